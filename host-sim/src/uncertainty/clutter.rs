//! Clutter and removal: people and moved furniture hide what was learned and show what was not.
//!
//! Each feature is, with the probability given, gone, and a random segment is seen in its place: so there are as many
//! added as removed. It runs from a point uniform in the image towards another, as long as what it replaces unless the
//! second point is nearer; either side is the brighter one. Nothing of it has a stereo match.
//!
//! In looks alone, and drawn anew in each: people walk on, and a source that never sees the world can't tell which
//! features of two looks are the same piece of furniture. What stays moved through all looks of a trial is harder than
//! this. A source of ours.

use super::setting::source;
use super::{ActsIn, SourceFacts, UncertaintySource, for_each_feature};
use crate::camera::StereoObservation;
use crate::random::Stream;
use edgeloc::geometry::{PinholeCamera, Point2, Polarity, Segment2};

const FACTS: SourceFacts = SourceFacts {
    key: "clutter",
    name: "clutter and removal",
    symbol: "",
    unit: "share of features",
    stream_id: 12,
    is_enabled_by_default: false,
    default_magnitude: 0.2,
    legal_range: (0.0, 1.0),
    acts_in: ActsIn::Looks,
    cause: "people and moved furniture hide that share of the features and add as many random segments",
    citation: "ours",
};

source! {
    /// Puts random segments in place of some features; the magnitude is their share.
    pub struct Clutter: FACTS {}
}

impl UncertaintySource for Clutter {
    fn apply(&self, observation: &mut StereoObservation, stream: &mut Stream) {
        let camera = observation.rig.camera;
        for_each_feature(observation, stream, |feature, stream| {
            if stream.chance(self.magnitude) {
                let length_px = feature.left.iter().map(Segment2::length_px).sum();
                feature.left.clear();
                feature.left.extend(random_segment(&camera, length_px, stream));
                feature.right.clear();
                feature.is_matchable = false;
            }
        });
    }

    fn replaces_features(&self) -> bool {
        true
    }
}

/// A segment inside the image, at most `length_px` long; none in the rare case that its end points coincide.
fn random_segment(camera: &PinholeCamera, length_px: f32, stream: &mut Stream) -> Option<Segment2> {
    let (width_px, height_px) = (f64::from(camera.width_px()), f64::from(camera.height_px()));
    let mut point = || Point2::new(stream.uniform(0.0, width_px) as f32, stream.uniform(0.0, height_px) as f32);
    let (start, towards) = (point(), point());
    let end = start.lerp(towards, (length_px / start.distance(towards)).min(1.0));
    let polarity = if stream.chance(0.5) { Polarity::LeftBrighter } else { Polarity::RightBrighter };
    Segment2::new(start, end, polarity).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::test_observation::{observation, perturbed};

    #[test]
    fn zero_magnitude_is_the_identity() {
        let source = Clutter { magnitude: 0.0, ..Clutter::default() };
        assert_eq!(perturbed(&source, 200), observation(200));
    }

    #[test]
    fn one_feature_in_five_gives_way_to_a_segment_anywhere_in_the_image() {
        let (before, after) = (observation(20_000), perturbed(&Clutter::default(), 20_000));
        let (mut count, mut bright_left, mut sum) = (0.0, 0.0, (0.0, 0.0));
        for (before, after) in before.features.iter().zip(&after.features) {
            if before == after {
                continue;
            }
            let (old, new) = (&before.left[0], &after.left[0]);
            assert!(after.left.len() == 1 && after.right.is_empty() && !after.is_matchable);
            assert!(new.length_px() <= old.length_px() + 1e-2, "{new:?} is longer than {old:?}");
            for end in [new.start(), new.end()] {
                assert!((0.0..=640.0).contains(&end.x) && (0.0..=480.0).contains(&end.y), "{end:?}");
            }
            count += 1.0;
            bright_left += f64::from(u8::from(new.polarity() == Polarity::LeftBrighter));
            sum = (sum.0 + f64::from(new.start().x), sum.1 + f64::from(new.start().y));
        }
        assert!((count / 20_000.0 - 0.2_f64).abs() < 0.01, "{count}");
        assert!((bright_left / count - 0.5).abs() < 0.03, "{bright_left} of {count}");
        assert!((sum.0 / count - 320.0).abs() < 12.0 && (sum.1 / count - 240.0).abs() < 9.0, "{sum:?} of {count}");
    }
}

//! Polarity flips: before another background an edge is bright on its other side.
//!
//! Each feature is seen with its bright and dark side swapped with the probability given, in both images and in each
//! look anew. In looks alone: what counts is the difference from the polarity that was learned. A source of ours; the
//! paper has no polarity.

use super::setting::source;
use super::{ActsIn, SourceFacts, UncertaintySource, for_each_feature};
use crate::camera::StereoObservation;
use crate::random::Stream;
use edgeloc::geometry::Segment2;

const FACTS: SourceFacts = SourceFacts {
    key: "polarity_flips",
    name: "polarity flips",
    symbol: "",
    unit: "share of features",
    stream_id: 11,
    is_enabled_by_default: false,
    default_magnitude: 0.05,
    legal_range: (0.0, 1.0),
    acts_in: ActsIn::Looks,
    cause: "a changed background swaps the bright and the dark side of that share of the features",
    citation: "ours",
};

source! {
    /// Flips the polarity of some features; the magnitude is their share.
    pub struct PolarityFlips: FACTS {}
}

impl UncertaintySource for PolarityFlips {
    fn apply(&self, observation: &mut StereoObservation, stream: &mut Stream) {
        for_each_feature(observation, stream, |feature, stream| {
            if stream.chance(self.magnitude) {
                feature.left.iter_mut().chain(&mut feature.right).for_each(|piece| *piece = flipped(piece));
            }
        });
    }
}

/// The same piece from the same start to the same end, its other side the brighter one.
fn flipped(piece: &Segment2) -> Segment2 {
    Segment2::new(piece.start(), piece.end(), piece.polarity().flipped()).unwrap_or(*piece)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::test_observation::{observation, perturbed};

    #[test]
    fn zero_magnitude_is_the_identity() {
        let source = PolarityFlips { magnitude: 0.0, ..PolarityFlips::default() };
        assert_eq!(perturbed(&source, 200), observation(200));
    }

    #[test]
    fn one_feature_in_twenty_flips_in_both_images_and_moves_nowhere() {
        let (before, after) = (observation(20_000), perturbed(&PolarityFlips::default(), 20_000));
        let mut flipped_count = 0_u32;
        for (before, after) in before.features.iter().zip(&after.features) {
            let is_flipped = |before: &Segment2, after: &Segment2| {
                assert_eq!((before.start(), before.end()), (after.start(), after.end()));
                before.polarity() != after.polarity()
            };
            let is_left_flipped = is_flipped(&before.left[0], &after.left[0]);
            assert_eq!(is_left_flipped, is_flipped(&before.right[0], &after.right[0]));
            flipped_count += u32::from(is_left_flipped);
        }
        assert!((f64::from(flipped_count) / 20_000.0 - 0.05).abs() < 0.005, "{flipped_count}");
    }
}

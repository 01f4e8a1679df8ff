//! Epipolar removal: a stereo matcher leaves out what runs along the epipolar lines.
//!
//! "For simplicity, the simulation system removes all the features that are +-5 degrees parallel to a horizontal line"
//! (paper, section 4.2, after Crossley 2000). Such a feature stays visible in both images and becomes unmatchable; the
//! localiser leaves near-horizontal segments of its scene out by itself. A feature counts as near-horizontal when the
//! line from the start of its first to the end of its last piece is, in either image.

use super::setting::source;
use super::{ActsIn, SourceFacts, UncertaintySource};
use crate::camera::StereoObservation;
use crate::random::Stream;
use edgeloc::geometry::Segment2;
use edgeloc::math;

const FACTS: SourceFacts = SourceFacts {
    key: "epipolar_removal",
    name: "epipolar removal",
    symbol: "",
    unit: "degrees",
    stream_id: 4,
    is_enabled_by_default: true,
    default_magnitude: 5.0,
    legal_range: (0.0, 45.0),
    acts_in: ActsIn::Learning,
    cause: "the stereo matcher leaves out features nearer to the horizontal than that angle",
    citation: "Tian et al., section 4.2, after Crossley 2000",
};

source! {
    /// Makes near-horizontal features unmatchable; the magnitude is the greatest angle left out, in degrees.
    pub struct EpipolarRemoval: FACTS {}
}

impl UncertaintySource for EpipolarRemoval {
    fn apply(&self, observation: &mut StereoObservation, _: &mut Stream) {
        let greatest_slope = math::tan((self.magnitude as f32).to_radians());
        for feature in &mut observation.features {
            if is_flatter(&feature.left, greatest_slope) || is_flatter(&feature.right, greatest_slope) {
                feature.is_matchable = false;
            }
        }
    }
}

/// Whether the line through all pieces of one image rises less than `slope` rows a column.
fn is_flatter(pieces: &[Segment2], slope: f32) -> bool {
    let (Some(first), Some(last)) = (pieces.first(), pieces.last()) else { return false };
    let (start, end) = (first.start(), last.end());
    math::abs(end.y - start.y) < slope * math::abs(end.x - start.x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::test_observation::{observation, perturbed, unit_stream};
    use edgeloc::geometry::{Point2, Polarity};

    #[test]
    fn zero_magnitude_is_the_identity() {
        let source = EpipolarRemoval { magnitude: 0.0, ..EpipolarRemoval::default() };
        assert_eq!(perturbed(&source, 200), observation(200));
    }

    #[test]
    fn exactly_the_features_within_five_degrees_of_the_horizontal_become_unmatchable() {
        let mut observation = observation(1);
        for degrees in [-175.1_f32, -174.9, -90.0, -5.1, -4.9, 0.0, 4.9, 5.1, 60.0, 174.9, 175.1, 180.0] {
            let (sin, cos) = math::sin_cos(degrees.to_radians());
            let (start, end) = (Point2::new(300.0, 200.0), Point2::new(300.0 + 80.0 * cos, 200.0 + 80.0 * sin));
            let piece = Segment2::new(start, end, Polarity::LeftBrighter).expect("a segment");
            let feature = &mut observation.features[0];
            (feature.left, feature.right, feature.is_matchable) = (vec![piece], vec![piece], true);
            EpipolarRemoval::default().apply(&mut observation, &mut unit_stream());
            let from_horizontal = degrees.abs().min(180.0 - degrees.abs());
            assert_eq!(observation.features[0].is_matchable, from_horizontal > 5.0, "{degrees}");
        }
    }

    #[test]
    fn one_in_eighteen_random_directions_is_left_out() {
        let mut rotated = observation(20_000);
        for feature in &mut rotated.features {
            feature.right.clear();
        }
        EpipolarRemoval::default().apply(&mut rotated, &mut unit_stream());
        let share = rotated.features.iter().filter(|feature| !feature.is_matchable).count() as f64 / 20_000.0;
        assert!((share - 1.0 / 18.0).abs() < 0.006, "{share}");
    }
}

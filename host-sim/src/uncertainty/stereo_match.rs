//! Stereo match error: a share of the features is matched with the wrong partner.
//!
//! Each matchable feature is matched wrongly with probability psi_s; its right pieces are then displaced along the
//! epipolar lines by an error U(-20, 20) px of disparity (paper, section 4.2, after Crossley 2000: a mis-match rate of
//! 1 % over a disparity range of 20 px on each side).
//!
//! Departure: the paper shifts such features "in both images". A mis-match pairs a left feature with a wrong right one:
//! the left image itself is not changed, so the left pieces, which are also what a trial's scene is made of, stay, and
//! the whole disparity error goes to the right pieces. Only the 3-D segment is affected.

use super::setting::source;
use super::{ActsIn, SourceFacts, UncertaintySource, for_each_feature};
use crate::camera::{StereoObservation, move_pieces};
use crate::random::Stream;
use edgeloc::geometry::Point2;

const FACTS: SourceFacts = SourceFacts {
    key: "stereo_match",
    name: "stereo match error",
    symbol: "psi_s",
    unit: "share of features",
    stream_id: 5,
    is_enabled_by_default: true,
    default_magnitude: 0.01,
    legal_range: (0.0, 0.1),
    acts_in: ActsIn::Learning,
    cause: "the stereo matcher gives that share of the features a disparity wrong by up to 20 px",
    citation: "Tian et al., section 4.2, after Crossley 2000",
};

/// Greatest error of the disparity of a wrong match, in pixels.
const MAX_DISPARITY_ERROR_PX: f64 = 20.0;

source! {
    /// Displaces the right pieces of some features; the magnitude is psi_s, the share of the matchable features.
    pub struct StereoMatch: FACTS {}
}

impl UncertaintySource for StereoMatch {
    fn apply(&self, observation: &mut StereoObservation, stream: &mut Stream) {
        for_each_feature(observation, stream, |feature, stream| {
            if feature.is_matchable && stream.chance(self.magnitude) {
                let error_px = stream.uniform(-MAX_DISPARITY_ERROR_PX, MAX_DISPARITY_ERROR_PX) as f32;
                let displaced = |point: Point2| Point2::new(point.x - error_px, point.y);
                move_pieces(&mut feature.right, |piece| (displaced(piece.start()), displaced(piece.end())));
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::test_observation::{observation, perturbed, unit_stream};

    #[test]
    fn zero_magnitude_is_the_identity() {
        let source = StereoMatch { magnitude: 0.0, ..StereoMatch::default() };
        assert_eq!(perturbed(&source, 200), observation(200));
    }

    #[test]
    fn the_share_psi_gets_a_uniform_disparity_error_and_left_images_stay() {
        let source = StereoMatch { magnitude: 0.1, ..StereoMatch::default() };
        let (before, after) = (observation(20_000), perturbed(&source, 20_000));
        let mut errors_px = Vec::new();
        for (before, after) in before.features.iter().zip(&after.features) {
            assert_eq!(before.left, after.left);
            let error_px = f64::from(before.right[0].start().x - after.right[0].start().x);
            if before.right != after.right {
                assert!(error_px.abs() <= 20.0);
                errors_px.push(error_px);
            }
        }
        let count = errors_px.len() as f64;
        let variance = errors_px.iter().map(|error_px| error_px * error_px).sum::<f64>() / count;
        assert!((count / 20_000.0 - 0.1).abs() < 0.007, "{count}");
        assert!((variance - 400.0 / 3.0).abs() < 10.0, "{variance}");
    }

    #[test]
    fn unmatchable_features_are_left_alone() {
        let mut unmatched = observation(500);
        for feature in &mut unmatched.features {
            feature.is_matchable = false;
        }
        let before = unmatched.clone();
        StereoMatch { magnitude: 0.1, ..StereoMatch::default() }.apply(&mut unmatched, &mut unit_stream());
        assert_eq!(unmatched, before);
    }
}

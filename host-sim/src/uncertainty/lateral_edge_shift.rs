//! Lateral edge shift: changing light moves a detected edge sideways, all along its length.
//!
//! Each feature moves along its image normal by U(-r, r) px, r = psi_l (1 + 0.5 U(-1, 1)): within 3 +- 1.5 px at the
//! default (paper, section 4.2, after Coupe 2009), nothing at 0. Light is common to both images, so left and right
//! move by the same draw unless `is_common` is off.

use super::setting::source;
use super::{ActsIn, SourceFacts, UncertaintySource, for_each_feature};
use crate::camera::{StereoObservation, move_pieces};
use crate::random::Stream;
use edgeloc::geometry::{Point2, Segment2};

const FACTS: SourceFacts = SourceFacts {
    key: "lateral_edge_shift",
    name: "lateral edge shift",
    symbol: "psi_l",
    unit: "px",
    stream_id: 1,
    is_enabled_by_default: true,
    default_magnitude: 3.0,
    legal_range: (0.0, 10.0),
    acts_in: ActsIn::Both,
    cause: "illumination moves a detected edge along its normal, by at most the magnitude +- half of it",
    citation: "Tian et al., section 4.2, after Coupe 2009",
};

source! {
    /// Moves each feature along its image normal; the magnitude is psi_l, in pixels.
    pub struct LateralEdgeShift: FACTS {
        /// Whether the left and right image of a feature move alike.
        pub is_common: bool = true,
    }
}

impl UncertaintySource for LateralEdgeShift {
    fn apply(&self, observation: &mut StereoObservation, stream: &mut Stream) {
        for_each_feature(observation, stream, |feature, stream| {
            let left_px = self.draw_shift_px(stream);
            let right_px = if self.is_common { left_px } else { self.draw_shift_px(stream) };
            move_pieces(&mut feature.left, |piece| shifted(piece, left_px));
            move_pieces(&mut feature.right, |piece| shifted(piece, right_px));
        });
    }
}

impl LateralEdgeShift {
    fn draw_shift_px(&self, stream: &mut Stream) -> f32 {
        let reach_px = self.magnitude * (1.0 + 0.5 * stream.uniform(-1.0, 1.0));
        (reach_px * stream.uniform(-1.0, 1.0)) as f32
    }
}

/// The end points of a piece moved along its normal (to its right, walking from start to end).
pub(super) fn shifted(piece: &Segment2, shift_px: f32) -> (Point2, Point2) {
    let (start, end) = (piece.start(), piece.end());
    let scale = shift_px / piece.length_px();
    let (dx, dy) = ((start.y - end.y) * scale, (end.x - start.x) * scale);
    (Point2::new(start.x + dx, start.y + dy), Point2::new(end.x + dx, end.y + dy))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::test_observation::{observation, offsets_px, perturbed};

    #[test]
    fn zero_magnitude_is_the_identity() {
        let source = LateralEdgeShift { magnitude: 0.0, ..LateralEdgeShift::default() };
        assert_eq!(perturbed(&source, 200), observation(200));
    }

    #[test]
    fn shifts_are_parallel_within_three_halves_of_psi_and_spread_as_the_law_says() {
        let (before, after) = (observation(20_000), perturbed(&LateralEdgeShift::default(), 20_000));
        let (mut sum, mut square, mut greatest) = (0.0_f64, 0.0_f64, 0.0_f32);
        for (before, after) in before.features.iter().zip(&after.features) {
            let [at_start, at_end] = offsets_px(&before.left[0], &after.left[0]);
            assert!((at_start - at_end).abs() < 0.01, "{at_start} {at_end}");
            greatest = greatest.max(at_start.abs());
            sum += f64::from(at_start);
            square += f64::from(at_start) * f64::from(at_start);
        }
        let count = before.features.len() as f64;
        // Variance of U(-r, r) is r^2 / 3, and E r^2 = psi^2 (1 + 0.25 / 3).
        let expected_variance = 9.0 * (1.0 + 0.25 / 3.0) / 3.0;
        assert!((sum / count).abs() < 0.05, "{}", sum / count);
        assert!((square / count - expected_variance).abs() < 0.08, "{}", square / count);
        assert!(greatest <= 4.501 && greatest > 4.0, "{greatest}");
    }

    #[test]
    fn left_and_right_move_alike_unless_drawn_apart() {
        let differences = |source: &LateralEdgeShift| {
            let (before, after) = (observation(500), perturbed(source, 500));
            let pairs = before.features.iter().zip(&after.features);
            pairs
                .map(|(before, after)| {
                    offsets_px(&before.left[0], &after.left[0])[0] - offsets_px(&before.right[0], &after.right[0])[0]
                })
                .filter(|difference_px| difference_px.abs() > 0.01)
                .count()
        };
        assert_eq!(differences(&LateralEdgeShift::default()), 0);
        assert!(differences(&LateralEdgeShift { is_common: false, ..LateralEdgeShift::default() }) > 450);
    }
}

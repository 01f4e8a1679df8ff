//! Geometric approximation: fitting straight pieces to edge pixels misplaces their end points.
//!
//! Each end point of each piece moves by a circular Gaussian whose standard deviation is psi_g (1 + U(-1, 1) / 3) px,
//! drawn once for each image, left and right on their own: 0.15 +- 0.05 px at the default (paper, section 4.2, after
//! Ashbrook et al. 1995), nothing at 0.

use super::setting::source;
use super::{ActsIn, SourceFacts, UncertaintySource, for_each_feature};
use crate::camera::{StereoObservation, move_pieces};
use crate::random::Stream;
use edgeloc::geometry::Point2;

const FACTS: SourceFacts = SourceFacts {
    key: "geometric_approximation",
    name: "geometric approximation error",
    symbol: "psi_g",
    unit: "px",
    stream_id: 3,
    is_enabled_by_default: true,
    default_magnitude: 0.15,
    legal_range: (0.0, 5.0),
    acts_in: ActsIn::Both,
    cause: "line fitting misplaces each end point by a circular Gaussian; its standard deviation, drawn for each image, is the \
            magnitude +- a third of it",
    citation: "Tian et al., section 4.2, after Ashbrook et al. 1995",
};

/// How far the standard deviation varies from one image to the next: 0.15 +- 0.05 px.
const VARIATION: f64 = 1.0 / 3.0;

source! {
    /// Moves each end point of each piece; the magnitude is psi_g, the mean standard deviation in x and in y, in pixels.
    pub struct GeometricApproximation: FACTS {}
}

impl UncertaintySource for GeometricApproximation {
    fn apply(&self, observation: &mut StereoObservation, stream: &mut Stream) {
        let [left_px, right_px] = self.draw_deviations_px(stream);
        for_each_feature(observation, stream, |feature, stream| {
            for (pieces, deviation_px) in [(&mut feature.left, left_px), (&mut feature.right, right_px)] {
                let mut moved = |point: Point2| misplaced(point, deviation_px, stream);
                move_pieces(pieces, |piece| (moved(piece.start()), moved(piece.end())));
            }
        });
    }
}

impl GeometricApproximation {
    /// The standard deviations in the left and in the right image of one pair \[px\].
    pub(super) fn draw_deviations_px(&self, stream: &mut Stream) -> [f64; 2] {
        // A place in the stream that no feature has.
        stream.seek(u32::MAX as usize);
        [(); 2].map(|()| self.magnitude * (1.0 + VARIATION * stream.uniform(-1.0, 1.0)))
    }
}

/// A point moved by a circular Gaussian of `deviation_px` in x and in y.
pub(super) fn misplaced(point: Point2, deviation_px: f64, stream: &mut Stream) -> Point2 {
    let [x, y] = stream.circular_gaussian();
    Point2::new(point.x + (x * deviation_px) as f32, point.y + (y * deviation_px) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::test_observation::{observation, perturbed, unit_stream};

    #[test]
    fn zero_magnitude_is_the_identity() {
        let source = GeometricApproximation { magnitude: 0.0, ..GeometricApproximation::default() };
        assert_eq!(perturbed(&source, 200), observation(200));
    }

    #[test]
    fn end_points_of_an_image_move_by_one_circular_gaussian() {
        let source = GeometricApproximation::default();
        let (before, after) = (observation(10_000), perturbed(&source, 10_000));
        let [left_px, right_px] = source.draw_deviations_px(&mut unit_stream());
        assert!((left_px - right_px).abs() > 0.01, "{left_px} {right_px}");
        for (deviation_px, is_left) in [(left_px, true), (right_px, false)] {
            let mut errors = Vec::new();
            for (before, after) in before.features.iter().zip(&after.features) {
                let [from, to] =
                    [before, after].map(|feature| if is_left { &feature.left[0] } else { &feature.right[0] });
                for (from, to) in [(from.start(), to.start()), (from.end(), to.end())] {
                    errors.push([to.x - from.x, to.y - from.y].map(|error| f64::from(error) / deviation_px));
                }
            }
            let mean = |value: &dyn Fn(&[f64; 2]) -> f64| errors.iter().map(value).sum::<f64>() / errors.len() as f64;
            assert!(mean(&|error| error[0]).abs() < 0.025 && mean(&|error| error[1]).abs() < 0.025);
            assert!((mean(&|error| error[0] * error[0]).sqrt() - 1.0).abs() < 0.02);
            assert!((mean(&|error| error[1] * error[1]).sqrt() - 1.0).abs() < 0.02);
            assert!(mean(&|error| error[0] * error[1]).abs() < 0.025);
            // 68.3 % of a Gaussian lie within one standard deviation.
            let within = mean(&|error| f64::from(u8::from(error[0].abs() < 1.0)));
            assert!((within - 0.683).abs() < 0.012, "{within}");
        }
    }

    #[test]
    fn images_differ_by_a_third_of_psi() {
        let source = GeometricApproximation::default();
        let draw = |image| source.draw_deviations_px(&mut Stream::new(2, "test", image, 0));
        let drawn: Vec<f64> = (0..10_000).flat_map(draw).collect();
        assert!(drawn.iter().all(|deviation_px| (0.1..0.2).contains(deviation_px)));
        assert!(drawn.iter().any(|&deviation_px| deviation_px < 0.101) && drawn.iter().any(|&px| px > 0.199));
        let variance = drawn.iter().map(|deviation_px| deviation_px * deviation_px).sum::<f64>() / drawn.len() as f64;
        // E (1 + U(-1, 1) / 3)^2 = 1 + 1 / 27.
        assert!((variance / (0.15 * 0.15) - (1.0 + 1.0 / 27.0)).abs() < 0.01, "{variance}");
    }
}

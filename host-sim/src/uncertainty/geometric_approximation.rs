//! Geometric approximation: fitting straight pieces to edge pixels misplaces their end points.
//!
//! Each end point of each piece, in each image on its own, moves by a circular Gaussian of standard deviation psi_g px
//! (paper, section 4.2, after Ashbrook et al. 1995).

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
    cause: "line fitting misplaces each end point by a circular Gaussian of that standard deviation",
    citation: "Tian et al., section 4.2, after Ashbrook et al. 1995",
};

source! {
    /// Moves each end point of each piece; the magnitude is psi_g, the standard deviation in x and in y, in pixels.
    pub struct GeometricApproximation: FACTS {}
}

impl UncertaintySource for GeometricApproximation {
    fn apply(&self, observation: &mut StereoObservation, stream: &mut Stream) {
        for_each_feature(observation, stream, |feature, stream| {
            for pieces in [&mut feature.left, &mut feature.right] {
                let mut moved = |point: Point2| misplaced(point, self.magnitude, stream);
                move_pieces(pieces, |piece| (moved(piece.start()), moved(piece.end())));
            }
        });
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
    use crate::uncertainty::test_observation::{observation, perturbed};

    #[test]
    fn zero_magnitude_is_the_identity() {
        let source = GeometricApproximation { magnitude: 0.0, ..GeometricApproximation::default() };
        assert_eq!(perturbed(&source, 200), observation(200));
    }

    #[test]
    fn end_points_move_by_a_circular_gaussian_of_psi() {
        let (before, after) = (observation(10_000), perturbed(&GeometricApproximation::default(), 10_000));
        let mut errors_px = Vec::new();
        for (before, after) in before.features.iter().zip(&after.features) {
            for (before, after) in [(&before.left, &after.left), (&before.right, &after.right)] {
                for (from, to) in [(before[0].start(), after[0].start()), (before[0].end(), after[0].end())] {
                    errors_px.push((f64::from(to.x - from.x), f64::from(to.y - from.y)));
                }
            }
        }
        let mean =
            |value: &dyn Fn(&(f64, f64)) -> f64| errors_px.iter().map(value).sum::<f64>() / errors_px.len() as f64;
        assert!(mean(&|error| error.0).abs() < 0.003 && mean(&|error| error.1).abs() < 0.003);
        assert!((mean(&|error| error.0 * error.0).sqrt() - 0.15).abs() < 0.003);
        assert!((mean(&|error| error.1 * error.1).sqrt() - 0.15).abs() < 0.003);
        assert!(mean(&|error| error.0 * error.1).abs() < 0.0005);
        // 68.3 % of a Gaussian lie within one standard deviation.
        let within = mean(&|error| f64::from(u8::from(error.0.abs() < 0.15)));
        assert!((within - 0.683).abs() < 0.01, "{within}");
    }
}

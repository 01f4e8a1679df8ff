//! What the sources do to the corners of one view on their way to calibration.

use super::geometric_approximation::misplaced;
use super::{NoiseKey, SourceSetting, Sources};
use edgeloc::stereo::CornerPair;

/// Standard deviation that a calibration ascribes to a corner at least, in pixels: no detector is exact.
const LEAST_NOISE_PX: f64 = 0.05;

impl Sources {
    /// Perturbs the corners of the `view_index`-th view of a calibration: their positions by psi_g, the ends of lines
    /// being what they are; then detection loss and wrong matches.
    pub fn perturb_corners(&self, corners: &mut Vec<CornerPair>, seed: u64, view_index: u64) {
        let key = NoiseKey::corners(seed, view_index);
        if self.geometric_approximation.enabled {
            let mut stream = key.stream(self.geometric_approximation.facts());
            let [left_px, right_px] = self.geometric_approximation.draw_deviations_px(&mut stream);
            for pair in corners.iter_mut() {
                pair.left = misplaced(pair.left, left_px, &mut stream);
                pair.right = misplaced(pair.right, right_px, &mut stream);
            }
        }
        if self.corner_match.enabled {
            self.corner_match.move_corners(corners, &mut key.stream(self.corner_match.facts()));
        }
        if self.corner_detection_loss.enabled {
            self.corner_detection_loss.drop_corners(corners, &mut key.stream(self.corner_detection_loss.facts()));
        }
    }

    /// Standard deviation of a corner's position in x and in y, as a robot that calibrates knows it \[px\]: psi_g, at least
    /// 0.05. So with the geometric approximation off, calibrations are up to three times as sharp as at the default of
    /// 0.15 px, and the camera calibration error, which is drawn from what they leave open, is as much smaller.
    #[must_use]
    pub fn corner_noise_px(&self) -> f64 {
        let source = &self.geometric_approximation;
        if source.enabled { source.magnitude.max(LEAST_NOISE_PX) } else { LEAST_NOISE_PX }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::test_observation::corners;
    use crate::uncertainty::{CornerDetectionLoss, CornerMatch, GeometricApproximation};

    fn perturbed(sources: &Sources, view_index: u64) -> Vec<CornerPair> {
        let mut perturbed = corners(300);
        sources.perturb_corners(&mut perturbed, 3, view_index);
        perturbed
    }

    #[test]
    fn no_source_leaves_corners_alone() {
        assert_eq!(perturbed(&Sources::none(), 0), corners(300));
        assert!((Sources::none().corner_noise_px() - 0.05).abs() < 1e-12);
        assert!((Sources::default().corner_noise_px() - 0.15).abs() < 1e-12);
    }

    #[test]
    fn each_source_draws_the_same_whatever_the_others_do() {
        let lossy = Sources { corner_detection_loss: CornerDetectionLoss::default(), ..Sources::none() };
        let all = Sources {
            geometric_approximation: GeometricApproximation::default(),
            corner_match: CornerMatch::default(),
            ..lossy.clone()
        };
        let (few, all) = (perturbed(&lossy, 1), perturbed(&all, 1));
        assert!(few.len() < 280);
        assert_eq!(few.len(), all.len());
        let near = |(a, b): (&CornerPair, &CornerPair)| a.left.distance(b.left) < 11.0;
        assert!(few.iter().zip(&all).all(near));
        assert_ne!(few, perturbed(&lossy, 2));
    }
}

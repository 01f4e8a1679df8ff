//! Camera calibration error: the robot's parameters of its rig are not the true ones.
//!
//! The errors are those that a calibration leaves, correlated as its covariance C_a says, times psi_c (paper, section
//! 4.2, equation 2; [`edgeloc::stereo`]). A robot is calibrated once: its errors are drawn once for each map, and both
//! learning and every look with that map go by the wrong parameters. Segments move only where the robot rectifies its
//! images (`learning::CalibratedRig`), so there is nothing to do on an observation.

use super::setting::source;
use super::{ActsIn, NoiseKey, SourceFacts, UncertaintySource};
use edgeloc::stereo::{CorrelatedErrors, PARAMETER_COUNT, ParameterVector};

const FACTS: SourceFacts = SourceFacts {
    key: "camera_calibration",
    name: "camera calibration error",
    symbol: "psi_c",
    unit: "times the calibration's own standard errors",
    stream_id: 9,
    is_enabled_by_default: true,
    default_magnitude: 1.0,
    legal_range: (0.0, 10.0),
    acts_in: ActsIn::Both,
    cause: "a robot rectifies and triangulates with parameters that are off by what its calibration leaves open",
    citation: "Tian et al., section 4.2, after Thacker and Mayhew 1991",
};

source! {
    /// Gives the robot wrong parameters of its rig; the magnitude is psi_c, in standard errors of a calibration.
    pub struct CameraCalibration: FACTS {}
}

impl UncertaintySource for CameraCalibration {}

impl CameraCalibration {
    /// Whether a robot's parameters are off at all.
    #[must_use]
    pub fn acts(&self) -> bool {
        self.enabled && self.magnitude > 0.0
    }

    /// What the robot that learns and uses one map has wrong in its parameters.
    #[must_use]
    pub fn draw_error(&self, errors: &CorrelatedErrors, seed: u64, map_index: u64) -> ParameterVector {
        let mut stream = NoiseKey::robot(seed, map_index).stream(&FACTS);
        let gaussians: [f64; PARAMETER_COUNT] = core::array::from_fn(|_| stream.circular_gaussian()[0]);
        errors.error(&gaussians, self.magnitude)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use edgeloc::geometry::StereoRig;
    use edgeloc::stereo::{Calibration, StereoParameters};

    #[test]
    fn errors_are_of_the_calibrations_size_times_psi_and_each_map_has_its_own() {
        let ideal = StereoParameters::ideal(&StereoRig::reference());
        let deviation = ParameterVector::from_fn(|index, _| 0.01 * (1.0 + index as f64));
        let calibration = Calibration::from_prior(&ideal, &deviation).expect("a prior");
        let errors = CorrelatedErrors::of(&calibration).expect("positive");
        let source = CameraCalibration { magnitude: 3.0, ..CameraCalibration::default() };
        let drawn: Vec<ParameterVector> = (0..2000).map(|map| source.draw_error(&errors, 1, map)).collect();
        for index in 0..PARAMETER_COUNT {
            let square = drawn.iter().map(|error| (error[index] / deviation[index]).powi(2)).sum::<f64>() / 2000.0;
            assert!((square - 9.0).abs() < 1.2, "{index}: {square}");
        }
        assert_eq!(drawn[7], source.draw_error(&errors, 1, 7));
        assert_ne!(drawn[7], source.draw_error(&errors, 2, 7));
    }

    #[test]
    fn zero_magnitude_is_the_identity() {
        assert!(!CameraCalibration { magnitude: 0.0, ..CameraCalibration::default() }.acts());
        assert!(!CameraCalibration { enabled: false, ..CameraCalibration::default() }.acts());
    }
}

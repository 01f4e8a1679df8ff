//! Errors of the parameters that are correlated as a covariance says.
//!
//! The paper's singular value decomposition of C_a: with C_a = V S V^T, the error V sqrt(S) n of independent standard
//! Gaussian n has the covariance C_a. Pixels, radians and metres differ by orders of magnitude, so the standard
//! deviations are taken out first and the matrix of correlations is decomposed.

use super::{Calibration, CalibrationError, PARAMETER_COUNT, ParameterMatrix, ParameterVector};
use crate::math::double;

/// How the errors of a calibration hang together.
#[derive(Debug, Clone, PartialEq)]
pub struct CorrelatedErrors {
    /// D V sqrt(S): one column for each independent cause.
    causes: ParameterMatrix,
}

impl CorrelatedErrors {
    /// The errors that remain after a calibration.
    ///
    /// # Errors
    /// When its information is singular in double precision.
    pub fn of(calibration: &Calibration) -> Result<Self, CalibrationError> {
        let covariance = calibration.covariance()?;
        let deviation = covariance.diagonal().map(double::sqrt);
        let correlation = ParameterMatrix::from_fn(|row, column| {
            // Both triangles from one, so that it is symmetric to the bit.
            let (high, low) = if row > column { (row, column) } else { (column, row) };
            covariance[(high, low)] / (deviation[high] * deviation[low])
        });
        let decomposed = correlation.symmetric_eigen();
        let causes = ParameterMatrix::from_fn(|row, column| {
            let variance = decomposed.eigenvalues[column];
            let size = if variance > 0.0 { double::sqrt(variance) } else { 0.0 };
            deviation[row] * decomposed.eigenvectors[(row, column)] * size
        });
        Ok(Self { causes })
    }

    /// The error that independent standard Gaussian numbers make, `magnitude` (psi_c) times as large as the covariance
    /// says.
    #[must_use]
    pub fn error(&self, gaussians: &[f64; PARAMETER_COUNT], magnitude: f64) -> ParameterVector {
        let mut error = ParameterVector::zeros();
        for (column, gaussian) in gaussians.iter().enumerate() {
            error += self.causes.column(column) * (gaussian * magnitude);
        }
        error
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::StereoRig;
    use crate::stereo::StereoParameters;

    #[test]
    fn the_causes_together_make_the_covariance() {
        let ideal = StereoParameters::ideal(&StereoRig::reference());
        let mut calibration =
            Calibration::from_prior(&ideal, &ParameterVector::from_fn(|index, _| 1e-3 * (1.0 + index as f64)))
                .expect("a prior");
        calibration.know(&ParameterVector::from_fn(|index, _| 1.0 - 0.2 * index as f64), 1e-3).expect("known");
        let covariance = calibration.covariance().expect("positive");
        let causes = CorrelatedErrors::of(&calibration).expect("positive").causes;
        let difference = causes * causes.transpose() - covariance;
        assert!(difference.norm() < 1e-12 * covariance.norm(), "{difference}");
    }

    #[test]
    fn magnitude_zero_is_no_error() {
        let ideal = StereoParameters::ideal(&StereoRig::reference());
        let calibration = Calibration::from_prior(&ideal, &ParameterVector::repeat(0.5)).expect("a prior");
        let errors = CorrelatedErrors::of(&calibration).expect("positive");
        assert_eq!(errors.error(&[1.3; PARAMETER_COUNT], 0.0), ParameterVector::zeros());
    }
}

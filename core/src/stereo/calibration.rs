//! Calibration by the paper's equation (2): the prior and the epipolar geometry of matched corners, in one least square.
//!
//! chi^2 = (a - a_t)^T C_a^-1 (a - a_t) + sum_i (y_i - phi_i(a_t))^T W_i^-1 (y_i - phi_i(a_t)), minimised by damped
//! Gauss-Newton steps. What is carried from one batch of corners to the next is the estimate and C_a^-1, the inverse
//! covariance: after a batch it has grown by J^T W^-1 J (the sensitivity analysis), and serves as the next prior.
//!
//! Some pairs are wrong matches. While the estimate moves, a pair counts by Huber's weight, so that none pulls harder
//! than one at two of its standard deviations; at the end pairs beyond four are left out and the rest counts in full.
//! A pair's standard deviation is that of its corners and of what is still unknown of the rig, so that a vague prior
//! does not make every pair look wrong.

use super::epipolar::EpipolarModel;
use super::{CornerPair, ParameterMatrix, ParameterVector, StereoParameters};
use crate::math::double;
use core::fmt;

/// An estimate of the parameters of a stereo rig and how sure it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    estimate: StereoParameters,
    information: ParameterMatrix,
}

/// What one batch of corner pairs did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CalibrationUpdate {
    /// Pairs that count.
    pub used_pairs: usize,
    /// Pairs left out as wrong matches.
    pub rejected_pairs: usize,
    /// Sum of the squared residuals of the pairs that count, in standard deviations of their corners.
    pub chi_squared: f64,
    /// Squared distance of the new estimate from the prior, by the prior's covariance.
    pub prior_chi_squared: f64,
    /// Gauss-Newton steps tried.
    pub steps: u32,
}

/// Where Huber's weight sets in, in standard deviations.
const HUBER: f64 = 2.0;
/// Beyond how many standard deviations a pair is a wrong match.
const GATE: f64 = 4.0;
/// Steps tried before a calibration is given up: along the valley of a focal length that corners hardly tell, two hundred
/// have been seen to be needed.
const MAX_STEPS: u32 = 500;
/// Settled when a step moves the estimate by less than this, in squared standard deviations.
const SETTLED: f64 = 1e-8;
/// Damping at the start, its factor for a step too many, and where a step is given up.
const DAMPING: (f64, f64, f64) = (1e-4, 10.0, 1e12);
/// Times that pairs are gated and the estimate settled anew.
const GATE_ROUNDS: u32 = 3;

/// How much a pair counts.
#[derive(Debug, Clone, Copy)]
enum Weighting<'a> {
    /// Huber's weight, for pairs spread as this covariance of the parameters allows.
    Huber(&'a ParameterMatrix),
    /// One, or nothing beyond the gate round this estimate.
    Gate(&'a EpipolarModel, &'a ParameterMatrix),
}

/// The quadratic that equation (2) is near one estimate.
struct Normal {
    information: ParameterMatrix,
    descent: ParameterVector,
    /// What is minimised.
    cost: f64,
    chi_squared: f64,
    used_pairs: usize,
}

impl Calibration {
    /// What is known before any corner is seen: values, and the standard deviation of each, all independent.
    ///
    /// # Errors
    /// When the values can't be those of two cameras, or a standard deviation is not positive and finite.
    pub fn from_prior(mean: &StereoParameters, deviation: &ParameterVector) -> Result<Self, CalibrationError> {
        if !mean.is_possible() {
            return Err(CalibrationError::Parameters);
        }
        if !deviation.iter().all(|value| *value > 0.0 && value.is_finite()) {
            return Err(CalibrationError::Deviation);
        }
        let information = ParameterMatrix::from_diagonal(&deviation.map(|value| 1.0 / (value * value)));
        Ok(Self { estimate: *mean, information })
    }

    /// Adds that a combination of the parameters, `weights` times their values, is as the estimate has it within
    /// `deviation`.
    ///
    /// # Errors
    /// When the standard deviation is not positive and finite.
    pub fn know(&mut self, weights: &ParameterVector, deviation: f64) -> Result<(), CalibrationError> {
        if deviation <= 0.0 || !deviation.is_finite() {
            return Err(CalibrationError::Deviation);
        }
        self.information.ger(1.0 / (deviation * deviation), weights, weights, 1.0);
        Ok(())
    }

    /// Adds that a far point ahead has the disparity that the estimate gives it, within `deviation_px`.
    ///
    /// Corners don't tell it (see [the module](super)), and it decides every depth: a robot sees it at the end of a
    /// corridor, a bench in any distant edge.
    ///
    /// # Errors
    /// When the standard deviation is not positive and finite.
    pub fn know_far_disparity(&mut self, deviation_px: f64) -> Result<(), CalibrationError> {
        // Of a point straight ahead: ox_l - (ox_r + f_r R_y), for the small rotations of cameras side by side.
        let mut weights = ParameterVector::zeros();
        weights[2] = 1.0;
        weights[7] = -1.0;
        weights[11] = -self.estimate.right.focal_length_px;
        self.know(&weights, deviation_px)
    }

    /// The parameters as they are best known.
    #[must_use]
    pub const fn estimate(&self) -> &StereoParameters {
        &self.estimate
    }

    /// C_a^-1, the inverse covariance of the estimate.
    #[must_use]
    pub const fn information(&self) -> &ParameterMatrix {
        &self.information
    }

    /// C_a, the covariance of the estimate.
    ///
    /// # Errors
    /// When the information is singular in double precision.
    pub fn covariance(&self) -> Result<ParameterMatrix, CalibrationError> {
        Ok(self.information.cholesky().ok_or(CalibrationError::Singular)?.inverse())
    }

    /// Standard deviations of the estimate.
    ///
    /// # Errors
    /// When the information is singular in double precision.
    pub fn standard_errors(&self) -> Result<ParameterVector, CalibrationError> {
        Ok(self.covariance()?.diagonal().map(double::sqrt))
    }

    /// Refines the estimate by matched corners whose positions scatter by `noise_px` in x and in y of either image.
    ///
    /// # Errors
    /// When a corner is not finite, the noise not positive, or no minimum is found; the calibration is then unchanged.
    pub fn update(&mut self, pairs: &[CornerPair], noise_px: f64) -> Result<CalibrationUpdate, CalibrationError> {
        if noise_px <= 0.0 || !noise_px.is_finite() {
            return Err(CalibrationError::Noise);
        }
        let is_finite = |pair: &CornerPair| pair.left.is_finite() && pair.right.is_finite();
        if let Some(index) = pairs.iter().position(|pair| !is_finite(pair)) {
            return Err(CalibrationError::Corner { index });
        }
        let batch = Batch { prior: self, pairs, noise_px };
        let mut steps = 0;
        let vague = self.covariance()?;
        let mut estimate = batch.settle(self.estimate, Weighting::Huber(&vague), &mut steps)?;
        let mut covariance = batch.covariance_at(&estimate, Weighting::Huber(&vague))?;
        for _ in 0..2 {
            // Sharper with each round: what the pairs have told need not be allowed for any more.
            estimate = batch.settle(estimate, Weighting::Huber(&covariance), &mut steps)?;
            covariance = batch.covariance_at(&estimate, Weighting::Huber(&covariance))?;
        }
        let mut last = batch.normal(&estimate, Weighting::Huber(&covariance));
        for _ in 0..GATE_ROUNDS {
            let (around, spread) = (EpipolarModel::new(&estimate), covariance);
            let gate = Weighting::Gate(&around, &spread);
            estimate = batch.settle(estimate, gate, &mut steps)?;
            covariance = batch.covariance_at(&estimate, gate)?;
            last = batch.normal(&estimate, gate);
        }
        let update = CalibrationUpdate {
            used_pairs: last.used_pairs,
            rejected_pairs: pairs.len() - last.used_pairs,
            chi_squared: last.chi_squared,
            prior_chi_squared: batch.prior_cost(&estimate),
            steps,
        };
        *self = Self { estimate, information: last.information };
        Ok(update)
    }
}

/// Equation (2) for one batch of pairs.
struct Batch<'a> {
    prior: &'a Calibration,
    pairs: &'a [CornerPair],
    noise_px: f64,
}

impl Batch<'_> {
    /// The minimum that is reached from `estimate`.
    fn settle(
        &self,
        mut estimate: StereoParameters,
        weighting: Weighting<'_>,
        steps: &mut u32,
    ) -> Result<StereoParameters, CalibrationError> {
        let (start, factor, give_up) = DAMPING;
        let mut damping = start;
        let mut normal = self.normal(&estimate, weighting);
        let first = *steps;
        while *steps - first < MAX_STEPS {
            *steps += 1;
            let mut damped = normal.information;
            for index in 0..damped.nrows() {
                damped[(index, index)] *= 1.0 + damping;
            }
            let step = damped.cholesky().ok_or(CalibrationError::Singular)?.solve(&normal.descent);
            let moved = StereoParameters::from_vector(&(estimate.to_vector() + step));
            let beyond = moved.is_possible().then(|| self.normal(&moved, weighting));
            match beyond {
                Some(better) if better.cost <= normal.cost => {
                    (estimate, normal) = (moved, better);
                    damping /= factor;
                    if step.dot(&(normal.information * step)) < SETTLED {
                        return Ok(estimate);
                    }
                }
                // Too near the minimum for the cost to tell better from worse.
                _ if step.dot(&(normal.information * step)) < SETTLED => return Ok(estimate),
                _ if damping > give_up => return Err(CalibrationError::NoMinimum),
                _ => damping *= factor,
            }
        }
        Err(CalibrationError::NoMinimum)
    }

    fn covariance_at(
        &self,
        estimate: &StereoParameters,
        weighting: Weighting<'_>,
    ) -> Result<ParameterMatrix, CalibrationError> {
        let normal = self.normal(estimate, weighting);
        Ok(normal.information.cholesky().ok_or(CalibrationError::Singular)?.inverse())
    }

    fn prior_cost(&self, estimate: &StereoParameters) -> f64 {
        let change = estimate.to_vector() - self.prior.estimate.to_vector();
        change.dot(&(self.prior.information * change))
    }

    fn normal(&self, estimate: &StereoParameters, weighting: Weighting<'_>) -> Normal {
        let change = estimate.to_vector() - self.prior.estimate.to_vector();
        let pull = self.prior.information * change;
        let mut normal = Normal {
            information: self.prior.information,
            descent: -pull,
            cost: change.dot(&pull),
            chi_squared: 0.0,
            used_pairs: 0,
        };
        let model = EpipolarModel::new(estimate);
        for pair in self.pairs {
            let found = model.residual(pair);
            let (residual, slope) = (found.distance_px / self.noise_px, found.slope / self.noise_px);
            let size = if residual < 0.0 { -residual } else { residual };
            let weight = match weighting {
                Weighting::Huber(covariance) => {
                    let reach = HUBER * spread(&slope, covariance);
                    let is_inside = size <= reach;
                    normal.cost += if is_inside { size * size } else { reach * (2.0 * size - reach) };
                    if is_inside { 1.0 } else { reach / size }
                }
                Weighting::Gate(around, covariance) => {
                    let found = around.residual(pair);
                    let (distance, slope) = (found.distance_px / self.noise_px, found.slope / self.noise_px);
                    let reach = GATE * spread(&slope, covariance);
                    if !(-reach..=reach).contains(&distance) {
                        continue;
                    }
                    normal.cost += size * size;
                    1.0
                }
            };
            normal.used_pairs += 1;
            normal.chi_squared += size * size;
            normal.descent -= slope * (weight * residual);
            normal.information.ger(weight, &slope, &slope, 1.0);
        }
        normal
    }
}

/// Standard deviation of a residual: one for its corners, and what the covariance of the parameters adds.
fn spread(slope: &ParameterVector, covariance: &ParameterMatrix) -> f64 {
    double::sqrt(1.0 + slope.dot(&(covariance * slope)))
}

/// Why corners could not be used; the calibration is as it was.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CalibrationError {
    /// The parameters can't be those of two cameras.
    Parameters,
    /// A standard deviation is not positive and finite.
    Deviation,
    /// The noise of the corners is not positive and finite.
    Noise,
    /// A corner is not finite.
    Corner {
        /// Its place in the batch.
        index: usize,
    },
    /// The information is singular in double precision: a prior is far too vague.
    Singular,
    /// No minimum was found: the prior is far off, or hardly a pair is a right match.
    NoMinimum,
}

impl fmt::Display for CalibrationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parameters => f.write_str(
                "stereo parameters must be finite, with focal lengths above 1 px, aspect ratios above 0.01 and a baseline",
            ),
            Self::Deviation => f.write_str("a standard deviation must be positive and finite"),
            Self::Noise => f.write_str("the noise of the corners must be positive and finite, in pixels"),
            Self::Corner { index } => write!(f, "corner pair {index} has a coordinate that is not finite"),
            Self::Singular => f.write_str("the information is singular; give the prior smaller standard deviations"),
            Self::NoMinimum => {
                f.write_str("no minimum was found; begin nearer to the truth, or check that the corners are matched")
            }
        }
    }
}

impl core::error::Error for CalibrationError {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point2, StereoRig};

    fn ideal() -> StereoParameters {
        StereoParameters::ideal(&StereoRig::reference())
    }

    fn prior() -> Calibration {
        let deviation = [3.0, 1e-3, 2.0, 2.0, 0.01, 3.0, 1e-3, 2.0, 2.0, 0.01, 3e-3, 3e-3, 3e-3, 2e-4, 2e-4, 1e-3];
        Calibration::from_prior(&ideal(), &ParameterVector::from_column_slice(&deviation)).expect("a prior")
    }

    /// A cloud of corners as a rig with these parameters sees it, without any error.
    fn pairs(parameters: &StereoParameters) -> std::vec::Vec<CornerPair> {
        let mut pairs = std::vec::Vec::new();
        for index in 0..200_u8 {
            let part = |factor: f64| (f64::from(index) * factor) % 1.0 - 0.5;
            let z = 2.5 + 3.0 * part(0.618);
            let (x, y) = (z * 1.1 * part(0.755), z * 0.8 * part(0.57));
            let point = nalgebra::Vector3::new(x, y, z);
            let beside = parameters.rotation() * point + nalgebra::Vector3::from(parameters.translation_m);
            let pixel = |[x, y]: [f64; 2]| Point2::new(x as f32, y as f32);
            pairs.push(CornerPair {
                left: pixel(parameters.left.pixel([x / z, y / z])),
                right: pixel(parameters.right.pixel([beside.x / beside.z, beside.y / beside.z])),
            });
        }
        pairs
    }

    #[test]
    fn corners_of_another_rig_move_the_estimate_until_they_fit() {
        let mut truth = ideal();
        truth.rotation_rad = [2e-3, -1e-3, 3e-3];
        truth.left.k1 = 0.01;
        truth.right.principal_point_px[1] += 2.0;
        let mut calibration = prior();
        let before = calibration.standard_errors().expect("a covariance");
        let update = calibration.update(&pairs(&truth), 0.1).expect("a calibration");
        assert_eq!((update.used_pairs, update.rejected_pairs), (200, 0));
        // Without noise what remains is the pull of the prior, over a hundred times weaker than the pairs.
        assert!(update.chi_squared < 2.0, "{update:?}");
        let after = calibration.standard_errors().expect("a covariance");
        assert!((0..16).all(|index| after[index] <= before[index] * (1.0 + 1e-9)));
        assert!(after[12] < 0.2 * before[12]);
        assert!((calibration.estimate().rotation_rad[2] - 3e-3).abs() < 5.0 * after[12]);
    }

    #[test]
    fn the_baseline_keeps_the_spread_of_the_prior() {
        let mut calibration = prior();
        calibration.update(&pairs(&ideal()), 0.1).expect("a calibration");
        let after = calibration.standard_errors().expect("a covariance");
        assert!((after[13] - 2e-4).abs() < 1e-9, "{}", after[13]);
        assert!((calibration.estimate().baseline_m() - 0.12).abs() < 1e-6);
    }

    #[test]
    fn wrong_matches_are_left_out() {
        let mut pairs = pairs(&ideal());
        for index in [3, 77, 150] {
            pairs[index].right.y += 7.0;
        }
        let (mut clean, mut dirty) = (prior(), prior());
        let without: std::vec::Vec<CornerPair> = pairs
            .iter()
            .enumerate()
            .filter(|(index, _)| ![3, 77, 150].contains(index))
            .map(|(_, pair)| *pair)
            .collect();
        clean.update(&without, 0.15).expect("a calibration");
        let update = dirty.update(&pairs, 0.15).expect("a calibration");
        assert_eq!(update.rejected_pairs, 3);
        let difference = clean.estimate().to_vector() - dirty.estimate().to_vector();
        assert!(difference.dot(&(clean.information() * difference)) < 1e-4);
    }

    #[test]
    fn batches_in_turn_tell_what_they_tell_together() {
        let pairs = pairs(&ideal());
        let (mut together, mut in_turn) = (prior(), prior());
        together.update(&pairs, 0.15).expect("a calibration");
        for batch in pairs.chunks(40) {
            in_turn.update(batch, 0.15).expect("a calibration");
        }
        let (a, b) = (together.standard_errors().expect("positive"), in_turn.standard_errors().expect("positive"));
        assert!((0..16).all(|index| (a[index] / b[index] - 1.0).abs() < 0.01), "{a} {b}");
    }

    #[test]
    fn no_pairs_change_nothing_and_impossible_input_is_refused() {
        let mut calibration = prior();
        let update = calibration.update(&[], 0.15).expect("nothing to do");
        assert_eq!((update.used_pairs, calibration.clone()), (0, prior()));
        let nowhere = CornerPair { left: Point2::new(f32::NAN, 0.0), right: Point2::default() };
        assert_eq!(calibration.update(&[nowhere], 0.15), Err(CalibrationError::Corner { index: 0 }));
        assert_eq!(calibration.update(&[], 0.0), Err(CalibrationError::Noise));
        assert_eq!(calibration.know_far_disparity(f64::NAN), Err(CalibrationError::Deviation));
        assert_eq!(calibration, prior());
    }
}

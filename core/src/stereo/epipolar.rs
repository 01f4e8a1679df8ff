//! The epipolar term of equation (2): how far a matched pair of corners is from one that two lines of sight can make.
//!
//! y is the pair as seen, four pixel coordinates; phi(a) is the nearest pair whose lines of sight meet, given the
//! parameters a. With e(y, a) = x_r^T [t] R x_l, t the unit vector of T, the nearest pair is found to first order from
//! y, and again from there (Sampson's distance, with one more step). The residual is the distance from y to phi in
//! standard deviations of the corner positions, which is what W stands for.

use super::camera_model::Sight;
use super::parameters::cross_matrix;
use super::{CameraParameters, ParameterVector, StereoParameters};
use crate::geometry::Point2;
use nalgebra::{Matrix3, Vector3, Vector4};

/// One corner as both images show it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerPair {
    /// Where the left image shows it \[px\].
    pub left: Point2,
    /// Where the right image shows it \[px\].
    pub right: Point2,
}

/// How far the pair is from its epipolar geometry \[px\], with a sign: over both images together.
#[must_use]
pub fn epipolar_distance_px(parameters: &StereoParameters, pair: &CornerPair) -> f64 {
    EpipolarModel::new(parameters).residual(pair).distance_px
}

/// The distance of a pair and how it answers to the parameters.
#[derive(Debug, Clone, Copy)]
pub(super) struct Residual {
    pub(super) distance_px: f64,
    pub(super) slope: ParameterVector,
}

/// The epipolar geometry of some parameters, ready for many pairs.
#[derive(Debug, Clone)]
pub(super) struct EpipolarModel {
    left: CameraParameters,
    right: CameraParameters,
    essential: Matrix3<f64>,
    /// Derivatives of the essential matrix with respect to R and T.
    slopes: [Matrix3<f64>; 6],
}

/// e and its derivatives at one pair.
struct Constraint {
    value: f64,
    by_pixels: Vector4<f64>,
    by_parameters: ParameterVector,
}

impl EpipolarModel {
    pub(super) fn new(parameters: &StereoParameters) -> Self {
        let rotation = parameters.rotation();
        let length_m = parameters.baseline_m();
        let direction = Vector3::from(parameters.translation_m) / length_m;
        let cross = cross_matrix(&direction);
        let [about_x, about_y, about_z] = parameters.rotation_slopes().map(|slope| cross * slope);
        // Only the direction of T is seen: a step along T changes nothing.
        let by_translation = |axis: usize| {
            let step = Vector3::ith(axis, 1.0);
            cross_matrix(&((step - direction * direction[axis]) / length_m)) * rotation
        };
        Self {
            left: parameters.left,
            right: parameters.right,
            essential: cross * rotation,
            slopes: [about_x, about_y, about_z, by_translation(0), by_translation(1), by_translation(2)],
        }
    }

    pub(super) fn residual(&self, pair: &CornerPair) -> Residual {
        let seen = Vector4::new(pair.left.x, pair.left.y, pair.right.x, pair.right.y).map(f64::from);
        let at_seen = self.constraint(&seen);
        let fit = seen - at_seen.by_pixels * (at_seen.value / at_seen.by_pixels.norm_squared());
        // The slopes are taken where the constraint holds: there they carry no part of the corner's own error, which
        // would pass for information.
        let at_fit = self.constraint(&fit);
        let steepness = at_fit.by_pixels.norm();
        Residual {
            distance_px: (at_fit.value + at_fit.by_pixels.dot(&(seen - fit))) / steepness,
            slope: at_fit.by_parameters / steepness,
        }
    }

    fn constraint(&self, pixels: &Vector4<f64>) -> Constraint {
        let left = self.left.sight([pixels[0], pixels[1]]);
        let right = self.right.sight([pixels[2], pixels[3]]);
        let ray = |sight: &Sight| Vector3::new(sight.direction[0], sight.direction[1], 1.0);
        let (left_ray, right_ray) = (ray(&left), ray(&right));
        let right_line = self.essential * left_ray;
        let left_line = self.essential.tr_mul(&right_ray);

        let (left_pixels, left_camera) = by_camera(&self.left, &left, [left_line.x, left_line.y]);
        let (right_pixels, right_camera) = by_camera(&self.right, &right, [right_line.x, right_line.y]);
        let by_pose = self.slopes.map(|slope| right_ray.dot(&(slope * left_ray)));
        let all = left_camera.iter().chain(&right_camera).chain(&by_pose);
        Constraint {
            value: right_ray.dot(&right_line),
            by_pixels: Vector4::new(left_pixels[0], left_pixels[1], right_pixels[0], right_pixels[1]),
            by_parameters: ParameterVector::from_iterator(all.copied()),
        }
    }
}

/// Derivatives of e with respect to one camera's pixel and parameters, given those with respect to its direction.
fn by_camera(camera: &CameraParameters, sight: &Sight, by_direction: [f64; 2]) -> ([f64; 2], [f64; 5]) {
    let [[xx, xy], [_, yy]] = sight.slope;
    let by_distorted = [xx * by_direction[0] + xy * by_direction[1], xy * by_direction[0] + yy * by_direction[1]];
    let (f, aspect) = (camera.focal_length_px, camera.aspect_ratio);
    let by_pixel = [by_distorted[0] / f, by_distorted[1] / (f * aspect)];
    let ([x, y], [distorted_x, distorted_y]) = (sight.direction, sight.distorted);
    let by_parameters = [
        -(by_distorted[0] * distorted_x + by_distorted[1] * distorted_y) / f,
        -by_distorted[1] * distorted_y / aspect,
        -by_pixel[0],
        -by_pixel[1],
        -(by_distorted[0] * x + by_distorted[1] * y) * (x * x + y * y),
    ];
    (by_pixel, by_parameters)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verged() -> StereoParameters {
        let camera = CameraParameters {
            focal_length_px: 536.5,
            aspect_ratio: 1.002,
            principal_point_px: [342.4, 234.3],
            k1: -0.2,
        };
        StereoParameters {
            left: camera,
            right: CameraParameters { principal_point_px: [327.0, 249.0], k1: -0.21, ..camera },
            rotation_rad: [0.02, -0.1, 0.01],
            translation_m: [-0.0836, 0.0011, 0.0008],
        }
    }

    fn seen(parameters: &StereoParameters, point: [f64; 3]) -> CornerPair {
        let pixel = |camera: &CameraParameters, p: Vector3<f64>| {
            let [x, y] = camera.pixel([p.x / p.z, p.y / p.z]);
            Point2::new(x as f32, y as f32)
        };
        let from_left = Vector3::from(point);
        let from_right = parameters.rotation() * from_left + Vector3::from(parameters.translation_m);
        CornerPair { left: pixel(&parameters.left, from_left), right: pixel(&parameters.right, from_right) }
    }

    const POINTS: [[f64; 3]; 4] = [[0.1, 0.2, 1.0], [-0.8, 0.4, 2.0], [0.4, -0.5, 1.5], [1.5, 0.9, 4.0]];

    #[test]
    fn a_true_pair_fits_and_a_moved_one_is_off_by_its_distance() {
        let parameters = verged();
        for point in POINTS {
            let mut pair = seen(&parameters, point);
            assert!(epipolar_distance_px(&parameters, &pair).abs() < 1e-4);
            // Rows are nearly epipolar lines, and half of the squared error is laid to each image.
            pair.right.y += 2.0;
            let distance_px = epipolar_distance_px(&parameters, &pair).abs();
            assert!((distance_px - 2.0 / core::f64::consts::SQRT_2).abs() < 0.1, "{distance_px}");
        }
    }

    #[test]
    fn the_slope_is_how_the_distance_answers_to_each_parameter() {
        let parameters = verged();
        for point in POINTS {
            let pair = seen(&parameters, point);
            let slope = EpipolarModel::new(&parameters).residual(&pair).slope;
            for index in 0..slope.len() {
                let step = if matches!(index, 0 | 2 | 3 | 5 | 7 | 8) { 0.05 } else { 1e-5 };
                let beside = |step: f64| {
                    let mut vector = parameters.to_vector();
                    vector[index] += step;
                    epipolar_distance_px(&StereoParameters::from_vector(&vector), &pair)
                };
                let answer = (beside(step) - beside(-step)) / (2.0 * step);
                assert!(
                    (answer - slope[index]).abs() < 1e-3 * (1.0 + answer.abs()),
                    "{index}: {answer} {}",
                    slope[index]
                );
            }
        }
    }

    #[test]
    fn the_length_of_the_baseline_is_not_seen() {
        let parameters = verged();
        for point in POINTS {
            let slope = EpipolarModel::new(&parameters).residual(&seen(&parameters, point)).slope;
            let [x, y, z] = parameters.translation_m;
            assert!((slope[13] * x + slope[14] * y + slope[15] * z).abs() < 1e-12);
        }
    }
}

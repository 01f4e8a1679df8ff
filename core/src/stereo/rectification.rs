//! Rectification: where the points of two real images lie in the images of two ideal cameras side by side.
//!
//! The rectified left camera stands where the left one does, its x axis along the baseline, its optical axis as near to
//! the left one's as that allows; the right one is the same beside it. Both rectified images are those of a
//! [`PinholeCamera`] that one is free to choose. A straight edge stays straight but for the lens's own distortion, and is
//! mapped by its end points.

use super::{CalibrationError, CameraParameters, StereoParameters};
use crate::geometry::{PinholeCamera, Point2};
use nalgebra::{Matrix3, Vector3};

/// The way from the two real images to the rectified ones, as the parameters have it.
#[derive(Debug, Clone, PartialEq)]
pub struct Rectification {
    camera: PinholeCamera,
    baseline_m: f64,
    left: CameraParameters,
    right: CameraParameters,
    rectified_from_left: Matrix3<f64>,
    rectified_from_right: Matrix3<f64>,
}

impl Rectification {
    /// From the parameters as known to the images of `camera`.
    ///
    /// # Errors
    /// When the parameters can't be those of two cameras side by side: nonsense, or one before the other.
    pub fn new(parameters: &StereoParameters, camera: &PinholeCamera) -> Result<Self, CalibrationError> {
        if !parameters.is_possible() {
            return Err(CalibrationError::Parameters);
        }
        let rotation = parameters.rotation();
        let baseline_m = parameters.baseline_m();
        // Where the right camera stands, seen from the left one.
        let right_center = -rotation.tr_mul(&Vector3::from(parameters.translation_m));
        let x_axis = right_center / baseline_m;
        let down = Vector3::z().cross(&x_axis);
        let length = down.norm();
        if x_axis.x <= 0.0 || length < 0.1 {
            return Err(CalibrationError::Parameters);
        }
        let y_axis = down / length;
        let z_axis = x_axis.cross(&y_axis);
        let rectified_from_left = Matrix3::from_rows(&[x_axis.transpose(), y_axis.transpose(), z_axis.transpose()]);
        Ok(Self {
            camera: *camera,
            baseline_m,
            left: parameters.left,
            right: parameters.right,
            rectified_from_left,
            rectified_from_right: rectified_from_left * rotation.transpose(),
        })
    }

    /// Distance between the two rectified cameras \[m\].
    #[must_use]
    pub const fn baseline_m(&self) -> f64 {
        self.baseline_m
    }

    /// Where a point of the left image lies in the rectified left image.
    #[must_use]
    pub fn left(&self, point: Point2) -> Point2 {
        self.rectified(&self.left, &self.rectified_from_left, point)
    }

    /// Where a point of the right image lies in the rectified right image.
    #[must_use]
    pub fn right(&self, point: Point2) -> Point2 {
        self.rectified(&self.right, &self.rectified_from_right, point)
    }

    /// Not finite when the line of sight lies in the plane of the rectified image: no camera sees so far to the side.
    fn rectified(&self, camera: &CameraParameters, turn: &Matrix3<f64>, point: Point2) -> Point2 {
        let [x, y] = camera.direction([f64::from(point.x), f64::from(point.y)]);
        let ray = turn * Vector3::new(x, y, 1.0);
        let focal_length_px = f64::from(self.camera.focal_length_px());
        let center = self.camera.principal_point_px();
        let pixel = |along: f64, center: f32| (f64::from(center) + focal_length_px * along / ray.z) as f32;
        Point2::new(pixel(ray.x, center.x), pixel(ray.y, center.y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::StereoRig;

    fn verged() -> StereoParameters {
        let ideal = StereoParameters::ideal(&StereoRig::reference());
        let right =
            CameraParameters { focal_length_px: 498.0, principal_point_px: [311.0, 247.0], k1: 0.03, ..ideal.right };
        let left = CameraParameters { k1: -0.2, aspect_ratio: 1.01, ..ideal.left };
        StereoParameters { left, right, rotation_rad: [0.02, 0.05, -0.03], translation_m: [-0.12, 0.006, 0.009] }
    }

    #[test]
    fn rectified_points_share_their_row_and_their_disparity_is_the_depth() {
        let (parameters, camera) = (verged(), PinholeCamera::reference());
        let rectification = Rectification::new(&parameters, &camera).expect("side by side");
        let pixel = |[x, y]: [f64; 2]| Point2::new(x as f32, y as f32);
        for point in [[0.1, 0.2, 1.0], [-0.8, 0.4, 2.0], [0.4, -0.5, 1.5], [1.5, 0.9, 4.0]] {
            let from_left = Vector3::from(point);
            let from_right = parameters.rotation() * from_left + Vector3::from(parameters.translation_m);
            let left_pixel = pixel(parameters.left.pixel([from_left.x / from_left.z, from_left.y / from_left.z]));
            let right_pixel = pixel(parameters.right.pixel([from_right.x / from_right.z, from_right.y / from_right.z]));
            let (left, right) = (rectification.left(left_pixel), rectification.right(right_pixel));
            assert!((left.y - right.y).abs() < 1e-3, "{left:?} {right:?}");
            let depth_m = (rectification.rectified_from_left * from_left).z;
            let expected_px = f64::from(camera.focal_length_px()) * rectification.baseline_m() / depth_m;
            assert!((f64::from(left.x - right.x) - expected_px).abs() < 1e-3);
        }
    }

    #[test]
    fn the_ideal_rig_needs_no_rectification() {
        let rig = StereoRig::reference();
        let rectification = Rectification::new(&StereoParameters::ideal(&rig), &rig.camera).expect("side by side");
        for point in [Point2::new(0.0, 0.0), Point2::new(600.5, 33.0), Point2::new(320.0, 240.0)] {
            assert!(rectification.left(point).distance(point) < 1e-4);
            assert!(rectification.right(point).distance(point) < 1e-4);
        }
        assert!((rectification.baseline_m() - 0.12).abs() < 1e-8);
    }

    #[test]
    fn one_camera_before_the_other_is_refused() {
        let ahead = StereoParameters { translation_m: [0.0, 0.0, 0.1], ..verged() };
        let refused = Rectification::new(&ahead, &PinholeCamera::reference());
        assert_eq!(refused, Err(CalibrationError::Parameters));
    }
}

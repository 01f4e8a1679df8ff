//! The parameters of a stereo rig: as a value with names and units, and as the vector that is estimated.

use super::CameraParameters;
use crate::geometry::StereoRig;
use crate::math::double;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

/// How many parameters a stereo rig has: five of each camera, three of rotation, three of translation.
pub const PARAMETER_COUNT: usize = 16;

/// Values, or errors, of all parameters in the order of [`PARAMETERS`].
pub type ParameterVector = SVector<f64, PARAMETER_COUNT>;

/// Covariance, or its inverse, of all parameters in the order of [`PARAMETERS`].
pub type ParameterMatrix = SMatrix<f64, PARAMETER_COUNT, PARAMETER_COUNT>;

/// Name and unit of one parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ParameterFacts {
    /// Name for people.
    pub name: &'static str,
    /// Symbol in the paper, the camera as index.
    pub symbol: &'static str,
    /// Unit; empty for a ratio.
    pub unit: &'static str,
}

const fn facts(name: &'static str, symbol: &'static str, unit: &'static str) -> ParameterFacts {
    ParameterFacts { name, symbol, unit }
}

/// The parameters in the order of a [`ParameterVector`].
pub const PARAMETERS: [ParameterFacts; PARAMETER_COUNT] = [
    facts("left focal length", "f_l", "px"),
    facts("left aspect ratio", "a_l", ""),
    facts("left optical centre x", "ox_l", "px"),
    facts("left optical centre y", "oy_l", "px"),
    facts("left distortion", "k_l", ""),
    facts("right focal length", "f_r", "px"),
    facts("right aspect ratio", "a_r", ""),
    facts("right optical centre x", "ox_r", "px"),
    facts("right optical centre y", "oy_r", "px"),
    facts("right distortion", "k_r", ""),
    facts("rotation about x", "R_x", "rad"),
    facts("rotation about y", "R_y", "rad"),
    facts("rotation about z", "R_z", "rad"),
    facts("translation along x", "T_x", "m"),
    facts("translation along y", "T_y", "m"),
    facts("translation along z", "T_z", "m"),
];

/// The paper's S = F(f, a_x, a_y, o_x, o_y, k, R, T), f to k of each camera.
///
/// The paper writes one set of intrinsics. No two lenses sit alike on their sensors (15 px apart in a rig that we
/// measured), so each camera has its own; a prior can say how alike they are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StereoParameters {
    /// The left camera.
    pub left: CameraParameters,
    /// The right camera.
    pub right: CameraParameters,
    /// R as a rotation vector \[rad\]: a point p of the left camera's frame is R p + T in the right one's.
    pub rotation_rad: [f64; 3],
    /// T \[m\]; (-b, 0, 0) when the right camera stands b to the right of the left one.
    pub translation_m: [f64; 3],
}

impl StereoParameters {
    /// The parameters that a rig has when it is exactly what it is meant to be.
    #[must_use]
    pub fn ideal(rig: &StereoRig) -> Self {
        let center = rig.camera.principal_point_px();
        let camera = CameraParameters {
            focal_length_px: f64::from(rig.camera.focal_length_px()),
            aspect_ratio: 1.0,
            principal_point_px: [f64::from(center.x), f64::from(center.y)],
            k1: 0.0,
        };
        let translation_m = [-f64::from(rig.baseline_m), 0.0, 0.0];
        Self { left: camera, right: camera, rotation_rad: [0.0; 3], translation_m }
    }

    /// The parameters as a vector.
    #[must_use]
    pub fn to_vector(&self) -> ParameterVector {
        let camera = |camera: &CameraParameters| {
            let [x, y] = camera.principal_point_px;
            [camera.focal_length_px, camera.aspect_ratio, x, y, camera.k1]
        };
        let (left, right) = (camera(&self.left), camera(&self.right));
        let all = left.iter().chain(&right).chain(&self.rotation_rad).chain(&self.translation_m);
        ParameterVector::from_iterator(all.copied())
    }

    /// The parameters of a vector.
    #[must_use]
    pub fn from_vector(vector: &ParameterVector) -> Self {
        let camera = |first: usize| CameraParameters {
            focal_length_px: vector[first],
            aspect_ratio: vector[first + 1],
            principal_point_px: [vector[first + 2], vector[first + 3]],
            k1: vector[first + 4],
        };
        let three = |first: usize| [vector[first], vector[first + 1], vector[first + 2]];
        Self {
            left: camera(0),
            right: camera(CameraParameters::COUNT),
            rotation_rad: three(2 * CameraParameters::COUNT),
            translation_m: three(2 * CameraParameters::COUNT + 3),
        }
    }

    /// Length of T: the distance between the optical centres \[m\].
    #[must_use]
    pub fn baseline_m(&self) -> f64 {
        let [x, y, z] = self.translation_m;
        double::sqrt(x * x + y * y + z * z)
    }

    /// Whether the numbers can be those of two cameras: all finite, focal lengths, aspect ratios and baseline positive.
    #[must_use]
    pub fn is_possible(&self) -> bool {
        let is_camera = |camera: &CameraParameters| camera.focal_length_px > 1.0 && camera.aspect_ratio > 0.01;
        let is_finite = self.to_vector().iter().all(|value| value.is_finite());
        is_finite && is_camera(&self.left) && is_camera(&self.right) && self.baseline_m() > 1e-6
    }

    /// R as a matrix (Rodrigues).
    pub(super) fn rotation(&self) -> Matrix3<f64> {
        let Rodrigues { axis, sine, versine, .. } = self.rodrigues();
        Matrix3::identity() + axis * sine + axis * axis * versine
    }

    /// Derivatives of R with respect to the three components of the rotation vector.
    pub(super) fn rotation_slopes(&self) -> [Matrix3<f64>; 3] {
        let Rodrigues { axis, versine, remainder, .. } = self.rodrigues();
        // A small change d of the vector turns R further by J d, J the left Jacobian of the rotations.
        let jacobian = Matrix3::identity() + axis * versine + axis * axis * remainder;
        let rotation = self.rotation();
        [0, 1, 2].map(|component| cross_matrix(&jacobian.column(component).into_owned()) * rotation)
    }

    fn rodrigues(&self) -> Rodrigues {
        let axis = cross_matrix(&Vector3::from(self.rotation_rad));
        let [x, y, z] = self.rotation_rad;
        let square = x * x + y * y + z * z;
        let angle = double::sqrt(square);
        if angle < 1e-4 {
            // The first terms of the series: exact to the last bit for such angles.
            let (sine, versine) = (1.0 - square / 6.0, 0.5 - square / 24.0);
            return Rodrigues { axis, sine, versine, remainder: 1.0 / 6.0 - square / 120.0 };
        }
        let (sin, cos) = double::sin_cos(angle);
        let (sine, versine) = (sin / angle, (1.0 - cos) / square);
        Rodrigues { axis, sine, versine, remainder: (angle - sin) / (square * angle) }
    }
}

/// The parts of a rotation by the angle t = |v|: the cross matrix of v and the factors of its powers.
struct Rodrigues {
    axis: Matrix3<f64>,
    /// sin t / t.
    sine: f64,
    /// (1 - cos t) / t^2.
    versine: f64,
    /// (t - sin t) / t^3.
    remainder: f64,
}

/// The matrix whose product with p is the cross product of v and p.
pub(super) fn cross_matrix(v: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(0.0, -v.z, v.y, v.z, 0.0, -v.x, -v.y, v.x, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned() -> StereoParameters {
        StereoParameters {
            rotation_rad: [0.3, -0.2, 0.1],
            translation_m: [-0.1, 0.01, 0.02],
            ..StereoParameters::ideal(&StereoRig::reference())
        }
    }

    #[test]
    fn the_vector_and_back_changes_nothing_and_every_parameter_has_its_name() {
        let vector = ParameterVector::from_fn(|index, _| index as f64 + 0.5);
        assert_eq!(StereoParameters::from_vector(&vector).to_vector(), vector);
        for (index, one) in PARAMETERS.iter().enumerate() {
            assert!(PARAMETERS[..index].iter().all(|other| other.name != one.name && other.symbol != one.symbol));
        }
    }

    #[test]
    fn a_rotation_keeps_lengths_and_turns_by_its_vector() {
        let rotation = turned().rotation();
        assert!((rotation * rotation.transpose() - Matrix3::identity()).norm() < 1e-14);
        let quarter = StereoParameters { rotation_rad: [0.0, 0.0, core::f64::consts::FRAC_PI_2], ..turned() };
        assert!((quarter.rotation() * Vector3::x() - Vector3::y()).norm() < 1e-14);
    }

    #[test]
    fn the_slopes_are_how_a_rotation_answers_to_its_vector() {
        for scale in [1.0, 1e-6] {
            let at = StereoParameters { rotation_rad: turned().rotation_rad.map(|w| w * scale), ..turned() };
            for (component, slope) in at.rotation_slopes().iter().enumerate() {
                let beside = |step: f64| {
                    let mut rotation_rad = at.rotation_rad;
                    rotation_rad[component] += step;
                    StereoParameters { rotation_rad, ..at }.rotation()
                };
                let answer = (beside(1e-5) - beside(-1e-5)) / 2e-5;
                assert!((answer - slope).norm() < 1e-9, "{scale} {component}");
            }
        }
    }

    #[test]
    fn impossible_cameras_are_told() {
        assert!(turned().is_possible());
        assert!(!StereoParameters { translation_m: [0.0; 3], ..turned() }.is_possible());
        assert!(!StereoParameters { rotation_rad: [f64::NAN, 0.0, 0.0], ..turned() }.is_possible());
    }
}

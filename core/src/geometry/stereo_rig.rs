//! The stereo camera pair and how it is mounted.

use super::PinholeCamera;
use core::fmt;

/// Two identical, rectified cameras side by side, optical axes horizontal; the right one is to the right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StereoRig {
    /// Both cameras.
    pub camera: PinholeCamera,
    /// Distance between the optical centres \[m\], positive.
    pub baseline_m: f32,
    /// Height of the optical centres above the floor \[m\].
    pub camera_height_m: f32,
    /// Least depth at which an edge is seen \[m\], positive.
    pub near_limit_m: f32,
    /// Least depth at which a stereo match is kept \[m\].
    pub nearest_model_m: f32,
    /// Greatest depth at which a stereo match is kept \[m\].
    pub farthest_model_m: f32,
}

impl StereoRig {
    /// The reference rig: [`PinholeCamera::reference`], baseline 0.12 m, 1.0 m above the floor, edges seen from
    /// 0.15 m, matches kept from 0.25 to 16 m.
    #[must_use]
    pub const fn reference() -> Self {
        Self {
            camera: PinholeCamera::reference(),
            baseline_m: 0.12,
            camera_height_m: 1.0,
            near_limit_m: 0.15,
            nearest_model_m: 0.25,
            farthest_model_m: 16.0,
        }
    }

    /// The rig itself, if its lengths make sense.
    ///
    /// # Errors
    /// When a length is not finite or out of its range: baseline 1 mm to 10 m, height within 100 m, near limit 1 mm to
    /// 10 m, model depths positive, ordered and at most 1000 m.
    pub fn checked(self) -> Result<Self, RigError> {
        if !(0.001..=10.0).contains(&self.baseline_m) {
            return Err(RigError::Baseline);
        }
        if !(-100.0..=100.0).contains(&self.camera_height_m) {
            return Err(RigError::CameraHeight);
        }
        if !(0.001..=10.0).contains(&self.near_limit_m) {
            return Err(RigError::NearLimit);
        }
        let depths_ordered = self.nearest_model_m > 0.0 && self.nearest_model_m < self.farthest_model_m;
        if !depths_ordered || self.farthest_model_m > 1000.0 {
            return Err(RigError::ModelDepths);
        }
        Ok(self)
    }
}

/// Which length of a [`StereoRig`] is out of range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RigError {
    /// The baseline is not within 1 mm to 10 m.
    Baseline,
    /// The camera height is not within 100 m of the floor.
    CameraHeight,
    /// The near limit is not within 1 mm to 10 m.
    NearLimit,
    /// The model depths are not positive, ordered and at most 1000 m.
    ModelDepths,
}

impl fmt::Display for RigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Baseline => "stereo baseline is not within 0.001 to 10 m",
            Self::CameraHeight => "camera height is not within 100 m of the floor",
            Self::NearLimit => "near limit is not within 0.001 to 10 m",
            Self::ModelDepths => "model depths are not positive, ordered and at most 1000 m",
        })
    }
}

impl core::error::Error for RigError {}

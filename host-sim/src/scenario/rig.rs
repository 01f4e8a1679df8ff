//! The stereo rig as a scenario states it; by default [`StereoRig::reference`].

use super::decimal;
use edgeloc::geometry::{PinholeCamera, Point2, StereoRig};
use serde::{Deserialize, Serialize};

/// The stereo rig: two identical, rectified cameras side by side.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RigSettings {
    /// Image width in pixels.
    pub width_px: u16,
    /// Image height in pixels.
    pub height_px: u16,
    /// Focal length in pixels.
    pub focal_length_px: f64,
    /// Column where the optical axis meets the image in pixels.
    pub principal_point_x_px: f64,
    /// Row where the optical axis meets the image in pixels.
    pub principal_point_y_px: f64,
    /// Distance between the optical centres in metres.
    pub baseline_m: f64,
    /// Height of the optical centres above the floor in metres.
    pub camera_height_m: f64,
    /// Least depth at which an edge is seen in metres.
    pub near_limit_m: f64,
    /// Least depth at which a stereo match is kept in metres.
    pub nearest_model_m: f64,
    /// Greatest depth at which a stereo match is kept in metres.
    pub farthest_model_m: f64,
}

impl Default for RigSettings {
    fn default() -> Self {
        Self::from(&StereoRig::reference())
    }
}

impl From<&StereoRig> for RigSettings {
    fn from(rig: &StereoRig) -> Self {
        let camera = &rig.camera;
        Self {
            width_px: camera.width_px(),
            height_px: camera.height_px(),
            focal_length_px: decimal(camera.focal_length_px()),
            principal_point_x_px: decimal(camera.principal_point_px().x),
            principal_point_y_px: decimal(camera.principal_point_px().y),
            baseline_m: decimal(rig.baseline_m),
            camera_height_m: decimal(rig.camera_height_m),
            near_limit_m: decimal(rig.near_limit_m),
            nearest_model_m: decimal(rig.nearest_model_m),
            farthest_model_m: decimal(rig.farthest_model_m),
        }
    }
}

impl RigSettings {
    /// The rig these numbers describe.
    ///
    /// # Errors
    /// What is wrong with the numbers, when the camera or the rig refuses them.
    pub fn stereo_rig(&self) -> Result<StereoRig, String> {
        let principal_point_px = Point2::new(self.principal_point_x_px as f32, self.principal_point_y_px as f32);
        let camera =
            PinholeCamera::new((self.width_px, self.height_px), self.focal_length_px as f32, principal_point_px)
                .map_err(|error| error.to_string())?;
        StereoRig {
            camera,
            baseline_m: self.baseline_m as f32,
            camera_height_m: self.camera_height_m as f32,
            near_limit_m: self.near_limit_m as f32,
            nearest_model_m: self.nearest_model_m as f32,
            farthest_model_m: self.farthest_model_m as f32,
        }
        .checked()
        .map_err(|error| error.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_is_the_reference_rig_to_the_bit() {
        assert_eq!(RigSettings::default().stereo_rig(), Ok(StereoRig::reference()));
        assert!(format!("{:?}", RigSettings::default()).contains("baseline_m: 0.12,"));
    }
}

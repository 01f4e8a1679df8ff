//! The normal image: whatever the camera, verification works in an image of at most 640 x 480 px.

use crate::geometry::PinholeCamera;
use crate::math;

/// Width of the normal image in pixels.
pub(super) const WIDTH_PX: f32 = 640.0;
/// Height of the normal image in pixels.
pub(super) const HEIGHT_PX: f32 = 480.0;

/// A camera scaled to the normal image.
#[derive(Debug, Clone, Copy)]
pub(super) struct ImageFrame {
    /// Normal pixels per pixel of the camera.
    pub(super) scale: f32,
    pub(super) width_px: f32,
    pub(super) height_px: f32,
    pub(super) focal_px: f32,
    pub(super) center_px: [f32; 2],
}

impl ImageFrame {
    pub(super) fn new(camera: &PinholeCamera) -> Self {
        let (width, height) = (f32::from(camera.width_px()), f32::from(camera.height_px()));
        let scale = math::min(WIDTH_PX / width, HEIGHT_PX / height);
        let center = camera.principal_point_px();
        Self {
            scale,
            width_px: width * scale,
            height_px: height * scale,
            focal_px: camera.focal_length_px() * scale,
            center_px: [center.x * scale, center.y * scale],
        }
    }
}

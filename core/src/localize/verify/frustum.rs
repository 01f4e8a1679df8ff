//! What a camera sees: a pyramid without its tip, bounded by five planes.

use super::image_frame::ImageFrame;

/// The pyramid in the frame of a camera: x right, y down, z forward \[m\].
#[derive(Debug, Clone, Copy)]
pub(super) struct Frustum {
    near_m: f32,
    /// Slopes of the left and the right border.
    sides: [f32; 2],
    /// Slopes of the upper and the lower border.
    heights: [f32; 2],
}

impl Frustum {
    /// Number of planes.
    pub(super) const PLANES: usize = 5;

    /// That of a camera which sees nothing nearer than `near_m`.
    pub(super) const fn new(frame: &ImageFrame, near_m: f32) -> Self {
        let ([x, y], focal) = (frame.center_px, frame.focal_px);
        Self {
            near_m,
            sides: [x / focal, (frame.width_px - x) / focal],
            heights: [y / focal, (frame.height_px - y) / focal],
        }
    }

    /// Nothing nearer is seen \[m\].
    pub(super) const fn near_m(&self) -> f32 {
        self.near_m
    }

    /// Slopes of the left and the right border.
    pub(super) const fn sides(&self) -> [f32; 2] {
        self.sides
    }

    /// How far on the inner side of a plane a point lies, in that plane's own unit; less than 0 outside.
    #[inline(always)]
    pub(super) fn inside<const PLANE: usize>(&self, [x, y, z]: [f32; 3]) -> f32 {
        const { assert!(PLANE < Self::PLANES) }
        match PLANE {
            0 => x + self.sides[0] * z,
            1 => self.sides[1] * z - x,
            2 => z - self.near_m,
            3 => y + self.heights[0] * z,
            _ => self.heights[1] * z - y,
        }
    }
}

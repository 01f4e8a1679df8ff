//! A segment in the fixed-point form that histograms are built from.

use super::PghShape;
use crate::geometry::{BinaryAngle, Point2, Polarity, Segment2};
use crate::math;
use zerocopy::{FromBytes, Immutable, IntoBytes};

/// A segment of a scene, in integers: end points in Q4 px, unit normal in Q30, direction as a binary angle.
///
/// With polarity the line is directed so that the brighter side lies to its left, and directions have the period
/// 2 pi. Without, the line has no direction: it is walked so that its angle lies in `[0, pi)`, whichever end point
/// came first. (That choice jumps only between near-horizontal lines, which the default exclusion drops.)
#[derive(Debug, Clone, Copy, PartialEq, Eq, FromBytes, IntoBytes, Immutable)]
#[repr(C)]
pub struct Line {
    pub(super) start_q4: [i32; 2],
    pub(super) end_q4: [i32; 2],
    pub(super) midpoint_q4: [i32; 2],
    pub(super) normal_q30: [i32; 2],
    pub(super) length_q4: u32,
    pub(super) order: u32,
    pub(super) direction: u32,
}

impl Line {
    /// The fixed-point form of `segment`, the `order`-th of its scene, for histograms of the given shape.
    #[must_use]
    pub fn new(segment: &Segment2, order: u32, shape: &PghShape) -> Self {
        let walked_backwards = if shape.uses_polarity {
            segment.polarity() == Polarity::RightBrighter
        } else {
            let (dx, dy) = (segment.end().x - segment.start().x, segment.end().y - segment.start().y);
            dy < 0.0 || (dy == 0.0 && dx < 0.0)
        };
        let (from, to) =
            if walked_backwards { (segment.end(), segment.start()) } else { (segment.start(), segment.end()) };
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        let length = math::length(dx, dy);
        Self {
            start_q4: to_q4(from),
            end_q4: to_q4(to),
            midpoint_q4: to_q4(from.lerp(to, 0.5)),
            normal_q30: [
                math::round_to_i32(-dy / length * 1_073_741_824.0),
                math::round_to_i32(dx / length * 1_073_741_824.0),
            ],
            length_q4: Self::length_q4_of(length),
            order,
            direction: u32::from(BinaryAngle::from_radians(math::atan2(dy, dx), shape.period_radians()).0),
        }
    }

    /// A length in pixels in units of 1/16 px.
    pub(super) fn length_q4_of(length_px: f32) -> u32 {
        math::round_to_i32(length_px * 16.0) as u32
    }

    /// Length in units of 1/16 px.
    #[must_use]
    pub const fn length_q4(&self) -> u32 {
        self.length_q4
    }

    /// What tells lines of equal length apart: the number given to [`Self::new`].
    #[must_use]
    pub const fn order(&self) -> u32 {
        self.order
    }

    /// Puts lines that see the others alike near each other: by direction in sixteenths of a period, then by how far they are
    /// from the image's origin. Their histograms fill the same bins.
    pub(crate) fn kin(&self) -> (u32, i32) {
        const SECTOR: u32 = 0x1000;
        let parts = [0, 1].map(|axis| i64::from(self.normal_q30[axis]) * i64::from(self.midpoint_q4[axis]));
        (((self.direction + SECTOR / 2) & 0xffff) / SECTOR, ((parts[0] + parts[1]) >> 30) as i32)
    }

    /// Direction as a fraction of the shape's period.
    #[must_use]
    pub const fn direction(&self) -> BinaryAngle {
        BinaryAngle((self.direction & 0xffff) as u16)
    }
}

fn to_q4(point: Point2) -> [i32; 2] {
    [math::round_to_i32(point.x * 16.0), math::round_to_i32(point.y * 16.0)]
}

//! The axes of one histogram, and where along them the lines of a scene lie.

use super::block::{BLOCK, LineBlock};
use super::masses::stride_of;
use super::root::nearest;
use super::{DistanceKind, Line, PghShape};
use crate::geometry::Segment2;
use core::ops::Range;

/// Positions along the distance axis have this many fractional bits of a bin.
pub(super) const POSITION_BITS: u32 = 12;
pub(super) const BIN: i32 = 1 << POSITION_BITS;

/// What the frames of all reference lines have in common.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axes {
    /// Bins per 1/16 px of distance, with [`Self::wide_bits`], to be multiplied by 16.
    scale: i64,
    /// Fractional bits of a position before it is cut to [`POSITION_BITS`]: as many as fit.
    wide_bits: u32,
    /// Position of a line upon the reference line, with [`Self::wide_bits`].
    middle: i32,
    /// Greatest position, in Q12 bins.
    pub(super) end: i32,
    /// Least width of a span, 1 px, in Q12 bins.
    least_span: i32,
    angle_bins: i32,
    /// Half an angle bin in Q16 where the nearest bin takes all, none where two share.
    angle_offset: i32,
    /// What makes an angle's position between two bins, in Q16, the share of the upper one.
    above_scale: f32,
    stride: i32,
}

impl Axes {
    pub(super) fn of(shape: &PghShape) -> Self {
        let bins_per_px = 1.0 / shape.distance_bin_width_px();
        // The farthest two points can be apart, and the offset of a signed axis.
        let reach = 3.0 * Segment2::MAX_COORDINATE_PX * bins_per_px + f32::from(shape.distance_bins / 2 + 2);
        let wide_bits = (reach as u32).leading_zeros() - 1;
        Self {
            scale: i64::from((bins_per_px * (1_u64 << wide_bits) as f32) as i32),
            wide_bits,
            middle: match shape.distance {
                DistanceKind::Signed => i32::from(shape.distance_bins) << (wide_bits - 1),
                DistanceKind::Unsigned => 0,
            },
            end: i32::from(shape.distance_bins) * BIN,
            least_span: ((bins_per_px * BIN as f32) as i32).max(1),
            angle_bins: i32::from(shape.angle_bins),
            angle_offset: if shape.interpolates_angle { 0 } else { 0x8000 },
            above_scale: if shape.interpolates_angle { 1.0 / 65_536.0 } else { 0.0 },
            stride: stride_of(usize::from(shape.angle_bins), BLOCK) as i32,
        }
    }
}

/// A reference line with its histogram's axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame<'a> {
    pub(super) axes: &'a Axes,
    /// Normal of the reference line, in bins per 1/16 px with [`Axes::wide_bits`].
    normal: [i32; 2],
    /// Position of the image's origin, in the same unit.
    offset: i32,
    direction: i32,
}

impl<'a> Frame<'a> {
    #[inline(always)]
    pub(super) fn about(reference: &Line, axes: &'a Axes) -> Self {
        // From Q30 normals to positions of coordinates in Q4 px.
        let normal = reference.normal_q30.map(|part| ((i64::from(part) * axes.scale) >> (30 + 4)) as i32);
        let [x, y] = reference.midpoint_q4;
        let offset = axes.middle.wrapping_sub(normal[0].wrapping_mul(x).wrapping_add(normal[1].wrapping_mul(y)));
        Self { axes, normal, offset, direction: reference.direction as i32 }
    }

    /// The same with the normal to the other side.
    #[inline(always)]
    pub(super) fn mirrored(&self) -> Self {
        Self { normal: self.normal.map(|part| -part), offset: self.offset.wrapping_neg(), ..*self }
    }

    /// Position of a point along the distance axis, in Q12 bins.
    #[inline(always)]
    fn position(&self, x_q4: i32, y_q4: i32) -> i32 {
        // Each product may pass the border of i32; the sum is within reach.
        let wide = self.normal[0].wrapping_mul(x_q4).wrapping_add(self.normal[1].wrapping_mul(y_q4));
        wide.wrapping_add(self.offset) >> (self.axes.wide_bits - POSITION_BITS)
    }

    /// Where the lines of a block lie, and what they add.
    #[inline(always)]
    pub(super) fn shares(&self, block: &LineBlock, reach: &mut Reach) -> Shares {
        let mut shares = Shares::NONE;
        let Axes { end, stride, .. } = *self.axes;
        for i in 0..BLOCK {
            let (start, span) = self.extent(block, i);
            let density = block.mass[i] / span as f32;
            let (low, high) = (start.max(0).min(end), start.wrapping_add(span).max(0).min(end));
            let (first, last) = (low >> POSITION_BITS, high >> POSITION_BITS);
            reach.first[i] = reach.first[i].min(first);
            reach.last[i] = reach.last[i].max(last);

            let border = first.wrapping_add(1) << POSITION_BITS;
            let in_first = high.min(border).wrapping_sub(low);
            let in_last = high.wrapping_sub(border.max(last << POSITION_BITS)).max(0);

            let (column, above) = self.angle(block, i);
            shares.first[i] = first.wrapping_mul(stride).wrapping_add(column);
            shares.last[i] = last.wrapping_mul(stride).wrapping_add(column);
            shares.in_first[i] = split(density * in_first as f32, above);
            shares.in_last[i] = split(density * in_last as f32, above);
            shares.in_between[i] = split(density * BIN as f32, above);
        }
        shares
    }

    /// Where a line of a block begins along the distance axis, and how wide it is, in Q12 bins.
    #[inline(always)]
    pub(super) fn extent(&self, block: &LineBlock, i: usize) -> (i32, i32) {
        let a = self.position(block.start_x_q4[i], block.start_y_q4[i]);
        let b = self.position(block.end_x_q4[i], block.end_y_q4[i]);
        // Positions are within reach: nothing wraps.
        let (low, high) = (a.min(b), a.max(b));
        let (width, least) = (high.wrapping_sub(low), self.axes.least_span);
        let low = if width < least { (low.wrapping_add(high) >> 1) - (least >> 1) } else { low };
        (low, width.max(least))
    }

    /// The lower of the two angle bins that share a line of a block, and the share of the upper one.
    #[inline(always)]
    pub(super) fn angle(&self, block: &LineBlock, i: usize) -> (i32, f32) {
        let Axes { angle_bins, angle_offset, above_scale, .. } = *self.axes;
        let relative = block.direction[i].wrapping_sub(self.direction) & 0xffff;
        let angle = relative.wrapping_mul(angle_bins).wrapping_add(angle_offset);
        (angle >> 16, (angle & 0xffff) as f32 * above_scale)
    }
}

/// A mass, shared between two angle bins.
#[inline(always)]
fn split(mass: f32, above: f32) -> [i32; 2] {
    let (whole, above) = (nearest(mass), nearest(mass * above));
    [whole.wrapping_sub(above), above]
}

/// What the lines of a block add to a histogram: masses for two neighbouring angle bins each.
#[derive(Debug)]
pub(super) struct Shares {
    /// Places of the first distance bins, and of the last, which may be the same.
    pub(super) first: [i32; BLOCK],
    pub(super) last: [i32; BLOCK],
    pub(super) in_first: [[i32; 2]; BLOCK],
    pub(super) in_last: [[i32; 2]; BLOCK],
    /// In each bin between the two; means nothing if there is none.
    pub(super) in_between: [[i32; 2]; BLOCK],
}

impl Shares {
    const NONE: Self = Self {
        first: [0; BLOCK],
        last: [0; BLOCK],
        in_first: [[0; 2]; BLOCK],
        in_last: [[0; 2]; BLOCK],
        in_between: [[0; 2]; BLOCK],
    };
}

/// The first and the last distance bin of the lines of a scene, by place in their block.
#[derive(Debug)]
pub(super) struct Reach {
    first: [i32; BLOCK],
    last: [i32; BLOCK],
}

impl Reach {
    pub(super) const NONE: Self = Self { first: [i32::MAX; BLOCK], last: [0; BLOCK] };

    /// The distance bins that are not empty are among these; the last may be the one behind the last.
    #[inline(always)]
    pub(super) fn rows(&self) -> Range<usize> {
        let first = self.first.into_iter().fold(i32::MAX, i32::min);
        let last = self.last.into_iter().fold(0, i32::max);
        first.min(last) as usize..last as usize + 1
    }
}

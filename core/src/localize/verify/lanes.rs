//! One model segment as seen from many poses at a time: a lane for each pose, the same steps in each.
//!
//! Written so that a compiler turns every loop over the lanes into vector instructions, and into plain ones where there is
//! one lane; lanes do not know of each other, so the number of poses under way changes nothing.

use super::channel::CHANNELS;
use super::distance_planes::{COLUMNS, PLANE, ROWS};
use super::responses::WIDTHS_PX;

/// Poses under way at a time at most: what fills the vectors of the machine. One without vectors takes one pose after the
/// other, and is spared what that one does not see.
pub(super) const LANES: usize = if cfg!(edgeloc_body = "x86_64") {
    16
} else if cfg!(any(edgeloc_body = "neon", edgeloc_body = "simd128")) {
    4
} else {
    1
};
/// Points that are looked up along a segment at most.
pub(super) const MAX_POINTS: usize = 24;

/// A number for each pose.
pub(super) type Lane<T, const N: usize> = [T; N];

/// `2^23`: added to a small number it leaves the nearest integer in the low bits.
const ROUNDER: f32 = 8_388_608.0;

/// The nearest integer of a number within `[-0.5, 2^22]`; of any other, some integer.
#[inline(always)]
pub(super) fn rounded(number: f32) -> i32 {
    (number + ROUNDER).to_bits().wrapping_sub(ROUNDER.to_bits()) as i32
}

/// The ends of a segment in the frame of each camera: x right, y down, z forward \[m\].
#[derive(Debug)]
pub(super) struct SegmentEnds<const N: usize> {
    pub(super) x: [Lane<f32, N>; 2],
    pub(super) y: [f32; 2],
    pub(super) z: [Lane<f32, N>; 2],
}

/// Which part of a segment is left, in shares of the way from its start to its end; none, where `enter` is not below
/// `leave`.
#[derive(Debug)]
pub(super) struct LanePart<const N: usize> {
    pub(super) enter: Lane<f32, N>,
    pub(super) leave: Lane<f32, N>,
}

impl<const N: usize> LanePart<N> {
    /// The segment whole.
    pub(super) const WHOLE: Self = Self { enter: [0.0; N], leave: [1.0; N] };

    /// Cuts it at a plane through which `inside` turns negative.
    #[inline(always)]
    pub(super) fn cut(&mut self, ends: &SegmentEnds<N>, inside: impl Fn(f32, f32, f32) -> f32) {
        let (mut start, mut end) = ([0.0; N], [0.0; N]);
        let mut is_any_outside = false;
        for lane in 0..N {
            start[lane] = inside(ends.x[0][lane], ends.y[0], ends.z[0][lane]);
            end[lane] = inside(ends.x[1][lane], ends.y[1], ends.z[1][lane]);
            is_any_outside |= (start[lane] < 0.0) | (end[lane] < 0.0);
        }
        if !is_any_outside {
            return;
        }
        for lane in 0..N {
            let (from, to) = (start[lane], end[lane]);
            let at = from / (from - to);
            let (enter, leave) = (self.enter[lane], self.leave[lane]);
            let later = if (from < 0.0) & (at > enter) { at } else { enter };
            self.enter[lane] = if (from < 0.0) & (to < 0.0) { 2.0 } else { later };
            self.leave[lane] = if (to < 0.0) & (at < leave) { at } else { leave };
        }
    }
}

/// Tables that lanes look things up in.
#[derive(Debug)]
pub(super) struct Tables<'t> {
    /// The distances of all channels, pixel by pixel.
    pub(super) planes: &'t [u8; CHANNELS * PLANE],
    /// Response of each width to each distance.
    pub(super) responses: &'t [[u8; 256]; WIDTHS_PX.len()],
}

impl Tables<'_> {
    /// The sum of responses at `count` points in a channel, from `first` on and `step` apart, in plane pixels.
    #[inline(always)]
    pub(super) fn sum<const N: usize>(
        &self,
        count: usize,
        (first, step): ([Lane<f32, N>; 2], [Lane<f32, N>; 2]),
        channel: &Lane<u32, N>,
        width: &Lane<u32, N>,
    ) -> Lane<i32, N> {
        let [mut x, mut y] = first;
        let mut sum = [0; N];
        for _ in 0..count {
            let mut at = [0_u32; N];
            for lane in 0..N {
                // Half a pixel less, so that rounding gives the pixel that holds the point.
                let column = (rounded(x[lane] - 0.5) as u32).min(COLUMNS as u32 - 1);
                let row = (rounded(y[lane] - 0.5) as u32).min(ROWS as u32 - 1);
                at[lane] = (row * COLUMNS as u32 + column) * CHANNELS as u32 + channel[lane];
                x[lane] += step[0][lane];
                y[lane] += step[1][lane];
            }
            for lane in 0..N {
                let distance = self.planes[(at[lane] as usize).min(CHANNELS * PLANE - 1)];
                sum[lane] += i32::from(self.responses[(width[lane] & 3) as usize][usize::from(distance)]);
            }
        }
        sum
    }
}

//! One model segment as seen from many poses at a time: a lane for each pose, the same steps in each.
//!
//! Written so that a compiler turns every loop over the lanes into vector instructions, and into plain ones where there is
//! one lane; lanes do not know of each other, so the number of poses under way changes nothing.

use super::channel::CHANNELS;
use super::distance_planes::{COLUMNS, PLANE, ROWS};
use super::frustum::Frustum;
use super::responses::WIDTHS_PX;
use crate::math;

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

/// Whether it is so in any lane.
#[inline(always)]
pub(super) fn any<const N: usize>(lanes: &Lane<bool, N>) -> bool {
    lanes.iter().fold(false, |any, is_so| any | is_so)
}

/// Farther than this from a plane all lanes agree on which side a point lies, whatever is rounded; in the plane's unit.
const MARGIN: f32 = 1e-3;

/// Cameras under way: where they stand in the frame of a segment, right and forward \[m\].
#[derive(Debug)]
pub(super) struct Cameras<const N: usize> {
    pub(super) offsets: [Lane<f32, N>; 2],
    frustum: Frustum,
    /// The least and the most that a camera's place moves a point towards the inner side of each plane.
    reaches: [[f32; 2]; Frustum::PLANES],
}

impl<const N: usize> Cameras<N> {
    pub(super) fn new(offsets: [Lane<f32, N>; 2], frustum: Frustum) -> Self {
        let mut cameras = Self { offsets, frustum, reaches: [[0.0; 2]; Frustum::PLANES] };
        cameras.reaches = [
            cameras.reach::<0>(),
            cameras.reach::<1>(),
            cameras.reach::<2>(),
            cameras.reach::<3>(),
            cameras.reach::<4>(),
        ];
        cameras
    }

    fn reach<const PLANE: usize>(&self) -> [f32; 2] {
        let [right, forward] = &self.offsets;
        let still = self.frustum.inside::<PLANE>([0.0; 3]);
        let moved = |lane: usize| self.frustum.inside::<PLANE>([-right[lane], 0.0, -forward[lane]]) - still;
        let reach = |[least, most]: [f32; 2], lane| [math::min(least, moved(lane)), math::max(most, moved(lane))];
        (0..N).fold([f32::INFINITY, f32::NEG_INFINITY], reach)
    }

    /// Which part of a segment each camera sees; `None` if none of them sees any.
    #[inline(always)]
    pub(super) fn seen_part(&self, start: [f32; 3], end: [f32; 3]) -> Option<LanePart<N>> {
        let mut part = LanePart { enter: [0.0; N], leave: [1.0; N] };
        let may_be_seen = self.cut::<0>(start, end, &mut part)
            && self.cut::<1>(start, end, &mut part)
            && self.cut::<2>(start, end, &mut part)
            && self.cut::<3>(start, end, &mut part)
            && self.cut::<4>(start, end, &mut part);
        may_be_seen.then_some(part)
    }

    /// Cuts the part at a plane; false if all of it lies on the outer side for all cameras.
    #[inline(always)]
    fn cut<const PLANE: usize>(&self, start: [f32; 3], end: [f32; 3], part: &mut LanePart<N>) -> bool {
        let [least, most] = self.reaches[PLANE];
        let (from, to) = (self.frustum.inside::<PLANE>(start), self.frustum.inside::<PLANE>(end));
        if from + most < -MARGIN && to + most < -MARGIN {
            return false;
        }
        if from + least > MARGIN && to + least > MARGIN {
            return true;
        }
        let [right, forward] = &self.offsets;
        for lane in 0..N {
            let moved = |[x, y, z]: [f32; 3]| self.frustum.inside::<PLANE>([x - right[lane], y, z - forward[lane]]);
            let (from, to) = (moved(start), moved(end));
            let at = from / (from - to);
            let (enter, leave) = (part.enter[lane], part.leave[lane]);
            let later = if (from < 0.0) & (at > enter) { at } else { enter };
            part.enter[lane] = if (from < 0.0) & (to < 0.0) { 2.0 } else { later };
            part.leave[lane] = if (to < 0.0) & (at < leave) { at } else { leave };
        }
        true
    }
}

/// Which part of a segment is left, in shares of the way from its start to its end; none, where `enter` is not below
/// `leave`.
#[derive(Debug)]
pub(super) struct LanePart<const N: usize> {
    pub(super) enter: Lane<f32, N>,
    pub(super) leave: Lane<f32, N>,
}

impl<const N: usize> LanePart<N> {
    /// In which lanes anything is left.
    #[inline(always)]
    pub(super) fn is_left(&self) -> Lane<bool, N> {
        core::array::from_fn(|lane| self.enter[lane] < self.leave[lane])
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

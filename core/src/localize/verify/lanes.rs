//! One model segment as seen from many poses at a time: a lane for each pose, the same steps in each.
//!
//! Written so that a compiler turns every loop over the lanes into vector instructions, and into plain ones where there is
//! one lane; lanes do not know of each other, so the number of poses under way changes nothing.

use super::channel::CHANNELS;
use super::distance_planes::{COLUMNS, PLANE, ROWS};
use super::responses::{ResponseTable, step_of};
use crate::matching::Body;

/// Poses under way at a time: what fills the vectors of the machine. One without vectors takes one pose after the other,
/// and is spared what that one does not see.
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

/// The nearest integer of a number within `[-0.25, 2^22]`, 0 or -1 below down to -0.5; of any other, some integer.
#[inline(always)]
pub(super) fn rounded(number: f32) -> i32 {
    (number + ROUNDER).to_bits().wrapping_sub(ROUNDER.to_bits()) as i32
}

/// Whether it is so in any lane.
#[inline(always)]
pub(super) fn any<const N: usize>(lanes: &Lane<bool, N>) -> bool {
    lanes.iter().fold(false, |any, is_so| any | is_so)
}

/// Tables that lanes look things up in.
#[derive(Debug)]
pub(super) struct Tables<'t> {
    /// The distances of all channels, pixel by pixel.
    pub(super) planes: &'t [u8; CHANNELS * PLANE],
    pub(super) responses: &'t ResponseTable,
}

impl Tables<'_> {
    /// The sum of responses at `count` points in a channel, from `first` on and `step` apart, in plane pixels.
    #[inline(always)]
    pub(super) fn sum<const N: usize>(
        &self,
        body: impl Body,
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
                let column = rounded(x[lane] - 0.5).clamp(0, COLUMNS as i32 - 1) as u32;
                let row = rounded(y[lane] - 0.5).clamp(0, ROWS as i32 - 1) as u32;
                at[lane] = (row * COLUMNS as u32 + column) * CHANNELS as u32 + channel[lane];
                x[lane] += step[0][lane];
                y[lane] += step[1][lane];
            }
            let mut steps = body.bytes_at(self.planes.as_chunks().0, &at);
            for lane in 0..N {
                steps[lane] = step_of(steps[lane], width[lane] & 3);
            }
            let responses = body.bytes_of_few(self.responses, &steps);
            for lane in 0..N {
                sum[lane] += responses[lane] as i32;
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::{Work, run};
    use std::vec;

    /// The sum of the responses at one point of the first channel.
    struct At<'a>(&'a Tables<'a>, [f32; 2]);

    impl Work for At<'_> {
        type Output = i32;

        fn run<B: Body>(self, body: B) -> i32 {
            let Self(tables, [x, y]) = self;
            let [sum] = tables.sum(body, 1, ([[x], [y]], [[0.0]; 2]), &[0], &[0]);
            sum
        }
    }

    #[test]
    fn points_at_a_border_are_looked_up_in_the_pixel_there() {
        let mut planes = vec![u8::MAX; CHANNELS * PLANE];
        let corners = [0, COLUMNS - 1, (ROWS - 1) * COLUMNS, ROWS * COLUMNS - 1];
        for (distance, corner) in corners.into_iter().enumerate() {
            planes[corner * CHANNELS] = distance as u8;
        }
        let planes: &[u8; CHANNELS * PLANE] = planes.as_slice().try_into().expect("all of them");
        let mut responses = ResponseTable::default();
        for (step, response) in responses.as_flattened_mut().iter_mut().enumerate() {
            *response = step as u8 + 1;
        }
        let tables = Tables { planes, responses: &responses };
        let (columns, rows) = (COLUMNS as f32, ROWS as f32);
        for near in [-1e-6, 0.0, 0.1, 0.24, 0.26, 0.99] {
            let at = |x, y| run(At(&tables, [x, y]));
            assert_eq!(at(near, near), 1, "{near} from the upper left");
            assert_eq!(at(columns - near, near), 5, "{near} from the upper right");
            assert_eq!(at(near, rows - near), 9, "{near} from the lower left");
            assert_eq!(at(columns - near, rows - near), 13, "{near} from the lower right");
        }
    }
}

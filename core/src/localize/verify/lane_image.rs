//! The images of one model segment for several cameras, a lane each.

use super::cameras::SeenPart;
use super::image_frame::ImageFrame;
use super::lanes::Lane;
use crate::localize::segment_filter::SegmentFilter;

/// The images of the parts that are seen; where none is, they mean nothing.
#[derive(Debug)]
pub(super) struct LaneImage<const N: usize> {
    /// Where they start, column and row \[px\].
    pub(super) start: [Lane<f32, N>; 2],
    /// From there to their ends.
    pub(super) way: [Lane<f32, N>; 2],
    /// Length where the segment is in view, long enough and not near-horizontal, else 0.
    pub(super) seen_px: Lane<f32, N>,
    /// In the middle \[1/m\].
    pub(super) inverse_depth: Lane<f32, N>,
}

impl<const N: usize> LaneImage<N> {
    const EMPTY: Self = Self { start: [[0.0; N]; 2], way: [[0.0; N]; 2], seen_px: [0.0; N], inverse_depth: [0.0; N] };

    /// Of the segment between two points, for cameras at `offsets` (right, forward) which see a `part` of it.
    #[inline(always)]
    pub(super) fn of(
        ([start_x, start_y, start_z], [end_x, end_y, end_z]): ([f32; 3], [f32; 3]),
        [right, forward]: &[Lane<f32, N>; 2],
        part: &SeenPart<N>,
        (frame, filter): (&ImageFrame, &SegmentFilter),
    ) -> Self {
        let mut image = Self::EMPTY;
        for lane in 0..N {
            let (x, z) = (start_x - right[lane], start_z - forward[lane]);
            let (way_x, way_y, way_z) = ((end_x - right[lane]) - x, end_y - start_y, (end_z - forward[lane]) - z);
            let (from, to) = (part.enter[lane], part.leave[lane]);
            let start_inverse = 1.0 / (z + way_z * from);
            let end_inverse = 1.0 / (z + way_z * to);
            let (start_scale, end_scale) = (frame.focal_px * start_inverse, frame.focal_px * end_inverse);
            let image_start = [(x + way_x * from) * start_scale, (start_y + way_y * from) * start_scale];
            let image_end = [(x + way_x * to) * end_scale, (start_y + way_y * to) * end_scale];
            for axis in 0..2 {
                image.start[axis][lane] = frame.center_px[axis] + image_start[axis];
                image.way[axis][lane] = image_end[axis] - image_start[axis];
            }
            let (width, height) = (magnitude(image.way[0][lane]), magnitude(image.way[1][lane]));
            let length_px = octagonal_length(width, height);
            let is_seen =
                (from < to) & (length_px >= filter.min_length_px) & (height >= filter.horizontal_slope * width);
            image.seen_px[lane] = if is_seen { length_px } else { 0.0 };
            image.inverse_depth[lane] = 0.5 * (start_inverse + end_inverse);
        }
        image
    }

    /// Whether the segment is seen in any lane.
    #[inline(always)]
    pub(super) fn is_any_seen(&self) -> bool {
        self.seen_px.iter().fold(false, |any, length_px| any | (*length_px > 0.0))
    }
}

/// Magnitude of a number, without a call.
#[inline(always)]
fn magnitude(x: f32) -> f32 {
    if x < 0.0 { -x } else { x }
}

/// Length of a vector by its sides' magnitudes, within 1.3 %: no square root.
#[inline(always)]
fn octagonal_length(width: f32, height: f32) -> f32 {
    let (long, short) = if width > height { (width, height) } else { (height, width) };
    let (flat, steep) = (0.99 * long + 0.197 * short, 0.84 * long + 0.561 * short);
    if steep > flat { steep } else { flat }
}

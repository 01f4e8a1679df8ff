//! A node's model turned to a heading: the part of it that a camera near the node can see.

use crate::database::Node;
use crate::geometry::Point3;
use crate::matching::{Body, Work, run};
use crate::math;
use zerocopy::{FromBytes, Immutable, IntoBytes};

/// A model segment in the camera frame of the node: x right, y down, z forward \[m\].
#[derive(Debug, Clone, Copy, PartialEq, Default, FromBytes, IntoBytes, Immutable)]
#[repr(C)]
pub(super) struct ViewSegment {
    pub(super) start: [f32; 3],
    pub(super) end: [f32; 3],
    /// Length of its image from the middle of the poses that are to be checked, roughly \[px\].
    pub(super) extent_px: f32,
}

impl ViewSegment {
    /// Measures the extent from `center_m` (right, forward).
    pub(super) fn measure(&mut self, center_m: [f32; 2], focal_px: f32) {
        let ([start_x, start_y, start_z], [end_x, end_y, end_z]) = (self.start, self.end);
        let away = math::length(0.5 * (start_x + end_x) - center_m[0], 0.5 * (start_z + end_z) - center_m[1]);
        let across = math::max(math::abs(end_x - start_x), math::abs(end_y - start_y));
        self.extent_px = focal_px * math::max(across, 0.5 * math::abs(end_z - start_z)) / math::max(away, 0.3);
    }
}

/// Turns the node's segments to the heading given by its sine and cosine and puts those into `storage` that a camera
/// within `reach_m` of `center_m` (in the camera frame: right, forward) may see between the slopes of its left and right
/// border; as many as there is room for. Returns their number.
pub(super) fn turn_model(
    node: &Node<'_>,
    sin_cos: (f32, f32),
    sides: [f32; 2],
    (center_m, reach_m): ([f32; 2], f32),
    storage: &mut [ViewSegment],
) -> usize {
    run(Turn { node, sin_cos, sides, center_m, reach_m, storage })
}

/// [`turn_model`] as work for any machine.
struct Turn<'a, 'm> {
    node: &'a Node<'m>,
    sin_cos: (f32, f32),
    sides: [f32; 2],
    center_m: [f32; 2],
    reach_m: f32,
    storage: &'a mut [ViewSegment],
}

impl Work for Turn<'_, '_> {
    type Output = usize;

    #[inline(always)]
    fn run<B: Body>(self, _: B) -> usize {
        let Self { node, sin_cos: (sin, cos), sides: [left, right], center_m, reach_m, storage } = self;
        let mut count = 0;
        let turned = |p: Point3| [p.x * sin - p.y * cos, -p.z, p.x * cos + p.y * sin];
        for segment in node.segments() {
            let (start, end) = (turned(segment.start), turned(segment.end));
            let farthest = math::max(start[2], end[2]) - center_m[1] + reach_m;
            let leftmost = math::min(start[0], end[0]) - center_m[0] - reach_m;
            let rightmost = math::max(start[0], end[0]) - center_m[0] + reach_m;
            let may_be_seen = (farthest > 0.0) & (leftmost < right * farthest) & (rightmost > -left * farthest);
            // Which will be seen no processor guesses: all are written, and those that count stay.
            let Some(place) = storage.get_mut(count) else { break };
            *place = ViewSegment { start, end, extent_px: 0.0 };
            count += usize::from(may_be_seen);
        }
        count
    }
}

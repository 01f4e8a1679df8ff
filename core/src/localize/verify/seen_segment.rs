//! A segment of a look as it is kept until the end of the attempt.

use super::image_frame::ImageFrame;
use crate::geometry::{Point2, Segment2};
use crate::localize::segment_filter::SegmentFilter;
use crate::math;
use zerocopy::{FromBytes, Immutable, IntoBytes};

/// End points in the normal image of 640 x 480 px, in Q4.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, FromBytes, IntoBytes, Immutable)]
#[repr(C)]
pub(super) struct SeenSegment {
    pub(super) start_q4: [i16; 2],
    pub(super) end_q4: [i16; 2],
}

impl SeenSegment {
    pub(super) fn new(segment: &Segment2, frame: &ImageFrame) -> Self {
        let q4 = |coordinate: f32| math::round(coordinate * frame.scale * 16.0) as i16;
        Self {
            start_q4: [q4(segment.start().x), q4(segment.start().y)],
            end_q4: [q4(segment.end().x), q4(segment.end().y)],
        }
    }

    /// A segment between two points of the normal image, if `filter` keeps it.
    pub(super) fn predicted(start: Point2, end: Point2, filter: &SegmentFilter) -> Option<Self> {
        let q4 = |point: Point2| [point.x, point.y].map(|coordinate| math::round(coordinate * 16.0) as i16);
        filter.keeps_between(start, end).then(|| Self { start_q4: q4(start), end_q4: q4(end) })
    }

    /// Length in Q4 px.
    pub(super) fn length_q4(&self) -> i32 {
        let (dx, dy) = self.direction_q4();
        math::round(math::length(dx as f32, dy as f32)) as i32
    }

    pub(super) fn direction_q4(&self) -> (i32, i32) {
        (
            i32::from(self.end_q4[0]) - i32::from(self.start_q4[0]),
            i32::from(self.end_q4[1]) - i32::from(self.start_q4[1]),
        )
    }
}

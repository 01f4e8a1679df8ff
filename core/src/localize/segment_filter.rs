//! Which segments take part, of scene and prediction alike.

use super::LocalizerConfig;
use crate::geometry::{Point2, Segment2};
use crate::math;

/// Drops short and near-horizontal segments.
#[derive(Debug, Clone, Copy)]
pub(super) struct SegmentFilter {
    pub(super) min_length_px: f32,
    pub(super) horizontal_slope: f32,
}

impl SegmentFilter {
    pub(super) fn new(config: &LocalizerConfig) -> Self {
        let horizontal_slope = math::tan(config.horizontal_exclusion.radians());
        Self { min_length_px: config.min_length_px, horizontal_slope }
    }

    /// Whether `segment` is long enough and not near-horizontal. An exclusion of zero keeps horizontals.
    pub(super) fn keeps(&self, segment: &Segment2) -> bool {
        self.keeps_between(segment.start(), segment.end())
    }

    /// The same of a segment between two points.
    pub(super) fn keeps_between(&self, start: Point2, end: Point2) -> bool {
        let is_horizontal = math::abs(end.y - start.y) < self.horizontal_slope * math::abs(end.x - start.x);
        start.distance(end) >= self.min_length_px && !is_horizontal
    }
}

//! Which segments take part, of scene and prediction alike.

use super::LocalizerConfig;
use crate::geometry::Segment2;
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
        let (dx, dy) = (segment.end().x - segment.start().x, segment.end().y - segment.start().y);
        let is_horizontal = math::abs(dy) < self.horizontal_slope * math::abs(dx);
        segment.length_px() >= self.min_length_px && !is_horizontal
    }
}

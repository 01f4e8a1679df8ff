//! What the property tests of histograms draw: any shape, and segments that lie badly.

use super::{DistanceKind, PghShape};
use crate::geometry::{Point2, Polarity, Segment2};
use proptest::collection::{SizeRange, vec};
use proptest::prelude::*;
use std::vec::Vec;

/// Any shape that can be served, with few bins as often as with many.
pub(crate) fn any_shape() -> impl Strategy<Value = PghShape> {
    let bins = || prop_oneof![4 => 1..=4_u16, 8 => 5..=64_u16, 1 => 65..=256_u16];
    (bins(), bins(), 0.5..500.0_f32, any::<(bool, bool, bool)>()).prop_map(
        |(distance_bins, angle_bins, width_px, (is_signed, uses_polarity, interpolates_angle))| PghShape {
            distance_bins,
            angle_bins,
            max_distance_px: width_px * f32::from(distance_bins),
            distance: if is_signed { DistanceKind::Signed } else { DistanceKind::Unsigned },
            uses_polarity,
            interpolates_angle,
        },
    )
}

/// Segments anywhere in an image or as far out as they may be, short ones, and such between few points of a grid: parallel
/// and perpendicular, upon each other, and from one border of bins to another.
pub(crate) fn any_segments(count: impl Into<SizeRange>) -> impl Strategy<Value = Vec<Segment2>> {
    let point = |reach: f32| (-reach..=reach, -reach..=reach).prop_map(|(x, y)| Point2::new(x, y));
    let short =
        (point(300.0), point(40.0)).prop_map(|(start, way)| (start, Point2::new(start.x + way.x, start.y + way.y)));
    let at = |step: i8| 40.0 * f32::from(step);
    let on_grid = move || (-4..=4_i8, -4..=4_i8).prop_map(move |(x, y)| Point2::new(at(x), at(y)));
    let farthest = || {
        let end = || prop_oneof![Just(-Segment2::MAX_COORDINATE_PX), Just(0.0), Just(Segment2::MAX_COORDINATE_PX)];
        (end(), end()).prop_map(|(x, y)| Point2::new(x, y))
    };
    let ends = prop_oneof![
        4 => (point(Segment2::MAX_COORDINATE_PX), point(Segment2::MAX_COORDINATE_PX)),
        4 => (point(300.0), point(300.0)),
        4 => short,
        4 => (on_grid(), on_grid()),
        1 => (farthest(), farthest()),
    ];
    let polarity = prop_oneof![Just(Polarity::LeftBrighter), Just(Polarity::RightBrighter)];
    let segment = (ends, polarity)
        .prop_filter_map("no segment", |((start, end), polarity)| Segment2::new(start, end, polarity).ok());
    vec(segment, count)
}

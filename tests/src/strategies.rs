//! What the property tests draw: segments, scenes and histogram shapes, and how many cases they try.

use edgeloc::geometry::{Point2, Polarity, Segment2};
use edgeloc::pgh::{DistanceKind, PghShape};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, RngSeed};
use std::ops::RangeInclusive;

/// `cases` cases, the same ones in every run and on every machine; nothing is written to disk.
#[must_use]
pub fn fixed_cases(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_algorithm: RngAlgorithm::ChaCha,
        rng_seed: RngSeed::Fixed(0x0ed6_e10c),
        failure_persistence: None,
        max_global_rejects: 64 * cases,
        ..ProptestConfig::default()
    }
}

/// Either contrast.
pub fn polarity() -> impl Strategy<Value = Polarity> {
    prop_oneof![Just(Polarity::LeftBrighter), Just(Polarity::RightBrighter)]
}

/// A segment inside a 640 x 480 image, 2 px long or longer, any direction.
pub fn segment() -> impl Strategy<Value = Segment2> {
    let point = || (0.0..640.0_f32, 0.0..480.0_f32).prop_map(|(x, y)| Point2::new(x, y));
    // Most segments of a look are short: half of the draws are.
    let short = (point(), -40.0..40.0_f32, -40.0..40.0_f32).prop_map(|(start, x, y)| {
        (start, Point2::new((start.x + x).clamp(0.0, 640.0), (start.y + y).clamp(0.0, 480.0)))
    });
    let ends = prop_oneof![(point(), point()), short];
    (ends, polarity()).prop_filter_map("at least 2 px long", |((start, end), polarity)| {
        (start.distance(end) >= 2.0).then(|| Segment2::new(start, end, polarity).ok())?
    })
}

/// A segment as the localiser matches it: at least 12 px long, 5 degrees or more from the horizontal.
pub fn matched_segment() -> impl Strategy<Value = Segment2> {
    segment().prop_filter("long enough and not near-horizontal", |segment| {
        let (start, end) = (segment.start(), segment.end());
        segment.length_px() >= 12.0 && (end.y - start.y).abs() > (end.x - start.x).abs() * 0.0875
    })
}

/// A scene of matched segments.
pub fn matched_scene(size: RangeInclusive<usize>) -> impl Strategy<Value = Vec<Segment2>> {
    vec(matched_segment(), size)
}

/// Any shape of 2 to 60 by up to 64 bins with interpolated angles; a single distance bin could be too wide to serve.
pub fn interpolated_shape() -> impl Strategy<Value = PghShape> {
    let distance = prop_oneof![Just(DistanceKind::Signed), Just(DistanceKind::Unsigned)];
    (2..=60_u16, 1..=64_u16, 100.0..800.0_f32, distance, any::<bool>()).prop_map(
        |(distance_bins, angle_bins, max_distance_px, distance, uses_polarity)| PghShape {
            distance_bins,
            angle_bins,
            max_distance_px,
            distance,
            uses_polarity,
            interpolates_angle: true,
        },
    )
}

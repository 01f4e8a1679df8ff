//! Hand-made scenes with the histograms one expects of them.

use super::super::CharacterMap;
use super::*;
use edgeloc::geometry::Polarity;

/// Eight bins of 100 px over +-400 px and eight angle bins of 22.5 degrees.
const SMALL: PghShape = PghShape { distance_bins: 8, angle_bins: 8, ..PghShape::paper() };

/// A vertical reference line, walked downwards in the image, 100 px long, through (320, 240).
const VERTICAL: NaiveSegment = NaiveSegment::new([320.0, 190.0], [320.0, 290.0]);

fn about_the_first(shape: &PghShape, segments: &[NaiveSegment]) -> Histogram {
    histogram(shape, segments, 0)
}

#[track_caller]
fn assert_map(histogram: &Histogram, expected: &[&str]) {
    let drawn = CharacterMap(histogram).to_string();
    let rows: Vec<&str> = drawn.lines().collect();
    assert_eq!(rows, expected, "the histogram is\n{drawn}");
}

#[track_caller]
fn assert_close(a: &Histogram, b: &Histogram) {
    let worst = a.masses.iter().zip(&b.masses).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-9, "differ by {worst}:\n{}\n{}", CharacterMap(a), CharacterMap(b));
}

#[test]
fn a_parallel_line_fills_one_bin_of_angle_zero() {
    // 150 px to the left: about a line walked downwards, the normal (-sin 90, cos 90) points to -x.
    let parallel = NaiveSegment::new([170.0, 100.0], [170.0, 350.0]);
    let histogram = about_the_first(&SMALL, &[VERTICAL, parallel]);
    let expected = [
        "  0 |     @  |",
        "  1 |        |",
        "  2 |        |",
        "  3 |        |",
        "  4 |        |",
        "  5 |        |",
        "  6 |        |",
        "  7 |        |",
    ];
    assert_map(&histogram, &expected);
    assert!((histogram.mass(5, 0) - 250.0).abs() < 1e-9);
}

#[test]
fn a_line_on_a_bin_border_is_shared_by_both_sides_of_the_border() {
    let parallel = NaiveSegment::new([220.0, 100.0], [220.0, 350.0]);
    let histogram = about_the_first(&SMALL, &[VERTICAL, parallel]);
    assert!((histogram.mass(4, 0) - 125.0).abs() < 1e-9 && (histogram.mass(5, 0) - 125.0).abs() < 1e-9);
}

#[test]
fn perpendicular_pair_fills_the_middle_angle_bin() {
    let perpendicular = NaiveSegment::new([370.0, 240.0], [570.0, 240.0]);
    let histogram = about_the_first(&SMALL, &[VERTICAL, perpendicular]);
    // From 50 to 250 px on the right: half of one bin, a whole one, half of a third.
    let expected = [
        "  0 |        |",
        "  1 |        |",
        "  2 |        |",
        "  3 |        |",
        "  4 | +@+    |",
        "  5 |        |",
        "  6 |        |",
        "  7 |        |",
    ];
    assert_map(&histogram, &expected);
    assert!((histogram.mass(1, 4) - 50.0).abs() < 1e-9 && (histogram.mass(2, 4) - 100.0).abs() < 1e-9);
}

#[test]
fn with_polarity_opposite_contrasts_are_half_a_turn_apart() {
    let shape = PghShape { uses_polarity: true, ..SMALL };
    let parallel = NaiveSegment::new([170.0, 100.0], [170.0, 350.0]);
    let opposite = NaiveSegment { polarity: Polarity::RightBrighter, ..parallel };
    assert!((about_the_first(&shape, &[VERTICAL, parallel]).mass(5, 0) - 250.0).abs() < 1e-9);
    assert!((about_the_first(&shape, &[VERTICAL, opposite]).mass(5, 4) - 250.0).abs() < 1e-9);
    // Seen from the line of opposite contrast, the other side is the positive one as well.
    assert!((about_the_first(&shape, &[opposite, VERTICAL]).mass(5, 4) - 100.0).abs() < 1e-9);
}

#[test]
fn a_crossing_segment_fills_both_unsigned_sides_from_zero() {
    let shape = PghShape { distance: DistanceKind::Unsigned, ..SMALL };
    // 100 px on one side, 200 px on the other, in bins of 50 px.
    let crossing = NaiveSegment::new([220.0, 240.0], [520.0, 240.0]);
    let histogram = about_the_first(&shape, &[VERTICAL, crossing]);
    let expected = [
        "  0 |        |",
        "  1 |        |",
        "  2 |        |",
        "  3 |        |",
        "  4 |@@++    |",
        "  5 |        |",
        "  6 |        |",
        "  7 |        |",
    ];
    assert_map(&histogram, &expected);
    assert!((histogram.mass(0, 4) - 100.0).abs() < 1e-9 && (histogram.total() - 300.0).abs() < 1e-9);
}

#[test]
fn mass_beyond_the_greatest_distance_is_cut() {
    let long = NaiveSegment::new([320.0, 240.0], [920.0, 240.0]);
    assert!((about_the_first(&SMALL, &[VERTICAL, long]).total() - 400.0).abs() < 1e-9);
}

#[test]
fn an_angle_between_two_centres_is_shared_linearly() {
    // A quarter of a bin past 90 degrees: 90 + 22.5 / 4.
    let tilt = (22.5_f64 / 4.0).to_radians();
    let tilted = NaiveSegment::new([420.0, 240.0], [420.0 + 100.0 * tilt.cos(), 240.0 + 100.0 * tilt.sin()]);
    let histogram = about_the_first(&SMALL, &[VERTICAL, tilted]);
    let column = |angle: usize| (0..8).map(|distance| histogram.mass(distance, angle)).sum::<f64>();
    assert!((column(4) - 75.0).abs() < 1e-9 && (column(5) - 25.0).abs() < 1e-9);
    let hard = about_the_first(&PghShape { interpolates_angle: false, ..SMALL }, &[VERTICAL, tilted]);
    assert!((0..8).map(|distance| hard.mass(distance, 4)).sum::<f64>() > 100.0 - 1e-9);
}

#[test]
fn an_angle_just_below_the_period_wraps_into_bin_zero() {
    let leaning = NaiveSegment::new([221.0, 140.0], [220.0, 340.0]);
    let reversed = NaiveSegment::new([220.0, 140.0], [221.0, 340.0]);
    for segment in [leaning, reversed] {
        let histogram = about_the_first(&SMALL, &[VERTICAL, segment]);
        let at_zero: f64 = (0..8).map(|distance| histogram.mass(distance, 0)).sum();
        assert!(at_zero > 0.97 * histogram.total(), "{}", CharacterMap(&histogram));
    }
}

#[test]
fn a_segment_in_two_fragments_gives_the_same_histogram() {
    let (start, end) = ([100.0, 80.0], [500.0, 300.0]);
    let cut = [start[0] + 0.3 * (end[0] - start[0]), start[1] + 0.3 * (end[1] - start[1])];
    for distance in [DistanceKind::Signed, DistanceKind::Unsigned] {
        let shape = PghShape { distance, ..SMALL };
        let whole = about_the_first(&shape, &[VERTICAL, NaiveSegment::new(start, end)]);
        let fragments =
            about_the_first(&shape, &[VERTICAL, NaiveSegment::new(start, cut), NaiveSegment::new(end, cut)]);
        assert_close(&whole, &fragments);
    }
}

#[test]
fn a_lone_segment_has_an_empty_histogram() {
    let histogram = about_the_first(&SMALL, &[VERTICAL]).normalized();
    assert!(histogram.masses.iter().all(|&mass| mass.abs() < f64::MIN_POSITIVE));
}

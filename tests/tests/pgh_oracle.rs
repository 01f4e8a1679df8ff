//! The fixed-point histograms against their naive twin.
//!
//! What differs is the rounding of coordinates to 1/16 px, of directions to 1/65,536 of a period and of masses to
//! 1/128 px. It moves a little mass over a bin border here and there, so bins are compared as masses; a coefficient sees
//! square roots, which magnify slivers: there the worst case is far from the typical one, and both are bounded.

use edgeloc::geometry::{Point2, Polarity, Segment2};
use edgeloc::pgh::{DistanceKind, HistogramBuilder, LineBlock, PghShape};
use edgeloc_tests::matcher::lines;
use edgeloc_tests::oracle::{self, CharacterMap, Histogram, NaiveSegment, bhattacharyya_coefficient};
use edgeloc_tests::strategies::{fixed_cases, interpolated_shape, matched_scene, segment};
use proptest::collection::vec;
use proptest::prelude::*;

/// Greatest share of a histogram's mass that rounding may move; the worst of the cases below is 0.0077.
const MOVED_MASS: f64 = 0.01;
/// Greatest error of a coefficient; the worst of the cases below is 0.0069.
const COEFFICIENT_ERROR: f64 = 0.01;
/// Greatest mean error of the coefficients within a scene of ten or more; the worst of the cases below is 1.8e-4.
const MEAN_COEFFICIENT_ERROR: f64 = 2.5e-4;

/// The fast histogram of each segment, squared back from its root form.
fn fast_histograms(shape: &PghShape, segments: &[Segment2]) -> Vec<Histogram> {
    let lines = lines(shape, segments);
    let mut memory = vec![0; HistogramBuilder::memory_len(shape)];
    let mut blocks = vec![LineBlock::EMPTY; LineBlock::count_for(lines.len())];
    let mut builder = HistogramBuilder::new(shape, &mut memory, &mut blocks).expect("memory of the length asked for");
    builder.load(&lines).expect("as many lines as there is room for");
    let (distance_bins, angle_bins) = (usize::from(shape.distance_bins), usize::from(shape.angle_bins));
    let histogram_about = |reference: usize| {
        let mut masses = vec![0.0; shape.bin_count()];
        let mut last_index = None;
        builder.build(&lines[reference], reference, |index, roots| {
            assert!(roots.iter().all(|root| *root >= 0) && roots != [0; 2], "a pair holds something: {roots:?}");
            assert!(last_index < Some(index), "pairs come once and in order");
            last_index = Some(index);
            for (bin, root) in (2 * usize::from(index)..).zip(roots).filter(|(_, root)| *root > 0) {
                masses[bin] = (f64::from(root) / 32_768.0).powi(2);
            }
        });
        Histogram { distance_bins, angle_bins, masses }
    };
    (0..lines.len()).map(histogram_about).collect()
}

fn naive_histograms(shape: &PghShape, segments: &[Segment2]) -> Vec<Histogram> {
    let segments: Vec<NaiveSegment> = segments.iter().map(NaiveSegment::from).collect();
    oracle::scene_histograms(shape, &segments)
}

/// The share of mass that lies in another bin.
fn moved_mass(a: &Histogram, b: &Histogram) -> f64 {
    0.5 * a.masses.iter().zip(&b.masses).map(|(a, b)| (a - b).abs()).sum::<f64>()
}

fn check_masses(shape: &PghShape, segments: &[Segment2]) -> Result<(), TestCaseError> {
    let (fast, naive) = (fast_histograms(shape, segments), naive_histograms(shape, segments));
    for (fast, naive) in fast.iter().zip(&naive) {
        let moved = moved_mass(fast, naive);
        prop_assert!(moved < MOVED_MASS, "{moved} moved:\n{}\n{}", CharacterMap(fast), CharacterMap(naive));
        // All of the mass is there (within rounding of the roots), or none where none is within reach.
        let total = fast.total();
        prop_assert!((total - naive.total()).abs() < 5.0e-4, "the shares sum to {total}, not {}", naive.total());
    }
    Ok(())
}

fn squares(width: u16) -> PghShape {
    PghShape { distance_bins: width, angle_bins: width, ..PghShape::paper() }
}

/// How far the nearest relative angle of two segments is from a border between angle bins, in bins.
fn nearest_border(shape: &PghShape, segments: &[Segment2]) -> f64 {
    let period = f64::from(shape.period_radians());
    let directions: Vec<f64> =
        segments.iter().map(|segment| NaiveSegment::from(segment).direction(shape.uses_polarity)).collect();
    let pairs = directions.iter().flat_map(|a| directions.iter().map(move |b| a - b));
    pairs
        .map(|angle| (angle / period * f64::from(shape.angle_bins) - 0.5).rem_euclid(1.0))
        .map(|past| past.min(1.0 - past))
        .fold(0.5, f64::min)
}

proptest! {
    #![proptest_config(fixed_cases(300))]

    #[test]
    fn every_bin_agrees_for_any_shape(shape in interpolated_shape(), segments in matched_scene(0..=40)) {
        check_masses(&shape, &segments)?;
    }

    #[test]
    fn every_bin_agrees_without_interpolation_unless_an_angle_is_on_a_border(
        shape in interpolated_shape(),
        segments in matched_scene(2..=8),
    ) {
        let shape = PghShape { interpolates_angle: false, ..shape };
        prop_assume!(nearest_border(&shape, &segments) > 2.0e-3);
        check_masses(&shape, &segments)?;
    }

    #[test]
    fn coefficients_agree(
        uses_polarity in any::<bool>(),
        is_signed in any::<bool>(),
        segments in matched_scene(10..=40),
    ) {
        let distance = if is_signed { DistanceKind::Signed } else { DistanceKind::Unsigned };
        let shape = PghShape { uses_polarity, distance, ..PghShape::paper() };
        let (fast, naive) = (fast_histograms(&shape, &segments), naive_histograms(&shape, &segments));
        let mut errors = Vec::new();
        for (fast_a, naive_a) in fast.iter().zip(&naive) {
            for (fast_b, naive_b) in fast.iter().zip(&naive) {
                let (of_fast, of_naive) =
                    (bhattacharyya_coefficient(fast_a, fast_b), bhattacharyya_coefficient(naive_a, naive_b));
                errors.push((of_fast - of_naive).abs());
            }
        }
        let (mean, worst) =
            (errors.iter().sum::<f64>() / errors.len() as f64, errors.iter().copied().fold(0.0, f64::max));
        prop_assert!(mean < MEAN_COEFFICIENT_ERROR && worst < COEFFICIENT_ERROR, "mean {mean}, worst {worst}");
    }

    #[test]
    fn swapping_a_segments_end_points_together_with_its_polarity_changes_nothing(
        shape in interpolated_shape(),
        segments in vec(segment(), 2..20),
    ) {
        let reversed: Vec<Segment2> = segments.iter().map(Segment2::reversed).collect();
        prop_assert_eq!(fast_histograms(&shape, &segments), fast_histograms(&shape, &reversed));
    }

    #[test]
    fn without_polarity_the_contrast_changes_nothing(segments in vec(segment(), 2..20)) {
        let shape = PghShape::paper();
        let flipped: Vec<Segment2> = segments
            .iter()
            .map(|segment| {
                Segment2::new(segment.start(), segment.end(), segment.polarity().flipped()).expect("as it was")
            })
            .collect();
        prop_assert_eq!(fast_histograms(&shape, &segments), fast_histograms(&shape, &flipped));
    }

    #[test]
    fn a_histogram_holds_the_same_mass_in_any_order_of_the_segments(segments in matched_scene(2..=20)) {
        let backwards: Vec<Segment2> = segments.iter().rev().copied().collect();
        let mut of_backwards = fast_histograms(&PghShape::paper(), &backwards);
        of_backwards.reverse();
        prop_assert_eq!(fast_histograms(&PghShape::paper(), &segments), of_backwards);
    }
}

#[test]
fn hand_made_scenes_agree_in_every_option() {
    let segment = |start: (f32, f32), end: (f32, f32), polarity| {
        Segment2::new(Point2::new(start.0, start.1), Point2::new(end.0, end.1), polarity).expect("valid")
    };
    let segments = [
        segment((320.0, 140.0), (320.0, 340.0), Polarity::LeftBrighter),
        segment((420.0, 140.0), (420.0, 340.0), Polarity::RightBrighter),
        segment((300.0, 220.0), (500.0, 260.0), Polarity::LeftBrighter),
        segment((10.0, 470.0), (90.0, 390.0), Polarity::RightBrighter),
    ];
    for distance in [DistanceKind::Signed, DistanceKind::Unsigned] {
        for uses_polarity in [false, true] {
            for interpolates_angle in [false, true] {
                for bins in [1, 2, 15, 32, 64] {
                    let shape = PghShape { distance, uses_polarity, interpolates_angle, ..squares(bins) };
                    check_masses(&shape, &segments).expect("the histograms agree");
                }
            }
        }
    }
}

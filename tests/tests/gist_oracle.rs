//! The gist of a view against its naive twin: layout, code, and the scan of all rows.

use edgeloc::geometry::PinholeCamera;
use edgeloc::gist::{AXES, FEATURES, Projection, add_similarities, edge_layout};
use edgeloc_tests::oracle::gist;
use edgeloc_tests::strategies::{fixed_cases, segment};
use proptest::collection::vec;
use proptest::prelude::*;
use zerocopy::little_endian::I16;

proptest! {
    #![proptest_config(fixed_cases(100))]

    #[test]
    fn layouts_are_roots_of_lengths(segments in vec(segment(), 0..120)) {
        let layout = edge_layout(&PinholeCamera::reference(), segments.iter().copied());
        let exact = gist::edge_lengths(&segments);
        for (index, (root, exact)) in layout.iter().zip(&exact).enumerate() {
            let length = (f64::from(*root) / 64.0).powi(2);
            // Points 12 px apart, shares of 1/256.
            let error = (length - exact).abs();
            prop_assert!(error <= 1.5 + 0.05 * exact, "{index}: {length} for {exact}");
        }
        let (sum, exact): (f64, f64) =
            (layout.iter().map(|root| (f64::from(*root) / 64.0).powi(2)).sum(), exact.iter().sum());
        prop_assert!((sum - exact).abs() <= 5.0 + 0.02 * exact, "{sum} for {exact}");
    }

    #[test]
    fn codes_are_projections(
        layout in vec(0..4000_i16, FEATURES),
        mean in vec(0..500_i16, FEATURES),
        axes in vec(vec(-8191..=8191_i16, FEATURES), AXES),
    ) {
        let written = |numbers: &[i16]| -> [I16; FEATURES] { core::array::from_fn(|index| I16::new(numbers[index])) };
        let (fast_mean, fast_axes): (_, [[I16; FEATURES]; AXES]) =
            (written(&mean), core::array::from_fn(|axis| written(&axes[axis])));
        let projection = Projection { mean: &fast_mean, axes: &fast_axes };
        let code = projection.code(&core::array::from_fn(|index| layout[index]));
        for (fast, exact) in code.iter().zip(gist::code(&layout, &mean, &axes)) {
            prop_assert!((f64::from(*fast) - exact).abs() <= 0.6, "{fast} for {exact}");
        }
    }

    #[test]
    fn similarities_are_dot_products(
        code in vec(any::<i8>(), AXES),
        rows in vec(vec(vec(any::<i8>(), AXES), 0..40), 0..4),
        sums in vec(-8000..8000_i16, 0..40),
    ) {
        let array = |numbers: &Vec<i8>| -> [i8; AXES] { core::array::from_fn(|index| numbers[index]) };
        let sectors: Vec<Vec<[i8; AXES]>> = rows.iter().map(|rows| rows.iter().map(array).collect()).collect();
        let slices: Vec<&[[i8; AXES]]> = sectors.iter().map(Vec::as_slice).collect();
        let mut fast = sums.clone();
        add_similarities(&array(&code), &slices, &mut fast);
        for (index, (fast, before)) in fast.iter().zip(&sums).enumerate() {
            let of_first = sectors.first().and_then(|rows| rows.get(index));
            let best = sectors.iter().filter_map(|rows| rows.get(index)).map(|row| gist::similarity(&code, row)).max();
            let expected = of_first.and(best).map_or(*before, |best| before.saturating_add(best));
            prop_assert_eq!(*fast, expected);
        }
    }
}

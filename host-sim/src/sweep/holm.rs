//! Many comparisons at once: Holm's step-down correction of p-values (Holm 1979).
//!
//! The corrected values may be held against 0.05 one by one: the probability of even one false alarm among all
//! comparisons then stays below 5 %, whatever the dependence between them. And there is dependence: every setting of a
//! study is compared with the same default on the same trials.

/// The p-values of a family of comparisons, corrected, in their order; a comparison without a value stays without.
#[must_use]
pub fn holm(p_values: &[Option<f64>]) -> Vec<Option<f64>> {
    let mut order: Vec<usize> = (0..p_values.len()).filter(|&index| p_values[index].is_some()).collect();
    order.sort_by(|&a, &b| p_values[a].unwrap_or(1.0).total_cmp(&p_values[b].unwrap_or(1.0)));
    let mut corrected = vec![None; p_values.len()];
    let mut largest: f64 = 0.0;
    for (rank, &index) in order.iter().enumerate() {
        let still_open = (order.len() - rank) as f64;
        largest = largest.max(p_values[index].unwrap_or(1.0) * still_open).min(1.0);
        corrected[index] = Some(largest);
    }
    corrected
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corrected_values_are_those_of_the_definition() {
        // R: p.adjust(c(0.01, 0.04, 0.03, 0.005), "holm")
        let corrected = holm(&[Some(0.01), Some(0.04), None, Some(0.03), Some(0.005)]);
        for (ours, expected) in corrected.iter().zip([Some(0.03), Some(0.06), None, Some(0.06), Some(0.02)]) {
            assert_eq!(ours.is_some(), expected.is_some());
            assert!((ours.unwrap_or(0.0) - expected.unwrap_or(0.0)).abs() < 1e-12, "{corrected:?}");
        }
    }

    #[test]
    fn no_value_grows_beyond_certainty() {
        assert_eq!(holm(&[Some(0.9), Some(1.0)]), [Some(1.0), Some(1.0)]);
        assert!(holm(&[]).is_empty());
    }
}

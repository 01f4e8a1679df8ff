//! Rates over several worlds: trials of one world are more alike than trials of two, so the worlds are what is counted.

use super::QUANTILE_975;

/// The mean of the rates of worlds and its 95 % interval over worlds like these; `None` without worlds.
///
/// The interval is Student's of the rates themselves, one a world (cluster-level analysis: Donner and Klar 2000, *Design
/// and Analysis of Cluster Randomization Trials in Health Research*, chapter 6): it holds for few worlds, where sandwich
/// estimates are too narrow. It is cut at 0 and 1; of one world nothing can be said, and it is all of 0 to 1.
#[must_use]
pub fn clustered_interval(rates: &[f64]) -> Option<(f64, (f64, f64))> {
    let count = rates.len() as f64;
    if rates.is_empty() {
        return None;
    }
    let mean = rates.iter().sum::<f64>() / count;
    if rates.len() == 1 {
        return Some((mean, (0.0, 1.0)));
    }
    let squares = rates.iter().map(|rate| (rate - mean) * (rate - mean)).sum::<f64>();
    let error = (squares / (count - 1.0) / count).sqrt();
    let half_width = student_quantile_975(rates.len() - 1) * error;
    Some((mean, ((mean - half_width).max(0.0), (mean + half_width).min(1.0))))
}

/// The 97.5 % quantile of Student's distribution: tabled for few degrees of freedom, by the expansion of Fisher and
/// Cornish (1960) for more, then right to 0.0001.
fn student_quantile_975(degrees: usize) -> f64 {
    const TABLE: [f64; 8] = [12.706_205, 4.302_653, 3.182_446, 2.776_445, 2.570_582, 2.446_912, 2.364_624, 2.306_004];
    if let Some(&quantile) = degrees.checked_sub(1).and_then(|index| TABLE.get(index)) {
        return quantile;
    }
    let (z, n) = (QUANTILE_975, degrees as f64);
    let (z2, z3) = (z * z, z * z * z);
    let first = (z3 + z) / 4.0;
    let second = z * (5.0 * z2 * z2 + 16.0 * z2 + 3.0) / 96.0;
    let third = z * (3.0 * z2 * z2 * z2 + 19.0 * z2 * z2 + 17.0 * z2 - 15.0) / 384.0;
    z + first / n + second / (n * n) + third / (n * n * n)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `scipy.stats.t.ppf(0.975, n)`.
    #[test]
    fn quantiles_equal_those_of_scipy() {
        for (degrees, expected) in
            [(1, 12.7062), (4, 2.776_45), (8, 2.3060), (9, 2.262_16), (20, 2.085_96), (100, 1.983_97)]
        {
            assert!((student_quantile_975(degrees) - expected).abs() < 1e-3, "{degrees}");
        }
    }

    #[test]
    fn the_interval_is_of_the_worlds_not_of_their_trials() {
        let (mean, (low, high)) = clustered_interval(&[0.998, 0.983, 0.979, 0.996, 0.994]).expect("worlds");
        // scipy.stats.ttest_1samp(rates, 0).confidence_interval(0.95)
        assert!((mean - 0.99).abs() < 1e-9, "{mean}");
        assert!((low - 0.979_501).abs() < 1e-4 && (high - 1.0).abs() < 1e-9, "{low} {high}");
    }

    #[test]
    fn one_world_says_nothing_of_others_and_none_nothing_at_all() {
        assert_eq!(clustered_interval(&[]), None);
        assert_eq!(clustered_interval(&[0.9]), Some((0.9, (0.0, 1.0))));
    }
}

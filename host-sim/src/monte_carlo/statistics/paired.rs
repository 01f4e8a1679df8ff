//! Two settings compared: the exact test of McNemar (1947) on paired trials, and intervals of the difference of two rates.
//!
//! Trials are paired when both settings met the same robot poses. Then only the discordant trials, right under one
//! setting and wrong under the other, tell the two apart. Intervals are Newcombe's (1998), made of Wilson's: they stay
//! within [-1, 1] and hold their level near 0 and 1. A difference is always that of the second setting to the first.

use super::{SuccessRate, success_interval};

/// Paired trials of two settings, A and B, counted by who was right.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PairedCounts {
    /// Both were right.
    pub both: u64,
    /// A was right and B wrong.
    pub only_a: u64,
    /// B was right and A wrong.
    pub only_b: u64,
    /// Both were wrong.
    pub neither: u64,
}

impl PairedCounts {
    /// Counts pairs of successes, A's first.
    #[must_use]
    pub fn of(pairs: impl IntoIterator<Item = (bool, bool)>) -> Self {
        let mut counts = Self::default();
        for pair in pairs {
            *match pair {
                (true, true) => &mut counts.both,
                (true, false) => &mut counts.only_a,
                (false, true) => &mut counts.only_b,
                (false, false) => &mut counts.neither,
            } += 1;
        }
        counts
    }

    /// Pairs.
    #[must_use]
    pub const fn pairs(&self) -> u64 {
        self.both + self.only_a + self.only_b + self.neither
    }

    /// The success rate of A.
    #[must_use]
    pub const fn rate_a(&self) -> SuccessRate {
        SuccessRate { successes: self.both + self.only_a, trials: self.pairs() }
    }

    /// The success rate of B.
    #[must_use]
    pub const fn rate_b(&self) -> SuccessRate {
        SuccessRate { successes: self.both + self.only_b, trials: self.pairs() }
    }

    /// The rate of B less that of A; `None` without pairs.
    #[must_use]
    pub fn difference(&self) -> Option<f64> {
        (self.pairs() > 0).then(|| (self.only_b as f64 - self.only_a as f64) / self.pairs() as f64)
    }

    /// Two-sided exact probability of a split this uneven or more if A and B were equally good: [`mcnemar`].
    #[must_use]
    pub fn mcnemar(&self) -> f64 {
        mcnemar(self.only_a, self.only_b)
    }
}

/// McNemar's exact test: the two-sided probability that `discordant_a + discordant_b` fair coins split this unevenly or
/// more. 1 without discordant pairs.
///
/// Twice the smaller tail of the binomial distribution, at most 1.
#[must_use]
pub fn mcnemar(discordant_a: u64, discordant_b: u64) -> f64 {
    let (fewer, coins) = (discordant_a.min(discordant_b) as f64, discordant_a as f64 + discordant_b as f64);
    // The last term of the tail by logarithms, because 2^-coins underflows; the others by the ratio of neighbours.
    let log_choose = libm::lgamma(coins + 1.0) - libm::lgamma(fewer + 1.0) - libm::lgamma(coins - fewer + 1.0);
    let last = libm::exp(log_choose - coins * core::f64::consts::LN_2);
    let (mut tail, mut term, mut heads) = (last, last, fewer);
    while heads > 0.0 && term > tail * f64::EPSILON {
        term *= heads / (coins - heads + 1.0);
        heads -= 1.0;
        tail += term;
    }
    (2.0 * tail).min(1.0)
}

/// The 95 % interval of the rate of B less that of A in paired trials; `(-1, 1)` without pairs.
///
/// Newcombe 1998 (Statistics in Medicine 17, 2635), method 10: Wilson's intervals of both rates, squared, added and
/// corrected for how the two go together.
#[must_use]
pub fn paired_difference_interval(counts: &PairedCounts) -> (f64, f64) {
    let Some(difference) = counts.difference() else { return (-1.0, 1.0) };
    let (below_a, above_a) = reach(counts.rate_a());
    let (below_b, above_b) = reach(counts.rate_b());
    let phi = correlation(counts);
    let side = |b: f64, a: f64| (b * b - 2.0 * phi * b * a + a * a).max(0.0).sqrt();
    ((difference - side(below_b, above_a)).max(-1.0), (difference + side(above_b, below_a)).min(1.0))
}

/// The 95 % interval of the rate of B less that of A in trials that are not paired; `(-1, 1)` without trials of both.
///
/// Newcombe 1998 (Statistics in Medicine 17, 873), method 10.
#[must_use]
pub fn difference_interval(a: SuccessRate, b: SuccessRate) -> (f64, f64) {
    let (Some(rate_a), Some(rate_b)) = (a.rate(), b.rate()) else { return (-1.0, 1.0) };
    let ((below_a, above_a), (below_b, above_b)) = (reach(a), reach(b));
    let difference = rate_b - rate_a;
    ((difference - libm::hypot(below_b, above_a)).max(-1.0), (difference + libm::hypot(above_b, below_a)).min(1.0))
}

/// How far Wilson's interval reaches below and above a rate of at least one trial.
fn reach(of: SuccessRate) -> (f64, f64) {
    let (rate, (low, high)) = (of.rate().unwrap_or(0.5), success_interval(of.successes, of.trials));
    (rate - low, high - rate)
}

/// The phi coefficient of success under A and under B, lessened where it is positive by a correction for continuity.
fn correlation(counts: &PairedCounts) -> f64 {
    let [both, only_a, only_b, neither] =
        [counts.both, counts.only_a, counts.only_b, counts.neither].map(|count| count as f64);
    let margins = (both + only_a) * (only_b + neither) * (both + only_b) * (only_a + neither);
    let cross = both * neither - only_a * only_b;
    let corrected = if cross > 0.0 { (cross - counts.pairs() as f64 / 2.0).max(0.0) } else { cross };
    if margins > 0.0 { corrected / margins.sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counts([both, only_a, only_b, neither]: [u64; 4]) -> PairedCounts {
        PairedCounts { both, only_a, only_b, neither }
    }

    #[test]
    fn mcnemar_equals_the_sum_of_binomial_coefficients() {
        // 2 sum_k C(n, k) / 2^n in exact fractions, rounded once.
        for (a, b, exact) in [
            (0, 0, 1.0),
            (0, 1, 1.0),
            (0, 5, 0.0625),
            (6, 6, 1.0),
            (2, 12, 0.012_939_453_125),
            (10, 25, 0.016_673_847_800_120_71),
            (30, 60, 0.002_060_265_680_963_076),
            (250, 300, 0.036_578_745_549_102_704),
            (900, 1100, 8.457_089_535_503_927e-6),
        ] {
            for p in [mcnemar(a, b), mcnemar(b, a)] {
                assert!((p / exact - 1.0).abs() < 1e-11, "{a} against {b}: {p}");
            }
        }
    }

    #[test]
    fn mcnemar_stands_a_million_discordant_pairs() {
        assert!((mcnemar(500_000, 500_000) - 1.0).abs() < 1e-12);
        // 2000 of a standard deviation of 1000: the two-sided tail at 2 is 4.55 %, with the correction for continuity.
        assert!((mcnemar(499_000, 501_000) - 0.0456).abs() < 1e-4);
        assert!(mcnemar(0, 1_000_000) < 1e-300);
    }

    #[test]
    fn paired_intervals_are_those_of_newcombe() {
        // The first two are examples of the publication, to its four digits; the others by the same formula in Python.
        for (table, low, high) in [
            ([36, 2, 12, 0], 0.056_929_584, 0.340_427_603),
            ([20, 2, 12, 16], 0.056_156_425, 0.329_206_995),
            ([1, 7, 1, 3], -0.744_593_665, -0.075_821_343),
            ([0, 0, 0, 30], -0.113_513_393, 0.113_513_393),
            ([0, 0, 29, 1], 0.791_529_574, 0.994_091_410),
            ([0, 30, 0, 0], -1.0, -0.839_467_820),
            ([800, 10, 30, 60], 0.008_362_321, 0.036_893_942),
        ] {
            let (ours_low, ours_high) = paired_difference_interval(&counts(table));
            assert!(
                (ours_low - low).abs() < 1e-8 && (ours_high - high).abs() < 1e-8,
                "{table:?}: {ours_low} {ours_high}"
            );
        }
    }

    #[test]
    fn unpaired_intervals_are_those_of_newcombe() {
        let rate = |successes, trials| SuccessRate { successes, trials };
        for (a, b, low, high) in [
            (rate(48, 80), rate(56, 70), 0.052_431_472, 0.333_872_655),
            (rate(3, 10), rate(9, 10), 0.170_522_724, 0.809_017_974),
            (rate(0, 20), rate(10, 10), 0.679_086_037, 1.0),
        ] {
            let (ours_low, ours_high) = difference_interval(a, b);
            assert!(
                (ours_low - low).abs() < 1e-8 && (ours_high - high).abs() < 1e-8,
                "{a} {b}: {ours_low} {ours_high}"
            );
        }
    }

    #[test]
    fn pairs_are_counted_by_who_was_right() {
        let pairs = [(true, true), (true, false), (false, true), (false, true), (false, false)];
        let counted = PairedCounts::of(pairs);
        assert_eq!(counted, counts([1, 1, 2, 1]));
        assert_eq!((counted.rate_a().successes, counted.rate_b().successes, counted.pairs()), (2, 3, 5));
        assert!((counted.difference().expect("pairs") - 0.2).abs() < 1e-12);
        assert_eq!(PairedCounts::default().difference(), None);
    }
}

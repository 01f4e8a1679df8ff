//! Success rates with their 95 % confidence interval (Wilson 1927).
//!
//! Wilson's interval holds its level where rates come close to 0 or 1, where the textbook's does not.

mod clustered;
mod paired;

pub use clustered::clustered_interval;
pub use paired::{PairedCounts, difference_interval, mcnemar, paired_difference_interval};

use serde::{Deserialize, Serialize};
use std::fmt;

/// The 97.5 % quantile of the standard Gaussian.
const QUANTILE_975: f64 = 1.959_963_984_540_054;

/// A counted success rate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct SuccessRate {
    /// Successful trials.
    pub successes: u64,
    /// Trials.
    pub trials: u64,
}

impl SuccessRate {
    /// Counts the successes among outcomes.
    #[must_use]
    pub fn of(outcomes: impl IntoIterator<Item = bool>) -> Self {
        outcomes.into_iter().fold(Self::default(), |rate, is_success| Self {
            successes: rate.successes + u64::from(is_success),
            trials: rate.trials + 1,
        })
    }

    /// Successes per trial; `None` without trials.
    #[must_use]
    pub fn rate(&self) -> Option<f64> {
        (self.trials > 0).then(|| self.successes as f64 / self.trials as f64)
    }

    /// The 95 % interval of the rate, `[0, 1]` without trials.
    #[must_use]
    pub fn success_interval(&self) -> (f64, f64) {
        success_interval(self.successes, self.trials)
    }
}

/// Prints like `93.8 % [92.0, 95.2] (n = 900)`.
impl fmt::Display for SuccessRate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(rate) = self.rate() else { return f.write_str("no trials") };
        let (low, high) = self.success_interval();
        write!(f, "{:.1} % [{:.1}, {:.1}] (n = {})", 100.0 * rate, 100.0 * low, 100.0 * high, self.trials)
    }
}

/// Wilson's 95 % interval of a rate of `successes` in `trials`; `(0, 1)` without trials.
///
/// `successes` above `trials` count as `trials`.
#[must_use]
pub fn success_interval(successes: u64, trials: u64) -> (f64, f64) {
    if trials == 0 {
        return (0.0, 1.0);
    }
    let (n, z2) = (trials as f64, QUANTILE_975 * QUANTILE_975);
    let rate = successes.min(trials) as f64 / n;
    let center = (rate + z2 / (2.0 * n)) / (1.0 + z2 / n);
    let half_width = QUANTILE_975 * (rate * (1.0 - rate) / n + z2 / (4.0 * n * n)).sqrt() / (1.0 + z2 / n);
    // At 0 and 1 the bound is exact; rounding would leave it a hair off.
    let low = if successes == 0 { 0.0 } else { center - half_width };
    let high = if successes >= trials { 1.0 } else { center + half_width };
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `scipy.stats.binomtest(k, n).proportion_ci(0.95, method='wilson')`, SciPy 1.17.1.
    const SCIPY: [(u64, u64, f64, f64); 12] = [
        (0, 1, 0.0, 0.793_450_685_622_762_7),
        (0, 10, 0.0, 0.277_532_799_862_889_26),
        (10, 10, 0.722_467_200_137_110_9, 1.0),
        (1, 1, 0.206_549_314_377_237_45, 1.0),
        (5, 10, 0.236_593_090_512_564, 0.763_406_909_487_436_1),
        (422, 450, 0.911_541_665_870_462_5, 0.956_602_908_280_625_3),
        (844, 900, 0.920_059_649_000_732_7, 0.951_774_666_973_397_5),
        (835, 900, 0.908_986_397_521_985_2, 0.942_932_921_386_746_1),
        (1, 1000, 0.000_176_546_370_626_078_09, 0.005_642_558_597_957_935_5),
        (263, 500, 0.482_201_648_369_495_6, 0.569_401_885_926_503_8),
        (499, 500, 0.988_759_293_294_853_2, 0.999_646_863_605_440_7),
        (50_000, 100_000, 0.496_901_084_359_689_66, 0.503_098_915_640_310_3),
    ];

    #[test]
    fn intervals_equal_those_of_scipy() {
        for (successes, trials, low, high) in SCIPY {
            let (ours_low, ours_high) = success_interval(successes, trials);
            assert!((ours_low - low).abs() < 1e-12 && (ours_high - high).abs() < 1e-12, "{successes} of {trials}");
        }
    }

    #[test]
    fn a_rate_prints_with_its_interval_and_count() {
        assert_eq!(SuccessRate { successes: 844, trials: 900 }.to_string(), "93.8 % [92.0, 95.2] (n = 900)");
        assert_eq!(SuccessRate::default().to_string(), "no trials");
        assert_eq!(SuccessRate::of([true, false, true]), SuccessRate { successes: 2, trials: 3 });
    }

    #[test]
    fn without_trials_every_rate_is_possible() {
        assert_eq!(SuccessRate::default().rate(), None);
        assert_eq!(format!("{:?}", success_interval(0, 0)), "(0.0, 1.0)");
    }
}

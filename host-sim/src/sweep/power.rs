//! How many trials separate two settings, before a single one is run.
//!
//! Two settings with success rates p1 and p2, difference d = p1 - p2. Run on common random numbers they are compared
//! trial by trial: only the discordant pairs speak, those that one setting gets right and the other does not, a share
//! psi of all. McNemar's test at level alpha then finds the difference with probability 1 - beta from
//!
//! ```text
//! n = (z(1 - alpha/2) sqrt(psi) + z(1 - beta) sqrt(psi - d^2))^2 / d^2          pairs (Miettinen 1968)
//! ```
//!
//! and, with trials of their own, the test of two rates from
//!
//! ```text
//! n = (z(1 - alpha/2) sqrt(2 p (1 - p)) + z(1 - beta) sqrt(p1 (1 - p1) + p2 (1 - p2)))^2 / d^2   trials each, p = (p1 + p2) / 2
//! ```
//!
//! psi lies between |d|, when the worse setting never wins a pair, and about p1 (1 - p2) + p2 (1 - p1), when common
//! random numbers help nothing. Both formulas are asymptotic; a test holds them against simulated studies,
//! the first against those of the exact test that is used here.

/// The demands on a comparison: how rarely it may err, how surely it must find.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// Probability of calling equal settings different, alpha, two-sided.
    pub significance: f64,
    /// Probability of finding a difference that is there, 1 - beta.
    pub power: f64,
}

impl Default for Demand {
    /// 95 % confidence, 80 % power.
    fn default() -> Self {
        Self { significance: 0.05, power: 0.8 }
    }
}

impl Demand {
    /// The demand when `comparisons` share the probability of one false alarm (Bonferroni; Holm asks no more).
    #[must_use]
    pub fn shared_by(self, comparisons: usize) -> Self {
        Self { significance: self.significance / comparisons.max(1) as f64, ..self }
    }

    /// Pairs of trials needed by settings of success rates `rates` that disagree in a share `discordance` of them.
    ///
    /// `None` when the rates are equal, for no number of trials separates them.
    #[must_use]
    pub fn pairs_needed(self, rates: (f64, f64), discordance: f64) -> Option<u64> {
        let difference = (rates.0 - rates.1).abs();
        let discordance = discordance.clamp(difference, 1.0);
        let (z_alpha, z_beta) = self.quantiles();
        let root = z_alpha * discordance.sqrt() + z_beta * (discordance - difference * difference).max(0.0).sqrt();
        trials_of(root, difference)
    }

    /// Trials of each of two settings of success rates `rates`, every trial its own.
    ///
    /// `None` when the rates are equal, for no number of trials separates them.
    #[must_use]
    pub fn unpaired_trials_needed(self, rates: (f64, f64)) -> Option<u64> {
        let (difference, mean) = ((rates.0 - rates.1).abs(), f64::midpoint(rates.0, rates.1));
        let (z_alpha, z_beta) = self.quantiles();
        let root = z_alpha * (2.0 * variance(mean)).sqrt() + z_beta * (variance(rates.0) + variance(rates.1)).sqrt();
        trials_of(root, difference)
    }

    /// The least loss from `rate` that `pairs` pairs of trials find when a share `discordance` of them disagrees.
    ///
    /// `None` when even the loss of every success would not be found.
    #[must_use]
    pub fn detectable_loss(self, rate: f64, discordance: Option<f64>, pairs: u64) -> Option<f64> {
        let is_enough = |loss: f64| {
            let rates = (rate, rate - loss);
            let discordance = discordance.unwrap_or_else(|| independent_discordance(rates));
            self.pairs_needed(rates, discordance).is_some_and(|needed| needed <= pairs)
        };
        smallest_from_here_on(rate, is_enough)
    }

    /// The least loss from `rate` that `trials` trials of each of two settings find without pairing.
    ///
    /// `None` when even the loss of every success would not be found.
    #[must_use]
    pub fn detectable_unpaired_loss(self, rate: f64, trials: u64) -> Option<f64> {
        let is_enough =
            |loss: f64| self.unpaired_trials_needed((rate, rate - loss)).is_some_and(|needed| needed <= trials);
        smallest_from_here_on(rate, is_enough)
    }

    fn quantiles(self) -> (f64, f64) {
        (gaussian_quantile(1.0 - self.significance / 2.0), gaussian_quantile(self.power))
    }
}

/// Share of pairs in which exactly one of two settings succeeds when they have nothing in common.
#[must_use]
pub fn independent_discordance((first, second): (f64, f64)) -> f64 {
    first * (1.0 - second) + second * (1.0 - first)
}

fn variance(rate: f64) -> f64 {
    rate * (1.0 - rate)
}

fn trials_of(root: f64, difference: f64) -> Option<u64> {
    let trials = (root / difference).powi(2).ceil();
    // Differences below 1e-9 ask for more trials than can be counted.
    (trials.is_finite() && trials < 1e18).then_some(trials.max(1.0) as u64)
}

/// The least of the losses up to `most` that is enough, to 1e-6, for what is enough stays enough above it.
fn smallest_from_here_on(most: f64, is_enough: impl Fn(f64) -> bool) -> Option<f64> {
    if !is_enough(most) {
        return None;
    }
    let (mut too_little, mut enough) = (0.0, most);
    while enough - too_little > 1e-6 {
        let middle = f64::midpoint(too_little, enough);
        if is_enough(middle) { enough = middle } else { too_little = middle }
    }
    Some(enough)
}

/// The `probability` quantile of the standard Gaussian, to 1e-12, within +-9.
fn gaussian_quantile(probability: f64) -> f64 {
    let below = |z: f64| 0.5 * libm::erfc(-z / core::f64::consts::SQRT_2);
    let (mut low, mut high) = (-9.0, 9.0);
    while high - low > 1e-12 {
        let middle = f64::midpoint(low, high);
        if below(middle) < probability { low = middle } else { high = middle }
    }
    f64::midpoint(low, high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::monte_carlo::mcnemar;
    use crate::random::Stream;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (probability, expected) in [(0.5, 0.0), (0.8, 0.841_621_233_572_914), (0.975, 1.959_963_984_540_054)] {
            assert!((gaussian_quantile(probability) - expected).abs() < 1e-10, "{probability}");
        }
    }

    #[test]
    fn equal_rates_are_never_separated_and_pairing_pays_when_settings_agree() {
        let demand = Demand::default();
        assert_eq!(demand.pairs_needed((0.9, 0.9), 0.1), None);
        assert_eq!(demand.unpaired_trials_needed((0.9, 0.9)), None);
        let rates = (0.928, 0.908);
        let [agreeing, independent] = [0.03, independent_discordance(rates)].map(|psi| demand.pairs_needed(rates, psi));
        let unpaired = demand.unpaired_trials_needed(rates);
        assert!(agreeing < independent && independent.zip(unpaired).is_some_and(|(a, b)| a.abs_diff(b) < b / 100));
        assert!(demand.shared_by(21).pairs_needed(rates, 0.03) > agreeing);
    }

    #[test]
    fn the_detectable_loss_needs_just_the_trials_it_was_asked_for() {
        let demand = Demand::default();
        let loss = demand.detectable_loss(0.93, Some(0.06), 900).expect("found");
        let needed = |loss: f64| demand.pairs_needed((0.93, 0.93 - loss), 0.06).expect("a number");
        assert!(needed(loss) <= 900 && needed(loss - 0.001) > 900, "{loss}");
        assert_eq!(demand.detectable_loss(0.93, None, 1), None);
        let unpaired = demand.detectable_unpaired_loss(0.93, 900).expect("found");
        assert!(demand.unpaired_trials_needed((0.93, 0.93 - unpaired)) <= Some(900) && unpaired > loss);
    }

    /// Share of 4000 simulated studies that find the difference.
    fn simulated(seed: u64, study: impl Fn(&mut Stream) -> bool) -> f64 {
        let studies = 4000;
        let found = (0..studies).filter(|&index| study(&mut Stream::new(seed, "power", index, 0))).count();
        found as f64 / studies as f64
    }

    #[test]
    fn simulated_paired_studies_find_the_difference_as_often_as_demanded() {
        for (rates, discordance) in [((0.93, 0.90), 0.08), ((0.93, 0.88), 0.1), ((0.6, 0.5), 0.3)] {
            let pairs = Demand::default().pairs_needed(rates, discordance).expect("a number");
            let only_first = f64::midpoint(discordance, rates.0 - rates.1);
            let found = simulated(1, |stream| {
                let (mut first, mut second) = (0, 0);
                for _ in 0..pairs {
                    let draw = stream.unit();
                    first += u64::from(draw < only_first);
                    second += u64::from((only_first..discordance).contains(&draw));
                }
                mcnemar(first, second) < 0.05
            });
            // 4000 studies tell a share of 80 % to 1.9 points at three standard errors; the exact test, which errs on
            // the safe side, finds a few points less than the formula says.
            assert!((0.74..0.83).contains(&found), "{rates:?}: {found} with {pairs} pairs");
        }
    }

    #[test]
    fn simulated_unpaired_studies_find_the_difference_as_often_as_demanded() {
        for rates in [(0.93, 0.88), (0.6, 0.5)] {
            let trials = Demand::default().unpaired_trials_needed(rates).expect("a number");
            let found = simulated(2, |stream| {
                let mut count = |rate: f64| (0..trials).filter(|_| stream.chance(rate)).count() as f64 / trials as f64;
                let (first, second) = (count(rates.0), count(rates.1));
                let spread = 2.0 * variance(f64::midpoint(first, second)) / trials as f64;
                (first - second).abs() > 1.959_964 * spread.sqrt()
            });
            assert!((found - 0.8).abs() < 0.03, "{rates:?}: {found} with {trials} trials");
        }
    }
}

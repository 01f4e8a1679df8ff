//! The trials of one setting, as a search sees them.

use super::Merit;
use crate::monte_carlo::{PairedCounts, SuccessRate};
use serde::{Deserialize, Serialize};

/// What one trial under one setting gave.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TrialResult {
    /// Whether the answered node was one of the two nearest.
    pub is_success: bool,
    /// Looks taken.
    pub looks: u32,
    /// Work of the localiser: nodes scored in all looks, each weighed by the bins of its histograms; the same on every
    /// machine.
    pub work: f64,
}

/// Trials of one setting, in their order: the same place in two samples means the same robot pose and noise.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Sample {
    /// The trials.
    pub trials: Vec<TrialResult>,
    /// Mean size of a map in bytes.
    pub map_bytes: f64,
    /// Wall time of the localiser in all trials together, in seconds: reported, never decided by.
    pub localizer_s: f64,
}

impl Sample {
    /// Successes of the trials.
    #[must_use]
    pub fn success(&self) -> SuccessRate {
        SuccessRate::of(self.trials.iter().map(|trial| trial.is_success))
    }

    /// Success, work and map together; of no trials, zeros.
    #[must_use]
    pub fn merit(&self) -> Merit {
        let work = self.mean(|trial| trial.work);
        Merit { success: self.success().rate().unwrap_or(0.0), work, map_bytes: self.map_bytes }
    }

    /// Mean looks of a trial.
    #[must_use]
    pub fn mean_looks(&self) -> f64 {
        self.mean(|trial| f64::from(trial.looks))
    }

    /// Mean wall time of a localisation in seconds.
    #[must_use]
    pub fn mean_localizer_s(&self) -> f64 {
        self.localizer_s / self.trials.len().max(1) as f64
    }

    /// Who was right in the trials that both have, this sample as A.
    #[must_use]
    pub fn against(&self, other: &Self) -> PairedCounts {
        PairedCounts::of(self.trials.iter().zip(&other.trials).map(|(a, b)| (a.is_success, b.is_success)))
    }

    /// Adds further trials of the same setting.
    pub fn extend(&mut self, more: Self) {
        let (before, added) = (self.trials.len() as f64, more.trials.len() as f64);
        if added > 0.0 {
            self.map_bytes = (self.map_bytes * before + more.map_bytes * added) / (before + added);
        }
        self.localizer_s += more.localizer_s;
        self.trials.extend(more.trials);
    }

    fn mean(&self, value: impl Fn(&TrialResult) -> f64) -> f64 {
        self.trials.iter().map(value).fold(0.0, |sum, value| sum + value) / self.trials.len().max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(successes: &[bool], work: f64, map_bytes: f64) -> Sample {
        let trial = |&is_success: &bool| TrialResult { is_success, looks: 2, work };
        Sample { trials: successes.iter().map(trial).collect(), map_bytes, localizer_s: 1.0 }
    }

    #[test]
    fn further_trials_weigh_as_many_as_they_are() {
        let mut all = Sample::default();
        all.extend(sample(&[true, false], 10.0, 100.0));
        all.extend(sample(&[true, true, true, true], 40.0, 160.0));
        assert_eq!(all.success(), SuccessRate { successes: 5, trials: 6 });
        assert_eq!(all.merit(), Merit { success: 5.0 / 6.0, work: 30.0, map_bytes: 140.0 });
        assert!((all.mean_localizer_s() - 2.0 / 6.0).abs() < 1e-12 && (all.mean_looks() - 2.0).abs() < 1e-12);
        assert_eq!(Sample::default().merit(), Merit::default());
    }

    #[test]
    fn only_trials_that_both_have_are_paired() {
        let counts = sample(&[true, true, false], 1.0, 1.0).against(&sample(&[true, false], 1.0, 1.0));
        assert_eq!((counts.pairs(), counts.only_a, counts.only_b), (2, 1, 0));
    }
}

//! Two rows of two runs compared: trial by trial where both met the same robot poses.

use super::RunResults;
use crate::monte_carlo::{PairedCounts, SuccessRate, TrialRecord, difference_interval, paired_difference_interval};
use serde::Serialize;
use std::collections::HashMap;
use thiserror::Error;

/// One row of one run.
#[derive(Debug, Clone, Copy)]
pub struct RunRow<'r> {
    /// The run.
    pub run: &'r RunResults,
    /// Name of the row.
    pub row: &'r str,
}

/// How row B does beside row A. Rates and differences are fractions of 1.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Name of row A.
    pub row_a: String,
    /// Name of row B.
    pub row_b: String,
    /// Figures of A.
    pub a: Side,
    /// Figures of B.
    pub b: Side,
    /// Pairs of trials from the same pose; none when not paired.
    pub pairs: Option<Pairs>,
    /// The rate of B less that of A.
    pub difference: f64,
    /// Lower end of its 95 % interval (Newcombe).
    pub difference_low: f64,
    /// Upper end of its 95 % interval.
    pub difference_high: f64,
}

/// The trials of one side that were compared.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Side {
    /// Trials compared.
    pub trials: u64,
    /// Trials of the row without a partner, left out.
    pub left_out: u64,
    /// Successes.
    pub successes: u64,
    /// Success rate.
    pub success_rate: f64,
    /// Lower end of its 95 % Wilson interval.
    pub success_rate_low: f64,
    /// Upper end of its 95 % Wilson interval.
    pub success_rate_high: f64,
    /// Mean looks of a trial.
    pub mean_looks: f64,
    /// Mean wall time of a look in seconds, of all trials of the row; it depends on the machine.
    pub mean_s_per_look: f64,
}

/// Who was right in pairs of trials.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Pairs {
    /// Both were right.
    pub both: u64,
    /// A alone was right.
    pub only_a: u64,
    /// B alone was right.
    pub only_b: u64,
    /// Both were wrong.
    pub neither: u64,
    /// Two-sided exact probability of discordant pairs this uneven if both were equally good (McNemar).
    pub mcnemar_p: f64,
    /// Mean of B's looks less A's, pair by pair.
    pub mean_more_looks: f64,
}

impl Comparison {
    /// Compares the trials of the same index, which started at the same pose.
    ///
    /// # Errors
    /// When the rows are not paired: another seed, world or start, or poses that differ.
    pub fn paired(a: RunRow<'_>, b: RunRow<'_>) -> Result<Self, NotPaired> {
        let (seed_a, seed_b) = (a.run.scenario.seed, b.run.scenario.seed);
        if seed_a != seed_b {
            return Err(NotPaired::Seed(seed_a, seed_b));
        }
        if a.run.manifest.world.checksum != b.run.manifest.world.checksum {
            return Err(NotPaired::World(a.run.manifest.world.name.clone(), b.run.manifest.world.name.clone()));
        }
        let of_a: HashMap<u32, &TrialRecord> = a.records().map(|record| (record.trial, record)).collect();
        let pairs: Vec<_> = b.records().filter_map(|record| Some((*of_a.get(&record.trial)?, record))).collect();
        if pairs.is_empty() {
            return Err(NotPaired::NoTrials);
        }
        if let Some((record, _)) = pairs.iter().find(|(a, b)| !a.has_pose_of(b)) {
            return Err(NotPaired::Pose { trial: record.trial });
        }
        let counts = PairedCounts::of(pairs.iter().map(|(a, b)| (a.is_success, b.is_success)));
        let more_looks = pairs.iter().map(|(a, b)| f64::from(b.looks) - f64::from(a.looks)).sum::<f64>();
        let (difference_low, difference_high) = paired_difference_interval(&counts);
        let PairedCounts { both, only_a, only_b, neither } = counts;
        Ok(Self {
            row_a: a.row.to_owned(),
            row_b: b.row.to_owned(),
            a: a.side(pairs.iter().map(|(record, _)| *record)),
            b: b.side(pairs.iter().map(|(_, record)| *record)),
            difference: counts.difference().unwrap_or(0.0),
            difference_low,
            difference_high,
            pairs: Some(Pairs {
                both,
                only_a,
                only_b,
                neither,
                mcnemar_p: counts.mcnemar(),
                mean_more_looks: more_looks / pairs.len() as f64,
            }),
        })
    }

    /// Compares the rates of all trials of both rows, whatever the poses.
    #[must_use]
    pub fn unpaired(a: RunRow<'_>, b: RunRow<'_>) -> Self {
        let (side_a, side_b) = (a.side(a.records()), b.side(b.records()));
        let rate = |side: &Side| SuccessRate { successes: side.successes, trials: side.trials };
        let (difference_low, difference_high) = difference_interval(rate(&side_a), rate(&side_b));
        Self {
            row_a: a.row.to_owned(),
            row_b: b.row.to_owned(),
            difference: side_b.success_rate - side_a.success_rate,
            a: side_a,
            b: side_b,
            pairs: None,
            difference_low,
            difference_high,
        }
    }
}

impl<'r> RunRow<'r> {
    fn records(self) -> impl Iterator<Item = &'r TrialRecord> {
        self.run.records.iter().filter(move |record| record.row == self.row)
    }

    fn side<'a>(self, compared: impl Iterator<Item = &'a TrialRecord>) -> Side {
        let (mut rate, mut looks) = (SuccessRate::default(), 0_u64);
        for record in compared {
            rate.trials += 1;
            rate.successes += u64::from(record.is_success);
            looks += u64::from(record.looks);
        }
        let (success_rate_low, success_rate_high) = rate.success_interval();
        let timings = self.run.timings.rows.iter().find(|timings| timings.row == self.row);
        Side {
            trials: rate.trials,
            left_out: self.records().count() as u64 - rate.trials,
            successes: rate.successes,
            success_rate: rate.rate().unwrap_or(0.0),
            success_rate_low,
            success_rate_high,
            mean_looks: looks as f64 / rate.trials.max(1) as f64,
            mean_s_per_look: timings.map_or(0.0, |timings| timings.mean_s_per_look),
        }
    }
}

/// Why two rows can't be compared trial by trial.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum NotPaired {
    /// Other random draws.
    #[error("they have different seeds, {0} and {1}")]
    Seed(u64, u64),
    /// Another building.
    #[error("they took place in different worlds, {0:?} and {1:?}")]
    World(String, String),
    /// Nothing in common.
    #[error("they have no trial of the same index")]
    NoTrials,
    /// Other starts.
    #[error("trial {trial} started at different poses: the starts, their radius or the nodes differ")]
    Pose {
        /// The first such trial.
        trial: u32,
    },
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    #[test]
    fn a_run_beside_itself_differs_in_nothing() {
        let run = sample::run().results;
        let row = RunRow { run: &run, row: &run.scenario.rows[0].name };
        let same = Comparison::paired(row, row).expect("the same poses");
        let pairs = same.pairs.expect("paired");
        assert_eq!((pairs.only_a, pairs.only_b, pairs.both + pairs.neither), (0, 0, 60));
        assert!(pairs.mcnemar_p > 0.999 && same.difference_low < 0.0 && same.difference_high > 0.0, "{same:?}");
        assert_eq!((same.a.trials, same.a.left_out), (60, 0));
        assert_eq!(Comparison::unpaired(row, row).pairs, None);
    }

    #[test]
    fn what_b_gains_is_counted_pair_by_pair() {
        let run = sample::run().results;
        let mut better = run.clone();
        better.records.retain(|record| record.trial < 50);
        let mut gained = 0;
        for record in better.records.iter_mut().filter(|record| record.row == run.scenario.rows[0].name) {
            gained += u64::from(!record.is_success);
            record.is_success = true;
            record.looks += 1;
        }
        let row = &run.scenario.rows[0].name;
        let compared = Comparison::paired(RunRow { run: &run, row }, RunRow { run: &better, row }).expect("paired");
        let pairs = compared.pairs.expect("paired");
        assert!(gained > 0 && (pairs.only_a, pairs.only_b, pairs.neither) == (0, gained, 0), "{pairs:?}");
        assert!((compared.difference - gained as f64 / 50.0).abs() < 1e-12);
        assert!((pairs.mean_more_looks - 1.0).abs() < 1e-12);
        assert_eq!((compared.a.left_out, compared.b.left_out), (10, 0));
    }

    #[test]
    fn rows_that_met_other_poses_are_not_paired() {
        let run = sample::run().results;
        let refused = |change: fn(&mut RunResults)| {
            let mut other = run.clone();
            change(&mut other);
            let row = &run.scenario.rows[0].name;
            Comparison::paired(RunRow { run: &run, row }, RunRow { run: &other, row }).expect_err("not paired")
        };
        assert_eq!(refused(|run| run.scenario.seed = 9), NotPaired::Seed(1, 9));
        assert!(matches!(refused(|run| run.manifest.world.checksum.clear()), NotPaired::World(..)));
        assert_eq!(refused(|run| run.records[7].true_x_m += 0.1), NotPaired::Pose { trial: 7 });
        assert_eq!(refused(|run| run.records.clear()), NotPaired::NoTrials);
    }
}

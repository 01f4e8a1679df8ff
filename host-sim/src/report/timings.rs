//! Wall times of a run, kept apart from its results: they differ from machine to machine.

use crate::monte_carlo::TrialRecord;
use crate::scenario::Row;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::time::Duration;

/// Wall times of a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RunTimings {
    /// Making the world ready (free space, nodes, what is seen from each), in seconds; of a resumed run the last time.
    pub prepare_s: f64,
    /// Learning all maps and running all trials, in seconds; of a resumed run before and after the interruption, without
    /// the trials that were under way.
    pub trials_s: f64,
    /// One entry a row.
    pub rows: Vec<RowTimings>,
}

/// Wall times of the localiser in the trials of one row, on one thread, a look at a time.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RowTimings {
    /// Name of the row.
    pub row: String,
    /// Mean, in seconds.
    pub mean_s_per_look: f64,
    /// Median, in seconds.
    pub median_s_per_look: f64,
    /// 95 of 100 looks take at most this, in seconds.
    pub p95_s_per_look: f64,
}

impl RunTimings {
    /// The times of `records`, whose looks took `look_times`, in the same order.
    #[must_use]
    pub fn new(
        rows: &[Row],
        records: &[TrialRecord],
        look_times: &[Vec<Duration>],
        prepare: Duration,
        trials: Duration,
    ) -> Self {
        let of_row = |row: &Row| {
            let of_trials = records.iter().zip(look_times).filter(|(record, _)| record.row == row.name);
            let mut seconds = of_trials.flat_map(|(_, times)| times).map(Duration::as_secs_f64).collect::<Vec<_>>();
            seconds.sort_by(f64::total_cmp);
            let quantile = |share: f64| {
                let rank = (share * seconds.len() as f64).ceil() as usize;
                seconds.get(rank.saturating_sub(1)).copied().unwrap_or(0.0)
            };
            RowTimings {
                row: row.name.clone(),
                mean_s_per_look: seconds.iter().sum::<f64>() / seconds.len().max(1) as f64,
                median_s_per_look: quantile(0.5),
                p95_s_per_look: quantile(0.95),
            }
        };
        let rows = rows.iter().map(of_row).collect();
        Self { prepare_s: prepare.as_secs_f64(), trials_s: trials.as_secs_f64(), rows }
    }

    /// Wall time of the run, in seconds.
    #[must_use]
    pub fn total_s(&self) -> f64 {
        self.prepare_s + self.trials_s
    }
}

/// The wall time of every look as CSV: row, trial, look from 1, seconds.
pub(super) fn look_times_csv(records: &[TrialRecord], look_times: &[Vec<Duration>]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["row", "trial", "look", "localizer_s"])?;
    for (record, times) in records.iter().zip(look_times) {
        for (look, time) in times.iter().enumerate() {
            let (look, seconds) = ((look + 1).to_string(), format!("{:.6}", time.as_secs_f64()));
            writer.write_record([&record.row, &record.trial.to_string(), &look, &seconds])?;
        }
    }
    writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))
}

/// The wall times of the looks of each of `records`, read back.
pub(super) fn read_look_times(file: impl std::io::Read, records: &[TrialRecord]) -> Result<Vec<Vec<Duration>>, String> {
    let mut of_trial: HashMap<(String, u32), Vec<Duration>> = HashMap::new();
    for line in csv::Reader::from_reader(file).into_deserialize() {
        let (row, trial, _, seconds): (String, u32, u32, f64) = line.map_err(|error| error.to_string())?;
        let time = Duration::try_from_secs_f64(seconds).map_err(|error| error.to_string())?;
        of_trial.entry((row, trial)).or_default().push(time);
    }
    let times = records.iter().map(|record| of_trial.remove(&(record.row.clone(), record.trial)).unwrap_or_default());
    Ok(times.collect())
}

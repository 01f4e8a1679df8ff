//! The figures of a localiser over several worlds: a line a world, and what they come to together.

use super::{AnswerFigures, RunResults, Share};
use crate::monte_carlo::{TrialRecord, clustered_interval};
use crate::scenario::Start;
use serde::Serialize;

/// A row of a scenario in several worlds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ValidationRow {
    /// Name of the row.
    pub row: String,
    /// Where its trials start.
    pub start: Start,
    /// One line a world, in the order in which they ran.
    pub worlds: Vec<WorldLine>,
    /// All worlds together.
    pub total: TotalLine,
}

/// A row in one world.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WorldLine {
    /// The world, as its run's folder is called.
    pub world: String,
    /// Nodes of the map.
    pub nodes: usize,
    /// Free space for each node \[m2\].
    pub free_m2_per_node: f64,
    /// Mean bytes of the map.
    pub map_bytes: f64,
    /// Trials that ended right, of all.
    pub success: Share,
    /// What the answers are worth.
    pub answers: AnswerFigures,
    /// Mean looks of a trial.
    pub mean_looks: f64,
    /// Mean wall time of the localiser for a look in seconds.
    pub mean_s_per_look: f64,
    /// Trials that ended in an error of the localiser.
    pub errors: u64,
}

/// A row in all worlds together.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TotalLine {
    /// Mean over worlds of the success rate, a fraction, each world alike; none without trials.
    pub mean_success_rate: Option<f64>,
    /// Lower end of its 95 % interval over worlds, a fraction: [`clustered_interval`], and never narrower than Wilson's of
    /// all trials, because worlds that all happen to have the same rate prove no certainty.
    pub clustered_low: f64,
    /// Upper end of its 95 % interval over worlds, a fraction.
    pub clustered_high: f64,
    /// The world of the lowest success rate.
    pub worst_world: Option<String>,
    /// The success rate there, a fraction.
    pub worst_success_rate: Option<f64>,
    /// Trials of all worlds that ended right, of all; its interval takes them as one world's.
    pub success: Share,
    /// What the answers in all worlds are worth.
    pub answers: AnswerFigures,
    /// Mean looks of a trial.
    pub mean_looks: f64,
    /// Trials that ended in an error of the localiser.
    pub errors: u64,
}

/// The rows of runs of one scenario in several worlds, each with the name of its world.
#[must_use]
pub fn validation(runs: &[(String, RunResults)]) -> Vec<ValidationRow> {
    let rows = runs.first().map_or(&[][..], |(_, first)| &first.scenario.rows);
    rows.iter().enumerate().map(|(index, row)| validation_row(runs, index, &row.name, row.start)).collect()
}

fn validation_row(runs: &[(String, RunResults)], index: usize, name: &str, start: Start) -> ValidationRow {
    let line = |(world, results): &(String, RunResults)| {
        let row = results.summary.rows.get(index)?;
        let time = results.timings.rows.iter().find(|timings| timings.row == row.row);
        Some(WorldLine {
            world: world.clone(),
            nodes: row.nodes,
            free_m2_per_node: row.map.free_m2_per_node,
            map_bytes: row.map.mean_bytes,
            success: Share::from_counts(row.successes, row.trials),
            answers: row.answers.clone(),
            mean_looks: row.mean_looks,
            mean_s_per_look: time.map_or(0.0, |timings| timings.mean_s_per_look),
            errors: row.errors,
        })
    };
    let worlds: Vec<WorldLine> = runs.iter().filter_map(line).collect();
    let records: Vec<&TrialRecord> =
        runs.iter().flat_map(|(_, results)| &results.records).filter(|record| record.row == name).collect();
    ValidationRow { row: name.to_owned(), start, total: total_line(start, &worlds, &records), worlds }
}

fn total_line(start: Start, worlds: &[WorldLine], records: &[&TrialRecord]) -> TotalLine {
    let rates: Vec<f64> = worlds.iter().filter_map(|world| world.success.rate).collect();
    let clustered = clustered_interval(&rates);
    let success = Share::of(records.iter().map(|record| record.is_success));
    let (low, high) = clustered.map_or((0.0, 1.0), |(_, interval)| interval);
    let (clustered_low, clustered_high) = (low.min(success.low), high.max(success.high));
    let with_rate = worlds.iter().filter_map(|world| Some((world, world.success.rate?)));
    let worst = with_rate.min_by(|(_, a), (_, b)| a.total_cmp(b));
    let looks: f64 = records.iter().map(|record| f64::from(record.looks)).sum();
    TotalLine {
        mean_success_rate: clustered.map(|(mean, _)| mean),
        clustered_low,
        clustered_high,
        worst_world: worst.map(|(world, _)| world.world.clone()),
        worst_success_rate: worst.map(|(_, rate)| rate),
        success,
        answers: AnswerFigures::new(start, records),
        mean_looks: looks / records.len().max(1) as f64,
        errors: worlds.iter().map(|world| world.errors).sum(),
    }
}

/// A line of `validation.csv`: rates are fractions, empty where there is none.
#[derive(Debug, Serialize)]
struct CsvLine<'l> {
    row: &'l str,
    start: Start,
    world: &'l str,
    nodes: Option<usize>,
    trials: u64,
    successes: u64,
    success_rate: Option<f64>,
    success_rate_low: f64,
    success_rate_high: f64,
    answered: u64,
    coverage: Option<f64>,
    false_accepts: u64,
    false_accept_rate: Option<f64>,
    false_accept_rate_low: f64,
    false_accept_rate_high: f64,
    truth_named: u64,
    truth_named_rate: Option<f64>,
    near_ties: u64,
    pose_error_median_m: Option<f64>,
    pose_error_95_m: Option<f64>,
    pose_error_99_m: Option<f64>,
    heading_error_median_deg: Option<f64>,
    calibration_error: Option<f64>,
    mean_looks: f64,
    errors: u64,
}

/// Name of the line of all worlds.
const ALL_WORLDS: &str = "all worlds";

/// The table `validation.csv`: a line for each row in each world, and one of all worlds, whose rate is the mean over worlds
/// and whose interval is the clustered one.
///
/// # Errors
/// When a line can't be written, which does not happen in memory.
pub fn validation_csv(rows: &[ValidationRow]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        for world in &row.worlds {
            let line = csv_line(row, (&world.world, Some(world.nodes)), &world.success, &world.answers);
            writer.serialize(CsvLine { mean_looks: world.mean_looks, errors: world.errors, ..line })?;
        }
        let total = &row.total;
        let line = csv_line(row, (ALL_WORLDS, None), &total.success, &total.answers);
        writer.serialize(CsvLine {
            success_rate: total.mean_success_rate,
            success_rate_low: total.clustered_low,
            success_rate_high: total.clustered_high,
            mean_looks: total.mean_looks,
            errors: total.errors,
            ..line
        })?;
    }
    writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))
}

fn csv_line<'l>(
    row: &'l ValidationRow,
    (world, nodes): (&'l str, Option<usize>),
    success: &Share,
    answers: &AnswerFigures,
) -> CsvLine<'l> {
    CsvLine {
        row: &row.row,
        start: row.start,
        world,
        nodes,
        trials: success.of,
        successes: success.count,
        success_rate: success.rate,
        success_rate_low: success.low,
        success_rate_high: success.high,
        answered: answers.coverage.count,
        coverage: answers.coverage.rate,
        false_accepts: answers.false_accepts.count,
        false_accept_rate: answers.false_accepts.rate,
        false_accept_rate_low: answers.false_accepts.low,
        false_accept_rate_high: answers.false_accepts.high,
        truth_named: answers.truth_named.count,
        truth_named_rate: answers.truth_named.rate,
        near_ties: answers.near_ties,
        pose_error_median_m: answers.pose_error_median_m,
        pose_error_95_m: answers.pose_error_95_m,
        pose_error_99_m: answers.pose_error_99_m,
        heading_error_median_deg: answers.heading_error_median_deg,
        calibration_error: answers.calibration_error,
        mean_looks: 0.0,
        errors: 0,
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::report::{Summary, sample};

    /// The same run in two worlds; in the second some more trials fail.
    pub(in crate::report) fn two_worlds() -> Vec<(String, RunResults)> {
        let first = sample::run().results;
        let mut second = first.clone();
        second.records.iter_mut().step_by(3).for_each(|record| record.is_success = false);
        second.summary = Summary::new(&second.scenario, &second.nodes, 120.0, &second.records);
        vec![("office-1".to_owned(), first), ("hall".to_owned(), second)]
    }

    #[test]
    fn worlds_count_alike_and_the_worst_is_named() {
        let rows = validation(&two_worlds());
        assert_eq!(rows.len(), 4);
        for row in &rows {
            let rates: Vec<f64> = row.worlds.iter().filter_map(|world| world.success.rate).collect();
            assert_eq!(row.total.mean_success_rate, Some((rates[0] + rates[1]) / 2.0));
            assert_eq!(
                (row.total.worst_world.as_deref(), row.total.worst_success_rate),
                (Some("hall"), Some(rates[1]))
            );
            assert_eq!((row.total.success.of, row.total.answers.coverage.of), (120, 120));
            assert!(row.total.clustered_low <= rates[1] && row.total.clustered_high >= rates[0]);
        }
    }

    #[test]
    fn worlds_that_all_have_the_same_rate_prove_no_certainty() {
        let mut runs = two_worlds();
        runs[1] = ("hall".to_owned(), runs[0].1.clone());
        for row in validation(&runs) {
            assert!(
                row.total.clustered_low <= row.total.success.low && row.total.clustered_high >= row.total.success.high
            );
        }
    }

    #[test]
    fn the_table_has_a_line_a_world_and_one_of_all() {
        let rows = validation(&two_worlds());
        let text = String::from_utf8(validation_csv(&rows).expect("written")).expect("UTF-8");
        assert_eq!(text.lines().count(), 1 + 4 * 3);
        assert_eq!(text.lines().filter(|line| line.contains(",all worlds,")).count(), 4);
        assert!(text.starts_with("row,start,world,nodes,trials,"), "{text}");
        assert_eq!(validation(&[]), []);
    }
}

//! The figures of a run, row by row: what `summary.json` holds and the tables show. No wall times.

use super::AnswerFigures;
use crate::monte_carlo::{Outcome, SuccessRate, TrialRecord};
use crate::scenario::{Scenario, Start};
use edgeloc::geometry::Point2;
use serde::{Deserialize, Serialize};

/// The paper's own success rate in simulation, a fraction; n > 900 (section 5).
pub const PAPER_RATE: f64 = 0.9282;
/// The 95 % Wilson interval of [`PAPER_RATE`] at the stated number of trials, as fractions.
pub const PAPER_INTERVAL: (f64, f64) = (0.909, 0.943);

/// The figures of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Name of the scenario.
    pub scenario: String,
    /// Where the robot can stand \[m2\].
    pub free_area_m2: f64,
    /// The paper's success rate, a fraction.
    pub paper_rate: f64,
    /// Lower and upper end of its 95 % interval, as fractions.
    pub paper_interval: (f64, f64),
    /// One entry a row, in the scenario's order.
    pub rows: Vec<RowSummary>,
}

/// Size of a row's learned map, mean over its trials.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct MapFacts {
    /// Mean bytes of the database.
    pub mean_bytes: f64,
    /// Mean segments in the model of a node.
    pub mean_segments_per_node: f64,
    /// Free space, without what is withheld, for each node \[m2\]: the density of the nodes.
    pub free_m2_per_node: f64,
}

/// The figures of one row.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RowSummary {
    /// Name of the row.
    pub row: String,
    /// Where its trials start.
    pub start: Start,
    /// Whether its histograms use polarity.
    pub polarity: bool,
    /// Nodes of the map.
    pub nodes: usize,
    /// The map as learned.
    pub map: MapFacts,
    /// Success rate of blind guessing, a fraction: two of the nodes are right, none where starts are unlearned.
    pub chance_rate: f64,
    /// Trials.
    pub trials: u64,
    /// Trials that ended right: at one of the two nearest nodes, or without an answer where starts are unlearned.
    pub successes: u64,
    /// Successes per trial, a fraction; none without trials.
    pub success_rate: Option<f64>,
    /// Lower end of the 95 % Wilson interval, a fraction.
    pub success_rate_low: f64,
    /// Upper end of the 95 % Wilson interval, a fraction.
    pub success_rate_high: f64,
    /// What the answers are worth.
    pub answers: AnswerFigures,
    /// Trials answered "I can't tell".
    pub unknown: u64,
    /// Trials that ended in an error of the localiser.
    pub errors: u64,
    /// Mean looks of a trial.
    pub mean_looks: f64,
    /// Median looks of a trial.
    pub median_looks: f64,
    /// Mean image segments of a look that entered the matching.
    pub mean_segments_per_look: f64,
    /// Mean distance from the true position to the nearest node in metres.
    pub mean_nearest_node_distance_m: f64,
    /// Median distance from the true position to the answered node in metres; none without answers.
    pub median_answer_distance_m: Option<f64>,
}

impl RowSummary {
    /// The success rate with its interval.
    #[must_use]
    pub fn success(&self) -> SuccessRate {
        SuccessRate { successes: self.successes, trials: self.trials }
    }
}

impl Summary {
    /// The figures of `records`, trials of `scenario` with the given nodes of each row in so much free space.
    #[must_use]
    pub fn new(scenario: &Scenario, nodes: &[Vec<Point2>], free_area_m2: f64, records: &[TrialRecord]) -> Self {
        let settings = scenario.settings().unwrap_or_default();
        let rows = scenario.rows.iter().enumerate().map(|(index, row)| {
            let nodes = nodes.get(index).map_or(0, Vec::len);
            let per_node = |value: f64| value / nodes.max(1) as f64;
            let withheld = settings.get(index).map_or(0.0, |setting| setting.scenario.learning.withheld);
            let records = records.iter().filter(|record| record.row == row.name).collect::<Vec<_>>();
            let success = SuccessRate::of(records.iter().map(|record| record.is_success));
            let interval = success.success_interval();
            let count = |outcome| records.iter().filter(|record| record.outcome == outcome).count() as u64;
            let looks = records.iter().map(|record| f64::from(record.looks)).collect::<Vec<_>>();
            let segments = records.iter().map(|record| f64::from(record.scene_segments)).sum::<f64>();
            RowSummary {
                row: row.name.clone(),
                start: row.start,
                polarity: row.polarity,
                nodes,
                map: MapFacts {
                    mean_bytes: mean(records.iter().map(|record| f64::from(record.map_bytes))),
                    mean_segments_per_node: per_node(mean(records.iter().map(|record| f64::from(record.map_segments)))),
                    free_m2_per_node: per_node(free_area_m2 * (1.0 - withheld)),
                },
                chance_rate: match row.start {
                    Start::Near | Start::Anywhere => (2.0 / nodes.max(1) as f64).min(1.0),
                    Start::Unlearned => 0.0,
                },
                trials: success.trials,
                successes: success.successes,
                success_rate: success.rate(),
                success_rate_low: interval.0,
                success_rate_high: interval.1,
                answers: AnswerFigures::new(row.start, &records),
                unknown: count(Outcome::Unknown),
                errors: count(Outcome::Error),
                mean_looks: mean(looks.iter().copied()),
                median_looks: median(looks.clone()).unwrap_or(0.0),
                mean_segments_per_look: segments / looks.iter().sum::<f64>().max(1.0),
                mean_nearest_node_distance_m: mean(
                    records.iter().map(|record| f64::from(record.nearest_node_distance_m)),
                ),
                median_answer_distance_m: median(
                    records.iter().filter_map(|record| record.answer_distance_m).map(f64::from).collect(),
                ),
            }
        });
        Self {
            scenario: scenario.name.clone(),
            free_area_m2,
            paper_rate: PAPER_RATE,
            paper_interval: PAPER_INTERVAL,
            rows: rows.collect(),
        }
    }
}

/// The `count` worst failures: errors first, then by distance from the truth to the answered node, then "can't tell".
/// Of rows that fail from the same start only the worst is listed.
#[must_use]
pub fn worst_trials(records: &[TrialRecord], count: usize) -> Vec<&TrialRecord> {
    let badness = |record: &TrialRecord| match record.outcome {
        Outcome::Error => f64::INFINITY,
        Outcome::Localized => record.answer_distance_m.map_or(0.0, f64::from),
        Outcome::Unknown => -1.0,
    };
    let mut failures = records.iter().filter(|record| !record.is_success).collect::<Vec<_>>();
    failures.sort_by(|a, b| badness(b).total_cmp(&badness(a)));
    let mut worst: Vec<&TrialRecord> = Vec::new();
    for record in failures {
        let start = |record: &TrialRecord| [record.true_x_m.to_bits(), record.true_y_m.to_bits()];
        if worst.len() < count && worst.iter().all(|other| start(other) != start(record)) {
            worst.push(record);
        }
    }
    worst
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    if count > 0.0 { sum / count } else { 0.0 }
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let (low, high) = (values.get(values.len().checked_sub(1)? / 2)?, values.get(values.len() / 2)?);
    Some(f64::midpoint(*low, *high))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    #[test]
    fn rows_are_summed_apart() {
        let results = sample::run().results;
        let rows = &results.summary.rows;
        let trials = rows.iter().map(|row| row.trials).sum::<u64>();
        assert_eq!((rows.len(), trials), (4, results.records.len() as u64));
        assert!(rows[0].success_rate > rows[3].success_rate);
    }

    #[test]
    fn a_run_without_trials_has_figures_too() {
        let summary = Summary::new(&Scenario::default(), &[], 0.0, &[]);
        assert_eq!((summary.rows[0].trials, summary.rows[0].success_rate), (0, None));
        assert!(serde_json::to_string(&summary).is_ok_and(|json| !json.contains("NaN")));
    }

    #[test]
    fn the_worst_trials_are_failures_farthest_first() {
        let results = sample::run().results;
        let worst = worst_trials(&results.records, 3);
        let distances = worst.iter().filter_map(|record| record.answer_distance_m);
        assert!(distances.collect::<Vec<_>>().is_sorted_by(|a, b| a >= b));
        assert!(worst.len() == 3 && worst.iter().all(|record| !record.is_success));
    }

    #[test]
    fn the_median_of_an_even_number_is_the_middle() {
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), Some(2.5));
        assert_eq!(median(vec![]), None);
    }
}

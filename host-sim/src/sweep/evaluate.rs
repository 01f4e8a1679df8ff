//! The trials of a search: a stage of it is a scenario of its own, one row a setting.

use super::{Sample, Stage, TrialResult};
use crate::monte_carlo::{RunOutcome, TrialRecord};
use crate::random::Stream;
use crate::scenario::{Row, Scenario, ScenarioError};
use std::time::Duration;

/// Bins of a histogram that cost as much to match as a node's prediction costs to build; measured at 8 to 64 by 5 to 60
/// bins, where a look takes about a + b x bins.
const BINS_PER_PREDICTION: f64 = 600.0;

/// The scenario of a stage: the settings of the given indices among `points`, each a row that starts and sees like `row`.
///
/// A stage has a seed of its own, drawn from that of `base`: its nodes, maps, poses and noise are fresh.
///
/// # Errors
/// When a point can't be set.
pub fn stage_scenario(
    base: &Scenario,
    row: &Row,
    points: &[Vec<String>],
    stage: Stage,
    settings: &[usize],
    trials: u32,
) -> Result<Scenario, ScenarioError> {
    let named = |&setting: &usize| Row { name: row_name(setting), trials: None, ..row.clone() };
    let rows = settings.iter().map(named).collect();
    let mut scenario = Scenario { seed: stage_seed(base.seed, stage), trials, rows, ..base.clone() };
    for (place, &setting) in settings.iter().enumerate() {
        for change in &points[setting] {
            scenario = scenario.with_setting(&format!("rows.{place}.set.{change}"))?;
        }
    }
    let refused = |illegal| ScenarioError::Illegal { illegal: Box::new(illegal), text: None, place: None };
    scenario.check().map_err(refused)?;
    Ok(scenario)
}

/// Name of the row of a setting.
fn row_name(setting: usize) -> String {
    format!("setting {setting}")
}

fn stage_seed(seed: u64, stage: Stage) -> u64 {
    let number = match stage {
        Stage::Confirmation => 0,
        Stage::Rung(rung) => 1 + rung as u64,
    };
    // TOML integers have 63 bits.
    Stream::new(seed, "stage", number, 0).index(i64::MAX as usize) as u64
}

/// What the trials of a stage gave: a sample for each row of its scenario.
#[must_use]
pub fn samples(scenario: &Scenario, outcome: &RunOutcome) -> Vec<Sample> {
    let settings = scenario.settings().expect("a stage's scenario is checked when it is made");
    let of_row = |row: &str, bins: f64| {
        let timed = outcome.records.iter().zip(&outcome.look_times).filter(|(record, _)| record.row == row);
        let mut sample = Sample::default();
        for (record, times) in timed {
            sample.trials.push(TrialResult {
                is_success: record.is_success,
                looks: record.looks,
                work: work(record, bins),
            });
            sample.map_bytes += f64::from(record.map_bytes);
            sample.localizer_s += times.iter().map(Duration::as_secs_f64).sum::<f64>();
        }
        sample.map_bytes /= sample.trials.len().max(1) as f64;
        sample
    };
    let bins = |pgh: &crate::scenario::PghSettings| f64::from(pgh.distance_bins) * f64::from(pgh.angle_bins);
    settings.iter().map(|setting| of_row(&setting.row.name, bins(&setting.scenario.localizer.pgh))).collect()
}

/// Work of a trial: nodes scored in all looks together, each weighed by what its histograms cost. No clock is asked, so
/// that a search decides alike on every machine.
fn work(record: &TrialRecord, bins: f64) -> f64 {
    f64::from(record.scored_nodes) * (1.0 + bins / BINS_PER_PREDICTION)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Start;

    #[test]
    fn a_stage_has_a_row_for_each_setting_and_a_seed_of_its_own() {
        let points = [vec![], vec!["localizer.turn_deg=60".to_owned(), "learning.nodes=9".to_owned()], vec![]];
        let row = Row::new("near", Start::Near, true);
        let stage = |stage| stage_scenario(&Scenario::default(), &row, &points, stage, &[0, 1], 7).expect("legal");
        let (rung, confirmation) = (stage(Stage::Rung(0)), stage(Stage::Confirmation));
        let settings = rung.settings().expect("legal");
        assert_eq!((settings.len(), settings[1].row.name.as_str(), rung.trials), (2, "setting 1", 7));
        assert_eq!((settings[1].scenario.learning.nodes, settings[0].scenario.learning.nodes), (9, 72));
        assert_ne!(rung.seed, confirmation.seed);
        assert_eq!(rung.seed, stage(Stage::Rung(0)).seed);
    }

    #[test]
    fn an_illegal_point_is_refused_with_its_key() {
        let row = Row::new("near", Start::Near, true);
        let points = [vec!["localizer.turn_deg=400".to_owned()]];
        let error = stage_scenario(&Scenario::default(), &row, &points, Stage::Rung(0), &[0], 1).expect_err("illegal");
        assert!(error.to_string().contains("turn_deg"), "{error}");
    }
}

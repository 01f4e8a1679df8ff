//! A study in figures: rows whose names begin alike, and each row against the default on the same trials.
//!
//! A row called `4(a): B_th 0.05` is the setting `B_th 0.05` of the figure `4(a)`; a row that starts anywhere carries
//! `, anywhere` at its end and is the same setting's mark of the other regime. The default is the first row of a regime
//! that changes nothing of its scenario.

use super::holm;
use crate::monte_carlo::{PairedCounts, SuccessRate, TrialRecord};
use crate::scenario::{IllegalValue, Row, Scenario, Setting, Start};
use std::collections::BTreeMap;

/// End of the name of a row that repeats another one anywhere in free space.
const ANYWHERE: &str = ", anywhere";

/// A figure: settings in their order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Figure {
    /// Its name, such as `4(a)`.
    pub name: String,
    /// Its settings, each with its rows' places in the scenario, one a regime.
    pub settings: Vec<(String, Vec<usize>)>,
}

/// Figure and setting that a row's name tells; the figure is empty when it tells none.
#[must_use]
pub fn figure_and_setting(row: &Row) -> (&str, &str) {
    let (figure, setting) = row.name.split_once(": ").unwrap_or(("", &row.name));
    let is_repeat = row.start == Start::Anywhere;
    (figure, setting.strip_suffix(ANYWHERE).filter(|_| is_repeat).unwrap_or(setting))
}

/// The figures of rows, in the order in which they first appear.
#[must_use]
pub fn figures_of(rows: &[Row]) -> Vec<Figure> {
    let mut figures: Vec<Figure> = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let (name, setting) = figure_and_setting(row);
        let place = figures.iter().position(|figure| figure.name == name).unwrap_or_else(|| {
            figures.push(Figure { name: name.to_owned(), settings: Vec::new() });
            figures.len() - 1
        });
        let settings = &mut figures[place].settings;
        match settings.iter_mut().find(|(known, _)| known == setting) {
            Some((_, rows)) => rows.push(index),
            None => settings.push((setting.to_owned(), vec![index])),
        }
    }
    figures
}

/// The scenario with every near row repeated anywhere in free space.
#[must_use]
pub fn with_anywhere(scenario: &Scenario) -> Scenario {
    let near = scenario.rows.iter().filter(|row| row.start == Start::Near);
    let repeat = |row: &Row| Row { name: format!("{}{ANYWHERE}", row.name), start: Start::Anywhere, ..row.clone() };
    let repeats: Vec<Row> = near.map(repeat).filter(|row| scenario.row(Some(&row.name)).is_none()).collect();
    Scenario { rows: scenario.rows.iter().cloned().chain(repeats).collect(), ..scenario.clone() }
}

/// How a row compares with the default.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Against {
    /// It is the default, or the same by another name.
    IsDefault,
    /// The same robot poses, trial by trial, the default as A: McNemar's exact test.
    Paired(PairedCounts),
    /// Other poses, because the nodes differ: two rates, the default's first.
    Unpaired(SuccessRate, SuccessRate),
    /// The regime has no default row.
    NoDefault,
}

/// A row against the default.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DefaultComparison {
    /// With what, and what came out.
    pub against: Against,
    /// Two-sided p-value; none where nothing is compared.
    pub p: Option<f64>,
    /// The same after Holm's correction for all comparisons of the study.
    pub p_holm: Option<f64>,
}

impl Against {
    fn p(&self) -> Option<f64> {
        match self {
            Self::Paired(counts) => Some(counts.mcnemar()),
            Self::Unpaired(default, row) => p_of_two_rates(*default, *row),
            Self::IsDefault | Self::NoDefault => None,
        }
    }
}

/// Every row of a study against the default of its regime, in the scenario's order.
///
/// # Errors
/// The first row that is not legal.
pub fn compare_with_default(
    scenario: &Scenario,
    records: &[TrialRecord],
) -> Result<Vec<DefaultComparison>, IllegalValue> {
    let settings = scenario.settings()?;
    let defaults = settings.iter().map(|setting| changes_nothing(scenario, setting)).collect::<Vec<_>>();
    let mut trials: BTreeMap<&str, BTreeMap<u32, &TrialRecord>> = BTreeMap::new();
    for record in records {
        trials.entry(&record.row).or_default().insert(record.trial, record);
    }
    let none = BTreeMap::new();
    let of = |index: usize| trials.get(scenario.rows[index].name.as_str()).unwrap_or(&none);
    let against = |index: usize| {
        // A row of another polarity is held against the default of its start, so that polarity is a setting like others.
        let is_reference = |&other: &usize| defaults[other] && settings[other].row.start == settings[index].row.start;
        let Some(reference) = (0..settings.len()).find(is_reference) else { return Against::NoDefault };
        if defaults[index] && settings[index].row.polarity == settings[reference].row.polarity {
            return Against::IsDefault;
        }
        against(of(reference), of(index))
    };
    let all: Vec<Against> = (0..settings.len()).map(against).collect();
    let p_values: Vec<Option<f64>> = all.iter().map(Against::p).collect();
    let corrected = holm(&p_values);
    let join = |((against, p), p_holm)| DefaultComparison { against, p, p_holm };
    Ok(all.into_iter().zip(p_values).zip(corrected).map(join).collect())
}

fn changes_nothing(scenario: &Scenario, setting: &Setting) -> bool {
    let rows = setting.scenario.rows.clone();
    setting.scenario == Scenario { rows, trials: setting.scenario.trials, ..scenario.clone() }
}

fn against(default: &BTreeMap<u32, &TrialRecord>, row: &BTreeMap<u32, &TrialRecord>) -> Against {
    let pairs = default.iter().filter_map(|(trial, a)| row.get(trial).map(|b| (*a, *b))).collect::<Vec<_>>();
    if pairs.iter().all(|(a, b)| a.has_pose_of(b)) {
        return Against::Paired(PairedCounts::of(pairs.iter().map(|(a, b)| (a.is_success, b.is_success))));
    }
    let rate = |trials: &BTreeMap<u32, &TrialRecord>| SuccessRate::of(trials.values().map(|record| record.is_success));
    Against::Unpaired(rate(default), rate(row))
}

/// The row called `row` against the row called `reference`, whose trials are A.
#[must_use]
pub fn against_row(records: &[TrialRecord], reference: &str, row: &str) -> Against {
    let of = |name: &str| {
        let records = records.iter().filter(|record| record.row == name);
        records.map(|record| (record.trial, record)).collect::<BTreeMap<_, _>>()
    };
    against(&of(reference), &of(row))
}

/// Two-sided p-value of two rates being equal, by their pooled standard error; none without trials.
fn p_of_two_rates(a: SuccessRate, b: SuccessRate) -> Option<f64> {
    let difference = a.rate()? - b.rate()?;
    let pooled = (a.successes + b.successes) as f64 / (a.trials + b.trials) as f64;
    let variance = pooled * (1.0 - pooled) * (1.0 / a.trials as f64 + 1.0 / b.trials as f64);
    if variance > 0.0 { Some(libm::erfc(difference.abs() / (2.0 * variance).sqrt())) } else { Some(1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::monte_carlo::Outcome;

    fn study() -> Scenario {
        let row = |name: &str| Row::new(name, Start::Near, true);
        let rows = vec![
            row("4(a): B_th 0").with("localizer.score_margin", 0.0),
            row("4(a): B_th 0.1"),
            row("4(b): all at default"),
            row("nodes: 36").with("learning.nodes", 36),
            Row::new("start: anywhere", Start::Anywhere, true),
            Row::new("start: anywhere, no polarity", Start::Anywhere, false),
        ];
        Scenario { rows, ..Scenario::default() }
    }

    /// A trial of a row, at a pose of its own in each trial and for each number of nodes.
    fn record(row: &str, trial: u32, is_success: bool) -> TrialRecord {
        let shift = if row.starts_with("nodes") { 0.5 } else { 0.0 };
        TrialRecord {
            row: row.to_owned(),
            trial,
            map: 0,
            true_x_m: trial as f32 + shift,
            true_y_m: 0.0,
            true_heading_deg: 0.0,
            nearest_node: 0,
            second_nearest_node: 1,
            nearest_node_distance_m: 0.1,
            outcome: Outcome::Localized,
            answered_node: Some(u32::from(is_success)),
            answer_distance_m: Some(0.1),
            pose_error_m: None,
            heading_error_deg: None,
            probability: None,
            is_success,
            is_truth_named: is_success,
            is_near_tie: false,
            unknown_kind: None,
            rivals: None,
            end_x_m: 0.0,
            end_y_m: 0.0,
            driven_m: 0.0,
            looks: 1,
            scene_segments: 50,
            scored_nodes: 72,
            leader_score: 0.5,
            runner_up_score: 0.4,
            truth_score: None,
            map_bytes: 1000,
            map_segments: 50,
            message: None,
        }
    }

    #[test]
    fn rows_are_gathered_into_figures_by_their_names() {
        let both = with_anywhere(&study());
        assert_eq!(both.check(), Ok(()));
        assert_eq!(both.rows.len(), 10);
        let figures = figures_of(&both.rows);
        let names = figures.iter().map(|figure| figure.name.as_str()).collect::<Vec<_>>();
        assert_eq!(names, ["4(a)", "4(b)", "nodes", "start"]);
        assert_eq!(figures[0].settings, [("B_th 0".to_owned(), vec![0, 6]), ("B_th 0.1".to_owned(), vec![1, 7])]);
        assert_eq!(with_anywhere(&both).rows.len(), 10, "no row is repeated twice");
    }

    #[test]
    fn rows_are_paired_with_the_default_of_their_start_where_the_poses_are_the_same() {
        let study = study();
        let mut records = Vec::new();
        for row in &study.rows {
            let is_default = row.set.is_empty() && row.polarity;
            records.extend((0..12).map(|trial| record(&row.name, trial, is_default || trial < 2)));
        }
        let compared = compare_with_default(&study, &records).expect("legal rows");
        let lost = Against::Paired(PairedCounts { both: 2, only_a: 10, only_b: 0, neither: 0 });
        assert_eq!((compared[0].against, compared[5].against), (lost, lost));
        assert!(
            [1, 2, 4]
                .iter()
                .all(|&row: &usize| compared[row].against == Against::IsDefault && compared[row].p.is_none())
        );
        let rate = |successes| SuccessRate { successes, trials: 12 };
        assert_eq!(compared[3].against, Against::Unpaired(rate(12), rate(2)));
        for row in [0, 3, 5] {
            let (p, corrected) = (compared[row].p.expect("compared"), compared[row].p_holm.expect("corrected"));
            assert!(p < 0.01 && corrected > p && corrected < 0.05, "row {row}: {p}, {corrected}");
        }
    }

    #[test]
    fn a_regime_without_a_default_is_compared_with_nothing() {
        let mut study = study();
        study.rows.truncate(1);
        let compared = compare_with_default(&study, &[record("4(a): B_th 0", 0, true)]).expect("legal rows");
        assert_eq!(compared, [DefaultComparison { against: Against::NoDefault, p: None, p_holm: None }]);
    }

    #[test]
    fn the_p_value_of_two_rates_is_that_of_the_pooled_score() {
        // statsmodels: proportions_ztest([45, 56], [100, 100]) gives 0.11978...
        let rate = |successes| SuccessRate { successes, trials: 100 };
        let p = p_of_two_rates(rate(45), rate(56)).expect("trials");
        assert!((p - 0.119_8).abs() < 5e-4, "{p}");
        assert_eq!(p_of_two_rates(rate(0), rate(0)), Some(1.0));
        assert_eq!(p_of_two_rates(SuccessRate::default(), rate(3)), None);
    }
}

//! The settings of a search as lines of a table: what `settings.csv` holds, the page shows and `--format json` prints.

use crate::monte_carlo::{SuccessRate, paired_difference_interval};
use crate::scenario::{Scenario, ScenarioError};
use crate::sweep::{Axis, Fate, Sample, Standing, choose, confirmed_front, holm};
use serde::Serialize;
use std::collections::BTreeMap;

/// One setting of a search. Rates and differences are fractions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SearchLine {
    /// Index; 0 is the origin, the scenario as it was given.
    pub setting: usize,
    /// Its value on every axis, by dotted key.
    pub values: BTreeMap<String, String>,
    /// How it left the search.
    pub fate: String,
    /// Trials in the rungs.
    pub searched_trials: u64,
    /// Success rate in the rungs, which flatters those that it chose; none without trials.
    pub searched_rate: Option<f64>,
    /// Fresh trials of the confirmation; 0 when it did not come so far. All that follows is of these.
    pub trials: u64,
    /// Trials that ended at one of the two nearest nodes.
    pub successes: u64,
    /// Successes per trial.
    pub success_rate: Option<f64>,
    /// Lower end of the 95 % Wilson interval.
    pub success_rate_low: f64,
    /// Upper end of the 95 % Wilson interval.
    pub success_rate_high: f64,
    /// Mean looks of a localisation.
    pub mean_looks: f64,
    /// Mean work of a localisation: what the search goes by in place of time.
    pub work: f64,
    /// Mean wall time of a localisation in seconds.
    pub mean_localizer_s: f64,
    /// Mean size of the map in bytes.
    pub map_bytes: f64,
    /// Success rate less that of the origin.
    pub difference: Option<f64>,
    /// Lower end of the difference's 95 % interval.
    pub difference_low: Option<f64>,
    /// Upper end of the difference's 95 % interval.
    pub difference_high: Option<f64>,
    /// Two-sided p-value of no difference (McNemar).
    pub p: Option<f64>,
    /// The same after Holm's correction over the confirmed settings.
    pub p_holm: Option<f64>,
    /// Whether no other confirmed setting beats it in success, work and map at once.
    pub is_on_front: bool,
    /// Whether it is the preset that the search wrote.
    pub is_chosen: bool,
}

impl SearchLine {
    /// The confirmed success rate with its interval.
    #[must_use]
    pub fn success(&self) -> SuccessRate {
        SuccessRate { successes: self.successes, trials: self.trials }
    }
}

/// The lines of a finished search over `points` of `axes` about `base`.
///
/// # Errors
/// When a point can't be set.
pub fn search_lines(
    base: &Scenario,
    axes: &[Axis],
    points: &[Vec<String>],
    standings: &[Standing],
    within: f64,
) -> Result<Vec<SearchLine>, ScenarioError> {
    let (front, chosen) = (confirmed_front(standings), choose(standings, within));
    let origin = standings.first().and_then(|standing| standing.confirmed.as_ref());
    let against_origin = |sample: &Sample| origin.map(|origin| origin.against(sample));
    let p_values: Vec<Option<f64>> = standings
        .iter()
        .skip(1)
        .map(|standing| standing.confirmed.as_ref().and_then(against_origin).map(|counts| counts.mcnemar()))
        .collect();
    let corrected = holm(&p_values);
    let line = |(setting, standing): (usize, &Standing)| {
        let sample = standing.confirmed.clone().unwrap_or_default();
        let success = sample.success();
        let counts = standing.confirmed.as_ref().and_then(against_origin).filter(|_| setting > 0);
        let interval = counts.map(|counts| paired_difference_interval(&counts));
        let searched = standing.searched.success();
        Ok(SearchLine {
            setting,
            values: values(base, axes, &points[setting])?,
            fate: fate(standing.fate),
            searched_trials: searched.trials,
            searched_rate: searched.rate(),
            trials: success.trials,
            successes: success.successes,
            success_rate: success.rate(),
            success_rate_low: success.success_interval().0,
            success_rate_high: success.success_interval().1,
            mean_looks: sample.mean_looks(),
            work: sample.merit().work,
            mean_localizer_s: sample.mean_localizer_s(),
            map_bytes: sample.map_bytes,
            difference: counts.and_then(|counts| counts.difference()),
            difference_low: interval.map(|(low, _)| low),
            difference_high: interval.map(|(_, high)| high),
            p: setting.checked_sub(1).and_then(|place| p_values[place]),
            p_holm: setting.checked_sub(1).and_then(|place| corrected[place]),
            is_on_front: front.contains(&setting),
            is_chosen: chosen == Some(setting),
        })
    };
    standings.iter().enumerate().map(line).collect()
}

fn fate(fate: Fate) -> String {
    match fate {
        Fate::Finalist => "confirmed".to_owned(),
        Fate::Beaten { rung, by } => format!("beaten by setting {by} in rung {}", rung + 1),
        Fate::Halved { rung } => format!("not among the better half of rung {}", rung + 1),
    }
}

/// The value of each axis at a point: the point's, or that of the scenario.
fn values(base: &Scenario, axes: &[Axis], point: &[String]) -> Result<BTreeMap<String, String>, ScenarioError> {
    let set = point.iter().try_fold(base.clone(), |scenario, setting| scenario.with_setting(setting))?;
    let whole = toml::Value::try_from(&set).expect("every field of a scenario has a TOML form");
    let value = |key: &str| {
        let leaf = key.split('.').try_fold(&whole, |value, part| value.get(part));
        leaf.map_or_else(String::new, |leaf| leaf.as_str().map_or_else(|| leaf.to_string(), str::to_owned))
    };
    Ok(axes.iter().map(|axis| (axis.key.clone(), value(&axis.key))).collect())
}

/// The lines as CSV: `setting`, a column for each axis, then the fields of [`SearchLine`].
///
/// # Errors
/// When a line can't be written.
pub fn search_csv(lines: &[SearchLine]) -> Result<Vec<u8>, csv::Error> {
    const AFTER_VALUES: [&str; 19] = [
        "fate",
        "searched_trials",
        "searched_rate",
        "trials",
        "successes",
        "success_rate",
        "success_rate_low",
        "success_rate_high",
        "mean_looks",
        "work",
        "mean_localizer_s",
        "map_bytes",
        "difference",
        "difference_low",
        "difference_high",
        "p",
        "p_holm",
        "is_on_front",
        "is_chosen",
    ];
    let mut writer = csv::Writer::from_writer(Vec::new());
    let keys = lines.first().map(|line| line.values.keys().cloned().collect::<Vec<_>>()).unwrap_or_default();
    let header = std::iter::once("setting").chain(keys.iter().map(String::as_str)).chain(AFTER_VALUES);
    writer.write_record(header)?;
    for line in lines {
        let optional = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
        let mut cells = vec![line.setting.to_string()];
        cells.extend(line.values.values().cloned());
        cells.extend([
            line.fate.clone(),
            line.searched_trials.to_string(),
            optional(line.searched_rate),
            line.trials.to_string(),
            line.successes.to_string(),
            optional(line.success_rate),
            line.success_rate_low.to_string(),
            line.success_rate_high.to_string(),
            line.mean_looks.to_string(),
            line.work.to_string(),
            line.mean_localizer_s.to_string(),
            line.map_bytes.to_string(),
            optional(line.difference),
            optional(line.difference_low),
            optional(line.difference_high),
            optional(line.p),
            optional(line.p_holm),
            line.is_on_front.to_string(),
            line.is_chosen.to_string(),
        ]);
        writer.write_record(cells)?;
    }
    writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))
}

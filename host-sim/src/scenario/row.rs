//! The rows of a run: the settings that it compares, each the scenario with a few values of its own.
//!
//! A row states where the robot is put down and whether polarity is used, and may change anything of the localiser, the
//! uncertainty sources and learning:
//!
//! ```toml
//! [[rows]]
//! name = "B_th 0.05, no gaps"
//! start = "near"
//! polarity = true
//! trials = 900                  # unless the scenario's count will do
//! set = { "localizer.score_margin" = 0.05, "uncertainty.edge_detection_loss.enabled" = false }
//! ```
//!
//! World, rig, seed and `trials_per_map` belong to the whole run, because rows are compared on common random numbers: the
//! same building, the same robot poses, and the same draws of every source that two rows share.

use super::load::insert;
use super::{IllegalValue, Scenario};
use edgeloc::localize::LocalizerConfig;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

/// What a row may change, each a table or a value at the top of the scenario.
const CHANGEABLE: [&str; 4] = ["localizer", "uncertainty", "learning", "near_radius_m"];

/// One setting of a run: trials of different rows share robot poses and noise wherever their settings agree.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// Name, unique in the scenario.
    pub name: String,
    /// Where the robot is put down.
    pub start: Start,
    /// Whether the histograms tell which side of an edge is brighter.
    pub polarity: bool,
    /// Trials of this row; those of the scenario when not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trials: Option<u32>,
    /// Values of the scenario that this row changes, by dotted or nested keys.
    #[serde(default, skip_serializing_if = "Table::is_empty")]
    pub set: Table,
}

/// Where the robot of a trial is put down; its heading is uniform in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Start {
    /// Within `near_radius_m` of a node, in free space.
    Near,
    /// Uniform in free space, without what `learning.withheld` keeps from being learned.
    Anywhere,
    /// Uniform over the places that no map knows: in the part that `learning.withheld` keeps from being learned, a walk
    /// of [`UNLEARNED_WAY_M`](crate::learning::UNLEARNED_WAY_M) from every learned node. Right is "I can't tell" there.
    Unlearned,
}

/// A row with the whole scenario that it stands for.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// Name, start and polarity, with nothing left to change.
    pub row: Row,
    /// The scenario with the row's values in place and this row alone: run by itself it gives the same trials.
    pub scenario: Scenario,
}

impl Row {
    /// A row that changes nothing of its scenario.
    #[must_use]
    pub fn new(name: &str, start: Start, polarity: bool) -> Self {
        Self { name: name.to_owned(), start, polarity, trials: None, set: Table::new() }
    }

    /// The same row with the value at a dotted `key` changed.
    #[must_use]
    pub fn with(mut self, key: &str, value: impl Into<Value>) -> Self {
        self.set.insert(key.to_owned(), value.into());
        self
    }

    /// Every value that the row changes, by its full dotted key.
    fn changes(&self) -> Vec<(String, Value)> {
        let mut changes = Vec::new();
        flatten("", &self.set, &mut changes);
        changes
    }
}

impl Setting {
    /// The localiser's parameters.
    #[must_use]
    pub fn localizer_config(&self) -> LocalizerConfig {
        self.scenario.localizer.localizer_config(self.row.polarity)
    }

    /// What was applied in every trial of the row, column by column of `trials.csv`: dotted keys as in a scenario file, and
    /// of each uncertainty source the magnitude, 0 when it is switched off.
    #[must_use]
    pub fn parameters(&self) -> Vec<(String, String)> {
        let whole = Table::try_from(&self.scenario).expect("every field of a scenario has a TOML form");
        let kept = whole.into_iter().filter(|(key, _)| key == "seed" || CHANGEABLE.contains(&key.as_str())).collect();
        let mut leaves = vec![
            ("start".to_owned(), Value::try_from(self.row.start).expect("a word")),
            ("polarity".to_owned(), Value::Boolean(self.row.polarity)),
        ];
        flatten("", &kept, &mut leaves);
        let is_off = |key: &str| leaves.iter().any(|(other, value)| other == key && value.as_bool() == Some(false));
        let applied = leaves.iter().filter_map(|(key, value)| match key.strip_prefix("uncertainty.") {
            Some(source) if source.ends_with(".enabled") => None,
            Some(_) if key.ends_with(".magnitude") && is_off(&key.replace(".magnitude", ".enabled")) => {
                Some((key.clone(), "0".to_owned()))
            }
            _ => Some((key.clone(), value.as_str().map_or_else(|| value.to_string(), str::to_owned))),
        });
        applied.collect()
    }
}

/// For each setting the first that has its [parameters](Setting::parameters): in one run both give the same trials. (A source
/// that is off and one of no magnitude do alike.)
#[must_use]
pub fn first_alike(settings: &[Setting]) -> Vec<usize> {
    let parameters: Vec<_> = settings.iter().map(Setting::parameters).collect();
    let first = |of: &_| parameters.iter().position(|other| other == of).unwrap_or_default();
    parameters.iter().map(first).collect()
}

impl Scenario {
    /// Every row as the whole scenario that it stands for, in order and checked.
    ///
    /// # Errors
    /// The row and the first value of it that can't be set or is not legal.
    pub fn settings(&self) -> Result<Vec<Setting>, IllegalValue> {
        (0..self.rows.len()).map(|index| self.setting_at(index)).collect()
    }

    /// The row called `name`, or the first row, as the whole scenario that it stands for; `None` without such a row.
    ///
    /// # Errors
    /// As [`Self::settings`].
    pub fn setting(&self, name: Option<&str>) -> Option<Result<Setting, IllegalValue>> {
        let is_asked = |row: &Row| name.is_none_or(|name| row.name == name);
        self.rows.iter().position(is_asked).map(|index| self.setting_at(index))
    }

    /// Trials of all rows together.
    #[must_use]
    pub fn total_trials(&self) -> u64 {
        self.rows.iter().map(|row| u64::from(row.trials.unwrap_or(self.trials))).sum()
    }

    fn setting_at(&self, index: usize) -> Result<Setting, IllegalValue> {
        let changed = &self.rows[index];
        let row = Row::new(&changed.name, changed.start, changed.polarity);
        let trials = changed.trials.unwrap_or(self.trials);
        let mut scenario = Self { rows: vec![row.clone()], trials, ..self.clone() };
        let changes = changed.changes();
        for (place, (key, value)) in changes.iter().enumerate() {
            let is_new = changes[..place].iter().all(|(other, _)| other != key);
            scenario = scenario.with_change(key, value, is_new).map_err(|illegal| illegal.in_row(index, &row.name))?;
        }
        if changed.trials.is_some() || !changes.is_empty() {
            scenario.check_values().map_err(|illegal| illegal.in_row(index, &row.name))?;
        }
        if row.start == Start::Unlearned && scenario.learning.withheld <= 0.0 {
            let withheld = IllegalValue {
                row: None,
                key: "learning.withheld".to_owned(),
                value: scenario.learning.withheld.to_string(),
                legal: "above 0 to 0.9 where start = \"unlearned\"".to_owned(),
                remedy:
                    "a robot can start in unlearned places only where some are; write set = { \"learning.withheld\" = \
                         0.25 }"
                        .to_owned(),
            };
            return Err(withheld.in_row(index, &row.name));
        }
        Ok(Setting { row, scenario })
    }

    fn with_change(&self, key: &str, value: &Value, is_new: bool) -> Result<Self, IllegalValue> {
        let refused = |legal: String, remedy: &str| IllegalValue {
            row: None,
            key: key.to_owned(),
            value: value.to_string(),
            legal,
            remedy: remedy.to_owned(),
        };
        let top = key.split('.').next().unwrap_or_default();
        if !CHANGEABLE.contains(&top) {
            let legal = "localizer.*, uncertainty.*, learning.* and near_radius_m".to_owned();
            return Err(refused(legal, remedy_for(top)));
        }
        if !is_new {
            return Err(refused("each key once".to_owned(), "the row sets it twice, dotted and nested; remove one"));
        }
        let mut root = Value::try_from(self).map_err(|error| refused(error.to_string(), ""))?;
        let all_keys = "all keys with their ranges: `edgeloc run paper --print-config`";
        let unknown = |reason: String| refused(format!("a known key and a value of its kind ({reason})"), all_keys);
        insert(&mut root, key, value.clone()).map_err(unknown)?;
        root.try_into().map_err(|error: toml::de::Error| unknown(error.message().to_owned()))
    }
}

/// What to do about a key that a row may not change.
fn remedy_for(top: &str) -> &'static str {
    match top {
        "name" | "start" | "polarity" | "trials" => "write it beside set, not in it",
        _ => {
            "rows of a run are compared on the same world, robot poses and noise draws, so world, rig, seed and \
             trials_per_map belong to the whole run; write another scenario"
        }
    }
}

/// The leaves of a table by their dotted keys.
fn flatten(prefix: &str, table: &Table, leaves: &mut Vec<(String, Value)>) {
    for (key, value) in table {
        let key = match key.strip_prefix("localiser") {
            Some(rest) if prefix.is_empty() => format!("localizer{rest}"),
            _ => format!("{prefix}{key}"),
        };
        match value {
            Value::Table(inner) => flatten(&format!("{key}."), inner, leaves),
            leaf => leaves.push((key, leaf.clone())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STUDY: &str = r#"
        trials = 9
        [[rows]]
        name = "plain"
        start = "near"
        polarity = true
        [[rows]]
        name = "dotted"
        start = "anywhere"
        polarity = false
        trials = 4
        set = { "localizer.score_margin" = 0.05, "uncertainty.edge_detection_loss.enabled" = false }
        [[rows]]
        name = "nested"
        start = "near"
        polarity = true
        set.localiser.pgh.distance_bins = 30
        set.learning.nodes = 40
        set.near_radius_m = 1
    "#;

    fn study(text: &str) -> Scenario {
        Scenario::parse(text, "study").expect("a scenario")
    }

    #[test]
    fn a_row_stands_for_the_scenario_with_its_values_in_place() {
        let study = study(STUDY);
        assert_eq!(study.check(), Ok(()));
        let settings = study.settings().expect("legal rows");
        let base = Scenario { rows: vec![Row::new("plain", Start::Near, true)], ..study.clone() };
        assert_eq!(settings[0].scenario, base);

        let mut dotted = Scenario { rows: vec![Row::new("dotted", Start::Anywhere, false)], trials: 4, ..base.clone() };
        dotted.localizer.score_margin = 0.05;
        dotted.uncertainty.edge_detection_loss.enabled = false;
        assert_eq!(settings[1].scenario, dotted);

        let nested = &settings[2].scenario;
        assert_eq!((nested.localizer.pgh.distance_bins, nested.learning.nodes), (30, 40));
        assert_eq!(nested.near_radius_m.to_string(), "1");
        assert_eq!(study.setting(Some("dotted")), Some(Ok(settings[1].clone())));
        assert_eq!(study.setting(Some("absent")), None);
    }

    #[test]
    fn rows_with_values_read_back_as_written() {
        let study = study(STUDY);
        assert_eq!(Scenario::parse(&study.to_toml(), "written").expect("readable"), study);
    }

    #[test]
    fn an_illegal_row_is_named_with_its_key_and_the_remedy() {
        let illegal = |line: &str| {
            let text = format!("[[rows]]\nname = \"odd\"\nstart = \"near\"\npolarity = true\n{line}\n");
            let illegal = study(&text).check().expect_err("an illegal row");
            format!("{illegal}; {}", illegal.remedy)
        };
        for (line, expected) in [
            ("set = { \"localizer.turn_deg\" = 400 }", &["row \"odd\"", "rows.0.set.localizer.turn_deg = 400"][..]),
            ("set = { \"localizer.turn\" = 3 }", &["rows.0.set.localizer.turn", "unknown field `turn`", "turn_deg"]),
            ("set.localizer = 3", &["rows.0.set.localizer", "invalid type"]),
            ("set.uncertainty.stereo_match.magnitude = 2", &["row \"odd\"", "0 to 0.1"]),
            ("set.seed = 3", &["rows.0.set.seed", "another scenario"]),
            ("set.world.seed = 3", &["rows.0.set.world.seed", "same world"]),
            ("set.trials = 3", &["beside set"]),
            ("set = { \"learning.nodes\" = 3, learning = { nodes = 4 } }", &["learning.nodes", "twice"]),
            ("trials = 0", &["row \"odd\"", "rows.0.trials = 0"]),
        ] {
            let message = illegal(line);
            for part in expected {
                assert!(message.contains(part), "{line}: {message:?} lacks {part:?}");
            }
        }
    }

    #[test]
    fn parameters_are_what_was_applied_and_a_source_switched_off_has_magnitude_zero() {
        let settings = study(STUDY).settings().expect("legal rows");
        let value = |setting: &Setting, key: &str| {
            let parameters = setting.parameters();
            let found = parameters.iter().filter(|(other, _)| other == key).map(|(_, value)| value.clone());
            let found = found.collect::<Vec<_>>();
            assert_eq!(found.len(), 1, "{key}: {parameters:?}");
            found[0].clone()
        };
        for (setting, key, expected) in [
            (0, "localizer.kind", "paper"),
            (0, "localizer.score_margin", "0.1"),
            (1, "localizer.score_margin", "0.05"),
            (0, "uncertainty.edge_detection_loss.magnitude", "0.1125"),
            (1, "uncertainty.edge_detection_loss.magnitude", "0"),
            (1, "start", "anywhere"),
            (1, "polarity", "false"),
            (2, "learning.nodes", "40"),
            (2, "localizer.pgh.distance_bins", "30"),
            (2, "near_radius_m", "1.0"),
            (0, "seed", "1"),
        ] {
            assert_eq!(value(&settings[setting], key), expected, "{key}");
        }
        let keys = |setting: &Setting| setting.parameters().into_iter().map(|(key, _)| key).collect::<Vec<_>>();
        assert_eq!(keys(&settings[0]), keys(&settings[2]));
    }
}

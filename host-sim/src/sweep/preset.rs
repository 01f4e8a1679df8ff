//! A scenario as a preset: only what differs from the bundled setting of the paper, which every scenario lies over.

use crate::scenario::Scenario;
use toml::{Table, Value};

/// The TOML of a scenario that states no more than it must, below a comment of the given lines.
#[must_use]
pub fn preset_toml(scenario: &Scenario, comment: &[String]) -> String {
    let table = |scenario: &Scenario| Table::try_from(scenario).expect("every field of a scenario has a TOML form");
    let mut changed = what_differs(table(scenario), &table(&Scenario::default()));
    changed.insert("name".to_owned(), Value::String(scenario.name.clone()));
    let comment: String = comment.iter().map(|line| format!("# {line}\n")).collect();
    let text = toml::to_string(&changed).expect("a part of a table that has a TOML form");
    format!("{comment}{text}")
}

/// The leaves of `table` that `base` lacks or has otherwise; lists stay whole, and so does a world, whose keys belong
/// together.
fn what_differs(table: Table, base: &Table) -> Table {
    let differs = |(key, value): (String, Value)| match (value, base.get(&key)) {
        (Value::Table(inner), Some(Value::Table(other))) if key != "world" => {
            let inner = what_differs(inner, other);
            (!inner.is_empty()).then_some((key, Value::Table(inner)))
        }
        (value, Some(other)) if value == *other => None,
        (value, _) => Some((key, value)),
    };
    table.into_iter().filter_map(differs).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::WorldChoice;
    use std::path::PathBuf;

    #[test]
    fn a_preset_reads_back_as_its_scenario_and_states_only_what_differs() {
        let mut scenario = Scenario { name: "fast".to_owned(), ..Scenario::default() };
        scenario.localizer.turn_deg = 60.0;
        scenario.localizer.pgh.distance_bins = 10;
        scenario.world = WorldChoice::file(PathBuf::from("/a/b.edgeworld"));
        let text = preset_toml(&scenario, &["found by a search".to_owned()]);
        assert_eq!(Scenario::parse(&text, "preset").expect("a scenario"), scenario);
        assert!(text.starts_with("# found by a search\n") && text.lines().count() < 14, "{text}");
        assert!(!text.contains("angle_bins") && !text.contains("uncertainty"), "{text}");
    }
}

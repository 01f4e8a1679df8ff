//! The arguments of every verb that works on a scenario.

use super::console;
use super::world::file_stem;
use clap::Args;
use edgeloc_sim::scenario::{Building, IllegalValue, Scenario, ScenarioError, Setting};
use miette::{Result, miette};
use std::path::PathBuf;

/// Which scenario, and what to change in it.
#[derive(Debug, Clone, Args)]
pub(super) struct ScenarioArguments {
    /// Scenario file (.toml), or a bundled scenario: edgeloc, paper, demo, stress, ablation, smoke, figures, paper-scale.
    #[arg(default_value = "edgeloc")]
    scenario: String,
    #[command(flatten)]
    changes: ScenarioChanges,
}

/// What to change in a scenario.
#[derive(Debug, Clone, Default, Args)]
pub(super) struct ScenarioChanges {
    /// World file (.edgeworld) instead of the scenario's world; its name joins the scenario's.
    #[arg(long, value_name = "FILE")]
    pub(super) world: Option<PathBuf>,
    /// Change one setting, such as localizer.turn_deg=60 or rows.0.polarity=false; may be repeated.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    settings: Vec<String>,
    /// Trials of each row, whatever the row states.
    #[arg(long, value_name = "N")]
    trials: Option<u32>,
    /// Nodes of the map.
    #[arg(long, value_name = "N")]
    nodes: Option<u16>,
    /// Seed of all random draws.
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Print the whole scenario as TOML that runs as it is, and stop.
    #[arg(long)]
    pub(super) print_config: bool,
}

impl ScenarioArguments {
    /// The scenario, checked; none when it was only to be printed.
    pub(super) fn load(&self) -> Result<Option<Scenario>> {
        self.changes.load(&self.scenario)
    }
}

impl ScenarioChanges {
    /// The scenario called `name` with these changes, checked; none when it was only to be printed.
    pub(super) fn load(&self, name: &str) -> Result<Option<Scenario>> {
        self.load_adapted(name, |scenario| scenario)
    }

    /// The same, with its rows adapted by a verb of its own.
    pub(super) fn load_adapted(
        &self,
        name: &str,
        adapt: impl FnOnce(Scenario) -> Scenario,
    ) -> Result<Option<Scenario>> {
        let numbers = [
            self.trials.map(|trials| format!("trials={trials}")),
            self.nodes.map(|nodes| format!("learning.nodes={nodes}")),
            self.seed.map(|seed| format!("seed={seed}")),
        ];
        let settings = self.settings.iter().cloned().chain(numbers.into_iter().flatten()).collect::<Vec<_>>();
        let mut scenario = adapt(Scenario::load(name, &settings)?);
        if let Some(world) = &self.world {
            let file = std::path::absolute(world).unwrap_or_else(|_| world.clone());
            let is_named = |setting: &String| setting.split('=').next().is_some_and(|key| key.trim() == "name");
            if !self.settings.iter().any(is_named) {
                let building = world.file_stem().unwrap_or_default().to_string_lossy();
                // Both parts are ASCII, so that any byte is a place to cut.
                scenario.name = format!("{}-{}", scenario.name, file_stem(&building));
                scenario.name.truncate(Scenario::MAX_NAME_BYTES);
            }
            scenario.world.building = Building::File { file };
        }
        if self.trials.is_some() {
            scenario.rows.iter_mut().for_each(|row| row.trials = None);
        }
        scenario.check().map_err(refused)?;
        if self.print_config {
            console::print(&scenario.to_toml())?;
            return Ok(None);
        }
        Ok(Some(scenario))
    }
}

/// The row called `name`, or the first one, with the scenario that it stands for.
pub(super) fn find_setting(scenario: &Scenario, name: Option<&str>) -> Result<Setting> {
    let rows = scenario.rows.iter().map(|row| format!("{:?}", row.name)).collect::<Vec<_>>().join(", ");
    let asked = name.unwrap_or_default();
    scenario
        .setting(name)
        .ok_or_else(|| miette!(help = format!("rows: {rows}"), "there is no row {asked:?} in the scenario"))?
        .map_err(|illegal| refused(illegal).into())
}

fn refused(illegal: IllegalValue) -> ScenarioError {
    ScenarioError::Illegal { illegal: Box::new(illegal), text: None, place: None }
}

//! Everything that defines a run: world, rig, learning, localiser and the rows of trials.
//!
//! A scenario is a TOML file, laid over the values of the bundled preset `paper` and under the
//! `--set key=value` settings of the command line. It is checked once ([`Scenario::check`]) and written beside the
//! results, so that a run can be repeated from what it left behind. Every field carries its unit in its name; the legal
//! ranges stand in [`Scenario::check`] and in the bundled `paper.toml`.

mod check;
mod error;
mod load;
mod localizer;
mod preset;
mod rig;
mod row;
mod world_choice;

pub use error::{IllegalValue, ScenarioError};
pub use localizer::{LocalizerKind, LocalizerSettings, PghSettings, VerificationSettings};
pub use preset::{PRESETS, Preset};
pub use rig::RigSettings;
pub use row::{Row, Setting, Start, first_alike};
pub use world_choice::{Building, VisibilityChoice, WorldChoice};

use crate::learning::NodePlacement;
use crate::uncertainty::Sources;
use serde::{Deserialize, Serialize};

/// Everything that defines a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Scenario {
    /// Name, fit for a folder.
    pub name: String,
    /// Seed of all random draws of the run; the same seed gives the same `trials.csv`.
    pub seed: u64,
    /// Trials of each row that does not state its own.
    pub trials: u32,
    /// Trials that share one draw of the map's noise; then the world is learned anew.
    pub trials_per_map: u32,
    /// Greatest distance from a node of a start of [`Start::Near`] in metres.
    pub near_radius_m: f64,
    /// The world.
    pub world: WorldChoice,
    /// The stereo rig that learns and localises.
    pub rig: RigSettings,
    /// How the world is learned.
    pub learning: LearningSettings,
    /// The localiser; its British spelling is understood too.
    #[serde(alias = "localiser")]
    pub localizer: LocalizerSettings,
    /// The uncertainty sources.
    pub uncertainty: Sources,
    /// The rows of the run: the settings that are compared.
    pub rows: Vec<Row>,
}

impl Default for Scenario {
    /// The paper's setting in the bundled office, the preset `paper`.
    fn default() -> Self {
        Self {
            name: "paper".to_owned(),
            seed: 1,
            trials: 500,
            trials_per_map: 50,
            near_radius_m: 0.3,
            world: WorldChoice::office(1),
            rig: RigSettings::default(),
            learning: LearningSettings::default(),
            localizer: LocalizerSettings::default(),
            uncertainty: Sources::default(),
            rows: vec![
                Row::new("near, polarity", Start::Near, true),
                Row::new("near, no polarity", Start::Near, false),
                Row::new("anywhere, polarity", Start::Anywhere, true),
                Row::new("anywhere, no polarity", Start::Anywhere, false),
            ],
        }
    }
}

impl Scenario {
    /// The row called `name`, or the first row when no name is given.
    #[must_use]
    pub fn row(&self, name: Option<&str>) -> Option<&Row> {
        match name {
            Some(name) => self.rows.iter().find(|row| row.name == name),
            None => self.rows.first(),
        }
    }
}

/// How the world is learned.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LearningSettings {
    /// Nodes placed in the free space; 72 in the paper.
    pub nodes: u16,
    /// Where they are placed.
    pub placement: NodePlacement,
    /// Views learned at each node, evenly around the circle; 12 in the paper.
    pub views: u16,
    /// Whether pieces of one edge become one segment of the model again; not in the paper.
    pub join: bool,
    /// The most segments of a node's model; those are kept that tell most. Not in the paper.
    pub max_segments: u16,
    /// Share of the free space, one connected part, whose nodes are not learned; for rows that start unlearned.
    pub withheld: f64,
}

impl Default for LearningSettings {
    fn default() -> Self {
        Self {
            nodes: 72,
            placement: NodePlacement::Spread,
            views: 12,
            join: false,
            max_segments: u16::MAX,
            withheld: 0.0,
        }
    }
}

/// The shortest decimal number that rounds to `value`: 0.12, not 0.11999999731779099.
fn decimal(value: f32) -> f64 {
    value.to_string().parse().expect("a float prints as a number")
}

//! `locate`: one attempt, explained.

use super::attempt::{Attempt, JSON_FIELDS};
use super::console::Format;
use super::scenario_args::{ScenarioArguments, find_setting};
use super::trials;
use super::world::{file_stem, parse_place};
use clap::Args;
use edgeloc::geometry::{Angle, Heading, Point2};
use edgeloc_sim::monte_carlo::{Site, TruePose};
use miette::{Result, miette};
use std::path::PathBuf;

/// Put the robot down once and explain, look by look, how it finds out where it is; one drawing a look.
#[derive(Debug, Args)]
#[command(after_help = format!("Examples:\n  edgeloc locate\n  edgeloc locate --row near --trial 3\n  \
                        edgeloc locate paper --row 'anywhere, no polarity' --trial 3\n  \
                        edgeloc locate --world small_house.edgeworld --at 5,-2 --heading-deg 90\n\n\
                        JSON (--format json): {JSON_FIELDS}."))]
pub(super) struct Locate {
    #[command(flatten)]
    scenario: ScenarioArguments,
    /// Row of the scenario; the first when not given.
    #[arg(long, value_name = "NAME")]
    row: Option<String>,
    /// Trial: which start is drawn, and which noise.
    #[arg(long, value_name = "I", default_value_t = 0)]
    trial: u32,
    /// Put the robot here [m] instead of at the trial's start.
    #[arg(long, value_name = "X,Y", value_parser = parse_place, allow_hyphen_values = true)]
    at: Option<Point2>,
    /// With --at: the heading at the first look [degrees], counter-clockwise from +x.
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, requires = "at", allow_hyphen_values = true)]
    heading_deg: f32,
    /// Folder for the drawings [default: locate-<scenario>-<trial>]; drawings of the same name are overwritten.
    #[arg(short, long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

impl Locate {
    pub(super) fn execute(self) -> Result<()> {
        let Some(scenario) = self.scenario.load()? else { return Ok(()) };
        let setting = find_setting(&scenario, self.row.as_deref())?;
        let site = trials::prepare(&setting.scenario)?;
        let start = self.start(&site)?;
        let folder = self
            .out
            .clone()
            .unwrap_or_else(|| PathBuf::from(format!("locate-{}-{}", file_stem(&scenario.name), self.trial)));
        Attempt::make(&site, &setting, self.trial, start, &folder)?.print(self.format)
    }

    fn start(&self, site: &Site) -> Result<Option<TruePose>> {
        let Some(position) = self.at else { return Ok(None) };
        if !site.free_space.contains(position) {
            return Err(miette!(
                help = "`edgeloc world view` draws free space tinted; node 0 is free, for one",
                "the robot can't stand at {}, {} m",
                position.x,
                position.y
            ));
        }
        let heading = Heading::new(Angle::from_degrees(self.heading_deg)).ok_or_else(|| {
            miette!(help = "give degrees, such as 90", "--heading-deg {} is no heading", self.heading_deg)
        })?;
        Ok(Some(TruePose { position, heading }))
    }
}

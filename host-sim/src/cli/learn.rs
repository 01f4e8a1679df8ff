//! `learn`: a world becomes a map, the file that goes into a robot's flash.

use super::console::{self, Format};
use super::coverage;
use super::map::{JSON_FIELDS, MapDescription};
use super::scenario_args::ScenarioArguments;
use super::world::file_stem;
use super::{trials, worlds};
use clap::Args;
use edgeloc_sim::report::{FloorPlan, to_svg_file};
use miette::{IntoDiagnostic, Result};
use std::path::PathBuf;

/// Learn a world: place nodes, look around from each through the uncertainty sources, write the map (.edgemap).
///
/// The map is the topological database that the on-robot library opens in place: put the file byte for byte into the
/// robot's flash (include_bytes! in its firmware, or a region of its own) and give these bytes to
/// TopologicalDatabase::open. Nothing is unpacked or copied.
#[derive(Debug, Args)]
#[command(after_help = format!("Examples:\n  edgeloc learn\n  edgeloc learn --world small_house.edgeworld --nodes 40\n  \
                        edgeloc learn my.toml --noise-draw 3 -o flash.edgemap\n\n\
                        JSON (--format json): {JSON_FIELDS}."))]
pub(super) struct Learn {
    #[command(flatten)]
    scenario: ScenarioArguments,
    /// Which draw of the map's noise; trials of a run use 0, 1, 2, ... in turn.
    #[arg(long, value_name = "I", default_value_t = 0)]
    noise_draw: u32,
    /// Map to write [default: the name of the world, .edgemap].
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Also draw the nodes, and what they cover poorly, from above.
    #[arg(long, value_name = "FILE")]
    plan: Option<PathBuf>,
    /// Overwrite the map and the plan.
    #[arg(long)]
    force: bool,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

impl Learn {
    pub(super) fn execute(self) -> Result<()> {
        let Some(scenario) = self.scenario.load()? else { return Ok(()) };
        let site = trials::prepare(&scenario)?;
        let default_output = || PathBuf::from(format!("{}.edgemap", file_stem(&site.world.name)));
        let path = self.output.clone().unwrap_or_else(default_output);
        for file in [Some(&path), self.plan.as_ref()].into_iter().flatten() {
            console::check_overwrite(file, self.force)?;
        }
        console::remark(&format!(
            "a node for each {:.1} m2 of {}",
            site.free_m2_per_node(),
            site.free_space.describe()
        ));
        let coverage = site.coverage();
        coverage::tell(site.nodes.len(), &coverage);
        let bytes = site.learn_map(&scenario, self.noise_draw).into_diagnostic()?;
        console::write_file(&path, &bytes)?;
        if let Some(file) = &self.plan {
            let free = worlds::free_cells(&site.free_space);
            let plan = FloorPlan::new(Some(&site.world), Some(&free), &site.nodes).with_poor_places(&coverage);
            let drawing = plan.canvas().add(plan.background()).add(plan.node_marks()).add(plan.scale_bar());
            console::write_file(file, to_svg_file(drawing).as_bytes())?;
        }
        MapDescription::new(&path, &bytes)?.print(self.format)
    }
}

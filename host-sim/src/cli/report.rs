//! `report`: the figures and the page of a finished run.

use super::console::{self, Format};
use super::run::{JSON_FIELDS, RunPrinted};
use super::scenario_args::find_setting;
use super::trials::{behind_link, name, unchanged_world};
use super::{coverage, summary_table, worlds};
use clap::Args;
use edgeloc_sim::report::{FloorPlan, RunFolder, RunResults, page, to_svg_file, trials_plan};
use edgeloc_sim::world::{FreeSpace, FreeSpaceOptions, WireframeWorld};
use miette::Result;
use std::path::{Path, PathBuf};

/// Print the figures of a finished run and write its report.html anew.
#[derive(Debug, Args)]
#[command(after_help = format!(
    "Examples:\n  edgeloc report runs/latest\n  edgeloc report runs/2026-01-31-paper --format json\n  \
                  edgeloc report runs/latest --plan plan.svg --row 'near, polarity'\n\n\
     JSON (--format json): {JSON_FIELDS}."
))]
pub(super) struct Report {
    /// Folder of the run.
    run: PathBuf,
    /// Also write the plan of one row's trials, as a drawing of its own.
    #[arg(long, value_name = "FILE")]
    plan: Option<PathBuf>,
    /// Overwrite the plan.
    #[arg(long, requires = "plan")]
    force: bool,
    /// Row of the plan [default: the first].
    #[arg(long, requires = "plan")]
    row: Option<String>,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

impl Report {
    pub(super) fn execute(self) -> Result<()> {
        if let Some(plan) = &self.plan {
            console::check_overwrite(plan, self.force)?;
        }
        let (folder, results) = open(&self.run)?;
        let world = match world_of(&results) {
            Ok(world) => Some(world),
            Err(error) => {
                console::remark(&format!("the report goes without the world: {error}"));
                None
            }
        };
        let free = world.as_ref().and_then(|world| FreeSpace::of(world, &FreeSpaceOptions::default()).ok());
        let coverage = world.as_ref().zip(free.as_ref());
        let coverage = coverage.map(|(world, free)| coverage::of_rows(world, free, &results.scenario, &results.nodes));
        let coverage = coverage.unwrap_or_default();
        let free = free.as_ref().map(|free| worlds::free_cells_of_run(free, &results.scenario));
        let report = page(&results, world.as_ref(), free.as_ref(), &coverage, &name(folder.path()));
        let report = folder.write("report.html", report.as_bytes())?;
        if let Some(path) = &self.plan {
            let row = find_setting(&results.scenario, self.row.as_deref())?.row;
            let nodes = results.scenario.rows.iter().position(|other| other.name == row.name).unwrap_or(0);
            let mut plan = FloorPlan::new(world.as_ref(), free.as_ref(), &results.nodes[nodes]);
            if let Some(free) = &free {
                plan = plan.with_withheld(free, free.withheld.get(nodes).map_or(&[], Vec::as_slice));
            }
            if let Some(coverage) = coverage.get(nodes) {
                plan = plan.with_poor_places(coverage);
            }
            let records = results.records.iter().filter(|record| record.row == row.name);
            console::write_file(path, to_svg_file(trials_plan(&plan, records)).as_bytes())?;
        }
        if self.format == Format::Json {
            return console::print_json(&RunPrinted { folder: folder.path(), summary: &results.summary });
        }
        console::print(&summary_table::headline(&results).to_string())?;
        console::print(&summary_table::answers(&results).to_string())?;
        console::print(&summary_table::remarks(&results))?;
        console::print(&format!("report written: {}", report.display()))
    }
}

/// A finished run: its folder, whatever link led there, and its results.
pub(super) fn open(path: &Path) -> Result<(RunFolder, RunResults)> {
    let folder = RunFolder::open(&behind_link(path))?;
    let results = folder.read_results()?;
    Ok((folder, results))
}

/// The world that a run took place in, if it is still the same.
pub(super) fn world_of(results: &RunResults) -> Result<WireframeWorld> {
    unchanged_world(&results.scenario, &results.manifest)
}

//! `merge`: the shards of a run put together.

use super::console::{self, Format};
use super::run::{JSON_FIELDS, RunPrinted};
use super::trials::{behind_link, name, unchanged_world};
use super::{coverage, summary_table, worlds};
use clap::Args;
use edgeloc_sim::report::{RunFolder, ShardResults, merge, page};
use edgeloc_sim::world::{FreeSpace, FreeSpaceOptions};
use miette::Result;
use std::path::PathBuf;

/// Put the shards of a run together; the result is that of the run in one piece.
///
/// Every shard must be there once, finished, and of the same scenario, world and version of the program: otherwise the
/// folders that are missing, doubled or foreign are named and nothing is written. A world file may lie elsewhere on each
/// machine: its checksum decides. trials.csv, nodes.csv, summary.json and scenario.toml are byte for byte those of the
/// whole run, but for the path of a world file, which is that of the first folder given.
#[derive(Debug, Args)]
#[command(after_help = format!(
    "Examples:\n  edgeloc merge runs/2026-01-31-paper-shard-*\n  edgeloc merge one/runs/latest two/runs/latest --out all\n\n\
     JSON (--format json): {JSON_FIELDS}."
))]
pub(super) struct Merge {
    /// Folders of all shards, in any order.
    #[arg(required = true, value_name = "FOLDER")]
    shards: Vec<PathBuf>,
    /// Folder that gets a folder of the whole run.
    #[arg(short, long, value_name = "FOLDER", default_value = "runs")]
    out: PathBuf,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

impl Merge {
    pub(super) fn execute(self) -> Result<()> {
        let mut shards = Vec::new();
        for path in &self.shards {
            let folder = RunFolder::open(&behind_link(path))?;
            let results = folder.read_results()?;
            let look_times = folder.read_look_times(&results.records)?;
            shards.push(ShardResults { folder: name(folder.path()), results, look_times });
        }
        let (results, look_times) = merge(shards)?;
        let world = unchanged_world(&results.scenario, &results.manifest);
        let world = world.map_err(|error| console::remark(&format!("the report goes without the world: {error}"))).ok();
        let free = world.as_ref().and_then(|world| FreeSpace::of(world, &FreeSpaceOptions::default()).ok());
        let coverage = world.as_ref().zip(free.as_ref());
        let coverage = coverage.map(|(world, free)| coverage::of_rows(world, free, &results.scenario, &results.nodes));
        let coverage = coverage.unwrap_or_default();
        let free = free.as_ref().map(|free| worlds::free_cells_of_run(free, &results.scenario));

        let date = jiff::Zoned::now().strftime("%Y-%m-%d").to_string();
        let folder = RunFolder::create(&self.out, &date, &results.scenario.name)?;
        let report = page(&results, world.as_ref(), free.as_ref(), &coverage, &name(folder.path()));
        folder.write("report.html", report.as_bytes())?;
        folder.write_results(&results, &look_times)?;
        if let Err(error) = folder.link_latest() {
            console::remark(&format!("the run is complete, but {error}"));
        }
        if self.format == Format::Json {
            return console::print_json(&RunPrinted { folder: folder.path(), summary: &results.summary });
        }
        console::print(&summary_table::headline(&results).to_string())?;
        console::print(&summary_table::answers(&results).to_string())?;
        console::print(&format!("report: {}", folder.path().join("report.html").display()))
    }
}

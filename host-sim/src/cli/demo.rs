//! `demo`: what `cargo run --release` does.

use super::console::{self, Format};
use super::run::{JSON_FIELDS, RunPrinted};
use super::scenario_args::ScenarioChanges;
use super::summary_table;
use super::trials::{self, RunArguments, name};
use clap::Args;
use miette::Result;

/// Learn the bundled office and put a robot down in it 1000 times: the paper's localiser and ours, on the same poses.
#[derive(Debug, Default, Args)]
#[command(after_help = format!(
    "Examples:\n  edgeloc demo\n  edgeloc demo --trials 900 --threads 4\n  edgeloc demo --seed 2 --format json\n\n\
     JSON (--format json): {JSON_FIELDS}."
))]
pub(super) struct Demo {
    #[command(flatten)]
    changes: ScenarioChanges,
    #[command(flatten)]
    how: RunArguments,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

impl Demo {
    pub(super) fn execute(self) -> Result<()> {
        let Some(scenario) = self.changes.load("demo")? else { return Ok(()) };
        if self.format == Format::Text {
            console::print(&format!(
                "A robot wakes up somewhere in an office that it has learned before: {} of {} each.\n\
                 It looks around and says where it is by the straight edges it sees; {} times anywhere in free space, on the\n\
                 same poses and noise with the paper's localiser, which names a node, and with ours, which answers with a\n\
                 pose or says that it can't tell. Right is one of the two nearest nodes.\n",
                console::count(scenario.learning.nodes, "node"),
                console::count(scenario.learning.views, "view"),
                scenario.trials,
            ))?;
        }
        let (folder, results) = trials::run(scenario, &self.how, None, "run")?;
        if self.format == Format::Json {
            return console::print_json(&RunPrinted { folder: folder.path(), summary: &results.summary });
        }
        console::print(&summary_table::headline(&results).to_string())?;
        console::print(&summary_table::answers(&results).to_string())?;
        console::print(&summary_table::remarks(&results))?;
        let report = folder.path().join("report.html");
        let folder = name(folder.path());
        let worst =
            summary_table::worst_replay(&results, &folder).unwrap_or_else(|| format!("edgeloc replay {folder}"));
        console::print(&format!(
            "\nLook at the report:          {}\n\
             Watch its worst trial:       {worst}\n\
             Draw the office:             edgeloc world generate --seed 1 && edgeloc world view office-1.edgeworld\n\
             Try your own building:       edgeloc world import BUILDING.world\n\
             Validate in many worlds:     edgeloc validate --trials 100\n\
             Change anything:             edgeloc run edgeloc --print-config > my.toml\n\
             (edgeloc is target/release/edgeloc here, or cargo run --release -- VERB)",
            report.display()
        ))
    }
}

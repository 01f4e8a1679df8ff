//! `run`: all trials of a scenario.

use super::console::{self, Format};
use super::scenario_args::ScenarioArguments;
use super::trials::{self, RunArguments};
use super::{summary_table, trials::name};
use clap::Args;
use edgeloc_sim::monte_carlo::Shard;
use edgeloc_sim::report::Summary;
use miette::Result;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// The fields that `--format json` prints for a run, for the help.
pub(super) const JSON_FIELDS: &str = "\
folder, and summary = what summary.json holds (rates are fractions of 1): scenario, free_area_m2, paper_rate, paper_interval \
(low, high), rows. Each of the rows: row, start, polarity, nodes, map (mean_bytes, mean_segments_per_node, \
free_m2_per_node), chance_rate of blind guessing, trials, successes, success_rate (null without trials) with its 95 % Wilson interval success_rate_low \
to success_rate_high, answers, unknown (can't tell) and errors in trials, mean_looks, median_looks, mean_segments_per_look, \
mean_nearest_node_distance_m, median_answer_distance_m (null without answers). answers: coverage (trials answered), false_accepts \
(wrong answers, of all answers; where starts are unlearned answers of all trials), truth_named (trials right, or with the truth \
among the rivals named), each with count, of, rate, low and high of the interval; near_ties (answers within 0.5 m whose node is not one \
of the two nearest), pose_error_median_m, pose_error_95_m, pose_error_99_m, heading_error_median_deg and calibration_error of \
the probabilities stated (null without poses or probabilities)";

/// Arguments that say what to run, which the folder of an interrupted run knows.
const NOT_WITH_RESUME: [&str; 9] =
    ["scenario", "world", "settings", "trials", "nodes", "seed", "print_config", "shard", "out"];

/// Run the kidnapped-robot trials of a scenario; the results go to a folder of their own.
///
/// The folder, runs/<date>-<scenario>, holds the manifest, the whole scenario, trials.csv (no wall times in it: the same
/// scenario gives the same bytes), nodes.csv, summary.json, timings.json, look_times.csv and report.html.
/// runs/latest points at the newest. While the run is under way the folder holds a journal of the trials that ended: Ctrl-C,
/// a crash or a power cut loses no more than those under way, and --resume goes on. The wall time of a resumed run is that
/// before and after the interruption together.
#[derive(Debug, Args)]
#[command(after_help = format!("Examples:\n  edgeloc run smoke\n  edgeloc run paper --trials 900\n  \
                        edgeloc run my.toml --world small_house.edgeworld --set localizer.turn_deg=60\n  \
                        edgeloc run paper --print-config > my.toml\n  \
                        edgeloc run --resume runs/latest                 after Ctrl-C or a power cut\n  \
                        edgeloc run paper --shard 2/3                    a third of it, on another machine\n\n\
                        JSON (--format json): {JSON_FIELDS}."))]
pub(super) struct Run {
    #[command(flatten)]
    scenario: ScenarioArguments,
    #[command(flatten)]
    how: RunArguments,
    /// Run only the K-th of N parts of the trials, from 1; `edgeloc merge` puts the parts together.
    #[arg(long, value_name = "K/N")]
    shard: Option<Shard>,
    /// Go on with an interrupted run in its folder; the result is that of an uninterrupted one.
    #[arg(long, value_name = "FOLDER", conflicts_with_all = NOT_WITH_RESUME)]
    resume: Option<PathBuf>,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// What `--format json` prints.
#[derive(Serialize)]
pub(super) struct RunPrinted<'r> {
    /// Folder of the run.
    pub(super) folder: &'r Path,
    /// Its figures.
    pub(super) summary: &'r Summary,
}

impl Run {
    pub(super) fn execute(self) -> Result<()> {
        let (folder, results) = match &self.resume {
            Some(folder) => trials::resume(folder, self.how.threads, "run")?,
            None => {
                let Some(scenario) = self.scenario.load()? else { return Ok(()) };
                trials::run(scenario, &self.how, self.shard, "run")?
            }
        };
        if self.format == Format::Json {
            return console::print_json(&RunPrinted { folder: folder.path(), summary: &results.summary });
        }
        console::print(&summary_table::headline(&results).to_string())?;
        console::print(&summary_table::answers(&results).to_string())?;
        console::print(&summary_table::remarks(&results))?;
        console::print(&format!("report: {}", folder.path().join("report.html").display()))?;
        if let Some(shard) = results.manifest.shard {
            console::print(&format!("shard {shard}; all of them together: edgeloc merge FOLDER..."))?;
        }
        match summary_table::worst_replay(&results, &name(folder.path())) {
            Some(command) => console::print(&format!("worst trial: {command}")),
            None => Ok(()),
        }
    }
}

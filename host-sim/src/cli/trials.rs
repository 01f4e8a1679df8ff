//! Running a scenario and writing its folder: what `run` and `demo` share.

use super::console;
use super::progress::{self, TrialProgress};
use super::worlds;
use clap::Args;
use edgeloc_sim::monte_carlo::{self, Site};
use edgeloc_sim::report::{Manifest, MapFacts, RunFolder, RunResults, RunTimings, Summary, WorldFacts, page};
use edgeloc_sim::scenario::Scenario;
use miette::{IntoDiagnostic, Result};
use std::path::{Path, PathBuf};
use std::time::Instant;
use tracing::info;

/// How to run, whatever the scenario.
#[derive(Debug, Clone, Args)]
pub(super) struct RunArguments {
    /// Threads; all of the machine when not given. The results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    threads: Option<u16>,
    /// Folder that gets a folder of this run.
    #[arg(long, value_name = "FOLDER", default_value = "runs")]
    out: PathBuf,
}

impl Default for RunArguments {
    fn default() -> Self {
        Self { threads: None, out: PathBuf::from("runs") }
    }
}

/// Makes the scenario's world ready for learning and trials.
pub(super) fn prepare(scenario: &Scenario) -> Result<Site> {
    let _wheel = progress::wheel("looking around in the world");
    let world = worlds::open(&scenario.world)?;
    let site = Site::prepare(world, scenario).into_diagnostic()?;
    info!("{}", site.free_space.describe());
    Ok(site)
}

/// Runs a scenario and writes its folder.
pub(super) fn run(scenario: Scenario, arguments: &RunArguments) -> Result<(RunFolder, RunResults)> {
    let (started, start) = (jiff::Timestamp::now(), Instant::now());
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(arguments.threads.map_or(0, usize::from))
        .build()
        .into_diagnostic()?;
    let site = pool.install(|| prepare(&scenario))?;
    let prepare_time = start.elapsed();

    let start = Instant::now();
    let progress = TrialProgress::new(&scenario);
    let outcome = pool.install(|| monte_carlo::run(&site, &scenario, &|record| progress.count(record)));
    drop(progress);
    let outcome = outcome.into_diagnostic()?;
    let times = &outcome.look_times;
    let timings = RunTimings::new(&scenario.rows, &outcome.records, times, prepare_time, start.elapsed());

    let map = MapFacts {
        mean_bytes: outcome.map_bytes,
        mean_segments_per_node: outcome.segments_per_node,
        free_m2_per_node: site.free_m2_per_node(),
    };
    let world = WorldFacts::new(&site.world, &scenario.world);
    let threads = pool.current_num_threads();
    let results = RunResults {
        manifest: Manifest::new(&scenario, world, threads, outcome.records.len(), started),
        summary: Summary::new(&scenario, &site.nodes, map, &outcome.records),
        nodes: site.nodes.clone(),
        records: outcome.records,
        scenario,
        timings,
    };
    let date = jiff::Zoned::now().strftime("%Y-%m-%d").to_string();
    let folder = RunFolder::create(&arguments.out, &date, &results.scenario.name)?;
    let report = page(&results, Some(&site.world), Some(&worlds::free_cells(&site.free_space)), &name(folder.path()));
    folder.write("report.html", report.as_bytes())?;
    folder.write_results(&results, &outcome.look_times)?;
    if let Err(error) = folder.link_latest() {
        console::remark(&format!("the run is complete, but {error}"));
    }
    Ok((folder, results))
}

/// How commands and reports name a folder.
pub(super) fn name(path: &Path) -> String {
    path.display().to_string()
}

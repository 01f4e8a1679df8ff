//! Running a scenario and writing its folder: what `run` and `demo` share.

use super::console;
use super::progress::{self, TrialProgress};
use super::worlds;
use clap::Args;
use edgeloc_sim::monte_carlo::{self, Site, Sites};
use edgeloc_sim::report::{Manifest, RunFolder, RunResults, RunTimings, Summary, WorldFacts, page};
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

/// Makes the world ready for every row of the scenario.
fn prepare_rows(scenario: &Scenario) -> Result<Sites> {
    let _wheel = progress::wheel("looking around in the world");
    let sites = Sites::prepare(worlds::open(&scenario.world)?, scenario).into_diagnostic()?;
    info!("{}", sites.all()[0].free_space.describe());
    Ok(sites)
}

/// Runs a scenario and writes its folder.
pub(super) fn run(scenario: Scenario, arguments: &RunArguments) -> Result<(RunFolder, RunResults)> {
    let (started, start) = (jiff::Timestamp::now(), Instant::now());
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(arguments.threads.map_or(0, usize::from))
        .build()
        .into_diagnostic()?;
    let sites = pool.install(|| prepare_rows(&scenario))?;
    let site = &sites.all()[0];
    let prepare_time = start.elapsed();

    let start = Instant::now();
    let progress = TrialProgress::new(&scenario);
    let outcome = pool.install(|| monte_carlo::run(&sites, &|record| progress.count(record)));
    drop(progress);
    let outcome = outcome.into_diagnostic()?;
    let times = &outcome.look_times;
    let timings = RunTimings::new(&scenario.rows, &outcome.records, times, prepare_time, start.elapsed());

    let nodes: Vec<_> = (0..scenario.rows.len()).map(|row| sites.of_row(row).nodes.clone()).collect();
    let world = WorldFacts::new(&site.world, &scenario.world);
    let threads = pool.current_num_threads();
    let results = RunResults {
        manifest: Manifest::new(&scenario, world, threads, outcome.records.len(), started),
        summary: Summary::new(&scenario, &nodes, site.free_space.area_m2(), &outcome.records),
        nodes,
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

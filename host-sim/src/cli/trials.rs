//! Running a scenario and writing its folder: what `run`, `demo` and `figures` share; and making a world ready, as
//! `learn` and `locate` do too.

use super::progress::{self, TrialProgress};
use super::{console, coverage, interruption, worlds};
use clap::Args;
use edgeloc_sim::monte_carlo::{self, Part, RunOutcome, Shard, Site, Sites, TimedTrial};
use edgeloc_sim::report::{Journal, Manifest, RunFolder, RunResults, RunTimings, Summary, WorldFacts, page};
use edgeloc_sim::scenario::Scenario;
use edgeloc_sim::world::WireframeWorld;
use miette::{IntoDiagnostic, Result, miette};
use std::collections::HashSet;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};
use tracing::info;

/// How to run, whatever the scenario.
#[derive(Debug, Clone, Args)]
pub(super) struct RunArguments {
    /// Threads; all of the machine when not given. The results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub(super) threads: Option<u16>,
    /// Folder that gets a folder of this run.
    #[arg(short, long, value_name = "FOLDER", default_value = "runs")]
    pub(super) out: PathBuf,
}

impl Default for RunArguments {
    fn default() -> Self {
        Self { threads: None, out: PathBuf::from("runs") }
    }
}

/// Makes the scenario's world ready for learning and trials.
pub(super) fn prepare(scenario: &Scenario) -> Result<Site> {
    let _wheel = progress::wheel("looking around in the world");
    let world = worlds::open(scenario)?;
    let site = Site::prepare(world, scenario).into_diagnostic()?;
    info!("{}", site.free_space.describe());
    Ok(site)
}

/// Makes a world ready for every row of the scenario.
fn prepare_rows(world: WireframeWorld, scenario: &Scenario) -> Result<Sites> {
    let wheel = progress::wheel("looking around in the world");
    let sites = Sites::prepare(world, scenario).into_diagnostic()?;
    drop(wheel);
    info!("{}", sites.all()[0].free_space.describe());
    for site in sites.all() {
        coverage::tell(site.nodes.len(), &site.coverage());
    }
    Ok(sites)
}

/// Runs a scenario, or a shard of it, in a new folder; `verb` is the one that goes on with it.
pub(super) fn run(
    scenario: Scenario,
    arguments: &RunArguments,
    shard: Option<Shard>,
    verb: &'static str,
) -> Result<(RunFolder, RunResults)> {
    let folder = |name: &str| {
        let date = jiff::Zoned::now().strftime("%Y-%m-%d").to_string();
        let part = shard.map_or_else(String::new, |shard| format!("-shard-{}-of-{}", shard.index, shard.count));
        let folder = RunFolder::create(&arguments.out, &date, &format!("{name}{part}"))?;
        if let Err(error) = folder.link_latest() {
            console::remark(&format!("the run goes on, but {error}"));
        }
        Ok(folder)
    };
    run_in(scenario, arguments.threads, (shard, verb), folder)
}

/// Runs a scenario, or a shard of it, in the folder that `make_folder` makes for its name once the world is ready.
pub(super) fn run_in(
    scenario: Scenario,
    threads: Option<u16>,
    (shard, verb): (Option<Shard>, &'static str),
    make_folder: impl FnOnce(&str) -> Result<RunFolder>,
) -> Result<(RunFolder, RunResults)> {
    let (started, start) = (jiff::Timestamp::now(), Instant::now());
    let trials = shard.map(|shard| shard.trials(&scenario)).transpose().into_diagnostic()?;
    let pool = thread_pool(threads)?;
    let sites = pool.install(|| prepare_rows(worlds::open(&scenario)?, &scenario))?;
    let world = WorldFacts::new(&sites.all()[0].world, &scenario.world);
    let trials = trials.unwrap_or(0..sites.trials());
    let count = monte_carlo::count_trials(sites.settings(), &trials);
    let manifest = Manifest::new(&scenario, world, pool.current_num_threads(), shard, count, started);

    let folder = make_folder(&scenario.name)?;
    folder.begin(&manifest, &scenario)?;
    Running { pool, sites, folder, manifest, scenario, trials, prepare_time: start.elapsed(), verb }.finish()
}

/// Goes on with a run that was interrupted; `verb` is the one that does so.
pub(super) fn resume(path: &Path, threads: Option<u16>, verb: &'static str) -> Result<(RunFolder, RunResults)> {
    let start = Instant::now();
    let (folder, manifest, scenario) = RunFolder::open_unfinished(&behind_link(path))?;
    check_same_program(
        &manifest,
        &Manifest::new(&scenario, manifest.world.clone(), 0, None, 0, jiff::Timestamp::now()),
    )?;
    let trials = manifest.shard.map(|shard| shard.trials(&scenario)).transpose().into_diagnostic()?;
    let world = unchanged_world(&scenario, &manifest)?;
    let pool = thread_pool(threads)?;
    let sites = pool.install(|| prepare_rows(world, &scenario))?;
    let trials = trials.unwrap_or(0..sites.trials());
    Running { pool, sites, folder, manifest, scenario, trials, prepare_time: start.elapsed(), verb }.finish()
}

/// A run under way.
struct Running {
    pool: rayon::ThreadPool,
    sites: Sites,
    folder: RunFolder,
    manifest: Manifest,
    scenario: Scenario,
    trials: Range<u32>,
    prepare_time: Duration,
    verb: &'static str,
}

impl Running {
    /// Runs what the journal lacks and writes the results; leaves a folder to resume when that is interrupted.
    fn finish(self) -> Result<(RunFolder, RunResults)> {
        let (journal, done) = Journal::open(self.folder.path())?;
        let known: HashSet<(usize, u32)> = done.iter().map(|trial| (trial.row, trial.record.trial)).collect();
        let progress = TrialProgress::going_on(self.manifest.trials, &done);
        let ended = Mutex::new(done);
        let on_trial = |trial: TimedTrial| {
            journal.append(&trial);
            progress.count(&trial.record);
            ended.lock().unwrap_or_else(PoisonError::into_inner).push(trial);
        };
        let part = Part {
            trials: self.trials.clone(),
            is_done: &|row, trial| known.contains(&(row, trial)),
            should_stop: &|| interruption::is_asked() || journal.has_failed(),
        };
        interruption::listen();
        let run = self.pool.install(|| monte_carlo::run_part(&self.sites, &part, &on_trial));
        drop(progress);
        let trials_time = journal.elapsed();
        let closed = journal.close();
        let ended = ended.into_inner().unwrap_or_else(PoisonError::into_inner);
        let folder = name(self.folder.path());
        let is_complete = run.is_ok() && closed.is_ok() && ended.len() == self.manifest.trials;
        if !is_complete {
            console::remark(&format!("{} of {} trials are kept in {folder}", ended.len(), self.manifest.trials));
        }
        run.into_diagnostic()?;
        closed?;
        if !is_complete {
            return Err(miette!(
                help = format!("go on with: edgeloc {} --resume {folder}", self.verb),
                "the run was interrupted"
            ));
        }
        self.write(RunOutcome::of(ended), trials_time)
    }

    fn write(self, outcome: RunOutcome, trials_time: Duration) -> Result<(RunFolder, RunResults)> {
        let Self { sites, folder, manifest, scenario, prepare_time, .. } = self;
        let RunOutcome { records, look_times } = outcome;
        let site = &sites.all()[0];
        let nodes: Vec<_> = (0..scenario.rows.len()).map(|row| sites.of_row(row).nodes.clone()).collect();
        let results = RunResults {
            manifest: manifest.finished(),
            summary: Summary::new(&scenario, &nodes, site.free_space.area_m2(), &records),
            timings: RunTimings::new(&scenario.rows, &records, &look_times, prepare_time, trials_time),
            nodes,
            records,
            scenario,
        };
        let free = worlds::free_cells_of_run(&site.free_space, &results.scenario);
        let coverage = coverage::of_rows(&site.world, &site.free_space, &results.scenario, &results.nodes);
        let report = page(&results, Some(&site.world), Some(&free), &coverage, &name(folder.path()));
        folder.write("report.html", report.as_bytes())?;
        folder.write_results(&results, &look_times)?;
        Ok((folder, results))
    }
}

fn thread_pool(threads: Option<u16>) -> Result<rayon::ThreadPool> {
    rayon::ThreadPoolBuilder::new().num_threads(threads.map_or(0, usize::from)).build().into_diagnostic()
}

/// Where a folder is, whatever link led there: a link such as runs/latest will lead elsewhere after the next run.
pub(super) fn behind_link(path: &Path) -> PathBuf {
    path.read_link().map_or_else(|_| path.to_owned(), |target| path.with_file_name(target))
}

/// Refuses to go on with what another version of the program began.
pub(super) fn check_same_program(begun: &Manifest, now: &Manifest) -> Result<()> {
    if begun.is_of_same_program(now) {
        return Ok(());
    }
    let commit = |manifest: &Manifest| manifest.git_commit.clone().unwrap_or_else(|| "unknown".to_owned());
    Err(miette!(
        help = "resume it with the program that began it, or begin it anew",
        "the run was begun by edgeloc {} (commit {}), this is {} (commit {})",
        begun.program_version,
        commit(begun),
        now.program_version,
        commit(now)
    ))
}

/// The world that a run took place in, if it is still the same.
pub(super) fn unchanged_world(scenario: &Scenario, manifest: &Manifest) -> Result<WireframeWorld> {
    let world = worlds::open(scenario)?;
    check_same_world(&manifest.world, &WorldFacts::new(&world, &scenario.world))?;
    Ok(world)
}

/// Refuses a world, or viewpoints in it, that changed since a run.
pub(super) fn check_same_world(then: &WorldFacts, now: &WorldFacts) -> Result<()> {
    if now.checksum != then.checksum {
        return Err(miette!(
            help = "bring back the world file of the run, or use the version of the program that made it",
            "the world {:?} has changed since the run: its checksum was {}, it is {}",
            now.name,
            then.checksum,
            now.checksum
        ));
    }
    match (&now.visibility, &then.visibility) {
        (Some(now), Some(then)) if now.checksum != then.checksum => Err(miette!(
            help = "bring back the file as it was, or run the scenario again",
            "what is visible in the world has changed since the run: the checksum of {} was {}, it is {}",
            now.file.as_deref().unwrap_or("the viewpoints"),
            then.checksum,
            now.checksum
        )),
        _ => Ok(()),
    }
}

/// How commands and reports name a folder.
pub(super) fn name(path: &Path) -> String {
    path.display().to_string()
}

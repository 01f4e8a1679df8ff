//! `optimise`: better parameters by successive halving.

use super::console::{self, Format};
use super::progress;
use super::scenario_args::find_setting;
use super::{trials, worlds};
use clap::Args;
use edgeloc_sim::monte_carlo::{self, Sites};
use edgeloc_sim::report::{
    Cost, Manifest, RunFolder, SearchFacts, SearchLine, WorldFacts, pareto_chart, search_csv, search_lines,
    search_page, to_svg_file,
};
use edgeloc_sim::scenario::{Building, Row, Scenario, Setting};
use edgeloc_sim::sweep::{
    Axis, LEAST_TRIALS, Sample, Schedule, Stage, Standing, choose, draw_points, preset_toml, samples, search,
    stage_scenario,
};
use edgeloc_sim::world::WireframeWorld;
use miette::{IntoDiagnostic, Result, miette};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The fields that `--format json` prints, for the help.
const JSON_FIELDS: &str = "\
folder, preset (path of the scenario written), settings = one for each setting, as the columns of settings.csv (rates and \
differences are fractions of 1): setting (0 is the scenario as given), values (of each axis, by dotted key), fate, \
searched_trials and searched_rate (in the rungs), and of the fresh trials of the confirmation trials (0 when it did not \
come so far), successes, success_rate, success_rate_low, success_rate_high, mean_looks, work (nodes scored in all looks, \
weighed by the bins of their histograms), mean_localizer_s, map_bytes, difference from setting 0, difference_low, \
difference_high, p, p_holm, is_on_front, is_chosen";

/// Search better parameters by successive halving on common random numbers, and write the best as a preset.
///
/// Settings are drawn evenly over the axes; after each rung the better half goes on with twice the trials. A setting that a
/// no costlier one beats is dropped for good only on evidence that may be read at any time (an e-process, 5 % for all pairs
/// together), so that looking often proves nothing that is not there. The finalists run again on fresh poses, maps and noise:
/// every rate reported is of those trials.
///
/// The folder, runs/<date>-optimise-<name> and from its first stage on runs/latest, gets settings.csv, two SVGs of the front, optimise.html and the preset, which
/// `edgeloc run` takes. The same seed searches the same way on every machine: no clock decides anything.
#[derive(Debug, Args)]
#[command(after_help = format!(
    "Examples:\n  edgeloc optimise\n  edgeloc optimise --trials-total 5000 --settings 16 --name quick\n  \
     edgeloc optimise --row 'anywhere, polarity' --world small_house.edgeworld\n  \
     edgeloc optimise --axis localizer.turn_deg=30,60,90 --axis localizer.max_looks=4,8,12\n  \
     edgeloc optimise --resume runs/2026-01-31-optimise-optimised\n  \
     edgeloc run runs/2026-01-31-optimise-optimised/optimised.toml\n\n\
     JSON (--format json): {JSON_FIELDS}."
))]
pub(super) struct Optimise {
    /// Scenario to begin from (.toml), or a bundled one.
    #[arg(default_value = "paper")]
    scenario: String,
    /// World file (.edgeworld) instead of the scenario's world.
    #[arg(long, value_name = "FILE")]
    world: Option<PathBuf>,
    /// Change one setting of the scenario before the search; may be repeated.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    settings_before: Vec<String>,
    /// Seed of all random draws.
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Row of the scenario whose start and polarity the trials have [default: the first].
    #[arg(long)]
    row: Option<String>,
    /// What to search, KEY=VALUE,VALUE,...; may be repeated [default: n_dist, n_angle, d_max, B_th, turn and nodes].
    #[arg(long = "axis", value_name = "KEY=VALUES", value_parser = Axis::parse)]
    axes: Vec<Axis>,
    /// Settings at the start, the scenario as given among them.
    #[arg(long, value_name = "N", default_value_t = 32, value_parser = clap::value_parser!(u16).range(2..=100))]
    settings: u16,
    /// Settings left for the confirmation.
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u16).range(1..=99))]
    finalists: u16,
    /// Trials of all settings and rungs together.
    #[arg(long, value_name = "N", default_value_t = 20_000, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    trials_total: u64,
    /// The preset may lie this far below the best rate if it is cheaper, in points.
    #[arg(long, value_name = "POINTS", default_value_t = 1.0)]
    within_points: f64,
    /// Name of the preset.
    #[arg(long, default_value = "optimised")]
    name: String,
    /// Go on with an interrupted search of the same arguments, in its folder.
    #[arg(long, value_name = "FOLDER")]
    resume: Option<PathBuf>,
    /// Threads; all of the machine when not given. The results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    threads: Option<u16>,
    /// Folder that gets a folder of this search.
    #[arg(short, long, value_name = "FOLDER", default_value = "runs")]
    out: PathBuf,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// What `--format json` prints.
#[derive(Serialize)]
struct OptimisePrinted<'o> {
    folder: &'o Path,
    preset: &'o Path,
    settings: &'o [SearchLine],
}

/// A finished stage as kept for `--resume`.
#[derive(Serialize, Deserialize)]
struct StageFile {
    /// Where it comes from: only the same program in the same world goes on with it.
    manifest: Manifest,
    /// The scenario of the stage: only the very same one is taken up again.
    scenario: String,
    samples: Vec<Sample>,
}

/// What every stage of a search needs.
struct Stages<'s> {
    base: &'s Scenario,
    row: &'s Row,
    points: &'s [Vec<String>],
    world: &'s WireframeWorld,
    folder: &'s Path,
    pool: &'s rayon::ThreadPool,
}

impl Optimise {
    pub(super) fn execute(self) -> Result<()> {
        let start = Instant::now();
        let given = self.base()?;
        let Setting { row, scenario: base } = find_setting(&given, self.row.as_deref())?;
        let axes = if self.axes.is_empty() { Axis::defaults() } else { self.axes.clone() };
        let points = draw_points(&axes, usize::from(self.settings), base.seed);
        let (settings, finalists) = (points.len(), usize::from(self.finalists));
        let schedule = Schedule { settings, finalists, trials_total: self.trials_total };
        let least = schedule.least_trials_total();
        if self.trials_total < least {
            let settings = console::count(settings as u64, "setting");
            return Err(miette!(
                help = format!(
                    "give at least {least}, so that each has {LEAST_TRIALS} trials in every stage, or search fewer --settings"
                ),
                "--trials-total {} is too small for {settings} and {}",
                self.trials_total,
                console::count(finalists as u64, "finalist")
            ));
        }
        let world = worlds::open(&base)?;
        let folder = self.folder()?;
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(self.threads.map_or(0, usize::from))
            .build()
            .into_diagnostic()?;
        let stages = Stages { base: &base, row: &row, points: &points, world: &world, folder: &folder, pool: &pool };
        let standings = search(&schedule, |stage, settings, trials| stages.evaluate(stage, settings, trials))
            .inspect_err(|_| {
                // What was refused before a stage was over leaves nothing to go on with: an empty folder goes.
                let _ = std::fs::remove_dir(&folder);
            })?;

        let within = self.within_points / 100.0;
        let lines = search_lines(&base, &axes, &points, &standings, within)?;
        let preset = self.preset(&base, &row, &points, &standings, &lines, within)?;
        let write = |file: &str, content: &[u8]| {
            let path = folder.join(file);
            console::write_file(&path, content).map(|()| path)
        };
        let preset_path = write(&format!("{}.toml", self.name), preset.as_bytes())?;
        write("settings.csv", &search_csv(&lines).into_diagnostic()?)?;
        for (file, cost) in [("front-time.svg", Cost::Time), ("front-map.svg", Cost::MapSize)] {
            write(file, to_svg_file(pareto_chart(&lines, cost)).as_bytes())?;
        }
        let command = std::env::args().collect::<Vec<_>>().join(" ");
        let facts = SearchFacts {
            name: &self.name,
            row: &row.name,
            schedule: &schedule,
            within,
            preset: &preset,
            command: &command,
            wall_s: start.elapsed().as_secs_f64(),
        };
        let page = write("optimise.html", search_page(&lines, &facts).as_bytes())?;
        if self.format == Format::Json {
            let printed = OptimisePrinted { folder: &folder, preset: &preset_path, settings: &lines };
            return console::print_json(&printed);
        }
        console::print(&table(&lines).to_string())?;
        console::print("settings marked * are on the front: none beats them in success, work and map at once")?;
        console::print(&format!("report: {}", page.display()))?;
        console::print(&format!("preset: edgeloc run {}", preset_path.display()))
    }

    /// The scenario to begin from, checked.
    fn base(&self) -> Result<Scenario> {
        let seed = self.seed.map(|seed| format!("seed={seed}"));
        let settings = self.settings_before.iter().cloned().chain(seed).collect::<Vec<_>>();
        let mut scenario = Scenario::load(&self.scenario, &settings)?;
        if let Some(world) = &self.world {
            let file = std::path::absolute(world).unwrap_or_else(|_| world.clone());
            scenario.world.building = Building::File { file };
        }
        let named = Scenario { name: format!("optimise-{}", self.name), ..scenario.clone() };
        for checked in [&scenario, &named] {
            checked.check().map_err(|illegal| miette!(help = illegal.remedy.clone(), "{illegal}"))?;
        }
        Ok(scenario)
    }

    fn folder(&self) -> Result<PathBuf> {
        match &self.resume {
            Some(path) if path.is_dir() => Ok(path.clone()),
            Some(path) => Err(miette!(
                help = "give the folder that the interrupted search said it made",
                "{} is no folder",
                path.display()
            )),
            None => {
                let date = jiff::Zoned::now().strftime("%Y-%m-%d").to_string();
                let folder = RunFolder::create(&self.out, &date, &format!("optimise-{}", self.name))?;
                Ok(folder.path().to_owned())
            }
        }
    }

    /// The chosen setting as a scenario of its own.
    fn preset(
        &self,
        base: &Scenario,
        row: &Row,
        points: &[Vec<String>],
        standings: &[Standing],
        lines: &[SearchLine],
        within: f64,
    ) -> Result<String> {
        let chosen = choose(standings, within).unwrap_or(0);
        let mut scenario = Scenario { name: self.name.clone(), ..base.clone() };
        for setting in &points[chosen] {
            scenario = scenario.with_setting(setting)?;
        }
        let world_name = match &base.world.building {
            Building::Office { seed } => format!("office {seed}"),
            Building::File { file } => file.display().to_string(),
        };
        let of = |setting: usize| format!("{}, {:.2} looks", lines[setting].success(), lines[setting].mean_looks);
        let comment = [
            format!("Found by edgeloc optimise in {}, row {:?}, seed {}.", world_name, row.name, base.seed),
            format!("Fresh trials: {}.", of(chosen)),
            format!("The scenario as given: {}.", of(0)),
        ];
        Ok(preset_toml(&scenario, &comment))
    }
}

impl Stages<'_> {
    /// Runs a stage, or takes it from the folder when it is there.
    fn evaluate(&self, stage: Stage, settings: &[usize], trials: u32) -> Result<Vec<Sample>> {
        let Self { base, row, points, .. } = self;
        let scenario = stage_scenario(base, row, points, stage, settings, trials)?;
        let (file, what) = match stage {
            Stage::Rung(rung) => (format!("rung-{}.json", rung + 1), format!("rung {}", rung + 1)),
            Stage::Confirmation => ("confirmation.json".to_owned(), "confirmation".to_owned()),
        };
        let text = scenario.to_toml();
        let count = settings.len() * trials as usize;
        let (facts, started) = (WorldFacts::new(self.world, &scenario.world), jiff::Timestamp::now());
        let manifest = Manifest::new(&scenario, facts, self.pool.current_num_threads(), None, count, started);
        if let Ok(known) = std::fs::read(self.folder.join(&file)) {
            let known: StageFile = serde_json::from_slice(&known)
                .map_err(|error| miette!("{file} is damaged or of another version: {error}"))?;
            trials::check_same_program(&known.manifest, &manifest)?;
            if known.scenario != text {
                return Err(miette!(
                    help = "resume with the arguments of the interrupted search, or begin a new one without --resume",
                    "{file} is of another search"
                ));
            }
            trials::check_same_world(&known.manifest.world, &manifest.world)?;
            return Ok(known.samples);
        }
        console::remark(&format!("{what}: {} settings, {trials} trials each", settings.len()));
        let outcome = self.pool.install(|| {
            let sites = {
                let _wheel = progress::wheel("looking around in the world");
                Sites::prepare(self.world.clone(), &scenario).into_diagnostic()?
            };
            let progress = progress::TrialProgress::new(&scenario);
            monte_carlo::run(&sites, &|record| progress.count(record)).into_diagnostic()
        })?;
        let samples = samples(&scenario, &outcome);
        let kept = StageFile { manifest: manifest.finished(), scenario: text, samples };
        console::write_file(&self.folder.join(&file), &serde_json::to_vec(&kept).into_diagnostic()?)?;
        if let Err(error) = RunFolder::link_latest_to(self.folder) {
            console::remark(&format!("the search goes on, but {error}"));
        }
        Ok(kept.samples)
    }
}

fn table(lines: &[SearchLine]) -> comfy_table::Table {
    let keys = lines.first().map(|line| line.values.keys().cloned().collect::<Vec<_>>()).unwrap_or_default();
    let short = keys.iter().map(|key| key.rsplit('.').next().unwrap_or(key));
    let after = ["success [95 % interval]", "trials", "looks", "ms", "map kB", "points to origin"];
    let mut table = console::table(&std::iter::once("setting").chain(short).chain(after).collect::<Vec<_>>());
    for line in lines.iter().filter(|line| line.trials > 0) {
        let mark = if line.is_on_front { " *" } else { "" };
        let role = match (line.setting, line.is_chosen) {
            (0, true) => "0, origin, chosen".to_owned(),
            (0, false) => "0, origin".to_owned(),
            (setting, true) => format!("{setting}, chosen"),
            (setting, false) => setting.to_string(),
        };
        let (low, high) = (100.0 * line.success_rate_low, 100.0 * line.success_rate_high);
        let mut cells = vec![format!("{role}{mark}")];
        cells.extend(line.values.values().cloned());
        cells.extend([
            format!("{:.1} % [{low:.1}, {high:.1}]", 100.0 * line.success_rate.unwrap_or(0.0)),
            line.trials.to_string(),
            format!("{:.2}", line.mean_looks),
            format!("{:.1}", 1e3 * line.mean_localizer_s),
            format!("{:.0}", line.map_bytes / 1e3),
            line.difference.map_or_else(String::new, |difference| format!("{:+.1}", 100.0 * difference)),
        ]);
        table.add_row(cells);
    }
    table
}

//! `validate`: how good the default localiser is, in several worlds.

use super::console::{self, Format};
use super::summary_table::{position_errors, share};
use super::trials::{self, RunArguments, name};
use super::worlds;
use clap::{Args, ValueEnum};
use comfy_table::{CellAlignment, Table};
use edgeloc_sim::report::{
    AnswerFigures, RunFolder, RunResults, Share, ValidationRow, WorldLine, validation, validation_csv, validation_page,
};
use edgeloc_sim::scenario::{Building, Scenario, Start, WorldChoice};
use edgeloc_sim::world::{FreeSpace, FreeSpaceOptions};
use miette::{IntoDiagnostic, Result, miette};
use serde::Serialize;
use std::fs;
use std::path::{Path, PathBuf};

/// Free space for each node in worlds that are no generated office, in square metres: the office's 72 nodes have as much.
const M2_PER_NODE: f64 = 2.3;

/// The file that says what a validation consists of: the worlds, each with its scenario in TOML.
const PLAN: &str = "plan.json";

/// What an interrupted validation has settled already.
const NOT_WITH_RESUME: [&str; 11] =
    ["worlds", "offices", "no_offices", "strata", "stress", "ablation", "trials", "nodes", "seed", "settings", "out"];

/// The fields that `--format json` prints, for the help.
const JSON_FIELDS: &str = "\
folder, and rows = what summary.json holds (rates are fractions of 1; shares have count, of, rate, and low and high of the 95 % \
Wilson interval): row, start, worlds and total. Each of the worlds: world, nodes, free_m2_per_node, map_bytes, success, answers \
(coverage, false_accepts, truth_named by the answer or the rivals, near_ties, pose_error_median_m, pose_error_95_m, pose_error_99_m, \
heading_error_median_deg, calibration_error), mean_looks, mean_s_per_look, errors. The total: mean_success_rate over worlds with \
its interval over worlds clustered_low to clustered_high, worst_world and worst_success_rate, and of all trials success, \
answers, mean_looks, errors";

/// Validate the default localiser in several worlds: success, coverage, false accepts, pose errors, calibration.
///
/// Runs the bundled scenario edgeloc in the generated offices of --offices, 72 nodes each, and in every WORLD given, with a
/// node for each 2.3 m2 of free space, the office's density. Each world has a run of its own in the folder of the
/// validation, with a report, and any trial of it replays; the folder also gets validation.csv, summary.json and
/// validation.html. Intervals are Wilson's for each world, and for their mean Student's over the worlds.
#[derive(Debug, Args)]
#[command(after_help = format!(
    "Examples:\n  edgeloc validate\n  edgeloc validate small_house.edgeworld willow.edgeworld --trials 900\n  \
     edgeloc validate --strata anywhere,near,unlearned\n  edgeloc validate --stress --offices 11,12 --trials 300\n  \
     edgeloc validate --ablation --set localizer.verification.confidence=0.6\n  \
     edgeloc validate --no-offices small_house.edgeworld\n  \
     edgeloc validate --resume runs/latest            after Ctrl-C or a power cut\n\n\
     JSON (--format json): {JSON_FIELDS}."
))]
pub(super) struct Validate {
    /// World files (.edgeworld) beside the offices.
    #[arg(value_name = "WORLD")]
    worlds: Vec<PathBuf>,
    /// Seeds of the generated offices.
    #[arg(long, value_name = "SEEDS", value_delimiter = ',', default_values_t = [11, 12, 13, 14, 15])]
    offices: Vec<u64>,
    /// No generated office, the given worlds alone.
    #[arg(long, requires = "worlds")]
    no_offices: bool,
    /// Where robots start.
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = [Stratum::Anywhere], conflicts_with_all = ["stress", "ablation"])]
    strata: Vec<Stratum>,
    /// The bundled scenario stress instead: one thing made harder in each row.
    #[arg(long, conflicts_with = "ablation")]
    stress: bool,
    /// The bundled scenario ablation instead: without one part of the localiser in each row.
    #[arg(long)]
    ablation: bool,
    /// Trials of each row in each world.
    #[arg(long, value_name = "N", default_value_t = 900)]
    trials: u32,
    /// Nodes in every world, instead of the office's density.
    #[arg(long, value_name = "N")]
    nodes: Option<u16>,
    /// Seed of all random draws.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Change one setting of every row, such as localizer.turn_deg=90; may be repeated.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    settings: Vec<String>,
    #[command(flatten)]
    how: RunArguments,
    /// Go on with an interrupted validation in its folder.
    #[arg(long, value_name = "FOLDER", conflicts_with_all = NOT_WITH_RESUME)]
    resume: Option<PathBuf>,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Where robots start, as the rows of the scenario edgeloc do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Stratum {
    /// Anywhere in free space.
    Anywhere,
    /// Near the nodes.
    Near,
    /// In a part of the building that was not learned.
    Unlearned,
}

/// One world of a validation: the name of its folder, and what runs in it.
#[derive(Debug)]
struct PlannedRun {
    world: String,
    scenario: Scenario,
}

/// What `--format json` prints.
#[derive(Serialize)]
struct ValidationPrinted<'v> {
    folder: &'v Path,
    rows: &'v [ValidationRow],
}

impl Validate {
    pub(super) fn execute(self) -> Result<()> {
        let (folder, plan) = match &self.resume {
            Some(path) => Self::reopen(path)?,
            None => self.begin()?,
        };
        let mut runs = Vec::new();
        for PlannedRun { world, scenario } in plan {
            let results = self.run_world(&folder, &world, scenario)?;
            runs.push((world, results));
            if self.format == Format::Text {
                let last = runs.last().map(|run| validation(std::slice::from_ref(run))).unwrap_or_default();
                console::print(&world_lines(&last))?;
            }
        }
        let rows = validation(&runs);
        let mut summary = serde_json::to_vec_pretty(&rows).into_diagnostic()?;
        summary.push(b'\n');
        folder.write("validation.csv", &validation_csv(&rows).into_diagnostic()?)?;
        folder.write("summary.json", &summary)?;
        let page = validation_page(&rows, &runs, &name(folder.path()));
        let page = folder.write("validation.html", page.as_bytes())?;
        if self.format == Format::Json {
            return console::print_json(&ValidationPrinted { folder: folder.path(), rows: &rows });
        }
        console::print(&total_table(&rows).to_string())?;
        console::print(
            "mean: of the worlds' rates, with Student's interval over worlds; other intervals: Wilson's of all trials together",
        )?;
        console::print(&format!("report: {}", page.display()))
    }

    /// Plans a validation and makes its folder.
    fn begin(&self) -> Result<(RunFolder, Vec<PlannedRun>)> {
        let base = self.scenario()?;
        let mut plan = Vec::new();
        for &seed in self.offices.iter().filter(|_| !self.no_offices) {
            let scenario = Scenario { world: WorldChoice::office(seed), ..base.clone() };
            plan.push(PlannedRun { world: format!("office-{seed}"), scenario });
        }
        for file in &self.worlds {
            let file = std::path::absolute(file).unwrap_or_else(|_| file.clone());
            let mut scenario = base.clone();
            scenario.world.building = Building::File { file: file.clone() };
            if self.nodes.is_none() && !self.settings.iter().any(|setting| setting.starts_with("learning.nodes")) {
                scenario.learning.nodes = self.nodes_for(&scenario)?;
            }
            let stem = super::world::file_stem(&file.file_stem().unwrap_or_default().to_string_lossy());
            plan.push(PlannedRun { world: stem, scenario });
        }
        for run in 0..plan.len() {
            if plan[..run].iter().any(|other| other.world == plan[run].world) {
                let world = &plan[run].world;
                return Err(miette!(
                    help = "give each world once, or rename a file",
                    "two worlds are called {world:?}"
                ));
            }
        }
        let date = jiff::Zoned::now().strftime("%Y-%m-%d").to_string();
        let folder = RunFolder::create(&self.how.out, &date, &format!("validate-{}", base.name))?;
        let written: Vec<_> = plan.iter().map(|run| (&run.world, run.scenario.to_toml())).collect();
        folder.write(PLAN, &serde_json::to_vec_pretty(&written).into_diagnostic()?)?;
        if let Err(error) = folder.link_latest() {
            console::remark(&format!("the validation goes on, but {error}"));
        }
        Ok((folder, plan))
    }

    /// The folder and the plan of a validation begun before.
    fn reopen(path: &Path) -> Result<(RunFolder, Vec<PlannedRun>)> {
        let path = trials::behind_link(path);
        let text = fs::read_to_string(path.join(PLAN)).map_err(|error| {
            miette!(
                help = "give the folder of an interrupted validation, such as runs/latest",
                "{} holds no validation: {PLAN}: {error}",
                path.display()
            )
        })?;
        let written: Vec<(String, String)> = serde_json::from_str(&text).into_diagnostic()?;
        let planned = |(world, text): (String, String)| {
            let scenario = Scenario::parse(&text, PLAN)?;
            Ok(PlannedRun { world, scenario })
        };
        let plan = written.into_iter().map(planned).collect::<Result<Vec<_>>>()?;
        Ok((RunFolder::at(path)?, plan))
    }

    /// The scenario of every world but for the world itself.
    fn scenario(&self) -> Result<Scenario> {
        let preset = match (self.stress, self.ablation) {
            (true, _) => "stress",
            (_, true) => "ablation",
            _ => "edgeloc",
        };
        let numbers = [
            Some(format!("trials={}", self.trials)),
            Some(format!("seed={}", self.seed)),
            self.nodes.map(|nodes| format!("learning.nodes={nodes}")),
        ];
        let settings = self.settings.iter().cloned().chain(numbers.into_iter().flatten()).collect::<Vec<_>>();
        let mut scenario = Scenario::load(preset, &settings)?;
        if preset == "edgeloc" {
            let is_asked = |start: Start| {
                let stratum = match start {
                    Start::Anywhere => Stratum::Anywhere,
                    Start::Near => Stratum::Near,
                    Start::Unlearned => Stratum::Unlearned,
                };
                self.strata.contains(&stratum)
            };
            scenario.rows.retain(|row| is_asked(row.start));
        }
        Ok(scenario)
    }

    /// Nodes that give a world the office's density.
    fn nodes_for(&self, scenario: &Scenario) -> Result<u16> {
        let world = worlds::open(scenario)?;
        let area_m2 = FreeSpace::of(&world, &FreeSpaceOptions::default()).into_diagnostic()?.area_m2();
        Ok((area_m2 / M2_PER_NODE).round().clamp(1.0, 4096.0) as u16)
    }

    /// The results of one world: as they are, of what was interrupted, or from the beginning.
    fn run_world(&self, folder: &RunFolder, world: &str, scenario: Scenario) -> Result<RunResults> {
        let path = folder.path().join(world);
        if let Ok(finished) = RunFolder::open(&path) {
            return Ok(finished.read_results()?);
        }
        let run = if path.join("manifest.json").is_file() {
            trials::resume(&path, self.how.threads, "validate")
        } else {
            trials::run_in(scenario, self.how.threads, (None, "validate"), |_| Ok(RunFolder::at(path.clone())?))
        };
        if run.is_err() {
            let folder = name(folder.path());
            console::remark(&format!("go on with all worlds: edgeloc validate --resume {folder}"));
        }
        run.map(|(_, results)| results)
    }
}

/// A line for each row of one world.
fn world_lines(rows: &[ValidationRow]) -> String {
    let line = |row: &ValidationRow, world: &WorldLine| {
        let answers = &world.answers;
        format!(
            "{}, {}: {} right of {}; {} answered, {} of them wrong; {}; {:.2} looks\n",
            world.world,
            row.row,
            share(&world.success),
            world.success.of,
            answers.coverage.count,
            wrong_answers(row.start, answers),
            position_errors(answers),
            world.mean_looks,
        )
    };
    rows.iter().flat_map(|row| row.worlds.iter().map(move |world| line(row, world))).collect()
}

/// How many of the answers are wrong.
fn wrong_answers(start: Start, answers: &AnswerFigures) -> u64 {
    if start == Start::Unlearned { answers.coverage.count } else { answers.false_accepts.count }
}

/// A line a row, all worlds together.
fn total_table(rows: &[ValidationRow]) -> Table {
    let mut table = console::table(&[
        "row, all worlds",
        "mean success [over worlds]",
        "worst world",
        "answered",
        "false accepts [95 %]",
        "right or named",
        "position error 50/95/99 %",
        "heading",
        "looks",
        "calibration",
    ]);
    for ValidationRow { row, total, worlds, .. } in rows {
        let percent = |rate: f64| format!("{:.2} %", 100.0 * rate);
        let rate = |share: &Share| share.rate.map_or_else(String::new, percent);
        let worst = total.worst_world.as_deref().zip(total.worst_success_rate);
        let (low, high) = (100.0 * total.clustered_low, 100.0 * total.clustered_high);
        // Of one world nothing can be said of others: the interval is Wilson's of its trials.
        let (low, high) = match &worlds[..] {
            [only] => (100.0 * only.success.low, 100.0 * only.success.high),
            _ => (low, high),
        };
        let interval = format!(" [{low:.2}, {high:.2}]");
        table.add_row([
            row.clone(),
            total.mean_success_rate.map_or_else(String::new, |mean| percent(mean) + &interval),
            worst.map_or_else(String::new, |(world, rate)| format!("{} {world}", percent(rate))),
            rate(&total.answers.coverage),
            share(&total.answers.false_accepts),
            rate(&total.answers.truth_named),
            position_errors(&total.answers),
            total.answers.heading_error_median_deg.map_or_else(String::new, |error| format!("{error:.2} deg")),
            format!("{:.2}", total.mean_looks),
            total.answers.calibration_error.map_or_else(String::new, percent),
        ]);
    }
    for column in [3, 5, 6, 7, 8, 9] {
        if let Some(column) = table.column_mut(column) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}

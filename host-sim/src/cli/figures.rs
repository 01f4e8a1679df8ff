//! `figures`: the paper's study in one command.

use super::console::{self, Format};
use super::report;
use super::scenario_args::ScenarioChanges;
use super::trials::{self, RunArguments};
use clap::Args;
use comfy_table::{CellAlignment, Table};
use edgeloc_sim::report::{
    FigureLine, RunFolder, RunResults, TestKind, figure_chart, figure_lines, figures_csv, figures_page,
    lines_of_figure, power_sentence, to_svg_file,
};
use edgeloc_sim::scenario::Scenario;
use edgeloc_sim::sweep::{compare_with_default, figures_of, with_anywhere};
use miette::{IntoDiagnostic, Result, miette};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Disagreement of two settings taken for granted before a run, a fraction; the report says what it was.
const USUAL_DISCORDANCE: f64 = 0.08;

/// The fields that `--format json` prints, for the help.
const JSON_FIELDS: &str = "\
folder, lines = one for each row, as the columns of figures.csv (rates, their 95 % intervals and differences from the \
default are fractions of 1): row, figure, setting, start, polarity, trials, successes, success_rate (null without trials), \
success_rate_low, success_rate_high, mean_looks, mean_localizer_s, test (default, mcnemar, two_rates when the robot poses \
differ, none), pairs (trials shared with the default), only_default and only_setting (pairs that just one of the two got \
right), difference, difference_low, difference_high, p, p_holm (Holm's correction over the study), paper_success_rate, paper_time_s";

/// What a finished run has settled already.
const NOT_WITH_FROM: [&str; 11] = [
    "study",
    "paper_scale",
    "anywhere",
    "world",
    "settings",
    "trials",
    "nodes",
    "seed",
    "print_config",
    "threads",
    "out",
];

/// What an interrupted study has settled already.
const NOT_WITH_RESUME: [&str; 11] =
    ["study", "paper_scale", "anywhere", "from", "world", "settings", "trials", "nodes", "seed", "print_config", "out"];

/// Run the paper's study: the settings of its figures 4 and 5 on common random numbers, beside what it states.
///
/// The 22 settings of the bundled scenario figures, 900 trials each: B_th (4a), the uncertainty sources one by one (4b),
/// n_dist and n_angle (5). Each is compared with the default trial by trial (McNemar, corrected by Holm). The folder of
/// the run also gets figures.csv, figures.html and an SVG of each figure.
#[derive(Debug, Args)]
#[command(after_help = format!(
    "Examples:\n  edgeloc figures\n  edgeloc figures --trials 100 --anywhere\n  edgeloc figures --paper-scale\n  \
     edgeloc figures --resume runs/latest             after Ctrl-C or a power cut\n  \
     edgeloc figures my-study.toml --threads 2\n  edgeloc figures --from runs/latest\n  \
     edgeloc figures --print-config > my-study.toml\n\n\
     In a study of one's own, a row called \"turn: 60 degrees\" is the setting \"60 degrees\" of the figure \"turn\", and\n\
     the first row that changes nothing is the default.\n\n\
     JSON (--format json): {JSON_FIELDS}."
))]
pub(super) struct Figures {
    /// Scenario file of the study (.toml), or a bundled one [default: figures].
    study: Option<String>,
    /// The paper's four months: the 77 settings of the bundled scenario paper-scale, 74,110 trials.
    #[arg(long, conflicts_with = "study")]
    paper_scale: bool,
    /// Repeat every setting with starts anywhere in free space.
    #[arg(long)]
    anywhere: bool,
    /// Write the figures of a finished run anew, or of shards that were merged, and run nothing.
    #[arg(long, value_name = "RUN", conflicts_with_all = NOT_WITH_FROM)]
    from: Option<PathBuf>,
    /// Go on with an interrupted study in its folder; the result is that of an uninterrupted one.
    #[arg(long, value_name = "FOLDER", conflicts_with_all = NOT_WITH_RESUME)]
    resume: Option<PathBuf>,
    #[command(flatten)]
    changes: ScenarioChanges,
    #[command(flatten)]
    how: RunArguments,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// What `--format json` prints.
#[derive(Serialize)]
struct FiguresPrinted<'f> {
    folder: &'f Path,
    lines: &'f [FigureLine],
}

impl Figures {
    pub(super) fn execute(self) -> Result<()> {
        let (folder, results) = match (&self.from, &self.resume) {
            (Some(run), _) => merged(run)?,
            (None, Some(run)) => trials::resume(run, self.how.threads, "figures")?,
            (None, None) => {
                let Some(scenario) = self.scenario()? else { return Ok(()) };
                self.announce(&scenario);
                trials::run(scenario, &self.how, None, "figures")?
            }
        };
        let lines = figure_lines(&results).into_diagnostic()?;
        let page = write(&folder, &results, &lines)?;
        if self.format == Format::Json {
            return console::print_json(&FiguresPrinted { folder: folder.path(), lines: &lines });
        }
        console::print(&table(&lines).to_string())?;
        let (seconds, threads) = (results.timings.total_s(), results.manifest.host.used_threads);
        let threads = console::count(threads as u64, "thread");
        console::print(&format!(
            "ms: wall time of the localiser for a localisation; time: {seconds:.1} s ({threads})"
        ))?;
        console::print(&format!("report: {}", page.display()))
    }

    fn scenario(&self) -> Result<Option<Scenario>> {
        let bundled = if self.paper_scale { "paper-scale" } else { "figures" };
        let adapt = |scenario: Scenario| if self.anywhere { with_anywhere(&scenario) } else { scenario };
        self.changes.load_adapted(self.study.as_deref().unwrap_or(bundled), adapt)
    }

    /// Says before the run what it can find.
    fn announce(&self, scenario: &Scenario) {
        let trials = scenario.rows.iter().map(|row| row.trials.unwrap_or(scenario.trials)).min().unwrap_or(0);
        let comparisons = compare_with_default(scenario, &[]).unwrap_or_default();
        let comparisons = comparisons.iter().filter(|comparison| comparison.p.is_some()).count();
        let sentence = power_sentence(0.93, u64::from(trials), USUAL_DISCORDANCE, comparisons);
        console::remark(&format!("{} settings; {sentence}", scenario.rows.len()));
    }
}

/// A finished run that is whole.
fn merged(run: &Path) -> Result<(RunFolder, RunResults)> {
    let (folder, results) = report::open(run)?;
    match results.manifest.shard {
        Some(shard) => Err(miette!(
            help = "put all shards together first: edgeloc merge FOLDER...",
            "{} holds shard {shard} of a study, not the whole",
            run.display()
        )),
        None => Ok((folder, results)),
    }
}

/// Writes the table, the page and a drawing of each figure into the folder; the path of the page.
fn write(folder: &RunFolder, results: &RunResults, lines: &[FigureLine]) -> Result<PathBuf> {
    folder.write("figures.csv", &figures_csv(lines).into_diagnostic()?)?;
    for figure in figures_of(&results.scenario.rows) {
        let of_figure = lines_of_figure(lines, &figure.name);
        let chart = figure_chart(&of_figure.iter().collect::<Vec<_>>());
        folder.write(&file_name(&figure.name), to_svg_file(chart).as_bytes())?;
    }
    Ok(folder.write("figures.html", figures_page(results, lines).as_bytes())?)
}

/// `figure-4a.svg` for the figure `4(a)`.
fn file_name(figure: &str) -> String {
    let plain = |c: char| (c == ' ').then_some('-').or_else(|| c.is_ascii_alphanumeric().then_some(c));
    format!("figure-{}.svg", figure.chars().filter_map(plain).collect::<String>())
}

fn table(lines: &[FigureLine]) -> Table {
    let mut table = console::table(&[
        "setting",
        "success [95 % interval]",
        "trials",
        "looks",
        "ms",
        "against default [points]",
        "p, Holm",
        "the paper",
    ]);
    for line in lines {
        let (low, high) = (100.0 * line.success_rate_low, 100.0 * line.success_rate_high);
        let rate = |rate: f64| format!("{:.1} % [{low:.1}, {high:.1}]", 100.0 * rate);
        let against = match (line.test, line.difference, line.difference_low, line.difference_high) {
            (TestKind::Default, ..) => "the default".to_owned(),
            (_, Some(difference), Some(low), Some(high)) => {
                format!("{:+.1} [{:+.1}, {:+.1}]", 100.0 * difference, 100.0 * low, 100.0 * high)
            }
            _ => String::new(),
        };
        table.add_row([
            line.row.clone(),
            line.success_rate.map_or_else(|| "no trials".to_owned(), rate),
            line.trials.to_string(),
            format!("{:.2}", line.mean_looks),
            format!("{:.1}", 1e3 * line.mean_localizer_s),
            against,
            line.p_holm.map_or_else(String::new, |p| format!("{p:.3}")),
            line.paper_success_rate.map_or_else(String::new, |rate| format!("{:.2} %", 100.0 * rate)),
        ]);
    }
    for column in [2, 3, 4, 6] {
        if let Some(column) = table.column_mut(column) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}

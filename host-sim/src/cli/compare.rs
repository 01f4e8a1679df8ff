//! `compare`: two runs beside each other, trial by trial.

use super::console::{self, Format};
use super::report::open;
use super::scenario_args::find_setting;
use clap::Args;
use edgeloc_sim::report::{Comparison, Pairs, RunResults, RunRow, Side};
use miette::{Result, miette};
use std::path::PathBuf;

/// The fields that `--format json` prints.
const JSON_FIELDS: &str = "\
a list, one entry a pair of rows (rates and differences are fractions of 1): row_a, row_b, a and b (trials compared, \
left_out without a partner, successes, success_rate with its 95 % Wilson interval success_rate_low to success_rate_high, \
mean_looks, mean_s_per_look), pairs (null when unpaired: both right, only_a, only_b, neither, mcnemar_p two-sided and \
exact, mean_more_looks of B), difference = B less A with its 95 % interval difference_low to difference_high";

/// Compare two runs row by row: a paired test where both met the same robot poses.
///
/// Runs of the same seed, world and starts are paired: the same trial stood at the same pose in both, so only the trials
/// that one alone got right tell the two apart (McNemar's exact test). Differences are those of RUN_B to RUN_A, with 95 %
/// intervals of Newcombe. Many comparisons at once find a difference by chance now and then: 1 in 20 has p below 0.05.
#[derive(Debug, Args)]
#[command(after_help = format!(
    "Examples:\n  edgeloc compare runs/2026-01-31-paper runs/2026-01-31-paper-2\n  \
     edgeloc compare runs/latest runs/latest --row 'near, polarity' --row-b 'near, no polarity'\n  \
     edgeloc compare one/runs/latest two/runs/latest --unpaired\n\n\
     JSON (--format json): {JSON_FIELDS}."
))]
pub(super) struct Compare {
    /// Folder of run A.
    run_a: PathBuf,
    /// Folder of run B; the same folder compares rows of one run.
    run_b: PathBuf,
    /// Row to compare [default: every row that both have].
    #[arg(long, value_name = "NAME")]
    row: Option<String>,
    /// Row of run B, when it has another name there.
    #[arg(long, value_name = "NAME", requires = "row")]
    row_b: Option<String>,
    /// Compare the rates alone, of runs that met different poses.
    #[arg(long)]
    unpaired: bool,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

impl Compare {
    pub(super) fn execute(self) -> Result<()> {
        let ((_, a), (_, b)) = (open(&self.run_a)?, open(&self.run_b)?);
        let mut comparisons = Vec::new();
        for (row_a, row_b) in self.rows(&a, &b)? {
            let (a, b) = (RunRow { run: &a, row: &row_a }, RunRow { run: &b, row: &row_b });
            comparisons.push(if self.unpaired {
                Comparison::unpaired(a, b)
            } else {
                Comparison::paired(a, b).map_err(|reason| {
                    miette!(
                        help = "compare their rates alone with --unpaired; runs of the same seed, world and starts are paired",
                        "rows {row_a:?} and {row_b:?} are not paired: {reason}"
                    )
                })?
            });
        }
        if self.format == Format::Json {
            return console::print_json(&comparisons);
        }
        let mut table = console::table(&[
            "row",
            "A",
            "B",
            "B - A [95 % interval]",
            "only A right",
            "only B right",
            "McNemar p",
            "looks A, B",
            "ms a look A, B",
        ]);
        for compared in &comparisons {
            table.add_row(line(compared));
        }
        console::print(&format!("A: {}\nB: {}", self.run_a.display(), self.run_b.display()))?;
        console::print(&table.to_string())?;
        let left_out = comparisons.iter().map(|compared| compared.a.left_out + compared.b.left_out).sum::<u64>();
        if left_out > 0 {
            console::print(&format!("{left_out} trials have no partner in the other run and are left out"))?;
        }
        Ok(())
    }

    /// Which rows to compare.
    fn rows(&self, a: &RunResults, b: &RunResults) -> Result<Vec<(String, String)>> {
        if let Some(row) = &self.row {
            let row_a = find_setting(&a.scenario, Some(row))?.row.name;
            let row_b = find_setting(&b.scenario, Some(self.row_b.as_ref().unwrap_or(row)))?.row.name;
            return Ok(vec![(row_a, row_b)]);
        }
        let names = |run: &RunResults| run.scenario.rows.iter().map(|row| row.name.clone()).collect::<Vec<_>>();
        let (of_a, of_b) = (names(a), names(b));
        let common: Vec<_> =
            of_a.iter().filter(|name| of_b.contains(name)).map(|name| (name.clone(), name.clone())).collect();
        if common.is_empty() {
            return Err(miette!(
                help = format!("name one of each with --row and --row-b; A has {of_a:?}, B has {of_b:?}"),
                "the runs have no row of the same name"
            ));
        }
        Ok(common)
    }
}

fn line(compared: &Comparison) -> [String; 9] {
    let Comparison { row_a, row_b, a, b, pairs, .. } = compared;
    let row = if row_a == row_b { row_a.clone() } else { format!("{row_a} / {row_b}") };
    let rate = |side: &Side| {
        let (rate, low, high) = (side.success_rate, side.success_rate_low, side.success_rate_high);
        format!("{:.1} % [{:.1}, {:.1}] (n = {})", 100.0 * rate, 100.0 * low, 100.0 * high, side.trials)
    };
    let of_pairs = |words: fn(&Pairs) -> String| pairs.as_ref().map_or_else(|| "unpaired".to_owned(), words);
    [
        row,
        rate(a),
        rate(b),
        format!(
            "{:+.1} points [{:+.1}, {:+.1}]",
            100.0 * compared.difference,
            100.0 * compared.difference_low,
            100.0 * compared.difference_high
        ),
        of_pairs(|pairs| pairs.only_a.to_string()),
        of_pairs(|pairs| pairs.only_b.to_string()),
        of_pairs(|pairs| {
            if pairs.mcnemar_p < 1e-4 { format!("{:.1e}", pairs.mcnemar_p) } else { format!("{:.4}", pairs.mcnemar_p) }
        }),
        format!("{:.2}, {:.2}", a.mean_looks, b.mean_looks),
        format!("{:.1}, {:.1}", 1e3 * a.mean_s_per_look, 1e3 * b.mean_s_per_look),
    ]
}

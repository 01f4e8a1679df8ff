//! The rows of a study as lines of a table: what `figures.csv` holds, the page shows and `--format json` prints.

use super::RunResults;
use super::run_folder::to_csv;
use crate::monte_carlo::{SuccessRate, difference_interval, paired_difference_interval};
use crate::scenario::{IllegalValue, Start};
use crate::sweep::{Against, DefaultComparison, PaperClaim, compare_with_default, figure_and_setting, paper_claim};
use serde::Serialize;

/// One setting of a figure. Rates and differences are fractions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FigureLine {
    /// Name of the row.
    pub row: String,
    /// Figure that it belongs to.
    pub figure: String,
    /// Setting in that figure.
    pub setting: String,
    /// Where its trials start.
    pub start: Start,
    /// Whether its histograms use polarity.
    pub polarity: bool,
    /// Trials.
    pub trials: u64,
    /// Trials that ended at one of the two nearest nodes.
    pub successes: u64,
    /// Successes per trial; none without trials.
    pub success_rate: Option<f64>,
    /// Lower end of the 95 % Wilson interval.
    pub success_rate_low: f64,
    /// Upper end of the 95 % Wilson interval.
    pub success_rate_high: f64,
    /// Mean looks of a localisation.
    pub mean_looks: f64,
    /// Mean wall time of a localisation in seconds.
    pub mean_localizer_s: f64,
    /// How it is compared with the default of its start.
    pub test: TestKind,
    /// Trials that it shares with the default, when paired.
    pub pairs: Option<u64>,
    /// Trials that only the default got right, when paired.
    pub only_default: Option<u64>,
    /// Trials that only this setting got right, when paired.
    pub only_setting: Option<u64>,
    /// Success rate less that of the default.
    pub difference: Option<f64>,
    /// Lower end of the difference's 95 % interval (Newcombe).
    pub difference_low: Option<f64>,
    /// Upper end of the difference's 95 % interval.
    pub difference_high: Option<f64>,
    /// Two-sided p-value of no difference.
    pub p: Option<f64>,
    /// The same after Holm's correction over the whole study.
    pub p_holm: Option<f64>,
    /// Success rate that the paper states of this setting.
    pub paper_success_rate: Option<f64>,
    /// Time of a localisation that the paper states, in seconds.
    pub paper_time_s: Option<f64>,
}

/// How a setting is compared with the default.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum TestKind {
    /// It is the default.
    Default,
    /// Trial by trial, McNemar's exact test.
    Mcnemar,
    /// As two rates, because the robot poses differ.
    TwoRates,
    /// There is nothing to compare with.
    None,
}

impl FigureLine {
    /// The success rate with its interval.
    #[must_use]
    pub fn success(&self) -> SuccessRate {
        SuccessRate { successes: self.successes, trials: self.trials }
    }

    /// What the paper states of the setting, which it tests near the nodes as we read it.
    #[must_use]
    pub fn paper(&self) -> Option<&'static PaperClaim> {
        paper_claim(&self.figure, &self.setting).filter(|_| self.start == Start::Near)
    }

    /// Share of the paired trials in which exactly one of default and setting was right.
    #[must_use]
    pub fn discordance(&self) -> Option<f64> {
        let discordant = self.only_default? + self.only_setting?;
        self.pairs.filter(|&pairs| pairs > 0).map(|pairs| discordant as f64 / pairs as f64)
    }
}

/// The lines of a finished study, in the scenario's order.
///
/// # Errors
/// The first row that is not legal.
pub fn figure_lines(results: &RunResults) -> Result<Vec<FigureLine>, IllegalValue> {
    let comparisons = compare_with_default(&results.scenario, &results.records)?;
    let rows = results.scenario.rows.iter().zip(&results.summary.rows).zip(comparisons);
    let lines = rows.map(|((row, summary), comparison)| {
        let (figure, setting) = figure_and_setting(row);
        let timings = results.timings.rows.iter().find(|timings| timings.row == row.name);
        let mut line = FigureLine {
            row: row.name.clone(),
            figure: figure.to_owned(),
            setting: setting.to_owned(),
            start: row.start,
            polarity: row.polarity,
            trials: summary.trials,
            successes: summary.successes,
            success_rate: summary.success_rate,
            success_rate_low: summary.success_rate_low,
            success_rate_high: summary.success_rate_high,
            mean_looks: summary.mean_looks,
            mean_localizer_s: timings.map_or(0.0, |timings| timings.mean_s_per_look * summary.mean_looks),
            test: TestKind::None,
            pairs: None,
            only_default: None,
            only_setting: None,
            difference: None,
            difference_low: None,
            difference_high: None,
            p: comparison.p,
            p_holm: comparison.p_holm,
            paper_success_rate: None,
            paper_time_s: None,
        };
        if let Some(claim) = line.paper() {
            (line.paper_success_rate, line.paper_time_s) = (Some(claim.success_rate), claim.time_s);
        }
        fill_comparison(&mut line, &comparison);
        line
    });
    Ok(lines.collect())
}

/// The lines of one figure. Where none of its settings is the default of a start that it has, the default comes first: a
/// setting says little without.
#[must_use]
pub fn lines_of_figure(lines: &[FigureLine], figure: &str) -> Vec<FigureLine> {
    let own = || lines.iter().filter(|line| line.figure == figure);
    let is_default = |line: &&FigureLine| line.test == TestKind::Default;
    let lacks_default = |start: &Start| {
        own().any(|line| line.start == *start) && !own().filter(is_default).any(|line| line.start == *start)
    };
    let starts = [Start::Near, Start::Anywhere].into_iter().filter(lacks_default);
    let added = starts.filter_map(|start| lines.iter().filter(is_default).find(|line| line.start == start));
    let added = added.map(|line| FigureLine {
        figure: figure.to_owned(),
        setting: "default".to_owned(),
        paper_success_rate: None,
        paper_time_s: None,
        ..line.clone()
    });
    added.chain(own().cloned()).collect()
}

fn fill_comparison(line: &mut FigureLine, comparison: &DefaultComparison) {
    let (difference, (low, high)) = match comparison.against {
        Against::IsDefault => {
            line.test = TestKind::Default;
            return;
        }
        Against::NoDefault => return,
        Against::Paired(counts) => {
            line.test = TestKind::Mcnemar;
            line.pairs = Some(counts.pairs());
            (line.only_default, line.only_setting) = (Some(counts.only_a), Some(counts.only_b));
            (counts.difference(), paired_difference_interval(&counts))
        }
        Against::Unpaired(default, setting) => {
            line.test = TestKind::TwoRates;
            let difference = setting.rate().zip(default.rate()).map(|(setting, default)| setting - default);
            (difference, difference_interval(default, setting))
        }
    };
    line.difference = difference;
    (line.difference_low, line.difference_high) = (Some(low), Some(high));
}

/// The lines as CSV, the columns named as the fields of [`FigureLine`].
///
/// # Errors
/// When a line can't be written.
pub fn figures_csv(lines: &[FigureLine]) -> Result<Vec<u8>, csv::Error> {
    to_csv(lines)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::monte_carlo::TrialRecord;
    use crate::report::sample;

    #[test]
    fn discordance_is_a_share_of_the_pairs_not_of_all_trials() {
        let mut results = sample::run().results;
        let name = |row: usize| results.scenario.rows[row].name.clone();
        let (default, other) = (name(0), name(1));
        results.records.retain(|record| record.row == default);
        let opposite = |record: &TrialRecord| {
            let is_success = !record.is_success;
            TrialRecord { row: other.clone(), is_success, ..record.clone() }
        };
        let opposites: Vec<TrialRecord> = results.records.iter().map(opposite).collect();
        results.records.truncate(20);
        results.records.extend(opposites);
        let lines = figure_lines(&results).expect("legal rows");
        assert_eq!((lines[1].trials, lines[1].pairs, lines[1].discordance()), (60, Some(20), Some(1.0)));
    }

    #[test]
    fn a_figure_without_the_default_gets_it() {
        let mut lines = figure_lines(&sample::run().results).expect("legal rows");
        let starts: Vec<Start> = lines.iter().map(|line| line.start).collect();
        let of = |start| starts.iter().position(|&other| other == start).expect("a row of that start");
        let (near, anywhere) = (of(Start::Near), of(Start::Anywhere));
        for line in &mut lines {
            (line.figure, line.test) = ("other".to_owned(), TestKind::Mcnemar);
        }
        (lines[near].figure, lines[near].test) = ("4(a)".to_owned(), TestKind::Default);
        lines[anywhere].figure = "start".to_owned();
        lines[anywhere].test = TestKind::Default;
        let names = |figure: &str| {
            let of_figure = lines_of_figure(&lines, figure);
            of_figure.into_iter().map(|line| (line.setting, line.start)).collect::<Vec<_>>()
        };
        assert_eq!((names("4(a)").len(), names("start").len(), names("none").len()), (1, 1, 0));
        let default = |start| ("default".to_owned(), start);
        assert_eq!(names("other")[..2], [default(Start::Near), default(Start::Anywhere)]);
        assert_eq!(names("other").len(), lines.len());
    }
}

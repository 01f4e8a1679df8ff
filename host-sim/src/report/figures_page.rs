//! The page of a study: every figure with its intervals beside what the paper states, and why the two differ.

use super::document::{document, inline};
use super::drawing::percent;
use super::figure_lines::{FigureLine, TestKind, lines_of_figure};
use super::{RunResults, figure_chart};
use crate::monte_carlo::paired_difference_interval;
use crate::scenario::Start;
use crate::sweep::{Against, Demand, PAPER_OPENINGS, against_row, figures_of};
use maud::{Markup, html};
use std::fmt::Write;

/// The report of a study: `lines` are those of `results`.
#[must_use]
pub fn figures_page(results: &RunResults, lines: &[FigureLine]) -> String {
    let title = format!("edgeloc figures: {}", results.scenario.name);
    let manifest = &results.manifest;
    let started = manifest.started_utc.trim_end_matches('Z').replace('T', " ");
    let subtitle = format!(
        "{} trials of {} settings · world {} · started {started} UTC",
        manifest.trials, manifest.rows, manifest.world.name
    );
    let body = html! {
        (what_came_out(lines))
        @for figure in figures_of(&results.scenario.rows) {
            (one_figure(&figure.name, &lines_of_figure(lines, &figure.name).iter().collect::<Vec<_>>()))
            @if figure.name == "4(b)" { (against_none(results)) }
        }
        (openings())
        (facts(results))
    };
    document(&title, &subtitle, &body)
}

/// What a study of these trials can find, as a sentence; `discordance` is the share of trials in which two settings
/// disagree.
#[must_use]
pub fn power_sentence(rate: f64, trials: u64, discordance: f64, comparisons: usize) -> String {
    let one = Demand::default();
    let all = one.shared_by(comparisons);
    let paired = one.detectable_loss(rate, Some(discordance), trials);
    let trials_words = if trials == 1 { "1 paired trial".to_owned() } else { format!("{trials} paired trials") };
    let Some(paired) = paired else {
        let rate = percent(rate);
        return format!("{trials_words} can't detect even a fall from {rate} to 0 (95 % confidence, 80 % power)");
    };
    let loss =
        |loss: Option<f64>| loss.map_or("no loss".to_owned(), |loss| format!("one of {:.1} points", 100.0 * loss));
    let shared = if comparisons > 1 {
        let loss = loss(all.detectable_loss(rate, Some(discordance), trials));
        format!(", {loss} when {comparisons} comparisons share the 5 %")
    } else {
        String::new()
    };
    format!(
        "{trials_words} detect a loss of {:.1} points from {} where two settings disagree in {} of the trials (95 % \
         confidence, 80 % power){shared}; unpaired they would detect {}",
        100.0 * paired,
        percent(rate),
        percent(discordance),
        loss(one.detectable_unpaired_loss(rate, trials)),
    )
}

fn what_came_out(lines: &[FigureLine]) -> Markup {
    let is_default =
        |start: Start| lines.iter().find(move |line| line.test == TestKind::Default && line.start == start);
    let compared = lines.iter().filter(|line| line.p_holm.is_some()).count();
    let different = lines.iter().filter(|line| line.p_holm.is_some_and(|p| p < 0.05));
    let mut discordances = lines.iter().filter_map(FigureLine::discordance).collect::<Vec<_>>();
    discordances.sort_by(f64::total_cmp);
    html! { section {
        h2 { "What came out" }
        @if let Some(default) = is_default(Start::Near) {
            p { "The default, near the nodes: " b { (default.success()) } ". The paper: 92.82 % over 900 trials, [90.9, 94.3]." }
        }
        @if let Some(default) = is_default(Start::Anywhere) {
            p { "The default, anywhere in free space: " b { (default.success()) } "." }
        }
        p {
            "Of " (compared) " comparisons with the default these differ after Holm's correction (p < 0.05): "
            @let names = different.map(|line| format!("{} ({})", line.row, points(line.difference))).collect::<Vec<_>>();
            @if names.is_empty() { "none." } @else { (names.join("; ")) "." }
        }
        @if let (Some(default), Some(discordance)) = (is_default(Start::Near), discordances.get(discordances.len() / 2)) {
            p.note { (power_sentence(default.success_rate.unwrap_or(0.0), default.trials, *discordance, compared)) "." }
        }
        p.note {
            "A trial succeeds when the answered node is one of the two nearest to the true position. Bars are 95 % Wilson intervals; "
            "all settings meet the same robot poses and the same draws of every noise source, so each is compared with the default "
            "trial by trial (McNemar's exact test). Dashed lines are what the paper's text states: its figures are pictures. Blue: "
            "near the nodes; orange: anywhere. The small bars below are the wall time of the localiser for a whole localisation."
        }
    } }
}

fn one_figure(name: &str, lines: &[&FigureLine]) -> Markup {
    html! { section {
        h2 { @if name.is_empty() { "Settings" } @else { "Figure " (name) } }
        div.wide { (inline(&figure_chart(lines))) }
        div.wide { table {
            tr {
                th { "setting" } th.number { "trials" } th { "success" } th { "the paper" } th.number { "looks" }
                th.number { "time" } th.number { "against default" } th { "95 % interval" } th.number { "only default : only this" }
                th.number { "p" } th.number { "p, Holm" }
            }
            @for line in lines { (table_row(line)) }
        } }
    } }
}

fn table_row(line: &FigureLine) -> Markup {
    let p_value = |p: Option<f64>| p.map(|p| if p < 0.001 { "< 0.001".to_owned() } else { format!("{p:.3}") });
    html! { tr {
        td { (line.setting) @if line.start == Start::Anywhere { span.quiet { " anywhere" } } }
        td.number { (line.trials) }
        td { (rate_with_interval(line)) }
        td { @if let Some(claim) = line.paper() { (format!("{:.2} %", 100.0 * claim.success_rate)) } }
        td.number { (format!("{:.2}", line.mean_looks)) }
        td.number { (format!("{:.1} ms", 1e3 * line.mean_localizer_s)) }
        @match line.test {
            TestKind::Default => td colspan="5" { span.quiet { "the default" } },
            TestKind::None => td colspan="5" { span.quiet { "nothing to compare with" } },
            TestKind::Mcnemar | TestKind::TwoRates => {
                td.number { (points(line.difference)) }
                td { @if let (Some(low), Some(high)) = (line.difference_low, line.difference_high) { (format!("[{:+.1}, {:+.1}]", 100.0 * low, 100.0 * high)) } }
                td.number { @match (line.only_default, line.only_setting) {
                    (Some(default), Some(setting)) => { (default) " : " (setting) },
                    _ => span.quiet { "other poses" },
                } }
                td.number { @if let Some(p) = p_value(line.p) { (p) } }
                td.number { @if let Some(p) = p_value(line.p_holm) { (p) } }
            },
        }
    } }
}

fn rate_with_interval(line: &FigureLine) -> String {
    let (low, high) = (100.0 * line.success_rate_low, 100.0 * line.success_rate_high);
    line.success_rate.map_or_else(|| "no trials".to_owned(), |rate| format!("{} [{low:.1}, {high:.1}]", percent(rate)))
}

fn points(difference: Option<f64>) -> String {
    difference.map_or_else(String::new, |difference| format!("{:+.1} points", 100.0 * difference))
}

/// Each source alone against none at all: the fall that the paper speaks of.
fn against_none(results: &RunResults) -> Markup {
    let rows = &results.scenario.rows;
    let Some(none) = rows.iter().find(|row| row.name == "4(b): none") else { return html! {} };
    let mut words = String::new();
    for row in
        rows.iter().filter(|row| row.name.starts_with("4(b): ") && row.name != none.name && row.start == none.start)
    {
        if let Against::Paired(counts) = against_row(&results.records, &none.name, &row.name) {
            let (low, high) = paired_difference_interval(&counts);
            let _ = write!(
                words,
                "{}{} {} [{:+.1}, {:+.1}]",
                if words.is_empty() { "" } else { "; " },
                row.name.trim_start_matches("4(b): "),
                points(counts.difference()),
                100.0 * low,
                100.0 * high
            );
        }
    }
    html! { section {
        h2 { "Each source alone, against none" }
        p.note { "The paper sees falls for stereo match errors and intense edge detection loss. Here: " (words) "." }
    } }
}

fn openings() -> Markup {
    html! { section {
        h2 { "The paper's study and this one" }
        p.note { "Where the paper leaves something open or contradicts itself, and what was chosen here." }
        div.wide { table {
            tr { th { "" } th { "the paper" } th { "here" } }
            @for opening in PAPER_OPENINGS { tr { td { (opening.subject) } td { (opening.paper) } td { (opening.choice) } } }
        } }
    } }
}

fn facts(results: &RunResults) -> Markup {
    let RunResults { manifest, timings, scenario, .. } = results;
    html! { section {
        h2 { "Facts" }
        dl {
            dt { "world" } dd { (manifest.world.name) ", " (manifest.world.edges) " straight edges, checksum " code { (manifest.world.checksum) } }
            dt { "program" } dd { "edgeloc " (manifest.program_version) @if let Some(commit) = &manifest.git_commit { ", commit " code { (commit) } } }
            dt { "command" } dd { code { (manifest.command.join(" ")) } }
            dt { "wall time" } dd { (format!("{:.0} s", timings.total_s())) }
            dt { "machine" } dd { (manifest.host.processor.as_deref().unwrap_or("unnamed processor")) ", " @if let Some(instructions) = &manifest.host.instructions { (instructions) ", " } (manifest.host.used_threads) @if manifest.host.used_threads == 1 { " thread" } @else { " threads" } }
            dt { "noise draws" } dd { "the map is learned anew every " (scenario.trials_per_map) " trials" }
        }
        details { summary { "scenario.toml" } pre { (scenario.to_toml()) } }
    } }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{figure_lines, figures_csv, sample};

    #[test]
    fn the_page_is_self_contained_and_tells_every_setting_and_opening() {
        let mut results = sample::run().results;
        for (row, name) in
            results.scenario.rows.iter_mut().zip(["4(a): B_th 0.1", "4(b): none", "5 left: n_dist 15", "x"])
        {
            results
                .records
                .iter_mut()
                .filter(|record| record.row == row.name)
                .for_each(|record| record.row = name.into());
            row.name = name.to_owned();
        }
        let lines = figure_lines(&results).expect("legal rows");
        let page = figures_page(&results, &lines);
        for part in ["B_th 0.1", "95.57 %", "the default", "p, Holm", "equation (1)", "Each source alone", "[[rows]]"] {
            assert!(page.contains(part), "the page lacks {part:?}");
        }
        // The name space of a drawing is a name, nothing that is fetched.
        let page = page.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
        for foreign in ["http", "<script", "src=", "NaN"] {
            assert!(!page.contains(foreign), "the page has {foreign:?}");
        }
        let csv = String::from_utf8(figures_csv(&lines).expect("a table")).expect("UTF-8");
        assert_eq!(csv.lines().count(), 1 + lines.len());
        let columns = "row,figure,setting,start,polarity,trials,successes,success_rate,success_rate_low,success_rate_high,\
                       mean_looks,mean_localizer_s,test,pairs,only_default,only_setting,difference,difference_low,difference_high,\
                       p,p_holm,paper_success_rate,paper_time_s";
        assert_eq!(csv.lines().next(), Some(columns));
    }

    #[test]
    fn a_study_says_what_it_can_find() {
        let sentence = power_sentence(0.93, 900, 0.08, 19);
        assert!(sentence.starts_with("900 paired trials detect a loss of 2.6 points from 93.0 %"), "{sentence}");
        assert!(sentence.contains("19 comparisons"), "{sentence}");
        assert!(!power_sentence(0.93, 900, 0.08, 1).contains("comparisons"));
        let few = power_sentence(0.93, 2, 0.08, 19);
        assert!(few.starts_with("2 paired trials can't detect even a fall from 93.0 % to 0"), "{few}");
    }
}

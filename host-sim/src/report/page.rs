//! `report.html`: one self-contained page of a run, with inline drawings and native tooltips, no scripts.

use super::document::{document, inline};
use super::drawing::{SERIES_COUNT, percent};
use super::{
    AnswerFigures, FloorPlan, FreeCells, Manifest, PAPER_INTERVAL, RowSummary, RunResults, Share, Summary,
    looks_histogram, rate_strip, reliability, reliability_chart, success_by_distance, trial_marks, worst_trials,
};
use crate::learning::{POOR_M, SightCoverage};
use crate::monte_carlo::{Outcome, TrialRecord};
use crate::scenario::{Row, Start};
use crate::world::WireframeWorld;
use edgeloc::geometry::Point2;
use maud::{Markup, html};
use svg::Node as _;
use svg::node::element::{Definitions, Group, SVG, Use};

/// Failures listed with the command that replays them.
const WORST_COUNT: usize = 3;
/// Rows drawn one by one; a study of many rows is read from its table.
const DRAWN_ROWS: usize = 12;

/// The report of a run. `folder` is how commands name its folder.
///
/// `coverage` is that of each row's nodes. Without the world, its free space or the coverage the plan shows what is left.
#[must_use]
pub fn page(
    results: &RunResults,
    world: Option<&WireframeWorld>,
    free: Option<&FreeCells>,
    coverage: &[SightCoverage],
    folder: &str,
) -> String {
    let plan = |(row, nodes): (usize, &Vec<Point2>)| {
        let mut plan = FloorPlan::new(world, free, nodes);
        if let Some((free, centers)) = free.and_then(|free| Some((free, free.withheld.get(row)?))) {
            plan = plan.with_withheld(free, centers);
        }
        if let Some(coverage) = coverage.get(row) {
            plan = plan.with_poor_places(coverage);
        }
        plan
    };
    let plans: Vec<FloorPlan> = results.nodes.iter().enumerate().map(plan).collect();
    let title = format!("edgeloc run: {}", results.scenario.name);
    let body = html! {
        (headline(results))
        (answers(results))
        (distance(results))
        (self::plans(results, &plans))
        (looks(results))
        (worst(results, folder))
        (facts(results, world.is_some(), coverage))
        (configuration(results))
    };
    document(&title, &subtitle(results), &body)
}

fn subtitle(results: &RunResults) -> String {
    let Manifest { trials, rows, world, started_utc, .. } = &results.manifest;
    let started = started_utc.trim_end_matches('Z').replace('T', " ");
    format!("{trials} trials in {rows} rows · world {} · started {started} UTC", world.name)
}

fn headline(results: &RunResults) -> Markup {
    let summary = &results.summary;
    let (low, high) = PAPER_INTERVAL;
    html! { section {
        h2 { "Success" }
        p.note {
            "A trial succeeds when the answered node is one of the two nearest to the true position (and without an answer, where it "
            "starts in a place that was never learned). Brackets and bars are "
            "95 % Wilson intervals. The paper reports " (percent(summary.paper_rate)) " ["
            (format!("{:.1}, {:.1}", 100.0 * low, 100.0 * high)) "] in simulation (dashed, shown beside the near starts); "
            "blind guessing gives " (values(summary, |row| percent(row.chance_rate))) " (dotted). Time per look is the mean wall time of the "
            "localiser alone, on one thread."
        }
        div.wide { table {
            tr {
                th { "row" } th { "success" } th { "0 to 100 %" } th.number { "trials" } th.number { "looks" br; "mean" }
                th.number { "time per look" br; "mean" } th.number { "can't tell" } th.number { "to nearest node" br; "mean" }
                th.number { "to answered node" br; "median" }
            }
            @for (series, row) in summary.rows.iter().enumerate() { (headline_row(results, series, row)) }
        } }
    } }
}

/// A commit as people write it; `-dirty` stays.
fn short_commit(commit: &str) -> String {
    let (hash, mark) = commit.split_once('-').map_or((commit, ""), |(hash, _)| (hash, "-dirty"));
    format!("{}{mark}", hash.get(..12).unwrap_or(hash))
}

fn headline_row(results: &RunResults, series: usize, row: &RowSummary) -> Markup {
    let timings = results.timings.rows.iter().find(|timings| timings.row == row.row);
    let paper = (row.start == Start::Near).then_some(PAPER_INTERVAL);
    let strip = rate_strip(series, row.success(), paper, row.chance_rate);
    html! { tr {
        td { (key(series)) (row.row) }
        td.strong {
            @match row.success_rate {
                Some(rate) => {
                    (percent(rate)) " "
                    span.quiet { "[" (format!("{:.1}, {:.1}", 100.0 * row.success_rate_low, 100.0 * row.success_rate_high)) "]" }
                }
                None => span.quiet { "no trials" },
            }
        }
        td { (inline(&strip)) }
        td.number { (row.trials) }
        td.number { (format!("{:.2}", row.mean_looks)) }
        td.number { @if let Some(timings) = timings { (format!("{:.1} ms", 1e3 * timings.mean_s_per_look)) } }
        td.number { (row.unknown) @if row.errors > 0 { " + " (row.errors) " errors" } }
        td.number { (format!("{:.2} m", row.mean_nearest_node_distance_m)) }
        td.number { @if let Some(distance) = row.median_answer_distance_m { (format!("{distance:.2} m")) } }
    } }
}

/// What the answers are worth, and whether their probabilities are honest.
fn answers(results: &RunResults) -> Markup {
    let has_probability = results.summary.rows.iter().any(|row| row.answers.calibration_error.is_some());
    html! { section {
        h2 { "Answers" }
        p.note {
            "A localiser may say that it can't tell: that is a failure above, but no false accept. Coverage: trials answered. False "
            "accepts: wrong answers of all answers; where starts are unlearned, answers of all trials, and right is \"can't tell\". "
            "Or named: right, or the truth among the rivals named. Near ties: answers within 0.5 m whose node is not one of the two "
            "nearest; they count as wrong. Brackets are 95 % Wilson intervals; position errors are median, 95 % and 99 % of the answers."
        }
        div.wide { table {
            tr {
                th { "row" } th { "coverage" } th { "false accepts" } th { "or named" } th.number { "near ties" }
                th.number { "position error" br; "50 / 95 / 99 %" } th.number { "heading error" br; "median" }
                th.number { "calibration" br; "error" }
            }
            @for (series, row) in results.summary.rows.iter().enumerate() { @let answers = &row.answers; tr {
                td { (key(series)) (row.row) }
                td { (share(&answers.coverage, 1)) } td { (share(&answers.false_accepts, 2)) } td { (share(&answers.truth_named, 1)) }
                td.number { (answers.near_ties) }
                td.number { (position_errors(answers)) }
                td.number { @if let Some(error) = answers.heading_error_median_deg { (format!("{error:.2}°")) } }
                td.number { @if let Some(error) = answers.calibration_error { (percent(error)) } }
            } }
        } }
        @if has_probability {
            h3 { "Are the probabilities honest?" }
            p.note {
                "Reliability of the probabilities that answers state: bins of equally many answers by rising probability, with 95 % Wilson "
                "intervals; on the dashed line what is stated comes true. The calibration error is the mean distance from it, weighed by "
                "answers; a few hundred answers have one of a point or so by chance."
            }
            div.panels { @for (series, row) in drawn(results).iter().enumerate() {
                @let bins = reliability(results.records.iter().filter(|record| record.row == row.name));
                @if !bins.is_empty() { figure {
                    figcaption { (key(series)) (row.name) }
                    (inline(&reliability_chart(series, &bins)))
                } }
            } }
        }
    } }
}

/// A share with its interval, in percent with so many decimals.
pub(super) fn share(share: &Share, decimals: usize) -> Markup {
    html! { @match share.rate {
        Some(rate) => {
            (format!("{:.decimals$} %", 100.0 * rate)) " "
            span.quiet { "[" (format!("{:.decimals$}, {:.decimals$}", 100.0 * share.low, 100.0 * share.high)) "]" }
        }
        None => span.quiet { "of none" },
    } }
}

/// The quantiles of the position error in centimetres.
pub(super) fn position_errors(answers: &AnswerFigures) -> String {
    match (answers.pose_error_median_m, answers.pose_error_95_m, answers.pose_error_99_m) {
        (Some(median), Some(most), Some(nearly_all)) => {
            format!("{:.1} / {:.1} / {:.1} cm", 100.0 * median, 100.0 * most, 100.0 * nearly_all)
        }
        _ => String::new(),
    }
}

fn distance(results: &RunResults) -> Markup {
    let rows = drawn(results);
    html! { section {
        h2 { "Success against distance to the nearest node" }
        p.note { "Displacement from the learned places is what breaks the method. Bins of fewer than 5 trials are left out; dashed: the paper." }
        (legend(rows))
        div.wide { (inline(&success_by_distance(rows, &results.records))) }
    } }
}

fn plans(results: &RunResults, plans: &[FloorPlan]) -> Markup {
    let rows = drawn(results);
    // The world and each set of nodes are drawn once and used by each plan.
    let first_with = |row: usize| results.nodes.iter().position(|nodes| *nodes == results.nodes[row]).unwrap_or(row);
    let mut shared = Definitions::new();
    if let Some(plan) = plans.first() {
        shared.append(Group::new().set("id", "world").add(plan.background()));
    }
    for (row, plan) in plans.iter().enumerate().take(rows.len()).filter(|(row, _)| *row == first_with(*row)) {
        shared.append(Group::new().set("id", format!("nodes{row}")).add(plan.node_marks()));
    }
    let shared = SVG::new()
        .set("class", "drawing")
        .set("width", 0)
        .set("height", 0)
        .set("style", "position:absolute")
        .add(shared);
    let trials_of = |series: usize, row: &Row, plan: &FloorPlan| {
        let of_row = results.records.iter().filter(|record| record.row == row.name);
        let layers = ["world".to_owned(), format!("nodes{}", first_with(series))];
        let under =
            layers.iter().fold(plan.canvas(), |canvas, id| canvas.add(Use::new().set("href", format!("#{id}"))));
        under.add(trial_marks(plan, of_row)).add(plan.scale_bar())
    };
    html! { section {
        h2 { "Where it worked" }
        p.note { "Seen from above: every edge of the world, free space tinted. A failure has a line to the node that was answered. Point at a mark for its trial." }
        ul.legend {
            li { span.key.kgood {} "success" } li { span.key.kbad {} "failure" } li { span.key.kunknown {} "can't tell" }
            li { span.key.knode {} "node" } li { span.key.kfree {} "free space" }
            @if rows.iter().any(|row| row.start == Start::Unlearned) { li { span.key.kwithheld {} "not learned" } }
            li { span.key.kpoor {} "no node in sight within " (POOR_M) " m" }
        }
        (inline(&shared))
        div.panels {
            @for (series, (row, plan)) in rows.iter().zip(plans).enumerate() {
                figure {
                    figcaption { (key(series)) (row.name) }
                    (inline(&trials_of(series, row, plan)))
                }
            }
        }
    } }
}

fn looks(results: &RunResults) -> Markup {
    // A robot that moved looks around anew: more looks than one full turn has.
    let most = |row: &Row| {
        let setting = results.scenario.setting(Some(&row.name)).and_then(Result::ok);
        let around =
            setting.map_or(results.scenario.localizer.max_looks, |setting| setting.scenario.localizer.max_looks);
        let taken = results.records.iter().filter(|record| record.row == row.name).map(|record| record.looks).max();
        u32::from(around).max(taken.unwrap_or(0)).min(u32::from(u16::MAX)) as u16
    };
    html! { section {
        h2 { "Looks" }
        p.note { "How many looks a trial took until the answer: right ones green, others red. At the last look shown the leading node is the answer." }
        div.panels {
            @for row in drawn(results) { figure { (inline(&looks_histogram(row, &results.records, most(row)))) } }
        }
    } }
}

fn worst(results: &RunResults, folder: &str) -> Markup {
    let worst = worst_trials(&results.records, WORST_COUNT);
    html! { section {
        h2 { "The worst trials" }
        @if worst.is_empty() {
            p.note { "None: every trial succeeded." }
        } @else {
            p.note { "Failures whose answer lies farthest from the truth. The command shows the trial look by look, with drawings." }
            @for record in worst {
                h3 { (describe(record)) }
                pre { (replay_command(record, folder)) }
            }
        }
    } }
}

fn describe(record: &TrialRecord) -> String {
    let answer = match (record.outcome, record.answered_node) {
        (Outcome::Localized, Some(node)) => {
            format!("answered node {node}, {:.1} m away", record.answer_distance_m.unwrap_or(f32::NAN))
        }
        (Outcome::Error, _) => {
            format!("the localiser failed: {}", record.message.as_deref().unwrap_or("no reason given"))
        }
        _ => "could not tell".to_owned(),
    };
    let truth = record.truth_score.map_or_else(
        || "both near nodes had dropped out before".to_owned(),
        |score| format!("{score:.3} of the better near node"),
    );
    format!(
        "{}, trial {}: {answer}, after {} looks; leading score {:.3}, {truth}",
        record.row, record.trial, record.looks, record.leader_score,
    )
}

/// The command that replays a trial of the run in `folder`.
#[must_use]
pub fn replay_command(record: &TrialRecord, folder: &str) -> String {
    format!("edgeloc replay {} --row {} --trial {}", quoted(folder), quoted(&record.row), record.trial)
}

/// `word` as a shell takes it.
fn quoted(word: &str) -> String {
    let is_plain = !word.is_empty() && word.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"-_./".contains(&byte));
    if is_plain { word.to_owned() } else { format!("'{}'", word.replace('\'', r"'\''")) }
}

fn facts(results: &RunResults, has_world: bool, coverages: &[SightCoverage]) -> Markup {
    let RunResults { manifest, summary, timings, scenario, .. } = results;
    let (world, host) = (&manifest.world, &manifest.host);
    let views = scenario.learning.views;
    html! { section {
        h2 { "Facts" }
        div.facts {
            dl {
                dt { "world" } dd { (world.name) }
                dt { "origin" } dd { (world.origin) }
                @if let Some(file) = &world.file { dt { "file" } dd { (file) @if !has_world { " (not found for this report)" } } }
                dt { "edges" } dd { (world.edges) " straight edges, " (world.triangles) " triangles" }
                dt { "checksum" } dd { code { (world.checksum) } }
                dt { "map" } dd { (values(summary, |row| row.nodes.to_string())) " nodes of " (views) " views, " (values(summary, |row| format!("{:.0}", row.map.mean_segments_per_node))) " segments a node" }
                dt { "density" } dd { "a node for each " (values(summary, |row| format!("{:.1}", row.map.free_m2_per_node))) " m² of free space" }
                @if let Some(coverage) = coverages.first() {
                    dt { "coverage" } dd { (coverage.describe()) @if coverages.iter().any(|other| other != coverage) { " (first row)" } }
                }
                dt { "map size" } dd { (values(summary, |row| format!("{:.0}", row.map.mean_bytes / 1e3))) " kB" }
                dt { "noise draws" } dd { "the map is learned anew every " (scenario.trials_per_map) " trials" }
            }
            dl {
                dt { "program" } dd { "edgeloc " (manifest.program_version) @if let Some(commit) = &manifest.git_commit { ", commit " code { (short_commit(commit)) } } }
                dt { "command" } dd { code { (manifest.command.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")) } }
                @if let Some(shard) = manifest.shard { dt { "shard" } dd { (shard) " of the run: these figures are of its trials alone" } }
                dt { "seed" } dd { (manifest.seed) }
                dt { "wall time" } dd { (format!("{:.1} s: {:.1} s to prepare, {:.1} s for learning and trials", timings.total_s(), timings.prepare_s, timings.trials_s)) }
                dt { "machine" } dd { (host.processor.as_deref().unwrap_or("unnamed processor")) ", " (host.architecture) ", " (host.os) }
                @if let Some(instructions) = &host.instructions { dt { "instructions" } dd { (instructions) } }
                dt { "threads" } dd { (host.used_threads) " of " (host.available_threads) }
                dt { "finished" } dd { (manifest.finished_utc.as_deref().unwrap_or("not yet")) }
            }
        }
    } }
}

fn configuration(results: &RunResults) -> Markup {
    html! { section {
        h2 { "Configuration" }
        p.note { "The whole scenario as it ran, settings of the command line included; the file " code { "scenario.toml" } " in the run's folder runs as it is." }
        details { summary { "scenario.toml" } pre { (results.scenario.to_toml()) } }
    } }
}

/// The rows that are drawn one by one.
fn drawn(results: &RunResults) -> &[Row] {
    let rows = &results.scenario.rows;
    &rows[..rows.len().min(DRAWN_ROWS)]
}

/// A figure of the rows: each of its values once, up to three.
fn values(summary: &Summary, figure: impl Fn(&RowSummary) -> String) -> String {
    let mut found: Vec<String> = Vec::new();
    for value in summary.rows.iter().map(figure) {
        if !found.contains(&value) {
            found.push(value);
        }
    }
    let more = if found.len() > 3 { ", …" } else { "" };
    found.truncate(3);
    format!("{}{more}", found.join(", "))
}

fn legend(rows: &[Row]) -> Markup {
    html! { ul.legend { @for (series, row) in rows.iter().enumerate() { li { (key(series)) (row.name) } } } }
}

fn key(series: usize) -> Markup {
    html! { span class={ "key k" (series % SERIES_COUNT) } {} }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    #[test]
    fn the_page_is_self_contained_and_complete() {
        let sample = sample::run();
        let page =
            page(&sample.results, Some(&sample.world), Some(&sample.free), &sample.coverage, "runs/2026-01-02-hall");
        for part in [
            "Answers",
            "false accepts",
            "near, no polarity",
            "edgeloc replay runs/2026-01-02-hall --row",
            "[localizer.pgh]",
            "<title>",
            "class=\"poor\"",
            "a node in sight within 1 m",
        ] {
            assert!(page.contains(part), "the page lacks {part:?}");
        }
        assert!(!page.contains("<script") && !page.contains("src=") && !page.contains("NaN"));
        if let Some(path) = std::env::var_os("EDGELOC_SAMPLE_REPORT") {
            std::fs::write(path, &page).expect("a written page");
        }
    }

    #[test]
    fn a_page_without_the_world_is_still_a_page() {
        let page = page(&sample::run().results, None, None, &[], "runs/x");
        assert!(page.contains("Where it worked"));
    }

    #[test]
    fn probabilities_have_a_reliability_curve() {
        let mut results = sample::run().results;
        let without = page(&results, None, None, &[], "runs/x");
        results.records.iter_mut().for_each(|record| record.probability = Some(0.9));
        let nodes = results.nodes.clone();
        results.summary = Summary::new(&results.scenario, &nodes, 120.0, &results.records);
        let with = page(&results, None, None, &[], "runs/x");
        assert!(!without.contains("Are the probabilities honest?") && with.contains("Are the probabilities honest?"));
        assert!(with.contains("stated 90.0 %"));
    }

    #[test]
    fn names_are_escaped_in_markup_and_shell() {
        let mut results = sample::run().results;
        results.manifest.world.name = "<b>".to_owned();
        assert!(!page(&results, None, None, &[], "it's").contains("<b>"));
        assert_eq!(quoted("it's"), r"'it'\''s'");
    }
}

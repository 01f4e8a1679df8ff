//! `validation.html`: a localiser over several worlds, on one self-contained page.

use super::answers::reliability;
use super::axes::Axes;
use super::document::{document, inline};
use super::drawing::{SERIES_COUNT, drawing, line, percent, text, tooltip};
use super::page::{position_errors, share};
use super::{AnswerFigures, RunResults, Share, ValidationRow, reliability_chart};
use maud::{Markup, html};
use svg::Node as _;
use svg::node::element::{Circle, Group, Rectangle, SVG};

/// The page of `rows`, made of `runs`, each with the name of its world. `folder` is how commands name the folder.
#[must_use]
pub fn validation_page(rows: &[ValidationRow], runs: &[(String, RunResults)], folder: &str) -> String {
    let scenario = runs.first().map_or("", |(_, first)| first.scenario.name.as_str());
    let trials: usize = runs.iter().map(|(_, results)| results.records.len()).sum();
    let worlds: Vec<&str> = runs.iter().map(|(world, _)| world.as_str()).collect();
    let subtitle = format!("{trials} trials in {}", worlds.join(", "));
    let body = html! {
        (together(rows))
        @for (series, row) in rows.iter().enumerate() { (row_section(series, row)) }
        (honesty(rows, runs))
        (provenance(runs, folder))
    };
    document(&format!("edgeloc validate: {scenario}"), &subtitle, &body)
}

fn together(rows: &[ValidationRow]) -> Markup {
    html! { section {
        h2 { "All worlds together" }
        p.note {
            "Success: right answers of all trials; \"can't tell\" is a failure, but where starts are unlearned it alone is right. The "
            "mean counts each world alike; its 95 % interval is Student's over the rates of the worlds (cluster-level analysis, Donner and "
            "Klar 2000), because trials of one world are more alike than trials of two, and never narrower than Wilson's of all trials. "
            "The other intervals are Wilson's, of all trials taken as one world's. False accepts: wrong answers of all answers (unlearned: "
            "answers of all trials). Or named: right, or the truth among the rivals named."
        }
        div.wide { table {
            (head("row", true))
            @for (series, row) in rows.iter().enumerate() { @let total = &row.total; tr {
                td { (key(series)) (row.row) }
                td.strong { @if let Some(mean) = total.mean_success_rate {
                    (format!("{:.2} %", 100.0 * mean)) " "
                    @if row.worlds.len() > 1 {
                        span.quiet { (format!("[{:.2}, {:.2}]", 100.0 * total.clustered_low, 100.0 * total.clustered_high)) }
                    }
                } }
                td { @if let (Some(world), Some(rate)) = (&total.worst_world, total.worst_success_rate) {
                    (format!("{:.2} %", 100.0 * rate)) " " span.quiet { (world) }
                } }
                (answer_cells(&total.answers, total.success.of, total.mean_looks, total.errors))
            } }
        } }
    } }
}

fn row_section(series: usize, row: &ValidationRow) -> Markup {
    let shares: Vec<(&str, &Share)> = row.worlds.iter().map(|world| (world.world.as_str(), &world.success)).collect();
    html! { section {
        h2 { (key(series)) (row.row) }
        (inline(&worlds_chart(series, &shares, row)))
        div.wide { table {
            (head("world", false))
            @for world in &row.worlds { tr {
                td { (world.world) " " span.quiet { (world.nodes) " nodes, " (format!("{:.2}", world.free_m2_per_node)) " m² each" } }
                td.strong { (share(&world.success, 2)) }
                (answer_cells(&world.answers, world.success.of, world.mean_looks, world.errors))
            } }
        } }
    } }
}

fn head(first: &str, has_worst: bool) -> Markup {
    html! { tr {
        th { (first) } th { "success" } @if has_worst { th { "worst world" } } th { "coverage" } th { "false accepts" } th { "or named" }
        th.number { "position error" br; "50 / 95 / 99 %" } th.number { "heading" br; "median" } th.number { "looks" br; "mean" }
        th.number { "near ties" } th.number { "calibration" br; "error" } th.number { "trials" }
    } }
}

fn answer_cells(answers: &AnswerFigures, trials: u64, mean_looks: f64, errors: u64) -> Markup {
    html! {
        td { (share(&answers.coverage, 1)) } td { (share(&answers.false_accepts, 2)) } td { (share(&answers.truth_named, 2)) }
        td.number { (position_errors(answers)) }
        td.number { @if let Some(error) = answers.heading_error_median_deg { (format!("{error:.2}°")) } }
        td.number { (format!("{mean_looks:.2}")) }
        td.number { (answers.near_ties) }
        td.number { @if let Some(error) = answers.calibration_error { (percent(error)) } }
        td.number { (trials) @if errors > 0 { ", " (errors) " errors" } }
    }
}

/// The success rate of each world on a scale that begins below the lowest, with the clustered interval as a band.
fn worlds_chart(series: usize, worlds: &[(&str, &Share)], row: &ValidationRow) -> SVG {
    let lows = worlds.iter().map(|(_, share)| share.low).chain([row.total.clustered_low]);
    let from = (lows.fold(1.0, f64::min) * 10.0).floor().clamp(0.0, 9.0) / 10.0;
    let axes = Axes { left: 160.0, top: 8.0, width: 560.0, height: 26.0 * worlds.len().max(1) as f64 };
    let x = |rate: f64| axes.x(((rate - from) / (1.0 - from)).clamp(0.0, 1.0));
    let mut chart = drawing(760.0, axes.height + 40.0);
    let (low, high) = (row.total.clustered_low, row.total.clustered_high);
    if worlds.len() > 1 {
        let band = Rectangle::new().set("class", "guide-band").set("x", x(low)).set("y", axes.top);
        let label = format!("interval over worlds: {} to {}", percent(low), percent(high));
        chart.append(band.set("width", x(high) - x(low)).set("height", axes.height).add(tooltip(label)));
    }
    for step in 0_u8..=5 {
        let rate = from + (1.0 - from) * f64::from(step) / 5.0;
        chart.append(line("grid", (x(rate), axes.y(1.0)), (x(rate), axes.y(0.0))));
        chart.append(text("middle", (x(rate), axes.y(0.0) + 18.0), percent(rate)));
    }
    let mut group = Group::new().set("class", format!("series{}", series % SERIES_COUNT));
    for (index, (world, share)) in worlds.iter().enumerate() {
        let y = axes.y(1.0 - (index as f64 + 0.5) / worlds.len() as f64);
        chart.append(text("end", (axes.left - 10.0, y + 4.0), *world));
        let Some(rate) = share.rate else { continue };
        let mark = Group::new().add(tooltip(format!("{world}: {} of {}", share.count, share.of)));
        let mark = mark.add(line("whisker", (x(share.low), y), (x(share.high), y)));
        group.append(mark.add(Circle::new().set("class", "dot").set("cx", x(rate)).set("cy", y).set("r", 4)));
    }
    chart.add(group)
}

fn honesty(rows: &[ValidationRow], runs: &[(String, RunResults)]) -> Markup {
    let curve = |row: &ValidationRow| {
        let records = runs.iter().flat_map(|(_, results)| &results.records);
        reliability(records.filter(|record| record.row == row.row))
    };
    html! { section {
        h2 { "Are the probabilities honest?" }
        p.note {
            "Of all worlds: bins of equally many answers by rising probability, with 95 % Wilson intervals; on the dashed line what is "
            "stated comes true."
        }
        div.panels { @for (series, row) in rows.iter().enumerate() {
            @let bins = curve(row);
            @if !bins.is_empty() { figure { figcaption { (key(series)) (row.row) } (inline(&reliability_chart(series, &bins))) } }
        } }
    } }
}

fn provenance(runs: &[(String, RunResults)], folder: &str) -> Markup {
    html! { section {
        h2 { "Where this comes from" }
        p.note { "Each world has its run in a folder of its own, with its report; any trial of it can be watched again." }
        @if let Some((world, first)) = runs.first() {
            pre { "edgeloc replay " (folder) "/" (world) " --trial 0" }
            dl {
                dt { "program" } dd { "edgeloc " (first.manifest.program_version) @if let Some(commit) = &first.manifest.git_commit { ", commit " (commit) } }
                dt { "command" } dd { code { (first.manifest.command.join(" ")) } }
                dt { "machine" } dd { (first.manifest.host.processor.as_deref().unwrap_or("unnamed processor")) ", " @if let Some(instructions) = &first.manifest.host.instructions { (instructions) ", " } (first.manifest.host.used_threads) " threads" }
                dt { "seed" } dd { (first.manifest.seed) }
            }
            details { summary { "scenario.toml of the first world" } pre { (first.scenario.to_toml()) } }
        }
    } }
}

fn key(series: usize) -> Markup {
    html! { span class={ "key k" (series % SERIES_COUNT) } {} }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::validation;
    use crate::report::validation::tests::two_worlds;

    #[test]
    fn the_page_names_every_world_and_row_and_needs_nothing_else() {
        let runs = two_worlds();
        let page = validation_page(&validation(&runs), &runs, "runs/x");
        for part in
            ["office-1", "hall", "anywhere, no polarity", "Donner", "edgeloc replay runs/x/office-1", "false accepts"]
        {
            assert!(page.contains(part), "the page lacks {part:?}");
        }
        assert!(!page.contains("<script") && !page.contains("src=") && !page.contains("NaN"));
    }
}

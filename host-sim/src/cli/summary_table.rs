//! The figures of a run as a table for people, beside the paper's and chance.

use super::console;
use comfy_table::{CellAlignment, Table};
use edgeloc_sim::report::{AnswerFigures, RunResults, Share, replay_command, worst_trials};
use edgeloc_sim::scenario::first_alike;

/// Maps told of in a few lines; a study of many is read from its summary.
const LISTED_MAPS: usize = 3;

/// The headline table of a run.
pub(super) fn headline(results: &RunResults) -> Table {
    let mut table = console::table(&[
        "row",
        "success [95 % interval]",
        "trials",
        "looks",
        "ms a look",
        "can't tell",
        "to nearest node",
    ]);
    let summary = &results.summary;
    for row in &summary.rows {
        let timings = results.timings.rows.iter().find(|timings| timings.row == row.row);
        let errors = if row.errors > 0 { format!(" + {} errors", row.errors) } else { String::new() };
        table.add_row([
            row.row.clone(),
            interval(row.success_rate, (row.success_rate_low, row.success_rate_high)),
            row.trials.to_string(),
            format!("{:.2}", row.mean_looks),
            timings.map_or_else(String::new, |timings| format!("{:.1}", 1e3 * timings.mean_s_per_look)),
            format!("{}{errors}", row.unknown),
            format!("{:.2} m", row.mean_nearest_node_distance_m),
        ]);
    }
    table.add_row(["the paper, simulated", &interval(Some(summary.paper_rate), summary.paper_interval), "> 900"]);
    for (index, row) in summary.rows.iter().enumerate() {
        if summary.rows[..index].iter().all(|other| other.nodes != row.nodes) {
            let chance = format!("{:.1} %", 100.0 * row.chance_rate);
            let of_nodes = match row.nodes {
                1 => "the only node".to_owned(),
                2 => "both nodes".to_owned(),
                nodes => format!("2 of {nodes} nodes"),
            };
            table.add_row([format!("chance, {of_nodes}"), chance, String::new()]);
        }
    }
    for column in 2..=6 {
        if let Some(column) = table.column_mut(column) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}

/// What the answers of each row are worth.
pub(super) fn answers(results: &RunResults) -> Table {
    let mut table = console::table(&[
        "row",
        "answered",
        "false accepts [95 % interval]",
        "right or named",
        "position error 50/95/99 %",
        "heading",
        "near ties",
    ]);
    for row in &results.summary.rows {
        let answers = &row.answers;
        let rate = |share: &Share| share.rate.map_or_else(String::new, |rate| format!("{:.1} %", 100.0 * rate));
        table.add_row([
            row.row.clone(),
            rate(&answers.coverage),
            share(&answers.false_accepts),
            rate(&answers.truth_named),
            position_errors(answers),
            answers.heading_error_median_deg.map_or_else(String::new, |error| format!("{error:.2} deg")),
            answers.near_ties.to_string(),
        ]);
    }
    for column in [1, 3, 4, 5, 6] {
        if let Some(column) = table.column_mut(column) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}

/// A small share with its interval.
pub(super) fn share(share: &Share) -> String {
    share.rate.map_or_else(
        || "no answers".to_owned(),
        |rate| format!("{:.2} % [{:.2}, {:.2}]", 100.0 * rate, 100.0 * share.low, 100.0 * share.high),
    )
}

/// Median, 95 % and 99 % of the position error.
pub(super) fn position_errors(answers: &AnswerFigures) -> String {
    match (answers.pose_error_median_m, answers.pose_error_95_m, answers.pose_error_99_m) {
        (Some(median), Some(most), Some(nearly_all)) => {
            format!("{:.1}/{:.1}/{:.1} cm", 100.0 * median, 100.0 * most, 100.0 * nearly_all)
        }
        _ => String::new(),
    }
}

/// Map, time and what is slow, in a few lines.
pub(super) fn remarks(results: &RunResults) -> String {
    let (summary, timings) = (&results.summary, &results.timings);
    // Rows that are alike were run once.
    let first_alike = results.scenario.settings().map(|settings| first_alike(&settings)).unwrap_or_default();
    let was_run = |row: usize| first_alike.get(row).is_none_or(|&first| first == row);
    let rows = timings.rows.iter().zip(&summary.rows).enumerate().filter(|(row, _)| was_run(*row));
    let localizer_s =
        rows.map(|(_, (timings, row))| timings.mean_s_per_look * row.mean_looks * row.trials as f64).sum::<f64>()
            / results.manifest.host.used_threads.max(1) as f64;
    let mut maps = String::new();
    for (index, row) in summary.rows.iter().enumerate() {
        if summary.rows[..index].iter().all(|other| other.map != row.map) && maps.lines().count() < LISTED_MAPS {
            let (nodes, map) = (console::count(row.nodes as u64, "node"), &row.map);
            maps.push_str(&format!(
                "map: {nodes}, one for each {:.1} m2 of free space; {:.0} segments a node, {:.0} kB\n",
                map.free_m2_per_node,
                map.mean_segments_per_node,
                map.mean_bytes / 1e3,
            ));
        }
    }
    let threads = console::count(results.manifest.host.used_threads as u64, "thread");
    let is_trivial = summary.rows.iter().any(|row| row.nodes <= 2);
    let trivial = if is_trivial { "\nwith no more than two nodes every answer is right: chance is 100 %" } else { "" };
    format!(
        "ms a look: mean wall time of the localiser alone, on one thread\n\
         {maps}time: {:.1} s; {:.1} s to prepare, {:.1} s for trials, of which the localiser took {localizer_s:.1} s ({threads}){trivial}",
        timings.total_s(),
        timings.prepare_s,
        timings.trials_s,
    )
}

/// The command that replays the worst trial, if any failed.
pub(super) fn worst_replay(results: &RunResults, folder: &str) -> Option<String> {
    worst_trials(&results.records, 1).first().map(|record| replay_command(record, folder))
}

fn interval(rate: Option<f64>, (low, high): (f64, f64)) -> String {
    rate.map_or_else(
        || "no trials".to_owned(),
        |rate| format!("{:.1} % [{:.1}, {:.1}]", 100.0 * rate, 100.0 * low, 100.0 * high),
    )
}

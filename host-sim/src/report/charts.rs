//! The charts of a run: success against distance to the nearest node, and looks.

use super::ReliabilityBin;
use super::axes::Axes;
use super::drawing::{SERIES_COUNT, drawing, line, percent, text, tidy, tooltip};
use super::summary::PAPER_RATE;
use crate::monte_carlo::{SuccessRate, TrialRecord};
use crate::scenario::Row;
use svg::Node;
use svg::node::element::{Circle, Group, Path, Rectangle, SVG};

/// Borders of the distance bins in metres; finer where near starts lie, and open at the end.
const DISTANCE_BORDERS_M: [f64; 13] = [0.0, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.25, 1.5, 2.0, 3.0, f64::INFINITY];
/// Bins of fewer trials say nothing and are left out.
const MIN_TRIALS_PER_BIN: u64 = 5;

/// Success against distance to the nearest node, binned, one series a row with 95 % intervals.
#[must_use]
pub fn success_by_distance(rows: &[Row], records: &[TrialRecord]) -> SVG {
    let axes = Axes { left: 52.0, top: 14.0, width: 830.0, height: 270.0 };
    let bins = shown_bins(rows, records);
    let slot = 1.0 / bins as f64;
    let mut chart = drawing(900.0, 348.0).add(axes.rates_grid());
    chart.append(
        line("guide", (axes.x(0.0), axes.y(PAPER_RATE)), (axes.x(1.0), axes.y(PAPER_RATE)))
            .add(tooltip(format!("the paper: {}", percent(PAPER_RATE)))),
    );
    for bin in 0..bins {
        let label = bin_label(bin, " – ");
        let middle = axes.x((bin as f64 + 0.5) * slot);
        chart.append(text("middle", (middle, axes.y(0.0) + 20.0), label));
        if bin > 0 {
            chart.append(line(
                "grid",
                (axes.x(bin as f64 * slot), axes.y(0.0)),
                (axes.x(bin as f64 * slot), axes.y(1.0)),
            ));
        }
    }
    for (series, row) in rows.iter().enumerate() {
        // Side by side within the bin, so that intervals do not cover each other.
        let shift = (series as f64 + 1.0) / (rows.len() as f64 + 1.0);
        chart.append(distance_series(series, row, records, |bin| axes.x((bin as f64 + shift) * slot), &axes, bins));
    }
    let caption = "distance from the true position to the nearest node [m]";
    chart.add(line("axis", (axes.x(0.0), axes.y(0.0)), (axes.x(1.0), axes.y(0.0)))).add(text(
        "middle",
        (axes.x(0.5), axes.y(0.0) + 46.0),
        caption,
    ))
}

/// Bins up to the last one in which a row has trials enough.
fn shown_bins(rows: &[Row], records: &[TrialRecord]) -> usize {
    let has_enough =
        |bin: &usize| rows.iter().any(|row| success_in_bin(row, records, *bin).trials >= MIN_TRIALS_PER_BIN);
    (0..DISTANCE_BORDERS_M.len() - 1).rfind(has_enough).unwrap_or(2) + 1
}

/// The distances of a bin in metres: from, `joint`, to.
fn bin_label(bin: usize, joint: &str) -> String {
    let (from, to) = (DISTANCE_BORDERS_M[bin], DISTANCE_BORDERS_M[bin + 1]);
    if to.is_finite() { format!("{from}{joint}{to}") } else { format!("over {from}") }
}

fn success_in_bin(row: &Row, records: &[TrialRecord], bin: usize) -> SuccessRate {
    let range = DISTANCE_BORDERS_M[bin]..DISTANCE_BORDERS_M[bin + 1];
    let in_bin = |record: &&TrialRecord| range.contains(&f64::from(record.nearest_node_distance_m));
    SuccessRate::of(
        records.iter().filter(|record| record.row == row.name).filter(in_bin).map(|record| record.is_success),
    )
}

fn distance_series(
    series: usize,
    row: &Row,
    records: &[TrialRecord],
    x_of: impl Fn(usize) -> f64,
    axes: &Axes,
    bins: usize,
) -> Group {
    let mut group = Group::new().set("class", format!("series{}", series % SERIES_COUNT));
    let mut trace = String::new();
    let mut marks = Vec::new();
    for bin in 0..bins {
        let success = success_in_bin(row, records, bin);
        let Some(rate) = success.rate().filter(|_| success.trials >= MIN_TRIALS_PER_BIN) else { continue };
        let (low, high) = success.success_interval();
        let (x, y) = (x_of(bin), axes.y(rate));
        trace.push_str(&format!("{}{x} {y}", if trace.is_empty() { "M" } else { "L" }));
        marks.push(
            Group::new()
                .add(tooltip(format!("{}, {} m: {success}", row.name, bin_label(bin, " to "))))
                .add(line("whisker", (x, axes.y(low)), (x, axes.y(high))))
                .add(Circle::new().set("class", "dot").set("cx", x).set("cy", y).set("r", 4)),
        );
    }
    group.append(Path::new().set("class", "trace").set("d", trace));
    for mark in marks {
        group.append(mark);
    }
    group
}

/// How many looks the trials of a row took, successes below failures.
#[must_use]
pub fn looks_histogram(row: &Row, records: &[TrialRecord], max_looks: u16) -> SVG {
    let axes = Axes { left: 40.0, top: 26.0, width: 400.0, height: 120.0 };
    let bars = usize::from(max_looks).clamp(1, 24);
    let mut counts = vec![(0_u32, 0_u32); bars];
    for record in records.iter().filter(|record| record.row == row.name) {
        let bar = &mut counts[(record.looks.max(1) as usize - 1).min(bars - 1)];
        if record.is_success { bar.0 += 1 } else { bar.1 += 1 }
    }
    let most = counts.iter().map(|(good, bad)| good + bad).max().unwrap_or(0);
    let most = round_up(most);
    let slot = 1.0 / bars as f64;
    let mut chart =
        drawing(450.0, 190.0).add(text("start", (axes.left, 14.0), row.name.as_str()).set("class", "title"));
    for share in [0.0, 0.5, 1.0] {
        let count = f64::from(most) * share;
        chart.append(line("grid", (axes.x(0.0), axes.y(share)), (axes.x(1.0), axes.y(share))));
        chart.append(text("end", (axes.left - 6.0, axes.y(share) + 4.0), count.to_string()));
    }
    for (index, &(good, bad)) in counts.iter().enumerate() {
        let (x, width) = (axes.x((index as f64 + 0.14) * slot), tidy(0.72 * slot * axes.width));
        let looks = if index + 1 == bars && bars < usize::from(max_looks) {
            format!("{} or more looks", index + 1)
        } else {
            format!("{} look{}", index + 1, if index == 0 { "" } else { "s" })
        };
        let share = |count: u32| f64::from(count) / f64::from(most);
        let mut group = Group::new().add(tooltip(format!("{looks}: {good} right, {bad} not")));
        for (class, from, to) in [("bar-good", 0, good), ("bar-bad", good, good + bad)] {
            if to > from {
                let (y, bottom) = (axes.y(share(to)), axes.y(share(from)));
                let bar = Rectangle::new().set("class", class).set("x", x).set("width", width);
                group.append(bar.set("y", y).set("height", tidy(bottom - y)));
            }
        }
        chart.append(group);
        chart.append(text(
            "middle",
            (axes.x((index as f64 + 0.5) * slot), axes.y(0.0) + 17.0),
            (index + 1).to_string(),
        ));
    }
    chart.add(text("middle", (axes.x(0.5), axes.y(0.0) + 36.0), "looks until the answer"))
}

/// The next even number with one leading digit, so that an axis and its half have round labels.
fn round_up(count: u32) -> u32 {
    let unit = 10_u32.pow(count.max(1).ilog10());
    let step = if unit == 1 { 2 } else { unit };
    count.max(1).div_ceil(step) * step
}

/// How often what answers state comes true: a dot with its interval for each bin of a reliability curve.
#[must_use]
pub fn reliability_chart(series: usize, bins: &[ReliabilityBin]) -> SVG {
    let axes = Axes { left: 52.0, top: 14.0, width: 300.0, height: 300.0 };
    // Beside few others it would be drawn as wide as the page.
    let mut chart = drawing(372.0, 362.0).set("style", "max-width:372px").add(axes.rates_grid());
    for tenths in [0.0, 0.2, 0.4, 0.6, 0.8, 1.0] {
        chart.append(text("middle", (axes.x(tenths), axes.y(0.0) + 18.0), format!("{:.0} %", 100.0 * tenths)));
    }
    chart.append(line("guide", (axes.x(0.0), axes.y(0.0)), (axes.x(1.0), axes.y(1.0))).add(tooltip("as stated")));
    let mut group = Group::new().set("class", format!("series{}", series % SERIES_COUNT));
    let mut trace = String::new();
    for bin in bins {
        let Some(rate) = bin.right.rate() else { continue };
        let (low, high) = bin.right.success_interval();
        let (x, y) = (axes.x(bin.stated), axes.y(rate));
        trace.push_str(&format!("{}{x} {y}", if trace.is_empty() { "M" } else { "L" }));
        let label = format!("stated {}, came true {}", percent(bin.stated), bin.right);
        let mark = Group::new().add(tooltip(label)).add(line("whisker", (x, axes.y(low)), (x, axes.y(high))));
        group.append(mark.add(Circle::new().set("class", "dot").set("cx", x).set("cy", y).set("r", 4)));
    }
    chart.append(group.add(Path::new().set("class", "trace").set("d", trace)));
    chart.add(line("axis", (axes.x(0.0), axes.y(0.0)), (axes.x(1.0), axes.y(0.0)))).add(text(
        "middle",
        (axes.x(0.5), axes.y(0.0) + 40.0),
        "probability stated; upwards: right",
    ))
}

/// A success rate as dot and interval on a line from 0 to 100 %, beside the paper's and chance.
#[must_use]
pub fn rate_strip(series: usize, success: SuccessRate, paper: Option<(f64, f64)>, chance_rate: f64) -> SVG {
    let axes = Axes { left: 6.0, top: 4.0, width: 248.0, height: 16.0 };
    let middle = axes.y(0.5);
    let mut strip = drawing(260.0, 24.0);
    if let Some((low, high)) = paper {
        let band = Rectangle::new().set("class", "guide-band").set("x", axes.x(low)).set("y", axes.top);
        let label = format!("the paper: {} [{:.1}, {:.1}]", percent(PAPER_RATE), 100.0 * low, 100.0 * high);
        strip.append(
            band.set("width", tidy((high - low) * axes.width)).set("height", axes.height).add(tooltip(label.clone())),
        );
        let guide = line("guide", (axes.x(PAPER_RATE), axes.top), (axes.x(PAPER_RATE), axes.y(0.0)));
        strip.append(guide.add(tooltip(label)));
    }
    let chance = line("chance", (axes.x(chance_rate), axes.top), (axes.x(chance_rate), axes.y(0.0)));
    strip.append(line("grid", (axes.x(0.0), middle), (axes.x(1.0), middle)));
    strip.append(chance.add(tooltip(format!("chance: {}", percent(chance_rate)))));
    if let Some(rate) = success.rate() {
        let (low, high) = success.success_interval();
        strip.append(
            Group::new()
                .set("class", format!("series{}", series % SERIES_COUNT))
                .add(tooltip(success.to_string()))
                .add(line("whisker", (axes.x(low), middle), (axes.x(high), middle)))
                .add(Circle::new().set("class", "dot").set("cx", axes.x(rate)).set("cy", middle).set("r", 5)),
        );
    }
    strip
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    #[test]
    fn every_trial_counts_in_the_looks_histogram() {
        let results = sample::run().results;
        let chart = looks_histogram(&results.scenario.rows[0], &results.records, 12).to_string();
        assert!(chart.contains("1 look: ") && chart.contains("2 looks: "));
        let numbers = chart
            .split(" right, ")
            .map_while(|before| before.rsplit_once(": "))
            .zip(chart.split(" right, ").skip(1).map(|after| after.split_once(" not").expect("a tooltip").0));
        let numbers = numbers
            .map(|((_, good), bad)| good.parse::<u32>().expect("a count") + bad.parse::<u32>().expect("a count"));
        assert_eq!(numbers.sum::<u32>(), results.scenario.trials);
    }

    #[test]
    fn trials_far_from_every_node_stand_in_the_open_last_bin() {
        let results = sample::run().results;
        let mut records = results.records.clone();
        for record in &mut records {
            record.nearest_node_distance_m = 7.5;
        }
        let chart = success_by_distance(&results.scenario.rows, &records).to_string();
        assert!(chart.contains("over 3") && chart.contains(&format!("{}, over 3 m: ", results.scenario.rows[0].name)));
    }

    #[test]
    fn axes_end_at_round_numbers() {
        assert_eq!([0, 1, 7, 13, 20, 287].map(round_up), [2, 2, 8, 20, 20, 300]);
    }

    #[test]
    fn charts_of_no_trials_are_empty_not_broken() {
        let rows = crate::scenario::Scenario::default().rows;
        for chart in [success_by_distance(&rows, &[]), looks_histogram(&rows[0], &[], 12)] {
            assert!(!chart.to_string().contains("NaN"));
        }
    }
}

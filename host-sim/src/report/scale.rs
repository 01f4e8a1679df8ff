//! How a localiser fares in maps of ever more nodes: a line a size, as a table and as a chart.

use super::axes::{Axes, round_steps};
use super::drawing::{drawing, line, text, tooltip};
use super::figure_chart::rate_steps;
use crate::monte_carlo::{CampusRecord, ExactScan, SuccessRate};
use serde::Serialize;
use std::time::Duration;
use svg::Node;
use svg::node::element::{Circle, Group, Path, SVG};

/// What was measured in a map of one size.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScaleLine {
    /// Nodes of the map.
    pub nodes: u64,
    /// Nodes that were scored at a time.
    pub scored_nodes: u64,
    /// Robots put down.
    pub trials: u64,
    /// One of the two nearest nodes was answered.
    pub successes: u64,
    /// Lower end of the 95 % interval of the success rate.
    pub success_rate_low: f64,
    /// Upper end.
    pub success_rate_high: f64,
    /// Another node was answered.
    pub wrong_answers: u64,
    /// One of the two nearest nodes was scored at the first look.
    pub shortlisted_at_first: u64,
    /// The same at the last look.
    pub shortlisted_at_last: u64,
    /// Robots for whom every node was scored at the first look, if that was asked for.
    pub exact_trials: u64,
    /// Of these, robots for whom one of the two nearest nodes then scored best.
    pub exact_right: u64,
    /// And of these, robots for whom that node was on the shortlist.
    pub exact_right_shortlisted: u64,
    /// Mean number of looks.
    pub mean_looks: f64,
    /// Least time of the localiser for the first look, on one thread.
    pub first_look_ms_min: f64,
    /// Median of it.
    pub first_look_ms_median: f64,
    /// Median over later looks; 0 when there were none.
    pub later_look_ms_median: f64,
    /// Least time of the first stage for a look, gist and scan.
    pub first_stage_ms_min: f64,
    /// Median of it.
    pub first_stage_ms_median: f64,
    /// Median position error of the answers in meters; 0 without answers.
    pub position_error_m_median: f64,
    /// Size of the map file.
    pub map_bytes: u64,
    /// Working memory of the localiser.
    pub memory_bytes: u64,
    /// Checking and opening the map.
    pub open_ms: f64,
}

/// What was measured beside the trials.
#[derive(Debug, Clone, Default)]
pub struct ScaleFacts {
    /// Nodes of the map.
    pub nodes: u64,
    /// Nodes scored at a time.
    pub scored_nodes: u64,
    /// Size of the map file.
    pub map_bytes: u64,
    /// Working memory of the localiser.
    pub memory_bytes: u64,
    /// Checking and opening the map.
    pub open: Duration,
    /// Time of the first stage, for each robot's first look.
    pub first_stage: Vec<Duration>,
    /// What scoring every node at the first look found, for each robot that was asked and saw enough.
    pub exact: Vec<ExactScan>,
}

impl ScaleLine {
    /// Counts the trials in one map.
    #[must_use]
    pub fn of(facts: &ScaleFacts, records: &[CampusRecord]) -> Self {
        let count = |of: &dyn Fn(&CampusRecord) -> bool| records.iter().filter(|record| of(record)).count() as u64;
        let success = SuccessRate::of(records.iter().map(|record| record.is_success));
        let (success_rate_low, success_rate_high) = success.success_interval();
        let ms = |times: &mut dyn Iterator<Item = Duration>| sorted(&mut times.map(|time| 1e3 * time.as_secs_f64()));
        let first = ms(&mut records.iter().filter_map(|record| record.look_times.first().copied()));
        let later = ms(&mut records.iter().flat_map(|record| record.look_times.iter().skip(1).copied()));
        let first_stage = ms(&mut facts.first_stage.iter().copied());
        let errors = sorted(&mut records.iter().filter_map(|record| record.position_error_m).map(f64::from));
        let looks: usize = records.iter().map(|record| record.look_times.len()).sum();
        Self {
            nodes: facts.nodes,
            scored_nodes: facts.scored_nodes,
            trials: success.trials,
            successes: success.successes,
            success_rate_low,
            success_rate_high,
            wrong_answers: count(&|record| record.is_answered && !record.is_success),
            shortlisted_at_first: count(&|record| record.is_shortlisted[0]),
            shortlisted_at_last: count(&|record| record.is_shortlisted[1]),
            exact_trials: facts.exact.len() as u64,
            exact_right: facts.exact.iter().filter(|scan| scan.is_right).count() as u64,
            exact_right_shortlisted: facts.exact.iter().filter(|scan| scan.is_right && scan.is_shortlisted).count()
                as u64,
            mean_looks: looks as f64 / records.len().max(1) as f64,
            first_look_ms_min: first.first().copied().unwrap_or(0.0),
            first_look_ms_median: median(&first),
            later_look_ms_median: median(&later),
            first_stage_ms_min: first_stage.first().copied().unwrap_or(0.0),
            first_stage_ms_median: median(&first_stage),
            position_error_m_median: median(&errors),
            map_bytes: facts.map_bytes,
            memory_bytes: facts.memory_bytes,
            open_ms: 1e3 * facts.open.as_secs_f64(),
        }
    }

    /// The success rate.
    #[must_use]
    pub const fn success(&self) -> SuccessRate {
        SuccessRate { successes: self.successes, trials: self.trials }
    }

    /// Robots with one of the two nearest nodes on the shortlist of the first look, and of the last.
    #[must_use]
    pub fn shortlisted(&self) -> [SuccessRate; 2] {
        let of = |successes| SuccessRate { successes, trials: self.trials };
        [of(self.shortlisted_at_first), of(self.shortlisted_at_last)]
    }

    /// How often an exact scan of the first look is right, and how often the shortlist holds what it is right about.
    #[must_use]
    pub const fn exact(&self) -> [SuccessRate; 2] {
        [
            SuccessRate { successes: self.exact_right, trials: self.exact_trials },
            SuccessRate { successes: self.exact_right_shortlisted, trials: self.exact_right },
        ]
    }
}

fn sorted(values: &mut dyn Iterator<Item = f64>) -> Vec<f64> {
    let mut values = values.collect::<Vec<_>>();
    values.sort_by(f64::total_cmp);
    values
}

fn median(sorted: &[f64]) -> f64 {
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}

/// The lines as CSV.
///
/// # Errors
/// When they can't be written as such, which a program error alone can cause.
pub fn scale_csv(lines: &[ScaleLine]) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for line in lines {
        writer.serialize(line)?;
    }
    let bytes = writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Rates, times of a look and memory, one above the other, over the number of nodes on a logarithmic axis.
#[must_use]
pub fn scale_chart(lines: &[ScaleLine]) -> SVG {
    let rates = Axes { left: 62.0, top: 30.0, width: 560.0, height: 210.0 };
    let times = Axes { left: 62.0, top: 300.0, width: 560.0, height: 130.0 };
    let sizes = Axes { left: 62.0, top: 490.0, width: 560.0, height: 110.0 };
    let decade = |count: u64| libm::log10(count.max(1) as f64);
    let least = libm::floor(lines.iter().map(|line| decade(line.nodes)).fold(2.0, f64::min));
    let most = libm::ceil(lines.iter().map(|line| decade(line.nodes)).fold(least + 1.0, f64::max) - 0.01);
    let x = |nodes: u64| rates.x((decade(nodes) - least) / (most - least));
    let lows = lines.iter().flat_map(|line| {
        [line.success().success_interval().0]
            .into_iter()
            .chain(line.shortlisted().map(|rate| rate.success_interval().0))
    });
    let floor = (libm::floor(10.0 * lows.fold(0.9, f64::min)) / 10.0).max(0.0);
    let height = move |rate: f64| (rate - floor) / (1.0 - floor);
    let slowest = lines.iter().map(|line| line.first_look_ms_median.max(line.later_look_ms_median)).fold(0.0, f64::max);
    let steps = round_steps(slowest);
    let top_ms = steps.last().copied().unwrap_or(1.0);

    // Memory in powers of ten, from below the least to above the greatest.
    let bytes = || lines.iter().flat_map(|line| [line.map_bytes, line.memory_bytes]).map(decade);
    let least_bytes = libm::floor(bytes().fold(6.0, f64::min));
    let most_bytes = libm::ceil(bytes().fold(least_bytes + 1.0, f64::max));
    let size_height = move |bytes: f64| (libm::log10(bytes) - least_bytes) / (most_bytes - least_bytes);
    let powers: Vec<f64> =
        (least_bytes as i32..=most_bytes as i32).map(|power| libm::exp10(f64::from(power))).collect();
    let in_words = |bytes: f64| if bytes < 1e9 { format!("{} MB", bytes / 1e6) } else { format!("{} GB", bytes / 1e9) };

    let mut chart = drawing(700.0, 660.0)
        .add(rates.grid(&rate_steps(floor), |rate| format!("{:.0} %", 100.0 * rate), height))
        .add(times.grid(&steps, |ms| format!("{ms} ms"), |ms| ms / top_ms))
        .add(sizes.grid(&powers, in_words, size_height));
    for axes in [&rates, &times, &sizes] {
        chart.append(line("axis", (axes.x(0.0), axes.y(0.0)), (axes.x(1.0), axes.y(0.0))));
    }
    for power in (least as i32)..=(most as i32) {
        let at = sizes.x((f64::from(power) - least) / (most - least));
        chart.append(text("middle", (at, sizes.y(0.0) + 20.0), grouped(10_u64.pow(power.unsigned_abs()))));
    }
    chart.append(text("middle", (sizes.x(0.5), sizes.y(0.0) + 44.0), "nodes of the map"));
    let rate_series: [Series<SuccessRate>; 3] = [
        ("success", ScaleLine::success),
        ("truth on the shortlist at the last look", |line| line.shortlisted()[1]),
        ("at the first look", |line| line.shortlisted()[0]),
    ];
    for (series, (name, rate_of)) in rate_series.into_iter().enumerate() {
        let marks = lines.iter().filter_map(|line| {
            let rate = rate_of(line);
            let (low, high) = rate.success_interval();
            let words = format!("{name}, {} nodes: {rate}", line.nodes);
            Some((
                x(line.nodes),
                rates.y(height(rate.rate()?)),
                Some((rates.y(height(low)), rates.y(height(high)))),
                words,
            ))
        });
        let label_at = (rates.x([0.02, 0.18, 0.68][series]), 18.0);
        chart.append(trace(series, name, label_at, marks.collect()));
    }
    let time_series: [Series<f64>; 3] = [
        ("first look, median", |line| line.first_look_ms_median),
        ("later looks", |line| line.later_look_ms_median),
        ("first stage", |line| line.first_stage_ms_median),
    ];
    for (series, (name, ms_of)) in time_series.into_iter().enumerate() {
        let marks = lines.iter().map(|line| {
            let words = format!("{name}, {} nodes: {:.1} ms", line.nodes, ms_of(line));
            (x(line.nodes), times.y(ms_of(line) / top_ms), None, words)
        });
        chart.append(trace(series + 3, name, (times.x(0.02 + 0.28 * series as f64), 288.0), marks.collect()));
    }
    let size_series: [Series<u64>; 2] =
        [("map", |line| line.map_bytes), ("working memory of the localiser", |line| line.memory_bytes)];
    for (series, (name, bytes_of)) in size_series.into_iter().enumerate() {
        let marks = lines.iter().map(|line| {
            let words = format!("{name}, {} nodes: {:.2} MB", line.nodes, bytes_of(line) as f64 / 1e6);
            (x(line.nodes), sizes.y(size_height(bytes_of(line).max(1) as f64)), None, words)
        });
        chart.append(trace(series, name, (sizes.x(0.02 + 0.28 * series as f64), 478.0), marks.collect()));
    }
    chart
}

/// A name, and what it is of a line.
type Series<T> = (&'static str, fn(&ScaleLine) -> T);

/// A mark: where it is, where its interval lies, and its tooltip.
type Mark = (f64, f64, Option<(f64, f64)>, String);

/// Marks joined by a line, and what they are.
fn trace(series: usize, name: &str, label_at: (f64, f64), marks: Vec<Mark>) -> Group {
    let mut group = Group::new().set("class", format!("series{series}"));
    let mut way = String::new();
    for (x, y, ..) in &marks {
        way.push_str(&format!("{}{x} {y}", if way.is_empty() { "M" } else { "L" }));
    }
    group.append(Path::new().set("class", "trace").set("d", way));
    for (x, y, interval, words) in marks {
        let mut mark = Group::new().add(tooltip(words));
        if let Some((low, high)) = interval {
            mark.append(line("whisker", (x, low), (x, high)));
        }
        group.append(mark.add(Circle::new().set("class", "dot").set("cx", x).set("cy", y).set("r", 4)));
    }
    let (x, y) = label_at;
    group.append(Circle::new().set("class", "dot").set("cx", x).set("cy", y - 4.0).set("r", 4));
    group.add(text("start", (x + 8.0, y), name))
}

/// A number with its thousands apart.
fn grouped(number: u64) -> String {
    if number < 1000 { number.to_string() } else { format!("{},{:03}", grouped(number / 1000), number % 1000) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines() -> Vec<ScaleLine> {
        let record = |is_success, is_first| CampusRecord {
            is_success,
            is_answered: true,
            position_error_m: Some(0.02),
            is_shortlisted: [is_first, true],
            look_times: vec![Duration::from_millis(40), Duration::from_millis(60)],
        };
        let records = [record(true, true), record(true, false), record(false, false), record(true, true)];
        let of = |nodes| {
            let facts = ScaleFacts {
                nodes,
                map_bytes: 12_000 * nodes,
                memory_bytes: 250_000,
                exact: [[true, true], [true, false], [false, true]]
                    .map(|[is_right, is_shortlisted]| ExactScan { is_right, is_shortlisted })
                    .to_vec(),
                ..ScaleFacts::default()
            };
            ScaleLine::of(&facts, &records)
        };
        [72, 1008, 10_008, 100_008].map(of).to_vec()
    }

    #[test]
    fn trials_are_counted() {
        let line = &lines()[1];
        assert_eq!((line.trials, line.successes, line.wrong_answers), (4, 3, 1));
        assert_eq!((line.shortlisted_at_first, line.shortlisted_at_last), (2, 4));
        let [right, kept] = line.exact();
        assert_eq!((right.successes, right.trials, kept.successes, kept.trials), (2, 3, 1, 2));
        assert!((line.first_look_ms_median - 40.0).abs() < 1e-9 && (line.later_look_ms_median - 60.0).abs() < 1e-9);
    }

    #[test]
    fn every_size_has_its_line_and_its_marks() {
        let csv = scale_csv(&lines()).expect("plain numbers");
        assert!(csv.starts_with("nodes,scored_nodes,trials,successes") && csv.lines().count() == 5, "{csv}");
        let chart = scale_chart(&lines()).to_string();
        assert!(chart.contains("success, 100008 nodes: 75.0 %") && chart.contains("100,000"), "{chart}");
        assert!(chart.contains("map, 100008 nodes: 1200.10 MB") && chart.contains("100 MB"), "{chart}");
        assert!(!chart.contains("NaN") && !scale_chart(&[]).to_string().contains("NaN"));
    }
}

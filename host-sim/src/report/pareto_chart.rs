//! The front of a search: success against the time of a localisation, or against the size of the map.

use super::axes::{Axes, round_steps};
use super::drawing::{drawing, line, percent, text, tooltip};
use super::figure_chart::rate_steps;
use super::search_lines::SearchLine;
use svg::Node;
use svg::node::element::{Circle, Group, Path, SVG, Text};

/// A cost of a setting, for the axis to the right.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cost {
    /// Time of a localisation: its work in milliseconds, at the mean speed of all confirmed trials.
    Time,
    /// Size of the map.
    MapSize,
}

/// Success of every confirmed setting against a cost; a line joins those that no other beats in these two.
#[must_use]
pub fn pareto_chart(lines: &[SearchLine], cost: Cost) -> SVG {
    let confirmed = lines.iter().filter(|line| line.trials > 0).collect::<Vec<_>>();
    let ms_per_work = ms_per_work(&confirmed);
    let cost_of = |line: &SearchLine| match cost {
        Cost::Time => line.work * ms_per_work,
        Cost::MapSize => line.map_bytes / 1e3,
    };
    let axes = Axes { left: 62.0, top: 30.0, width: 500.0, height: 300.0 };
    let steps = round_steps(confirmed.iter().map(|line| cost_of(line)).fold(0.0, f64::max));
    let most = steps.last().copied().unwrap_or(1.0);
    let lowest = confirmed.iter().map(|line| line.success_rate_low).fold(0.9, f64::min);
    let floor = (libm::floor(10.0 * lowest) / 10.0).max(0.0);
    let height = |rate: f64| ((rate - floor) / (1.0 - floor)).max(0.0);
    let rates = rate_steps(floor);

    let mut chart = drawing(590.0, 384.0).add(axes.grid(&rates, |rate| format!("{:.0} %", 100.0 * rate), height));
    for step in &steps {
        chart.append(text("middle", (axes.x(step / most), axes.y(0.0) + 20.0), format!("{step}")));
    }
    chart.append(line("axis", (axes.x(0.0), axes.y(0.0)), (axes.x(1.0), axes.y(0.0))));
    let caption = match cost {
        Cost::Time => "time of a localisation [ms]",
        Cost::MapSize => "size of the map [kB]",
    };
    chart.append(text("middle", (axes.x(0.5), axes.y(0.0) + 44.0), caption));

    let mut by_cost = confirmed.clone();
    by_cost.sort_by(|a, b| {
        cost_of(a).total_cmp(&cost_of(b)).then(b.success_rate.unwrap_or(0.0).total_cmp(&a.success_rate.unwrap_or(0.0)))
    });
    let (mut trace, mut best) = (String::new(), -1.0);
    for line in by_cost {
        let rate = line.success_rate.unwrap_or(0.0);
        if rate > best {
            best = rate;
            let command = if trace.is_empty() { "M" } else { "L" };
            trace.push_str(&format!("{command}{} {}", axes.x(cost_of(line) / most), axes.y(height(rate))));
        }
    }
    chart.append(Group::new().set("class", "series0").add(Path::new().set("class", "trace").set("d", trace)));
    let x_of = |line: &SearchLine| axes.x(cost_of(line) / most);
    for line in &confirmed {
        chart.append(mark(line, x_of(line), &axes, height));
    }
    // Over all marks and lines.
    confirmed.iter().filter_map(|line| label(line, x_of(line), &axes, height)).for_each(|label| chart.append(label));
    chart
}

fn mark(of: &SearchLine, x: f64, axes: &Axes, height: impl Fn(f64) -> f64) -> Group {
    let y = axes.y(height(of.success_rate.unwrap_or(0.0)));
    let series = if of.is_on_front { "series0" } else { "series5" };
    let whisker = line("whisker", (x, axes.y(height(of.success_rate_low))), (x, axes.y(height(of.success_rate_high))));
    let dot = Circle::new().set("class", "dot").set("cx", x).set("cy", y).set("r", 4.5);
    let words = format!(
        "setting {}: {}, {:.1} ms, {:.0} kB",
        of.setting,
        of.success(),
        1e3 * of.mean_localizer_s,
        of.map_bytes / 1e3
    );
    let mut group = Group::new().set("class", series).add(tooltip(words)).add(whisker).add(dot);
    if of.is_chosen {
        group.append(Circle::new().set("class", "truth").set("cx", x).set("cy", y).set("r", 9));
    }
    group
}

/// What the scenario as given and the chosen setting are called.
fn label(of: &SearchLine, x: f64, axes: &Axes, height: impl Fn(f64) -> f64) -> Option<Text> {
    let rate = of.success_rate.unwrap_or(0.0);
    let (name, y) = match (of.setting, of.is_chosen) {
        (0, _) => ("origin", axes.y(height(rate)) + 15.0),
        (_, true) => ("chosen", axes.y(height(rate)) - 9.0),
        _ => return None,
    };
    // Towards the middle, where there is room; the two labels on different sides, for the marks may coincide.
    let (anchor, aside) = if x < axes.x(0.5) { ("start", 11.0) } else { ("end", -11.0) };
    Some(text(anchor, (x + aside, y), format!("{name} {}", percent(rate))).set("class", "label"))
}

/// Milliseconds for a unit of work, over all confirmed trials.
fn ms_per_work(confirmed: &[&SearchLine]) -> f64 {
    let sum =
        |value: fn(&SearchLine) -> f64| confirmed.iter().map(|line| value(line) * line.trials as f64).sum::<f64>();
    let work = sum(|line| line.work);
    if work > 0.0 { 1e3 * sum(|line| line.mean_localizer_s) / work } else { 0.0 }
}

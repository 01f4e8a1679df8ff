//! The chart of one figure of a study: success of each setting with its interval and the paper's value, and below it the
//! time of a localisation.

use super::axes::{Axes, round_steps};
use super::drawing::{SERIES_COUNT, drawing, line, percent, text, tidy, tooltip};
use super::figure_lines::FigureLine;
use crate::scenario::Start;
use svg::Node;
use svg::node::element::{Circle, Group, Path, Rectangle, SVG};

/// Width in px of the area inside the axes, whatever the number of settings.
const WIDTH_PX: f64 = 900.0;

/// The chart of the lines of one figure, its settings side by side in their order.
#[must_use]
pub fn figure_chart(lines: &[&FigureLine]) -> SVG {
    let mut settings: Vec<&str> = Vec::new();
    for line in lines {
        if !settings.contains(&line.setting.as_str()) {
            settings.push(&line.setting);
        }
    }
    let rates = Axes { left: 62.0, top: 14.0, width: WIDTH_PX, height: 210.0 };
    let times = Axes { left: 62.0, top: 262.0, width: WIDTH_PX, height: 70.0 };
    let floor = lowest_tenth(lines);
    let height = |rate: f64| (rate - floor) / (1.0 - floor);
    let steps = rate_steps(floor);
    let most_ms = lines.iter().map(|line| 1e3 * line.mean_localizer_s).fold(0.0, f64::max);
    let time_steps = round_steps(most_ms);
    let top_ms = time_steps.last().copied().unwrap_or(1.0);

    let mut chart = drawing(rates.left + WIDTH_PX + 16.0, 372.0);
    chart.append(rates.grid(&steps, |rate| format!("{:.0} %", 100.0 * rate), height));
    chart.append(times.grid(&[0.0, top_ms], |ms| ms.to_string(), |ms| ms / top_ms));
    chart.append(text("end", (times.left - 8.0, times.y(0.5) + 4.0), "ms"));
    for axes in [&rates, &times] {
        chart.append(line("axis", (axes.x(0.0), axes.y(0.0)), (axes.x(1.0), axes.y(0.0))));
    }
    let starts = [Start::Near, Start::Anywhere];
    for (index, setting) in settings.iter().enumerate() {
        let at = |share: f64| rates.x((index as f64 + share) / settings.len() as f64);
        chart.append(text("middle", (at(0.5), rates.y(0.0) + 20.0), *setting));
        let Some(claim) = lines.iter().find(|line| line.setting == *setting).and_then(|line| line.paper()) else {
            continue;
        };
        let y = rates.y(height(claim.success_rate.max(floor)));
        let label = format!("the paper: {}; {}", percent(claim.success_rate), claim.source);
        chart.append(Group::new().add(tooltip(label)).add(line("guide", (at(0.06), y), (at(0.94), y))).add(text(
            "end",
            (at(0.94), y - 5.0),
            format!("{:.2} %", 100.0 * claim.success_rate),
        )));
    }
    for (series, start) in starts.into_iter().enumerate() {
        // Side by side within the slot, so that intervals do not cover each other.
        let shift = if series == 0 { 0.3 } else { 0.45 };
        let x_of = |setting: &str| {
            let index = settings.iter().position(|known| *known == setting).unwrap_or(0);
            rates.x((index as f64 + shift) / settings.len() as f64)
        };
        let of_start = lines.iter().copied().filter(|line| line.start == start).collect::<Vec<_>>();
        let mut group = Group::new().set("class", format!("series{}", series % SERIES_COUNT));
        let mut trace = String::new();
        for line in &of_start {
            let Some(rate) = line.success_rate else { continue };
            trace.push_str(&format!(
                "{}{} {}",
                if trace.is_empty() { "M" } else { "L" },
                x_of(&line.setting),
                rates.y(height(rate))
            ));
        }
        group.append(Path::new().set("class", "trace").set("d", trace));
        for line in of_start {
            group.append(mark(line, x_of(&line.setting), &rates, height));
            group.append(time_bar(line, x_of(&line.setting), &times, top_ms));
        }
        chart.append(group);
    }
    chart.add(text("start", (times.left, times.y(0.0) + 22.0), "time of a localisation, all its looks together"))
}

fn mark(of: &FigureLine, x: f64, axes: &Axes, height: impl Fn(f64) -> f64) -> Group {
    let group = Group::new().add(tooltip(format!("{}: {}", of.row, of.success())));
    let Some(rate) = of.success_rate else { return group };
    let dot = Circle::new().set("class", "dot").set("cx", x).set("cy", axes.y(height(rate))).set("r", 4);
    let whisker =
        line("whisker", (x, axes.y(height(of.success_rate_low).max(0.0))), (x, axes.y(height(of.success_rate_high))));
    group.add(whisker).add(dot)
}

fn time_bar(of: &FigureLine, x: f64, axes: &Axes, top_ms: f64) -> Group {
    let ms = 1e3 * of.mean_localizer_s;
    let y = axes.y(ms / top_ms);
    let bar = Rectangle::new().set("class", "dot").set("x", tidy(x - 6.0)).set("width", 12).set("y", y);
    let label = format!("{}: {ms:.1} ms, {:.2} looks", of.row, of.mean_looks);
    Group::new().add(tooltip(label)).add(bar.set("height", tidy(axes.y(0.0) - y)))
}

/// Round rates from `floor`, a tenth, to 100 %: every 2, 5, 10 or 20 points.
pub(super) fn rate_steps(floor: f64) -> Vec<f64> {
    let points = libm::round(100.0 * (1.0 - floor)) as u32;
    let step = if points <= 10 {
        2
    } else if points <= 30 {
        5
    } else if points <= 60 {
        10
    } else {
        20
    };
    (0..=points / step).rev().map(|index| 1.0 - f64::from(index * step) / 100.0).collect()
}

/// The greatest tenth below every interval and every value of the paper, at most 90 %.
fn lowest_tenth(lines: &[&FigureLine]) -> f64 {
    let lows = lines.iter().filter(|line| line.trials > 0).map(|line| line.success_rate_low);
    let claims = lines.iter().filter_map(|line| line.paper()).map(|claim| claim.success_rate);
    let lowest = lows.chain(claims).fold(0.9, f64::min);
    (libm::floor(10.0 * lowest) / 10.0).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{figure_lines, sample};

    #[test]
    fn every_setting_and_regime_has_its_mark() {
        let results = sample::run().results;
        let lines = figure_lines(&results).expect("legal rows");
        let chart = figure_chart(&lines.iter().collect::<Vec<_>>()).to_string();
        for line in &lines {
            assert!(chart.contains(&format!("{}: {}", line.row, line.success())), "{}", line.row);
        }
        assert!(!chart.contains("NaN"));
        assert!(!figure_chart(&[]).to_string().contains("NaN"));
    }

    #[test]
    fn rates_are_round_and_end_at_one() {
        let count = |floor: f64| rate_steps(floor).len();
        assert_eq!([0.9, 0.8, 0.7, 0.5, 0.0].map(count), [6, 5, 7, 6, 6]);
        assert!(rate_steps(0.7).iter().all(|rate| (0.7 - 1e-9..=1.0).contains(rate)));
    }
}

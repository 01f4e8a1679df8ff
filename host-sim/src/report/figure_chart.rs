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

/// The two regimes stand this far apart, as a share of the slot of a setting.
const APART: f64 = 0.15;

/// The chart of the lines of one figure, its settings side by side in their order; a line joins neighbours that differ
/// by a number alone.
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
        chart.append(Group::new().add(tooltip(label)).add(line("guide", (at(0.01), y), (at(0.99), y))).add(text(
            "end",
            (at(1.0) + 8.0, y - 5.0),
            format!("{:.2} %", 100.0 * claim.success_rate),
        )));
    }
    // Side by side about the label where there are both, so that intervals do not cover each other.
    let is_alone = |setting: &str| {
        let mut starts = lines.iter().filter(|line| line.setting == setting).map(|line| line.start);
        let first = starts.next();
        starts.all(|start| Some(start) == first)
    };
    for (series, start) in starts.into_iter().enumerate() {
        let x_of = |setting: &str| {
            let shift = if is_alone(setting) { 0.5 } else { 0.5 + APART * (series as f64 - 0.5) };
            let index = settings.iter().position(|known| *known == setting).unwrap_or(0);
            rates.x((index as f64 + shift) / settings.len() as f64)
        };
        let of_start = lines.iter().copied().filter(|line| line.start == start).collect::<Vec<_>>();
        let mut group = Group::new().set("class", format!("series{}", series % SERIES_COUNT));
        let mut trace = String::new();
        for pair in of_start.windows(2).filter(|pair| is_next_on_scale(&pair[0].setting, &pair[1].setting)) {
            for (command, line) in ["M", "L"].into_iter().zip(pair) {
                let Some(rate) = line.success_rate else { continue };
                trace.push_str(&format!("{command}{} {}", x_of(&line.setting), rates.y(height(rate))));
            }
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

/// Whether a setting has the same words as the one before it and a greater number: `45 degrees`, `60 degrees`.
fn is_next_on_scale(before: &str, setting: &str) -> bool {
    let words_and_number = |setting: &str| {
        let start = setting.find(|c: char| c.is_ascii_digit())?;
        let length = setting[start..].find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(setting.len() - start);
        let (number, rest) = setting[start..].split_at(length);
        Some((format!("{}|{rest}", &setting[..start]), number.parse::<f64>().ok()?))
    };
    matches!((words_and_number(before), words_and_number(setting)), (Some(a), Some(b)) if a.0 == b.0 && a.1 < b.1)
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
    fn marks_stand_about_their_label_and_only_steps_of_a_scale_are_joined() {
        let results = sample::run().results;
        let line = figure_lines(&results).expect("legal rows").remove(0);
        let of = |setting: &str, start| FigureLine { setting: setting.to_owned(), start, ..line.clone() };
        let near = ["none", "psi_e 5 %", "psi_e 20 %", "psi_l 3 px"].map(|setting| of(setting, Start::Near));
        let anywhere = near.clone().map(|line| FigureLine { start: Start::Anywhere, ..line });
        let chart = |lines: &[&FigureLine]| figure_chart(lines).to_string();
        let alone = chart(&near.iter().collect::<Vec<_>>());
        // Slots of 225 px from 62 px on.
        for middle in [174.5, 399.5, 624.5, 849.5] {
            assert!(alone.contains(&format!("cx=\"{middle}\"")), "{middle}: {alone}");
        }
        assert_eq!(alone.matches("M399.5").count(), 1);
        assert!(!alone.contains("M174.5") && !alone.contains("M624.5"), "{alone}");
        // The first setting has both starts, the others are near alone.
        let both = chart(&near.iter().chain(&anywhere[..1]).collect::<Vec<_>>());
        let centers = both.split("cx=\"").skip(1).filter_map(|rest| rest.split('"').next()?.parse::<f64>().ok());
        let from_label = centers.map(|x| (x - 62.0).rem_euclid(225.0) - 112.5).collect::<Vec<_>>();
        let expected = [-16.875, 0.0, 0.0, 0.0, 16.875];
        assert_eq!(from_label.len(), expected.len());
        assert!(from_label.iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.01), "{from_label:?}");
    }

    #[test]
    fn a_scale_is_the_same_words_with_a_greater_number() {
        for (before, setting) in [("45 degrees", "60 degrees"), ("B_th 0", "B_th 0.025"), ("30 x 64", "60 x 64")] {
            assert!(is_next_on_scale(before, setting) && !is_next_on_scale(setting, before), "{before}, {setting}");
        }
        for (before, setting) in [("default", "10"), ("psi_e 5 %", "psi_l 6 px"), ("5 x 8", "30 x 64"), ("none", "x")] {
            assert!(!is_next_on_scale(before, setting), "{before}, {setting}");
        }
    }

    #[test]
    fn rates_are_round_and_end_at_one() {
        let count = |floor: f64| rate_steps(floor).len();
        assert_eq!([0.9, 0.8, 0.7, 0.5, 0.0].map(count), [6, 5, 7, 6, 6]);
        assert!(rate_steps(0.7).iter().all(|rate| (0.7 - 1e-9..=1.0).contains(rate)));
    }
}

//! What a search varies: axes of settings, and the points drawn among them.

use crate::random::Stream;

/// One setting and the values to try.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Axis {
    /// Dotted key in a scenario, such as `localizer.turn_deg`.
    pub key: String,
    /// Its values, as TOML.
    pub values: Vec<String>,
}

/// The axes of the paper's parameters that [`Axis::defaults`] gives: n_dist, n_angle, d_max, B_th, turn, nodes.
const DEFAULTS: [(&str, &[&str]); 6] = [
    ("localizer.pgh.distance_bins", &["5", "10", "15", "20", "30"]),
    ("localizer.pgh.angle_bins", &["8", "16", "32", "48"]),
    ("localizer.pgh.max_distance_px", &["200.0", "300.0", "400.0", "600.0"]),
    ("localizer.score_margin", &["0.025", "0.05", "0.1", "0.2", "0.4"]),
    ("localizer.turn_deg", &["30.0", "45.0", "60.0", "90.0"]),
    ("learning.nodes", &["36", "48", "72", "96"]),
];

impl Axis {
    /// The parameters that the paper's title means to optimise, about its own values.
    #[must_use]
    pub fn defaults() -> Vec<Self> {
        let axis = |(key, values): (&str, &[&str])| Self {
            key: key.to_owned(),
            values: values.iter().map(|&value| value.to_owned()).collect(),
        };
        DEFAULTS.into_iter().map(axis).collect()
    }

    /// The axis of `KEY=VALUE,VALUE,...`.
    ///
    /// # Errors
    /// What is wrong with the text.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (key, values) = text.split_once('=').ok_or("there is no '=' in it; write KEY=VALUE,VALUE,...")?;
        let values: Vec<String> = values.split(',').map(|value| value.trim().to_owned()).collect();
        if key.trim().is_empty() || values.iter().any(String::is_empty) {
            return Err("a key or a value is empty; write KEY=VALUE,VALUE,...".to_owned());
        }
        Ok(Self { key: key.trim().to_owned(), values })
    }
}

/// Up to `count` different points of the axes, each a list of `key=value`, spread evenly over every axis (a Latin
/// hypercube); the first is the origin: no setting at all.
///
/// The same seed gives the same points. Fewer come out when points coincide.
#[must_use]
pub fn draw_points(axes: &[Axis], count: usize, seed: u64) -> Vec<Vec<String>> {
    let drawn = count.saturating_sub(1);
    let columns: Vec<Vec<&str>> =
        axes.iter().enumerate().map(|(index, axis)| column(axis, drawn, seed, index)).collect();
    let mut points = vec![Vec::new()];
    for row in 0..drawn {
        let point: Vec<String> =
            axes.iter().zip(&columns).map(|(axis, column)| format!("{}={}", axis.key, column[row])).collect();
        if !points.contains(&point) {
            points.push(point);
        }
    }
    points
}

/// `count` values of an axis, each as often as the others, in random order.
fn column(axis: &Axis, count: usize, seed: u64, index: usize) -> Vec<&str> {
    let mut column: Vec<&str> = axis.values.iter().map(String::as_str).cycle().take(count).collect();
    let mut stream = Stream::new(seed, "points", index as u64, 0);
    for last in (1..column.len()).rev() {
        column.swap(last, stream.index(last + 1));
    }
    column
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Scenario;

    #[test]
    fn every_value_of_every_axis_is_drawn_equally_often_and_the_origin_comes_first() {
        let axes = Axis::defaults();
        let points = draw_points(&axes, 41, 1);
        assert!(points[0].is_empty() && points.len() > 35);
        let thirties = points.iter().flatten().filter(|setting| *setting == "localizer.turn_deg=30.0").count();
        assert!((9..=10).contains(&thirties), "{thirties}");
        assert_eq!(points, draw_points(&axes, 41, 1));
        assert_ne!(points, draw_points(&axes, 41, 2));
    }

    #[test]
    fn every_point_of_the_default_axes_is_a_legal_scenario() {
        for point in draw_points(&Axis::defaults(), 60, 7) {
            let apply = |scenario: Scenario, setting: &String| scenario.with_setting(setting).expect("a known key");
            assert_eq!(point.iter().fold(Scenario::default(), apply).check(), Ok(()));
        }
    }

    #[test]
    fn an_axis_reads_from_its_text() {
        let axis = Axis::parse("localizer.turn_deg = 30, 60").expect("an axis");
        assert_eq!(
            (axis.key.as_str(), axis.values.as_slice()),
            ("localizer.turn_deg", &["30".into(), "60".into()][..])
        );
        assert!(Axis::parse("turn").is_err() && Axis::parse("turn=").is_err() && Axis::parse("=3").is_err());
    }
}

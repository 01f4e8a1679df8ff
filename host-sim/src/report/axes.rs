//! The area of a chart, and how values map to it.

use super::drawing::{line, text, tidy};
use svg::Node;
use svg::node::element::Group;

/// The area of a chart inside its axes, in px of the drawing.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axes {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Axes {
    /// `fraction` grows to the right.
    pub(super) fn x(&self, fraction: f64) -> f64 {
        tidy(self.left + fraction * self.width)
    }

    /// `fraction` grows upwards.
    pub(super) fn y(&self, fraction: f64) -> f64 {
        tidy(self.top + (1.0 - fraction) * self.height)
    }

    /// Lines and labels from 0 to 100 %.
    pub(super) fn rates_grid(&self) -> Group {
        self.grid(&[0.0, 0.2, 0.4, 0.6, 0.8, 1.0], |tenth| format!("{:.0} %", 100.0 * tenth), |rate| rate)
    }

    /// A line across and a label for each of `values`, at the height that `place` gives.
    pub(super) fn grid(&self, values: &[f64], label: impl Fn(f64) -> String, place: impl Fn(f64) -> f64) -> Group {
        let mut group = Group::new();
        for &value in values {
            let y = self.y(place(value));
            group.append(line("grid", (self.x(0.0), y), (self.x(1.0), y)));
            group.append(text("end", (self.left - 8.0, y + 4.0), label(value)));
        }
        group
    }
}

/// Round numbers from 0 to at least `most`, at most six of them.
pub(super) fn round_steps(most: f64) -> Vec<f64> {
    let most = if most.is_finite() && most > 0.0 { most } else { 1.0 };
    let unit = libm::pow(10.0, libm::floor(libm::log10(most)));
    let step = [0.2, 0.5, 1.0, 2.0].into_iter().map(|step| step * unit).find(|step| most / step <= 5.0);
    let step = step.unwrap_or(5.0 * unit);
    (0_u8..=libm::ceil(most / step) as u8).map(|index| f64::from(index) * step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round_and_reach_the_most() {
        for (most, expected) in [(1.0, vec![0.0, 0.2, 0.4, 0.6, 0.8, 1.0]), (17.0, vec![0.0, 5.0, 10.0, 15.0, 20.0])] {
            let steps = round_steps(most);
            assert!(steps.len() == expected.len() && steps.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-9));
        }
        for most in [0.0, 0.003, 9.99, 10.0, 101.0, 6.0e7, f64::NAN] {
            let steps = round_steps(most);
            assert!(steps.len() <= 7 && !steps.last().is_some_and(|last| *last < most), "{most}: {steps:?}");
        }
    }
}

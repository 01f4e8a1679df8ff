//! What all drawings share: one style sheet for light and dark, tooltips, rounding.
//!
//! A drawing is an SVG whose elements carry classes of `drawing.css`. In the report the style sheet stands once in the
//! page; a drawing written as a file of its own carries it.

use svg::Node;
use svg::node::element::{Line, SVG, Style, Text, Title};

/// The style sheet of all drawings.
pub(super) const STYLE: &str = include_str!("drawing.css");

/// Colours of series in the style sheet; further series begin again.
pub(super) const SERIES_COUNT: usize = 6;

/// An empty drawing of the given size, in px of its own frame (x right, y down).
pub(super) fn drawing(width: f64, height: f64) -> SVG {
    SVG::new().set("class", "drawing").set("viewBox", (0, 0, tidy(width), tidy(height))).set("width", tidy(width))
}

/// The drawing as the text of an SVG file, with its style sheet and background.
#[must_use]
pub fn to_svg_file(mut drawing: SVG) -> String {
    let background =
        svg::node::element::Rectangle::new().set("class", "paper").set("width", "100%").set("height", "100%");
    let children = drawing.get_children_mut().expect("an svg element has children");
    children.splice(0..0, [Style::new(STYLE).into(), background.into()]);
    format!("{drawing}\n")
}

/// A native tooltip.
pub(super) fn tooltip(text: impl Into<String>) -> Title {
    Title::new(text)
}

/// A straight line of a class.
pub(super) fn line(class: &str, from: (f64, f64), to: (f64, f64)) -> Line {
    Line::new()
        .set("class", class)
        .set("x1", tidy(from.0))
        .set("y1", tidy(from.1))
        .set("x2", tidy(to.0))
        .set("y2", tidy(to.1))
}

/// A text anchored at its `start`, `middle` or `end`.
pub(super) fn text(anchor: &str, at: (f64, f64), content: impl Into<String>) -> Text {
    Text::new(content).set("text-anchor", anchor).set("x", tidy(at.0)).set("y", tidy(at.1))
}

/// `value` to two decimals, enough for a drawing.
pub(super) fn tidy(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

/// A success rate as the drawings write it: `93.8 %`.
pub(super) fn percent(rate: f64) -> String {
    format!("{:.1} %", 100.0 * rate)
}

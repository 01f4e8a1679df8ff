//! An explored path on the floor plan: what it covers, where it began, and the nodes dropped along it.

use super::drawing::tooltip;
use super::{FloorPlan, FreeCells};
use crate::learning::Exploration;
use std::fmt::Write;
use svg::node::element::{Circle, Path, SVG};

/// The floor plan with an explored path, a drawing of its own; `covered` are the free cells that the path covers.
#[must_use]
pub fn exploration_plan(plan: &FloorPlan, exploration: &Exploration, covered: &FreeCells) -> SVG {
    let mut way = String::new();
    for (index, &point) in exploration.path.iter().enumerate() {
        let (x, y) = plan.to_px(point);
        let _ = write!(way, "{}{x} {y}", if index == 0 { 'M' } else { 'L' });
    }
    let drawing = plan
        .canvas()
        .add(plan.background())
        .add(Path::new().set("class", "covered").set("d", plan.free_path(covered)))
        .add(Path::new().set("class", "trace").set("d", way))
        .add(plan.node_marks());
    let Some(&start) = exploration.path.first() else { return drawing.add(plan.scale_bar()) };
    let (x, y) = plan.to_px(start);
    let label = format!("start at {:.2}, {:.2} m", start.x, start.y);
    let mark = Circle::new().set("class", "truth").set("cx", x).set("cy", y).set("r", 8).add(tooltip(label));
    drawing.add(mark).add(plan.scale_bar())
}

//! An explored path on the floor plan: what it covers, where it began, and the nodes dropped along it.

use super::drawing::{drawing, line, text, tidy, tooltip};
use super::{FloorPlan, FreeCells};
use crate::learning::Exploration;
use std::fmt::Write;
use svg::Node;
use svg::node::element::{Circle, Group, Path, Rectangle, SVG};

/// Height of a line of the legend, width of a mark with the room beside it, and of a letter, in px.
const LEGEND_LINE_PX: f64 = 32.0;
const LEGEND_MARK_PX: f64 = 38.0;
const LEGEND_LETTER_PX: f64 = 10.5;

/// The floor plan with an explored path, a drawing of its own with a legend; `covered` and `missed` are the free cells
/// that the path covers and those that it does not.
#[must_use]
pub fn exploration_plan(plan: &FloorPlan, exploration: &Exploration, covered: &FreeCells, missed: &FreeCells) -> SVG {
    let mut way = String::new();
    for (index, &point) in exploration.path.iter().enumerate() {
        let (x, y) = plan.to_px(point);
        let _ = write!(way, "{}{x} {y}", if index == 0 { 'M' } else { 'L' });
    }
    let (legend, legend_px) = legend(plan.width_px(), plan.height_px());
    let mut drawing = drawing(plan.width_px(), plan.height_px() + legend_px)
        .add(plan.background())
        .add(Path::new().set("class", "covered").set("d", plan.free_path(covered)))
        .add(Path::new().set("class", "missed").set("d", plan.free_path(missed)))
        .add(Path::new().set("class", "trace").set("d", way))
        .add(plan.node_marks());
    if let Some(&start) = exploration.path.first() {
        let label = format!("start at {:.2}, {:.2} m", start.x, start.y);
        drawing.append(start_mark(plan.to_px(start)).add(tooltip(label)));
    }
    drawing.add(plan.scale_bar()).add(legend)
}

fn start_mark((x, y): (f64, f64)) -> Circle {
    Circle::new().set("class", "truth").set("cx", x).set("cy", y).set("r", 8)
}

/// What the marks mean, below the plan, and how high that is: as many in a line as there is room for.
fn legend(width_px: f64, top_px: f64) -> (Group, f64) {
    let square = |class: &str| {
        Rectangle::new().set("class", class).set("x", -11).set("y", -9).set("width", 22).set("height", 18)
    };
    // Each mark about its own origin.
    let marks = [
        ("start", Group::new().add(start_mark((0.0, 0.0)))),
        ("path", Group::new().add(line("trace", (-11.0, 0.0), (11.0, 0.0)))),
        ("node", Group::new().add(Circle::new().set("class", "node").set("r", 4.5))),
        ("floor covered", Group::new().add(square("free")).add(square("covered"))),
        ("not covered", Group::new().add(square("free")).add(square("missed"))),
    ];
    let mut items = Group::new();
    let (mut x, mut y) = (12.0, top_px + 0.5 * LEGEND_LINE_PX);
    for (name, mark) in marks {
        let item_px = LEGEND_MARK_PX + LEGEND_LETTER_PX * name.len() as f64;
        if x > 12.0 && x + item_px > width_px {
            (x, y) = (12.0, y + LEGEND_LINE_PX);
        }
        items.append(mark.set("transform", format!("translate({} {})", tidy(x + 11.0), tidy(y))));
        items.append(text("start", (x + 30.0, y + 7.0), name).set("class", "scale"));
        x += item_px + 16.0;
    }
    let height_px = y + 0.5 * LEGEND_LINE_PX - top_px;
    // What the plan shows beyond its frame ends here.
    let paper = Rectangle::new().set("class", "paper").set("y", top_px).set("width", width_px).set("height", height_px);
    (Group::new().add(paper).add(items), height_px)
}

#[cfg(test)]
mod tests {
    use super::*;
    use edgeloc::explore::Ending;
    use edgeloc::geometry::Point2;

    #[test]
    fn every_mark_is_in_the_legend_below_the_plan() {
        let path = vec![Point2::new(0.0, 0.0), Point2::new(1.0, 0.0)];
        let cells = |x| FreeCells {
            centers: vec![Point2::new(x, 0.0)],
            origin: Point2::default(),
            side_m: 0.1,
            withheld: Vec::new(),
        };
        let ending = Ending::Explored { reachable_m2: 1.0 };
        let exploration = Exploration { path, ending, collision_count: 0, least_clearance_m: 1.0 };
        // As tall as wide, then so narrow that the legend takes several lines.
        for (height_m, lines) in [(6.0, 1), (60.0, 4)] {
            let plan = FloorPlan::new(None, None, &[Point2::new(0.0, 0.0), Point2::new(6.0, height_m)]);
            let (_, legend_px) = legend(plan.width_px(), plan.height_px());
            assert!(
                (legend_px - f64::from(lines) * LEGEND_LINE_PX).abs() < 1e-9,
                "{legend_px} px, {}",
                plan.width_px()
            );
            let drawing = exploration_plan(&plan, &exploration, &cells(0.5), &cells(0.8)).to_string();
            for name in ["start", "path", "node", "floor covered", "not covered"] {
                assert!(drawing.contains(&format!("\n{name}\n")), "the legend lacks {name}: {drawing}");
            }
        }
    }
}

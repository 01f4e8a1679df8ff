//! Every node's accumulated score after each look, as one strip a look.

use super::super::drawing::{drawing, line, text, tidy, tooltip};
use super::super::explanation::is_right;
use crate::monte_carlo::TrialRecord;
use crate::report::LookExplanation;
use svg::Node;
use svg::node::element::{Rectangle, SVG};

/// Width in pixels of the drawing.
const WIDTH_PX: f64 = 1160.0;

/// Width in pixels of the labels at its left.
const LABELS_PX: f64 = 60.0;

/// Height in pixels of a strip.
const STRIP_PX: f64 = 22.0;

/// One strip a look, one field a node.
pub(super) fn score_strips(looks: &[LookExplanation], record: &TrialRecord) -> SVG {
    let node_count = looks.first().map_or(0, |look| look.nodes.len());
    let slot = (WIDTH_PX - LABELS_PX) / node_count.max(1) as f64;
    let height = looks.len() as f64 * (STRIP_PX + 6.0);
    let mut strips = drawing(WIDTH_PX, height + 22.0);
    for (index, look) in looks.iter().enumerate() {
        let top = index as f64 * (STRIP_PX + 6.0) + 2.0;
        let most = look.nodes.iter().map(|node| node.score).fold(1e-9, f64::max);
        strips.append(text("end", (LABELS_PX - 8.0, top + 15.0), format!("look {}", look.look)));
        for (node, standing) in look.nodes.iter().enumerate() {
            let state = match (standing.was_candidate, standing.is_candidate) {
                _ if look.is_verifying => "",
                (_, true) => ", a candidate",
                (true, false) => ", drops out",
                (false, false) => ", left before",
            };
            let is_framed = standing.is_candidate && !look.is_verifying;
            let field = Rectangle::new()
                .set("class", if is_framed { "heat framed" } else { "heat" })
                .set("x", tidy(LABELS_PX + (node as f64 + 0.08) * slot))
                .set("width", tidy(0.84 * slot))
                .set("y", top)
                .set("height", STRIP_PX)
                .set("fill-opacity", tidy((standing.score / most).clamp(0.0, 1.0)));
            strips.append(field.add(tooltip(format!("node {node}: {:.3}{state}", standing.score))));
        }
    }
    for node in (0..node_count).filter(|node| is_right(record, *node)) {
        let (from, to) = (LABELS_PX + node as f64 * slot, LABELS_PX + (node + 1) as f64 * slot);
        strips.append(line("right", (from, height), (to, height)));
        strips.append(text("middle", ((from + to) / 2.0, height + 16.0), node.to_string()));
    }
    strips
}

//! The trials of a row on the floor plan: successes faint, failures with a line to the answered node.

use super::FloorPlan;
use super::drawing::{line, tooltip};
use crate::monte_carlo::{Outcome, TrialRecord};
use edgeloc::geometry::Point2;
use svg::Node;
use svg::node::element::{Circle, Group, SVG};

/// The floor plan with the trials of `records`, a drawing of its own.
#[must_use]
pub fn trials_plan<'r>(plan: &FloorPlan, records: impl Iterator<Item = &'r TrialRecord>) -> SVG {
    plan.canvas().add(plan.background()).add(plan.node_marks()).add(trial_marks(plan, records)).add(plan.scale_bar())
}

/// Marks of `records`, to be drawn over the plan's background.
#[must_use]
pub fn trial_marks<'r>(plan: &FloorPlan, records: impl Iterator<Item = &'r TrialRecord>) -> Group {
    let (mut hits, mut lines, mut misses) = (Group::new(), Group::new(), Group::new());
    for record in records {
        let place = plan.to_px(Point2::new(record.true_x_m, record.true_y_m));
        let mark = Circle::new().set("cx", place.0).set("cy", place.1);
        if record.is_success {
            hits.append(mark.set("class", "hit").set("r", 4.5).add(tooltip(describe(record))));
            continue;
        }
        let class = if record.outcome == Outcome::Unknown { "unknown" } else { "miss" };
        if let Some(&answered) = record.answered_node.and_then(|node| plan.nodes().get(node as usize)) {
            lines.append(line("miss-line", place, plan.to_px(answered)));
        }
        misses.append(mark.set("class", class).set("r", 5).add(tooltip(describe(record))));
    }
    Group::new().add(hits).add(lines).add(misses)
}

fn describe(record: &TrialRecord) -> String {
    let answer = match (record.outcome, record.answered_node) {
        (Outcome::Unknown, _) => "can't tell".to_owned(),
        (Outcome::Error, _) => "an error".to_owned(),
        (Outcome::Localized, None) => "no node".to_owned(),
        (Outcome::Localized, Some(node)) => match record.answer_distance_m {
            Some(distance) => format!("node {node}, {distance:.2} m away"),
            None => format!("node {node}"),
        },
    };
    format!(
        "trial {}: {} after {} looks; nearest nodes {} ({:.2} m) and {}",
        record.trial,
        answer,
        record.looks,
        record.nearest_node,
        record.nearest_node_distance_m,
        record.second_nearest_node
    )
}

//! A look of the verifying localiser: what speaks for which place, what decides, and what came out.

use super::super::document::inline;
use super::super::drawing::{text, tidy, tooltip};
use super::super::explanation::sight;
use super::super::place_evidence::{Place, PlaceEvidence, told_heading};
use super::TrialFacts;
use super::images::scene_with_view;
use crate::report::{AnsweredPose, LookExplanation};
use edgeloc::geometry::Point2;
use edgeloc::localize::VerificationConfig;
use maud::{Markup, html};
use std::fmt::Write;
use svg::Node;
use svg::node::element::{Circle, Ellipse, Group, Path, SVG};

/// Steps of darkness of the evidence.
const LEVELS: usize = 12;
/// Half axes of an ellipse that holds 95 % of a normal distribution in the plane, in standard deviations.
const ELLIPSE_95: f64 = 2.4477;

/// What decided, what came out, and the places on the plan.
pub(super) fn decision(
    facts: &TrialFacts<'_>,
    look: &LookExplanation,
    evidence: &PlaceEvidence,
    config: &VerificationConfig,
) -> Markup {
    html! {
        h3 { "The decision" }
        dl {
            dt { "decision" } dd { (look.decision) }
            @if let Some(pose) = &look.pose { (pose_facts(look, pose)) }
            @if let Some(probability) = look.probability {
                dt { "probability" } dd { (format!("{:.2} % that the answer is right", 100.0 * probability)) }
            }
            @for rival in &look.rivals {
                dt { "possible" }
                dd { (format!(
                    "{:.1} %: {:.2}, {:.2} m, node {}; {:.2} m from the truth", 100.0 * rival.probability, rival.x_m,
                    rival.y_m, rival.node, Point2::new(rival.x_m, rival.y_m).distance(look.true_pose.position)
                )) }
            }
            dt { "what decides" }
            dd { (format!(
                "the lead of the best place over the best rival, times the root of the segments seen in thirties: {}; above {} \
                 (localizer.verification.confidence) the best is answered if it agrees well enough, after the last look above less",
                evidence.places.get(1).map_or("no rival".to_owned(), |rival| format!("{:.3}", rival.behind)),
                config.confidence
            )) }
        }
        h3 { "Places that agree best with all looks so far" }
        p.note {
            "Looked at anew for this page by the localiser's own check of a pose, on a grid over the building and more closely \
             about its best cells; the localiser's search may have found somewhat better or worse poses there. Agreement: 1 if \
             a model explains all that was seen and nothing else."
        }
        (places_table(facts, look, evidence))
        p.note {
            "On the plan, the darker a cell, the better it agrees; blue ring: the best place; numbered: its rivals; green: the \
             true pose; small circles: nodes."
            @if look.pose.is_some() { " Red: the pose answered, with the ellipse that holds 95 % by its covariance." }
        }
        div.wide { (inline(&plan(facts, look, evidence))) }
    }
}

/// What would be seen from the best place and from the true pose, over what was seen.
pub(super) fn models(facts: &TrialFacts<'_>, look: &LookExplanation, evidence: &PlaceEvidence) -> Markup {
    let best = evidence.places.first().map(|place| ("best place", place));
    html! {
        h3 { "The models, predicted for a pose" }
        p.note { "Green: the node's 3-D segments as they would be seen from the pose. Blue and orange: what was seen." }
        div.panels { @for (name, place) in best.into_iter().chain([("true pose", &evidence.truth)]) {
            @if let Some(node) = facts.map.node(place.node) {
                figure {
                    figcaption { (format!("{name}, by the model of node {}: agreement {:.3}", place.node.0, place.score)) }
                    (inline(&scene_with_view(
                        look, facts.map.rig(), &node, (place.position, told_heading(facts.looks, look, place.heading_error))
                    )))
                }
            }
        } }
    }
}

fn pose_facts(look: &LookExplanation, pose: &AnsweredPose) -> Markup {
    let truth = look.true_pose.position;
    let [sd_x, sd_y, sd_heading] = [0, 1, 2].map(|axis| pose.covariance[axis][axis].max(0.0).sqrt());
    let covariance: Vec<String> = pose
        .covariance
        .iter()
        .map(|row| row.iter().map(|value| format!("{value:.2e}")).collect::<Vec<_>>().join("  "))
        .collect();
    let turned_deg = f64::from(pose.heading_deg) - look.heading_deg;
    let turned_deg = turned_deg - 360.0 * (turned_deg / 360.0).round();
    html! {
        dt { "pose" }
        dd { (format!(
            "{:.3} ± {sd_x:.3} m, {:.3} ± {sd_y:.3} m, heading {:.2}° ± {:.2}° (one standard deviation)", pose.x_m, pose.y_m,
            pose.heading_deg, sd_heading.to_degrees()
        )) }
        dt { "off the truth" }
        dd { (format!(
            "{:+.3} m, {:+.3} m, {turned_deg:+.2}°: {:.3} m in all", pose.x_m - truth.x, pose.y_m - truth.y,
            Point2::new(pose.x_m, pose.y_m).distance(truth)
        )) }
        dt { "covariance" }
        dd { "of x, y, heading in m, m, rad: " (covariance.join(" | ")) }
    }
}

fn places_table(facts: &TrialFacts<'_>, look: &LookExplanation, evidence: &PlaceEvidence) -> Markup {
    let places = evidence.places.iter().enumerate().map(|(rank, place)| ((rank + 1).to_string(), place));
    html! {
        div.wide { table {
            thead { tr {
                @for (class, name) in [
                    ("", "place"), ("number", "position"), ("number", "heading"), ("number", "by the model of"),
                    ("number", "agreement"), ("number", "confidence of the best over it"), ("number", "from the truth"),
                ] { th class=(class) { (name) } }
            } }
            tbody { @for (name, place) in places.chain([("true pose".to_owned(), &evidence.truth)]) { tr {
                td { (name) }
                td.number { (format!("{:.2}, {:.2} m", place.position.x, place.position.y)) }
                td.number { (format!("{:.1}°", told_heading(facts.looks, look, place.heading_error).angle().degrees())) }
                td.number { "node " (place.node.0) }
                td.number { (format!("{:.3}", place.score)) }
                td.number { @if name == "1" { "–" } @else { (format!("{:.3}", place.behind)) } }
                td.number { (format!("{:.2} m", place.position.distance(look.true_pose.position))) }
            } } }
        } }
    }
}

fn plan(facts: &TrialFacts<'_>, look: &LookExplanation, evidence: &PlaceEvidence) -> SVG {
    let plan = facts.plan;
    let mut marks = Group::new().add(plan.node_marks()).add(sight(plan, look.true_pose.position, look.heading_deg));
    for (index, place) in evidence.places.iter().enumerate().rev() {
        marks.append(place_mark(facts, place, index));
    }
    if let Some(pose) = &look.pose {
        marks.append(pose_mark(facts, pose));
    }
    plan.canvas().add(plan.background()).add(cells(facts, evidence)).add(marks).add(plan.scale_bar())
}

/// The cells, those of one darkness as one path.
fn cells(facts: &TrialFacts<'_>, evidence: &PlaceEvidence) -> Group {
    let best = evidence.cells.iter().map(|(_, score)| *score).fold(1e-9, f64::max);
    let side = facts.plan.length_px(f64::from(evidence.cell_m));
    let mut paths = vec![String::new(); LEVELS + 1];
    for (center, score) in &evidence.cells {
        // Squared, so that the few that agree stand out.
        let level = ((score / best).clamp(0.0, 1.0).powi(2) * LEVELS as f64).round() as usize;
        let (x, y) = facts.plan.to_px(*center);
        let _ = write!(paths[level], "M{} {}h{side}v{side}h-{side}z", tidy(x - side / 2.0), tidy(y - side / 2.0));
    }
    let mut group = Group::new();
    for (level, path) in paths.into_iter().enumerate().skip(1).filter(|(_, path)| !path.is_empty()) {
        let opacity = tidy(0.85 * level as f64 / LEVELS as f64);
        group.append(Path::new().set("class", "evidence").set("fill-opacity", opacity).set("d", path));
    }
    group
}

fn place_mark(facts: &TrialFacts<'_>, place: &Place, index: usize) -> Group {
    let (x, y) = facts.plan.to_px(place.position);
    let class = if index == 0 { "best" } else { "rival" };
    let label = format!("{}: agreement {:.3}, node {}", index + 1, place.score, place.node.0);
    let ring = Circle::new().set("class", class).set("cx", x).set("cy", y).set("r", 11).add(tooltip(label));
    Group::new().add(ring).add(text("start", (x + 14.0, y - 8.0), (index + 1).to_string()).set("class", "rank"))
}

/// The pose answered, with its ellipse.
fn pose_mark(facts: &TrialFacts<'_>, pose: &AnsweredPose) -> Group {
    let (x, y) = facts.plan.to_px(Point2::new(pose.x_m, pose.y_m));
    let [[xx, xy, _], [_, yy, _], _] = pose.covariance.map(|row| row.map(f64::from));
    let (mean, half) = ((xx + yy) / 2.0, ((xx - yy) / 2.0).hypot(xy));
    let axis_px = |variance: f64| facts.plan.length_px(ELLIPSE_95 * variance.max(0.0).sqrt()).max(0.5);
    // The plan's y axis points down.
    let turn_deg = -0.5 * libm::atan2(2.0 * xy, xx - yy).to_degrees();
    let ellipse = Ellipse::new()
        .set("class", "answer")
        .set("cx", x)
        .set("cy", y)
        .set("rx", axis_px(mean + half))
        .set("ry", axis_px(mean - half))
        .set("transform", format!("rotate({} {x} {y})", tidy(turn_deg)));
    let angle = f64::from(pose.heading_deg).to_radians();
    let tip = (x + 26.0 * libm::cos(angle), y - 26.0 * libm::sin(angle));
    let ray = super::super::drawing::line("answer", (x, y), tip);
    let label = format!("answered: {:.2}, {:.2} m, heading {:.1}°", pose.x_m, pose.y_m, pose.heading_deg);
    Group::new().add(ellipse).add(ray.add(tooltip(label)))
}

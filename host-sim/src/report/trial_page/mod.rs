//! One trial as a page: every intermediate of every look, from the draws of the sources to the decision.

mod histograms;
mod images;
mod scores;

use super::document::{document, inline};
use super::{FloorPlan, LookExplanation};
use crate::monte_carlo::{LookImages, SourceEffect, TrialRecord};
use edgeloc::database::{NodeId, TopologicalDatabase};
use edgeloc::localize::LocalizerConfig;
use histograms::histograms;
use images::{both_images, model_over_scene};
use maud::{Markup, html};
use scores::score_strips;
use std::collections::BTreeMap;

/// Everything that the page of a trial is made of.
#[derive(Debug)]
pub struct TrialFacts<'a> {
    /// What came out.
    pub record: &'a TrialRecord,
    /// What was applied, by the keys of a scenario.
    pub parameters: &'a BTreeMap<String, String>,
    /// What the localiser worked with.
    pub config: LocalizerConfig,
    /// The map of the trial.
    pub map: TopologicalDatabase<'a>,
    /// The building, with the nodes.
    pub plan: &'a FloorPlan,
    /// The looks, in order.
    pub looks: &'a [LookExplanation],
    /// The images of the looks, in the same order.
    pub images: &'a [LookImages],
}

/// The page of a trial: one self-contained file.
#[must_use]
pub fn trial_page(facts: &TrialFacts<'_>) -> String {
    let record = facts.record;
    let title = format!("Trial {} of {}", record.trial, record.row);
    let answer = match (record.answered_node, record.answer_distance_m) {
        (Some(node), Some(distance)) => format!("node {node}, {distance:.2} m from the truth"),
        _ => "no answer".to_owned(),
    };
    let verdict = if record.is_success { "right" } else { "wrong" };
    let subtitle = format!("{} looks, {answer}: {verdict}", record.looks);
    let body = html! {
        section {
            h2 { "The trial" }
            p.note {
                (format!(
                    "The robot stood at {:.2}, {:.2} m, heading {:.1}°; the nodes nearest to it are {} ({:.2} m) and {}.",
                    record.true_x_m, record.true_y_m, record.true_heading_deg, record.nearest_node,
                    record.nearest_node_distance_m, record.second_nearest_node
                ))
                @if let Some(message) = &record.message { " It failed: " (message) }
            }
            h3 { "Accumulated score of each node after each look" }
            p.note {
                "One line a look. The darker, the higher; framed: still a candidate after the look; green line below: one of the \
                 two nearest nodes. Point at a field for its number."
            }
            div.wide { (inline(&score_strips(facts.looks, record))) }
            details {
                summary { "Parameters as they were applied" }
                dl { @for (key, value) in facts.parameters { dt { (key) } dd { (value) } } }
            }
        }
        @for (look, images) in facts.looks.iter().zip(facts.images) { (look_section(facts, look, images)) }
    };
    document(&title, &subtitle, &body)
}

fn look_section(facts: &TrialFacts<'_>, look: &LookExplanation, images: &LookImages) -> Markup {
    let camera = &facts.map.rig().camera;
    let ranking = look.ranking();
    let leader = ranking.first().map(|(node, _)| NodeId(*node as u32));
    let truth = NodeId(facts.record.nearest_node);
    let left = look.nodes.iter().filter(|node| node.is_candidate).count();
    let told = look.compass_deg.map_or_else(|| "not told".to_owned(), |told| format!("told {told:.1}°"));
    html! {
        section {
            h2 { (format!("Look {}: {}", look.look, look.decision)) }
            p.note {
                (format!(
                    "True heading {:.1}°, {}. {} segments seen, {} matched against {} candidates; the margin is B_th / i = \
                     {:.4}, and {left} candidates are left.",
                    look.heading_deg, told, look.seen_segments, look.used_segments, ranking.len(),
                    facts.config.score_margin / look.look as f32
                ))
            }
            h3 { "What the sources drew" }
            (effects_table(&images.effects))
            h3 { "Both images" }
            p.note { "Grey: what is visible. Blue and orange: what the robot works with, by contrast polarity." }
            div.panels { @for (name, image) in both_images(images, camera) {
                figure { figcaption { (name) } (inline(&image)) }
            } }
            h3 { "The models, predicted at the heading told" }
            p.note { "Green: the node's 3-D segments as they would be seen from the node. Blue and orange: what was seen." }
            div.panels { @for (name, node) in [("leading node", leader), ("nearest node", Some(truth))] {
                @if let Some(node) = node.and_then(|id| facts.map.node(id).map(|node| (id, node))) {
                    figure {
                        figcaption { (name) " " (node.0.0) }
                        (inline(&model_over_scene(&node.1, facts.map.rig(), look)))
                    }
                }
            } }
            @if let Some(node) = leader.and_then(|id| facts.map.node(id)) {
                h3 { "Histograms of the longest lines, and their best partners in the leading node's prediction" }
                p.note {
                    "Across: relative angle; upwards: perpendicular distance. The darker, the larger the root of the bin's share. \
                     Their dot product is the Bhattacharyya coefficient."
                }
                div.panels { @for pair in histograms(look, &node, facts.map.rig(), &facts.config) {
                    figure { figcaption { (pair.caption) } (inline(&pair.drawing)) }
                } }
            }
            details {
                summary { "The plan, and every node's score" }
                div.wide { (inline(&look.to_svg(facts.plan, camera, facts.record))) }
            }
        }
    }
}

fn effects_table(effects: &[SourceEffect]) -> Markup {
    html! {
        @if effects.is_empty() { p.note { "No source acted on the images." } } @else {
            div.wide { table {
                thead { tr {
                    @for (class, name) in [
                        ("", "source"), ("number", "magnitude"), ("number", "features changed"), ("number", "pieces"),
                        ("number", "length kept"), ("number", "shift, rms"), ("number", "shift, most"), ("number", "flipped"),
                        ("number", "not matched"),
                    ] { th class=(class) { (name) } }
                } }
                tbody { @for effect in effects { tr {
                    td { (effect.source) br; span.quiet { (effect.unit) } }
                    td.number { (effect.magnitude) }
                    td.number { (effect.changed_features) " of " (effect.features) }
                    td.number { (effect.pieces[0]) " → " (effect.pieces[1]) }
                    td.number { (format!("{:.1} %", 100.0 * effect.length_px[1] / effect.length_px[0].max(1e-9))) }
                    td.number { (format!("{:.2} px", effect.rms_shift_px)) }
                    td.number { (format!("{:.2} px", effect.greatest_shift_px)) }
                    td.number { (effect.flipped_pieces) }
                    td.number { (effect.unmatched_features) }
                } } }
            } }
        }
    }
}

//! One trial as a page: every intermediate of every look, from the draws of the sources to the decision.

mod histograms;
mod images;
mod scores;
mod verified;

use super::document::{document, inline};
use super::place_evidence::{PlaceEvidence, place_evidence};
use super::{FloorPlan, LookExplanation, answer_words};
use crate::learning::CalibratedRig;
use crate::monte_carlo::{LookImages, SourceEffect, TrialRecord};
use edgeloc::database::{NodeId, TopologicalDatabase};
use edgeloc::geometry::Point2;
use edgeloc::localize::{LocalizerConfig, VerificationConfig};
use edgeloc::stereo::PARAMETERS;
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
    /// The rig as the robot believes it.
    pub robot: &'a CalibratedRig,
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
    let verdict = if record.is_success { "right" } else { "wrong" };
    let subtitle = format!("{}, {}: {verdict}", counted(record.looks as usize, "look"), answer_words(record));
    let truth = Point2::new(record.true_x_m, record.true_y_m);
    let evidence = match facts.config.verification {
        Some(_) => place_evidence(facts.looks, &facts.map, &facts.config, truth),
        None => Vec::new(),
    };
    let body = html! {
        section {
            h2 { "The trial" }
            p.note {
                (format!(
                    "The robot stood at {:.2}, {:.2} m, heading {:.1}°, and at its last look at {:.2}, {:.2} m, after {:.2} m \
                     of moves; the nodes nearest to it are {} ({:.2} m) and {}.",
                    record.true_x_m, record.true_y_m, record.true_heading_deg, record.end_x_m, record.end_y_m,
                    record.driven_m, record.nearest_node, record.nearest_node_distance_m, record.second_nearest_node
                ))
                @if let Some(message) = &record.message { " It failed: " (message) }
            }
            @if facts.config.verification.is_some() {
                h3 { "Agreement of the best pose beside each node after each look" }
                p.note {
                    "As the localiser's search found it, over all looks so far. One line a look. The darker, the better; green line \
                     below: one of the two nearest nodes. Point at a field for its number."
                }
            } @else {
                h3 { "Accumulated score of each node after each look" }
                p.note {
                    "One line a look. The darker, the higher; framed: still a candidate after the look; green line below: one of \
                     the two nearest nodes. Point at a field for its number."
                }
            }
            div.wide { (inline(&score_strips(facts.looks, record))) }
            details {
                summary { "What the robot's calibration is off" }
                table { @for (facts, error) in PARAMETERS.iter().zip(facts.robot.errors().iter()) {
                    tr { td { (facts.name) } td { (facts.symbol) } td { (format!("{error:+.6} {}", facts.unit)) } }
                } }
            }
            details {
                summary { "Parameters as they were applied" }
                dl { @for (key, value) in facts.parameters { dt { (key) } dd { (value) } } }
            }
        }
        @for (index, (look, images)) in facts.looks.iter().zip(facts.images).enumerate() {
            section {
                h2 { (format!("Look {}: {}", look.look, look.decision)) }
                @match facts.config.verification.as_ref().zip(evidence.get(index)) {
                    Some((config, evidence)) => (verified_look(facts, look, images, (evidence, config))),
                    None => (matched_look(facts, look, images)),
                }
            }
        }
    };
    document(&title, &subtitle, &body)
}

/// A look of the verifying localiser.
fn verified_look(
    facts: &TrialFacts<'_>,
    look: &LookExplanation,
    images: &LookImages,
    (evidence, config): (&PlaceEvidence, &VerificationConfig),
) -> Markup {
    html! {
        p.note {
            (headings(look))
            (format!(
                " {} seen, {} checked against poses beside {}.", counted(look.seen_segments, "segment"), look.used_segments,
                counted(look.nodes.len(), "node")
            ))
        }
        (verified::decision(facts, look, evidence, config))
        (images_section(facts, images))
        (verified::models(facts, look, evidence))
    }
}

/// A look of the paper's localiser.
fn matched_look(facts: &TrialFacts<'_>, look: &LookExplanation, images: &LookImages) -> Markup {
    let camera = &facts.map.rig().camera;
    let ranking = look.ranking();
    let leader = ranking.first().map(|(node, _)| NodeId(*node as u32));
    let truth = NodeId(facts.record.nearest_node);
    let left = look.nodes.iter().filter(|node| node.is_candidate).count();
    html! {
        p.note {
            (headings(look))
            (format!(
                " {} seen, {} matched against {}; the margin is B_th / i = {:.4}, and {} left.",
                counted(look.seen_segments, "segment"), look.used_segments, counted(ranking.len(), "candidate"),
                facts.config.score_margin / look.look as f32,
                if left == 1 { "1 candidate is".to_owned() } else { format!("{left} candidates are") }
            ))
        }
        (images_section(facts, images))
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

fn headings(look: &LookExplanation) -> String {
    let spread = look.compass_spread.degrees();
    let spread = if spread > 0.0 { format!(" ± {spread:.1}°") } else { String::new() };
    let told = look.compass_deg.map_or_else(|| "not told".to_owned(), |told| format!("told {told:.1}°{spread}"));
    format!("True heading {:.1}°, {told}.", look.heading_deg)
}

fn images_section(facts: &TrialFacts<'_>, images: &LookImages) -> Markup {
    html! {
        h3 { "What the sources drew" }
        (effects_table(&images.effects))
        h3 { "Both images" }
        p.note { "Grey: what is visible. Blue and orange: what the robot works with, by contrast polarity." }
        div.panels { @for (name, image) in both_images(images, &facts.map.rig().camera) {
            figure { figcaption { (name) } (inline(&image)) }
        } }
    }
}

/// A number of things, in words.
fn counted(count: usize, thing: &str) -> String {
    if count == 1 { format!("1 {thing}") } else { format!("{count} {thing}s") }
}

fn effects_table(effects: &[SourceEffect]) -> Markup {
    html! {
        @if effects.is_empty() { p.note { "No source acted on the images." } } @else {
            div.wide { table {
                thead { tr {
                    @for (class, name) in [
                        ("", "source"), ("number", "magnitude"), ("number", "features changed"), ("number", "removed"),
                        ("number", "added"), ("number", "pieces"), ("number", "length"), ("number", "shift, rms"),
                        ("number", "shift, most"), ("number", "flipped"), ("number", "not matched"),
                    ] { th class=(class) { (name) } }
                } }
                tbody { @for effect in effects { tr {
                    td { (effect.source) br; span.quiet { (effect.unit) } }
                    td.number { (effect.magnitude) }
                    td.number { (effect.changed_features) " of " (effect.features) }
                    td.number { (effect.removed_features) }
                    td.number { (effect.added_features) }
                    td.number { (effect.pieces[0]) " → " (effect.pieces[1]) }
                    td.number { (format!("{:.1} %", 100.0 * effect.length_px[1] / effect.length_px[0].max(1e-9))) }
                    @for shift_px in [effect.rms_shift_px, effect.greatest_shift_px] {
                        td.number { @if shift_px > 0.0 { (format!("{shift_px:.2} px")) } @else { "–" } }
                    }
                    td.number { (effect.flipped_pieces) }
                    td.number { (effect.unmatched_features) }
                } } }
            } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::StereoObservation;
    use crate::monte_carlo::TruePose;
    use crate::report::{AnsweredPose, sample};
    use edgeloc::geometry::{Heading, StereoRig};

    /// The page of a trial of one look at the second place of the made-up map, its nodes' scores those given.
    fn page(config: LocalizerConfig, scores: [f64; 2], answer: Option<AnsweredPose>) -> String {
        let bytes = sample::map_of_posts();
        let map = TopologicalDatabase::open(&bytes).expect("a map");
        let places: Vec<Point2> = map.nodes().map(|node| node.position()).collect();
        let mut record = sample::run().results.records[0].clone();
        (record.true_x_m, record.true_y_m, record.nearest_node, record.second_nearest_node) = (5.1, 2.1, 1, 0);
        let nodes = scores.map(|score| crate::report::NodeStanding { score, was_candidate: true, is_candidate: true });
        let is_verifying = config.verification.is_some();
        let true_pose = TruePose { position: Point2::new(5.1, 2.1), heading: Heading::default() };
        let nodes = nodes.to_vec();
        let look = LookExplanation { nodes, is_verifying, pose: answer, true_pose, ..sample::look_at_posts() };
        let blank = || StereoObservation { rig: StereoRig::reference(), features: Vec::new() };
        let images = LookImages { clean: blank(), perturbed: blank(), effects: Vec::new() };
        trial_page(&TrialFacts {
            record: &record,
            parameters: &BTreeMap::new(),
            config,
            robot: &CalibratedRig::exact(StereoRig::reference()),
            map,
            plan: &FloorPlan::new(None, None, &places),
            looks: &[look],
            images: &[images],
        })
    }

    #[test]
    fn the_page_of_the_verifying_localiser_shows_what_that_one_does() {
        let covariance = [[4e-4, 1e-4, 0.0], [1e-4, 9e-4, 0.0], [0.0, 0.0, 1e-6]];
        let answer = AnsweredPose { x_m: 5.02, y_m: 2.03, heading_deg: 0.5, covariance };
        let page = page(LocalizerConfig::edgeloc(), [-0.2, 0.9], Some(answer));
        for part in [
            "Agreement of the best pose beside each node",
            "localizer.verification.confidence",
            "5.020 ± 0.020 m, 2.030 ± 0.030 m, heading 0.50° ± 0.06°",
            "-0.080 m, -0.070 m, +0.50°: 0.106 m in all",
            "class=\"evidence\"",
            "class=\"best\"",
            "class=\"answer\"",
            "class=\"sight\"",
            "true pose, by the model of node",
            "What the robot's calibration is off",
            "+0.000000",
        ] {
            assert!(page.contains(part), "the page lacks {part}");
        }
        let body = page.split("</style>").nth(1).expect("a body");
        for part in ["B_th", "candidate", "Bhattacharyya", "fill-opacity=\"-", "NaN"] {
            assert!(!body.contains(part), "the page of the verifying localiser tells of {part}");
        }
    }

    #[test]
    fn the_best_place_of_a_clean_look_is_where_the_robot_stands() {
        let bytes = sample::map_of_posts();
        let map = TopologicalDatabase::open(&bytes).expect("a map");
        let truth = Point2::new(5.0, 2.0);
        let found = place_evidence(&[sample::look_at_posts()], &map, &LocalizerConfig::edgeloc(), truth);
        let (best, at_truth) = (found[0].places[0], found[0].truth);
        assert!(best.position.distance(truth) < 0.2 && best.node == NodeId(1), "{best:?}");
        assert!(at_truth.score > 0.8 && at_truth.score < best.score + 0.05, "{at_truth:?}");
        assert!(found[0].places[1..].iter().all(|rival| rival.behind >= 0.0 && rival.score <= best.score));
    }

    #[test]
    fn the_page_of_the_paper_s_localiser_shows_margin_and_histograms() {
        let page = page(LocalizerConfig::paper(), [0.3, 0.9], None);
        assert!(
            page.contains("B_th / i = 0.1000, and 2 candidates are left") && page.contains("Bhattacharyya"),
            "{page}"
        );
        assert!(!page.contains("class=\"evidence\"") && !page.contains("localizer.verification"));
    }
}

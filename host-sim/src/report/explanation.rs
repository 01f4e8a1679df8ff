//! One trial explained look by look: in words, and as a drawing of each look.
//!
//! A drawing shows what the camera saw, where the candidates are on the plan, and every node's accumulated score.

use super::FloorPlan;
use super::drawing::{drawing, line, text, tidy, tooltip};
use crate::monte_carlo::{LookEvent, TrialRecord, TruePose};
use edgeloc::geometry::{Angle, Heading, PinholeCamera, Point2, Polarity, Segment2};
use edgeloc::localize::{Decision, LocalizerConfig, UnknownReason};
use serde::Serialize;
use std::fmt::Write;
use svg::Node;
use svg::node::element::{Circle, Group, Path, Rectangle, SVG};

/// Nodes named in the words about a look.
const NAMED_NODES: usize = 5;

/// Width in pixels of the drawing of a look.
const WIDTH_PX: f64 = 1000.0;

/// Width in pixels of the camera's image in it.
const IMAGE_WIDTH_PX: f64 = 560.0;

/// What happened at one look.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LookExplanation {
    /// Look, from 1.
    pub look: usize,
    /// True heading of the optical axis in degrees.
    pub heading_deg: f64,
    /// What the compass told of it, in degrees; none without a compass.
    pub compass_deg: Option<f64>,
    /// Segments that the camera saw.
    pub seen_segments: usize,
    /// Segments that entered the matching or the verification.
    pub used_segments: usize,
    /// Every node's accumulated score and standing, by identity.
    pub nodes: Vec<NodeStanding>,
    /// The answer, in words.
    pub decision: String,
    /// Whether the verifying localiser looked: there are no candidates then, and no node leaves.
    #[serde(skip)]
    pub is_verifying: bool,
    /// The pose answered, if any.
    pub pose: Option<AnsweredPose>,
    /// Probability that the answer is right as the localiser has it, if it states one.
    pub probability: Option<f32>,
    /// The places between which the localiser can't tell.
    pub rivals: Vec<PossiblePlace>,
    /// The segments seen.
    #[serde(skip)]
    pub scene: Vec<Segment2>,
    /// The true pose.
    #[serde(skip)]
    pub true_pose: TruePose,
    /// What the compass told of it; the truth without a compass.
    #[serde(skip)]
    pub compass: Heading,
    /// Standard deviation of what the compass tells.
    #[serde(skip)]
    pub compass_spread: Angle,
}

/// A pose answered.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct AnsweredPose {
    /// Position in the world frame \[m\].
    pub x_m: f32,
    /// Position in the world frame \[m\].
    pub y_m: f32,
    /// Heading at the look in degrees.
    pub heading_deg: f32,
    /// Covariance of x, y and heading in m, m and rad.
    pub covariance: [[f32; 3]; 3],
}

/// A place at which the robot may be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PossiblePlace {
    /// The node nearest to it.
    pub node: u32,
    /// Position in the world frame \[m\].
    pub x_m: f32,
    /// Position in the world frame \[m\].
    pub y_m: f32,
    /// Probability that the robot is there, if it is at one of the places named.
    pub probability: f32,
}

/// How a node stands after a look.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct NodeStanding {
    /// Accumulated score, Bhattacharyya coefficients summed over looks; when verifying, the agreement of the best pose
    /// beside the node.
    pub score: f64,
    /// Whether it was a candidate before the look.
    pub was_candidate: bool,
    /// Whether it is one after the look.
    pub is_candidate: bool,
}

impl LookExplanation {
    /// What the `look`-th look, from 1, came to.
    #[must_use]
    pub fn new(look: usize, event: &LookEvent<'_>, config: &LocalizerConfig) -> Self {
        let scores = event.localizer.candidates().scores();
        let standing = |(node, was_candidate): (&edgeloc::localize::NodeScore, &bool)| NodeStanding {
            score: node.as_f64(),
            was_candidate: *was_candidate,
            is_candidate: node.is_candidate(),
        };
        let (mut pose, mut probability, mut rivals) = (None, None, Vec::new());
        match event.decision {
            Ok(Decision::Localized(place)) => {
                probability = place.probability;
                pose = place.pose.map(|pose| AnsweredPose {
                    x_m: pose.position.x,
                    y_m: pose.position.y,
                    heading_deg: pose.heading.angle().degrees(),
                    covariance: pose.covariance,
                });
            }
            Ok(Decision::Unknown { reason: UnknownReason::Indistinguishable(places) }) => {
                rivals.extend(places.iter().map(|place| PossiblePlace {
                    node: place.node.0,
                    x_m: place.position.x,
                    y_m: place.position.y,
                    probability: place.probability,
                }));
            }
            _ => {}
        }
        let decision = match event.decision {
            Ok(Decision::Localized(place)) => {
                let at = |pose: AnsweredPose| format!(", {:.2}, {:.2} m, {:.1}°", pose.x_m, pose.y_m, pose.heading_deg);
                let how_sure = probability.map(|probability| format!(", probability {:.1} %", 100.0 * probability));
                format!("at node {}{}{}", place.node.0, pose.map(at).unwrap_or_default(), how_sure.unwrap_or_default())
            }
            Ok(Decision::LookAgain { turn, step_m }) => {
                let step = if *step_m > 0.0 { format!(" and {step_m:.2} m ahead") } else { String::new() };
                format!("look again after a turn of {:.0} degrees{step}", turn.degrees())
            }
            Ok(Decision::Unknown { reason }) => format!("can't tell: {reason}"),
            Err(error) => format!("refused: {error}"),
        };
        Self {
            look,
            heading_deg: f64::from(event.pose.heading.angle().degrees()),
            compass_deg: event.compass.map(|told| f64::from(told.mean.angle().degrees())),
            seen_segments: event.scene.len(),
            used_segments: event.localizer.scene_segment_count(),
            nodes: scores.iter().zip(event.was_candidate).map(standing).collect(),
            decision,
            is_verifying: config.verification.is_some(),
            pose,
            probability,
            rivals,
            scene: event.scene.to_vec(),
            true_pose: event.pose,
            compass: event.compass.map_or(event.pose.heading, |told| told.mean),
            compass_spread: event.compass.map_or(Angle::from_degrees(180.0), |told| told.standard_deviation),
        }
    }

    /// Candidates before the look by falling score, so that the leader is first.
    #[must_use]
    pub fn ranking(&self) -> Vec<(usize, NodeStanding)> {
        let mut ranking =
            self.nodes.iter().copied().enumerate().filter(|(_, node)| node.was_candidate).collect::<Vec<_>>();
        ranking.sort_by(|(_, a), (_, b)| b.score.total_cmp(&a.score));
        ranking
    }

    /// The look in a few lines. `record` tells which nodes would be right.
    #[must_use]
    pub fn to_text(&self, record: &TrialRecord) -> String {
        let ranking = self.ranking();
        let compass = match self.compass_deg {
            None => " (no compass)".to_owned(),
            Some(told) if (told - self.heading_deg).abs() < 0.05 => String::new(),
            Some(told) => format!(" (compass {told:.1})"),
        };
        let mut words = format!(
            "look {:>2}, heading {:>6.1} degrees{compass}: {} segments seen, {} {} {} {}\n",
            self.look,
            self.heading_deg,
            self.seen_segments,
            self.used_segments,
            if self.is_verifying { "checked at poses beside" } else { "matched against" },
            ranking.len(),
            match (self.is_verifying, ranking.len()) {
                (true, 1) => "node",
                (true, _) => "nodes",
                (false, 1) => "candidate",
                (false, _) => "candidates",
            }
        );
        for (rank, (node, standing)) in ranking.iter().enumerate() {
            let is_right = is_right(record, *node);
            if rank < NAMED_NODES || is_right {
                let state = match (self.is_verifying, standing.is_candidate) {
                    (true, _) => "",
                    (false, true) => "  stays",
                    (false, false) => "  drops out",
                };
                let right = if is_right { "  <- one of the two nearest" } else { "" };
                let _ =
                    writeln!(words, "    {:>4}. node {node:>3}  score {:.3}{state}{right}", rank + 1, standing.score);
            }
        }
        if self.is_verifying {
            let _ = writeln!(words, "    -> {}", self.decision);
        } else {
            let left = self.nodes.iter().filter(|node| node.is_candidate).count();
            let _ = writeln!(words, "    {left} left -> {}", self.decision);
        }
        words
    }

    /// The look as a drawing: the image, the plan with the candidates, the scores.
    #[must_use]
    pub fn to_svg(&self, plan: &FloorPlan, camera: &PinholeCamera, record: &TrialRecord) -> SVG {
        let image_size = fitted((f64::from(camera.width_px()), f64::from(camera.height_px())), IMAGE_WIDTH_PX);
        let plan_size = fitted((plan.width_px(), plan.height_px()), WIDTH_PX - IMAGE_WIDTH_PX - 60.0);
        let (left, right, top) = (20.0, IMAGE_WIDTH_PX + 40.0, 54.0);
        let scores_top = top + image_size.1.max(plan_size.1) + 40.0;
        let title = format!("look {} at heading {:.1}°: {}", self.look, self.heading_deg, self.decision);
        let (used, standings) = if self.is_verifying {
            ("checked", "the darker a node, the better the best pose beside it agrees")
        } else {
            ("matched", "full: stays · red: drops out now · hollow: left before")
        };
        let seen = format!("{} segments seen, {} {used}", self.seen_segments, self.used_segments);
        drawing(WIDTH_PX, scores_top + 190.0)
            .add(text("start", (left, 26.0), title).set("class", "title"))
            .add(text("start", (left, 46.0), seen))
            .add(placed(scene_drawing(&self.scene, camera), (left, top), image_size))
            .add(text("start", (right, 46.0), standings))
            .add(placed(self.plan_with_candidates(plan, record), (right, top), plan_size))
            .add(self.score_bars(left, scores_top, WIDTH_PX - 40.0, 140.0, record))
    }

    fn plan_with_candidates(&self, plan: &FloorPlan, record: &TrialRecord) -> SVG {
        let mut marks = Group::new();
        let most = self.nodes.iter().map(|node| node.score).fold(1e-9, f64::max);
        for (node, (standing, &place)) in self.nodes.iter().zip(plan.nodes()).enumerate() {
            let (x, y) = plan.to_px(place);
            let class = match (standing.was_candidate, standing.is_candidate) {
                (_, true) => "candidate",
                (true, false) => "miss",
                (false, false) => "node",
            };
            let label = format!("node {node}: {:.3}", standing.score);
            let mut mark = Circle::new().set("class", class).set("cx", x).set("cy", y).set("r", 8).add(tooltip(label));
            if self.is_verifying {
                mark = mark.set("fill-opacity", tidy((standing.score / most).clamp(0.0, 1.0)));
            }
            marks.append(mark);
        }
        if let Some(pose) = &self.pose {
            let (x, y) = plan.to_px(Point2::new(pose.x_m, pose.y_m));
            let label = format!("answered: {:.2}, {:.2} m", pose.x_m, pose.y_m);
            let mark = Circle::new().set("class", "answer").set("cx", x).set("cy", y).set("r", 11);
            marks.append(mark.add(tooltip(label)));
        }
        for node in [record.nearest_node, record.second_nearest_node] {
            if let Some(&place) = plan.nodes().get(node as usize) {
                let (x, y) = plan.to_px(place);
                marks.append(Circle::new().set("class", "truth").set("cx", x).set("cy", y).set("r", 14));
            }
        }
        let place = self.true_pose.position;
        plan.canvas().add(plan.background()).add(sight(plan, place, self.heading_deg)).add(marks)
    }

    fn score_bars(&self, left: f64, top: f64, width: f64, height: f64, record: &TrialRecord) -> Group {
        let most = self.nodes.iter().map(|node| node.score).fold(1e-9, f64::max);
        let slot = width / self.nodes.len().max(1) as f64;
        let bottom = top + height;
        let title = if self.is_verifying {
            "agreement of the best pose beside each node, over all looks: green = one of the two nearest"
        } else {
            "accumulated score of each node: green = one of the two nearest, blue = candidate, grey = left before"
        };
        let mut bars = Group::new().add(text("start", (left, top - 10.0), title));
        for (node, standing) in self.nodes.iter().enumerate() {
            let class = match (is_right(record, node), standing.was_candidate, standing.is_candidate) {
                (true, ..) => "bar-truth",
                (_, _, true) => "bar-plain",
                (_, true, false) => "bar-bad",
                _ => "bar-out",
            };
            let bar_height = (standing.score / most * height).max(1.0);
            let label = format!("node {node}: {:.3}", standing.score);
            bars.append(
                Rectangle::new()
                    .set("class", class)
                    .set("x", tidy(left + (node as f64 + 0.1) * slot))
                    .set("width", tidy(0.8 * slot))
                    .set("y", tidy(bottom - bar_height))
                    .set("height", tidy(bar_height))
                    .add(tooltip(label)),
            );
            let step = self.nodes.len().div_ceil(36).max(1);
            if node % step == 0 {
                bars.append(text("middle", (left + (node as f64 + 0.5) * slot, bottom + 16.0), node.to_string()));
            }
        }
        bars.append(line("axis", (left, bottom), (left + width, bottom)));
        bars.append(text("end", (left + width, top - 10.0), format!("highest {most:.3}")));
        bars
    }
}

/// Segments as the camera's image shows them; the two colours are the two polarities.
#[must_use]
pub fn scene_drawing(scene: &[Segment2], camera: &PinholeCamera) -> SVG {
    let (width, height) = (f64::from(camera.width_px()), f64::from(camera.height_px()));
    let frame = Rectangle::new().set("class", "frame").set("width", width).set("height", height);
    let mut image = drawing(width, height).add(frame);
    for segment in scene {
        // Both colours depend on how the edge lies in the image, not on the order of its end points.
        let is_down = (segment.start().y, segment.start().x) <= (segment.end().y, segment.end().x);
        let class = match (segment.polarity(), is_down) {
            (Polarity::LeftBrighter, true) | (Polarity::RightBrighter, false) => "edge-left",
            _ => "edge-right",
        };
        let at = |point: Point2| (f64::from(point.x), f64::from(point.y));
        image.append(line(class, at(segment.start()), at(segment.end())));
    }
    image
}

/// A robot on the plan, looking along a heading.
#[must_use]
pub fn sight(plan: &FloorPlan, place: Point2, heading_deg: f64) -> Group {
    let (x, y) = plan.to_px(place);
    let reach = plan.length_px(1.5);
    let corner = |offset_deg: f64| {
        let angle = (heading_deg + offset_deg).to_radians();
        (tidy(x + reach * libm::cos(angle)), tidy(y - reach * libm::sin(angle)))
    };
    let ((left_x, left_y), (right_x, right_y)) = (corner(32.5), corner(-32.5));
    Group::new()
        .add(Path::new().set("class", "sight").set("d", format!("M{x} {y}L{left_x} {left_y}L{right_x} {right_y}z")))
        .add(Circle::new().set("class", "hit").set("cx", x).set("cy", y).set("r", 6).add(tooltip("the robot")))
}

/// A size of the same shape with the given width.
fn fitted((width, height): (f64, f64), target_width: f64) -> (f64, f64) {
    (target_width, height * target_width / width)
}

fn placed(drawing: SVG, (x, y): (f64, f64), (width, height): (f64, f64)) -> SVG {
    drawing.set("x", tidy(x)).set("y", tidy(y)).set("width", tidy(width)).set("height", tidy(height))
}

/// How a trial came out, in words.
#[must_use]
pub fn answer_words(record: &TrialRecord) -> String {
    let mut words = match (record.answered_node, record.answer_distance_m) {
        (Some(node), Some(distance)) => format!("node {node}, {distance:.2} m from the truth"),
        _ => "no answer".to_owned(),
    };
    if let (Some(error_m), Some(error_deg)) = (record.pose_error_m, record.heading_error_deg) {
        let _ = write!(words, ", its pose {error_m:.2} m and {:.1}° off", error_deg.abs());
    }
    words
}

pub(super) fn is_right(record: &TrialRecord, node: usize) -> bool {
    [record.nearest_node as usize, record.second_nearest_node as usize].contains(&node)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    fn look() -> LookExplanation {
        let standing = |score, was_candidate, is_candidate| NodeStanding { score, was_candidate, is_candidate };
        let nodes = vec![
            standing(0.4, false, false),
            standing(1.1, true, true),
            standing(1.3, true, true),
            standing(0.9, true, false),
        ];
        let decision = "look again after a turn of 30 degrees".to_owned();
        let of_posts =
            LookExplanation { look: 2, heading_deg: 30.0, compass_deg: Some(30.0), ..sample::look_at_posts() };
        LookExplanation { seen_segments: 140, used_segments: 90, nodes, decision, scene: Vec::new(), ..of_posts }
    }

    #[test]
    fn the_words_of_the_verifying_localiser_tell_of_no_candidates() {
        let record = &sample::run().results.records[0];
        let words = LookExplanation { is_verifying: true, ..look() }.to_text(record);
        assert!(
            words.contains("90 checked at poses beside 3 nodes") && words.contains("\n    -> look again"),
            "{words}"
        );
        assert!(!words.contains("candidate") && !words.contains("stays") && !words.contains("drops out"), "{words}");
    }

    #[test]
    fn the_words_name_leader_losers_and_truth() {
        let mut record = sample::run().results.records[0].clone();
        (record.nearest_node, record.second_nearest_node) = (3, 1);
        let words = look().to_text(&record);
        let position = |part: &str| words.find(part).unwrap_or_else(|| panic!("{words} lacks {part}"));
        assert!(position("node   2  score 1.300  stays") < position("node   1  score 1.100  stays  <- one of"));
        assert!(position("node   3  score 0.900  drops out  <- one of") < position("2 left -> look again"));
    }

    #[test]
    fn the_words_tell_of_a_compass_that_errs() {
        let record = &sample::run().results.records[0];
        assert!(!look().to_text(record).contains("compass"));
        let none = LookExplanation { compass_deg: None, ..look() };
        assert!(none.to_text(record).contains("heading   30.0 degrees (no compass): "));
        let wrong = LookExplanation { compass_deg: Some(32.5), ..look() };
        assert!(wrong.to_text(record).contains("heading   30.0 degrees (compass 32.5): "));
    }

    #[test]
    fn a_look_can_be_drawn_even_when_nothing_was_seen() {
        let sample = sample::run();
        let plan = FloorPlan::new(Some(&sample.world), None, &sample.results.nodes[0]);
        let svg = look().to_svg(&plan, &PinholeCamera::reference(), &sample.results.records[0]).to_string();
        assert!(svg.contains("look 2 at heading 30.0°") && !svg.contains("NaN"));
    }
}

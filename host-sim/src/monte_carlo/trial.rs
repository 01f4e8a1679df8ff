//! One kidnapped-robot trial, from a random pose to a decision. It reads like the paper's Fig. 1(a).

use super::looks::Looks;
use super::{Outcome, Site, TrialRecord, TruePose, UnknownKind};
use crate::scenario::{Setting, Start};
use edgeloc::database::{NodeId, TopologicalDatabase};
use edgeloc::geometry::{Angle, Heading, Point2, Scene, Segment2};
use edgeloc::localize::{
    Decision, HeadingPrior, Localizer, Look, ObserveError, Rival, Rivals, StartError, UnknownReason,
};
use edgeloc::math;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// Longest message that a record keeps of a panic.
const MESSAGE_CHARS: usize = 200;
/// A rival nearer to the true position than this names the truth \[m\].
const SAME_PLACE_M: f32 = 1.0;
/// A position answered nearer to the true one than this is no blunder, whatever node it is given to \[m\].
const NEAR_TIE_M: f32 = 0.5;

/// What happened at one look, for those who watch a trial.
#[derive(Debug)]
pub struct LookEvent<'a> {
    /// Where the robot truly is.
    pub pose: TruePose,
    /// What the compass told of it, if there is one.
    pub compass: Option<HeadingPrior>,
    /// The segments that the robot saw.
    pub scene: &'a [Segment2],
    /// Which nodes were candidates before this look.
    pub was_candidate: &'a [bool],
    /// The localiser after the look.
    pub localizer: &'a Localizer<'a>,
    /// Its answer.
    pub decision: &'a Result<Decision, ObserveError>,
    /// Wall time of the localiser.
    pub localizer_time: Duration,
}

/// One attempt to localise a robot that was put down at a pose.
#[derive(Debug)]
pub(super) struct Trial<'s> {
    pub(super) site: &'s Site,
    pub(super) setting: &'s Setting,
    pub(super) trial: u32,
    pub(super) map: u32,
    pub(super) map_bytes: u32,
    pub(super) start: TruePose,
}

impl<'s> Trial<'s> {
    /// Lets the robot look around until the localiser decides; tells `watch` of every look.
    ///
    /// A localiser that refuses or panics ends the trial with [`Outcome::Error`] and its words: a failure is counted,
    /// never dropped, and never takes the other trials with it.
    pub(super) fn run(
        &self,
        database: TopologicalDatabase<'_>,
        memory: &mut [u64],
        looks: &mut Looks<'s>,
        watch: impl FnMut(&LookEvent<'_>),
    ) -> TrialRecord {
        let mut record = self.record_at_start(&database);
        // Whatever a panic leaves half done is not read again: the record says so, memory is divided anew.
        let attempt = AssertUnwindSafe(|| self.look_around(&mut record, database, memory, looks, watch));
        let message = match catch_unwind(attempt) {
            Ok(Ok(())) => return record,
            Ok(Err(error)) => error.to_string(),
            Err(panic) => format!("panicked: {}", words_of(panic.as_ref())),
        };
        record.outcome = Outcome::Error;
        record.message = Some(message);
        record
    }

    fn look_around(
        &self,
        record: &mut TrialRecord,
        database: TopologicalDatabase<'_>,
        memory: &mut [u64],
        looks: &mut Looks<'s>,
        mut watch: impl FnMut(&LookEvent<'_>),
    ) -> Result<(), StartError> {
        let mut localizer = Localizer::new(database, &self.setting.localizer_config(), memory)?;
        let (mut pose, mut motion) = (self.start, None);
        loop {
            let was_candidate: Vec<bool> =
                localizer.candidates().scores().iter().map(|node| node.is_candidate()).collect();
            let (look, sources) = (record.looks as usize, &self.setting.scenario.uncertainty);
            let compass = looks.compass_reading(look, pose.heading, sources);
            let scene = looks.scene(look, pose, sources);

            let started = Instant::now();
            let decision =
                localizer.observe(&Look { heading: compass, motion_since_last: motion, scene: Scene::new(scene) });
            let localizer_time = started.elapsed();

            record.looks += 1;
            record.scene_segments += localizer.scene_segment_count() as u32;
            record.scored_nodes += was_candidate.iter().filter(|is_candidate| **is_candidate).count() as u32;
            watch(&LookEvent {
                pose,
                compass,
                scene,
                was_candidate: &was_candidate,
                localizer: &localizer,
                decision: &decision,
                localizer_time,
            });
            match decision {
                Ok(Decision::LookAgain { turn, step_m }) => {
                    let heading = pose.heading.turned(turn).expect("a checked scenario turns by a finite angle");
                    // The base stops at what is in its way.
                    let ahead_m = self.site.free_space.free_way_m(pose.position, heading, step_m);
                    motion = looks.odometry_reading(look + 1, turn, ahead_m, sources);
                    pose = TruePose { position: ahead(pose.position, heading, ahead_m), heading };
                    record.driven_m += ahead_m;
                }
                last => {
                    self.record_end(record, pose, &last, &localizer, &was_candidate);
                    return Ok(());
                }
            }
        }
    }

    fn record_at_start(&self, database: &TopologicalDatabase<'_>) -> TrialRecord {
        let position = self.start.position;
        let [nearest_node, second_nearest_node] = self.site.two_nearest_nodes(position);
        TrialRecord {
            row: self.setting.row.name.clone(),
            trial: self.trial,
            map: self.map,
            true_x_m: position.x,
            true_y_m: position.y,
            true_heading_deg: self.start.heading.angle().degrees(),
            nearest_node,
            second_nearest_node,
            nearest_node_distance_m: self.site.nodes[nearest_node as usize].distance(position),
            outcome: Outcome::Error,
            answered_node: None,
            answer_distance_m: None,
            pose_error_m: None,
            heading_error_deg: None,
            probability: None,
            is_success: false,
            is_truth_named: false,
            is_near_tie: false,
            unknown_kind: None,
            rivals: None,
            end_x_m: position.x,
            end_y_m: position.y,
            driven_m: 0.0,
            looks: 0,
            scene_segments: 0,
            scored_nodes: 0,
            leader_score: 0.0,
            runner_up_score: 0.0,
            truth_score: None,
            map_bytes: self.map_bytes,
            map_segments: database.segment_count() as u32,
            message: None,
        }
    }

    /// Whether one of the rivals is where the robot is.
    fn is_among(&self, rivals: &Rivals, position: Point2, nearest_node: u32) -> bool {
        let is_here = |rival: &Rival| rival.node.0 == nearest_node || rival.position.distance(position) <= SAME_PLACE_M;
        self.setting.row.start != Start::Unlearned && rivals.iter().any(is_here)
    }

    fn record_end(
        &self,
        record: &mut TrialRecord,
        TruePose { position, heading }: TruePose,
        decision: &Result<Decision, ObserveError>,
        localizer: &Localizer<'_>,
        was_candidate: &[bool],
    ) {
        // The answer is of where the robot stands now.
        (record.end_x_m, record.end_y_m) = (position.x, position.y);
        [record.nearest_node, record.second_nearest_node] = self.site.two_nearest_nodes(position);
        record.nearest_node_distance_m = self.site.nodes[record.nearest_node as usize].distance(position);
        match decision {
            Ok(Decision::Localized(localized)) => {
                record.outcome = Outcome::Localized;
                record.answered_node = Some(localized.node.0);
                let answered = self.site.nodes.get(localized.node.0 as usize);
                record.answer_distance_m = answered.map(|node| node.distance(position));
                record.pose_error_m = localized.pose.map(|pose| pose.position.distance(position));
                record.heading_error_deg = localized.pose.map(|pose| {
                    let error_rad = pose.heading.angle().radians() - heading.angle().radians();
                    Angle::from_radians(error_rad).wrapped().degrees()
                });
                record.probability = localized.probability;
            }
            Ok(Decision::Unknown { reason }) => {
                record.outcome = Outcome::Unknown;
                record.unknown_kind = Some(kind_of(reason));
                if let UnknownReason::Indistinguishable(rivals) = reason {
                    record.rivals = Some(rivals_in_words(rivals)).filter(|words| !words.is_empty());
                    record.is_truth_named = self.is_among(rivals, position, record.nearest_node);
                }
            }
            // A look more is never the last decision.
            Ok(Decision::LookAgain { .. }) => record.outcome = Outcome::Unknown,
            Err(error) => {
                record.outcome = Outcome::Error;
                record.message = Some(error.to_string());
            }
        }
        let nearest = [record.nearest_node, record.second_nearest_node];
        record.is_success = match self.setting.row.start {
            Start::Near | Start::Anywhere => record.answered_node.is_some_and(|node| nearest.contains(&node)),
            Start::Unlearned => record.outcome == Outcome::Unknown,
        };
        record.is_truth_named |= record.is_success;
        let is_close = record.pose_error_m.is_some_and(|error_m| error_m <= NEAR_TIE_M);
        record.is_near_tie = is_close && !record.is_success && self.setting.row.start != Start::Unlearned;

        let scores = localizer.candidates().scores();
        let leader = localizer.candidates().leading_node().map(|(node, _)| node);
        let score_of = |node: u32| scores[node as usize].as_f64();
        let in_last_look = (0..scores.len() as u32).filter(|node| was_candidate[*node as usize]);
        record.leader_score = leader.map_or(0.0, |node| score_of(node.0));
        record.runner_up_score =
            in_last_look.filter(|node| Some(NodeId(*node)) != leader).map(score_of).fold(0.0, f64::max);
        record.truth_score =
            nearest.into_iter().filter(|node| was_candidate[*node as usize]).map(score_of).reduce(f64::max);
    }
}

/// The point `ahead_m` from `position` along `heading`.
fn ahead(position: Point2, heading: Heading, ahead_m: f32) -> Point2 {
    let (sin, cos) = math::sin_cos(heading.angle().radians());
    Point2::new(position.x + ahead_m * cos, position.y + ahead_m * sin)
}

/// Why there is no answer, without the details.
fn kind_of(reason: &UnknownReason) -> UnknownKind {
    match reason {
        UnknownReason::SceneTooPoor => UnknownKind::SceneTooPoor,
        UnknownReason::OutsideMap => UnknownKind::OutsideMap,
        UnknownReason::Indistinguishable(_) => UnknownKind::Indistinguishable,
    }
}

/// The rivals as a column of the record.
fn rivals_in_words(rivals: &Rivals) -> String {
    let words = |rival: &Rival| {
        let (node, at, probability) = (rival.node.0, rival.position, rival.probability);
        format!("{node}@{:.2},{:.2}:{probability:.3}", at.x, at.y)
    };
    rivals.iter().map(words).collect::<Vec<_>>().join(" ")
}

/// What a panic said.
fn words_of(panic: &(dyn Any + Send)) -> String {
    let words = panic.downcast_ref::<&str>().map(|words| (*words).to_owned());
    let words = words.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "without words".to_owned());
    words.chars().take(MESSAGE_CHARS).collect()
}

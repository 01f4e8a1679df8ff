//! Where to look next: the view that is predicted to tell the best place from its rivals.
//!
//! What would be seen from the best place is drawn as if it were seen; the lead that the best would have then over its
//! best rival, all looks together, is what the look is worth. A robot that has looked all around and still can't tell
//! moves a little, where its best place has room for it.

use super::check::{Checker, Closeness};
use super::clear_way::clear_way_m;
use super::hypothesis::Hypothesis;
use super::judgement::seen_weight;
use super::kept_looks::{KeptLooks, LEAST_MOVE_M, LookPose};
use super::models::Model;
use super::moves::Moves;
use super::{Evidence, SeenSegment};
use crate::database::{Node, TopologicalDatabase};
use crate::geometry::{Angle, Point2};
use crate::math;

/// Rivals that a look is to tell the best place from.
const RIVALS: usize = 3;
/// Rivals are at least this far from the best place and from each other \[m\].
const RIVAL_APART_M: f32 = 1.0;
/// How closely predictions are compared.
const CLOSENESS: Closeness = Closeness { position_m: 0.03, heading_rad: 0.0, spacing_px: 14.0 };
/// Directions that a move may take.
const DIRECTIONS: u16 = 12;
/// A robot stops this far before an edge \[m\].
const STANDOFF_M: f32 = 0.4;

/// The best place and its rivals.
#[derive(Debug)]
struct Contest {
    places: [Hypothesis; 1 + RIVALS],
    count: usize,
}

impl Contest {
    /// Of hypotheses, the best first.
    fn of(hypotheses: &[Hypothesis], database: &TopologicalDatabase<'_>) -> Option<Self> {
        let mut contest = Self { places: [*hypotheses.first()?; 1 + RIVALS], count: 1 };
        for hypothesis in hypotheses {
            let here = hypothesis.world_position(database);
            let is_apart = |other: &Hypothesis| other.world_position(database).distance(here) > RIVAL_APART_M;
            if contest.count < contest.places.len() && contest.places[..contest.count].iter().all(is_apart) {
                contest.places[contest.count] = *hypothesis;
                contest.count += 1;
            }
        }
        Some(contest)
    }

    const fn best(&self) -> &Hypothesis {
        &self.places[0]
    }

    fn rivals(&self) -> &[Hypothesis] {
        &self.places[1..self.count]
    }
}

/// The turn to the view that tells most, of those `turn` apart that were not looked at from here; `turn` where all were.
pub(super) fn most_telling_turn(
    hypotheses: &[Hypothesis],
    turn: Angle,
    max_looks: u16,
    database: &TopologicalDatabase<'_>,
    checker: &mut Checker<'_>,
    looks: &mut KeptLooks<'_>,
) -> Angle {
    let (Some(contest), Some(last)) = (Contest::of(hypotheses, database), looks.here().last().copied()) else {
        return turn;
    };
    let mut best: Option<(f32, Angle)> = None;
    let around = (core::f32::consts::TAU / math::max(math::abs(turn.radians()), 0.01) + 0.5) as u16;
    for step in 1..max_looks.min(around) {
        let onward = Angle::from_radians(turn.radians() * f32::from(step)).wrapped();
        let ahead = LookPose { heading_rad: last.heading_rad + onward.radians(), ..last };
        let apart_rad =
            |look: &LookPose| math::abs(Angle::from_radians(look.heading_rad - ahead.heading_rad).wrapped().radians());
        if looks.here().iter().any(|look| apart_rad(look) < 0.5 * math::abs(turn.radians())) {
            continue;
        }
        let worth = worth_of_look(&contest, &ahead, database, checker, looks);
        if best.is_none_or(|(most, _)| worth > most) {
            best = Some((worth, onward));
        }
    }
    best.map_or(turn, |(_, turn)| turn)
}

/// The turn and the way ahead \[m\] that lead to the view that tells most, among those with the most room.
pub(super) fn most_telling_move(
    hypotheses: &[Hypothesis],
    move_m: f32,
    moves: &Moves,
    database: &TopologicalDatabase<'_>,
    checker: &mut Checker<'_>,
    looks: &mut KeptLooks<'_>,
) -> (Angle, f32) {
    let straight = (Angle::from_radians(0.0), move_m);
    let (Some(contest), Some(last)) = (Contest::of(hypotheses, database), looks.here().last().copied()) else {
        return straight;
    };
    let best_place = contest.best();
    let Some(node) = database.node(best_place.node()) else { return straight };
    let (model, offset_m) = model_at(best_place, node, &last, database);
    let mut best: Option<([f32; 2], Angle)> = None;
    for direction in 0..DIRECTIONS {
        let turn = Angle::from_degrees(360.0 / f32::from(DIRECTIONS) * f32::from(direction)).wrapped();
        let heading_rad = last.heading_rad + turn.radians();
        if moves.is_blocked(heading_rad) {
            continue;
        }
        let sin_cos = math::sin_cos(heading_rad + best_place.heading_error_rad);
        let clear_m = clear_way_m(&model.node, offset_m, sin_cos, move_m + STANDOFF_M);
        // What blocks the way is known in part: where all seems blocked the robot tries.
        let step_m = math::max(clear_m - STANDOFF_M, LEAST_MOVE_M);
        if best.is_some_and(|([most_m, _], _)| step_m < most_m) {
            continue;
        }
        let (sin, cos) = math::sin_cos(heading_rad);
        let way_m = [last.way_m[0] + step_m * cos, last.way_m[1] + step_m * sin];
        let worth = worth_of_look(&contest, &LookPose { heading_rad, way_m, ..last }, database, checker, looks);
        if best.is_none_or(|([most_m, most], _)| step_m > most_m || worth > most) {
            best = Some(([step_m, worth], turn));
        }
    }
    best.map_or(straight, |([step_m, _], turn)| (turn, step_m))
}

/// The lead that the best place is predicted to have over its best rival after a look from `ahead`, times the weight of
/// what is seen then.
fn worth_of_look(
    contest: &Contest,
    ahead: &LookPose,
    database: &TopologicalDatabase<'_>,
    checker: &mut Checker<'_>,
    looks: &mut KeptLooks<'_>,
) -> f32 {
    let (count, seen_q4) = predict(contest.best(), ahead, database, checker, looks.spare());
    checker.draw_segments(&looks.spare()[..count]);
    let seen_q4 = looks.seen_q4().saturating_add(seen_q4);
    let mut score_q20 = |place: &Hypothesis| {
        let look = evidence_for(place, ahead, database, checker);
        place.evidence.plus(look).score_q20(seen_q4)
    };
    let best_q20 = score_q20(contest.best());
    let lead_q20 = contest.rivals().iter().map(|rival| best_q20 - score_q20(rival)).min().unwrap_or(best_q20);
    lead_q20 as f32 / (1 << 20) as f32 * seen_weight(looks.segment_count() + count as u32)
}

/// What a camera at `place` sees from `ahead`, into `storage`; the number of segments and their length in Q4 px.
fn predict(
    place: &Hypothesis,
    ahead: &LookPose,
    database: &TopologicalDatabase<'_>,
    checker: &mut Checker<'_>,
    storage: &mut [SeenSegment],
) -> (usize, i32) {
    let Some(node) = database.node(place.node()) else { return (0, 0) };
    let (model, offset_m) = model_at(place, node, ahead, database);
    checker.turn(&model.node, ahead.heading_rad + place.heading_error_rad, (offset_m, 0.05));
    let offset = checker.in_camera(offset_m);
    let (mut count, mut seen_q4) = (0, 0_i32);
    for segment in checker.view() {
        let Some(image) = checker.project(segment, offset) else { continue };
        let point = |[x, y]: [f32; 2]| Point2::new(x, y);
        let Some(seen) = SeenSegment::predicted(point(image.start_px), point(image.end_px), checker.filter()) else {
            continue;
        };
        let Some(place) = storage.get_mut(count) else { break };
        *place = seen;
        count += 1;
        seen_q4 = seen_q4.saturating_add(seen.length_q4());
    }
    (count, seen_q4)
}

/// The model that tells what is seen from `place` at `ahead`, and where that is from its node, axes of the world \[m\].
fn model_at<'m>(
    place: &Hypothesis,
    node: Node<'m>,
    ahead: &LookPose,
    database: &TopologicalDatabase<'m>,
) -> (Model<'m>, [f32; 2]) {
    let offset_m = place.offset_at(ahead);
    let elsewhere = Model::elsewhere(ahead, &node, offset_m, database);
    let model = elsewhere.unwrap_or(Model::own(node));
    (model, model.offset(offset_m))
}

/// What speaks for `place` in what is drawn as seen from `ahead`.
fn evidence_for(
    place: &Hypothesis,
    ahead: &LookPose,
    database: &TopologicalDatabase<'_>,
    checker: &mut Checker<'_>,
) -> Evidence {
    let Some(node) = database.node(place.node()) else { return Evidence::default() };
    let (model, offset_m) = model_at(place, node, ahead, database);
    checker.turn(&model.node, ahead.heading_rad + place.heading_error_rad, (offset_m, 0.05));
    checker.evidence(offset_m, &CLOSENESS)
}

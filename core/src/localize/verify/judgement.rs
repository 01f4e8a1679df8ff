//! From hypotheses to a decision: how sure is the best, and which are its rivals.

use super::hypothesis::Hypothesis;
use super::kept_looks::KeptLooks;
use crate::database::{Node, TopologicalDatabase};
use crate::geometry::Point2;
use crate::localize::{Rival, Rivals};
use crate::math;

/// Hypotheses nearer to each other than this are the same place \[m\].
const PLACE_RADIUS_M: f32 = 1.0;
/// Slope of the log odds of two places over the confidence of one over the other.
const LOG_ODDS_PER_CONFIDENCE: f32 = 15.0;

/// What the hypotheses come to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Judgement {
    pub(super) best: Hypothesis,
    /// Lead over the best rival, times the [weight of what was seen](seen_weight).
    pub(super) confidence: f32,
    /// How far the best lies from the node nearest to it \[m\].
    pub(super) from_node_m: f32,
    /// The best and its rivals, with probabilities that sum to one.
    pub(super) places: Rivals,
}

/// Judges hypotheses, the best first; `None` when there are none.
pub(super) fn judge(
    hypotheses: &[Hypothesis],
    database: &TopologicalDatabase<'_>,
    looks: &KeptLooks<'_>,
) -> Option<Judgement> {
    let best = *hypotheses.first()?;
    let last = looks.pose(looks.count().saturating_sub(1));
    let scale = seen_weight(looks.segment_count()) / (1 << 20) as f32;
    let behind = |hypothesis: &Hypothesis| (best.score_q20 - hypothesis.score_q20) as f32 * scale;
    let mut places = Rivals::default();
    let mut confidence = f32::INFINITY;
    let mut from_node_m = 0.0;
    for next in hypotheses {
        let here = next.world_position_at(&last, database);
        if places.iter().any(|place: &Rival| place.position.distance(here) <= PLACE_RADIUS_M) {
            continue;
        }
        let nearest = nearest_node(database, here);
        match places.iter().count() {
            0 => from_node_m = nearest.map_or(0.0, |node| node.position().distance(here)),
            1 => confidence = behind(next),
            _ => {}
        }
        let odds = math::exp(-LOG_ODDS_PER_CONFIDENCE * behind(next));
        if !places.push(Rival {
            node: nearest.map(|node| node.id()).unwrap_or_default(),
            position: here,
            probability: odds,
        }) {
            break;
        }
    }
    places.normalize();
    Some(Judgement { best, confidence, from_node_m, places })
}

/// Weight of a lead: each segment is a witness, and their errors average out. Thirty of them weigh one.
pub(super) fn seen_weight(segment_count: u32) -> f32 {
    math::sqrt(segment_count as f32 / 30.0)
}

/// The node nearest to a position.
pub(super) fn nearest_node<'m>(database: &TopologicalDatabase<'m>, position: Point2) -> Option<Node<'m>> {
    let mut nearest: Option<(f32, Node<'m>)> = None;
    for node in database.nodes() {
        let distance = node.position().distance(position);
        if nearest.is_none_or(|(least, _)| distance < least) {
            nearest = Some((distance, node));
        }
    }
    nearest.map(|(_, node)| node)
}

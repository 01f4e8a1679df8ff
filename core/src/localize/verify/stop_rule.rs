//! When the best place is sure enough to be answered.
//!
//! A sequential test: the lead of the best place over its best rival says whether it is that place rather than another of
//! the map, and its agreement with what was seen, measured against the map's agreement with itself, whether it is in the
//! map at all. Early, both have to be clear, the first look alone most of all; what agreement lacks a lead may make up for.
//! The more the robot has looked around, the less is asked: what it could not learn by then no turn will tell. A place at
//! the edge of what the nodes cover is most often one beyond it, seen along the same line of sight: more is asked there.

use super::judgement::Judgement;
use crate::math;

/// Confidence that the first look alone asks for, in confidences asked for.
const FIRST_CONFIDENCE: f32 = 1.25;
/// Segments a node beyond which a map is crowded: by chance places resemble each other more, and the first look alone has
/// to say more, in proportion up to [`MOST_CROWDED`]. Set between offices (360 a node, joined) and a furnished flat (700).
const CROWDED: f32 = 540.0;
/// The most that a crowded map asks of the first look, in what others ask.
const MOST_CROWDED: f32 = 1.5;
/// Having looked all around, before a move.
const AROUND_CONFIDENCE: f32 = 0.45;
/// When nothing is left to look at.
const LAST_CONFIDENCE: f32 = 0.18;
/// Agreement asked for where turns are left, as a share of the map's with itself, at the confidence asked for.
const ASKED_AGREEMENT: f32 = 1.2;
/// How much less agreement does for a confidence that is greater by one.
const AGREEMENT_PER_CONFIDENCE: f32 = 0.3;
/// The least that does, however clear the lead.
const LEAST_AGREEMENT: f32 = 0.9;
/// The least that does when nothing is left to look at: with less the robot is outside the map.
const INSIDE_AGREEMENT: f32 = 0.75;
/// The least at which a move is worth it: from elsewhere more may agree.
const DOUBTFUL_AGREEMENT: f32 = 0.55;
/// Segments of a look that may contradict a place, however well others agree with it.
const TELLING_SEGMENTS: usize = 75;
/// Such a look contradicts a place that it agrees less with than this.
const CONTRADICTION: f32 = 0.25;
/// A lead this clear no look contradicts: the map may have changed; in confidences asked for.
const BEYOND_DOUBT: f32 = 2.5;
/// Farther than this from every node a place is at the edge, as a share of the nodes' spacing.
const EDGE: f32 = 0.68;
/// Lead asked for at the edge, in leads asked for elsewhere.
const EDGE_LEAD: f32 = 2.0;
/// A telling look contradicts a place at the edge that it agrees less with than this, whatever the lead.
const EDGE_CONTRADICTION: f32 = 0.4;
/// The map's agreement with itself, where it was not measured: what a good calibration gives.
const USUAL_AGREEMENT: f32 = 0.5;

/// How much of what can be looked at was.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Looked {
    /// Once.
    Once,
    /// More often, and there are turns left.
    Partly,
    /// All around; a move is left.
    AllAround,
    /// Nothing is left to look at.
    AtEverything,
}

/// What is asked of an answer.
#[derive(Debug)]
pub(super) struct StopRule {
    confidence: f32,
    first_confidence: f32,
    self_agreement: f32,
    edge_m: f32,
}

/// What the rule has to know of a map.
#[derive(Debug, Clone, Copy)]
pub(super) struct MapTraits {
    /// Its agreement with itself, as far as it was measured.
    pub(super) self_agreement: Option<f32>,
    /// How far its nodes lie apart in the mean \[m\].
    pub(super) spacing_m: f32,
    /// Segments of a node's model in the mean.
    pub(super) segments_per_node: f32,
}

impl StopRule {
    /// The rule for a map.
    pub(super) fn new(confidence: f32, map: &MapTraits) -> Self {
        let crowded = math::max(1.0, math::min(map.segments_per_node / CROWDED, MOST_CROWDED));
        Self {
            confidence,
            first_confidence: FIRST_CONFIDENCE * crowded,
            self_agreement: map.self_agreement.unwrap_or(USUAL_AGREEMENT),
            edge_m: EDGE * map.spacing_m,
        }
    }

    /// Whether lead and agreement of the best place suffice.
    pub(super) fn suffices(&self, judgement: &Judgement, looked: Looked) -> bool {
        let (lead, agreement) = (judgement.confidence, self.agreement(judgement.best.score_q20));
        let made_up = AGREEMENT_PER_CONFIDENCE * (lead - self.confidence);
        let early = math::max(ASKED_AGREEMENT - made_up, LEAST_AGREEMENT);
        let (least_lead, least_agreement) = match looked {
            Looked::Once => (self.first_confidence, early),
            Looked::Partly => (1.0, early),
            Looked::AllAround => (AROUND_CONFIDENCE, LEAST_AGREEMENT),
            Looked::AtEverything => (LAST_CONFIDENCE, INSIDE_AGREEMENT),
        };
        let at_edge = if self.is_at_edge(judgement) { EDGE_LEAD } else { 1.0 };
        lead > at_edge * least_lead * self.confidence && agreement >= least_agreement
    }

    /// Whether the best place agrees well enough for the robot to be in the map.
    pub(super) fn is_inside(&self, judgement: &Judgement) -> bool {
        self.agreement(judgement.best.score_q20) >= INSIDE_AGREEMENT
    }

    /// Whether another view might show that the robot is in the map.
    pub(super) fn may_be_inside(&self, judgement: &Judgement) -> bool {
        self.agreement(judgement.best.score_q20) >= DOUBTFUL_AGREEMENT
    }

    /// Whether the lead is so clear that no look contradicts it.
    pub(super) fn is_beyond_doubt(&self, judgement: &Judgement) -> bool {
        judgement.confidence > BEYOND_DOUBT * self.confidence && !self.is_at_edge(judgement)
    }

    /// Whether a look of so many segments that agrees so contradicts the best place.
    pub(super) fn contradicts(&self, judgement: &Judgement, segment_count: usize, score_q20: i32) -> bool {
        let least = if self.is_at_edge(judgement) { EDGE_CONTRADICTION } else { CONTRADICTION };
        segment_count >= TELLING_SEGMENTS && self.agreement(score_q20) < least
    }

    /// Whether the best place lies at the edge of what the nodes cover.
    fn is_at_edge(&self, judgement: &Judgement) -> bool {
        judgement.from_node_m > self.edge_m
    }

    /// A score as a share of the map's agreement with itself.
    fn agreement(&self, score_q20: i32) -> f32 {
        score_q20 as f32 / (1 << 20) as f32 / self.self_agreement
    }
}

#[cfg(test)]
mod tests {
    use super::super::hypothesis::Hypothesis;
    use super::*;
    use crate::database::NodeId;
    use crate::localize::Rivals;

    const MAP: MapTraits = MapTraits { self_agreement: Some(0.5), spacing_m: 1.5, segments_per_node: 360.0 };

    fn judgement(confidence: f32, agreement: f32) -> Judgement {
        let score_q20 = (agreement * 0.5 * (1 << 20) as f32) as i32;
        let best = Hypothesis { score_q20, ..Hypothesis::new(NodeId(0), [0.0; 2], 0.0) };
        Judgement { best, confidence, from_node_m: 0.5, places: Rivals::default() }
    }

    #[test]
    fn the_more_was_looked_at_the_less_is_asked() {
        let rule = StopRule::new(0.4, &MAP);
        let asked = [Looked::Once, Looked::Partly, Looked::AllAround, Looked::AtEverything];
        for (confidence, expected) in [(0.6, 4), (0.5, 3), (0.3, 2), (0.1, 1), (0.05, 0)] {
            let judgement = judgement(confidence, 1.3);
            let sufficed = asked.iter().filter(|looked| rule.suffices(&judgement, **looked)).count();
            assert_eq!(sufficed, expected, "{confidence}");
        }
    }

    #[test]
    fn a_clear_lead_makes_up_for_agreement_but_not_for_any() {
        let rule = StopRule::new(0.4, &MAP);
        let suffices = |confidence, agreement| rule.suffices(&judgement(confidence, agreement), Looked::Partly);
        assert!(suffices(0.45, 1.25) && !suffices(0.45, 1.1));
        assert!(suffices(0.8, 1.1) && !suffices(0.8, 1.0));
        assert!(suffices(5.0, 0.91) && !suffices(5.0, 0.89));
    }

    #[test]
    fn a_rich_look_that_agrees_with_nothing_contradicts_and_a_poor_one_does_not() {
        let rule = StopRule::new(0.4, &MAP);
        let best = judgement(0.5, 1.0);
        let contradicts = |count, score_q20| rule.contradicts(&best, count, score_q20);
        assert!(contradicts(100, 0) && !contradicts(10, 0) && !contradicts(100, 1 << 18));
    }

    #[test]
    fn in_a_crowded_map_the_first_look_has_to_say_more() {
        let suffices = |segments_per_node, looked| {
            StopRule::new(0.4, &MapTraits { segments_per_node, ..MAP }).suffices(&judgement(0.55, 1.3), looked)
        };
        assert!(suffices(500.0, Looked::Once) && !suffices(700.0, Looked::Once));
        assert!(suffices(700.0, Looked::Partly));
    }

    #[test]
    fn at_the_edge_of_what_the_nodes_cover_twice_the_lead_is_asked_and_looks_contradict_sooner() {
        let rule = StopRule::new(0.4, &MAP);
        let at = |from_node_m| Judgement { from_node_m, ..judgement(1.2, 1.3) };
        let (inner, edge) = (at(1.0), at(1.05));
        assert!(rule.is_beyond_doubt(&inner) && !rule.is_beyond_doubt(&edge));
        let third_q20 = (0.5 * 0.33 * (1 << 20) as f32) as i32;
        assert!(rule.contradicts(&edge, 100, third_q20) && !rule.contradicts(&inner, 100, third_q20));
        let suffices = |confidence| rule.suffices(&Judgement { confidence, ..edge }, Looked::Partly);
        assert!(suffices(0.85) && !suffices(0.75));
    }

    #[test]
    fn without_a_measured_agreement_a_usual_one_is_assumed() {
        let rule_of = |self_agreement| StopRule::new(0.4, &MapTraits { self_agreement, ..MAP });
        let (known, unknown) = (rule_of(Some(USUAL_AGREEMENT)), rule_of(None));
        for agreement in [0.7, 0.8] {
            let judgement = judgement(1.0, agreement);
            assert_eq!(known.is_inside(&judgement), unknown.is_inside(&judgement));
        }
    }
}

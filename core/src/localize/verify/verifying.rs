//! The verifying localiser: poses around every node, checked against all looks.

use super::VerificationConfig;
use super::check::Checker;
use super::hypothesis::Hypothesis;
use super::judgement::{Judgement, judge, nearest_node};
use super::kept_looks::KeptLooks;
use super::memory::Memory;
use super::pose_fit::fit;
use super::search::Search;
use super::shortlist::Shortlist;
use super::slots::Slots;
use crate::database::{NodeId, TopologicalDatabase};
use crate::geometry::{Angle, Heading, Point2};
use crate::localize::extent::Extent;
use crate::localize::first_stage::FirstStage;
use crate::localize::segment_filter::SegmentFilter;
use crate::localize::{
    CandidateSet, Decision, Localized, LocalizerConfig, Look, ObserveError, PoseEstimate, StartError, UnknownReason,
};

/// An attempt that saw less than this in all looks was too poor to tell \[px\].
const POOR_PX: i32 = 300;
/// After the last look a lead of this part of the confidence asked for is enough.
const LAST_CONFIDENCE: f32 = 0.16;
/// Agreement that an answer asks for, before the last look and after it, as a share of the map's agreement with itself:
/// with less the robot is outside the map.
const LEAST_AGREEMENTS: [f32; 2] = [0.95, 0.75];
/// The map's agreement with itself, where it was not measured: what a good calibration gives.
const USUAL_AGREEMENT: f32 = 0.5;
/// Rivals less likely than this are not named.
const LEAST_PROBABILITY: f32 = 0.01;

/// Tells a pose, look by look.
#[derive(Debug)]
pub(in crate::localize) struct VerifyingLocalizer<'m> {
    database: TopologicalDatabase<'m>,
    config: LocalizerConfig,
    confidence: f32,
    /// Scores that an answer asks for, before the last look and after it, in Q20.
    least_scores_q20: [i32; 2],
    checker: Checker<'m>,
    looks: KeptLooks<'m>,
    shortlist: Option<Shortlist<'m>>,
    search: Search<'m>,
    candidates: CandidateSet<'m>,
    is_finished: bool,
}

impl<'m> VerifyingLocalizer<'m> {
    /// A localiser in `database`, working in `memory`, with `config` unchecked as yet.
    pub(in crate::localize) fn new(
        database: TopologicalDatabase<'m>,
        config: &LocalizerConfig,
        verification: &VerificationConfig,
        memory: &'m mut [u64],
    ) -> Result<Self, StartError> {
        let config = config.checked().map_err(StartError::Config)?;
        let extent = Extent::of(&config, &database);
        let memory = Memory::divide(memory, &config, verification, extent).map_err(StartError::Memory)?;
        let index = database.index().filter(|_| extent.has_first_stage());
        let shortlist = index.map(|index| {
            let stage = FirstStage::new(*index, database.rig().camera, memory.similarities);
            Shortlist::new(stage, memory.codes, memory.chosen)
        });
        let search_memory = (memory.cells, memory.ranked, memory.refined, memory.children);
        Ok(Self {
            database,
            config,
            confidence: verification.confidence,
            least_scores_q20: LEAST_AGREEMENTS.map(|share| {
                let agreement = share * database.self_agreement().unwrap_or(USUAL_AGREEMENT);
                (agreement * (1 << 20) as f32) as i32
            }),
            checker: Checker::new(database.rig(), SegmentFilter::new(&config), memory.planes, memory.view),
            looks: KeptLooks::new(memory.poses, memory.segments),
            shortlist,
            search: Search::new(verification, &database, Slots::new(memory.slots), search_memory),
            candidates: CandidateSet::new(memory.node_scores),
            is_finished: false,
        })
    }

    /// Takes one look into account and decides.
    pub(in crate::localize) fn observe(&mut self, look: &Look<'_>) -> Result<Decision, ObserveError> {
        if self.is_finished {
            self.reset();
        }
        if !self.looks.can_place(look.heading, look.motion_since_last) {
            return Err(ObserveError::HeadingMissing);
        }
        let (filter, frame) = (*self.checker.filter(), *self.checker.frame());
        self.looks.push((look.heading, look.motion_since_last), look.scene.segments(), &filter, &frame);
        if let Some(shortlist) = &mut self.shortlist {
            shortlist.keep(self.looks.count() - 1, look.scene.segments());
        }
        self.search.look(&self.database, &mut self.checker, &self.looks, self.shortlist.as_mut());
        let Self { search, candidates, .. } = self;
        let score = |hypothesis: &Hypothesis| (hypothesis.node(), i64::from(hypothesis.score_q20) << 10);
        candidates.replace(search.places().iter().chain(search.ranked()).map(score));
        if search.slots().are_chosen() {
            candidates.restrict(search.slots().nodes());
        }
        let decision = self.decide();
        self.is_finished = !matches!(decision, Decision::LookAgain { .. });
        Ok(decision)
    }

    /// Forgets all looks.
    pub(in crate::localize) fn reset(&mut self) {
        self.looks.clear();
        self.shortlist.iter_mut().for_each(Shortlist::clear);
        self.checker.forget();
        self.search.clear();
        self.candidates.reset();
        self.is_finished = false;
    }

    /// The score of the best pose beside each node.
    pub(in crate::localize) const fn candidates(&self) -> &CandidateSet<'m> {
        &self.candidates
    }

    /// Segments of the last look that entered.
    pub(in crate::localize) fn scene_segment_count(&self) -> usize {
        self.looks.count().checked_sub(1).map_or(0, |last| self.looks.segments(last).len())
    }

    fn decide(&mut self) -> Decision {
        let has_looked_enough = self.looks.is_full();
        let is_poor = self.looks.seen_q4() < POOR_PX * 16;
        let judgement = judge(self.search.places(), &self.database, self.looks.segment_count());
        match judgement {
            Some(judgement) if !is_poor && self.is_sure(&judgement, has_looked_enough) => {
                Decision::Localized(self.localized(&judgement))
            }
            _ if !has_looked_enough => Decision::LookAgain { turn: self.config.turn },
            Some(_) | None if is_poor => Decision::Unknown { reason: UnknownReason::SceneTooPoor },
            Some(judgement) if !self.is_outside(&judgement, true) => {
                let mut rivals = judgement.places;
                rivals.retain_likelier(LEAST_PROBABILITY);
                Decision::Unknown { reason: UnknownReason::Indistinguishable(rivals) }
            }
            _ => Decision::Unknown { reason: UnknownReason::OutsideMap },
        }
    }

    fn is_sure(&self, judgement: &Judgement, is_last_look: bool) -> bool {
        let asked = if is_last_look { self.confidence * LAST_CONFIDENCE } else { self.confidence };
        judgement.confidence > asked && !self.is_outside(judgement, is_last_look)
    }

    /// The answer: the pose at the last look, and the node nearest to it.
    fn localized(&mut self, judgement: &Judgement) -> Localized {
        let best = &judgement.best;
        let fitted = fit(best, &self.database, &mut self.checker, &self.looks);
        let last = self.looks.pose(self.looks.count().saturating_sub(1));
        let from = self.database.node(best.node()).map_or(Point2::default(), |node| node.position());
        let position =
            Point2::new(from.x + fitted.offset_m[0] + last.way_m[0], from.y + fitted.offset_m[1] + last.way_m[1]);
        let heading = Heading::new(Angle::from_radians(last.heading_rad + fitted.heading_error_rad));
        let pose = PoseEstimate { position, heading: heading.unwrap_or_default(), covariance: fitted.covariance };
        let node: NodeId = nearest_node(&self.database, position);
        let probability = judgement.places.iter().next().map(|place| place.probability);
        Localized { node, pose: Some(pose), probability }
    }

    /// Whether even the best place agrees too little with what was seen.
    fn is_outside(&self, judgement: &Judgement, is_last_look: bool) -> bool {
        judgement.best.score_q20 < self.least_scores_q20[usize::from(is_last_look)]
    }
}

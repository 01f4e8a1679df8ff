//! The verifying localiser: poses around every node, checked against all looks.

use super::check::Checker;
use super::hypothesis::Hypothesis;
use super::judgement::{Judgement, judge, nearest_node};
use super::kept_looks::KeptLooks;
use super::memory::Memory;
use super::moves::Moves;
use super::next_look::{most_telling_move, most_telling_turn};
use super::pose_fit::fit;
use super::search::{Search, agreement_of_look};
use super::shortlist::Shortlist;
use super::slots::Slots;
use super::spacing::mean_spacing_m;
use super::stop_rule::{Looked, MapTraits, StopRule};
use super::{NextLook, VerificationConfig};
use crate::database::TopologicalDatabase;
use crate::geometry::{Angle, Heading, Point2};
use crate::localize::extent::Extent;
use crate::localize::first_stage::FirstStage;
use crate::localize::segment_filter::SegmentFilter;
use crate::localize::{
    CandidateSet, Decision, Localized, LocalizerConfig, Look, ObserveError, PoseEstimate, StartError, UnknownReason,
};

/// An attempt that saw less than this in all looks was too poor to tell \[px\].
const POOR_PX: i32 = 300;
/// Rivals less likely than this are not named.
const LEAST_PROBABILITY: f32 = 0.01;

/// Tells a pose, look by look.
#[derive(Debug)]
pub(in crate::localize) struct VerifyingLocalizer<'m> {
    database: TopologicalDatabase<'m>,
    config: LocalizerConfig,
    verification: VerificationConfig,
    moves: Moves,
    stop_rule: StopRule,
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
        let spacing_m = mean_spacing_m(&database);
        let search = Search::new(verification, spacing_m, Slots::new(memory.slots), search_memory);
        let map_traits = MapTraits {
            self_agreement: database.self_agreement(),
            spacing_m,
            segments_per_node: database.segment_count() as f32 / database.node_count().max(1) as f32,
        };
        Ok(Self {
            database,
            config,
            verification: *verification,
            moves: Moves::default(),
            stop_rule: StopRule::new(verification.confidence, &map_traits),
            checker: Checker::new(database.rig(), SegmentFilter::new(&config), memory.planes, memory.view),
            looks: KeptLooks::new(memory.poses, memory.segments, config.max_segments),
            shortlist,
            search,
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
        self.moves.look(&self.looks);
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
        self.moves = Moves::default();
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
        let may_turn = self.looks.here().len() < usize::from(self.config.max_looks) && !self.looks.is_full();
        let may_move =
            self.moves.may_be_more(self.verification.moves) && self.looks.has_odometry() && !self.looks.is_full();
        let looked = match (may_turn, may_move) {
            (true, _) if self.looks.count() <= 1 => Looked::Once,
            (true, _) => Looked::Partly,
            (false, true) => Looked::AllAround,
            (false, false) => Looked::AtEverything,
        };
        let is_poor = self.looks.seen_q4() < POOR_PX * 16;
        let judgement = judge(self.search.places(), &self.database, &self.looks);
        let mut is_inside = judgement.is_some_and(|judgement| self.stop_rule.is_inside(&judgement));
        let may_be_inside = judgement.is_some_and(|judgement| self.stop_rule.may_be_inside(&judgement));
        if let Some(judgement) = &judgement
            && !is_poor
            && self.stop_rule.suffices(judgement, looked)
        {
            if self.stop_rule.is_beyond_doubt(judgement) || !self.is_contradicted(judgement) {
                return Decision::Localized(self.localized(judgement));
            }
            is_inside = false;
        }
        match judgement {
            _ if may_turn => Decision::LookAgain { turn: self.next_turn(), step_m: 0.0 },
            _ if may_move && (is_poor || may_be_inside) => self.next_move(),
            _ if is_poor => Decision::Unknown { reason: UnknownReason::SceneTooPoor },
            Some(judgement) if is_inside => {
                let mut rivals = judgement.places;
                rivals.retain_likelier(LEAST_PROBABILITY);
                Decision::Unknown { reason: UnknownReason::Indistinguishable(rivals) }
            }
            _ => Decision::Unknown { reason: UnknownReason::OutsideMap },
        }
    }

    /// Whether a look that shows much agrees with nothing there.
    fn is_contradicted(&mut self, judgement: &Judgement) -> bool {
        let Self { database, checker, looks, stop_rule, .. } = self;
        (0..looks.count()).any(|look| {
            let score_q20 = agreement_of_look(&judgement.best, look, database, checker, looks);
            stop_rule.contradicts(judgement, looks.segments(look).len(), score_q20)
        })
    }

    fn next_turn(&mut self) -> Angle {
        let Self { config, database, checker, looks, .. } = self;
        match self.verification.next_look {
            NextLook::Fixed => config.turn,
            NextLook::Predicted => {
                most_telling_turn(self.search.places(), config.turn, config.max_looks, database, checker, looks)
            }
        }
    }

    /// A turn and a step to where the best place has room and its rivals look different.
    fn next_move(&mut self) -> Decision {
        let Self { database, checker, looks, moves, .. } = self;
        let (turn, step_m) =
            most_telling_move(self.search.places(), self.verification.move_m, moves, database, checker, looks);
        moves.ask(looks, turn);
        Decision::LookAgain { turn, step_m }
    }

    /// The answer: the pose at the last look, and the node nearest to it.
    fn localized(&mut self, judgement: &Judgement) -> Localized {
        let best = &judgement.best;
        let fitted = fit(best, &self.database, &mut self.checker, &mut self.looks);
        let last = self.looks.pose(self.looks.count().saturating_sub(1));
        let from = self.database.node(best.node()).map_or(Point2::default(), |node| node.position());
        let way_m = last.way_m_if(fitted.heading_error_rad);
        let position = Point2::new(from.x + fitted.offset_m[0] + way_m[0], from.y + fitted.offset_m[1] + way_m[1]);
        let heading = Heading::new(Angle::from_radians(last.heading_rad + last.drift_rad + fitted.heading_error_rad));
        let pose =
            PoseEstimate { position, heading: heading.unwrap_or_default(), covariance: fitted.covariance_at(&last) };
        let node = nearest_node(&self.database, position).map(|node| node.id()).unwrap_or_default();
        let probability = judgement.places.iter().next().map(|place| place.probability);
        Localized { node, pose: Some(pose), probability }
    }
}

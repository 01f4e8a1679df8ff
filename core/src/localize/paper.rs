//! The paper's localiser: the loop of its Fig. 1(a).

use super::extent::Extent;
use super::first_stage::FirstStage;
use super::segment_filter::SegmentFilter;
use super::workspace::Workspace;
use super::{
    CandidateSet, ConfigError, Decision, Localized, LocalizerConfig, Look, ObserveError, ScoreMargin, StartError,
    UnknownReason, predict_view,
};
use crate::database::{NodeId, TopologicalDatabase};
use crate::geometry::{Heading, Segment2};
use crate::matching::{PRUNES, Panel, PanelRow, RootRows, ViewScore, score_view};
use crate::pgh::{HistogramBuilder, Line, LineBlock, LongestLines};

/// Scores nodes by pairwise geometric histograms, look by look.
///
/// Every node's model, re-projected at the measured heading, is scored against the scene;
/// scores accumulate; nodes more than `B_th / i` below the best drop out; when one is left, it is the answer.
#[derive(Debug)]
pub(super) struct PaperLocalizer<'m> {
    database: TopologicalDatabase<'m>,
    config: LocalizerConfig,
    margin: ScoreMargin,
    filter: SegmentFilter,
    candidates: CandidateSet<'m>,
    first_stage: Option<FirstStage<'m>>,
    scene: SceneMatcher<'m>,
    is_finished: bool,
}

impl<'m> PaperLocalizer<'m> {
    /// A localiser in `database`, working in `memory`, with `config` unchecked as yet.
    pub(super) fn new(
        database: TopologicalDatabase<'m>,
        config: &LocalizerConfig,
        memory: &'m mut [u64],
    ) -> Result<Self, StartError> {
        let config = config.checked().map_err(StartError::Config)?;
        let margin = ScoreMargin::new(config.score_margin).ok_or(StartError::Config(ConfigError::ScoreMargin))?;
        let extent = Extent::of(&config, &database);
        let memory = Workspace::divide(memory, &config, extent).map_err(StartError::Memory)?;
        let index = database.index().filter(|_| extent.has_first_stage());
        let first_stage = index.map(|index| FirstStage::new(*index, database.rig().camera, memory.similarities));
        Ok(Self {
            database,
            config,
            margin,
            filter: SegmentFilter::new(&config),
            candidates: CandidateSet::new(memory.node_scores),
            first_stage,
            scene: SceneMatcher {
                lines: memory.scene_lines,
                line_count: 0,
                rows: RootRows::new(memory.scene_pairs, memory.scene_row_ends),
                view_lines: memory.view_lines,
                masses: memory.masses,
                line_blocks: memory.line_blocks,
                panel_rows: memory.panel_rows,
                best_coefficients: memory.best_coefficients,
            },
            is_finished: false,
        })
    }

    /// Takes one look into account and decides.
    pub(super) fn observe(&mut self, look: &Look<'_>) -> Result<Decision, ObserveError> {
        let heading = look.heading.ok_or(ObserveError::HeadingMissing)?.mean;
        self.describe_scene(look.scene.segments())?;
        if self.is_finished {
            self.reset();
        }
        self.shortlist(heading, look.scene.segments());
        self.score_candidates(heading);
        self.candidates.filter(self.margin);
        let decision = self.decide();
        self.is_finished = !matches!(decision, Decision::LookAgain { .. });
        Ok(decision)
    }

    /// Forgets all looks.
    pub(super) fn reset(&mut self) {
        self.candidates.reset();
        self.first_stage.iter_mut().for_each(FirstStage::clear);
        self.is_finished = false;
    }

    /// Accumulated scores of all nodes, and which are still candidates.
    pub(super) const fn candidates(&self) -> &CandidateSet<'m> {
        &self.candidates
    }

    /// Segments of the last look that entered the matching.
    pub(super) const fn scene_segment_count(&self) -> usize {
        self.scene.line_count
    }

    fn describe_scene(&mut self, segments: &[Segment2]) -> Result<(), ObserveError> {
        let lines = keep_longest(segments.iter().copied(), &self.filter, &self.config, self.scene.lines);
        self.scene.line_count = lines.len();
        let mut builder = HistogramBuilder::new(&self.config.shape, self.scene.masses, self.scene.line_blocks)
            .map_err(ObserveError::Histograms)?;
        self.scene.rows.rebuild(&mut builder, lines).map_err(ObserveError::Capacity)
    }

    /// As long as no node has scored, leaves those in play that are most like what was seen so far.
    fn shortlist(&mut self, heading: Heading, segments: &[Segment2]) {
        let has_scored = self.candidates.leading_node().is_some_and(|(_, score)| score.sum_q30 > 0);
        if let Some(stage) = self.first_stage.as_mut().filter(|_| !has_scored) {
            let code = stage.code(segments);
            stage.add(&code, core::iter::once(heading.angle().radians()));
            self.candidates.restrict(stage.best(usize::from(self.config.shortlist)));
        }
    }

    fn score_candidates(&mut self, heading: Heading) {
        let Self { database, config, filter, candidates, scene, .. } = self;
        candidates.accumulate(|id| scene.score_node(database, id, heading, filter, config));
    }

    fn decide(&self) -> Decision {
        let has_looked_enough = self.candidates.iteration() >= u32::from(self.config.max_looks);
        match self.candidates.leading_node() {
            Some((node, score)) if score.sum_q30 > 0 && (self.candidates.rival_count() == 0 || has_looked_enough) => {
                Decision::Localized(Localized { node, pose: None, probability: None })
            }
            _ if has_looked_enough => Decision::Unknown { reason: UnknownReason::SceneTooPoor },
            _ => Decision::LookAgain { turn: self.config.turn, step_m: 0.0 },
        }
    }
}

/// The scene of the current look and the scratch to match views against it.
#[derive(Debug)]
struct SceneMatcher<'m> {
    lines: &'m mut [Line],
    line_count: usize,
    rows: RootRows<'m>,
    view_lines: &'m mut [Line],
    masses: &'m mut [i32],
    line_blocks: &'m mut [LineBlock],
    panel_rows: &'m mut [PanelRow],
    best_coefficients: &'m mut [i32],
}

impl SceneMatcher<'_> {
    fn score_node(
        &mut self,
        database: &TopologicalDatabase<'_>,
        id: NodeId,
        heading: Heading,
        filter: &SegmentFilter,
        config: &LocalizerConfig,
    ) -> ViewScore {
        let builder = HistogramBuilder::new(&config.shape, self.masses, self.line_blocks).ok();
        let Some((node, mut builder)) = database.node(id).zip(builder) else { return ViewScore::default() };
        let prediction = predict_view(&node, database.rig(), heading);
        let view_lines = keep_longest(prediction, filter, config, self.view_lines);
        if PRUNES {
            view_lines.sort_unstable_by_key(Line::kin);
        }
        let mut panel = Panel::new(self.panel_rows);
        let scene_lines = &self.lines[..self.line_count];
        let score = score_view(scene_lines, &self.rows, view_lines, &mut builder, &mut panel, self.best_coefficients);
        // A view has no more lines than the scene may have, for which there is room.
        score.unwrap_or_default()
    }
}

/// The lines that the paper's localiser matches, of a scene and of a prediction alike: the longest of `segments` that are
/// long enough and not near-horizontal, as many as `storage` holds. A line's order is the place of its segment.
pub fn lines_to_match<'s>(
    segments: impl Iterator<Item = Segment2>,
    config: &LocalizerConfig,
    storage: &'s mut [Line],
) -> &'s [Line] {
    keep_longest(segments, &SegmentFilter::new(config), config, storage)
}

fn keep_longest<'s>(
    segments: impl Iterator<Item = Segment2>,
    filter: &SegmentFilter,
    config: &LocalizerConfig,
    storage: &'s mut [Line],
) -> &'s mut [Line] {
    let mut longest = LongestLines::new(storage);
    for (order, segment) in segments.enumerate().filter(|(_, segment)| filter.keeps(segment)) {
        longest.offer(Line::new(&segment, order as u32, &config.shape));
    }
    longest.into_lines()
}

//! The localiser: the loop of the paper's Fig. 1(a), behind one verb.

use super::workspace::{self, Workspace};
use super::{
    CandidateSet, ConfigError, Decision, Localized, LocalizerConfig, Look, ScoreMargin, UnknownReason, predict_view,
};
use crate::database::{NodeId, TopologicalDatabase};
use crate::geometry::{CapacityError, Heading, Segment2};
use crate::matching::{Panel, PanelRow, RootRows, ViewScore, score_view};
use crate::math;
use crate::pgh::{BuilderError, HistogramBuilder, Line, LongestLines};
use core::fmt;

/// Tells the robot where it is, look by look.
///
/// The paper's localiser: every node's model, re-projected at the measured heading, is scored against the scene;
/// scores accumulate; nodes more than `B_th / i` below the best drop out; when one is left, it is the answer.
#[derive(Debug)]
pub struct Localizer<'m> {
    database: TopologicalDatabase<'m>,
    config: LocalizerConfig,
    margin: ScoreMargin,
    filter: SegmentFilter,
    candidates: CandidateSet<'m>,
    scene: SceneMatcher<'m>,
    is_finished: bool,
}

impl<'m> Localizer<'m> {
    /// Number of `u64` of working memory for a configuration and a number of nodes.
    #[must_use]
    pub const fn memory_len(config: &LocalizerConfig, node_count: usize) -> usize {
        workspace::memory_len(config, node_count)
    }

    /// A localiser in `database`, working in `memory` of at least [`Self::memory_len`] words.
    ///
    /// # Errors
    /// When a parameter is out of range, or the memory too small: by how much.
    pub fn new(
        database: TopologicalDatabase<'m>,
        config: &LocalizerConfig,
        memory: &'m mut [u64],
    ) -> Result<Self, StartError> {
        let config = config.checked().map_err(StartError::Config)?;
        let margin = ScoreMargin::new(config.score_margin).ok_or(StartError::Config(ConfigError::ScoreMargin))?;
        let memory = Workspace::divide(memory, &config, database.node_count()).map_err(StartError::Memory)?;
        Ok(Self {
            database,
            config,
            margin,
            filter: SegmentFilter::new(&config),
            candidates: CandidateSet::new(memory.node_scores),
            scene: SceneMatcher {
                lines: memory.scene_lines,
                line_count: 0,
                rows: RootRows::new(memory.scene_pairs, memory.scene_row_ends),
                view_lines: memory.view_lines,
                masses: memory.masses,
                panel_rows: memory.panel_rows,
                best_coefficients: memory.best_coefficients,
            },
            is_finished: false,
        })
    }

    /// Takes one look into account and decides.
    ///
    /// After a [`Decision::Localized`] or [`Decision::Unknown`] the next look begins a new attempt.
    ///
    /// # Errors
    /// When the look lacks what the localiser needs; no score and no candidate has changed then.
    pub fn observe(&mut self, look: &Look<'_>) -> Result<Decision, ObserveError> {
        let heading = look.heading.ok_or(ObserveError::HeadingMissing)?.mean;
        self.describe_scene(look.scene.segments())?;
        if self.is_finished {
            self.reset();
        }
        self.score_candidates(heading);
        self.candidates.filter(self.margin);
        let decision = self.decide();
        self.is_finished = !matches!(decision, Decision::LookAgain { .. });
        Ok(decision)
    }

    /// Forgets all looks: the robot was switched on, or carried away.
    pub fn reset(&mut self) {
        self.candidates.reset();
        self.is_finished = false;
    }

    /// Accumulated scores of all nodes, and which are still candidates; kept after a decision until the next look.
    #[must_use]
    pub const fn candidates(&self) -> &CandidateSet<'m> {
        &self.candidates
    }

    /// Segments of the last look that entered the matching.
    #[must_use]
    pub const fn scene_segment_count(&self) -> usize {
        self.scene.line_count
    }

    fn describe_scene(&mut self, segments: &[Segment2]) -> Result<(), ObserveError> {
        let lines = keep_longest(segments.iter().copied(), &self.filter, &self.config, self.scene.lines);
        self.scene.line_count = lines.len();
        let mut builder =
            HistogramBuilder::new(&self.config.shape, self.scene.masses).map_err(ObserveError::Histograms)?;
        self.scene.rows.rebuild(&mut builder, lines).map_err(ObserveError::Capacity)
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
            _ => Decision::LookAgain { turn: self.config.turn },
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
        let builder = HistogramBuilder::new(&config.shape, self.masses).ok();
        let Some((node, mut builder)) = database.node(id).zip(builder) else { return ViewScore::default() };
        let prediction = predict_view(&node, database.rig(), heading);
        let view_lines = keep_longest(prediction, filter, config, self.view_lines);
        let mut panel = Panel::new(self.panel_rows);
        let scene_lines = &self.lines[..self.line_count];
        score_view(scene_lines, &self.rows, view_lines, &mut builder, &mut panel, self.best_coefficients)
    }
}

/// Which segments take part, of scene and prediction alike.
#[derive(Debug, Clone, Copy)]
struct SegmentFilter {
    min_length_px: f32,
    horizontal_slope: f32,
}

impl SegmentFilter {
    fn new(config: &LocalizerConfig) -> Self {
        let horizontal_slope = math::tan(config.horizontal_exclusion.radians());
        Self { min_length_px: config.min_length_px, horizontal_slope }
    }

    /// Whether `segment` is long enough and not near-horizontal. An exclusion of zero keeps horizontals.
    fn keeps(&self, segment: &Segment2) -> bool {
        let (dx, dy) = (segment.end().x - segment.start().x, segment.end().y - segment.start().y);
        let is_horizontal = math::abs(dy) < self.horizontal_slope * math::abs(dx);
        segment.length_px() >= self.min_length_px && !is_horizontal
    }
}

fn keep_longest<'s>(
    segments: impl Iterator<Item = Segment2>,
    filter: &SegmentFilter,
    config: &LocalizerConfig,
    storage: &'s mut [Line],
) -> &'s [Line] {
    let mut longest = LongestLines::new(storage);
    for (order, segment) in segments.enumerate().filter(|(_, segment)| filter.keeps(segment)) {
        longest.offer(Line::new(&segment, order as u32, &config.shape));
    }
    longest.into_lines()
}

/// Why a localiser can't start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StartError {
    /// A parameter is out of range.
    Config(ConfigError),
    /// The memory is too small.
    Memory(CapacityError),
}

impl fmt::Display for StartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Config(error) => error.fmt(f),
            Self::Memory(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for StartError {}

/// Why a look can't be taken into account.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ObserveError {
    /// The look has no heading, which this localiser needs.
    HeadingMissing,
    /// Histograms can't be built.
    Histograms(BuilderError),
    /// A part of the working memory is too small.
    Capacity(CapacityError),
}

impl fmt::Display for ObserveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::HeadingMissing => f.write_str("the look has no heading: the paper's localiser needs a compass"),
            Self::Histograms(error) => error.fmt(f),
            Self::Capacity(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for ObserveError {}

//! The localiser: one verb, whichever method answers.

use super::paper::PaperLocalizer;
use super::workspace;
use super::{CandidateSet, ConfigError, Decision, LocalizerConfig, Look};
use crate::database::TopologicalDatabase;
use crate::geometry::CapacityError;
use crate::pgh::BuilderError;
use core::fmt;

/// Tells the robot where it is, look by look.
///
/// The paper's localiser: every node's model, re-projected at the measured heading, is scored against the scene;
/// scores accumulate; nodes more than `B_th / i` below the best drop out; when one is left, it is the answer.
#[derive(Debug)]
pub struct Localizer<'m> {
    paper: PaperLocalizer<'m>,
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
        Ok(Self { paper: PaperLocalizer::new(database, config, memory)? })
    }

    /// Takes one look into account and decides.
    ///
    /// After a [`Decision::Localized`] or [`Decision::Unknown`] the next look begins a new attempt.
    ///
    /// # Errors
    /// When the look lacks what the localiser needs; no score and no candidate has changed then.
    pub fn observe(&mut self, look: &Look<'_>) -> Result<Decision, ObserveError> {
        self.paper.observe(look)
    }

    /// Forgets all looks: the robot was switched on, or carried away.
    pub fn reset(&mut self) {
        self.paper.reset();
    }

    /// Accumulated scores of all nodes, and which are still candidates; kept after a decision until the next look.
    #[must_use]
    pub const fn candidates(&self) -> &CandidateSet<'m> {
        self.paper.candidates()
    }

    /// Segments of the last look that entered the matching.
    #[must_use]
    pub const fn scene_segment_count(&self) -> usize {
        self.paper.scene_segment_count()
    }
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

//! The localiser: one verb, whichever method answers.

use super::extent::Extent;
use super::paper::PaperLocalizer;
use super::verify::{self, VerifyingLocalizer};
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
///
/// The verifying localiser: poses around every node are checked against all looks; the answer is a pose, with its
/// covariance and a probability, or the reason why there is none.
///
/// In a map with an index and more nodes than the [shortlist](LocalizerConfig::shortlist) has room for, either scores only
/// those nodes whose views are most like what is seen. The paper's chooses them at the first look by which any node
/// scores. The verifying one chooses anew at each look, by all looks so far, and checks who enters against all of them.
#[derive(Debug)]
pub struct Localizer<'m> {
    method: Method<'m>,
}

#[derive(Debug)]
#[expect(clippy::large_enum_variant, reason = "a robot has one of them, and no heap to put it on")]
enum Method<'m> {
    Paper(PaperLocalizer<'m>),
    Verifying(VerifyingLocalizer<'m>),
}

impl<'m> Localizer<'m> {
    /// Number of `u64` of working memory for a configuration and a number of nodes, in a map without an index.
    #[must_use]
    pub const fn memory_len(config: &LocalizerConfig, node_count: usize) -> usize {
        Self::memory_len_for(config, Extent::whole(node_count))
    }

    /// The same in a map whose index has views from `poses` poses about each node: mostly that of the
    /// [shortlist](LocalizerConfig::shortlist), and 16 bytes a node and 2 a pose.
    #[must_use]
    pub const fn indexed_memory_len(config: &LocalizerConfig, node_count: usize, poses: usize) -> usize {
        Self::memory_len_for(config, Extent::indexed(config, node_count, poses))
    }

    /// The same in the map `database`.
    #[must_use]
    pub fn memory_len_in(config: &LocalizerConfig, database: &TopologicalDatabase<'_>) -> usize {
        Self::memory_len_for(config, Extent::of(config, database))
    }

    const fn memory_len_for(config: &LocalizerConfig, extent: Extent) -> usize {
        match &config.verification {
            None => workspace::memory_len(config, extent),
            Some(verification) => verify::memory_len(config, verification, extent),
        }
    }

    /// A localiser in `database`, working in `memory` of at least [`Self::memory_len_in`] words.
    ///
    /// # Errors
    /// When a parameter is out of range, or the memory too small: by how much.
    pub fn new(
        database: TopologicalDatabase<'m>,
        config: &LocalizerConfig,
        memory: &'m mut [u64],
    ) -> Result<Self, StartError> {
        let method = match &config.verification {
            None => Method::Paper(PaperLocalizer::new(database, config, memory)?),
            Some(verification) => Method::Verifying(VerifyingLocalizer::new(database, config, verification, memory)?),
        };
        Ok(Self { method })
    }

    /// Takes one look into account and decides.
    ///
    /// After a [`Decision::Localized`] or [`Decision::Unknown`] the next look begins a new attempt.
    ///
    /// # Errors
    /// When the look lacks what the localiser needs; no score and no candidate has changed then.
    pub fn observe(&mut self, look: &Look<'_>) -> Result<Decision, ObserveError> {
        match &mut self.method {
            Method::Paper(paper) => paper.observe(look),
            Method::Verifying(verifying) => verifying.observe(look),
        }
    }

    /// Forgets all looks: the robot was switched on, or carried away.
    pub fn reset(&mut self) {
        match &mut self.method {
            Method::Paper(paper) => paper.reset(),
            Method::Verifying(verifying) => verifying.reset(),
        }
    }

    /// Accumulated scores of all nodes, and which are still candidates; kept after a decision until the next look.
    ///
    /// When verifying, a node's score is that of the best pose beside it, over all looks; all stay in play, or all of the
    /// shortlist.
    #[must_use]
    pub const fn candidates(&self) -> &CandidateSet<'m> {
        match &self.method {
            Method::Paper(paper) => paper.candidates(),
            Method::Verifying(verifying) => verifying.candidates(),
        }
    }

    /// Segments of the last look that entered the matching.
    #[must_use]
    pub fn scene_segment_count(&self) -> usize {
        match &self.method {
            Method::Paper(paper) => paper.scene_segment_count(),
            Method::Verifying(verifying) => verifying.scene_segment_count(),
        }
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
    /// The look has no heading: the paper's localiser needs a compass, the verifying one a compass or odometry.
    HeadingMissing,
    /// Histograms can't be built.
    Histograms(BuilderError),
    /// A part of the working memory is too small.
    Capacity(CapacityError),
}

impl fmt::Display for ObserveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::HeadingMissing => f.write_str("the look has no heading: without a compass the paper's localiser can't work, and the verifying one needs odometry"),
            Self::Histograms(error) => error.fmt(f),
            Self::Capacity(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for ObserveError {}

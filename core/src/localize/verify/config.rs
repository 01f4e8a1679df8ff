//! The parameters of verification, all in one place.

use super::headings::MAX_HEADINGS;
use super::kept_looks::LEAST_MOVE_M;

/// Parameters of the verifying localiser, beside those that every localiser has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VerificationConfig {
    /// Positions tried along either side of the square about each node, odd, 3 to 31. How far apart they lie follows
    /// from the spacing of the nodes.
    pub cells_per_side: u16,
    /// How far that square reaches to either side, in distances from a node to the next, 0.1 to 2, but 0.6 m at
    /// least and 2 m at most. From 0.8 on the squares reach the neighbours.
    pub reach: f32,
    /// Headings that may be tried in every cell of the grid, 1 to 9: one does for a compass that errs up to 2.5 degrees,
    /// three beyond; a robot without a compass needs four, along and across the building.
    pub headings: u16,
    /// Confidence above which the best hypothesis is answered, 0 to 100: what it is ahead of the best rival a metre or
    /// more away, times the square root of the segments seen in thirties. The first look alone asks for more, a robot
    /// that has looked all around for less.
    pub confidence: f32,
    /// Hypotheses that are posed more closely after each look, 1 to 256.
    pub refined: u16,
    /// Places that are posed most closely and compared, 1 to `refined`.
    pub finalists: u16,
    /// Where to look next.
    pub next_look: NextLook,
    /// Exploratory moves asked for where turns can't tell, 0 to 15; none of a robot that reports no motion. They need the
    /// memory that poor looks leave: [`max_looks`](crate::localize::LocalizerConfig::max_looks) looks of as many segments as
    /// may enter fill it.
    pub moves: u16,
    /// Length of a move where there is room \[m\], 0.25 to 10.
    pub move_m: f32,
}

/// Where a robot that is not sure yet looks next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum NextLook {
    /// A turn of [`turn`](crate::localize::LocalizerConfig::turn) on.
    Fixed,
    /// Of the multiples of that turn, the one whose view is predicted to tell the best place from its rivals best.
    #[default]
    Predicted,
}

impl VerificationConfig {
    /// Hypotheses of one node that may be refined: neighbouring cells crowd others out.
    pub(super) const PER_NODE: usize = 4;

    /// The values that the study of the office settled on.
    #[must_use]
    pub const fn reference() -> Self {
        Self {
            cells_per_side: 7,
            reach: 0.8,
            headings: 4,
            confidence: 0.4,
            refined: 56,
            finalists: 12,
            next_look: NextLook::Predicted,
            moves: 2,
            move_m: 1.0,
        }
    }

    /// Whether every parameter is in range.
    pub(crate) fn is_legal(&self) -> bool {
        let is_odd = self.cells_per_side % 2 == 1;
        is_odd
            && (3..=31).contains(&self.cells_per_side)
            && (0.1..=2.0).contains(&self.reach)
            && (1..=MAX_HEADINGS as u16).contains(&self.headings)
            && (0.0..=100.0).contains(&self.confidence)
            && (1..=256).contains(&self.refined)
            && (1..=self.refined).contains(&self.finalists)
            && self.moves <= 15
            && (LEAST_MOVE_M..=10.0).contains(&self.move_m)
    }

    /// Places that the robot looks around from, at most.
    pub(super) const fn places(&self) -> usize {
        1 + self.moves as usize
    }

    /// Poses tried about each node.
    pub(super) const fn poses_per_node(&self) -> usize {
        self.cells_per_node().saturating_mul(self.headings as usize)
    }

    /// Positions tried about each node.
    pub(super) const fn cells_per_node(&self) -> usize {
        (self.cells_per_side as usize).saturating_mul(self.cells_per_side as usize)
    }
}

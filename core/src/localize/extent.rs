//! How much of a map a localiser has in hand.

use super::LocalizerConfig;
use crate::database::TopologicalDatabase;

/// Numbers that a localiser's memory follows from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Extent {
    /// Nodes of the map.
    pub(super) nodes: usize,
    /// Nodes that are scored at a time.
    pub(super) scored: usize,
    /// Poses about all nodes that the first stage compares; none when there is no first stage.
    pub(super) compared: usize,
}

impl Extent {
    /// Every node is scored.
    pub(super) const fn whole(nodes: usize) -> Self {
        Self { nodes, scored: nodes, compared: 0 }
    }

    /// In a map whose index has views from so many poses about each node.
    pub(super) const fn indexed(config: &LocalizerConfig, nodes: usize, poses: usize) -> Self {
        let shortlist = config.shortlist as usize;
        if nodes <= shortlist {
            return Self::whole(nodes);
        }
        Self { nodes, scored: shortlist, compared: nodes.saturating_mul(poses) }
    }

    /// In `database`.
    pub(super) fn of(config: &LocalizerConfig, database: &TopologicalDatabase<'_>) -> Self {
        let nodes = database.node_count();
        let poses = database.index().map(|index| usize::from(index.shape().poses));
        poses.map_or(Self::whole(nodes), |poses| Self::indexed(config, nodes, poses))
    }

    /// Whether a first stage chooses the nodes that are scored.
    pub(super) const fn has_first_stage(&self) -> bool {
        self.compared > 0
    }
}

//! Candidate filtering: which nodes the robot may still be at (paper, section 3.2 and Fig. 1a).

use super::ScoreMargin;
use crate::database::NodeId;
use crate::matching::ViewScore;
use zerocopy::{FromBytes, Immutable, IntoBytes};

/// The accumulated score of one node.
///
/// Scores are accumulated as the plain **sum** of the view scores of all looks (the literal reading of the paper), while
/// the margin shrinks as `B_th / i`: the same margin therefore means less and less of a mean score.
#[derive(Debug, Clone, Copy, PartialEq, Eq, FromBytes, IntoBytes, Immutable)]
#[repr(C)]
pub struct NodeScore {
    /// Sum of the node's view scores in Q30, over the looks for which it was a candidate.
    pub sum_q30: i64,
    in_play: u64,
}

impl NodeScore {
    /// Whether the node is still a candidate (the leading node is one).
    #[must_use]
    pub const fn is_candidate(&self) -> bool {
        self.in_play != 0
    }

    /// The accumulated score in coefficients.
    #[must_use]
    pub fn as_f64(&self) -> f64 {
        self.sum_q30 as f64 / f64::from(1 << 30)
    }
}

/// All nodes with their accumulated scores.
#[derive(Debug)]
pub struct CandidateSet<'m> {
    nodes: &'m mut [NodeScore],
    iteration: u32,
}

impl<'m> CandidateSet<'m> {
    /// All nodes in play, no look taken. `nodes` has one place for each node of the database.
    pub fn new(nodes: &'m mut [NodeScore]) -> Self {
        let mut set = Self { nodes, iteration: 0 };
        set.reset();
        set
    }

    /// Puts all nodes back in play.
    pub fn reset(&mut self) {
        self.nodes.fill(NodeScore { sum_q30: 0, in_play: 1 });
        self.iteration = 0;
    }

    /// Looks taken so far.
    #[must_use]
    pub const fn iteration(&self) -> u32 {
        self.iteration
    }

    /// Every node's score, by identity.
    #[must_use]
    pub fn scores(&self) -> &[NodeScore] {
        self.nodes
    }

    /// The candidates by identity, the leading node among them.
    pub fn candidates(&self) -> impl Iterator<Item = (NodeId, NodeScore)> {
        self.nodes
            .iter()
            .enumerate()
            .filter(|(_, node)| node.is_candidate())
            .map(|(id, node)| (NodeId(id as u32), *node))
    }

    /// The candidate with the greatest score; of equals the first. `None` only in a set of no nodes.
    #[must_use]
    pub fn leading_node(&self) -> Option<(NodeId, NodeScore)> {
        self.candidates().reduce(|leader, other| if other.1.sum_q30 > leader.1.sum_q30 { other } else { leader })
    }

    /// Number of candidates besides the leading node.
    #[must_use]
    pub fn rival_count(&self) -> usize {
        self.candidates().count().saturating_sub(1)
    }

    /// Adds a look's score to every candidate.
    pub fn accumulate(&mut self, mut score: impl FnMut(NodeId) -> ViewScore) {
        self.iteration = self.iteration.saturating_add(1);
        for (id, node) in self.nodes.iter_mut().enumerate().filter(|(_, node)| node.is_candidate()) {
            node.sum_q30 = node.sum_q30.saturating_add(i64::from(score(NodeId(id as u32)).q30));
        }
    }

    /// Replaces every node's score after a look by the best that it has, 0 where it has none; all are in play.
    pub(super) fn replace(&mut self, scores_q30: impl Iterator<Item = (NodeId, i64)>) {
        self.iteration = self.iteration.saturating_add(1);
        self.nodes.fill(NodeScore { sum_q30: i64::MIN, in_play: 1 });
        for (id, score_q30) in scores_q30 {
            if let Some(node) = self.nodes.get_mut(id.0 as usize) {
                node.sum_q30 = node.sum_q30.max(score_q30);
            }
        }
        for node in self.nodes.iter_mut().filter(|node| node.sum_q30 == i64::MIN) {
            node.sum_q30 = 0;
        }
    }

    /// Leaves only some nodes in play.
    pub(super) fn restrict(&mut self, chosen: impl Iterator<Item = NodeId>) {
        self.nodes.iter_mut().for_each(|node| node.in_play = 0);
        for id in chosen {
            if let Some(node) = self.nodes.get_mut(id.0 as usize) {
                node.in_play = 1;
            }
        }
    }

    /// Keeps the leading node and the candidates scoring more than `B_max - B_th / i`.
    ///
    /// As long as no node has scored there is no leader to fall behind, and all stay whatever the margin.
    pub fn filter(&mut self, margin: ScoreMargin) {
        let Some((leader, best)) = self.leading_node() else { return };
        if best.sum_q30 == 0 {
            return;
        }
        let floor = best.sum_q30 - margin.at_iteration(self.iteration);
        for (id, node) in self.nodes.iter_mut().enumerate() {
            if id as u32 != leader.0 && node.sum_q30 <= floor {
                node.in_play = 0;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EMPTY: NodeScore = NodeScore { sum_q30: 0, in_play: 0 };

    fn score(value: f64) -> ViewScore {
        ViewScore { q30: (value * f64::from(1 << 30)) as i32 }
    }

    fn kept<const N: usize>(margin: f32, looks: &[[f64; N]]) -> [bool; N] {
        let mut nodes = [EMPTY; N];
        let mut set = CandidateSet::new(&mut nodes);
        for look in looks {
            set.accumulate(|id| score(look[id.0 as usize]));
            set.filter(ScoreMargin::new(margin).expect("in range"));
        }
        nodes.map(|node| node.is_candidate())
    }

    #[test]
    fn nodes_within_the_margin_stay() {
        assert_eq!(kept(0.1, &[[0.49, 0.55, 0.44, 0.6]]), [false, true, false, true]);
    }

    #[test]
    fn the_margin_shrinks_with_each_look_while_scores_add_up() {
        assert_eq!(kept(0.1, &[[0.5, 0.45], [0.5, 0.48]]), [true, false]);
        assert_eq!(kept(0.1, &[[0.5, 0.45], [0.5, 0.51]]), [true, true]);
    }

    #[test]
    fn a_zero_margin_keeps_the_first_of_equals_alone() {
        assert_eq!(kept(0.0, &[[0.5, 0.5, 0.5]]), [true, false, false]);
    }

    #[test]
    fn a_blank_look_changes_nothing() {
        assert_eq!(kept(0.1, &[[0.0, 0.0, 0.0]]), [true, true, true]);
        assert_eq!(kept(0.0, &[[0.0, 0.0, 0.0]]), [true, true, true]);
        assert_eq!(kept(0.0, &[[0.0, 0.0, 0.0], [0.2, 0.5, 0.4]]), [false, true, false]);
    }

    #[test]
    fn a_node_that_left_does_not_come_back() {
        assert_eq!(kept(0.1, &[[0.5, 0.1], [0.0, 0.9]]), [true, false]);
    }
}

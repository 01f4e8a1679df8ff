//! A pose that the robot may have had at the first look.

use super::Evidence;
use super::kept_looks::LookPose;
use crate::database::{NodeId, TopologicalDatabase};
use crate::geometry::Point2;
use core::cmp::Ordering;
use zerocopy::{FromBytes, Immutable, IntoBytes};

/// A camera beside a node, what speaks for it and how well.
#[derive(Debug, Clone, Copy, PartialEq, FromBytes, IntoBytes, Immutable)]
#[repr(C)]
pub(super) struct Hypothesis {
    pub(super) node: u32,
    /// From the node, axes of the world \[m\].
    pub(super) offset_m: [f32; 2],
    /// What the compass errs by \[rad\].
    pub(super) heading_error_rad: f32,
    pub(super) evidence: Evidence,
    /// Agreement over all looks, in Q20.
    pub(super) score_q20: i32,
}

impl Hypothesis {
    /// A hypothesis without evidence.
    pub(super) fn new(node: NodeId, offset_m: [f32; 2], heading_error_rad: f32) -> Self {
        Self { node: node.0, offset_m, heading_error_rad, evidence: Evidence::default(), score_q20: 0 }
    }

    pub(super) const fn node(&self) -> NodeId {
        NodeId(self.node)
    }

    /// Where the camera stood at a look, from the node, axes of the world \[m\].
    pub(super) fn offset_at(&self, look: &LookPose) -> [f32; 2] {
        let [x, y] = look.way_m_if(self.heading_error_rad);
        [self.offset_m[0] + x, self.offset_m[1] + y]
    }

    /// Position at the first look in the world frame.
    pub(super) fn world_position(&self, database: &TopologicalDatabase<'_>) -> Point2 {
        let node = database.node(self.node()).map_or(Point2::default(), |node| node.position());
        Point2::new(node.x + self.offset_m[0], node.y + self.offset_m[1])
    }

    /// Position at a look in the world frame.
    pub(super) fn world_position_at(&self, look: &LookPose, database: &TopologicalDatabase<'_>) -> Point2 {
        let node = database.node(self.node()).map_or(Point2::default(), |node| node.position());
        let [x, y] = self.offset_at(look);
        Point2::new(node.x + x, node.y + y)
    }

    /// The better first; equals by node and position, so that the order is the same everywhere.
    pub(super) fn rank(&self, other: &Self) -> Ordering {
        let place = |h: &Self| [h.offset_m[0], h.offset_m[1], h.heading_error_rad].map(f32::to_bits);
        other.score_q20.cmp(&self.score_q20).then(self.node.cmp(&other.node)).then(place(self).cmp(&place(other)))
    }
}

/// Keeps the best hypotheses offered, as many as `best` holds, in the order of their rank; `count` of them so far.
pub(super) fn keep_best(best: &mut [Hypothesis], count: &mut usize, new: Hypothesis) {
    let at = best[..*count].iter().position(|other| new.rank(other) == Ordering::Less).unwrap_or(*count);
    if at == best.len() {
        return;
    }
    *count = (*count + 1).min(best.len());
    best[at..*count].rotate_right(1);
    best[at] = new;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scored(score_q20: i32) -> Hypothesis {
        Hypothesis { score_q20, ..Hypothesis::new(NodeId(0), [0.0, 0.0], 0.0) }
    }

    #[test]
    fn the_best_are_kept_in_order() {
        let mut best = [scored(0); 3];
        let mut count = 0;
        for score in [5, 1, 9, 7, 2] {
            keep_best(&mut best, &mut count, scored(score));
        }
        assert_eq!((count, best.map(|kept| kept.score_q20)), (3, [9, 7, 5]));
    }
}

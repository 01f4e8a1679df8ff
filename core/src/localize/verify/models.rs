//! Whose model tells what is seen from a place: that of the node a hypothesis is posed beside, and after a move that of
//! the node it came to stand beside.

use super::judgement::nearest_node;
use super::kept_looks::LookPose;
use crate::database::{Node, TopologicalDatabase};
use crate::geometry::Point2;

/// A node's model, and how its frame lies.
#[derive(Debug, Clone, Copy)]
pub(super) struct Model<'m> {
    pub(super) node: Node<'m>,
    /// From this node to the one that offsets are from, axes of the world \[m\].
    shift_m: [f32; 2],
}

impl<'m> Model<'m> {
    /// The node's own.
    pub(super) const fn own(node: Node<'m>) -> Self {
        Self { node, shift_m: [0.0; 2] }
    }

    /// After a move that of the node nearest to `offset_m` from `node`, if it is another.
    pub(super) fn elsewhere(
        look: &LookPose,
        node: &Node<'m>,
        offset_m: [f32; 2],
        database: &TopologicalDatabase<'m>,
    ) -> Option<Self> {
        if look.is_elsewhere() { Self::nearest(node, offset_m, database) } else { None }
    }

    /// That of the node nearest to `offset_m` from `node`, if it is another.
    fn nearest(node: &Node<'m>, offset_m: [f32; 2], database: &TopologicalDatabase<'m>) -> Option<Self> {
        let from = node.position();
        let here = Point2::new(from.x + offset_m[0], from.y + offset_m[1]);
        let other = nearest_node(database, here).filter(|other| other.id() != node.id())?;
        let to = other.position();
        Some(Self { node: other, shift_m: [from.x - to.x, from.y - to.y] })
    }

    /// An offset from the node that was asked for as one from the model's.
    pub(super) fn offset(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        [x + self.shift_m[0], y + self.shift_m[1]]
    }
}

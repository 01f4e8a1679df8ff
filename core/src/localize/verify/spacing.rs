//! How far nodes lie apart, and how far the grid about a node reaches.

use crate::database::{Node, TopologicalDatabase};
use crate::math;

/// Least and greatest reach \[m\].
const REACH_LIMITS_M: [f32; 2] = [0.6, 2.0];

/// Nodes that are asked for their spacing in a map of more than [`MOST_NODES`].
const ASKED_NODES: usize = 256;
/// Most nodes that are all asked.
const MOST_NODES: usize = 1024;

/// Distance from a node to the nearest other \[m\]; infinite when there is none.
fn nearest_other_m(database: &TopologicalDatabase<'_>, node: &Node<'_>) -> f32 {
    let others = database.nodes().filter(|other| other.id() != node.id());
    others.map(|other| other.position().distance(node.position())).fold(f32::INFINITY, math::min)
}

/// Mean distance from a node to the nearest other \[m\]; infinite when there is none.
pub(super) fn mean_spacing_m(database: &TopologicalDatabase<'_>) -> f32 {
    let count = database.node_count();
    let step = if count > MOST_NODES { count.div_ceil(ASKED_NODES) } else { 1 };
    let sum = database.nodes().step_by(step).fold(0.0, |sum, node| sum + nearest_other_m(database, &node));
    sum / count.div_ceil(step) as f32
}

/// How far the grid about every node reaches along an axis \[m\]: `share` of the nodes' spacing. With 0.8 it reaches past
/// the corners of their Voronoi cells.
pub(super) fn reach_m(spacing_m: f32, share: f32) -> f32 {
    math::max(REACH_LIMITS_M[0], math::min(share * spacing_m, REACH_LIMITS_M[1]))
}

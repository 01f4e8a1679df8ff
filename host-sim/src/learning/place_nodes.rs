//! Where to put the nodes of a topological map: spread evenly over the free space.
//!
//! K-means (Lloyd 1982) over the free cells, with the length of the way over free cells as distance, so that a wall
//! separates nodes however thin it is. It starts from cells that are each as far as can be from those before (Gonzalez
//! 1985), the first drawn by seed. The paper says "uniformly distributed".

use crate::random::Stream;
use crate::world::FreeSpace;
use edgeloc::geometry::Point2;

/// The most rounds of assigning cells and moving nodes; mostly nothing moves any more after fewer.
const ROUNDS: usize = 30;

/// Places `count` nodes on centers of free cells, all different, in the world frame.
///
/// # Errors
/// When `count` is zero or above the number of free cells.
pub fn place_nodes(space: &FreeSpace, count: usize, seed: u64) -> Result<Vec<Point2>, PlaceNodesError> {
    let centers: Vec<Point2> = space.cell_centers().collect();
    if count == 0 || count > centers.len() {
        return Err(PlaceNodesError { count, cell_count: centers.len(), area_m2: space.area_m2() });
    }
    let mut nodes = spread(space, centers.len(), count, seed);
    for _ in 0..ROUNDS {
        let mut clusters = Clusters::new(centers.len());
        clusters.grow(space, nodes.iter().copied().enumerate());
        let middles = clusters.middles(&centers, count);
        if middles == nodes {
            break;
        }
        nodes = middles;
    }
    Ok(nodes.into_iter().map(|cell| centers[cell]).collect())
}

/// Cells far from each other.
fn spread(space: &FreeSpace, cell_count: usize, count: usize, seed: u64) -> Vec<usize> {
    let mut clusters = Clusters::new(cell_count);
    let mut next = Stream::new(seed, "nodes", 0, 0).index(cell_count);
    let mut nodes = Vec::with_capacity(count);
    while nodes.len() < count {
        clusters.grow(space, [(nodes.len(), next)]);
        nodes.push(next);
        let farthest = clusters.ways.iter().enumerate().max_by_key(|&(cell, way)| (way, usize::MAX - cell));
        next = farthest.map_or(0, |(cell, _)| cell);
    }
    nodes
}

/// For each free cell the nearest node and the way to it.
pub(super) struct Clusters {
    /// In tenths of a cell.
    pub(super) ways: Vec<usize>,
    nodes: Vec<usize>,
}

impl Clusters {
    pub(super) fn new(cell_count: usize) -> Self {
        Self { ways: vec![usize::MAX; cell_count], nodes: vec![usize::MAX; cell_count] }
    }

    /// Gives each of `nodes`, a number and its cell, the cells to which its way is the shortest (Dijkstra 1959, with the
    /// queue of Dial 1969: a step is at most 14 tenths, so a ring of 15 lists holds all that wait).
    pub(super) fn grow(&mut self, space: &FreeSpace, nodes: impl IntoIterator<Item = (usize, usize)>) {
        const RING: usize = 15;
        let mut waiting: [Vec<usize>; RING] = Default::default();
        for (node, cell) in nodes {
            (self.ways[cell], self.nodes[cell]) = (0, node);
            waiting[0].push(cell);
        }
        let mut way = 0;
        let mut empty_in_row = 0;
        while empty_in_row < RING {
            let reached = std::mem::take(&mut waiting[way % RING]);
            empty_in_row = if reached.is_empty() { empty_in_row + 1 } else { 0 };
            for cell in reached {
                if self.ways[cell] != way {
                    continue; // reached by a shorter way since
                }
                for (beside, tenths) in space.neighbors(cell) {
                    if way + tenths < self.ways[beside] {
                        (self.ways[beside], self.nodes[beside]) = (way + tenths, self.nodes[cell]);
                        waiting[(way + tenths) % RING].push(beside);
                    }
                }
            }
            way += 1;
        }
    }

    /// Of each cluster the cell nearest to the mean of its cells.
    fn middles(&self, centers: &[Point2], count: usize) -> Vec<usize> {
        let mut sums = vec![(0.0_f64, 0.0_f64, 0.0_f64); count];
        for (center, &node) in centers.iter().zip(&self.nodes) {
            let sum = &mut sums[node];
            *sum = (sum.0 + f64::from(center.x), sum.1 + f64::from(center.y), sum.2 + 1.0);
        }
        let mut nearest = vec![(f32::INFINITY, 0); count];
        for (cell, (center, &node)) in centers.iter().zip(&self.nodes).enumerate() {
            let (x, y, cell_count) = sums[node];
            let distance = center.distance(Point2::new((x / cell_count) as f32, (y / cell_count) as f32));
            if distance < nearest[node].0 {
                nearest[node] = (distance, cell);
            }
        }
        nearest.into_iter().map(|(_, cell)| cell).collect()
    }
}

/// There can't be that many nodes.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("cannot place {count} nodes on {cell_count} free cells ({area_m2:.1} m2); ask for 1 to {cell_count} nodes")]
pub struct PlaceNodesError {
    /// How many nodes were asked for.
    pub count: usize,
    /// How many free cells there are.
    pub cell_count: usize,
    /// The free area \[m2\].
    pub area_m2: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::office::{self, OfficeOptions};
    use crate::world::{FreeSpaceOptions, Occluders};
    use edgeloc::geometry::Point3;

    fn office_space() -> FreeSpace {
        FreeSpace::of(&office::generate(&OfficeOptions::default()), &FreeSpaceOptions::default()).expect("an office")
    }

    #[test]
    fn nodes_are_distinct_and_stand_in_free_space() {
        let space = office_space();
        let nodes = place_nodes(&space, 72, 1).expect("room for 72");
        assert_eq!(nodes.len(), 72);
        assert!(nodes.iter().all(|&node| space.contains(node)));
        let apart = (0..72).flat_map(|a| (0..a).map(move |b| (a, b))).map(|(a, b)| nodes[a].distance(nodes[b]));
        let nearest = apart.fold(f32::INFINITY, f32::min);
        assert!(nearest > 0.7, "two nodes {nearest} m apart");
        assert_eq!(nodes, place_nodes(&space, 72, 1).expect("the same again"));
        assert_ne!(nodes, place_nodes(&space, 72, 2).expect("others"));
    }

    #[test]
    fn every_free_place_has_a_node_within_sight_and_two_metres_nearly_always() {
        let world = office::generate(&OfficeOptions::default());
        let space = office_space();
        let nodes = place_nodes(&space, 72, 1).expect("room for 72");
        let occluders = Occluders::new(&world.surfaces);
        let eye = |point: Point2| Point3::new(point.x, point.y, 1.3);
        let cells: Vec<Point2> = space.cell_centers().step_by(50).collect();
        let is_served = |cell: &&Point2| {
            nodes.iter().any(|&node| node.distance(**cell) < 2.0 && occluders.is_visible(eye(node), eye(**cell)))
        };
        let served = cells.iter().filter(is_served).count();
        assert!(served * 100 >= cells.len() * 97, "{served} of {}", cells.len());
    }

    #[test]
    fn as_many_nodes_as_cells_fill_them_and_more_or_none_are_refused() {
        let space = office_space();
        let cell_count = space.cell_centers().len();
        assert!(place_nodes(&space, 0, 1).is_err());
        let error = place_nodes(&space, cell_count + 1, 1).expect_err("too many");
        assert!(error.to_string().contains(&format!("1 to {cell_count} nodes")), "{error}");
    }
}

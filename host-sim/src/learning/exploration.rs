//! What came of exploring: the path, the floor it covers, and the nodes dropped along it.

use super::PlaceNodesError;
use super::place_nodes::Clusters;
use crate::world::FreeSpace;
use edgeloc::explore::Ending;
use edgeloc::geometry::Point2;
use std::collections::HashMap;

/// Free floor counts as covered up to this way from the path \[m\].
pub const COVER_REACH_M: f32 = 1.5;

/// Path this near to where the robot passed before leads over no new ground \[m\].
const NEW_GROUND_M: f32 = 0.5;

/// What the robot has just passed does not count as passed before \[m\].
const JUST_PASSED_M: f64 = 2.0;

/// How the robot explored.
#[derive(Debug, Clone, PartialEq)]
pub struct Exploration {
    /// Where the robot stood when it scanned, from the start, in the world frame; straight in between.
    pub path: Vec<Point2>,
    /// How it ended, in the robot's words.
    pub ending: Ending,
    /// Motions that were stopped by a surface.
    pub collision_count: usize,
    /// Least distance from the robot's center to a surface on the whole path \[m\].
    pub least_clearance_m: f32,
}

impl Exploration {
    /// Length of the path \[m\].
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.path.windows(2).map(|pair| f64::from(pair[0].distance(pair[1]))).sum()
    }

    /// For each free cell whether it was covered: whether a way of at most [`COVER_REACH_M`] over free cells leads there
    /// from the path, so that a wall separates.
    #[must_use]
    pub fn covered_cells(&self, space: &FreeSpace) -> Vec<bool> {
        let mut clusters = Clusters::new(space.cell_centers().len());
        let passed = self.points(0.5 * space.cell_m()).filter_map(|point| space.number_at(point));
        clusters.grow(space, passed.map(|cell| (0, cell)));
        let reach = (10.0 * COVER_REACH_M / space.cell_m()) as usize;
        clusters.ways.iter().map(|&way| way <= reach).collect()
    }

    /// Share of the free cells that was covered.
    #[must_use]
    pub fn coverage(&self, space: &FreeSpace) -> f64 {
        let covered = self.covered_cells(space);
        covered.iter().filter(|&&is_covered| is_covered).count() as f64 / covered.len().max(1) as f64
    }

    /// Points along the path, at most `spacing_m` apart.
    fn points(&self, spacing_m: f32) -> impl Iterator<Item = Point2> + '_ {
        let legs = self.path.windows(2).flat_map(move |pair| {
            let count = (pair[0].distance(pair[1]) / spacing_m) as u16 + 1;
            (0..count).map(move |index| pair[0].lerp(pair[1], f32::from(index) / f32::from(count)))
        });
        legs.chain(self.path.last().copied())
    }

    /// Drops `count` nodes evenly along the path where it leads over new ground, each in the middle of its piece.
    ///
    /// The paper's nodes are "uniformly distributed along a pre-defined path". An exploring robot comes along some ways
    /// twice, and a second node where one stands already would leave another place without.
    ///
    /// # Errors
    /// When there is no room for so many on the path.
    pub fn drop_nodes(&self, space: &FreeSpace, count: usize) -> Result<Vec<Point2>, PlaceNodesError> {
        let ground = self.new_ground(space);
        if count == 0 || count > ground.len() {
            return Err(PlaceNodesError { count, cell_count: ground.len(), area_m2: space.area_m2() });
        }
        let middle = |index: usize| ground[(2 * index + 1) * ground.len() / (2 * count)];
        Ok((0..count).map(middle).collect())
    }

    /// The centers of the free cells that the path passes through where it leads over new ground, in its order.
    fn new_ground(&self, space: &FreeSpace) -> Vec<Point2> {
        let centers: Vec<Point2> = space.cell_centers().collect();
        let spacing_m = 0.5 * space.cell_m();
        let square = |point: Point2| [point.x, point.y].map(|at| libm::floorf(at / NEW_GROUND_M) as i32);
        let mut passed: HashMap<[i32; 2], Vec<(f64, Point2)>> = HashMap::new();
        let (mut along_m, mut last) = (0.0, None::<Point2>);
        let mut ground = Vec::new();
        for point in self.points(spacing_m) {
            along_m += last.map_or(0.0, |last| f64::from(last.distance(point)));
            last = Some(point);
            let [x, y] = square(point);
            let around = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| [x + dx, y + dy]));
            let is_before =
                |&(at_m, other): &(f64, Point2)| at_m < along_m - JUST_PASSED_M && other.distance(point) < NEW_GROUND_M;
            let is_old = around.filter_map(|square| passed.get(&square)).flatten().any(is_before);
            passed.entry([x, y]).or_default().push((along_m, point));
            if let (false, Some(cell)) = (is_old, space.number_at(point))
                && ground.last() != Some(&centers[cell])
            {
                ground.push(centers[cell]);
            }
        }
        ground
    }
}

//! What of a world is indoors, by the two rules of [`super::FreeSpace`].

use super::FreeSpaceOptions;
use super::coverage::{Coverage, Grid, Slab};
use super::distance::squared_distances;
use crate::world::Surfaces;
use edgeloc::geometry::Point3;

/// Radius of the ball that finds the outside of the world \[m\]: it does not pass openings twice as wide.
pub(super) const OUTSIDE_BALL_M: f64 = 1.25;

/// How far from z = 0 a floor may lie \[m\].
const FLOOR_TOLERANCE_M: f64 = 0.1;

/// Which rule found the region.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum IndoorRule {
    WalledIn,
    FloorAndCeiling,
}

/// What is indoors.
pub(super) struct Indoors {
    pub(super) rule: IndoorRule,
    pub(super) regions: Vec<Vec<usize>>,
    /// For each cell of the grid whether the robot touches nothing there, indoors or not.
    pub(super) is_clear: Vec<bool>,
}

/// The indoor regions by the rule that gives the larger one.
pub(super) fn indoor_regions(surfaces: &Surfaces, grid: &Grid, options: &FreeSpaceOptions) -> Indoors {
    let is_touched = touched_cells(surfaces, grid, options);
    let level_in = |low: f64, high: f64| {
        let mut coverage = Coverage::new(grid);
        for triangle in triangles(surfaces).filter(is_level) {
            coverage.add(&triangle, Slab { low, high });
        }
        coverage.cells()
    };
    let has_floor = level_in(-FLOOR_TOLERANCE_M, FLOOR_TOLERANCE_M.min(f64::from(options.slice_m.1)));
    let has_ceiling = level_in(f64::from(options.slice_m.1), f64::INFINITY);
    let is_clear = clear_cells(grid, &is_touched, options);
    let walled_in = both(&is_clear, &walled_in_cells(grid, &is_touched));
    let walled_in_count = walled_in.iter().filter(|&&is_in| is_in).count();
    let with_floor = both(&walled_in, &has_floor);
    let models_floor = 2 * with_floor.iter().filter(|&&is_in| is_in).count() > walled_in_count;
    let walled_in = regions(grid, if models_floor { &with_floor } else { &walled_in });
    let covered = regions(grid, &both(&is_clear, &both(&has_floor, &has_ceiling)));
    let largest = |regions: &[Vec<usize>]| regions.iter().map(Vec::len).max().unwrap_or(0);
    let (rule, regions) = if largest(&covered) > largest(&walled_in) {
        (IndoorRule::FloorAndCeiling, covered)
    } else {
        (IndoorRule::WalledIn, walled_in)
    };
    Indoors { rule, regions, is_clear }
}

/// Cells that a surface in the robot's height touches.
fn touched_cells(surfaces: &Surfaces, grid: &Grid, options: &FreeSpaceOptions) -> Vec<bool> {
    let slab = Slab { low: f64::from(options.slice_m.0), high: f64::from(options.slice_m.1) };
    let mut touched = Coverage::new(grid);
    for triangle in triangles(surfaces) {
        touched.add(&triangle, slab);
    }
    touched.cells()
}

/// Cells whose center keeps at least the robot's radius from all points of touched cells.
fn clear_cells(grid: &Grid, is_touched: &[bool], options: &FreeSpaceOptions) -> Vec<bool> {
    let reach = f64::from(options.robot_radius_m) / grid.cell_m + core::f64::consts::FRAC_1_SQRT_2;
    squared_distances(grid, is_touched).into_iter().map(|squared| squared as f64 >= reach * reach).collect()
}

/// Cells that the ball does not touch as it rolls round the outside, coming from the border of the grid.
fn walled_in_cells(grid: &Grid, is_touched: &[bool]) -> Vec<bool> {
    let reach = OUTSIDE_BALL_M / grid.cell_m;
    let is_beyond = |squared: i64| squared as f64 >= reach * reach;
    let ball_fits: Vec<bool> = squared_distances(grid, is_touched).into_iter().map(is_beyond).collect();
    let mut ball_passes = vec![false; grid.cell_count()];
    for region in regions(grid, &ball_fits) {
        if region.iter().any(|&cell| grid.is_on_border(cell)) {
            for cell in region {
                ball_passes[cell] = true;
            }
        }
    }
    squared_distances(grid, &ball_passes).into_iter().map(is_beyond).collect()
}

/// Regions of cells connected over their sides, in the order of their first cell.
fn regions(grid: &Grid, is_member: &[bool]) -> Vec<Vec<usize>> {
    let mut is_new = is_member.to_vec();
    let mut regions = Vec::new();
    for first in 0..is_member.len() {
        if !is_new[first] {
            continue;
        }
        is_new[first] = false;
        let mut region = vec![first];
        let mut reached = 0;
        while let Some(&cell) = region.get(reached) {
            reached += 1;
            for beside in grid.beside(cell).into_iter().flatten() {
                if is_new[beside] {
                    is_new[beside] = false;
                    region.push(beside);
                }
            }
        }
        regions.push(region);
    }
    regions
}

fn both(a: &[bool], b: &[bool]) -> Vec<bool> {
    a.iter().zip(b).map(|(&a, &b)| a && b).collect()
}

/// Whether a triangle is less than 45 degrees from level.
fn is_level([a, b, c]: &[[f64; 3]; 3]) -> bool {
    let [u, v] = [b, c].map(|corner| [0, 1, 2].map(|axis| corner[axis] - a[axis]));
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    normal[2] * normal[2] > normal[0] * normal[0] + normal[1] * normal[1]
}

/// The triangles of which all is finite, as coordinates.
pub(in crate::world) fn triangles(surfaces: &Surfaces) -> impl Iterator<Item = [[f64; 3]; 3]> + '_ {
    let corner = |index: u32| {
        let Point3 { x, y, z } = surfaces.vertices.get(index as usize).copied()?;
        [x, y, z].iter().all(|c| c.is_finite()).then(|| [x, y, z].map(f64::from))
    };
    surfaces.triangles.iter().filter_map(move |&[a, b, c]| Some([corner(a)?, corner(b)?, corner(c)?]))
}

//! Free space: where a round robot can be, as an occupancy grid of the one largest connected indoor region.
//!
//! A cell is *clear* when no surface within the robot's height comes nearer to its center than the robot's radius,
//! counted by cells and rounded against the robot. Of the clear cells those are *indoors* that
//! - are walled in: a ball of 2.5 m diameter that rolls round the outside of the world, not passing doors and windows,
//!   never touches them (and there is floor below them, if the world models its floor at all), or
//! - lie between a floor and a ceiling, for buildings with a wider opening.
//!
//! Of the regions either rule gives, connected over the sides of their cells, the largest one is the free space. Floors
//! and ceilings are surfaces less than 45 degrees from level, a floor within 10 cm of z = 0.

mod coverage;
mod distance;
mod indoor;

use super::{Surfaces, WireframeWorld};
use crate::random::Stream;
use coverage::Grid;
use edgeloc::geometry::{Heading, Point2};
use edgeloc::math;
use indoor::{IndoorRule, Indoors, OUTSIDE_BALL_M, indoor_regions};

pub(super) use coverage::{Slab, outline};
pub(super) use indoor::triangles;

/// The most cells a grid may have, about 100 m by 100 m at 5 cm: bounds the memory that a world file can ask for.
const MAX_CELL_COUNT: f64 = 4e6;

/// The most rows of cells that all triangles together may reach over, each counted for itself: each costs a step in
/// each of three passes, together a few seconds. A furnished flat of 100,000 triangles needs 200,000.
const MAX_ROW_STEPS: usize = 50_000_000;

/// In place of a number, for a cell that is not free.
const NOT_FREE: u32 = u32::MAX;

/// What the robot needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeSpaceOptions {
    /// Radius of the robot \[m\], 0 to 5.
    pub robot_radius_m: f32,
    /// Heights above the floor between which it must not touch anything \[m\]. Carpets and doorsteps are lower.
    pub slice_m: (f32, f32),
    /// Side of a cell \[m\], 0.01 to 1.
    pub cell_m: f32,
}

impl Default for FreeSpaceOptions {
    /// A robot of 0.25 m radius with its camera at 1 m, on cells of 5 cm.
    fn default() -> Self {
        Self { robot_radius_m: 0.25, slice_m: (0.05, 1.15), cell_m: 0.05 }
    }
}

/// The cells where a robot can stand; all can be reached from each other.
#[derive(Debug, Clone)]
pub struct FreeSpace {
    grid: Grid,
    /// Which cells of the grid are free.
    cells: Vec<usize>,
    /// For each cell of the grid its place in `cells`, or [`NOT_FREE`].
    numbers: Vec<u32>,
    exits: Vec<[Point2; 2]>,
    options: FreeSpaceOptions,
    rule: IndoorRule,
    other_regions: Regions,
}

/// How many regions, and how many cells they have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Regions {
    region_count: usize,
    cell_count: usize,
}

impl FreeSpace {
    /// Finds the free space of a world.
    ///
    /// # Errors
    /// When an option is out of range, the world has no surfaces or too large ones for the grid, or when nothing in it
    /// is indoors and wide enough for the robot.
    pub fn of(world: &WireframeWorld, options: &FreeSpaceOptions) -> Result<Self, FreeSpaceError> {
        Self::choose(world, options, |_, regions| {
            let largest = regions.iter().enumerate().max_by_key(|(index, cells)| (cells.len(), usize::MAX - index));
            Ok(largest.map_or(0, |(index, _)| index))
        })
    }

    /// The indoor region that holds `place`, which need not be the largest one: a closed room, say.
    ///
    /// # Errors
    /// As [`Self::of`], and when the robot can't stand at `place`.
    pub fn around(world: &WireframeWorld, options: &FreeSpaceOptions, place: Point2) -> Result<Self, FreeSpaceError> {
        Self::choose(world, options, |grid, regions| {
            let cell = grid.cell_at(place);
            let holds = |cells: &Vec<usize>| cell.is_some_and(|cell| cells.contains(&cell));
            regions.iter().position(holds).ok_or(FreeSpaceError::NotFree { x_m: place.x, y_m: place.y })
        })
    }

    /// The region with the index that `chosen` tells.
    fn choose(
        world: &WireframeWorld,
        options: &FreeSpaceOptions,
        chosen: impl FnOnce(&Grid, &[Vec<usize>]) -> Result<usize, FreeSpaceError>,
    ) -> Result<Self, FreeSpaceError> {
        check(options)?;
        let grid = grid_over(&world.surfaces, options)?;
        check_row_steps(&world.surfaces, &grid)?;
        let Indoors { rule, mut regions, is_clear } = indoor_regions(&world.surfaces, &grid, options);
        if regions.is_empty() {
            return Err(FreeSpaceError::NoRoom { world: world.name.clone(), robot_radius_m: options.robot_radius_m });
        }
        let mut cells = regions.swap_remove(chosen(&grid, &regions)?);
        cells.sort_unstable();
        let mut numbers = vec![NOT_FREE; grid.cell_count()];
        for (number, &cell) in (0_u32..).zip(&cells) {
            numbers[cell] = number;
        }
        let is_outside = |cell: usize| is_clear[cell] && numbers[cell] == NOT_FREE;
        let exits = cells.iter().flat_map(|&cell| grid.sides(cell).filter(|&(beside, _)| is_outside(beside)));
        let exits = exits.map(|(_, side)| side).collect();
        let other_regions = Regions { region_count: regions.len(), cell_count: regions.iter().map(Vec::len).sum() };
        Ok(Self { grid, cells, numbers, exits, options: *options, rule, other_regions })
    }

    /// Whether the cell at a point of the floor is free.
    #[must_use]
    pub fn contains(&self, point: Point2) -> bool {
        self.grid.cell_at(point).is_some_and(|cell| self.numbers[cell] != NOT_FREE)
    }

    /// How far a robot at `from` can drive along `heading` before it meets something, `most_m` at most \[m\].
    #[must_use]
    pub fn free_way_m(&self, from: Point2, heading: Heading, most_m: f32) -> f32 {
        let (sin, cos) = math::sin_cos(heading.angle().radians());
        let step_m = 0.25 * self.cell_m();
        let at = |way_m: f32| Point2::new(from.x + way_m * cos, from.y + way_m * sin);
        let steps = (most_m / step_m) as u32;
        let free = (1..=steps).take_while(|step| self.contains(at(*step as f32 * step_m))).count();
        if free == steps as usize && self.contains(at(most_m)) { most_m } else { free as f32 * step_m }
    }

    /// The number of the free cell at a point of the floor, as in [`Self::cell_centers`].
    pub(crate) fn number_at(&self, point: Point2) -> Option<usize> {
        let number = self.numbers[self.grid.cell_at(point)?];
        (number != NOT_FREE).then_some(number as usize)
    }

    /// Where the robot could leave: sides of free cells beyond which it touches nothing either, in doors to the outside.
    #[must_use]
    pub fn exits(&self) -> &[[Point2; 2]] {
        &self.exits
    }

    /// What the robot needs, as this was found for.
    #[must_use]
    pub const fn options(&self) -> &FreeSpaceOptions {
        &self.options
    }

    /// Area of the free cells \[m2\].
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        self.area_of(self.cells.len())
    }

    /// Centers of the free cells, row by row from the south, in a row from the west.
    pub fn cell_centers(&self) -> impl ExactSizeIterator<Item = Point2> + '_ {
        self.cells.iter().map(|&cell| self.grid.center(cell))
    }

    /// A point uniform over the free cells.
    pub fn sample(&self, stream: &mut Stream) -> Point2 {
        self.sample_cell(self.grid.center(self.cells[stream.index(self.cells.len())]), stream)
    }

    /// A point uniform over the cell about `center`.
    pub(crate) fn sample_cell(&self, center: Point2, stream: &mut Stream) -> Point2 {
        let half = 0.5 * f64::from(self.options.cell_m);
        let mut beside = |coordinate: f32| coordinate + stream.uniform(-half, half) as f32;
        Point2::new(beside(center.x), beside(center.y))
    }

    /// South-west corner of the grid \[m\].
    #[must_use]
    pub fn origin(&self) -> Point2 {
        Point2::new(self.grid.west as f32, self.grid.south as f32)
    }

    /// Side of a cell \[m\].
    #[must_use]
    pub const fn cell_m(&self) -> f32 {
        self.options.cell_m
    }

    /// Indoor regions that were left out because they are not connected to this one.
    #[must_use]
    pub const fn other_region_count(&self) -> usize {
        self.other_regions.region_count
    }

    /// Their area \[m2\].
    #[must_use]
    pub fn other_regions_m2(&self) -> f64 {
        self.area_of(self.other_regions.cell_count)
    }

    /// One line that says what was found, and how.
    #[must_use]
    pub fn describe(&self) -> String {
        let rule = match self.rule {
            IndoorRule::WalledIn => "walled in",
            IndoorRule::FloorAndCeiling => "between a floor and a ceiling",
        };
        let FreeSpaceOptions { robot_radius_m, cell_m, .. } = self.options;
        format!(
            "{:.1} m2 of free space {rule}, for a robot of {robot_radius_m} m radius on cells of {cell_m} m; \
             {} other indoor regions of together {:.1} m2 cannot be reached from it and are left out",
            self.area_m2(),
            self.other_region_count(),
            self.other_regions_m2()
        )
    }

    /// The cells next to a free cell with the way there in tenths of a cell; a step across a corner needs both cells
    /// beside it free. Cells are numbered as in [`Self::cell_centers`].
    pub(crate) fn neighbors(&self, cell: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        const STEPS: [(isize, isize, usize); 8] =
            [(1, 0, 10), (-1, 0, 10), (0, 1, 10), (0, -1, 10), (1, 1, 14), (-1, 1, 14), (1, -1, 14), (-1, -1, 14)];
        let at = self.cells[cell];
        // The border of the grid is never free, so a step from a free cell stays inside.
        let number =
            move |dx: isize, dy: isize| self.numbers[at.wrapping_add_signed(dx + dy * self.grid.width as isize)];
        let is_open = move |dx, dy| number(dx, dy) != NOT_FREE;
        STEPS
            .into_iter()
            .filter(move |&(dx, dy, _)| is_open(dx, dy) && is_open(dx, 0) && is_open(0, dy))
            .map(move |(dx, dy, tenths)| (number(dx, dy) as usize, tenths))
    }

    fn area_of(&self, cell_count: usize) -> f64 {
        cell_count as f64 * f64::from(self.options.cell_m) * f64::from(self.options.cell_m)
    }
}

fn check(options: &FreeSpaceOptions) -> Result<(), FreeSpaceError> {
    let (low, high) = options.slice_m;
    let checks = [
        ((0.0..=5.0).contains(&options.robot_radius_m), "robot radius", "0 to 5 m"),
        (low.is_finite() && high.is_finite() && low < high, "height slice", "a lower and a higher height"),
        ((0.01..=1.0).contains(&options.cell_m), "cell size", "0.01 to 1 m"),
    ];
    match checks.into_iter().find(|(holds, _, _)| !holds) {
        Some((_, name, range)) => Err(FreeSpaceError::Option { name, range }),
        None => Ok(()),
    }
}

/// A grid over all surfaces, with a border along which the ball of the outside can roll.
fn grid_over(surfaces: &Surfaces, options: &FreeSpaceOptions) -> Result<Grid, FreeSpaceError> {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for corners in triangles(surfaces) {
        for corner in corners {
            for (axis, coordinate) in [corner[0], corner[1]].into_iter().enumerate() {
                low[axis] = low[axis].min(coordinate);
                high[axis] = high[axis].max(coordinate);
            }
        }
    }
    if low[0] > high[0] {
        return Err(FreeSpaceError::NoSurfaces);
    }
    let cell_m = f64::from(options.cell_m);
    let border = OUTSIDE_BALL_M.max(f64::from(options.robot_radius_m)) + 3.0 * cell_m;
    let [width, height] = [0, 1].map(|axis| libm::ceil((high[axis] - low[axis] + 2.0 * border) / cell_m));
    if width * height > MAX_CELL_COUNT {
        let (width_m, depth_m) = (high[0] - low[0], high[1] - low[1]);
        return Err(FreeSpaceError::TooLarge { width_m, depth_m, cell_m, max_cell_count: MAX_CELL_COUNT as usize });
    }
    Ok(Grid { west: low[0] - border, south: low[1] - border, cell_m, width: width as usize, height: height as usize })
}

/// Refuses surfaces that would take too long to lay on the grid.
fn check_row_steps(surfaces: &Surfaces, grid: &Grid) -> Result<(), FreeSpaceError> {
    let row_count = |corners: [[f64; 3]; 3]| {
        let [a, b, c] = corners.map(|corner| corner[1]);
        let rows = grid.rows(a.min(b).min(c), a.max(b).max(c));
        rows.end() + 1 - rows.start()
    };
    let row_steps = triangles(surfaces).map(row_count).fold(0, usize::saturating_add);
    if row_steps > MAX_ROW_STEPS {
        return Err(FreeSpaceError::TooManyLargeTriangles { row_steps, max_row_steps: MAX_ROW_STEPS });
    }
    Ok(())
}

/// Why a world has no free space.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FreeSpaceError {
    /// An option is out of range.
    #[error("the {name} of the free space is out of range; give {range}")]
    Option {
        /// Which one.
        name: &'static str,
        /// What it may be.
        range: &'static str,
    },
    /// There is nothing to stand on or to bump into.
    #[error("the world has no surfaces, so where a robot can stand is unknown; import a model with surfaces")]
    NoSurfaces,
    /// The grid would be too large.
    #[error(
        "the world's surfaces extend over {width_m:.0} m x {depth_m:.0} m, more than {max_cell_count} cells of \
         {cell_m} m; leave out what is far from the building, check the unit of length, or ask for larger cells"
    )]
    TooLarge {
        /// Extent along x \[m\].
        width_m: f64,
        /// Extent along y \[m\].
        depth_m: f64,
        /// Side of a cell \[m\].
        cell_m: f64,
        /// The most cells there may be.
        max_cell_count: usize,
    },
    /// Laying the triangles on the grid would take too long.
    #[error(
        "the world's triangles reach over {row_steps} rows of cells, added up, more than {max_row_steps}; leave out \
         large surfaces of many triangles, such as terrain, simplify the meshes, or ask for larger cells"
    )]
    TooManyLargeTriangles {
        /// Rows, added up over the triangles.
        row_steps: usize,
        /// The most there may be.
        max_row_steps: usize,
    },
    /// The place is in no indoor region.
    #[error(
        "the robot can't stand at {x_m}, {y_m} m: it would touch something, or the place is not indoors; \
         `edgeloc world view` draws free space tinted"
    )]
    NotFree {
        /// East of the origin \[m\].
        x_m: f32,
        /// North of the origin \[m\].
        y_m: f32,
    },
    /// Nothing is indoors and free.
    #[error(
        "the world {world:?} has no indoor place for a robot of {robot_radius_m} m radius: nothing is walled in or \
         lies between a floor at z = 0 and a ceiling; check the unit, that z points up and that the floor is at \
         z = 0, or ask for a smaller robot"
    )]
    NoRoom {
        /// Name of the world.
        world: String,
        /// Radius asked for \[m\].
        robot_radius_m: f32,
    },
}

#[cfg(test)]
mod tests;

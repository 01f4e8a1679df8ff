//! Exploring a world with the on-robot explorer: the robot drives, the simulated range sensor looks.
//!
//! The robot starts in the middle of a free cell, with a heading drawn by seed; it knows neither. Its odometry is exact:
//! correcting drift is another subject, and the nodes of the map are where the robot believes them to be anyhow. A
//! motion that would bring a surface within the robot's radius stops there and is counted as a collision. Doors to the
//! outside are closed ([`FreeSpace::exits`]): beyond them there is no end of floor to explore, and none of the building.

use super::Exploration;
use crate::random::Stream;
use crate::world::{FreeSpace, Outlines, RangeSensor, RangeSensorOptions, WireframeWorld};
use edgeloc::explore::{Action, Cell, ExploreConfig, ExploreError, Explorer, Motion, Odometry, RangeScan, ScanError};
use edgeloc::geometry::{Angle, Heading, Point2};
use edgeloc::math;

/// A motion is checked for collisions this often \[m\].
const CHECK_M: f32 = 0.01;

/// Beyond the building the robot's grid leaves room for what the sensor sees through windows and doors \[m\].
const OUTSIDE_M: f32 = 16.0;

/// A robot that explores a world: what it knows of itself, what it sees with and what it bumps with.
#[derive(Debug, Clone)]
pub struct ExploringRobot {
    config: ExploreConfig,
    sensor: RangeSensor,
    body: Outlines,
}

impl ExploringRobot {
    /// The robot that `space` was found for, in that world; its grid is large enough for the building.
    #[must_use]
    pub fn new(world: &WireframeWorld, space: &FreeSpace, sensor: &RangeSensorOptions) -> Self {
        let sensor = RangeSensor::with_closed(&world.surfaces, sensor, space.exits());
        let body = Outlines::new(&world.surfaces, space.options().slice_m);
        let reference = ExploreConfig::reference();
        let side_m = body.extent_m() + OUTSIDE_M;
        let side_cells = ((side_m / reference.cell_m) as u16).clamp(64, 4096).next_power_of_two();
        let config = ExploreConfig { robot_radius_m: space.options().robot_radius_m, side_cells, ..reference };
        Self { config, sensor, body }
    }
}

/// How far exploring has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExplorationProgress {
    /// Scans taken.
    pub scans: usize,
    /// Length of the path \[m\].
    pub length_m: f32,
    /// Floor covered, as the robot counts it \[m2\].
    pub covered_m2: f32,
}

/// Lets the robot explore from `start`; `seed` selects its heading and the noise of its sensor, `step` is told of each
/// motion.
///
/// # Errors
/// When the robot can't stand at `start` or a setting is out of range.
pub fn explore(
    space: &FreeSpace,
    robot: &ExploringRobot,
    start: Point2,
    seed: u64,
    mut step: impl FnMut(&ExplorationProgress),
) -> Result<Exploration, ExplorationError> {
    let not_free = ExplorationError::NotFree { x_m: start.x, y_m: start.y };
    let origin = space.cell_centers().nth(space.number_at(start).ok_or(not_free)?).ok_or(not_free)?;
    let turn = Stream::new(seed, "explore", 0, 0).uniform(0.0, core::f64::consts::TAU);
    let mut cells = vec![Cell::EMPTY; Explorer::cell_count(&robot.config)];
    let mut explorer = Explorer::new(&robot.config, &mut cells).map_err(ExplorationError::Explorer)?;
    let mut odometry = Odometry { position: Point2::default(), heading: heading(turn as f32) };
    let in_world = |position: Point2| Point2::new(origin.x + position.x, origin.y + position.y);
    let (mut path, mut length_m) = (vec![origin], 0.0);
    let mut body = Body {
        outlines: &robot.body,
        radius_m: space.options().robot_radius_m,
        collision_count: 0,
        least_clearance_m: f32::INFINITY,
    };
    loop {
        let mut noise = Stream::new(seed, "range", path.len() as u64, 0);
        let ranges = robot.sensor.scan(in_world(odometry.position), odometry.heading, &mut noise);
        let scan = RangeScan::new(&ranges, robot.sensor.options().max_range_m).map_err(ExplorationError::Scan)?;
        match explorer.step(&odometry, &scan) {
            Action::Move(motion) => odometry = body.moved(&odometry, &motion, in_world),
            Action::Finish(ending) => {
                let Body { collision_count, least_clearance_m, .. } = body;
                return Ok(Exploration { path, ending, collision_count, least_clearance_m });
            }
        }
        let position = in_world(odometry.position);
        length_m += path.last().map_or(0.0, |last| last.distance(position));
        path.push(position);
        step(&ExplorationProgress { scans: path.len(), length_m, covered_m2: explorer.covered_m2() });
    }
}

/// The robot as a body among surfaces.
struct Body<'a> {
    outlines: &'a Outlines,
    radius_m: f32,
    collision_count: usize,
    least_clearance_m: f32,
}

impl Body<'_> {
    /// Where a motion leads; it ends before the robot would touch something.
    fn moved(&mut self, from: &Odometry, motion: &Motion, in_world: impl Fn(Point2) -> Point2) -> Odometry {
        let heading = heading(from.heading.angle().radians() + motion.turn.radians());
        let (sin, cos) = math::sin_cos(heading.angle().radians());
        let count = (motion.advance_m / CHECK_M) as u16 + 1;
        let mut position = from.position;
        for index in 1..=count {
            let along_m = motion.advance_m * f32::from(index) / f32::from(count);
            let next = Point2::new(from.position.x + cos * along_m, from.position.y + sin * along_m);
            let clearance_m = self.outlines.clearance_m(in_world(next), 2.0 * self.radius_m);
            self.least_clearance_m = self.least_clearance_m.min(clearance_m);
            if clearance_m < self.radius_m {
                self.collision_count += 1;
                break;
            }
            position = next;
        }
        Odometry { position, heading }
    }
}

fn heading(radians: f32) -> Heading {
    Heading::new(Angle::from_radians(radians)).expect("a few turns at most")
}

/// Why a world can't be explored.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ExplorationError {
    /// The start is not free.
    #[error("the robot can't stand at {x_m}, {y_m} m; `edgeloc world view` draws free space tinted")]
    NotFree {
        /// East of the origin \[m\].
        x_m: f32,
        /// North of the origin \[m\].
        y_m: f32,
    },
    /// A parameter of the explorer is out of range.
    #[error("the robot can't explore: {0}")]
    Explorer(ExploreError),
    /// The sensor's settings are out of range.
    #[error("the range sensor is none: {0}")]
    Scan(ScanError),
}

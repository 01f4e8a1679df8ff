//! The explorer: one scan in, one motion out.

use super::closed_room;
use super::config::{ExploreConfig, ExploreConfigError};
use super::grid::{At, Cell, Grid, NONE};
use super::near_field::NearField;
use super::scan::RangeScan;
use super::search::Clearances;
use crate::geometry::{Angle, CapacityError, Heading, Point2};
use crate::math;
use core::fmt;

/// The robot follows a wall for as long as it covers new floor within this way \[m\].
const BARREN_M: f32 = 1.5;

/// Having come to a place worth going to, it follows the wall there at first for this much of [`BARREN_M`].
const BARREN_ON_ARRIVAL_M: f32 = 0.75;

/// A scan that covers fewer cells anew covers nothing new.
const NEW_CELLS: u32 = 20;

/// Headings that wall following tries, evenly around.
const HEADING_COUNT: u8 = 72;

/// Where nothing can be done but look for another way this often, the robot takes another scan.
const ATTEMPTS: u8 = 64;

/// Where the robot is, from odometry: since the start, along axes of its own choice.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Odometry {
    /// Position from that of the first scan \[m\].
    pub position: Point2,
    /// Heading from the first axis, counter-clockwise.
    pub heading: Heading,
}

/// What the robot does before the next scan: turn on the spot, then go straight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// The turn.
    pub turn: Angle,
    /// How far to go afterwards \[m\].
    pub advance_m: f32,
}

/// What comes next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Action {
    /// Move, then scan again.
    Move(Motion),
    /// Exploring is over.
    Finish(Ending),
}

/// How exploring ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ending {
    /// All that can be reached is explored, rooms and what connects them.
    Explored {
        /// Floor on which the robot can stand \[m2\].
        reachable_m2: f32,
    },
    /// All that can be reached is explored, and it is one room without a way out: most of it was seen in one look.
    ClosedRoom {
        /// Floor on which the robot can stand \[m2\].
        reachable_m2: f32,
    },
    /// The robot gave up after as many motions as it may make.
    StepLimit,
}

/// What the robot is about.
#[derive(Debug, Clone, Copy)]
enum Mode {
    FollowWall {
        /// Way since new floor was covered \[m\].
        barren_m: f32,
    },
    GoTo {
        target: At,
        /// Number of the cell on the way where the robot is.
        reached: u32,
    },
    Finished(Ending),
}

/// Explores a building: follows walls, goes where it has not been, and knows when it is done.
#[derive(Debug)]
pub struct Explorer<'m> {
    config: ExploreConfig,
    clearances: Clearances,
    grid: Grid<'m>,
    near: NearField,
    mode: Mode,
    step_count: u32,
    covered_cells: u32,
    /// Most floor seen in one scan \[m2\].
    widest_look_m2: f32,
}

impl<'m> Explorer<'m> {
    /// How many [`Cell`]s an explorer works on.
    #[must_use]
    pub const fn cell_count(config: &ExploreConfig) -> usize {
        config.side_cells as usize * config.side_cells as usize
    }

    /// An explorer that knows nothing yet, in the caller's memory.
    ///
    /// # Errors
    /// When a parameter is out of range or there are too few cells.
    pub fn new(config: &ExploreConfig, cells: &'m mut [Cell]) -> Result<Self, ExploreError> {
        let config = config.checked().map_err(ExploreError::Config)?;
        let (capacity, needed) = (cells.len(), Self::cell_count(&config));
        let what = "cells of the explorer's grid";
        let cells = cells.get_mut(..needed).ok_or(ExploreError::Memory(CapacityError { what, capacity, needed }))?;
        Ok(Self {
            config,
            clearances: Clearances::new(&config),
            grid: Grid::new(cells, config.side_cells, config.cell_m),
            near: NearField::new(),
            mode: Mode::FollowWall { barren_m: 0.0 },
            step_count: 0,
            covered_cells: 0,
            widest_look_m2: 0.0,
        })
    }

    /// Takes in a scan and where it was made, and says what to do next.
    pub fn step(&mut self, odometry: &Odometry, scan: &RangeScan<'_>) -> Action {
        if let Mode::Finished(ending) = self.mode {
            return Action::Finish(ending);
        }
        let heading_rad = odometry.heading.angle().radians();
        self.near.update(heading_rad, scan);
        self.widest_look_m2 = math::max(self.widest_look_m2, closed_room::seen_m2(scan));
        let new_cells = self.grid.record(odometry.position, heading_rad, scan, self.config.cover_m);
        self.covered_cells += new_cells;
        if self.step_count == self.config.max_steps {
            return self.finish(Ending::StepLimit);
        }
        self.step_count += 1;
        if let Some(motion) = self.follow_wall(heading_rad, new_cells >= NEW_CELLS) {
            return Action::Move(motion);
        }
        self.go_on(odometry.position, heading_rad)
    }

    /// Floor covered so far: seen from within [`ExploreConfig::cover_m`] \[m2\].
    #[must_use]
    pub fn covered_m2(&self) -> f32 {
        self.grid.area_m2(self.covered_cells as usize)
    }

    fn finish(&mut self, ending: Ending) -> Action {
        self.mode = Mode::Finished(ending);
        Action::Finish(ending)
    }

    /// The right-hand rule with object avoidance: of the headings from the right to the left, the first along which the
    /// robot keeps its gap; straight on where no wall is near. None when following leads to nothing new.
    fn follow_wall(&mut self, heading_rad: f32, is_new: bool) -> Option<Motion> {
        let Mode::FollowWall { barren_m } = &mut self.mode else { return None };
        *barren_m = if is_new { 0.0 } else { *barren_m };
        if *barren_m >= BARREN_M {
            return None;
        }
        let ExploreConfig { robot_radius_m, margin_m, wall_gap_m, step_m, .. } = self.config;
        let wall_reach_m = robot_radius_m + wall_gap_m + 2.0 * step_m;
        let has_wall = self.near.has_wall_at_right(heading_rad, wall_reach_m);
        let first_rad = heading_rad - if has_wall { core::f32::consts::FRAC_PI_2 } else { 0.0 };
        for gap_m in [wall_gap_m, 0.5 * (wall_gap_m + margin_m)] {
            for index in 0..HEADING_COUNT {
                let turn = f32::from(index) * core::f32::consts::TAU / f32::from(HEADING_COUNT);
                let (sin, cos) = math::sin_cos(first_rad + turn);
                let target = Point2::new(cos * step_m, sin * step_m);
                if self.near.clearance_on_way_m(target) >= robot_radius_m + gap_m {
                    *barren_m += step_m;
                    let turn = Angle::from_radians(first_rad + turn - heading_rad).wrapped();
                    return Some(Motion { turn, advance_m: step_m });
                }
            }
        }
        None
    }

    /// Goes on along the way to the nearest place worth going to, or finds it; ends when there is none.
    fn go_on(&mut self, position: Point2, heading_rad: f32) -> Action {
        let mut is_way_new = false;
        for _ in 0..ATTEMPTS {
            let Mode::GoTo { target, reached } = self.mode else {
                match self.grid.find_nearest(self.grid.at(position), &self.clearances) {
                    Some(target) => {
                        let reached = self.grid.number(self.grid.at(position));
                        self.mode = Mode::GoTo { target, reached };
                        is_way_new = true;
                        continue;
                    }
                    None => return self.finish_explored(),
                }
            };
            if !self.grid.is_worth_going(target) {
                self.mode = Mode::FollowWall { barren_m: BARREN_ON_ARRIVAL_M };
                if self.near.has_wall_at_right(heading_rad, 2.0 * self.config.robot_radius_m + self.config.step_m)
                    && let Some(motion) = self.follow_wall(heading_rad, false)
                {
                    return Action::Move(motion);
                }
                continue;
            }
            if let Some((motion, number)) = self.farthest_on_way(position, heading_rad, reached) {
                self.mode = Mode::GoTo { target, reached: number };
                return Action::Move(motion);
            }
            // A way just found that can't be gone is none: what stands there was taken for free.
            if is_way_new {
                let next = self.grid.numbered(reached).next;
                let blocked = if next == NONE { target } else { self.grid.place(next) };
                self.grid.block(blocked);
            }
            self.mode = Mode::FollowWall { barren_m: BARREN_M };
        }
        Action::Move(Motion { turn: Angle::default(), advance_m: 0.0 })
    }

    /// The motion to the farthest cell on the way, within a step, that keeps clear of what is near, and its number.
    fn farthest_on_way(&mut self, position: Point2, heading_rad: f32, reached: u32) -> Option<(Motion, u32)> {
        let ExploreConfig { robot_radius_m, margin_m, step_m, .. } = self.config;
        // Where the robot is put down too near to something, it may go wherever it comes no nearer.
        let least_m = math::min(robot_radius_m + margin_m, self.near.clearance_m() - 0.5 * margin_m);
        let mut farthest = None;
        let mut number = self.grid.numbered(reached).next;
        while number != NONE {
            let center = self.grid.center(self.grid.place(number));
            let target = Point2::new(center.x - position.x, center.y - position.y);
            let advance_m = math::length(target.x, target.y);
            if advance_m > step_m + self.config.cell_m || self.near.clearance_on_way_m(target) < least_m {
                break;
            }
            let turn = Angle::from_radians(math::atan2(target.y, target.x) - heading_rad).wrapped();
            farthest = Some((Motion { turn, advance_m }, number));
            number = self.grid.numbered(number).next;
        }
        farthest
    }

    fn finish_explored(&mut self) -> Action {
        let reachable_m2 = self.grid.reached_m2();
        let is_one_room = self.grid.is_one_room(self.widest_look_m2);
        self.finish(if is_one_room { Ending::ClosedRoom { reachable_m2 } } else { Ending::Explored { reachable_m2 } })
    }
}

/// Why there is no explorer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExploreError {
    /// A parameter is out of range.
    Config(ExploreConfigError),
    /// The memory is too small.
    Memory(CapacityError),
}

impl fmt::Display for ExploreError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Config(error) => error.fmt(f),
            Self::Memory(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for ExploreError {}

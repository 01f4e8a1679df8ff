//! The parameters of exploring, all in one place.

use core::fmt;

/// What the robot is like and how it explores.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExploreConfig {
    /// Radius of the robot \[m\], 0.05 to 1.
    pub robot_radius_m: f32,
    /// Kept between the robot and all that is seen \[m\], 0.005 to 0.2: the sensor's noise and what a motion is off.
    pub margin_m: f32,
    /// Kept between the robot and the wall it follows, and wherever there is room \[m\], at least the margin, to 1.
    pub wall_gap_m: f32,
    /// Floor counts as covered when the robot has seen it from this near \[m\], 0.3 to 5.
    pub cover_m: f32,
    /// Longest motion between two scans \[m\], 0.05 to 1.
    pub step_m: f32,
    /// Side of a cell of the grid \[m\], 0.02 to 0.2; robot and margin must be within 15 cells.
    pub cell_m: f32,
    /// Cells along a side of the grid: a power of two, 64 to 4096. The building must be smaller than the grid, wherever
    /// in it the robot starts.
    pub side_cells: u16,
    /// Motions after which the robot gives up, at least 1.
    pub max_steps: u32,
}

impl ExploreConfig {
    /// A robot of 0.25 m radius in a building of up to 51 m by 51 m, on cells of 5 cm: 8 MiB.
    #[must_use]
    pub const fn reference() -> Self {
        Self {
            robot_radius_m: 0.25,
            margin_m: 0.02,
            wall_gap_m: 0.15,
            cover_m: 1.2,
            step_m: 0.25,
            cell_m: 0.05,
            side_cells: 1024,
            max_steps: 20_000,
        }
    }

    /// The parameters themselves, if all are in range.
    ///
    /// # Errors
    /// When one is not: the first such.
    pub fn checked(self) -> Result<Self, ExploreConfigError> {
        let least_cells = (self.robot_radius_m + self.margin_m) / self.cell_m;
        let checks = [
            ((0.05..=1.0).contains(&self.robot_radius_m), ExploreConfigError::RobotRadius),
            ((0.005..=0.2).contains(&self.margin_m), ExploreConfigError::Margin),
            ((self.margin_m..=1.0).contains(&self.wall_gap_m), ExploreConfigError::WallGap),
            ((0.3..=5.0).contains(&self.cover_m), ExploreConfigError::Cover),
            ((0.05..=1.0).contains(&self.step_m), ExploreConfigError::Step),
            ((0.02..=0.2).contains(&self.cell_m) && least_cells <= 15.0, ExploreConfigError::Cell),
            (
                self.side_cells.is_power_of_two() && (64..=4096).contains(&self.side_cells),
                ExploreConfigError::SideCells,
            ),
            (self.max_steps > 0, ExploreConfigError::MaxSteps),
        ];
        match checks.into_iter().find(|(holds, _)| !holds) {
            Some((_, error)) => Err(error),
            None => Ok(self),
        }
    }
}

/// Which parameter is out of range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExploreConfigError {
    /// The robot's radius is not within 0.05 to 1 m.
    RobotRadius,
    /// The margin is not within 0.005 to 0.2 m.
    Margin,
    /// The gap to the wall is not within the margin to 1 m.
    WallGap,
    /// The distance of cover is not within 0.3 to 5 m.
    Cover,
    /// The motion between scans is not within 0.05 to 1 m.
    Step,
    /// The side of a cell is not within 0.02 to 0.2 m, or too small for the robot.
    Cell,
    /// The side of the grid is not a power of two within 64 to 4096 cells.
    SideCells,
    /// The number of motions is zero.
    MaxSteps,
}

impl fmt::Display for ExploreConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::RobotRadius => "robot radius is not within 0.05 to 1 m",
            Self::Margin => "margin is not within 0.005 to 0.2 m",
            Self::WallGap => "gap to the wall is not within the margin to 1 m",
            Self::Cover => "distance of cover is not within 0.3 to 5 m",
            Self::Step => "motion between scans is not within 0.05 to 1 m",
            Self::Cell => "side of a cell is not within 0.02 to 0.2 m, or a 15th of the robot's radius and margin",
            Self::SideCells => "side of the grid is not a power of two within 64 to 4096 cells",
            Self::MaxSteps => "number of motions is zero",
        })
    }
}

impl core::error::Error for ExploreConfigError {}

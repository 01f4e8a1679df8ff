//! What the robot hands to the localiser after each look around.

use crate::geometry::{Angle, Heading, Point2, Scene};
use crate::math;

/// One look: what was seen, and what is known of how the camera stood.
#[derive(Debug, Clone, Copy)]
pub struct Look<'a> {
    /// The compass heading of the left camera's optical axis, if there is a compass.
    pub heading: Option<HeadingPrior>,
    /// How the robot moved since the look before, if it can tell; `None` at the first look.
    pub motion_since_last: Option<Motion>,
    /// The segments of the left image.
    pub scene: Scene<'a>,
}

/// A measured heading with its spread.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeadingPrior {
    /// The measured heading.
    pub mean: Heading,
    /// Standard deviation of its error.
    pub standard_deviation: Angle,
}

impl HeadingPrior {
    /// A heading taken as exact.
    #[must_use]
    pub const fn exact(mean: Heading) -> Self {
        Self { mean, standard_deviation: Angle::from_radians(0.0) }
    }
}

/// What the robot did between two looks, measured by odometry. The paper's localiser relies on the compass alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// The turn made.
    pub turn: Angle,
    /// Standard deviation of its error.
    pub turn_standard_deviation: Angle,
    /// The step made, in the robot's frame before the turn: x forward, y left \[m\].
    pub step_m: Point2,
    /// Standard deviation of its error, along either axis \[m\].
    pub step_standard_deviation_m: f32,
}

impl Motion {
    /// A turn on the spot, taken as exact.
    #[must_use]
    pub const fn exact_turn(turn: Angle) -> Self {
        Self {
            turn,
            turn_standard_deviation: Angle::from_radians(0.0),
            step_m: Point2::new(0.0, 0.0),
            step_standard_deviation_m: 0.0,
        }
    }

    /// A turn, and after it a way straight ahead \[m\], taken as exact: what a [`super::Decision::LookAgain`] asks for.
    #[must_use]
    pub fn exact(turn: Angle, ahead_m: f32) -> Self {
        let (sin, cos) = math::sin_cos(turn.radians());
        Self { step_m: Point2::new(ahead_m * cos, ahead_m * sin), ..Self::exact_turn(turn) }
    }
}

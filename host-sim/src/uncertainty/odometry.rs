//! Odometry error: how far the robot turned and drove is not exactly what it reports.
//!
//! Every turn and every step is reported longer or shorter by a Gaussian share of itself, drawn in each look: slipping
//! wheels, a gyro's scale. The localiser is told that share as its spread; without this source it is told the truth as
//! exact, and of a robot without odometry nothing. No image changes.
//!
//! In looks alone: the path of learning is closed and smoothed. A source of ours; the paper's robot only turns.

use super::setting::source;
use super::{ActsIn, SourceFacts, UncertaintySource};
use crate::random::Stream;
use edgeloc::geometry::Angle;
use edgeloc::localize::Motion;
use edgeloc::math;

const FACTS: SourceFacts = SourceFacts {
    key: "odometry",
    name: "odometry error",
    symbol: "",
    unit: "share of the motion",
    stream_id: 15,
    is_enabled_by_default: false,
    default_magnitude: 0.01,
    legal_range: (0.0, 0.5),
    acts_in: ActsIn::Looks,
    cause: "wheels that slip and a gyro's scale make turns and steps be reported longer or shorter by a Gaussian of that \
            standard deviation",
    citation: "ours",
};

source! {
    /// Misreports turns and steps; the magnitude is the standard deviation of the error, as a share of the motion.
    pub struct Odometry: FACTS {
        /// Whether the robot reports its motion at all; without odometry it is never asked to move, only to turn.
        pub available: bool = true,
    }
}

impl UncertaintySource for Odometry {}

impl Odometry {
    /// What odometry tells of a turn and a way straight ahead after it \[m\].
    pub(super) fn read(&self, turn: Angle, ahead_m: f32, stream: &mut Stream) -> Motion {
        let [turn_error, step_error] = stream.circular_gaussian().map(|error| (error * self.magnitude) as f32);
        let told_turn = Angle::from_radians(turn.radians() * (1.0 + turn_error));
        let spread = self.magnitude as f32;
        Motion {
            turn_standard_deviation: Angle::from_radians(turn.radians().abs() * spread),
            // Sideways the way errs by its own turn.
            step_standard_deviation_m: ahead_m * spread * math::length(1.0, turn.radians()),
            ..Motion::exact(told_turn, ahead_m * (1.0 + step_error))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::{NoiseKey, Sources};
    use edgeloc::geometry::Point2;

    const TURN: Angle = Angle::from_degrees(60.0);

    fn told(odometry: Odometry, look: u32) -> Option<Motion> {
        Sources { odometry, ..Sources::none() }.odometry_reading(TURN, 1.0, &NoiseKey::look(5, 0, look))
    }

    #[test]
    fn zero_magnitude_and_a_source_that_is_off_tell_the_truth_as_exact() {
        for odometry in [Odometry { enabled: true, magnitude: 0.0, ..Odometry::default() }, Odometry::default()] {
            assert_eq!(told(odometry, 0), Some(Motion::exact(TURN, 1.0)));
        }
    }

    #[test]
    fn a_robot_without_odometry_is_told_nothing_whether_it_would_err_or_not() {
        for enabled in [false, true] {
            assert_eq!(told(Odometry { enabled, available: false, ..Odometry::default() }, 0), None);
        }
    }

    #[test]
    fn turns_and_steps_err_by_the_share_told() {
        const LOOKS: u32 = 4000;
        let odometry = Odometry { enabled: true, magnitude: 0.02, ..Odometry::default() };
        let motions: Vec<Motion> = (0..LOOKS).filter_map(|look| told(odometry, look)).collect();
        let spread = |value: &dyn Fn(&Motion) -> f32| {
            let sum: f32 = motions.iter().map(|motion| (value(motion) - 1.0).powi(2)).sum();
            (sum / LOOKS as f32).sqrt()
        };
        let turned = |motion: &Motion| motion.turn.radians() / TURN.radians();
        let driven = |motion: &Motion| motion.step_m.distance(Point2::default());
        for spread in [spread(&turned), spread(&driven)] {
            assert!((spread - 0.02).abs() < 0.002, "{spread}");
        }
        let first = motions.first().expect("a motion");
        assert!((first.turn_standard_deviation.degrees() - 1.2).abs() < 1e-4);
        let aside = |motion: &Motion| (motion.step_m.y * 0.5 - motion.step_m.x * 0.866_025_4).powi(2);
        let sideways = (motions.iter().map(aside).sum::<f32>() / LOOKS as f32).sqrt();
        assert!((sideways - 0.02 * TURN.radians()).abs() < 0.002, "{sideways}");
        assert!((0.02..0.02 * 1.5).contains(&first.step_standard_deviation_m));
    }
}

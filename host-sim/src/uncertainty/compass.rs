//! Compass error: the heading that the localiser is told is not the true one.
//!
//! The whole error has the standard deviation given. A part of its variance is a bias, steel and wiring about the robot,
//! drawn once a trial; the rest is noise, drawn in each look. The localiser is told the wrong heading and, as its
//! spread, that standard deviation; without this source it is told the truth as exact, and of a robot without a compass
//! nothing. No image changes.
//!
//! In looks alone: a map is made along headings that many readings and odometry agree on. A source of ours; the paper
//! expects the orientation to be known (section 3.2).

use super::setting::source;
use super::{ActsIn, SourceFacts, UncertaintySource};
use crate::random::Stream;
use edgeloc::geometry::{Angle, Heading};
use edgeloc::localize::HeadingPrior;

const FACTS: SourceFacts = SourceFacts {
    key: "compass",
    name: "compass error",
    symbol: "",
    unit: "degrees",
    stream_id: 10,
    is_enabled_by_default: false,
    default_magnitude: 2.0,
    legal_range: (0.0, 90.0),
    acts_in: ActsIn::Looks,
    cause: "iron nearby (a bias each trial) and noise (each look) turn the heading told by a Gaussian of that standard \
            deviation in all",
    citation: "ours",
};

source! {
    /// Tells a wrong heading; the magnitude is the standard deviation of its error, in degrees.
    pub struct Compass: FACTS {
        /// Share of the error's variance that is a bias, the same in all looks of a trial; the rest is noise.
        pub bias_share: f64 in 0.0 to 1.0 = 0.5,
        /// Whether the robot has a compass at all; without one the localiser is told no heading, whatever the rest says.
        pub available: bool = true,
    }
}

impl UncertaintySource for Compass {}

impl Compass {
    /// What the compass tells of `heading`, with the draws of the whole trial and of the look.
    pub(super) fn read(&self, heading: Heading, of_trial: &mut Stream, of_look: &mut Stream) -> HeadingPrior {
        let ([bias, _], [noise, _]) = (of_trial.circular_gaussian(), of_look.circular_gaussian());
        let error = bias * self.bias_share.sqrt() + noise * (1.0 - self.bias_share).sqrt();
        let turn = Angle::from_degrees((error * self.magnitude) as f32);
        HeadingPrior {
            // A Gaussian of 90 degrees stays far below a thousand turns.
            mean: heading.turned(turn).unwrap_or(heading),
            standard_deviation: Angle::from_degrees(self.magnitude as f32),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::{NoiseKey, Sources};

    const TRIALS: u64 = 4000;

    /// The errors of two looks of many trials, in degrees.
    fn errors_deg(compass: Compass) -> Vec<[f64; 2]> {
        let sources = Sources { compass, ..Sources::none() };
        let heading = Heading::new(Angle::from_degrees(100.0)).expect("finite");
        let error_deg = |trial, look| {
            let told = sources.compass_reading(heading, &NoiseKey::look(5, trial, look)).expect("a compass");
            assert!((f64::from(told.standard_deviation.degrees()) - compass.magnitude).abs() < 1e-5);
            f64::from(told.mean.angle().degrees() - heading.angle().degrees())
        };
        (0..TRIALS).map(|trial| [error_deg(trial, 0), error_deg(trial, 1)]).collect()
    }

    fn mean(errors: &[[f64; 2]], value: impl Fn(&[f64; 2]) -> f64) -> f64 {
        errors.iter().map(value).sum::<f64>() / TRIALS as f64
    }

    #[test]
    fn zero_magnitude_and_a_source_that_is_off_tell_the_truth_as_exact() {
        let heading = Heading::new(Angle::from_degrees(-70.0)).expect("finite");
        for compass in [Compass { enabled: true, magnitude: 0.0, ..Compass::default() }, Compass::default()] {
            let sources = Sources { compass, ..Sources::none() };
            let told = sources.compass_reading(heading, &NoiseKey::look(5, 0, 0));
            assert_eq!(told, Some(HeadingPrior::exact(heading)));
        }
    }

    #[test]
    fn a_robot_without_a_compass_is_told_nothing_whether_it_would_err_or_not() {
        for enabled in [false, true] {
            let compass = Compass { enabled, available: false, ..Compass::default() };
            let sources = Sources { compass, ..Sources::none() };
            assert_eq!(sources.compass_reading(Heading::default(), &NoiseKey::look(5, 0, 0)), None);
        }
    }

    #[test]
    fn errors_have_the_spread_told_and_share_half_their_variance_within_a_trial() {
        let errors = errors_deg(Compass { enabled: true, ..Compass::default() });
        for look in [0, 1] {
            assert!(mean(&errors, |error| error[look]).abs() < 0.1);
            assert!((mean(&errors, |error| error[look] * error[look]) - 4.0).abs() < 0.3);
        }
        assert!((mean(&errors, |error| error[0] * error[1]) - 2.0).abs() < 0.25);
    }

    #[test]
    fn a_bias_alone_is_the_same_in_every_look_and_noise_alone_in_none() {
        let errors = errors_deg(Compass { enabled: true, bias_share: 1.0, ..Compass::default() });
        assert!(errors.iter().all(|[first, second]| (first - second).abs() < 1e-3));
        let errors = errors_deg(Compass { enabled: true, bias_share: 0.0, ..Compass::default() });
        assert!(mean(&errors, |error| error[0] * error[1]).abs() < 0.2);
    }
}

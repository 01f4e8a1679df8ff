//! The direction a camera looks, as a compass gives it.

use super::Angle;

/// Yaw of the optical axis in the world frame, counter-clockwise from +x, in `(-pi, pi]`.
///
/// Convert a magnetic compass (clockwise from north) at the sensor boundary.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Heading {
    angle: Angle,
}

impl Heading {
    /// A heading from an angle; `None` unless the angle is finite and within a thousand turns.
    #[must_use]
    pub fn new(angle: Angle) -> Option<Self> {
        let in_range = angle.radians().is_finite() && crate::math::abs(angle.radians()) < 6_283.0;
        in_range.then(|| Self { angle: angle.wrapped() })
    }

    /// The heading as an angle in `(-pi, pi]`.
    #[must_use]
    pub const fn angle(self) -> Angle {
        self.angle
    }

    /// The heading after turning by `turn`; `None` if the turn is not finite or beyond a thousand turns.
    #[must_use]
    pub fn turned(self, turn: Angle) -> Option<Self> {
        Self::new(Angle::from_radians(self.angle.radians() + turn.radians()))
    }
}

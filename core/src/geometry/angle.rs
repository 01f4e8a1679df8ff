//! Angles: radians for people, binary angles for the kernels.

use crate::math;
use core::f32::consts::{PI, TAU};

/// An angle or turn, in radians, not wrapped. Positive is counter-clockwise seen from above.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default)]
pub struct Angle {
    radians: f32,
}

impl Angle {
    /// An angle given in radians.
    #[must_use]
    pub const fn from_radians(radians: f32) -> Self {
        Self { radians }
    }

    /// An angle given in degrees.
    #[must_use]
    pub const fn from_degrees(degrees: f32) -> Self {
        Self { radians: degrees * (PI / 180.0) }
    }

    /// The angle in radians.
    #[must_use]
    pub const fn radians(self) -> f32 {
        self.radians
    }

    /// The angle in degrees.
    #[must_use]
    pub const fn degrees(self) -> f32 {
        self.radians * (180.0 / PI)
    }

    /// The same direction in `(-pi, pi]`.
    #[must_use]
    pub fn wrapped(self) -> Self {
        let turns = math::floor((self.radians + PI) / TAU);
        let radians = self.radians - turns * TAU;
        Self { radians: if radians <= -PI { radians + TAU } else { radians } }
    }
}

/// A direction as a fraction of a period: 65,536 steps are one period, so that wrapping is free.
///
/// The period is pi for undirected lines and 2 pi for directed ones; the holder knows which.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct BinaryAngle(pub u16);

impl BinaryAngle {
    /// Rounds `radians` to steps of `period_radians / 65536`, modulo the period.
    #[must_use]
    pub fn from_radians(radians: f32, period_radians: f32) -> Self {
        let steps = math::round_to_i32(radians / period_radians * 65_536.0);
        // The angles of this library are a few periods at most, so the steps fit an i32; the mask wraps.
        Self((steps & 0xffff) as u16)
    }

    /// The angle from `reference` to `self`, wrapped into one period.
    #[must_use]
    pub const fn relative_to(self, reference: Self) -> Self {
        Self(self.0.wrapping_sub(reference.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrapped_angles_lie_in_the_half_open_turn() {
        for degrees in [-720.0_f32, -540.0, -180.0, -179.0, 0.0, 179.0, 180.0, 181.0, 360.0, 540.0, 1000.0] {
            let wrapped = Angle::from_degrees(degrees).wrapped().radians();
            assert!(wrapped > -PI - 1e-5 && wrapped <= PI + 1e-5, "{degrees} gave {wrapped}");
        }
    }

    #[test]
    fn a_binary_angle_wraps_at_its_period() {
        assert_eq!(BinaryAngle::from_radians(PI, PI), BinaryAngle(0));
        assert_eq!(BinaryAngle::from_radians(PI / 2.0, PI), BinaryAngle(0x8000));
        assert_eq!(BinaryAngle::from_radians(-PI / 2.0, TAU), BinaryAngle(0xc000));
        assert_eq!(BinaryAngle(10).relative_to(BinaryAngle(20)), BinaryAngle(65_526));
    }
}

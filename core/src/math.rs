//! The float functions of this library, from one backend on every machine.
//!
//! `std` calls the platform's C library, whose results differ between machines in the last bit. `libm` is the same
//! Rust code everywhere, so host and target agree bit for bit. Nothing else in this crate calls a float function.

/// Square root of `x`, correctly rounded.
#[must_use]
pub fn sqrt(x: f32) -> f32 {
    libm::sqrtf(x)
}

/// Sine and cosine of `radians`.
#[must_use]
pub fn sin_cos(radians: f32) -> (f32, f32) {
    libm::sincosf(radians)
}

/// Tangent of `radians`.
#[must_use]
pub fn tan(radians: f32) -> f32 {
    libm::tanf(radians)
}

/// Angle of the vector `(x, y)` in radians, in `[-pi, pi]`.
#[must_use]
pub fn atan2(y: f32, x: f32) -> f32 {
    libm::atan2f(y, x)
}

/// Nearest integer to `x`, halves away from zero.
#[must_use]
pub fn round(x: f32) -> f32 {
    libm::roundf(x)
}

/// Nearest integer to `x`, halves away from zero, for magnitudes up to 2^30: [`round`] without a call.
#[must_use]
#[inline]
pub fn round_to_i32(x: f32) -> i32 {
    let whole = x as i32;
    // Exact: from 2^23 on there is no fraction.
    let fraction = x - whole as f32;
    whole + i32::from(fraction >= 0.5) - i32::from(fraction <= -0.5)
}

/// Largest integer not above `x`.
#[must_use]
pub fn floor(x: f32) -> f32 {
    libm::floorf(x)
}

/// The greater of `a` and `b`; of equals, and beside a NaN, `a`. (`f32::max` leaves the sign of zero open.)
#[must_use]
pub fn max(a: f32, b: f32) -> f32 {
    if b > a { b } else { a }
}

/// The lesser of `a` and `b`; of equals, and beside a NaN, `a`.
#[must_use]
pub fn min(a: f32, b: f32) -> f32 {
    if b < a { b } else { a }
}

/// Magnitude of `x`.
#[must_use]
pub fn abs(x: f32) -> f32 {
    libm::fabsf(x)
}

/// Length of the vector `(x, y)` by the plain formula: both well inside the range of `f32`.
#[must_use]
pub fn length(x: f32, y: f32) -> f32 {
    sqrt(x * x + y * y)
}

/// `e` to the power `x`.
#[must_use]
pub fn exp(x: f32) -> f32 {
    libm::expf(x)
}

/// Double precision, for what is worked out rarely and ill-conditioned: the calibration of the cameras.
pub mod double {
    /// Square root of `x`, correctly rounded.
    #[must_use]
    pub fn sqrt(x: f64) -> f64 {
        libm::sqrt(x)
    }

    /// Sine and cosine of `radians`.
    #[must_use]
    pub fn sin_cos(radians: f64) -> (f64, f64) {
        libm::sincos(radians)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_without_a_call_is_rounding() {
        let near = |x: f32| (-3..=3).map(move |steps: i32| f32::from_bits(x.to_bits().wrapping_add(steps as u32)));
        let halves = (0..4000).map(|half| half as f32 * 0.5);
        let large = (0..30).map(|exponent| (1_u32 << exponent) as f32 + 0.5);
        for x in halves.chain(large).filter(|x| *x > 0.0).flat_map(near).chain([0.0, 1.0e-30]) {
            assert_eq!(round_to_i32(x), round(x) as i32, "{x}");
            assert_eq!(round_to_i32(-x), round(-x) as i32, "-{x}");
        }
    }
}

//! Square roots of shares of a mass, in arithmetic that every machine rounds alike.

/// Square root of the share that `mass` is of a total whose reciprocal is `per_mass`, in Q15; one is `i16::MAX`.
///
/// Two steps of Newton's iteration for the inverse root from the well-known guess at the bits: single-precision
/// multiplications and subtractions only, so that a loop over bins becomes vectors on any machine that has them. Within
/// two thirds of a unit of the last place.
#[inline(always)]
pub(super) fn root_q15(mass: i32, per_mass: f32) -> i32 {
    let share = mass as f32 * per_mass;
    let half = 0.5 * share;
    let mut inverse = f32::from_bits(0x5f37_5a86 - (share.to_bits() >> 1));
    inverse *= 1.5 - half * inverse * inverse;
    inverse *= 1.5 - half * inverse * inverse;
    // The nearest integer to the root times 2^15, as below: the last bit of a sum with 384 is worth 2^-15.
    const SHIFT: f32 = 384.0;
    let root = (share * inverse + SHIFT).to_bits().wrapping_sub(SHIFT.to_bits()) as i32;
    root.min(i32::from(i16::MAX))
}

const SHIFT: f32 = 12_582_912.0;

#[inline(always)]
fn nearest_bits(x: f32) -> u32 {
    (x + SHIFT).to_bits()
}

/// The integer nearest to `x`, to the even one from halfway, within 2^22 on either side: the last bit of a sum with
/// 3 x 2^22 is worth one.
#[inline(always)]
pub(super) fn nearest(x: f32) -> i32 {
    nearest_bits(x).wrapping_sub(SHIFT.to_bits()) as i32
}

/// The same for `x` that isn't negative, with one operation less where constants have to be fetched.
#[inline(always)]
pub(super) fn nearest_natural(x: f32) -> i32 {
    (nearest_bits(x) & 0x3f_ffff) as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_within_two_thirds_of_a_unit_of_the_last_place() {
        let mut worst = 0.0_f64;
        for step in 0..200_000_u64 {
            let mass = ((step * step * 27) % (1 << 30)) as i32;
            let exact = (f64::from(mass) / f64::from(1 << 30)).sqrt() * 32_768.0;
            let root = root_q15(mass, 1.0 / (1 << 30) as f32);
            worst = worst.max((f64::from(root) - exact.min(32_767.0)).abs());
        }
        assert!(worst <= 0.667, "worst error {worst} units");
    }

    #[test]
    fn one_saturates_and_zero_is_zero() {
        assert_eq!(root_q15(1 << 30, 1.0 / (1 << 30) as f32), i32::from(i16::MAX));
        assert_eq!(root_q15(0, 1.0), 0);
        assert_eq!(root_q15(1, 1.0 / (1 << 30) as f32), 1);
    }

    #[test]
    fn the_nearest_integer_is_found() {
        for (x, expected) in [(0.0, 0), (0.49, 0), (0.51, 1), (-7.6, -8), (4_194_303.0, 4_194_303)] {
            assert_eq!(nearest(x), expected, "{x}");
            assert!(x < 0.0 || nearest_natural(x) == expected, "{x}");
        }
    }
}

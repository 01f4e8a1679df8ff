//! Square roots of fractions, by a table with linear interpolation.

/// Roots of `i / 512` for `i` from 128 to 512, in Q20: 384 intervals over `[1/4, 1]`.
const TABLE: [u32; 385] = {
    let mut table = [0; 385];
    let mut i = 0;
    while i < table.len() {
        // floor(sqrt(x * 2^40)) for x = (128 + i) / 512, rounded by one more bit.
        let twice = (((128 + i as u64) << 33) as u128).isqrt() as u32;
        table[i] = (twice + 1) >> 1;
        i += 1;
    }
    table
};

/// Square root of a fraction in Q30 (at most one), in Q15, within two units of the last place; one is `i16::MAX`.
pub(super) fn root_q15(fraction_q30: u32) -> i16 {
    if fraction_q30 == 0 {
        return 0;
    }
    // Shift by whole bit pairs until the fraction lies in [1/4, 1]: the root then shifts by half as many bits.
    let pairs = (fraction_q30.leading_zeros().saturating_sub(2)) / 2;
    let mantissa = fraction_q30 << (2 * pairs);
    let index = (mantissa >> 21) as usize - 128;
    let (below, above) = (TABLE[index.min(384)], TABLE[(index + 1).min(384)]);
    let part = mantissa & ((1 << 21) - 1);
    let root_q20 = below + (((above - below) * (part >> 9)) >> 12);
    let shift = 5 + pairs;
    let rounded = (root_q20 + ((1 << shift) >> 1)) >> shift;
    rounded.min(i16::MAX as u32) as i16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_within_two_units_of_the_last_place() {
        let mut worst = 0.0_f64;
        for step in 0..200_000_u64 {
            let fraction = ((step * step * 27) % (1 << 30)) as u32;
            let exact = (f64::from(fraction) / f64::from(1 << 30)).sqrt() * 32_768.0;
            worst = worst.max((f64::from(root_q15(fraction)) - exact.min(32_767.0)).abs());
        }
        assert!(worst <= 1.5, "worst error {worst} units");
    }

    #[test]
    fn one_saturates_and_zero_is_zero() {
        assert_eq!(root_q15(1 << 30), i16::MAX);
        assert_eq!(root_q15(0), 0);
        assert_eq!(root_q15(1), 1);
    }
}

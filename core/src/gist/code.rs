//! From a layout to a code: the directions that tell places apart.

use super::{EdgeLayout, FEATURES};
use zerocopy::little_endian::I16;

/// Numbers of a code.
pub const AXES: usize = 64;

/// A layout along [`AXES`] axes, of length about 254: the dot product of two codes is their cosine times
/// [`ONE`](super::ONE).
pub type Code = [i8; AXES];

/// Length of a code before its numbers are cut to those of an `i8`.
const LENGTH: i64 = 254;

/// The linear map from layouts to codes, read in place.
#[derive(Debug, Clone, Copy)]
pub struct Projection<'a> {
    /// The mean layout.
    pub mean: &'a [I16; FEATURES],
    /// The axes, each within 8191 of zero.
    pub axes: &'a [[I16; FEATURES]; AXES],
}

impl Projection<'_> {
    /// The code of a layout; all zero when the layout is the mean one.
    #[must_use]
    pub fn code(&self, layout: &EdgeLayout) -> Code {
        let mut apart = [0_i16; FEATURES];
        for ((apart, seen), mean) in apart.iter_mut().zip(layout).zip(self.mean) {
            *apart = seen.saturating_sub(mean.get()).clamp(-8191, 8191);
        }
        let along = self.axes.each_ref().map(|axis| dot(&apart, axis) >> 10);
        // Each of them is below 2^25 in magnitude.
        let square = along.iter().fold(0_u64, |sum, along| sum.saturating_add((along * along).unsigned_abs()));
        let length = square.isqrt().max(1) as i64;
        along.map(|along| {
            let doubled = 2 * LENGTH * along;
            let rounded = (doubled + if along < 0 { -length } else { length }) / (2 * length);
            rounded.clamp(-127, 127) as i8
        })
    }
}

/// Products of numbers within 8191 of zero: thirty-two of them fit an `i32`; others wrap.
fn dot(a: &[i16; FEATURES], b: &[I16; FEATURES]) -> i64 {
    let (a, b) = (a.as_chunks::<32>().0, b.as_chunks::<32>().0);
    a.iter().zip(b).fold(0, |sum, (a, b)| {
        let products = a.iter().zip(b).map(|(a, b)| i32::from(*a) * i32::from(b.get()));
        sum + i64::from(products.fold(0_i32, i32::wrapping_add))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Axes that each take up one number of a layout.
    fn plain(scale: i16) -> std::boxed::Box<[[I16; FEATURES]; AXES]> {
        let mut axes = std::boxed::Box::new([[I16::new(0); FEATURES]; AXES]);
        for (index, axis) in axes.iter_mut().enumerate() {
            axis[index] = I16::new(scale);
        }
        axes
    }

    #[test]
    fn a_code_has_its_length_whatever_the_scale() {
        let (mean, axes) = ([I16::new(5); FEATURES], plain(8191));
        let projection = Projection { mean: &mean, axes: &axes };
        for scale in [40_i16, 400, 4000] {
            let mut layout = [5_i16; FEATURES];
            layout.iter_mut().take(AXES).enumerate().for_each(|(index, root)| *root += scale * (index as i16 % 3 - 1));
            let code = projection.code(&layout);
            let square: i32 = code.iter().map(|part| i32::from(*part) * i32::from(*part)).sum();
            assert!((i64::from(square) - LENGTH * LENGTH).abs() < 2_000, "{square}");
        }
    }

    #[test]
    fn the_mean_layout_has_no_code_and_absurd_axes_are_survived() {
        let (mean, axes) = ([I16::new(7); FEATURES], [[I16::new(i16::MIN); FEATURES]; AXES]);
        let projection = Projection { mean: &mean, axes: &axes };
        assert_eq!(projection.code(&[7; FEATURES]), [0; AXES]);
        let _ = projection.code(&[i16::MIN; FEATURES]);
        let _ = projection.code(&[i16::MAX; FEATURES]);
    }
}

//! Adding up a histogram line by line, where there are no vectors.
//!
//! The same numbers as a block's [`shares`](Frame::shares), with nothing worked out that a line has not got: one of ten adds
//! nothing, two of three lie within a distance bin, most others within two.

use super::block::LineBlock;
use super::frame::{BIN, Frame, POSITION_BITS};
use super::root::nearest_natural;

/// Adds what the lines have in `frame` to `masses`, `[distance][angle]`, and returns the total.
#[inline(never)]
pub(super) fn add(masses: &mut [i32], frame: &Frame<'_>, lines: &[LineBlock], angle_bins: usize) -> u32 {
    let end = frame.axes.end;
    let mut total = 0_i32;
    for line in lines {
        let (start, span) = frame.extent(line, 0);
        let (low, high) = (start.max(0), start.wrapping_add(span).min(end));
        if low >= high {
            continue;
        }
        let (column, above) = frame.angle(line, 0);
        // The nearest bin may be the one behind the last, which is the first.
        let column = if column as usize == angle_bins { 0 } else { column as usize };
        let density = line.mass[0] / span as f32;
        let mut put = |row: i32, width: i32| {
            let mass = density * width as f32;
            let (whole, above) = (nearest_natural(mass), nearest_natural(mass * above));
            total = total.wrapping_add(whole);
            let place = (row as usize).wrapping_mul(angle_bins).wrapping_add(column);
            let next = place.wrapping_add(1);
            let next = if column.wrapping_add(1) == angle_bins { next.wrapping_sub(angle_bins) } else { next };
            if let Some(bin) = masses.get_mut(place) {
                *bin = bin.wrapping_add(whole.wrapping_sub(above));
            }
            if let Some(bin) = masses.get_mut(next) {
                *bin = bin.wrapping_add(above);
            }
        };
        let (first, last) = (low >> POSITION_BITS, high >> POSITION_BITS);
        if first == last {
            put(first, high.wrapping_sub(low));
            continue;
        }
        put(first, (first.wrapping_add(1) << POSITION_BITS).wrapping_sub(low));
        for between in first.wrapping_add(1)..last {
            put(between, BIN);
        }
        put(last, high & (BIN - 1));
    }
    total as u32
}

//! Chamfer distances: down and up once, a step costs 5 units and a slanted one 7.
//!
//! All channels go hand in hand, a pixel after the other: each pixel waits for the one beside it, the channels do not wait
//! for each other.

use super::channel::CHANNELS;
use super::distance_planes::{COLUMNS, Pixel, UNITS_PER_PIXEL};

const STEP: u8 = UNITS_PER_PIXEL as u8;
const DIAGONAL: u8 = 7;
const FAR: Pixel = [u8::MAX; CHANNELS];

/// Lowers the distance of each pixel in each channel to that of the nearest drawn one, on top of what is drawn there.
pub(super) fn spread(pixels: &mut [Pixel]) {
    // The row before, with a far pixel at either end.
    let mut before = [FAR; COLUMNS + 2];
    for row in pixels.chunks_exact_mut(COLUMNS) {
        let mut beside = FAR;
        for (column, pixel) in row.iter_mut().enumerate() {
            beside = relaxed(pixel, &beside, [&before[column], &before[column + 1], &before[column + 2]]);
            *pixel = beside;
        }
        before[1..=COLUMNS].copy_from_slice(row);
    }
    before = [FAR; COLUMNS + 2];
    for row in pixels.chunks_exact_mut(COLUMNS).rev() {
        let mut beside = FAR;
        for (column, pixel) in row.iter_mut().enumerate().rev() {
            beside = relaxed(pixel, &beside, [&before[column], &before[column + 1], &before[column + 2]]);
            *pixel = beside;
        }
        before[1..=COLUMNS].copy_from_slice(row);
    }
}

/// A pixel after steps from the one beside it and from three of the row before.
#[inline(always)]
fn relaxed(pixel: &Pixel, beside: &Pixel, [slant, straight, other_slant]: [&Pixel; 3]) -> Pixel {
    core::array::from_fn(|channel| {
        let slanted = slant[channel].min(other_slant[channel]).saturating_add(DIAGONAL);
        let stepped = straight[channel].min(beside[channel]).saturating_add(STEP);
        pixel[channel].min(slanted).min(stepped)
    })
}

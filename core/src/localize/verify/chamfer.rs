//! Chamfer distances: down and up once, a step costs 5 units and a slanted one 7.
//!
//! All channels go hand in hand. Steps from the row before are taken by a whole row at a time; those along the row are
//! taken a pixel after the other, for each pixel waits for the one beside it.

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
        step_across(row, &before);
        step_along(row.iter_mut());
        before[1..=COLUMNS].copy_from_slice(row);
    }
    before = [FAR; COLUMNS + 2];
    for row in pixels.chunks_exact_mut(COLUMNS).rev() {
        step_across(row, &before);
        step_along(row.iter_mut().rev());
        before[1..=COLUMNS].copy_from_slice(row);
    }
}

/// Steps from the row before, straight and slanted.
fn step_across(row: &mut [Pixel], before: &[Pixel; COLUMNS + 2]) {
    let [slant, straight, other_slant] = [0, 1, 2].map(|from: usize| before[from..][..COLUMNS].as_flattened());
    for (index, distance) in row.as_flattened_mut().iter_mut().enumerate().take(COLUMNS * CHANNELS) {
        let slanted = slant[index].min(other_slant[index]).saturating_add(DIAGONAL);
        *distance = (*distance).min(slanted).min(straight[index].saturating_add(STEP));
    }
}

/// Steps from each pixel of a row to the next.
fn step_along<'p>(row: impl Iterator<Item = &'p mut Pixel>) {
    let mut beside = FAR;
    for pixel in row {
        for channel in 0..CHANNELS {
            beside[channel] = beside[channel].saturating_add(STEP).min(pixel[channel]);
        }
        *pixel = beside;
    }
}

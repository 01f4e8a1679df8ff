//! Chamfer distances: down and up once, a step costs 5 units and a slanted one 7.
//!
//! All channels go hand in hand. Steps from the row before are taken by a whole row at a time; those along the row are
//! taken a pixel after the other, for each pixel waits for the one beside it.

use super::channel::CHANNELS;
use super::distance_planes::{COLUMNS, Pixel, UNITS_PER_PIXEL};
use crate::matching::lower_by_step;

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
    for (column, step) in [(0, DIAGONAL), (1, STEP), (2, DIAGONAL)] {
        lower_by_step(row.as_flattened_mut(), before[column..][..COLUMNS].as_flattened(), step);
    }
}

/// Steps from each pixel of a row to the next.
fn step_along<'p>(row: impl Iterator<Item = &'p mut Pixel>) {
    let mut beside = FAR;
    for pixel in row {
        lower_by_step(pixel, &beside, STEP);
        beside = *pixel;
    }
}

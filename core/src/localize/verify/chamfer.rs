//! Chamfer distances: down and up once, a step costs 5 units and a slanted one 7.
//!
//! All channels go hand in hand. Steps from the row before are taken by a whole row at a time; those along the row are
//! taken a pixel after the other, for each pixel waits for the one beside it.

use super::channel::CHANNELS;
use super::distance_planes::{COLUMNS, Pixel, UNITS_PER_PIXEL};
use crate::matching::{Quad, lesser, saturating_sum};

const STEP: Quad = [UNITS_PER_PIXEL as u8; 4];
const DIAGONAL: Quad = [7; 4];
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
    let from = |column: usize| quads(&before[column..][..COLUMNS]);
    let sources = from(0).iter().zip(from(1)).zip(from(2));
    let (distances, _) = row.as_flattened_mut().as_chunks_mut();
    for (distance, ((slant, straight), other_slant)) in distances.iter_mut().zip(sources) {
        let slanted = saturating_sum(lesser(*slant, *other_slant), DIAGONAL);
        *distance = lesser(lesser(*distance, slanted), saturating_sum(*straight, STEP));
    }
}

/// Steps from each pixel of a row to the next.
fn step_along<'p>(row: impl Iterator<Item = &'p mut Pixel>) {
    let mut beside = [[u8::MAX; 4]; CHANNELS / 4];
    for pixel in row {
        let (distances, _) = pixel.as_chunks_mut();
        for (beside, distance) in beside.iter_mut().zip(distances) {
            *beside = lesser(*distance, saturating_sum(*beside, STEP));
            *distance = *beside;
        }
    }
}

fn quads(pixels: &[Pixel]) -> &[Quad] {
    pixels.as_flattened().as_chunks().0
}

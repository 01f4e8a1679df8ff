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

#[cfg(test)]
mod tests {
    use super::super::distance_planes::ROWS;
    use super::*;
    use std::vec;

    #[test]
    fn each_pixel_is_as_far_as_the_shortest_way_over_the_grid_to_a_drawn_one() {
        let drawn = [(0, [3, 7], 0), (0, [150, 100], 2), (0, [80, 0], 4), (5, [159, 119], 0), (5, [20, 60], 1)];
        let mut pixels = vec![FAR; COLUMNS * ROWS];
        for (channel, [column, row], distance) in drawn {
            pixels[row * COLUMNS + column][channel] = distance;
        }
        spread(&mut pixels);
        for (index, pixel) in pixels.iter().enumerate() {
            let (column, row) = (index % COLUMNS, index / COLUMNS);
            for (channel, distance) in pixel.iter().enumerate() {
                let ways = drawn.iter().filter(|from| from.0 == channel).map(|(_, [from_column, from_row], from)| {
                    let (across, down) = (column.abs_diff(*from_column), row.abs_diff(*from_row));
                    let slanted = across.min(down);
                    usize::from(*from) + 7 * slanted + 5 * (across.max(down) - slanted)
                });
                let nearest = ways.min().unwrap_or(usize::MAX).min(255);
                assert_eq!(usize::from(*distance), nearest, "channel {channel} at {column}, {row}");
            }
        }
    }
}

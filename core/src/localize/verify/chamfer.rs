//! Chamfer distances in a plane: down and up once, a step costs 5 units and a slanted one 7.
//!
//! Two ways to the same distances. Pixel after pixel, each waits for the one beside it; row by row, a row is relaxed from
//! the one before it and then from ever farther pixels of its own (1, 2, 4 ... 32 away), many pixels at a time.

use super::distance_planes::{COLUMNS, PLANE, ROWS, UNITS_PER_PIXEL};
use crate::matching::{Body, Work, run};

const STEP: u8 = UNITS_PER_PIXEL as u8;
const DIAGONAL: u8 = 7;
/// Distances along a row that double: all that reach no farther than 255 units.
const REACHES: [usize; 6] = [1, 2, 4, 8, 16, 32];
const FARTHEST: usize = REACHES[REACHES.len() - 1];

type Row = [u8; COLUMNS];

/// Lowers each pixel of each plane to its distance from the nearest drawn one, on top of what is drawn there.
pub(super) fn spread(planes: &mut [u8]) {
    run(Spread(planes));
}

struct Spread<'p>(&'p mut [u8]);

impl Work for Spread<'_> {
    type Output = ();

    #[inline(always)]
    fn run<B: Body>(self, _: B) {
        for plane in self.0.chunks_exact_mut(PLANE) {
            if B::IS_WIDE { by_rows(plane) } else { by_pixels(plane) }
        }
    }
}

/// Row after row.
#[inline(always)]
fn by_rows(plane: &mut [u8]) {
    let (rows, _) = plane.as_chunks_mut::<COLUMNS>();
    for pass in [false, true] {
        let mut before = [u8::MAX; COLUMNS];
        for index in 0..rows.len() {
            let row = &mut rows[if pass { ROWS - 1 - index } else { index }];
            relax_from(&before, row);
            if pass { relax_leftwards(row) } else { relax_rightwards(row) }
            before = *row;
        }
    }
}

/// Steps from the row before, straight and slanted.
#[inline(always)]
fn relax_from(before: &Row, row: &mut Row) {
    let mut padded = [u8::MAX; COLUMNS + 2];
    padded[1..=COLUMNS].copy_from_slice(before);
    for (column, pixel) in row.iter_mut().enumerate() {
        let slanted = padded[column].min(padded[column + 2]).saturating_add(DIAGONAL);
        *pixel = (*pixel).min(slanted).min(padded[column + 1].saturating_add(STEP));
    }
}

#[inline(always)]
fn relax_rightwards(row: &mut Row) {
    for reach in REACHES {
        let mut padded = [u8::MAX; FARTHEST + COLUMNS];
        padded[FARTHEST..].copy_from_slice(row);
        for (pixel, left) in row.iter_mut().zip(&padded[FARTHEST - reach..]) {
            *pixel = (*pixel).min(left.saturating_add(STEP * reach as u8));
        }
    }
}

#[inline(always)]
fn relax_leftwards(row: &mut Row) {
    for reach in REACHES {
        let mut padded = [u8::MAX; COLUMNS + FARTHEST];
        padded[..COLUMNS].copy_from_slice(row);
        for (pixel, right) in row.iter_mut().zip(&padded[reach..]) {
            *pixel = (*pixel).min(right.saturating_add(STEP * reach as u8));
        }
    }
}

/// Pixel after pixel.
#[inline(always)]
fn by_pixels(plane: &mut [u8]) {
    let mut relax = |at: usize, neighbors: [(bool, usize, u8); 4]| {
        let mut least = plane[at];
        for (is_inside, neighbor, step) in neighbors {
            if is_inside {
                least = least.min(plane[neighbor].saturating_add(step));
            }
        }
        plane[at] = least;
    };
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let at = row * COLUMNS + column;
            let (above, left, right) = (row > 0, column > 0, column + 1 < COLUMNS);
            relax(
                at,
                [
                    (left, at.wrapping_sub(1), STEP),
                    (above, at.wrapping_sub(COLUMNS), STEP),
                    (above && left, at.wrapping_sub(COLUMNS + 1), DIAGONAL),
                    (above && right, at.wrapping_sub(COLUMNS - 1), DIAGONAL),
                ],
            );
        }
    }
    for row in (0..ROWS).rev() {
        for column in (0..COLUMNS).rev() {
            let at = row * COLUMNS + column;
            let (below, left, right) = (row + 1 < ROWS, column > 0, column + 1 < COLUMNS);
            relax(
                at,
                [
                    (right, at + 1, STEP),
                    (below, at + COLUMNS, STEP),
                    (below && right, at + COLUMNS + 1, DIAGONAL),
                    (below && left, at + COLUMNS - 1, DIAGONAL),
                ],
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::vec;

    proptest! {
        #[test]
        fn rows_and_pixels_give_the_same_distances(
            drawn in prop::collection::vec((0..PLANE, any::<u8>()), 0..60),
        ) {
            let mut planes = [vec![u8::MAX; PLANE], vec![u8::MAX; PLANE]];
            for (at, units) in drawn {
                planes.iter_mut().for_each(|plane| plane[at] = units);
            }
            let [rows, pixels] = &mut planes;
            by_rows(rows);
            by_pixels(pixels);
            prop_assert_eq!(rows, pixels);
        }
    }
}

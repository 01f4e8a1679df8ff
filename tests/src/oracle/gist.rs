//! The gist of a view from its definition: lengths of edges by cell and direction, projected, compared.

use edgeloc::geometry::{Polarity, Segment2};

/// Cells along either side, and directions.
const CELLS: usize = 8;

/// Lengths in pixels of an image of 640 x 480 px by `[row][column][direction]`: each segment cut into a great many pieces,
/// each shared by the cells and directions nearest to it.
#[must_use]
pub fn edge_lengths(segments: &[Segment2]) -> Vec<f64> {
    const PIECES: usize = 2000;
    let mut lengths = vec![0.0; CELLS * CELLS * CELLS];
    for segment in segments {
        let ends = [segment.start(), segment.end()].map(|point| [f64::from(point.x), f64::from(point.y)]);
        let [from, to] = if segment.polarity() == Polarity::LeftBrighter { ends } else { [ends[1], ends[0]] };
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let length = dx.hypot(dy);
        if length < 12.0 || dy.abs() < 5.0_f64.to_radians().tan() * dx.abs() {
            continue;
        }
        let direction = dy.atan2(dx).rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU * CELLS as f64;
        for piece in 0..PIECES {
            let at = (piece as f64 + 0.5) / PIECES as f64;
            let column = (from[0] + dx * at) / 80.0 - 0.5;
            let row = (from[1] + dy * at) / 60.0 - 0.5;
            for (row, row_share) in nearest(row) {
                for (column, column_share) in nearest(column) {
                    for (direction, share) in around(direction) {
                        let index = (row * CELLS + column) * CELLS + direction;
                        lengths[index] += length / PIECES as f64 * row_share * column_share * share;
                    }
                }
            }
        }
    }
    lengths
}

fn nearest(coordinate: f64) -> [(usize, f64); 2] {
    let inside = coordinate.clamp(0.0, (CELLS - 1) as f64);
    let (cell, later) = (inside.floor() as usize, inside.fract());
    [(cell, 1.0 - later), ((cell + 1).min(CELLS - 1), later)]
}

fn around(direction: f64) -> [(usize, f64); 2] {
    let (first, later) = (direction.floor() as usize, direction.fract());
    [(first % CELLS, 1.0 - later), ((first + 1) % CELLS, later)]
}

/// The code of a layout: its differences from the mean along the axes, of length 254.
#[must_use]
pub fn code(layout: &[i16], mean: &[i16], axes: &[Vec<i16>]) -> Vec<f64> {
    let along: Vec<f64> = axes
        .iter()
        .map(|axis| {
            let products = axis.iter().zip(layout.iter().zip(mean)).map(|(a, (x, m))| f64::from(*a) * f64::from(x - m));
            products.sum()
        })
        .collect();
    let length = along.iter().map(|x| x * x).sum::<f64>().sqrt().max(1.0);
    along.iter().map(|x| (254.0 * x / length).clamp(-127.0, 127.0)).collect()
}

/// The similarity of two codes.
#[must_use]
pub fn similarity(a: &[i8], b: &[i8]) -> i16 {
    let products: i64 = a.iter().zip(b).map(|(a, b)| i64::from(*a) * i64::from(*b)).sum();
    products.div_euclid(16) as i16
}

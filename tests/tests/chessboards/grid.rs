//! Which corner of the board is which: a lattice grown from one corner to the next.

use std::collections::BTreeMap;

/// Inner corners along the board's long and its short side.
pub(crate) const SIZE: [i32; 2] = [9, 6];

/// A corner found is the expected one within this part of a square's side.
const TOLERANCE: f64 = 0.3;

type Lattice = BTreeMap<(i32, i32), [f64; 2]>;

/// The board's corners row by row, the long side running to the right in the image, or none when they are not all found.
pub(crate) fn order(corners: &[[f64; 2]]) -> Option<Vec<[f64; 2]>> {
    corners.iter().find_map(|seed| ordered(&grown(*seed, corners)?))
}

/// Every corner that continues the lattice of the seed and its two neighbours.
fn grown(seed: [f64; 2], corners: &[[f64; 2]]) -> Option<Lattice> {
    let mut steps: Vec<[f64; 2]> =
        corners.iter().map(|corner| minus(*corner, seed)).filter(|step| length(*step) > 0.0).collect();
    steps.sort_by(|a, b| length(*a).total_cmp(&length(*b)));
    let first = *steps.first()?;
    let is_across = |step: &&[f64; 2]| cross(first, **step).abs() > 0.6 * length(first) * length(**step);
    let second = *steps.iter().take(8).find(is_across)?;
    let mut lattice = Lattice::from([((0, 0), seed)]);
    let mut open = vec![(0, 0)];
    while let Some((i, j)) = open.pop() {
        let here = lattice[&(i, j)];
        for (di, dj) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
            if lattice.contains_key(&(i + di, j + dj)) {
                continue;
            }
            let step = local_step(&lattice, (i, j), (di, dj))
                .unwrap_or_else(|| [0, 1].map(|axis| first[axis] * f64::from(di) + second[axis] * f64::from(dj)));
            let expected = [here[0] + step[0], here[1] + step[1]];
            let nearest =
                corners.iter().min_by(|a, b| length(minus(**a, expected)).total_cmp(&length(minus(**b, expected))))?;
            let is_new = lattice.values().all(|known| length(minus(*known, *nearest)) > 0.0);
            if is_new && length(minus(*nearest, expected)) < TOLERANCE * length(step) {
                lattice.insert((i + di, j + dj), *nearest);
                open.insert(0, (i + di, j + dj));
            }
        }
    }
    Some(lattice)
}

/// The step in a direction as the lattice has it beside a place: before it, or in a neighbouring row.
fn local_step(lattice: &Lattice, (i, j): (i32, i32), (di, dj): (i32, i32)) -> Option<[f64; 2]> {
    let between = |from: (i32, i32), to: (i32, i32)| Some(minus(*lattice.get(&to)?, *lattice.get(&from)?));
    between((i - di, j - dj), (i, j))
        .or_else(|| between((i + dj, j + di), (i + dj + di, j + di + dj)))
        .or_else(|| between((i - dj, j - di), (i - dj + di, j - di + dj)))
}

/// The lattice row by row, if it is a whole board.
fn ordered(lattice: &Lattice) -> Option<Vec<[f64; 2]>> {
    let range = |axis: fn(&(i32, i32)) -> i32| {
        let low = lattice.keys().map(axis).min()?;
        Some((low, lattice.keys().map(axis).max()? - low + 1))
    };
    let ((low_i, count_i), (low_j, count_j)) = (range(|place| place.0)?, range(|place| place.1)?);
    let is_transposed = [count_j, count_i] == SIZE;
    if lattice.len() as i32 != SIZE[0] * SIZE[1] || (!is_transposed && [count_i, count_j] != SIZE) {
        return None;
    }
    let at = |along: i32, across: i32| {
        let (i, j) = if is_transposed { (across, along) } else { (along, across) };
        lattice[&(low_i + i, low_j + j)]
    };
    let (origin, along_end, across_end) = (at(0, 0), at(SIZE[0] - 1, 0), at(0, SIZE[1] - 1));
    let is_backwards = along_end[0] < origin[0];
    // Seen from its front, the long side runs clockwise to the short one.
    let is_upside_down = (cross(minus(along_end, origin), minus(across_end, origin)) < 0.0) != is_backwards;
    let rows = (0..SIZE[1]).flat_map(|row| (0..SIZE[0]).map(move |column| (column, row)));
    let flip = |is_flipped: bool, index: i32, count: i32| if is_flipped { count - 1 - index } else { index };
    Some(
        rows.map(|(column, row)| at(flip(is_backwards, column, SIZE[0]), flip(is_upside_down, row, SIZE[1]))).collect(),
    )
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn length(a: [f64; 2]) -> f64 {
    a[0].hypot(a[1])
}

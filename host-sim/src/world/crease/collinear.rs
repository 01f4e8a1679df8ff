//! Merging: coincident pieces and runs of collinear, touching pieces become one segment.
//!
//! The longest piece left starts a run and takes in every piece that touches it and lies along it, until none does.
//! Contrast is the mean of the pieces' contrasts, weighted by length. Pieces are found by their end points, through
//! grids of several cell sizes so that a long piece looks into few cells; a budget bounds the work on hostile meshes.

use super::Piece;
use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::collections::HashMap;

/// Pieces this near each other touch, and pieces this near a line lie on it, in metres.
const TOLERANCE_M: f64 = 1e-3;
/// Least cosine between the directions of pieces of one run: 3 degrees.
const COS_ALONG: f64 = 0.998_63;
/// Candidates looked at per piece, on average, before merging stops; furnished buildings need up to 120.
const BUDGET_PER_PIECE: u64 = 1000;
/// Candidates looked at beyond that, so that small meshes never run out.
const BUDGET_BASE: u64 = 1_000_000;

/// The merged pieces, longest first piece first, and whether the budget sufficed.
pub(super) fn merge(pieces: &[Piece]) -> (Vec<Piece>, bool) {
    let mut order: Vec<usize> = (0..pieces.len()).collect();
    order.sort_by(|&a, &b| pieces[b].length_m().total_cmp(&pieces[a].length_m()).then(a.cmp(&b)));
    let mut search = EndPointSearch::new(pieces);
    let mut taken = vec![false; pieces.len()];
    let mut runs = Vec::new();
    for seed in order {
        if std::mem::replace(&mut taken[seed], true) {
            continue;
        }
        let mut run = Run::new(&pieces[seed]);
        let mut to_visit = vec![seed];
        while let Some(index) = to_visit.pop() {
            for candidate in search.touching(index) {
                if !taken[candidate] && run.try_extend(&pieces[candidate]) {
                    taken[candidate] = true;
                    to_visit.push(candidate);
                }
            }
        }
        runs.push(run.piece());
    }
    (runs, search.budget > 0)
}

/// A growing run: the line through its outermost points.
struct Run {
    seed: Piece,
    start: Vector3<f64>,
    end: Vector3<f64>,
    contrast_sum: f64,
    length_sum: f64,
}

impl Run {
    fn new(seed: &Piece) -> Self {
        let length_m = seed.length_m();
        Self {
            seed: *seed,
            start: seed.start,
            end: seed.end,
            contrast_sum: seed.contrast * length_m,
            length_sum: length_m,
        }
    }

    /// Takes `piece` in if it lies along the run and the run stays straight.
    fn try_extend(&mut self, piece: &Piece) -> bool {
        let Some(direction) = (self.end - self.start).try_normalize(0.0) else { return false };
        let Some(other) = (piece.end - piece.start).try_normalize(0.0) else { return true };
        let cosine = direction.dot(&other);
        if cosine.abs() < COS_ALONG {
            return false;
        }
        let (mut start, mut end) = (self.start, self.end);
        for point in [piece.start, piece.end] {
            if distance_to_line(point, self.start, &direction) > TOLERANCE_M {
                return false;
            }
            if (point - start).dot(&direction) < 0.0 {
                start = point;
            }
            if (point - end).dot(&direction) > 0.0 {
                end = point;
            }
        }
        let extended = (end - start).normalize();
        let seed_strays = [self.seed.start, self.seed.end]
            .iter()
            .any(|&point| distance_to_line(point, start, &extended) > TOLERANCE_M);
        if seed_strays {
            return false;
        }
        let length_m = piece.length_m();
        self.contrast_sum += piece.contrast * length_m * cosine.signum();
        self.length_sum += length_m;
        (self.start, self.end) = (start, end);
        true
    }

    fn piece(&self) -> Piece {
        let contrast = if self.length_sum > 0.0 { self.contrast_sum / self.length_sum } else { 0.0 };
        Piece { start: self.start, end: self.end, contrast }
    }
}

fn distance_to_line(point: Vector3<f64>, origin: Vector3<f64>, direction: &Vector3<f64>) -> f64 {
    (point - origin).cross(direction).norm()
}

/// Pieces by their end points.
struct EndPointSearch<'a> {
    pieces: &'a [Piece],
    /// By level; a level's cells are `CELL_M * 4^level` wide. Made when first asked for.
    grids: BTreeMap<u32, HashMap<[i64; 3], Vec<usize>>>,
    budget: u64,
}

/// Width of the smallest cells, in metres.
const CELL_M: f64 = 0.01;

impl<'a> EndPointSearch<'a> {
    fn new(pieces: &'a [Piece]) -> Self {
        let budget = BUDGET_BASE + BUDGET_PER_PIECE * pieces.len() as u64;
        Self { pieces, grids: BTreeMap::new(), budget }
    }

    /// Pieces, some perhaps twice, with an end point on the piece at `index`.
    fn touching(&mut self, index: usize) -> Vec<usize> {
        let pieces = self.pieces;
        let piece = &pieces[index];
        let (length_m, along) = (piece.length_m(), piece.end - piece.start);
        let mut level = 0;
        let mut cell_m = CELL_M;
        while cell_m * 4.0 < length_m && level < 12 {
            level += 1;
            cell_m *= 4.0;
        }
        let grid = self.grids.entry(level).or_insert_with(|| grid_of(pieces, cell_m));

        let part_count = libm::ceil(length_m / cell_m).max(1.0);
        let mut found = Vec::new();
        let mut part = 0.0;
        while part < part_count {
            let (from, to) =
                (piece.start + along * (part / part_count), piece.start + along * ((part + 1.0) / part_count));
            for_cells(from, to, cell_m, |cell| {
                for &candidate in grid.get(&cell).map_or(&[][..], Vec::as_slice) {
                    if self.budget == 0 {
                        return;
                    }
                    self.budget -= 1;
                    let other = &pieces[candidate];
                    if candidate != index && (touches(piece, other.start) || touches(piece, other.end)) {
                        found.push(candidate);
                    }
                }
            });
            part += 1.0;
        }
        found
    }
}

fn grid_of(pieces: &[Piece], cell_m: f64) -> HashMap<[i64; 3], Vec<usize>> {
    let mut grid: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    for (index, piece) in pieces.iter().enumerate() {
        let (start, end) = (cell_of(piece.start, cell_m), cell_of(piece.end, cell_m));
        grid.entry(start).or_default().push(index);
        if end != start {
            grid.entry(end).or_default().push(index);
        }
    }
    grid
}

fn cell_of(point: Vector3<f64>, cell_m: f64) -> [i64; 3] {
    [point.x, point.y, point.z].map(|coordinate| libm::floor(coordinate / cell_m) as i64)
}

/// Calls `visit` with each cell that the box around `from` and `to`, grown by the tolerance, meets.
fn for_cells(from: Vector3<f64>, to: Vector3<f64>, cell_m: f64, mut visit: impl FnMut([i64; 3])) {
    let grown = Vector3::repeat(TOLERANCE_M);
    let (low, high) = (cell_of(from.inf(&to) - grown, cell_m), cell_of(from.sup(&to) + grown, cell_m));
    for x in low[0]..=high[0] {
        for y in low[1]..=high[1] {
            for z in low[2]..=high[2] {
                visit([x, y, z]);
            }
        }
    }
}

/// Whether `point` lies on `piece`.
fn touches(piece: &Piece, point: Vector3<f64>) -> bool {
    let along = piece.end - piece.start;
    let square = along.norm_squared();
    let fraction = if square > 0.0 { ((point - piece.start).dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 };
    (piece.start + along * fraction - point).norm() <= TOLERANCE_M
}

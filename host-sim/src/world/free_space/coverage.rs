//! Which cells of a grid on the floor lie below or above a set of triangles, cut to a slab of heights.

use edgeloc::geometry::Point2;
use std::ops::RangeInclusive;

/// Square cells over the floor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Grid {
    /// West border \[m\].
    pub(super) west: f64,
    /// South border \[m\].
    pub(super) south: f64,
    /// Side of a cell \[m\].
    pub(super) cell_m: f64,
    /// Cells from west to east.
    pub(super) width: usize,
    /// Cells from south to north.
    pub(super) height: usize,
}

impl Grid {
    pub(super) const fn cell_count(&self) -> usize {
        self.width * self.height
    }

    /// The cell that holds a point.
    pub(super) fn cell_at(&self, point: Point2) -> Option<usize> {
        let x = libm::floor((f64::from(point.x) - self.west) / self.cell_m);
        let y = libm::floor((f64::from(point.y) - self.south) / self.cell_m);
        let inside = (0.0..self.width as f64).contains(&x) && (0.0..self.height as f64).contains(&y);
        inside.then(|| y as usize * self.width + x as usize)
    }

    pub(super) fn center(&self, cell: usize) -> Point2 {
        let middle = |low: f64, index: usize| (low + (index as f64 + 0.5) * self.cell_m) as f32;
        Point2::new(middle(self.west, cell % self.width), middle(self.south, cell / self.width))
    }

    /// The sides of a cell that others share, each with the cell beyond it.
    pub(super) fn sides(&self, cell: usize) -> impl Iterator<Item = (usize, [Point2; 2])> + use<> {
        let (center, half) = (self.center(cell), 0.5 * self.cell_m as f32);
        let corner = |x: f32, y: f32| Point2::new(center.x + x * half, center.y + y * half);
        let [low, east, north, high] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0)];
        let sides = [[low, north], [east, high], [low, east], [north, high]];
        self.beside(cell).into_iter().zip(sides).filter_map(|(beside, side)| Some((beside?, side)))
    }

    pub(super) const fn is_on_border(&self, cell: usize) -> bool {
        let (x, y) = (cell % self.width, cell / self.width);
        x == 0 || y == 0 || x + 1 == self.width || y + 1 == self.height
    }

    /// The rows from one y to another \[m\].
    pub(super) fn rows(&self, south: f64, north: f64) -> RangeInclusive<usize> {
        let row = |y: f64| self.index(y - self.south, self.height);
        row(south)..=row(north)
    }

    /// The column at an x \[m\], the outermost one beyond the grid.
    fn column(&self, x: f64) -> usize {
        self.index(x - self.west, self.width)
    }

    fn index(&self, along_m: f64, count: usize) -> usize {
        libm::floor(along_m / self.cell_m).clamp(0.0, count as f64 - 1.0) as usize
    }

    /// The cells that share a side with a cell: west, east, south, north.
    pub(super) fn beside(&self, cell: usize) -> [Option<usize>; 4] {
        let (x, y) = (cell % self.width, cell / self.width);
        [
            (x > 0).then(|| cell - 1),
            (x + 1 < self.width).then(|| cell + 1),
            (y > 0).then(|| cell - self.width),
            (y + 1 < self.height).then(|| cell + self.width),
        ]
    }
}

/// Heights from `low` to `high` \[m\].
#[derive(Debug, Clone, Copy)]
pub(in crate::world) struct Slab {
    pub(in crate::world) low: f64,
    pub(in crate::world) high: f64,
}

/// The outline of what of a triangle lies in the slab, seen from above: its sides.
pub(in crate::world) fn outline(triangle: &[[f64; 3]; 3], slab: Slab) -> impl Iterator<Item = [[f64; 2]; 2]> + use<> {
    let mut polygon = Polygon::of(triangle);
    polygon.cut(2, slab.low, slab.high);
    let corner = move |index: usize| {
        let [x, y, _] = polygon.corners[index % polygon.count];
        [x, y]
    };
    (0..polygon.count).map(move |index| [corner(index), corner(index + 1)])
}

/// How many triangles touch each cell.
///
/// Runs of cells are noted by their ends, so a triangle costs a step a row, however wide it is.
#[derive(Debug)]
pub(super) struct Coverage<'a> {
    grid: &'a Grid,
    /// For each row the change of the count from cell to cell, with one more at its end.
    changes: Vec<i64>,
}

impl<'a> Coverage<'a> {
    pub(super) fn new(grid: &'a Grid) -> Self {
        Self { grid, changes: vec![0; (grid.width + 1) * grid.height] }
    }

    /// Adds what of a triangle lies in the slab.
    pub(super) fn add(&mut self, triangle: &[[f64; 3]; 3], slab: Slab) {
        let mut polygon = Polygon::of(triangle);
        polygon.cut(2, slab.low, slab.high);
        let Some((south, north)) = polygon.extent(1) else { return };
        let grid = self.grid;
        for row in grid.rows(south, north) {
            let low = grid.south + row as f64 * grid.cell_m;
            let mut strip = polygon;
            strip.cut(1, low, low + grid.cell_m);
            if let Some((west, east)) = strip.extent(0) {
                let first = row * (grid.width + 1);
                self.changes[first + grid.column(west)] += 1;
                self.changes[first + grid.column(east) + 1] -= 1;
            }
        }
    }

    /// For each cell whether a triangle touches it.
    pub(super) fn cells(&self) -> Vec<bool> {
        let mut cells = Vec::with_capacity(self.grid.cell_count());
        for row in self.changes.chunks_exact(self.grid.width + 1) {
            let mut count = 0;
            cells.extend(row[..self.grid.width].iter().map(|change| {
                count += change;
                count > 0
            }));
        }
        cells
    }
}

/// A convex polygon: a triangle cut by up to four planes.
#[derive(Debug, Clone, Copy)]
struct Polygon {
    corners: [[f64; 3]; 8],
    count: usize,
}

impl Polygon {
    fn of(triangle: &[[f64; 3]; 3]) -> Self {
        let mut corners = [[0.0; 3]; 8];
        corners[..3].copy_from_slice(triangle);
        Self { corners, count: 3 }
    }

    /// Keeps what lies between two planes across an axis (Sutherland and Hodgman 1974).
    fn cut(&mut self, axis: usize, low: f64, high: f64) {
        self.keep(|corner| corner[axis] - low);
        self.keep(|corner| high - corner[axis]);
    }

    /// Keeps the side of a plane on which `height` is not negative.
    fn keep(&mut self, height: impl Fn(&[f64; 3]) -> f64) {
        let whole = *self;
        self.count = 0;
        for index in 0..whole.count {
            let (from, to) = (whole.corners[index], whole.corners[(index + 1) % whole.count]);
            let (above, next_above) = (height(&from), height(&to));
            if above >= 0.0 {
                self.push(from);
            }
            if (above < 0.0 && next_above > 0.0) || (above > 0.0 && next_above < 0.0) {
                let t = above / (above - next_above);
                self.push([0, 1, 2].map(|axis| from[axis] + (to[axis] - from[axis]) * t));
            }
        }
    }

    /// Each plane adds at most one corner to a convex polygon, so eight are room for five planes.
    fn push(&mut self, corner: [f64; 3]) {
        if self.count < self.corners.len() {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }

    /// Least and greatest coordinate along an axis; `None` when nothing is left.
    fn extent(&self, axis: usize) -> Option<(f64, f64)> {
        let corners = self.corners[..self.count].iter().map(|corner| corner[axis]);
        let extent = corners.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
        (self.count > 0).then_some(extent)
    }
}

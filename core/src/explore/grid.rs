//! What the robot has seen, as square cells in memory of the caller.
//!
//! The grid wraps round like a torus: cell `(x, y)` counts from where the robot started, and its place in memory is
//! both coordinates modulo the side. A building smaller than the grid therefore fits wherever in it the robot starts;
//! what would reach further from the other end than the side is left out.

use super::scan::RangeScan;
use crate::geometry::{GridWalk, Point2};
use crate::math;

/// Distances to what is occupied are told up to this many cells.
pub(super) const MAX_CLEARANCE: i32 = 15;

/// In place of the number of a cell: none.
pub(super) const NONE: u32 = u32::MAX;

/// Evidence of a cell that was never seen is 0; below this it is free, from here on occupied.
const OCCUPIED: u8 = 32;
const LEAST_EVIDENCE: u8 = 20;
const MOST_EVIDENCE: u8 = 44;
const EVIDENCE: u8 = 0x3f;
const COVERED: u8 = 0x40;
const BLOCKED: u8 = 0x80;

/// A cell of the grid, eight bytes of the caller's memory.
#[derive(Debug, Clone, Copy)]
pub struct Cell {
    /// Number of a further cell in a list, or [`NONE`].
    pub(super) next: u32,
    /// Way to here in the last search; `u16::MAX` where it did not come.
    pub(super) cost: u16,
    /// Squared distance to the nearest occupied cell, in cells.
    pub(super) clearance: u8,
    /// Evidence for free or occupied, and two marks.
    state: u8,
}

impl Cell {
    /// A cell of which nothing is known.
    pub const EMPTY: Self = Self { next: NONE, cost: u16::MAX, clearance: u8::MAX, state: 0 };

    pub(super) const fn is_free(self) -> bool {
        let evidence = self.state & EVIDENCE;
        evidence > 0 && evidence < OCCUPIED && self.state & BLOCKED == 0
    }

    const fn is_occupied(self) -> bool {
        self.state & EVIDENCE >= OCCUPIED
    }

    /// Whether the robot has seen it from near.
    pub(super) const fn is_covered(self) -> bool {
        self.state & COVERED != 0
    }

    pub(super) const fn is_unknown(self) -> bool {
        self.state & EVIDENCE == 0
    }
}

/// A cell by its coordinates from where the robot started.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct At {
    pub(super) x: i32,
    pub(super) y: i32,
}

/// From a least to a greatest coordinate, both included; empty when they are the wrong way round.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    pub(super) low: At,
    pub(super) high: At,
}

impl Extent {
    const EMPTY: Self = Self { low: At { x: i32::MAX, y: i32::MAX }, high: At { x: i32::MIN, y: i32::MIN } };

    const fn contains(&self, at: At) -> bool {
        at.x >= self.low.x && at.x <= self.high.x && at.y >= self.low.y && at.y <= self.high.y
    }

    fn places(self) -> impl Iterator<Item = At> {
        (self.low.y..=self.high.y).flat_map(move |y| (self.low.x..=self.high.x).map(move |x| At { x, y }))
    }

    fn with(self, at: At) -> Self {
        Self {
            low: At { x: self.low.x.min(at.x), y: self.low.y.min(at.y) },
            high: At { x: self.high.x.max(at.x), y: self.high.y.max(at.y) },
        }
    }

    /// What lies within `margin` of this and in `limits`.
    fn grown(self, margin: i32, limits: &Self) -> Self {
        Self {
            low: At { x: (self.low.x - margin).max(limits.low.x), y: (self.low.y - margin).max(limits.low.y) },
            high: At { x: (self.high.x + margin).min(limits.high.x), y: (self.high.y + margin).min(limits.high.y) },
        }
    }
}

/// The grid.
#[derive(Debug)]
pub(super) struct Grid<'m> {
    cells: &'m mut [Cell],
    /// One less than the side, a power of two.
    mask: i32,
    cell_m: f32,
    /// What has been seen.
    pub(super) seen: Extent,
    /// Where cells have become occupied or free since the clearances were worked out.
    changed: Extent,
    /// Where cells may have a cost.
    costed: Extent,
}

impl<'m> Grid<'m> {
    /// A grid on `cells`, `side` times `side` of them; whatever they hold is forgotten.
    pub(super) fn new(cells: &'m mut [Cell], side: u16, cell_m: f32) -> Self {
        cells.fill(Cell::EMPTY);
        Self {
            cells,
            mask: i32::from(side) - 1,
            cell_m,
            seen: Extent::EMPTY,
            changed: Extent::EMPTY,
            costed: Extent::EMPTY,
        }
    }

    /// The cell that holds a point \[m\].
    pub(super) fn at(&self, point: Point2) -> At {
        let index = |coordinate: f32| math::floor(coordinate / self.cell_m) as i32;
        At { x: index(point.x), y: index(point.y) }
    }

    pub(super) fn center(&self, at: At) -> Point2 {
        Point2::new((at.x as f32 + 0.5) * self.cell_m, (at.y as f32 + 0.5) * self.cell_m)
    }

    pub(super) const fn number(&self, at: At) -> u32 {
        (((at.y & self.mask) as u32) * (self.mask as u32 + 1)) | (at.x & self.mask) as u32
    }

    /// Where the cell of a number lies among what has been seen.
    pub(super) fn place(&self, number: u32) -> At {
        let low = self.seen.low;
        let (x, y) = (number as i32 & self.mask, number as i32 / (self.mask + 1));
        At { x: low.x + ((x - low.x) & self.mask), y: low.y + ((y - low.y) & self.mask) }
    }

    pub(super) fn cell(&self, at: At) -> Cell {
        if self.seen.contains(at) { self.cells[self.number(at) as usize] } else { Cell::EMPTY }
    }

    pub(super) fn numbered(&mut self, number: u32) -> &mut Cell {
        &mut self.cells[number as usize]
    }

    /// Every place among what has been seen.
    pub(super) fn places(&self) -> impl Iterator<Item = At> + use<> {
        self.seen.places()
    }

    /// Gives a cell its cost in a search.
    pub(super) fn set_cost(&mut self, at: At, cost: u16) {
        self.costed = self.costed.with(at);
        let number = self.number(at);
        self.numbered(number).cost = cost;
    }

    /// Takes back all costs. A search seldom comes far in what has been seen, so only where it came is looked at.
    pub(super) fn forget_costs(&mut self) {
        for at in core::mem::replace(&mut self.costed, Extent::EMPTY).places() {
            let number = self.number(at);
            self.numbered(number).cost = u16::MAX;
        }
    }

    pub(super) fn area_m2(&self, cell_count: usize) -> f32 {
        cell_count as f32 * self.cell_m * self.cell_m
    }

    /// Keeps the robot from coming to a cell again.
    pub(super) fn block(&mut self, at: At) {
        if self.seen.contains(at) {
            let number = self.number(at);
            self.numbered(number).state |= BLOCKED;
        }
    }

    /// Takes in a scan made at `position` with a heading \[rad\]; returns how many cells it covers that were not before.
    pub(super) fn record(&mut self, position: Point2, heading_rad: f32, scan: &RangeScan<'_>, cover_m: f32) -> u32 {
        let mut covered_count = 0;
        for (direction, range_m, is_met) in scan.rays() {
            let (sin, cos) = math::sin_cos(heading_rad + direction);
            // What was met may lie in the cell before, so the last half of a cell is not called free.
            let free_cells = range_m / self.cell_m - if is_met { 0.5 } else { 0.0 };
            let mut walk = GridWalk::new([position.x / self.cell_m, position.y / self.cell_m], [cos, sin], 1.0);
            while walk.entered < free_cells {
                let is_near = walk.entered * self.cell_m < cover_m;
                let at = At { x: walk.cell[0], y: walk.cell[1] };
                let Some(cell) = self.reached(at) else { break };
                let evidence = cell.state & EVIDENCE;
                let passed = if evidence == 0 { OCCUPIED - 1 } else { (evidence - 1).max(LEAST_EVIDENCE) };
                let is_new = is_near && cell.state & COVERED == 0;
                let mark = if is_near { COVERED } else { 0 };
                let was_occupied = cell.is_occupied();
                cell.state = (cell.state & !EVIDENCE) | passed | mark;
                covered_count += u32::from(is_new);
                if was_occupied != (passed >= OCCUPIED) {
                    self.changed = self.changed.with(at);
                }
                walk.advance();
            }
            if is_met {
                self.record_met(Point2::new(position.x + cos * range_m, position.y + sin * range_m));
            }
        }
        covered_count
    }

    fn record_met(&mut self, point: Point2) {
        let at = self.at(point);
        let Some(cell) = self.reached(at) else { return };
        let evidence = cell.state & EVIDENCE;
        let met = if evidence == 0 { OCCUPIED + 2 } else { (evidence + 3).min(MOST_EVIDENCE) };
        let was_occupied = cell.is_occupied();
        cell.state = (cell.state & !EVIDENCE) | met;
        if was_occupied != (met >= OCCUPIED) {
            self.changed = self.changed.with(at);
        }
    }

    /// Whether the grid reaches as far as a place.
    pub(super) fn has_room_for(&self, at: At) -> bool {
        let seen = self.seen.with(at);
        seen.high.x - seen.low.x <= self.mask && seen.high.y - seen.low.y <= self.mask
    }

    /// The cell at a place, which from now on counts as seen; none when the grid does not reach so far.
    fn reached(&mut self, at: At) -> Option<&mut Cell> {
        if !self.seen.contains(at) {
            if !self.has_room_for(at) {
                return None;
            }
            self.seen = self.seen.with(at);
        }
        let number = self.number(at);
        Some(self.numbered(number))
    }

    /// Works out the clearances anew wherever something changed: exact distances, rows first, then columns.
    pub(super) fn update_clearances(&mut self) {
        if self.changed.low.x > self.changed.high.x {
            return;
        }
        let region = self.changed.grown(MAX_CLEARANCE, &self.seen);
        let around = region.grown(MAX_CLEARANCE, &self.seen);
        self.changed = Extent::EMPTY;
        // Distances along rows go where the next search will write its costs.
        self.costed = self.costed.with(around.low).with(around.high);
        for y in around.low.y..=around.high.y {
            let mut distance = MAX_CLEARANCE;
            for x in around.low.x..=around.high.x {
                let number = self.number(At { x, y });
                let cell = self.numbered(number);
                distance = if cell.is_occupied() { 0 } else { (distance + 1).min(MAX_CLEARANCE) };
                cell.cost = distance as u16;
            }
            distance = MAX_CLEARANCE;
            for x in (around.low.x..=around.high.x).rev() {
                let number = self.number(At { x, y });
                let cell = self.numbered(number);
                distance = (distance + 1).min(i32::from(cell.cost));
                cell.cost = distance as u16;
            }
        }
        for y in region.low.y..=region.high.y {
            let rows = (y - MAX_CLEARANCE).max(around.low.y)..=(y + MAX_CLEARANCE).min(around.high.y);
            for x in region.low.x..=region.high.x {
                let squared = rows.clone().map(|row| {
                    let along = i32::from(self.cells[self.number(At { x, y: row }) as usize].cost);
                    along * along + (row - y) * (row - y)
                });
                let nearest = squared.min().unwrap_or(i32::MAX).min(MAX_CLEARANCE * MAX_CLEARANCE);
                let number = self.number(At { x, y });
                self.numbered(number).clearance = nearest as u8;
            }
        }
    }
}

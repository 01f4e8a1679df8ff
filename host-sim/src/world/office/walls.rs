//! Putting pieces against the walls of one room where they fit, at random.

use super::furniture::Piece;
use super::layout::Rectangle;
use crate::random::Stream;
use crate::world::WireframeWorld;
use crate::world::template::Placement;

/// How often a place is sought for a piece before the room does without it.
const ATTEMPTS: usize = 80;

/// Least distance between two pieces \[m\].
pub(super) const GAP_M: f32 = 0.04;

/// The four walls of a room and the floor between them, with what is there already.
#[derive(Debug)]
pub(super) struct Walls {
    floor: Rectangle,
    /// South, east, north and west.
    walls: [Wall; 4],
    /// Floor taken by pieces.
    taken: Vec<Rectangle>,
    /// Floor that must stay clear, though clear floors may overlap.
    clear: Vec<Rectangle>,
}

/// Which of the walls that run along x.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    South,
    North,
}

/// One wall seen from inside the room: its left end is the origin, `quarters` turn a piece to stand before it.
#[derive(Debug)]
struct Wall {
    left_end: [f32; 2],
    quarters: u8,
    length: f32,
    /// Pieces stand this far from it \[m\].
    setback: f32,
    covered: Vec<Covered>,
}

/// A part of a wall behind something: along the wall from its left end, and in height \[m\].
#[derive(Debug, Clone, Copy)]
struct Covered {
    from: f32,
    to: f32,
    heights: (f32, f32),
}

impl Walls {
    /// Four bare walls round a floor.
    pub(super) const fn around(floor: Rectangle) -> Self {
        let Rectangle { west, east, south, north } = floor;
        const fn wall(left_end: [f32; 2], quarters: u8, length: f32) -> Wall {
            Wall { left_end, quarters, length, setback: 0.0, covered: Vec::new() }
        }
        let walls = [
            wall([west, south], 0, east - west),
            wall([east, south], 1, north - south),
            wall([east, north], 2, east - west),
            wall([west, north], 3, north - south),
        ];
        Self { floor, walls, taken: Vec::new(), clear: Vec::new() }
    }

    /// Keeps pieces off a part of a wall: `half` to either side of `x`, between two heights.
    pub(super) fn cover(&mut self, side: Side, x: f32, half: f32, heights: (f32, f32)) {
        let (wall, middle) = match side {
            Side::South => (0, x - self.floor.west),
            Side::North => (2, self.floor.east - x),
        };
        self.walls[wall].covered.push(Covered { from: middle - half, to: middle + half, heights });
    }

    /// Keeps pieces off the west and the east wall.
    pub(super) fn cover_ends(&mut self) {
        for wall in [1, 3] {
            let to = self.walls[wall].length;
            self.walls[wall].covered.push(Covered { from: 0.0, to, heights: (0.0, f32::INFINITY) });
        }
    }

    /// Has pieces stand off a wall.
    pub(super) fn set_back(&mut self, side: Side, setback: f32) {
        self.walls[if side == Side::South { 0 } else { 2 }].setback = setback;
    }

    /// Keeps pieces off a part of the floor.
    pub(super) fn take(&mut self, area: Rectangle) {
        self.taken.push(area);
    }

    /// Keeps pieces off a part of the floor, though not the clear floor before them.
    pub(super) fn keep_clear(&mut self, area: Rectangle) {
        self.clear.push(area);
    }

    /// Puts a piece against a wall where it fits, and tells where; `None` when no place was found.
    pub(super) fn set(&mut self, piece: &Piece, stream: &mut Stream, world: &mut WireframeWorld) -> Option<Placement> {
        for _ in 0..ATTEMPTS {
            let index = stream.index(self.walls.len());
            let wall = &self.walls[index];
            let room = f64::from(wall.length - piece.width - 2.0 * GAP_M);
            let centimetres = (stream.unit() * room.max(0.0) * 100.0) as u32;
            let along = GAP_M + 0.5 * piece.width + centimetres as f32 / 100.0;
            let (from, to) = (along - 0.5 * piece.width, along + 0.5 * piece.width);
            let covered = Covered { from: from - GAP_M, to: to + GAP_M, heights: piece.heights };
            let is_bare = room >= 0.0 && wall.covered.iter().all(|other| !other.overlaps(&covered));
            let stands = piece.heights.0 <= 0.0;
            let back = if stands { wall.setback } else { 0.0 };
            let front = back + piece.depth;
            let body = wall.floor_before(from..to, back..front);
            let before = wall.floor_before(from..to, front..front + piece.clearance);
            if is_bare && (!stands || self.is_clear(&body, &before)) {
                let placement = self.walls[index].placement(along, back);
                self.walls[index].covered.push(covered);
                if stands {
                    self.taken.push(body);
                    self.clear.push(before);
                }
                piece.template.place(&placement, world);
                return Some(placement);
            }
        }
        None
    }

    fn is_clear(&self, body: &Rectangle, before: &Rectangle) -> bool {
        let floor = self.floor;
        let inside = |area: &Rectangle| {
            area.west >= floor.west && area.east <= floor.east && area.south >= floor.south && area.north <= floor.north
        };
        inside(body)
            && inside(before)
            && self.taken.iter().all(|other| !other.overlaps(body, GAP_M) && !other.overlaps(before, 0.0))
            && self.clear.iter().all(|other| !other.overlaps(body, 0.0))
    }
}

impl Wall {
    /// Where a piece stands whose middle is `along` the wall from its left end and whose back is `setback` before it.
    fn placement(&self, along: f32, setback: f32) -> Placement {
        let wall = Placement::at(self.left_end[0], self.left_end[1], 0.0).turned_quarters(self.quarters);
        wall.then(&Placement::at(along, setback, 0.0))
    }

    /// The floor before a part of the wall, between two distances from it.
    fn floor_before(&self, along: std::ops::Range<f32>, off: std::ops::Range<f32>) -> Rectangle {
        let corner = |along, off| self.placement(along, off).position();
        let (a, b) = (corner(along.start, off.start), corner(along.end, off.end));
        Rectangle { west: a.x.min(b.x), east: a.x.max(b.x), south: a.y.min(b.y), north: a.y.max(b.y) }
    }
}

impl Covered {
    fn overlaps(&self, other: &Self) -> bool {
        self.from < other.to
            && other.from < self.to
            && self.heights.0 < other.heights.1
            && other.heights.0 < self.heights.1
    }
}

impl Rectangle {
    /// Whether two areas come nearer than `gap`, or overlap.
    fn overlaps(&self, other: &Self, gap: f32) -> bool {
        self.west < other.east + gap
            && other.west < self.east + gap
            && self.south < other.north + gap
            && other.south < self.north + gap
    }
}

//! Furnishing one room: pieces go against its walls where they fit, at random.

use super::clutter::{Clutter, Spot};
use super::furniture::{DESK_HEIGHT_M, Furniture, Piece, SHELF_HEIGHTS_M};
use super::joinery::{CASING_M, DOOR_HEIGHT_M, RADIATOR_DEPTH_M, RADIATOR_WIDTH_M, WINDOW_HEIGHTS_M};
use super::layout::{DOOR_WIDTH_M, Purpose, Rectangle, Room, WINDOW_WIDTH_M};
use crate::random::Stream;
use crate::world::WireframeWorld;
use crate::world::template::Placement;

/// How often a place is sought for a piece before the room does without it.
const ATTEMPTS: usize = 80;

/// Least distance between two pieces [m].
const GAP_M: f32 = 0.04;

/// Pieces at the outer wall stand this far from it, before the radiators [m].
const RADIATOR_SETBACK_M: f32 = RADIATOR_DEPTH_M + GAP_M;

/// Depth of floor kept clear inside a door [m].
const DOOR_CLEARANCE_M: f32 = 1.15;

/// Puts furniture into one room.
#[derive(Debug)]
pub(super) struct Furnisher<'a> {
    room: &'a Room,
    furniture: &'a Furniture,
    stream: Stream,
    walls: [Wall; 4],
    /// Floor taken by pieces.
    taken: Vec<Rectangle>,
    /// Floor that must stay clear, though clear floors may overlap.
    clear: Vec<Rectangle>,
}

/// One wall seen from inside the room: its left end is the origin, `quarters` turn a piece to stand before it.
#[derive(Debug)]
struct Wall {
    left_end: [f32; 2],
    quarters: u8,
    length: f32,
    setback: f32,
    /// What covers the wall: along it and in height.
    covered: Vec<Covered>,
}

#[derive(Debug, Clone, Copy)]
struct Covered {
    from: f32,
    to: f32,
    heights: (f32, f32),
}

impl<'a> Furnisher<'a> {
    /// A room with nothing but its door and windows.
    pub(super) fn new(room: &'a Room, furniture: &'a Furniture, stream: Stream) -> Self {
        let Rectangle { west, east, south, north } = room.floor;
        let wall = |left_end, quarters, length| Wall { left_end, quarters, length, setback: 0.0, covered: Vec::new() };
        let mut walls = [
            wall([west, south], 0, east - west),
            wall([east, south], 1, north - south),
            wall([east, north], 2, east - west),
            wall([west, north], 3, north - south),
        ];
        let (door_wall, window_wall) = if room.is_north { (0, 2) } else { (2, 0) };
        walls[window_wall].setback = RADIATOR_SETBACK_M;
        let covered = |wall: usize, x: f32, half: f32, heights| {
            let middle = if wall == 0 { x - west } else { east - x };
            Covered { from: middle - half, to: middle + half, heights }
        };
        let door_half = 0.5 * DOOR_WIDTH_M + CASING_M;
        walls[door_wall].covered.push(covered(door_wall, room.door.x, door_half, (0.0, DOOR_HEIGHT_M + CASING_M)));
        let window_heights = (WINDOW_HEIGHTS_M.0 - 0.03, WINDOW_HEIGHTS_M.1);
        for &x in &room.windows {
            walls[window_wall].covered.push(covered(window_wall, x, 0.5 * WINDOW_WIDTH_M + 0.05, window_heights));
        }
        // The leaf stands open on the hinge side, nearly square to the wall.
        let (to_west, to_east) = if room.door.hinges_east { (0.55, 0.75) } else { (0.75, 0.55) };
        let (near, far) =
            if room.is_north { (south, south + DOOR_CLEARANCE_M) } else { (north - DOOR_CLEARANCE_M, north) };
        let doorway = Rectangle { west: room.door.x - to_west, east: room.door.x + to_east, south: near, north: far };
        let taken = radiators(room).collect();
        Self { room, furniture, stream, walls, taken, clear: vec![doorway] }
    }

    /// Furnishes the room for its purpose and tells `clutter` where small things can go.
    pub(super) fn furnish(mut self, world: &mut WireframeWorld, clutter: &mut Clutter) {
        let share = match self.room.purpose {
            Purpose::Office => 1,
            Purpose::OpenOffice => 2,
            Purpose::Meeting => {
                self.set_table(world, clutter);
                0
            }
        };
        for _ in 0..2 * share {
            self.set_desk(world, clutter);
        }
        let furniture = self.furniture;
        for _ in 0..2 * share {
            self.set_bookcase(world, clutter);
        }
        for _ in 0..share.max(1) {
            self.set(&furniture.cupboard, world);
        }
        for _ in 0..share {
            self.set(&furniture.filing_cabinet, world);
            self.set(&furniture.whiteboard, world);
        }
        if let Some(board) = self.set(&furniture.notice_board, world) {
            clutter.add_spot(Spot::Board, board);
        }
        for _ in 0..1 + share {
            self.set(&furniture.picture, world);
        }
    }

    /// A desk with its screen and its chair.
    fn set_desk(&mut self, world: &mut WireframeWorld, clutter: &mut Clutter) {
        let furniture = self.furniture;
        let Some(desk) = self.set(&furniture.desk, world) else { return };
        let desk = desk.mirrored(self.stream.chance(0.5));
        let mut draw = |low, high| self.stream.uniform(low, high) as f32;
        let screen = Placement::at(draw(-0.35, 0.1), draw(0.18, 0.3), DESK_HEIGHT_M).turned_deg(draw(-15.0, 15.0));
        furniture.monitor.template.place(&desk.then(&screen), world);
        let chair = Placement::at(draw(-0.35, 0.0), draw(0.85, 1.05), 0.0).turned_deg(180.0 + draw(-50.0, 50.0));
        furniture.chair.template.place(&desk.then(&chair), world);
        clutter.add_spot(Spot::Desk, desk.then(&Placement::at(draw(-0.3, 0.0), 0.55, DESK_HEIGHT_M)));
        clutter.add_spot(Spot::Desk, desk.then(&Placement::at(draw(0.5, 0.6), 0.3, DESK_HEIGHT_M)));
    }

    fn set_bookcase(&mut self, world: &mut WireframeWorld, clutter: &mut Clutter) {
        let furniture = self.furniture;
        let Some(bookcase) = self.set(&furniture.bookcase, world) else { return };
        for height in SHELF_HEIGHTS_M {
            clutter.add_spot(Spot::Shelf, bookcase.then(&Placement::at(0.0, 0.0, height)));
        }
    }

    /// A table in the middle of the room with three chairs on either side.
    fn set_table(&mut self, world: &mut WireframeWorld, clutter: &mut Clutter) {
        let Rectangle { west, east, south, north } = self.room.floor;
        let middle = Placement::at(0.5 * (west + east), 0.5 * (south + north), 0.0).turned_quarters(1);
        let furniture = self.furniture;
        furniture.table.template.place(&middle, world);
        for (side, facing_deg) in [(-0.75, 0.0), (0.75, 180.0)] {
            for seat in [-0.65, 0.0, 0.65] {
                let mut draw = |low, high| self.stream.uniform(low, high) as f32;
                let chair = Placement::at(seat + draw(-0.05, 0.05), side + draw(-0.1, 0.1), 0.0);
                furniture.chair.template.place(&middle.then(&chair.turned_deg(facing_deg + draw(-25.0, 25.0))), world);
            }
        }
        clutter.add_spot(Spot::Desk, middle.then(&Placement::at(-0.4, 0.1, DESK_HEIGHT_M)));
        clutter.add_spot(Spot::Desk, middle.then(&Placement::at(0.5, -0.1, DESK_HEIGHT_M)));
        let (x, y) = (0.5 * (west + east), 0.5 * (south + north));
        self.taken.push(Rectangle { west: x - 1.1, east: x + 1.1, south: y - 1.1, north: y + 1.1 });
    }

    /// Puts a piece against a wall where it fits, and tells where; `None` when no place was found.
    fn set(&mut self, piece: &Piece, world: &mut WireframeWorld) -> Option<Placement> {
        for _ in 0..ATTEMPTS {
            let wall = &self.walls[self.stream.index(4)];
            let room = f64::from(wall.length - piece.width - 2.0 * GAP_M);
            let along = GAP_M + 0.5 * piece.width + (self.stream.unit() * room.max(0.0) * 100.0) as u32 as f32 / 100.0;
            let (from, to) = (along - 0.5 * piece.width, along + 0.5 * piece.width);
            let covered = Covered { from: from - GAP_M, to: to + GAP_M, heights: piece.heights };
            let stands = piece.heights.0 <= 0.0;
            let setback = if stands { wall.setback } else { 0.0 };
            let body = wall.floor_before(from..to, setback..setback + piece.depth);
            let before = wall.floor_before(from..to, setback + piece.depth..setback + piece.depth + piece.clearance);
            let fits = room >= 0.0
                && wall.covered.iter().all(|other| !other.overlaps(&covered))
                && (!stands || self.is_clear(&body, &before));
            if fits {
                let placement = wall.placement(along, setback);
                if stands {
                    self.taken.push(body);
                    self.clear.push(before);
                }
                let wall = &mut self.walls[usize::from(wall.quarters)];
                wall.covered.push(covered);
                piece.template.place(&placement, world);
                return Some(placement);
            }
        }
        None
    }

    fn is_clear(&self, body: &Rectangle, before: &Rectangle) -> bool {
        let floor = self.room.floor;
        let inside = |area: &Rectangle| {
            area.west >= floor.west && area.east <= floor.east && area.south >= floor.south && area.north <= floor.north
        };
        inside(body)
            && inside(before)
            && self.taken.iter().all(|other| !other.overlaps(body, GAP_M) && !other.overlaps(before, 0.0))
            && self.clear.iter().all(|other| !other.overlaps(body, 0.0))
    }
}

/// The floor below a room's radiators.
fn radiators(room: &Room) -> impl Iterator<Item = Rectangle> {
    let floor = room.floor;
    let (south, north) = if room.is_north {
        (floor.north - RADIATOR_DEPTH_M, floor.north)
    } else {
        (floor.south, floor.south + RADIATOR_DEPTH_M)
    };
    room.windows.iter().map(move |&x| Rectangle {
        west: x - 0.5 * RADIATOR_WIDTH_M,
        east: x + 0.5 * RADIATOR_WIDTH_M,
        south,
        north,
    })
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

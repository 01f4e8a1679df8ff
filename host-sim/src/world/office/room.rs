//! What rooms are furnished with.

use super::clutter::{Clutter, Spot};
use super::furniture::{DESK_HEIGHT_M, Furniture, Piece, SHELF_HEIGHTS_M};
use super::joinery::{CASING_M, DOOR_HEIGHT_M, RADIATOR_DEPTH_M, RADIATOR_WIDTH_M, WINDOW_HEIGHTS_M};
use super::layout::{DOOR_WIDTH_M, Layout, Purpose, Rectangle, Room, WINDOW_WIDTH_M};
use super::walls::{GAP_M, Side, Walls};
use crate::random::Stream;
use crate::world::WireframeWorld;
use crate::world::template::Placement;

/// Depth of floor kept clear inside a door \[m\].
const DOOR_CLEARANCE_M: f32 = 1.15;

/// Half the width of a door with its casing \[m\].
const DOOR_HALF_M: f32 = 0.5 * DOOR_WIDTH_M + CASING_M;

/// Heights that a door with its casing covers \[m\].
const DOOR_HEIGHTS_M: (f32, f32) = (0.0, DOOR_HEIGHT_M + CASING_M);

/// Furnishes the rooms of one office.
#[derive(Debug)]
pub(super) struct Furnisher<'a> {
    furniture: &'a Furniture,
    /// The world that grows.
    world: &'a mut WireframeWorld,
    /// Where small things can go.
    clutter: &'a mut Clutter,
    /// Draws for the room at hand.
    stream: Stream,
    walls: Walls,
}

impl<'a> Furnisher<'a> {
    /// A room with nothing but its door and windows.
    pub(super) fn room(
        room: &Room,
        furniture: &'a Furniture,
        stream: Stream,
        world: &'a mut WireframeWorld,
        clutter: &'a mut Clutter,
    ) -> Self {
        let mut walls = Walls::around(room.floor);
        let (door_side, window_side) =
            if room.is_north { (Side::South, Side::North) } else { (Side::North, Side::South) };
        walls.cover(door_side, room.door.x, DOOR_HALF_M, DOOR_HEIGHTS_M);
        for &x in &room.windows {
            let sill_and_top = (WINDOW_HEIGHTS_M.0 - 0.03, WINDOW_HEIGHTS_M.1);
            walls.cover(window_side, x, 0.5 * WINDOW_WIDTH_M + 0.05, sill_and_top);
        }
        walls.set_back(window_side, RADIATOR_DEPTH_M + GAP_M);
        radiators(room).for_each(|radiator| walls.take(radiator));
        walls.keep_clear(doorway(room));
        Self { furniture, world, clutter, stream, walls }
    }

    /// The bare corridor.
    pub(super) fn corridor(
        layout: &Layout,
        furniture: &'a Furniture,
        stream: Stream,
        world: &'a mut WireframeWorld,
        clutter: &'a mut Clutter,
    ) -> Self {
        let mut walls = Walls::around(layout.corridor);
        for room in &layout.rooms {
            let side = if room.is_north { Side::North } else { Side::South };
            walls.cover(side, room.door.x, DOOR_HALF_M, DOOR_HEIGHTS_M);
        }
        walls.cover_ends();
        Self { furniture, world, clutter, stream, walls }
    }

    /// Furnishes a room for its purpose.
    pub(super) fn furnish_room(mut self, room: &Room) {
        let furniture = self.furniture;
        let share = match room.purpose {
            Purpose::Meeting => {
                self.set_table(&room.floor);
                0
            }
            Purpose::Office => 1,
            Purpose::OpenOffice => 2,
        };
        for _ in 0..2 * share {
            self.set_desk();
        }
        for _ in 0..2 * share {
            self.set_bookcase();
        }
        for _ in 0..share.max(1) {
            self.set(&furniture.cupboard);
        }
        for _ in 0..share {
            self.set(&furniture.filing_cabinet);
            self.set(&furniture.whiteboard);
        }
        for _ in 0..1 + share {
            self.set_notice_board();
            self.set(&furniture.picture);
        }
    }

    /// Hangs pictures and boards in the corridor; nothing stands there.
    pub(super) fn furnish_corridor(mut self) {
        let furniture = self.furniture;
        for _ in 0..4 {
            self.set_notice_board();
        }
        for _ in 0..6 {
            self.set(&furniture.picture);
        }
    }

    fn set(&mut self, piece: &Piece) -> Option<Placement> {
        self.walls.set(piece, &mut self.stream, self.world)
    }

    fn draw(&mut self, low: f64, high: f64) -> f32 {
        self.stream.uniform(low, high) as f32
    }

    /// A desk with its screen and its chair.
    fn set_desk(&mut self) {
        let furniture = self.furniture;
        let Some(desk) = self.set(&furniture.desk) else { return };
        let desk = desk.mirrored(self.stream.chance(0.5));
        let screen = Placement::at(self.draw(-0.35, 0.1), self.draw(0.18, 0.3), DESK_HEIGHT_M);
        let screen = screen.turned_deg(self.draw(-15.0, 15.0));
        furniture.monitor.place(&desk.then(&screen), self.world);
        let chair = Placement::at(self.draw(-0.35, 0.0), self.draw(0.85, 1.05), 0.0);
        let chair = chair.turned_deg(180.0 + self.draw(-50.0, 50.0));
        furniture.chair.place(&desk.then(&chair), self.world);
        for (x, y) in [(self.draw(-0.3, 0.0), 0.55), (self.draw(0.45, 0.5), 0.3)] {
            self.clutter.add_spot(Spot::Desk, desk.then(&Placement::at(x, y, DESK_HEIGHT_M)));
        }
    }

    fn set_bookcase(&mut self) {
        let Some(bookcase) = self.set(&self.furniture.bookcase) else { return };
        for height in SHELF_HEIGHTS_M {
            self.clutter.add_spot(Spot::Shelf, bookcase.then(&Placement::at(0.0, 0.0, height)));
        }
    }

    fn set_notice_board(&mut self) {
        if let Some(board) = self.set(&self.furniture.notice_board) {
            self.clutter.add_spot(Spot::Board, board);
        }
    }

    /// A table in the middle of the room with three chairs on either side.
    fn set_table(&mut self, floor: &Rectangle) {
        let (x, y) = (0.5 * (floor.west + floor.east), 0.5 * (floor.south + floor.north));
        let middle = Placement::at(x, y, 0.0).turned_quarters(1);
        let furniture = self.furniture;
        furniture.table.place(&middle, self.world);
        for (side, facing_deg) in [(-0.75, 0.0), (0.75, 180.0)] {
            for seat in [-0.65, 0.0, 0.65] {
                let chair = Placement::at(seat + self.draw(-0.05, 0.05), side + self.draw(-0.1, 0.1), 0.0);
                let chair = chair.turned_deg(facing_deg + self.draw(-25.0, 25.0));
                furniture.chair.place(&middle.then(&chair), self.world);
            }
        }
        for (x, y) in [(-0.4, 0.1), (0.5, -0.1)] {
            self.clutter.add_spot(Spot::Desk, middle.then(&Placement::at(x, y, DESK_HEIGHT_M)));
        }
        self.walls.take(Rectangle { west: x - 1.1, east: x + 1.1, south: y - 1.1, north: y + 1.1 });
    }
}

/// The floor inside a door and under its leaf, which stands open on the hinge side, nearly square to the wall.
fn doorway(room: &Room) -> Rectangle {
    let Rectangle { south, north, .. } = room.floor;
    let (to_west, to_east) = if room.door.hinges_east { (0.55, 0.75) } else { (0.75, 0.55) };
    let (south, north) =
        if room.is_north { (south, south + DOOR_CLEARANCE_M) } else { (north - DOOR_CLEARANCE_M, north) };
    Rectangle { west: room.door.x - to_west, east: room.door.x + to_east, south, north }
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

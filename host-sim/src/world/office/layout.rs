//! The floor plan: a corridor along x with a row of rooms on either side, drawn at random within an architect's habits.

use super::{DEPTH_M, LENGTH_M};
use crate::random::Stream;

/// Thickness of the walls between rooms \[m\].
pub(super) const WALL_M: f32 = 0.1;

/// Clear width of a door \[m\].
pub(super) const DOOR_WIDTH_M: f32 = 0.9;

/// Width of a window \[m\].
pub(super) const WINDOW_WIDTH_M: f32 = 1.8;

/// Rooms in one row.
const ROOMS_IN_ROW: usize = 5;

/// The most a wall between two rooms moves from the even grid, either way \[m\].
const WALL_SHIFT_M: f64 = 0.45;

/// The rooms and the corridor between them.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    /// The corridor, its doors left to the rooms.
    pub(super) corridor: Rectangle,
    /// Every room with its door and windows, the corridor not included.
    pub(super) rooms: Vec<Room>,
}

/// An area of floor between walls \[m\].
#[derive(Debug, Clone, Copy)]
pub(super) struct Rectangle {
    pub(super) west: f32,
    pub(super) east: f32,
    pub(super) south: f32,
    pub(super) north: f32,
}

/// One room.
#[derive(Debug, Clone)]
pub(super) struct Room {
    /// The floor.
    pub(super) floor: Rectangle,
    /// Whether the room lies north of the corridor; its door is then in its south wall, else in its north wall.
    pub(super) is_north: bool,
    /// What it is furnished for.
    pub(super) purpose: Purpose,
    /// The door to the corridor.
    pub(super) door: Door,
    /// Middles of the windows in the outer wall, along x \[m\].
    pub(super) windows: Vec<f32>,
}

/// What a room is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Purpose {
    /// Desks for two.
    Office,
    /// Desks for four, in a room made of two.
    OpenOffice,
    /// One table with chairs all round.
    Meeting,
}

/// A door whose leaf stands open into the room.
#[derive(Debug, Clone, Copy)]
pub(super) struct Door {
    /// Middle of the opening along x \[m\].
    pub(super) x: f32,
    /// Whether the hinges are on the east side of the opening.
    pub(super) hinges_east: bool,
    /// How far the leaf is open \[degrees\].
    pub(super) open_deg: f32,
}

impl Layout {
    /// Draws a floor plan.
    pub(super) fn draw(stream: &mut Stream) -> Self {
        let south = rounded(stream.uniform(6.1, 6.9));
        let corridor = Rectangle { west: 0.0, east: LENGTH_M, south, north: south + rounded(stream.uniform(1.7, 2.0)) };
        let open_office = stream.index(2 * (ROOMS_IN_ROW - 1));
        let meeting = stream.index(2);
        let mut rooms = Vec::new();
        for (row, is_north) in [false, true].into_iter().enumerate() {
            let merged = (open_office % 2 == row).then_some(open_office / 2);
            let widths = draw_row(stream, merged);
            let last = widths.len() - 1;
            for (index, (west, east)) in widths.into_iter().enumerate() {
                let (south, north) =
                    if is_north { (corridor.north + WALL_M, DEPTH_M) } else { (0.0, corridor.south - WALL_M) };
                let purpose = match merged {
                    Some(merged) if merged == index => Purpose::OpenOffice,
                    None if index == meeting * last => Purpose::Meeting,
                    _ => Purpose::Office,
                };
                let floor = Rectangle { west, east, south, north };
                rooms.push(Room {
                    floor,
                    is_north,
                    purpose,
                    door: draw_door(stream, &floor),
                    windows: windows(&floor),
                });
            }
        }
        Self { corridor, rooms }
    }
}

/// West and east walls of a row of rooms, two of them made one at `merged`.
fn draw_row(stream: &mut Stream, merged: Option<usize>) -> Vec<(f32, f32)> {
    let pitch = (LENGTH_M + WALL_M) / ROOMS_IN_ROW as f32;
    let mut walls = vec![0.0];
    for index in 1..ROOMS_IN_ROW {
        walls.push(index as f32 * pitch + rounded(stream.uniform(-WALL_SHIFT_M, WALL_SHIFT_M)));
    }
    walls.push(LENGTH_M + WALL_M);
    if let Some(merged) = merged {
        walls.remove(merged + 1);
    }
    walls.windows(2).map(|pair| (pair[0], pair[1] - WALL_M)).collect()
}

/// A door near one end of the room, its leaf against the near side wall.
fn draw_door(stream: &mut Stream, floor: &Rectangle) -> Door {
    let from_corner = rounded(stream.uniform(0.25, 0.6)) + 0.5 * DOOR_WIDTH_M;
    let is_east = stream.chance(0.5);
    let x = if is_east { floor.east - from_corner } else { floor.west + from_corner };
    Door { x, hinges_east: is_east, open_deg: stream.uniform(80.0, 98.0) as f32 }
}

/// As many windows as the outer wall takes, evenly spaced.
fn windows(floor: &Rectangle) -> Vec<f32> {
    let width = floor.east - floor.west;
    let count = libm::floorf(width / (WINDOW_WIDTH_M + 0.6));
    (0..count as usize).map(|index| floor.west + width * (index as f32 + 0.5) / count).collect()
}

/// To whole centimetres.
fn rounded(length_m: f64) -> f32 {
    (libm::round(length_m * 100.0) / 100.0) as f32
}

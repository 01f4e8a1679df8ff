//! The shell of the office: floor, ceiling and walls with their openings, and the lines where they meet.

use super::joinery::{CASING_M, DOOR_HEIGHT_M, WINDOW_HEIGHTS_M};
use super::layout::{DOOR_WIDTH_M, Layout, Rectangle, WALL_M, WINDOW_WIDTH_M};
use super::{DEPTH_M, HEIGHT_M, LENGTH_M};
use crate::world::template::Template;

/// Thickness of the outer walls \[m\].
const OUTER_WALL_M: f32 = 0.2;

/// Top of the skirting boards \[m\].
const SKIRTING_M: f32 = 0.1;

/// Distance between the joints of the ceiling \[m\].
const CEILING_TILE_M: f32 = 0.6;

/// A hole in a wall that runs along x: where it is along x and in height \[m\].
#[derive(Debug, Clone, Copy)]
struct Opening {
    west: f32,
    east: f32,
    bottom: f32,
    top: f32,
}

/// The shell of a floor plan, to be placed once.
pub(super) fn shell(layout: &Layout) -> Template {
    let mut shell = Template::new("shell");
    raise_slabs(&mut shell);
    raise_outer_walls(&mut shell, layout);
    raise_inner_walls(&mut shell, layout);
    line_walls(&mut shell, &layout.corridor, &doors(layout, false), &doors(layout, true));
    for room in &layout.rooms {
        let door = [door_opening(room.door.x)];
        let (south, north): (&[_], &[_]) = if room.is_north { (&door, &[]) } else { (&[], &door) };
        line_walls(&mut shell, &room.floor, south, north);
        line_ceiling(&mut shell, &room.floor);
    }
    shell
}

fn raise_slabs(shell: &mut Template) {
    let (west, east) = (-OUTER_WALL_M, LENGTH_M + OUTER_WALL_M);
    let (south, north) = (-OUTER_WALL_M, DEPTH_M + OUTER_WALL_M);
    for z in [0.0, HEIGHT_M] {
        shell.add_surface([[west, south, z], [east, south, z], [east, north, z], [west, north, z]]);
    }
}

fn raise_outer_walls(shell: &mut Template, layout: &Layout) {
    for (west, east) in [(-OUTER_WALL_M, 0.0), (LENGTH_M, LENGTH_M + OUTER_WALL_M)] {
        shell.add_solid([west, -OUTER_WALL_M, 0.0], [east, DEPTH_M + OUTER_WALL_M, HEIGHT_M]);
    }
    for (is_north, south) in [(false, -OUTER_WALL_M), (true, DEPTH_M)] {
        let rooms = layout.rooms.iter().filter(|room| room.is_north == is_north);
        let windows: Vec<_> = rooms.flat_map(|room| &room.windows).map(|&x| window_opening(x)).collect();
        raise_wall(shell, (south, south + OUTER_WALL_M), &windows);
    }
}

fn raise_inner_walls(shell: &mut Template, layout: &Layout) {
    let corridor = layout.corridor;
    raise_wall(shell, (corridor.south - WALL_M, corridor.south), &doors(layout, false));
    raise_wall(shell, (corridor.north, corridor.north + WALL_M), &doors(layout, true));
    for Rectangle { east, south, north, .. } in layout.rooms.iter().map(|room| room.floor) {
        if east < LENGTH_M - WALL_M {
            shell.add_solid([east, south, 0.0], [east + WALL_M, north, HEIGHT_M]);
        }
    }
}

/// A wall along the whole office with openings, given from west to east.
fn raise_wall(shell: &mut Template, (south, north): (f32, f32), openings: &[Opening]) {
    let mut reached = 0.0;
    for opening in openings {
        shell.add_solid([reached, south, 0.0], [opening.west, north, HEIGHT_M]);
        shell.add_solid([opening.west, south, opening.top], [opening.east, north, HEIGHT_M]);
        if opening.bottom > 0.0 {
            shell.add_solid([opening.west, south, 0.0], [opening.east, north, opening.bottom]);
        }
        reached = opening.east;
    }
    shell.add_solid([reached, south, 0.0], [LENGTH_M, north, HEIGHT_M]);
}

/// The lines of the four walls round `floor`: corners, ceiling, and the skirting boards between the doors.
fn line_walls(shell: &mut Template, floor: &Rectangle, south_doors: &[Opening], north_doors: &[Opening]) {
    let Rectangle { west, east, south, north } = *floor;
    let corners = [(west, south), (east, south), (east, north), (west, north)];
    for (x, y) in corners {
        shell.add_line([x, y, 0.0], [x, y, HEIGHT_M]);
    }
    shell.add_outline(&corners.map(|(x, y)| [x, y, HEIGHT_M]));
    for z in [0.0, SKIRTING_M] {
        shell.add_line([west, south, z], [west, north, z]);
        shell.add_line([east, south, z], [east, north, z]);
        for (y, doors) in [(south, south_doors), (north, north_doors)] {
            let mut reached = west;
            for door in doors {
                shell.add_line([reached, y, z], [door.west - CASING_M, y, z]);
                reached = door.east + CASING_M;
            }
            shell.add_line([reached, y, z], [east, y, z]);
        }
    }
}

/// The joints of a room's suspended ceiling.
fn line_ceiling(shell: &mut Template, floor: &Rectangle) {
    let joints = |low: f32, high: f32| {
        let positions = (1..).map(move |index| low + index as f32 * CEILING_TILE_M);
        positions.take_while(move |&at| at < high - 0.1)
    };
    for x in joints(floor.west, floor.east) {
        shell.add_line([x, floor.south, HEIGHT_M], [x, floor.north, HEIGHT_M]);
    }
    for y in joints(floor.south, floor.north) {
        shell.add_line([floor.west, y, HEIGHT_M], [floor.east, y, HEIGHT_M]);
    }
}

/// The door openings of one row of rooms, from west to east.
fn doors(layout: &Layout, is_north: bool) -> Vec<Opening> {
    let rooms = layout.rooms.iter().filter(|room| room.is_north == is_north);
    rooms.map(|room| door_opening(room.door.x)).collect()
}

fn door_opening(x: f32) -> Opening {
    let half = 0.5 * DOOR_WIDTH_M;
    Opening { west: x - half, east: x + half, bottom: 0.0, top: DOOR_HEIGHT_M }
}

fn window_opening(x: f32) -> Opening {
    let half = 0.5 * WINDOW_WIDTH_M;
    Opening { west: x - half, east: x + half, bottom: WINDOW_HEIGHTS_M.0, top: WINDOW_HEIGHTS_M.1 }
}

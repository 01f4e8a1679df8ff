//! Doors, windows, radiators and lamps: the templates that belong to the building, and where they go.
//!
//! Their frame: the middle of the opening at floor height on the inner face of the wall, y into the room.

use super::layout::{DOOR_WIDTH_M, Layout, Rectangle, Room, WALL_M, WINDOW_WIDTH_M};
use super::{HEIGHT_M, LENGTH_M};
use crate::world::WireframeWorld;
use crate::world::template::{Placement, Template};

/// Height of a door opening \[m\].
pub(super) const DOOR_HEIGHT_M: f32 = 2.05;

/// Width of the casing round a door \[m\].
pub(super) const CASING_M: f32 = 0.06;

/// Lower and upper border of a window opening \[m\].
pub(super) const WINDOW_HEIGHTS_M: (f32, f32) = (0.9, 2.2);

/// How far a radiator stands out from the wall \[m\].
pub(super) const RADIATOR_DEPTH_M: f32 = 0.12;

/// Width of a radiator \[m\].
pub(super) const RADIATOR_WIDTH_M: f32 = 1.2;

/// Depth of the glass behind the inner face of the wall \[m\].
const REVEAL_M: f32 = 0.12;

/// Distance between two lamps of the corridor \[m\].
const LAMP_SPACING_M: f32 = 2.8;

/// Adds every door, window, radiator and lamp of a floor plan to `world`.
pub(super) fn place(layout: &Layout, world: &mut WireframeWorld) {
    let (frame, leaf, window, radiator) = (door_frame(), door_leaf(), window(), radiator());
    let (lamp, exit) = (lamp(), exit_door());
    for room in &layout.rooms {
        let (door, is_mirrored) = door_placement(room);
        let hinge = Placement::at(0.5 * DOOR_WIDTH_M, 0.0, 0.0).turned_deg(-room.door.open_deg);
        frame.place(&door, world);
        leaf.place(&door.mirrored(is_mirrored).then(&hinge), world);
        for &x in &room.windows {
            let y = if room.is_north { room.floor.north } else { room.floor.south };
            let below = Placement::at(x, y, 0.0).turned_quarters(if room.is_north { 2 } else { 0 });
            window.place(&below, world);
            radiator.place(&below, world);
        }
        for (x, y) in lamp_grid(&room.floor) {
            lamp.place(&Placement::at(x, y, HEIGHT_M), world);
        }
    }
    let corridor = layout.corridor;
    let middle = 0.5 * (corridor.south + corridor.north);
    for index in 0..(LENGTH_M / LAMP_SPACING_M) as usize {
        lamp.place(&Placement::at((index as f32 + 0.5) * LAMP_SPACING_M, middle, HEIGHT_M), world);
    }
    exit.place(&Placement::at(0.0, middle, 0.0).turned_quarters(3), world);
    exit.place(&Placement::at(LENGTH_M, middle, 0.0).turned_quarters(1), world);
}

/// Where a room's door is, and whether its hinges are on the template's far side.
fn door_placement(room: &Room) -> (Placement, bool) {
    let y = if room.is_north { room.floor.south } else { room.floor.north };
    let quarters = if room.is_north { 0 } else { 2 };
    (Placement::at(room.door.x, y, 0.0).turned_quarters(quarters), room.door.hinges_east != room.is_north)
}

/// Middles of a room's lamps: two rows along the room, a lamp about every three metres.
fn lamp_grid(floor: &Rectangle) -> Vec<(f32, f32)> {
    let (width, depth) = (floor.east - floor.west, floor.north - floor.south);
    let (columns, rows) = ((width / 2.6) as usize, (depth / 2.6) as usize);
    let middle = |low: f32, size: f32, index: usize, count: usize| low + size * (index as f32 + 0.5) / count as f32;
    (0..columns * rows)
        .map(|lamp| {
            let (column, row) = (lamp % columns, lamp / columns);
            (middle(floor.west, width, column, columns), middle(floor.south, depth, row, rows))
        })
        .collect()
}

/// The casing on both faces of a wall, the jambs and the door stop.
fn door_frame() -> Template {
    let mut frame = Template::new("frame");
    let half = 0.5 * DOOR_WIDTH_M;
    for y in [0.0, -WALL_M] {
        for (half, top) in [(half, DOOR_HEIGHT_M), (half + CASING_M, DOOR_HEIGHT_M + CASING_M)] {
            add_arch(&mut frame, y, half, top);
        }
    }
    for x in [-half, half] {
        for z in [0.0, DOOR_HEIGHT_M] {
            frame.add_line([x, -WALL_M, z], [x, 0.0, z]);
        }
    }
    frame
}

/// The two sides and the top of an opening.
fn add_arch(frame: &mut Template, y: f32, half: f32, top: f32) {
    frame.add_line([-half, y, 0.0], [-half, y, top]);
    frame.add_line([half, y, 0.0], [half, y, top]);
    frame.add_line([-half, y, top], [half, y, top]);
}

/// A leaf with two panels and a handle plate on either side; the hinge is the origin, closed it reaches to -x.
fn door_leaf() -> Template {
    let mut leaf = Template::new("leaf");
    let (width, thickness) = (DOOR_WIDTH_M - 0.02, 0.04);
    leaf.add_box([-width, 0.0, 0.01], [0.0, thickness, DOOR_HEIGHT_M - 0.01]);
    for y in [0.0, thickness] {
        leaf.add_front(y, (-width + 0.14, -0.14), (0.2, 0.9));
        leaf.add_front(y, (-width + 0.14, -0.14), (1.1, 1.9));
        leaf.add_front(y, (-width + 0.04, -width + 0.09), (0.92, 1.12));
    }
    leaf
}

/// A closed double door at an end of the corridor, with a panel in either wing.
fn exit_door() -> Template {
    let mut exit = Template::new("exit");
    let half = 0.75;
    for (half, top) in [(half, DOOR_HEIGHT_M), (half + CASING_M, DOOR_HEIGHT_M + CASING_M)] {
        add_arch(&mut exit, 0.0, half, top);
    }
    exit.add_line([0.0, 0.0, 0.0], [0.0, 0.0, DOOR_HEIGHT_M]);
    for wing in [-0.5 * half, 0.5 * half] {
        exit.add_front(0.0, (wing - 0.22, wing + 0.22), (0.25, 0.85));
        exit.add_front(0.0, (wing - 0.22, wing + 0.22), (1.1, 1.85));
    }
    exit.add_box([-half, 0.0, 0.98], [half, 0.05, 1.03]);
    exit
}

/// A window of two casements under a transom, set back in the wall, with its sill.
fn window() -> Template {
    let mut window = Template::new("window");
    let half = 0.5 * WINDOW_WIDTH_M;
    let (bottom, top) = WINDOW_HEIGHTS_M;
    let transom = top - 0.35;
    window.add_surface([
        [-half, -REVEAL_M, bottom],
        [half, -REVEAL_M, bottom],
        [half, -REVEAL_M, top],
        [-half, -REVEAL_M, top],
    ]);
    for y in [0.0, -REVEAL_M] {
        window.add_front(y, (-half, half), (bottom, top));
    }
    for x in [-half, half] {
        for z in [bottom, top] {
            window.add_line([x, -REVEAL_M, z], [x, 0.0, z]);
        }
    }
    for (left, right) in [(-half + 0.06, -0.04), (0.04, half - 0.06)] {
        window.add_front(-REVEAL_M, (left, right), (bottom + 0.06, transom - 0.04));
        window.add_front(-REVEAL_M, (left, right), (transom + 0.04, top - 0.06));
    }
    let (reach, front, under) = (half + 0.05, 0.14, bottom - 0.03);
    window.add_plate([-reach, 0.0, under], [reach, front, bottom]);
    window.add_line([-reach, front, under], [reach, front, under]);
    window
}

/// A radiator that hangs below a window.
fn radiator() -> Template {
    let mut radiator = Template::new("radiator");
    let (half, front) = (0.5 * RADIATOR_WIDTH_M, RADIATOR_DEPTH_M);
    radiator.add_plate([-half, 0.04, 0.14], [half, front, 0.74]);
    radiator.add_line([-half, front, 0.14], [half, front, 0.14]);
    for fin in 0..=8 {
        let x = -half + fin as f32 * 0.15;
        radiator.add_line([x, front, 0.14], [x, front, 0.74]);
    }
    radiator
}

/// A ceiling lamp with a louver; the origin is where it hangs from.
fn lamp() -> Template {
    let mut lamp = Template::new("lamp");
    let (half_length, half_width, bottom) = (0.6, 0.15, -0.06);
    lamp.add_solid([-half_length, -half_width, bottom], [half_length, half_width, 0.0]);
    for z in [bottom, 0.0] {
        lamp.add_outline(&[
            [-half_length, -half_width, z],
            [half_length, -half_width, z],
            [half_length, half_width, z],
            [-half_length, half_width, z],
        ]);
    }
    for rib in 1..4 {
        let x = -half_length + rib as f32 * 0.3;
        lamp.add_line([x, -half_width, bottom], [x, half_width, bottom]);
    }
    lamp
}

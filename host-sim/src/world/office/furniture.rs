//! The furniture of the office, each piece once: every room gets the same ones.

use crate::world::template::Template;

/// A piece of furniture that goes against a wall, with the room it takes.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    pub(super) template: Template,
    /// Along the wall \[m\].
    pub(super) width: f32,
    /// Out from the wall \[m\].
    pub(super) depth: f32,
    /// Heights between which it covers the wall behind it \[m\].
    pub(super) heights: (f32, f32),
    /// How much floor is kept clear before it \[m\].
    pub(super) clearance: f32,
}

/// One of each.
#[derive(Debug)]
pub(super) struct Furniture {
    pub(super) desk: Piece,
    pub(super) chair: Template,
    pub(super) monitor: Template,
    pub(super) bookcase: Piece,
    pub(super) filing_cabinet: Piece,
    pub(super) cupboard: Piece,
    pub(super) table: Template,
    pub(super) whiteboard: Piece,
    pub(super) notice_board: Piece,
    pub(super) picture: Piece,
}

/// Height of a desk \[m\].
pub(super) const DESK_HEIGHT_M: f32 = 0.74;

/// Height of each shelf of a bookcase on which things stand \[m\].
pub(super) const SHELF_HEIGHTS_M: [f32; 5] = [0.08, 0.46, 0.84, 1.22, 1.60];

/// Clear height between two shelves \[m\].
pub(super) const SHELF_CLEAR_M: f32 = 0.355;

/// Depth of a bookcase \[m\].
pub(super) const SHELF_DEPTH_M: f32 = 0.32;

/// Lower and upper border of the notice board, between which sheets are pinned \[m\].
pub(super) const NOTICE_BOARD_HEIGHTS_M: (f32, f32) = (1.0, 1.9);

impl Furniture {
    /// Makes every piece.
    pub(super) fn new() -> Self {
        let piece = |template, (width, depth), heights, clearance| Piece { template, width, depth, heights, clearance };
        Self {
            desk: piece(desk(), (1.6, 0.8), (0.0, 0.85), 0.8),
            chair: chair(),
            monitor: monitor(),
            bookcase: piece(bookcase(), (1.0, SHELF_DEPTH_M), (0.0, 1.98), 0.6),
            filing_cabinet: piece(filing_cabinet(), (0.44, 0.6), (0.0, 1.32), 0.5),
            cupboard: piece(cupboard(), (0.9, 0.45), (0.0, 1.8), 0.6),
            table: table(),
            whiteboard: piece(whiteboard(), (1.8, 0.08), (0.9, 2.1), 0.0),
            notice_board: piece(notice_board(), (1.2, 0.02), NOTICE_BOARD_HEIGHTS_M, 0.0),
            picture: piece(picture(), (0.6, 0.02), (1.2, 1.8), 0.0),
        }
    }
}

/// A desk with two side panels and a pedestal of three drawers; one sits at +y.
fn desk() -> Template {
    let mut desk = Template::new("desk");
    let under = DESK_HEIGHT_M - 0.03;
    desk.add_plate([-0.8, 0.0, under], [0.8, 0.8, DESK_HEIGHT_M]);
    desk.add_line([-0.8, 0.0, under], [-0.8, 0.8, under]);
    desk.add_line([-0.8, 0.8, under], [0.8, 0.8, under]);
    desk.add_line([0.8, 0.0, under], [0.8, 0.8, under]);
    // Where they meet the top, nobody sees them.
    for (low, high) in [([-0.78, 0.05, 0.0], [-0.75, 0.75, under]), ([0.34, 0.1, 0.0], [0.78, 0.74, under])] {
        desk.add_post(low, high);
        desk.add_outline(&[low, [high[0], low[1], 0.0], [high[0], high[1], 0.0], [low[0], high[1], 0.0]]);
    }
    for (bottom, top) in [(0.05, 0.31), (0.32, 0.5), (0.51, 0.69)] {
        desk.add_front(0.74, (0.36, 0.76), (bottom, top));
        desk.add_line([0.48, 0.74, top - 0.05], [0.64, 0.74, top - 0.05]);
    }
    desk.add_surface([[-0.75, 0.2, 0.3], [0.34, 0.2, 0.3], [0.34, 0.2, under], [-0.75, 0.2, under]]);
    desk.add_line([-0.75, 0.2, 0.3], [0.34, 0.2, 0.3]);
    desk
}

/// An office chair on a cross foot; its origin is the middle of the foot, one looks to +y.
fn chair() -> Template {
    let mut chair = Template::new("chair");
    chair.add_box([-0.23, -0.22, 0.42], [0.23, 0.23, 0.49]);
    chair.add_box([-0.21, -0.25, 0.58], [0.21, -0.2, 0.95]);
    chair.add_post([-0.03, -0.25, 0.42], [0.03, -0.22, 0.58]);
    chair.add_post([-0.025, -0.025, 0.06], [0.025, 0.025, 0.42]);
    chair.add_plate([-0.3, -0.02, 0.02], [0.3, 0.02, 0.06]);
    chair.add_plate([-0.02, -0.3, 0.02], [0.02, 0.3, 0.06]);
    chair
}

/// A screen on its foot; the origin is the middle of the foot.
fn monitor() -> Template {
    let mut monitor = Template::new("monitor");
    monitor.add_box([-0.27, -0.02, 0.12], [0.27, 0.02, 0.45]);
    monitor.add_front(0.02, (-0.25, 0.25), (0.15, 0.43));
    monitor.add_post([-0.03, -0.03, 0.01], [0.03, -0.02, 0.2]);
    monitor.add_plate([-0.12, -0.1, 0.0], [0.12, 0.08, 0.01]);
    monitor
}

/// A bookcase, open in front, with five shelves.
fn bookcase() -> Template {
    let mut bookcase = Template::new("bookcase");
    let (half, board, back, top) = (0.5_f32, 0.025, 0.02, 1.98);
    let (left, right) = (-half + board, half - board);
    for (outer, inner) in [(-half, left), (half, right)] {
        bookcase.add_solid([outer.min(inner), 0.0, 0.0], [outer.max(inner), SHELF_DEPTH_M, top]);
        for x in [outer, inner] {
            bookcase.add_line([x, SHELF_DEPTH_M, 0.0], [x, SHELF_DEPTH_M, top]);
        }
        bookcase.add_line([outer, 0.0, 0.0], [outer, 0.0, top]);
        bookcase.add_line([outer, 0.0, 0.0], [outer, SHELF_DEPTH_M, 0.0]);
        bookcase.add_line([inner, back, SHELF_HEIGHTS_M[0]], [inner, back, top - board]);
    }
    bookcase.add_solid([left, 0.0, 0.0], [right, back, top]);
    for z in SHELF_HEIGHTS_M.into_iter().chain([top]) {
        bookcase.add_solid([left, back, z - board], [right, SHELF_DEPTH_M, z]);
        for edge in [z - board, z] {
            bookcase.add_line([left, SHELF_DEPTH_M, edge], [right, SHELF_DEPTH_M, edge]);
        }
    }
    for z in &SHELF_HEIGHTS_M[..3] {
        bookcase.add_line([left, back, *z], [right, back, *z]);
    }
    bookcase
}

/// A filing cabinet of four drawers.
fn filing_cabinet() -> Template {
    let mut cabinet = Template::new("filing");
    let front = 0.6;
    cabinet.add_case([-0.22, 0.0, 0.0], [0.22, front, 1.32]);
    for drawer in 0..4 {
        let bottom = 0.06 + drawer as f32 * 0.31;
        cabinet.add_front(front, (-0.2, 0.2), (bottom, bottom + 0.29));
        cabinet.add_line([-0.08, front, bottom + 0.22], [0.08, front, bottom + 0.22]);
    }
    cabinet
}

/// A cupboard with two doors.
fn cupboard() -> Template {
    let mut cupboard = Template::new("cupboard");
    let front = 0.45;
    cupboard.add_case([-0.45, 0.0, 0.0], [0.45, front, 1.8]);
    for (left, right, handle) in [(-0.43, -0.005, -0.06), (0.005, 0.43, 0.04)] {
        cupboard.add_front(front, (left, right), (0.08, 1.77));
        cupboard.add_front(front, (handle, handle + 0.02), (0.85, 1.05));
    }
    cupboard
}

/// A meeting table; the origin is its middle.
fn table() -> Template {
    let mut table = Template::new("table");
    table.add_box([-1.0, -0.5, 0.71], [1.0, 0.5, 0.74]);
    for (x, y) in [(-0.92, -0.42), (0.92, -0.42), (0.92, 0.42), (-0.92, 0.42)] {
        table.add_post([x - 0.03, y - 0.03, 0.0], [x + 0.03, y + 0.03, 0.71]);
    }
    table
}

/// A whiteboard with its pen tray.
fn whiteboard() -> Template {
    let mut board = Template::new("whiteb");
    board.add_panel([-0.9, 0.0, 0.92], [0.9, 0.03, 2.1]);
    board.add_front(0.03, (-0.86, 0.86), (0.96, 2.06));
    board.add_plate([-0.4, 0.03, 0.9], [0.4, 0.08, 0.92]);
    board
}

/// A framed notice board, without its sheets.
fn notice_board() -> Template {
    let mut board = Template::new("notice");
    let (bottom, top) = NOTICE_BOARD_HEIGHTS_M;
    board.add_panel([-0.6, 0.0, bottom], [0.6, 0.02, top]);
    board.add_front(0.02, (-0.57, 0.57), (bottom + 0.03, top - 0.03));
    board
}

/// A framed picture with its mount.
fn picture() -> Template {
    let mut picture = Template::new("picture");
    picture.add_panel([-0.3, 0.0, 1.2], [0.3, 0.02, 1.8]);
    picture.add_front(0.02, (-0.2, 0.2), (1.3, 1.7));
    picture
}

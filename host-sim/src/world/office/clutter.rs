//! The small things: books, boxes, papers, sheets on boards. Few patterns, dealt out at random.

use super::furniture::{NOTICE_BOARD_HEIGHTS_M, SHELF_CLEAR_M, SHELF_DEPTH_M};
use crate::random::Stream;
use crate::world::WireframeWorld;
use crate::world::template::{Placement, Template};

/// What can stand or hang at a spot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Spot {
    /// One shelf of a bookcase; its frame is the middle of the shelf's back.
    Shelf,
    /// The top of a desk or table; its frame is the middle of the thing.
    Desk,
    /// A notice board; its frame is that of the board.
    Board,
}

/// The spots of an office, to be filled at the end.
#[derive(Debug)]
pub(super) struct Clutter {
    spots: Vec<(Spot, Placement)>,
}

impl Clutter {
    /// No spots yet.
    pub(super) const fn new() -> Self {
        Self { spots: Vec::new() }
    }

    /// Adds a spot.
    pub(super) fn add_spot(&mut self, spot: Spot, placement: Placement) {
        self.spots.push((spot, placement));
    }

    /// Fills spots in random order until `world` holds `edge_count` edges, or there is none left.
    pub(super) fn deal_out(mut self, edge_count: usize, stream: &mut Stream, world: &mut WireframeWorld) {
        for last in (1..self.spots.len()).rev() {
            self.spots.swap(last, stream.index(last + 1));
        }
        let things = [(Spot::Shelf, shelf_things()), (Spot::Desk, desk_things()), (Spot::Board, board_things())];
        for (spot, placement) in self.spots {
            let fitting = things.iter().filter(|(fits, _)| *fits == spot).flat_map(|(_, things)| things);
            let fitting: Vec<&Template> = fitting.collect();
            let thing = fitting[stream.index(fitting.len())];
            let mirror = Placement::at(0.0, 0.0, 0.0).mirrored(stream.chance(0.5));
            if world.edges.len() + thing.edge_count() / 2 <= edge_count {
                thing.place(&placement.then(&mirror), world);
            }
        }
    }
}

/// Rows of books, thick and thin, and boxes.
fn shelf_things() -> Vec<Template> {
    vec![
        books("books a", &[(-0.45, 0.035, 0.29, 11), (0.1, 0.045, 0.24, 5)]),
        books("books b", &[(-0.3, 0.06, 0.31, 10)]),
        books("books c", &[(-0.46, 0.025, 0.21, 8), (-0.05, 0.04, 0.27, 9)]),
        books("books d", &[(-0.46, 0.07, 0.32, 4), (0.18, 0.03, 0.23, 7)]),
        boxes(),
    ]
}

/// Books standing side by side: for each group where it begins, thickness, height and how many. Heights differ a little
/// from book to book, in the same way in every copy.
fn books(name: &str, groups: &[(f32, f32, f32, usize)]) -> Template {
    let mut row = Template::new(name);
    for &(begin, thickness, height, count) in groups {
        let (back, front) = (0.05, SHELF_DEPTH_M - 0.05);
        let height_of = |book: usize| height - [0.0, 0.025, 0.01, 0.04][book % 4];
        for book in 0..count {
            let (left, top) = (begin + book as f32 * thickness, height_of(book));
            row.add_solid([left, back, 0.0], [left + thickness, front, top]);
            row.add_line([left, front, top], [left + thickness, front, top]);
            let top = if book > 0 { top.max(height_of(book - 1)) } else { top };
            row.add_line([left, front, 0.0], [left, front, top]);
        }
        let (right, top) = (begin + count as f32 * thickness, height_of(count - 1));
        row.add_line([right, front, 0.0], [right, front, top]);
    }
    row
}

/// Two archive boxes with labels.
fn boxes() -> Template {
    let mut boxes = Template::new("boxes");
    for left in [-0.42, 0.0] {
        let front = SHELF_DEPTH_M - 0.02;
        boxes.add_box([left, 0.04, 0.0], [left + 0.38, front, SHELF_CLEAR_M - 0.09]);
        boxes.add_front(front, (left + 0.1, left + 0.28), (0.08, 0.2));
    }
    boxes
}

/// A keyboard before papers, a stack of trays, a parcel; none is wider than half a metre.
fn desk_things() -> Vec<Template> {
    let mut papers = Template::new("papers");
    papers.add_plate([-0.22, 0.02, 0.0], [0.22, 0.18, 0.03]);
    papers.add_outline(&[[-0.2, -0.2, 0.0], [0.1, -0.21, 0.0], [0.11, 0.0, 0.0], [-0.19, 0.01, 0.0]]);
    let mut trays = Template::new("trays");
    for tray in 0..3 {
        let bottom = tray as f32 * 0.08;
        trays.add_box([-0.13, -0.16, bottom], [0.13, 0.16, bottom + 0.02]);
    }
    let mut parcel = Template::new("parcel");
    parcel.add_box([-0.2, -0.15, 0.0], [0.2, 0.15, 0.25]);
    parcel.add_line([-0.2, 0.0, 0.25], [0.2, 0.0, 0.25]);
    vec![papers, trays, parcel]
}

/// Sheets on a notice board.
fn board_things() -> Vec<Template> {
    let sheets = |name, lefts: &[(f32, f32, f32, f32)]| {
        let mut sheets = Template::new(name);
        for &(left, bottom, width, height) in lefts {
            let bottom = NOTICE_BOARD_HEIGHTS_M.0 + bottom;
            sheets.add_front(0.02, (left, left + width), (bottom, bottom + height));
        }
        sheets
    };
    vec![
        sheets(
            "sheets a",
            &[(-0.5, 0.45, 0.21, 0.3), (-0.2, 0.4, 0.21, 0.3), (0.1, 0.5, 0.3, 0.21), (-0.45, 0.08, 0.3, 0.21)],
        ),
        sheets(
            "sheets b",
            &[(-0.45, 0.1, 0.42, 0.6), (0.08, 0.45, 0.21, 0.3), (0.32, 0.4, 0.21, 0.3), (0.1, 0.1, 0.3, 0.21)],
        ),
        sheets("sheets c", &[(-0.3, 0.15, 0.42, 0.6), (0.2, 0.2, 0.21, 0.3)]),
    ]
}

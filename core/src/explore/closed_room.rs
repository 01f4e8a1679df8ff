//! Whether what was explored is one room: whether nearly all of it was seen from one place.

use super::grid::Grid;
use super::scan::RangeScan;

/// From one place in a room at least this share of its floor is seen, past its furniture.
const SHARE_IN_ONE_LOOK: f32 = 0.75;

/// The floor that a scan sees \[m2\]: a sector for each ray.
pub(super) fn seen_m2(scan: &RangeScan<'_>) -> f32 {
    let (squares, count) =
        scan.rays().fold((0.0, 0.0), |(squares, count), (_, range_m, _)| (squares + range_m * range_m, count + 1.0));
    core::f32::consts::PI * squares / count
}

impl Grid<'_> {
    /// Whether a look that saw `widest_look_m2` took in most of the floor that is free.
    pub(super) fn is_one_room(&self, widest_look_m2: f32) -> bool {
        let free_cells = self.places().filter(|&at| self.cell(at).is_free()).count();
        widest_look_m2 >= SHARE_IN_ONE_LOOK * self.area_m2(free_cells)
    }

    /// The floor that the last search reached \[m2\].
    pub(super) fn reached_m2(&self) -> f32 {
        self.area_m2(self.places().filter(|&at| self.cell(at).cost != u16::MAX).count())
    }
}

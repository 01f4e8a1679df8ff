//! The cells of a square grid along a ray, one after the other (Amanatides and Woo 1987).

use crate::math;

/// A walk along a ray from cell to cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridWalk {
    /// Column and row of the cell reached.
    pub cell: [i32; 2],
    /// Way from the origin to where the ray enters the cell, in the unit of the cells' side.
    pub entered: f32,
    leaves: [f32; 2],
    spacing: [f32; 2],
    step: [i32; 2],
}

impl GridWalk {
    /// A walk from `origin`, in columns and rows, along a unit `direction`, over cells of a `side` above 0 in the unit in
    /// which ways are told.
    #[must_use]
    pub fn new(origin: [f32; 2], direction: [f32; 2], side: f32) -> Self {
        let cell = origin.map(math::floor);
        let axis = |along: f32, inside: f32| {
            let spacing = if math::abs(along) < 1e-9 { 1e9 } else { side / math::abs(along) };
            let rest = if along > 0.0 { 1.0 - inside } else { inside };
            (rest * spacing, spacing, if along > 0.0 { 1 } else { -1 })
        };
        let (leaves_x, spacing_x, step_x) = axis(direction[0], origin[0] - cell[0]);
        let (leaves_y, spacing_y, step_y) = axis(direction[1], origin[1] - cell[1]);
        Self {
            cell: cell.map(|index| index as i32),
            entered: 0.0,
            leaves: [leaves_x, leaves_y],
            spacing: [spacing_x, spacing_y],
            step: [step_x, step_y],
        }
    }

    /// Way from the origin to where the ray leaves the cell.
    #[must_use]
    pub fn leaves(&self) -> f32 {
        math::min(self.leaves[0], self.leaves[1])
    }

    /// Goes on to the next cell.
    pub fn advance(&mut self) {
        self.entered = self.leaves();
        let axis = if self.leaves[0] < self.leaves[1] { 0 } else { 1 };
        self.leaves[axis] += self.spacing[axis];
        self.cell[axis] += self.step[axis];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_walk_meets_every_cell_in_order_and_tells_where_it_enters() {
        let mut walk = GridWalk::new([0.5, 0.25], [0.6, 0.8], 2.0);
        let mut met = [([0, 0], 0.0); 4];
        for place in &mut met {
            *place = (walk.cell, walk.entered);
            walk.advance();
        }
        // Columns begin at 5/3 and 5, rows at 1.875 and 4.375 of the way.
        let expected = [([0, 0], 0.0), ([1, 0], 5.0 / 3.0), ([1, 1], 1.875), ([1, 2], 4.375)];
        for ((cell, entered), (expected_cell, expected_entered)) in met.into_iter().zip(expected) {
            assert_eq!(cell, expected_cell);
            assert!(math::abs(entered - expected_entered) < 1e-5, "{entered} {expected_entered}");
        }
    }

    #[test]
    fn a_walk_backwards_along_an_axis_stays_in_its_row() {
        let mut walk = GridWalk::new([-0.5, 3.5], [-1.0, 0.0], 1.0);
        walk.advance();
        walk.advance();
        assert_eq!((walk.cell, walk.entered < walk.leaves()), ([-3, 3], true));
    }
}

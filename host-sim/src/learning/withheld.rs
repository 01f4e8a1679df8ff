//! A part of a building that is not learned, so that robots can be put down where no map helps.
//!
//! It grows from a random free cell over the way over free cells, as people would close off what lies nearest to each
//! other behind doors, until it holds the share of the free space asked for: one connected part. With the same seed a
//! larger share holds a smaller one.

use super::place_nodes::Clusters;
use crate::random::Stream;
use crate::world::FreeSpace;
use edgeloc::geometry::Point2;

/// Way over free cells to the nearest learned node from which a place counts as never learned, in metres.
pub const UNLEARNED_WAY_M: f64 = 3.0;

/// The part of a free space that learning leaves out.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Withheld {
    /// For each free cell whether it belongs to the part; empty when nothing is withheld.
    is_withheld: Vec<bool>,
}

impl Withheld {
    /// The part of `space` that holds `share` of it, grown from a cell drawn by `seed`.
    #[must_use]
    pub fn grow(space: &FreeSpace, share: f64, seed: u64) -> Self {
        let cell_count = space.cell_centers().len();
        let wanted = (share * cell_count as f64).round() as usize;
        if wanted == 0 {
            return Self::default();
        }
        let mut clusters = Clusters::new(cell_count);
        clusters.grow(space, [(0, Stream::new(seed, "withheld", 0, 0).index(cell_count))]);
        let mut by_way: Vec<usize> = (0..cell_count).collect();
        by_way.sort_by_key(|&cell| clusters.ways[cell]);
        let mut is_withheld = vec![false; cell_count];
        by_way.into_iter().take(wanted).for_each(|cell| is_withheld[cell] = true);
        Self { is_withheld }
    }

    /// Whether the cell at a point of the floor of `space` is withheld.
    #[must_use]
    pub fn contains(&self, space: &FreeSpace, point: Point2) -> bool {
        !self.is_withheld.is_empty() && space.number_at(point).is_some_and(|cell| self.is_withheld[cell])
    }

    /// How many free cells it has.
    #[must_use]
    pub fn cell_count(&self) -> usize {
        self.is_withheld.iter().filter(|is_withheld| **is_withheld).count()
    }

    /// Centers of its cells.
    #[must_use]
    pub fn cell_centers(&self, space: &FreeSpace) -> Vec<Point2> {
        let is_kept = self.is_withheld.iter().zip(space.cell_centers());
        is_kept.filter(|(is_withheld, _)| **is_withheld).map(|(_, center)| center).collect()
    }

    /// Centers of those of its cells whose way to each of the learned `nodes` is longer than [`UNLEARNED_WAY_M`].
    #[must_use]
    pub fn unlearned_centers(&self, space: &FreeSpace, nodes: &[Point2]) -> Vec<Point2> {
        if self.is_withheld.is_empty() {
            return Vec::new();
        }
        let mut clusters = Clusters::new(self.is_withheld.len());
        clusters.grow(space, nodes.iter().filter_map(|&node| space.number_at(node)).enumerate());
        // Ways are in tenths of a cell.
        let far = UNLEARNED_WAY_M * 10.0 / f64::from(space.cell_m());
        let is_far = |cell: &usize| self.is_withheld[*cell] && clusters.ways[*cell] as f64 > far;
        let centers: Vec<Point2> = space.cell_centers().collect();
        (0..centers.len()).filter(is_far).map(|cell| centers[cell]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::FreeSpaceOptions;
    use crate::world::office::{self, OfficeOptions};

    fn space() -> FreeSpace {
        let world = office::generate(&OfficeOptions::default());
        FreeSpace::of(&world, &FreeSpaceOptions::default()).expect("an office has rooms")
    }

    #[test]
    fn nothing_is_withheld_unless_asked_for() {
        let space = space();
        let none = Withheld::grow(&space, 0.0, 1);
        assert_eq!(none, Withheld::default());
        assert!(none.cell_centers(&space).is_empty() && !space.cell_centers().any(|cell| none.contains(&space, cell)));
        assert!(none.unlearned_centers(&space, &[]).is_empty());
    }

    #[test]
    fn a_quarter_is_one_connected_part_and_a_larger_share_holds_it() {
        let space = space();
        let (part, larger) = (Withheld::grow(&space, 0.25, 7), Withheld::grow(&space, 0.4, 7));
        let share = part.cell_centers(&space).len() as f64 / space.cell_centers().len() as f64;
        assert!((share - 0.25).abs() < 1e-3, "{share}");
        assert_ne!(part, Withheld::grow(&space, 0.25, 8));
        for center in part.cell_centers(&space) {
            assert!(part.contains(&space, center) && larger.contains(&space, center));
        }
        // Walking on withheld cells alone, one of them reaches all.
        let first = part.is_withheld.iter().position(|is_withheld| *is_withheld).expect("a cell");
        let (mut reached, mut waiting) = (vec![false; part.is_withheld.len()], vec![first]);
        reached[first] = true;
        let mut found = 0;
        while let Some(cell) = waiting.pop() {
            found += 1;
            for (beside, _) in space.neighbors(cell) {
                if part.is_withheld[beside] && !std::mem::replace(&mut reached[beside], true) {
                    waiting.push(beside);
                }
            }
        }
        assert_eq!(found, part.cell_count());
    }

    #[test]
    fn unlearned_places_are_far_from_every_learned_node() {
        let space = space();
        let part = Withheld::grow(&space, 0.25, 7);
        let learned: Vec<Point2> = space.cell_centers().filter(|cell| !part.contains(&space, *cell)).collect();
        let unlearned = part.unlearned_centers(&space, &learned);
        assert!(!unlearned.is_empty() && unlearned.len() < part.cell_centers(&space).len());
        for place in unlearned.iter().step_by(100) {
            assert!(part.contains(&space, *place));
            let mut from_place = Clusters::new(part.is_withheld.len());
            from_place.grow(&space, space.number_at(*place).map(|cell| (0, cell)));
            let ways = learned.iter().filter_map(|node| space.number_at(*node)).map(|cell| from_place.ways[cell]);
            let nearest_m = ways.min().expect("a learned node") as f64 * 0.1 * f64::from(space.cell_m());
            assert!(nearest_m > UNLEARNED_WAY_M, "{nearest_m}");
        }
    }
}

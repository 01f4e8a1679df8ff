//! The longest lines of a scene, in memory of a fixed size.

use super::Line;

/// Keeps the longest of the lines offered, as many as the caller's slice holds; equal lengths: the first offered.
///
/// Any number of lines may be offered: as soon as one is more than there is room for, they become a binary heap with the
/// line to be replaced next on top.
#[derive(Debug)]
pub struct LongestLines<'m> {
    storage: &'m mut [Line],
    count: usize,
    is_heap: bool,
}

impl<'m> LongestLines<'m> {
    /// No lines yet, room for as many as `storage` holds.
    pub fn new(storage: &'m mut [Line]) -> Self {
        Self { storage, count: 0, is_heap: false }
    }

    /// Keeps `line` if there is room or it is longer than the shortest kept.
    pub fn offer(&mut self, line: Line) {
        if self.count < self.storage.len() {
            self.storage[self.count] = line;
            self.count += 1;
            return;
        }
        if !self.is_heap {
            (0..self.count / 2).rev().for_each(|parent| self.sift_down(parent));
            self.is_heap = true;
        }
        if self.storage.first().is_some_and(|first| goes_before(first, &line)) {
            self.storage[0] = line;
            self.sift_down(0);
        }
    }

    /// The lines kept, in no particular but a reproducible order.
    #[must_use]
    pub fn into_lines(self) -> &'m mut [Line] {
        let Self { storage, count, .. } = self;
        &mut storage[..count]
    }

    fn sift_down(&mut self, mut parent: usize) {
        loop {
            let (left, right) = (2 * parent + 1, 2 * parent + 2);
            let mut first = parent;
            for child in [left, right] {
                if child < self.count && goes_before(&self.storage[child], &self.storage[first]) {
                    first = child;
                }
            }
            if first == parent {
                return;
            }
            self.storage.swap(parent, first);
            parent = first;
        }
    }
}

/// Whether `a` is given up before `b`: the shorter, of equals the later.
fn goes_before(a: &Line, b: &Line) -> bool {
    (a.length_q4, b.order) < (b.length_q4, a.order)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point2, Polarity, Segment2};
    use crate::pgh::PghShape;
    use proptest::collection::vec;
    use proptest::prelude::*;
    use std::vec::Vec;

    fn line(length_px: f32, order: u32) -> Line {
        let segment = Segment2::new(Point2::new(0.0, 0.0), Point2::new(0.0, length_px), Polarity::LeftBrighter);
        Line::new(&segment.expect("valid"), order, &PghShape::paper())
    }

    proptest! {
        #[test]
        fn the_longest_are_kept_and_ties_go_to_the_first(
            lengths in vec(prop_oneof![(1..6_u8).prop_map(f32::from), 1.0..90.0_f32], 0..40),
            room in 1..20_usize,
        ) {
            let lines: Vec<Line> = (0..).zip(&lengths).map(|(order, length)| line(*length, order)).collect();
            let mut storage = std::vec![line(1.0, 0); room];
            let mut longest = LongestLines::new(&mut storage);
            lines.iter().for_each(|line| longest.offer(*line));
            let mut kept: Vec<u32> = longest.into_lines().iter().map(|line| line.order).collect();
            kept.sort_unstable();
            let mut expected = lines;
            expected.sort_by_key(|line| core::cmp::Reverse(line.length_q4));
            let mut expected: Vec<u32> = expected.iter().take(room).map(|line| line.order).collect();
            expected.sort_unstable();
            prop_assert_eq!(kept, expected);
        }
    }

    #[test]
    fn no_room_keeps_nothing() {
        let mut longest = LongestLines::new(&mut []);
        longest.offer(line(20.0, 0));
        assert!(longest.into_lines().is_empty());
    }
}

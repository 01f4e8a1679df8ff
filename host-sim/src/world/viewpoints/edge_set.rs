//! A set of edges by number, held as ranges: what is visible together was mostly made together.

use std::ops::Range;

/// A set of edge indices.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct EdgeSet {
    /// In order, none empty, none touching the next.
    ranges: Vec<Range<u32>>,
}

impl EdgeSet {
    /// Whether `edge` is in the set.
    #[must_use]
    pub fn contains(&self, edge: u32) -> bool {
        let after = self.ranges.partition_point(|range| range.start <= edge);
        after > 0 && edge < self.ranges[after - 1].end
    }

    /// How many edges are in the set.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ranges.iter().map(ExactSizeIterator::len).sum()
    }

    /// Whether no edge is in the set.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ranges.is_empty()
    }

    /// The edges in order.
    pub fn iter(&self) -> impl Iterator<Item = u32> + '_ {
        self.ranges.iter().cloned().flatten()
    }

    /// The set as ranges in order, none touching the next.
    #[must_use]
    pub fn ranges(&self) -> &[Range<u32>] {
        &self.ranges
    }

    /// Puts `edge` in or takes it out; whether that changed anything.
    pub fn set(&mut self, edge: u32, is_in: bool) -> bool {
        if self.contains(edge) == is_in {
            return false;
        }
        // The first range that begins after the edge; the edge lies in the one before, or in none.
        let at = self.ranges.partition_point(|range| range.start <= edge);
        if is_in {
            self.ranges.insert(at, edge..edge + 1);
            let (from, to) = (at.saturating_sub(1), (at + 2).min(self.ranges.len()));
            let joined = joined(self.ranges[from..to].to_vec());
            self.ranges.splice(from..to, joined);
        } else {
            let Range { start, end } = self.ranges[at - 1];
            let left = [start..edge, edge + 1..end].into_iter().filter(|range| !range.is_empty());
            self.ranges.splice(at - 1..at, left);
        }
        true
    }
}

impl FromIterator<Range<u32>> for EdgeSet {
    /// The union of ranges in any order.
    fn from_iter<I: IntoIterator<Item = Range<u32>>>(ranges: I) -> Self {
        let mut ranges = ranges.into_iter().filter(|range| !range.is_empty()).collect::<Vec<_>>();
        ranges.sort_unstable_by_key(|range| range.start);
        Self { ranges: joined(ranges) }
    }
}

impl FromIterator<u32> for EdgeSet {
    /// Edges below `u32::MAX`, in any order.
    fn from_iter<I: IntoIterator<Item = u32>>(edges: I) -> Self {
        edges.into_iter().map(|edge| edge..edge + 1).collect()
    }
}

/// Ranges in the order of their starts with those that touch or overlap made one.
fn joined(ranges: Vec<Range<u32>>) -> Vec<Range<u32>> {
    let mut joined: Vec<Range<u32>> = Vec::with_capacity(ranges.len());
    for range in ranges {
        match joined.last_mut() {
            Some(last) if range.start <= last.end => last.end = last.end.max(range.end),
            _ => joined.push(range),
        }
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;

    #[test]
    fn any_row_of_changes_leaves_what_a_list_of_flags_says() {
        let mut stream = Stream::new(1, "sets", 0, 0);
        let (mut set, mut flags) = (EdgeSet::default(), [false; 40]);
        for _ in 0..4000 {
            let (edge, is_in) = (stream.index(40), stream.chance(0.5));
            assert_eq!(set.set(edge as u32, is_in), flags[edge] != is_in);
            flags[edge] = is_in;
            let expected = (0..40).filter(|&edge| flags[edge as usize]).collect::<Vec<_>>();
            assert_eq!(set.iter().collect::<Vec<_>>(), expected);
            assert_eq!((set.len(), set.is_empty()), (expected.len(), expected.is_empty()));
            assert!((0..40).all(|edge| set.contains(edge) == flags[edge as usize]));
            assert_eq!(set, expected.into_iter().collect(), "one form for one set");
        }
    }

    #[test]
    fn ranges_in_any_order_are_joined() {
        let set = [7..9, 0..3, 2..4, 9..10, 5..5].into_iter().collect::<EdgeSet>();
        assert_eq!(set.ranges(), [0..4, 7..10]);
    }
}

//! Which pairs of a row's bins meet anything in a panel: those that no line of the panel fills are left out, without
//! changing a sum. Where lines that are alike lie in one panel that is half of all meetings.

use super::LANES;
use crate::matching::{BinPair, PanelRow};

/// Pairs of bins are told for panels of up to so many.
const TOLD: usize = 256;

/// The pairs of bins that any line of a panel fills.
#[derive(Debug)]
pub(super) struct FilledBins {
    filled: [bool; TOLD],
    /// Whether that is all of the panel.
    is_whole: bool,
    meeting: [BinPair; TOLD],
}

impl FilledBins {
    #[inline(always)]
    pub(super) fn of(panel: &[PanelRow]) -> Self {
        let mut filled = [false; TOLD];
        for (filled, row) in filled.iter_mut().zip(panel) {
            let lanes: [u32; LANES] = zerocopy::transmute!(row.roots);
            *filled = lanes.into_iter().fold(0, |any, lane| any | lane) != 0;
        }
        Self { filled, is_whole: panel.len() <= TOLD, meeting: [BinPair { index: 0, roots: [0; 2] }; TOLD] }
    }

    /// The pairs of a `row` that meet something, or all if there are too many to tell.
    #[inline(always)]
    pub(super) fn meeting<'a>(&'a mut self, row: &'a [BinPair]) -> &'a [BinPair] {
        if !self.is_whole || row.len() >= TOLD {
            return row;
        }
        let mut count = 0_usize;
        for pair in row {
            // An index past the panel is looked up in place of another, and counts for nothing later.
            if self.filled[usize::from(pair.index) % TOLD] {
                self.meeting[count % TOLD] = *pair;
                count = count.wrapping_add(1);
            }
        }
        &self.meeting[..count % TOLD]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::kernels::Body;
    use crate::matching::kernels::portable::Portable;
    use proptest::collection::vec;
    use proptest::prelude::*;
    use std::vec::Vec;

    /// Most pairs of bins of a panel are empty, many are filled by one line alone.
    fn panel_row() -> impl Strategy<Value = PanelRow> {
        let alone = (0..LANES, any::<[i16; 2]>()).prop_map(|(lane, both)| {
            let mut row = PanelRow::EMPTY;
            row.roots[lane] = both;
            row
        });
        let full = any::<[[i16; 2]; LANES]>().prop_map(|roots| PanelRow { roots });
        prop_oneof![3 => Just(PanelRow::EMPTY), 2 => alone, 1 => full]
    }

    /// Indices within most panels, past all of them, and past those of which pairs are told.
    fn pair() -> impl Strategy<Value = BinPair> {
        (prop_oneof![4 => 0..40_u16, 2 => 0..320_u16, 1 => any::<u16>()], any::<[i16; 2]>())
            .prop_map(|(index, roots)| BinPair { index, roots })
    }

    proptest! {
        #[test]
        fn what_is_left_out_changes_no_coefficient(
            rows in vec(prop_oneof![4 => vec(pair(), 0..30), 1 => vec(pair(), TOLD - 2..TOLD + 3)], 1..6),
            panel in prop_oneof![4 => vec(panel_row(), 0..40), 1 => vec(panel_row(), TOLD - 2..TOLD + 40)],
        ) {
            let mut filled = FilledBins::of(&panel);
            for row in &rows {
                let meeting = filled.meeting(row);
                prop_assert_eq!(Portable.best_coefficient(meeting, &panel), Portable.best_coefficient(row, &panel));
            }
        }

        #[test]
        fn pairs_that_meet_nothing_are_left_out(
            row in vec(pair(), 0..TOLD),
            panel in vec(panel_row(), 0..=TOLD),
        ) {
            let meets = |pair: &&BinPair| panel.get(usize::from(pair.index)).is_some_and(|row| *row != PanelRow::EMPTY);
            let expected: Vec<BinPair> = row.iter().filter(meets).copied().collect();
            let mut filled = FilledBins::of(&panel);
            let is_within = |pair: &&BinPair| usize::from(pair.index) < panel.len();
            let meeting: Vec<BinPair> = filled.meeting(&row).iter().filter(is_within).copied().collect();
            prop_assert_eq!(meeting, expected);
        }
    }

    #[test]
    fn as_many_pairs_as_are_told_or_more_may_all_meet_something() {
        let panel = [PanelRow { roots: [[1; 2]; LANES] }; 2];
        for count in TOLD - 1..=2 * TOLD + 1 {
            let row: Vec<BinPair> =
                (0..count).map(|index| BinPair { index: index as u16 % 2, roots: [1; 2] }).collect();
            assert_eq!(FilledBins::of(&panel).meeting(&row), row, "{count} pairs");
        }
    }
}

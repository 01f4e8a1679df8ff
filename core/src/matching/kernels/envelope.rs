//! Exact pruning of matching: which lines of a panel need not be met, because they can't raise a row's best coefficient.
//!
//! In every pair of bins a half panel has an envelope, the greatest roots of any of its lines. Roots of histograms are not
//! negative, so a row's coefficient with the envelope is at least that with each of the lines; where it is no more than
//! the best so far they are left out. So are pairs of bins that no line fills. No best coefficient changes, and with them no
//! score, no greatest score and no candidate. Panels of more than [`MOST_ROWS`] rows are met whole.
//!
//! Where lines that are alike lie in one panel half of all half panels are left out. Bounds by merged bins are wider.

use super::LANES;
use crate::matching::{BinPair, PanelRow};

/// Envelopes are of panels of up to so many rows.
const MOST_ROWS: usize = 256;
/// Lines under an envelope.
pub(super) const HALF: usize = LANES / 2;

/// What there is to do with words of two roots each.
pub(super) trait RootWords: Copy {
    /// The greater of the first roots, and of the second.
    fn greater(self, a: u32, b: u32) -> u32;

    /// A sum and the products of the first roots and of the second.
    fn plus_products(self, sum: u32, a: u32, b: u32) -> u32;
}

/// The envelopes of a panel's halves.
#[derive(Debug)]
pub(super) struct Envelopes {
    /// Of each pair of bins the two roots in one word, for either half.
    greatest: [[u32; 2]; MOST_ROWS],
    /// Whether that is all of the panel.
    is_whole: bool,
    meeting: [BinPair; MOST_ROWS],
}

impl Envelopes {
    /// Of the lines of a `panel`.
    #[inline(always)]
    pub(super) fn of(panel: &[PanelRow], words: impl RootWords) -> Self {
        let mut greatest = [[0; 2]; MOST_ROWS];
        for (greatest, row) in greatest.iter_mut().zip(panel) {
            let lanes: [[u32; HALF]; 2] = zerocopy::transmute!(row.roots);
            *greatest = lanes.map(|half| half.into_iter().fold(0, |a, b| words.greater(a, b)));
        }
        Self { greatest, is_whole: panel.len() <= MOST_ROWS, meeting: [BinPair { index: 0, roots: [0; 2] }; MOST_ROWS] }
    }

    /// Raises `best` to the best coefficient of `row` with the panel; `best_of_half` finds that with either half, of the
    /// pairs that it is told.
    #[inline(always)]
    pub(super) fn raise_best(
        &mut self,
        words: impl RootWords,
        row: &[BinPair],
        best: &mut i32,
        best_of_half: impl Fn(usize, &[BinPair]) -> i32,
    ) {
        *best = (*best).max(0);
        let (meeting, bounds) = self.meeting(words, row);
        // The half that promises more comes first: the other may not be needed then.
        let order = if bounds[0] < bounds[1] { [1, 0] } else { [0, 1] };
        for half in order {
            if bounds[half] > best.unsigned_abs() {
                *best = (*best).max(best_of_half(half, meeting));
            }
        }
    }

    /// The pairs of a `row` that meet something, and its coefficients in Q30 with both envelopes; all pairs, and no bound, if
    /// there are too many to tell. By itself, so that all of it stays in registers.
    #[inline(never)]
    fn meeting<'a>(&'a mut self, words: impl RootWords, row: &'a [BinPair]) -> (&'a [BinPair], [u32; 2]) {
        if !self.is_whole || row.len() >= MOST_ROWS {
            return (row, [u32::MAX; 2]);
        }
        let (mut count, mut bounds) = (0_usize, [0_u32; 2]);
        for pair in row {
            // An index past the panel, which rows of its shape have not, is looked up in place of another and counts for
            // nothing later.
            let greatest = self.greatest[usize::from(pair.index) % MOST_ROWS];
            if greatest[0] | greatest[1] != 0 {
                self.meeting[count % MOST_ROWS] = *pair;
                count = count.wrapping_add(1);
                // Of eight unit histograms an envelope has a length of the root of eight at most: no sum passes 2^32.
                for (bound, greatest) in bounds.iter_mut().zip(greatest) {
                    *bound = words.plus_products(*bound, zerocopy::transmute!(pair.roots), greatest);
                }
            }
        }
        (&self.meeting[..count % MOST_ROWS], bounds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::bhattacharyya::Rebuild;
    use crate::matching::kernels::portable::Portable;
    use crate::matching::kernels::{Body, Work};
    use crate::matching::view_score::Score;
    use crate::matching::{Panel, RootRows, ViewScore};
    use crate::pgh::strategies::{any_segments, any_shape};
    use crate::pgh::{HistogramBuilder, Line, LineBlock, PghShape};
    use proptest::collection::vec;
    use proptest::prelude::*;
    use std::cell::Cell;
    use std::vec::Vec;

    impl RootWords for Portable {
        fn greater(self, a: u32, b: u32) -> u32 {
            (a & 0xffff).max(b & 0xffff) | (a >> 16).max(b >> 16) << 16
        }

        fn plus_products(self, sum: u32, a: u32, b: u32) -> u32 {
            sum + (a & 0xffff) * (b & 0xffff) + (a >> 16) * (b >> 16)
        }
    }

    /// Of so many of them no sum passes 2^32.
    fn roots() -> impl Strategy<Value = [i16; 2]> {
        [0..2000_i16, 0..2000_i16]
    }

    /// Most pairs of bins of a panel are empty, many are filled by one line alone.
    fn panel_row() -> impl Strategy<Value = PanelRow> {
        let alone = (0..LANES, roots()).prop_map(|(lane, both)| {
            let mut row = PanelRow::EMPTY;
            row.roots[lane] = both;
            row
        });
        let full = prop::array::uniform16(roots()).prop_map(|roots| PanelRow { roots });
        prop_oneof![3 => Just(PanelRow::EMPTY), 2 => alone, 1 => full]
    }

    /// Indices within most panels, past all of them, and past those that have envelopes.
    fn pair() -> impl Strategy<Value = BinPair> {
        (prop_oneof![4 => 0..40_u16, 2 => 0..320_u16, 1 => any::<u16>()], roots())
            .prop_map(|(index, roots)| BinPair { index, roots })
    }

    /// Rows that are met one after another, and panels that are, short ones and such as are too long for envelopes.
    fn rows_and_panels() -> impl Strategy<Value = (Vec<Vec<BinPair>>, Vec<Vec<PanelRow>>)> {
        let row = prop_oneof![4 => vec(pair(), 0..30), 1 => vec(pair(), MOST_ROWS - 2..MOST_ROWS + 3)];
        let panel = prop_oneof![4 => vec(panel_row(), 0..40), 1 => vec(panel_row(), MOST_ROWS - 2..MOST_ROWS + 40)];
        (vec(row, 1..6), vec(panel, 1..4))
    }

    /// The panel with one half of its lines alone.
    fn half_of(panel: &[PanelRow], half: usize) -> Vec<PanelRow> {
        let keep = |row: &PanelRow| {
            let mut kept = PanelRow::EMPTY;
            kept.roots[half * HALF..][..HALF].copy_from_slice(&row.roots[half * HALF..][..HALF]);
            kept
        };
        panel.iter().map(keep).collect()
    }

    /// Raises the best coefficients of `rows` and returns how many half panels they met.
    fn raise(rows: &[Vec<BinPair>], panel: &[PanelRow], best: &mut [i32]) -> usize {
        let (met, halves) = (Cell::new(0), [half_of(panel, 0), half_of(panel, 1)]);
        let mut envelopes = Envelopes::of(panel, Portable);
        for (row, best) in rows.iter().zip(best) {
            envelopes.raise_best(Portable, row, best, |half, row| {
                met.set(met.get() + 1);
                Portable.best_coefficient(row, &halves[half])
            });
        }
        met.get()
    }

    /// Portable code with pruning.
    #[derive(Clone, Copy)]
    struct Pruning;

    impl Body for Pruning {
        const NAME: &'static str = "pruning";

        fn best_coefficient(self, row: &[BinPair], panel: &[PanelRow]) -> i32 {
            Portable.best_coefficient(row, panel)
        }

        fn raise_best<'a>(self, rows: impl Iterator<Item = &'a [BinPair]>, panel: &[PanelRow], best: &mut [i32]) {
            let rows: Vec<Vec<BinPair>> = rows.map(<[BinPair]>::to_vec).collect();
            raise(&rows, panel, best);
        }
    }

    /// The scores of a scene against several views.
    struct Scores<'a> {
        shape: &'a PghShape,
        scene: &'a [Line],
        views: &'a [Vec<Line>],
    }

    impl Work for Scores<'_> {
        type Output = Vec<ViewScore>;

        fn run<B: Body>(self, body: B) -> Vec<ViewScore> {
            let Self { shape, scene, views } = self;
            let most = views.iter().map(Vec::len).max().unwrap_or(0).max(scene.len());
            let mut memory = std::vec![0; HistogramBuilder::memory_len(shape)];
            let mut blocks = std::vec![LineBlock::EMPTY; LineBlock::count_for(most)];
            let mut builder = HistogramBuilder::new(shape, &mut memory, &mut blocks).expect("enough memory");
            let empty = BinPair { index: 0, roots: [0; 2] };
            let mut pairs = std::vec![empty; RootRows::pairs_len(scene.len(), shape.bin_count())];
            let mut ends = std::vec![0; scene.len()];
            let mut rows = RootRows::new(&mut pairs, &mut ends);
            Rebuild { rows: &mut rows, builder: &mut builder, lines: scene }.run(body).expect("enough memory");
            let mut panel_rows = std::vec![PanelRow::EMPTY; Panel::rows_len(shape.bin_count())];
            let mut best = std::vec![0; scene.len()];
            let score = |view: &Vec<Line>| {
                let (builder, panel, best) = (&mut builder, &mut Panel::new(&mut panel_rows), &mut best);
                let score = Score { scene_lines: scene, scene_rows: &rows, view_lines: view, builder, panel, best };
                score.run(body).expect("enough memory")
            };
            views.iter().map(score).collect()
        }
    }

    proptest! {
        #[test]
        fn scores_are_those_of_the_full_scan(
            shape in any_shape(),
            scene in any_segments(1..20),
            views in vec(any_segments(0..40), 1..5),
        ) {
            let lines = |segments: &Vec<_>| segments.iter().map(|segment| Line::new(segment, 0, &shape)).collect();
            let (scene, views): (Vec<Line>, Vec<Vec<Line>>) = (lines(&scene), views.iter().map(lines).collect());
            let scores = || Scores { shape: &shape, scene: &scene, views: &views };
            prop_assert_eq!(scores().run(Pruning), scores().run(Portable));
        }

        #[test]
        fn what_is_left_out_changes_no_best_coefficient(
            (rows, panels) in rows_and_panels(),
            start in prop_oneof![4 => Just(0), 1 => any::<i32>()],
        ) {
            let mut best = std::vec![start; rows.len()];
            let mut full = best.clone();
            for panel in &panels {
                raise(&rows, panel, &mut best);
                Portable.raise_best(rows.iter().map(|row| &row[..]), panel, &mut full);
                prop_assert_eq!(&best, &full);
            }
        }

        #[test]
        fn pairs_that_meet_nothing_are_left_out(
            row in vec(pair(), 0..MOST_ROWS),
            panel in vec(panel_row(), 0..=MOST_ROWS),
        ) {
            let is_within = |pair: &&BinPair| usize::from(pair.index) < panel.len();
            let is_filled = |pair: &&BinPair| panel[usize::from(pair.index)] != PanelRow::EMPTY;
            let expected: Vec<BinPair> = row.iter().filter(is_within).filter(is_filled).copied().collect();
            let mut envelopes = Envelopes::of(&panel, Portable);
            let meeting: Vec<BinPair> = envelopes.meeting(Portable, &row).0.iter().filter(is_within).copied().collect();
            prop_assert_eq!(meeting, expected);
        }

        // Of one line an envelope is that line: its bound is met, by the better half of a panel and by no half twice.
        #[test]
        fn half_panels_that_cannot_raise_the_best_are_left_out(
            row in vec((0..40_u16, roots()).prop_map(|(index, roots)| BinPair { index, roots }), 0..30),
            lines in vec((roots(), roots()), 40),
        ) {
            let panel: Vec<PanelRow> = lines.into_iter().map(|(first, second)| {
                let mut row = PanelRow::EMPTY;
                (row.roots[0], row.roots[LANES - 1]) = (first, second);
                row
            }).collect();
            let mut best = [0];
            let met = raise(core::slice::from_ref(&row), &panel, &mut best);
            prop_assert_eq!(met, usize::from(best[0] > 0));
            prop_assert_eq!(raise(&[row], &panel, &mut best), 0);
        }
    }

    #[test]
    fn as_many_pairs_as_have_envelopes_or_more_may_all_meet_something() {
        let panel = [PanelRow { roots: [[1; 2]; LANES] }; 2];
        for count in MOST_ROWS - 1..=2 * MOST_ROWS + 1 {
            let row: Vec<BinPair> =
                (0..count).map(|index| BinPair { index: index as u16 % 2, roots: [1; 2] }).collect();
            assert_eq!(Envelopes::of(&panel, Portable).meeting(Portable, &row).0, row, "{count} pairs");
        }
    }
}

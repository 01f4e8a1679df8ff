//! The two forms in which root histograms meet: sparse rows and dense panels.

use super::kernels::{self, Body, LANES, Work};
use crate::geometry::CapacityError;
use crate::pgh::{HistogramBuilder, Line};
use zerocopy::{FromBytes, Immutable, IntoBytes};

/// Two neighbouring bins of a sparse histogram, at least one of them not empty.
#[derive(Debug, Clone, Copy, PartialEq, Eq, FromBytes, IntoBytes, Immutable)]
#[repr(C)]
pub struct BinPair {
    /// Bins `2 index` and `2 index + 1`.
    pub index: u16,
    /// Their square roots in Q15.
    pub roots: [i16; 2],
}

/// The same pair of bins of every line of a panel: a cache line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, FromBytes, IntoBytes, Immutable)]
#[repr(C, align(64))]
pub struct PanelRow {
    /// Square roots in Q15 of two bins, for each line.
    pub roots: [[i16; 2]; LANES],
}

impl PanelRow {
    pub(super) const EMPTY: Self = Self { roots: [[0; 2]; LANES] };
}

/// Number of bin pairs that hold `bins` bins.
pub(super) const fn pair_count(bins: usize) -> usize {
    bins.div_ceil(2)
}

/// The histograms of a scene, one sparse row for each reference line.
#[derive(Debug)]
pub struct RootRows<'m> {
    pairs: &'m mut [BinPair],
    /// Where each row ends in `pairs`.
    ends: &'m mut [u32],
    count: usize,
}

impl<'m> RootRows<'m> {
    /// Bin pairs that always suffice for `lines` rows of `bins` bins.
    #[must_use]
    pub const fn pairs_len(lines: usize, bins: usize) -> usize {
        lines.saturating_mul(pair_count(bins))
    }

    /// No rows yet; room for as many as `ends` holds.
    pub fn new(pairs: &'m mut [BinPair], ends: &'m mut [u32]) -> Self {
        Self { pairs, ends, count: 0 }
    }

    /// Replaces the rows by the histograms of all `lines`.
    ///
    /// # Errors
    /// When there are more lines than rows, or more bin pairs than fit; nothing is kept then.
    pub fn rebuild(&mut self, builder: &mut HistogramBuilder<'_>, lines: &[Line]) -> Result<(), CapacityError> {
        kernels::run(Rebuild { rows: self, builder, lines })
    }

    /// The rows in the order of the lines.
    #[inline(always)]
    pub fn rows(&self) -> impl Iterator<Item = &[BinPair]> {
        let ends = &self.ends[..self.count];
        let starts = core::iter::once(0).chain(ends.iter().copied());
        starts.zip(ends).map(|(start, end)| &self.pairs[start as usize..*end as usize])
    }
}

/// [`RootRows::rebuild`] as work for any machine.
pub(super) struct Rebuild<'a, 'm, 'b> {
    pub(super) rows: &'a mut RootRows<'m>,
    pub(super) builder: &'a mut HistogramBuilder<'b>,
    pub(super) lines: &'a [Line],
}

impl Work for Rebuild<'_, '_, '_> {
    type Output = Result<(), CapacityError>;

    #[inline(always)]
    fn run<B: Body>(self, _: B) -> Self::Output {
        let Self { rows, builder, lines } = self;
        rows.count = 0;
        if lines.len() > rows.ends.len() {
            return Err(CapacityError { what: "scene rows", capacity: rows.ends.len(), needed: lines.len() });
        }
        builder.load(lines)?;
        let mut filled = 0_usize;
        for (reference, line) in lines.iter().enumerate() {
            let pairs = &mut *rows.pairs;
            builder.build(line, reference, |index, roots| {
                if let Some(pair) = pairs.get_mut(filled) {
                    *pair = BinPair { index, roots };
                }
                filled += 1;
            });
            if filled > rows.pairs.len() {
                return Err(CapacityError { what: "scene bin pairs", capacity: rows.pairs.len(), needed: filled });
            }
            rows.ends[reference] = filled as u32;
        }
        rows.count = lines.len();
        Ok(())
    }
}

/// The histograms of up to [`LANES`] lines of a view, transposed.
#[derive(Debug)]
pub struct Panel<'m> {
    rows: &'m mut [PanelRow],
}

impl<'m> Panel<'m> {
    /// Rows of a panel of histograms with `bins` bins.
    #[must_use]
    pub const fn rows_len(bins: usize) -> usize {
        pair_count(bins)
    }

    /// A panel over the caller's memory, [`Self::rows_len`] rows for the shape that it will be filled with.
    pub fn new(rows: &'m mut [PanelRow]) -> Self {
        Self { rows }
    }

    /// Replaces the panel by the histograms about up to [`LANES`] of the `lines` that `builder` has loaded, from the
    /// `first`-th on.
    pub fn rebuild(&mut self, builder: &mut HistogramBuilder<'_>, lines: &[Line], first: usize) {
        kernels::run(Fill { panel: self, builder, lines, first });
    }

    /// [`Self::rebuild`] within other work.
    #[inline(always)]
    pub(super) fn fill(&mut self, builder: &mut HistogramBuilder<'_>, lines: &[Line], first: usize) {
        self.rows.fill(PanelRow::EMPTY);
        for (lane, (reference, line)) in lines.iter().enumerate().skip(first).take(LANES).enumerate() {
            let rows = &mut *self.rows;
            builder.build_dense(line, reference, |index, roots| {
                if let Some(row) = rows.get_mut(usize::from(index)) {
                    row.roots[lane] = roots;
                }
            });
        }
    }
}

/// [`Panel::rebuild`] as work for any machine.
struct Fill<'a, 'm, 'b> {
    panel: &'a mut Panel<'m>,
    builder: &'a mut HistogramBuilder<'b>,
    lines: &'a [Line],
    first: usize,
}

impl Work for Fill<'_, '_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<B: Body>(self, _: B) {
        self.panel.fill(self.builder, self.lines, self.first);
    }
}

/// The best coefficient in Q30 of a scene's `row` with a line of the panel `rows`, 0 if none is positive: what
/// [`score_view`](super::score_view) does for each row of a scene and each panel of a view, by itself.
///
/// An index past the panel counts for nothing; sums of what is not a histogram wrap.
#[must_use]
pub fn best_coefficient(row: &[BinPair], rows: &[PanelRow]) -> i32 {
    kernels::run(Coefficient { row, rows })
}

/// [`best_coefficient`] as work for any machine.
struct Coefficient<'a> {
    row: &'a [BinPair],
    rows: &'a [PanelRow],
}

impl Work for Coefficient<'_> {
    type Output = i32;

    #[inline(always)]
    fn run<B: Body>(self, body: B) -> i32 {
        body.best_coefficient(self.row, self.rows)
    }
}

/// Raises `best`, a number for each of `rows`, to the row's best coefficient in Q30 with a line of the `panels`; lanes left
/// empty give 0.
///
/// With vectors several panels together are faster than one after another; with the DSP extension of Cortex-M lines that
/// can't raise the best are left out. Of what are not histograms of one shape machines make different numbers.
pub fn best_coefficients(rows: &RootRows<'_>, panels: &[Panel<'_>], best: &mut [i32]) {
    kernels::run(Meet { rows, panels, best });
}

/// [`best_coefficients`] as work for any machine.
struct Meet<'a, 'r, 'p> {
    rows: &'a RootRows<'r>,
    panels: &'a [Panel<'p>],
    best: &'a mut [i32],
}

impl Work for Meet<'_, '_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<B: Body>(self, body: B) {
        raise_best(body, self.rows, self.panels, self.best);
    }
}

/// [`best_coefficients`] within other work: three panels at a time, rather two and two than three and one.
#[inline(always)]
pub(super) fn raise_best(body: impl Body, rows: &RootRows<'_>, panels: &[Panel<'_>], best: &mut [i32]) {
    let mut rest = panels;
    loop {
        rest = match rest {
            [] => return,
            [a] => return body.raise_best(rows.rows(), a.rows, best),
            [a, b] => meet(body, rows, [a, b], &[], best),
            [a, b, _, _] => meet(body, rows, [a, b], &rest[2..], best),
            [a, b, c, later @ ..] => meet(body, rows, [a, b, c], later, best),
        };
    }
}

/// Raises `best` to the best coefficients with `panels`; while they are met, some of the `later` ones are fetched, which
/// are returned.
#[inline(always)]
fn meet<'a, 'p, const PANELS: usize>(
    body: impl Body,
    rows: &RootRows<'_>,
    panels: [&Panel<'_>; PANELS],
    later: &'a [Panel<'p>],
    best: &mut [i32],
) -> &'a [Panel<'p>] {
    let panels = panels.map(|panel| &*panel.rows);
    let mut next = later.iter().take(PANELS).flat_map(|panel| &*panel.rows);
    let a_row = (PANELS * panels[0].len()).div_ceil(rows.count.max(1));
    for (row, best) in rows.rows().zip(best) {
        next.by_ref().take(a_row).for_each(|row| body.will_read(row));
        *best = (*best).max(body.best_of_panels(row, panels));
    }
    later
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pgh::strategies::{any_segments, any_shape};
    use crate::pgh::{LineBlock, PghShape};
    use proptest::prelude::*;
    use std::vec;
    use std::vec::Vec;

    /// The histograms of all lines, dense: as rows hold them, and as panels do that held other ones before.
    struct BothForms<'a>(&'a PghShape, &'a [Line]);

    impl Work for BothForms<'_> {
        type Output = [Vec<Vec<[i16; 2]>>; 2];

        fn run<B: Body>(self, _: B) -> Self::Output {
            let Self(shape, lines) = self;
            let mut memory = vec![-1; HistogramBuilder::memory_len(shape)];
            let mut blocks = vec![LineBlock::EMPTY; LineBlock::count_for(lines.len())];
            let mut builder = HistogramBuilder::new(shape, &mut memory, &mut blocks).expect("enough memory");
            builder.load(lines).expect("enough blocks");
            let mut of_rows = vec![vec![[0; 2]; pair_count(shape.bin_count())]; lines.len()];
            let mut panel_rows = vec![PanelRow { roots: [[7; 2]; LANES] }; Panel::rows_len(shape.bin_count())];
            let mut of_panels = Vec::new();
            for first in (0..lines.len()).step_by(LANES) {
                let mut panel = Panel::new(&mut panel_rows);
                panel.fill(&mut builder, lines, first);
                let lane = |lane: usize| panel.rows.iter().map(|row| row.roots[lane]).collect();
                of_panels.extend((0..LANES.min(lines.len() - first)).map(lane));
                // In turns, so that what the one leaves behind would show in the other.
                for (reference, line) in lines.iter().enumerate().skip(first).take(LANES) {
                    builder.build(line, reference, |index, roots| of_rows[reference][usize::from(index)] = roots);
                }
            }
            [of_rows, of_panels]
        }
    }

    proptest! {
        #[test]
        fn panels_hold_what_rows_hold(shape in any_shape(), segments in any_segments(0..40)) {
            let lines: Vec<Line> = segments.iter().map(|segment| Line::new(segment, 0, &shape)).collect();
            let [of_rows, of_panels] = kernels::run(BothForms(&shape, &lines));
            prop_assert_eq!(of_rows, of_panels);
        }
    }
}

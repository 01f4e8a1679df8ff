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

/// The same pair of bins of every line of a panel, aligned as working memory is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, FromBytes, IntoBytes, Immutable)]
#[repr(C, align(8))]
pub struct PanelRow {
    /// Square roots in Q15 of two bins, for each line.
    pub roots: [[i16; 2]; LANES],
}

impl PanelRow {
    const EMPTY: Self = Self { roots: [[0; 2]; LANES] };
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

    /// Fills the panel with the histograms about up to [`LANES`] of the `lines` that `builder` has loaded, from the
    /// `first`-th on.
    #[inline(always)]
    pub(super) fn fill(&mut self, builder: &mut HistogramBuilder<'_>, lines: &[Line], first: usize) {
        self.rows.fill(PanelRow::EMPTY);
        for (lane, (reference, line)) in lines.iter().enumerate().skip(first).take(LANES).enumerate() {
            let rows = &mut *self.rows;
            builder.build(line, reference, |index, roots| {
                if let Some(row) = rows.get_mut(usize::from(index)) {
                    row.roots[lane] = roots;
                }
            });
        }
    }

    /// The best coefficient in Q30 of `row` with a line of the panel; lanes left empty give 0.
    #[inline(always)]
    pub(super) fn best_coefficient(&self, body: impl Body, row: &[BinPair]) -> i32 {
        body.best_coefficient(row, self.rows)
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

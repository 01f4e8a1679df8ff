//! The inner loop of matching, one sparse row against one panel, look-ups in tables, and which instructions the work around
//! them may use.
//!
//! Several bodies, the same bits: integer sums do not depend on their order, and what is not written by hand is the same
//! portable source compiled once for each set of instructions.

#[cfg(edgeloc_body = "smlad")]
mod cortex_m;
mod distance_steps;
#[cfg(any(test, edgeloc_body = "smlad"))]
mod envelope;
#[cfg(edgeloc_body = "neon")]
mod neon;
#[cfg(any(test, edgeloc_body = "portable"))]
mod portable;
#[cfg(edgeloc_body = "simd128")]
mod simd128;
#[cfg(edgeloc_body = "x86_64")]
mod x86_64;

pub(crate) use distance_steps::lower_by_step;

use super::{BinPair, PanelRow};

/// View lines in a panel: one vector of coefficients.
pub const LANES: usize = 16;

/// Whether lines whose histograms are alike should lie in one panel: pairs of bins that none of them fills are left out then,
/// and lines that can't raise a row's best.
pub(crate) const PRUNES: bool = cfg!(edgeloc_body = "smlad");

/// A way to compute coefficients and to look bytes up.
pub(crate) trait Body: Copy {
    /// What it is called.
    const NAME: &'static str;

    /// The best coefficient in Q30 of one scene row with a panel's lines; 0 if none is positive.
    fn best_coefficient(self, row: &[BinPair], panel: &[PanelRow]) -> i32;

    /// The best with the lines of several panels, as far as all of them go: what is read of the row serves them all.
    #[inline(always)]
    fn best_of_panels<const PANELS: usize>(self, row: &[BinPair], panels: [&[PanelRow]; PANELS]) -> i32 {
        as_far_as_all_go(panels).into_iter().fold(0, |best, panel| best.max(self.best_coefficient(row, panel)))
    }

    /// Raises `best`, a number for each of `rows`, to the row's best coefficient with one panel.
    #[inline(always)]
    fn raise_best<'a>(self, rows: impl Iterator<Item = &'a [BinPair]>, panel: &[PanelRow], best: &mut [i32]) {
        for (row, best) in rows.zip(best) {
            *best = (*best).max(self.best_coefficient(row, panel));
        }
    }

    /// Hints that a panel's row will soon be read.
    #[inline(always)]
    fn will_read(self, _: &PanelRow) {}

    /// The bytes of `table` at `places`, as many as a panel has lanes at most; 0 beyond its end.
    #[inline(always)]
    fn bytes_at<const N: usize>(self, table: &[[u8; 4]], places: &[u32; N]) -> [u32; N] {
        let bytes = table.as_flattened();
        let mut found = [0; N];
        for (found, place) in found.iter_mut().zip(places) {
            *found = bytes.get(*place as usize).map_or(0, |byte| u32::from(*byte));
        }
        found
    }

    /// The bytes of a table of 128 at `places`, of which the low seven bits count; so few that vectors may hold them.
    #[inline(always)]
    fn bytes_of_few<const N: usize>(self, table: &[[u8; 4]; 32], places: &[u32; N]) -> [u32; N] {
        places.map(|place| u32::from(table.as_flattened()[place as usize % 128]))
    }
}

/// The panels' rows that all of them have.
#[inline(always)]
fn as_far_as_all_go<const PANELS: usize>(panels: [&[PanelRow]; PANELS]) -> [&[PanelRow]; PANELS] {
    let shared = panels.iter().map(|panel| panel.len()).min().unwrap_or(0);
    panels.map(|panel| panel.get(..shared).unwrap_or_default())
}

/// The row of each panel with that index, if all have it.
#[cfg(edgeloc_body = "x86_64")]
#[inline(always)]
fn rows_at<const PANELS: usize>(panels: [&[PanelRow]; PANELS], index: u16) -> Option<[&PanelRow; PANELS]> {
    let index = usize::from(index);
    let mut rows = [&PanelRow::EMPTY; PANELS];
    for (row, panel) in rows.iter_mut().zip(panels) {
        *row = panel.get(index)?;
    }
    Some(rows)
}

/// Work that is compiled once for each body. Everything it calls has to be `inline(always)` to profit.
pub(crate) trait Work {
    /// What comes of it.
    type Output;

    /// Does it, with what `body` has for it.
    fn run<B: Body>(self, body: B) -> Self::Output;
}

#[cfg(edgeloc_body = "smlad")]
use cortex_m::Smlad as Known;
#[cfg(edgeloc_body = "neon")]
use neon::Neon as Known;
#[cfg(edgeloc_body = "portable")]
use portable::Portable as Known;
#[cfg(edgeloc_body = "simd128")]
use simd128::Simd128 as Known;

/// Does `work` with the body that the machine is known to have when this is compiled.
#[cfg(not(edgeloc_body = "x86_64"))]
pub(crate) fn run<W: Work>(work: W) -> W::Output {
    work.run(Known)
}
#[cfg(edgeloc_body = "x86_64")]
pub use x86_64::limit_body;
#[cfg(edgeloc_body = "x86_64")]
pub(crate) use x86_64::run;

/// Name of the body that does the work on this machine, such as `AVX-512 VNNI`.
#[must_use]
pub fn body_name() -> &'static str {
    struct Name;
    impl Work for Name {
        type Output = &'static str;

        fn run<B: Body>(self, _: B) -> &'static str {
            B::NAME
        }
    }
    run(Name)
}

#[cfg(all(test, edgeloc_body = "x86_64"))]
mod tests {
    use super::*;
    use crate::matching::RootRows;
    use crate::matching::bhattacharyya::Rebuild;
    use crate::pgh::strategies::{any_segments, any_shape};
    use crate::pgh::{HistogramBuilder, Line, LineBlock, PghShape};
    use proptest::prelude::*;
    use std::vec;
    use std::vec::Vec;

    /// The best coefficient of each row with each lane of a panel by itself.
    struct Coefficients<'a>(&'a [Vec<BinPair>], &'a [PanelRow]);

    impl Work for Coefficients<'_> {
        type Output = Vec<i32>;

        fn run<B: Body>(self, body: B) -> Vec<i32> {
            let alone = |lane: usize| -> Vec<PanelRow> {
                let keep = |row: &PanelRow| {
                    let mut roots = [[0; 2]; LANES];
                    roots[lane] = row.roots[lane];
                    PanelRow { roots }
                };
                self.1.iter().map(keep).collect()
            };
            let panels: Vec<Vec<PanelRow>> = (0..LANES).map(alone).chain([self.1.to_vec()]).collect();
            let mut found = Vec::new();
            for row in self.0 {
                found.extend(panels.iter().map(|panel| body.best_coefficient(row, panel)));
                // Several at a time, of one length and of two.
                let three = |panels: &[Vec<PanelRow>]| body.best_of_panels(row, [&panels[0], &panels[1], &panels[2]]);
                found.extend(panels.windows(3).map(three));
                found.push(body.best_of_panels(row, [&panels[0][..30], &panels[LANES]]));
            }
            found
        }
    }

    /// All rows of a scene.
    struct Rows<'a>(&'a PghShape, &'a [Line]);

    impl Work for Rows<'_> {
        type Output = Vec<Vec<BinPair>>;

        #[inline(always)]
        fn run<B: Body>(self, body: B) -> Self::Output {
            let Self(shape, lines) = self;
            let mut memory = vec![0; HistogramBuilder::memory_len(shape)];
            let mut blocks = vec![LineBlock::EMPTY; LineBlock::count_for(lines.len())];
            let mut builder = HistogramBuilder::new(shape, &mut memory, &mut blocks).expect("enough memory");
            let empty = BinPair { index: 0, roots: [0; 2] };
            let mut pairs = vec![empty; RootRows::pairs_len(lines.len(), shape.bin_count())];
            let mut ends = vec![0; lines.len()];
            let mut rows = RootRows::new(&mut pairs, &mut ends);
            Rebuild { rows: &mut rows, builder: &mut builder, lines }.run(body).expect("enough memory");
            rows.rows().map(<[BinPair]>::to_vec).collect()
        }
    }

    /// The bytes at some places, of a table and of its beginning, for different numbers of lanes.
    struct Bytes<'a>(&'a [[u8; 4]], [u32; LANES]);

    impl Work for Bytes<'_> {
        type Output = Vec<u32>;

        fn run<B: Body>(self, body: B) -> Vec<u32> {
            let Self(table, places) = self;
            let few = core::array::from_fn(|quad| table.get(quad).copied().unwrap_or_default());
            let part = core::array::from_fn::<u32, 5, _>(|lane| places[lane]);
            let mut found = Vec::new();
            found.extend(body.bytes_at(table, &places));
            found.extend(body.bytes_at(table, &part));
            found.extend(body.bytes_at(table, &[places[0]]));
            found.extend(body.bytes_of_few(&few, &places));
            found.extend(body.bytes_of_few(&few, &part));
            found
        }
    }

    /// Roots are Q15 magnitudes, at times full ones or none.
    fn roots() -> impl Strategy<Value = [i16; 2]> {
        let root = || prop_oneof![4 => 0..=i16::MAX, 1 => Just(0), 1 => Just(i16::MAX)];
        (root(), root()).prop_map(|(even, odd)| [even, odd])
    }

    proptest! {
        // Rows below, at and above the pairs that are under way at a time; indices past the panel count for nothing.
        #[test]
        fn all_bodies_give_the_same_coefficients(
            rows in prop::collection::vec(prop::collection::vec((0_u16..40, roots()), 0..20), 1..4),
            panel in prop::collection::vec(prop::array::uniform16(roots()), 32),
        ) {
            let pair = |(index, roots)| BinPair { index, roots };
            let rows: Vec<Vec<BinPair>> = rows.into_iter().map(|row| row.into_iter().map(pair).collect()).collect();
            let panel: Vec<PanelRow> = panel.into_iter().map(|roots| PanelRow { roots }).collect();
            let expected = Coefficients(&rows, &panel).run(portable::Portable);
            for (name, found) in x86_64::run_all(|| Coefficients(&rows, &panel)) {
                prop_assert_eq!(&found, &expected, "{}", name);
            }
        }

        // Places within the table, about its end, and far beyond.
        #[test]
        fn all_bodies_find_the_same_bytes(
            table in prop::collection::vec(prop::array::uniform4(any::<u8>()), 0..60),
            places in prop::array::uniform16(prop_oneof![4 => 0_u32..260, 1 => any::<u32>()]),
        ) {
            let expected = Bytes(&table, places).run(portable::Portable);
            for (name, found) in x86_64::run_all(|| Bytes(&table, places)) {
                prop_assert_eq!(&found, &expected, "{}", name);
            }
        }

        #[test]
        fn all_bodies_give_the_same_histograms(shape in any_shape(), segments in any_segments(0..40)) {
            let lines: Vec<Line> = segments.iter().map(|segment| Line::new(segment, 0, &shape)).collect();
            let expected = Rows(&shape, &lines).run(portable::Portable);
            for (name, found) in x86_64::run_all(|| Rows(&shape, &lines)) {
                prop_assert_eq!(&found, &expected, "{}", name);
            }
        }
    }
}

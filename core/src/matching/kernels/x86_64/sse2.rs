//! SSE2, which every x86-64 has: one multiply-and-add-pairs for four lines.

use super::prefetch;
use crate::matching::kernels::{Body, LANES, as_far_as_all_go, rows_at};
use crate::matching::{BinPair, PanelRow};
use core::arch::x86_64::{__m128i, _mm_add_epi32, _mm_madd_epi16, _mm_set1_epi32, _mm_setzero_si128};

/// The body that every x86-64 can run.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sse2;

impl Body for Sse2 {
    const NAME: &'static str = "SSE2";

    #[inline(always)]
    fn best_coefficient(self, row: &[BinPair], panel: &[PanelRow]) -> i32 {
        self.best_of_panels(row, [panel])
    }

    #[inline(always)]
    fn best_of_panels<const PANELS: usize>(self, row: &[BinPair], panels: [&[PanelRow]; PANELS]) -> i32 {
        // SAFETY: every x86-64 has SSE2.
        unsafe { best_of_panels(row, panels) }
    }

    #[inline(always)]
    fn will_read(self, row: &PanelRow) {
        prefetch(row);
    }
}

#[inline]
#[target_feature(enable = "sse2")]
fn best_of_panels<const PANELS: usize>(row: &[BinPair], panels: [&[PanelRow]; PANELS]) -> i32 {
    let mut sums = [[_mm_setzero_si128(); LANES / 4]; PANELS];
    let panels = as_far_as_all_go(panels);
    for pair in row {
        let Some(rows) = rows_at(panels, pair.index) else { continue };
        let both = _mm_set1_epi32(zerocopy::transmute!(pair.roots));
        for (sums, bins) in sums.iter_mut().zip(rows) {
            let lanes: [__m128i; LANES / 4] = zerocopy::transmute!(bins.roots);
            for (sum, lanes) in sums.iter_mut().zip(lanes) {
                *sum = _mm_add_epi32(*sum, _mm_madd_epi16(both, lanes));
            }
        }
    }
    let best_of_panel = |sums: [__m128i; LANES / 4]| {
        let sums: [i32; LANES] = zerocopy::transmute!(sums);
        sums.into_iter().fold(0, i32::max)
    };
    sums.into_iter().map(best_of_panel).fold(0, i32::max)
}

//! SSE2, which every x86-64 has: one multiply-and-add-pairs for four lines.

use crate::matching::kernels::{Body, LANES};
use crate::matching::{BinPair, PanelRow};
use core::arch::x86_64::{__m128i, _mm_add_epi32, _mm_madd_epi16, _mm_set1_epi32, _mm_setzero_si128};

/// The body that every x86-64 can run.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sse2;

impl Body for Sse2 {
    #[inline(always)]
    fn best_coefficient(self, row: &[BinPair], panel: &[PanelRow]) -> i32 {
        // SAFETY: every x86-64 has SSE2.
        unsafe { best_coefficient(row, panel) }
    }
}

#[inline]
#[target_feature(enable = "sse2")]
fn best_coefficient(row: &[BinPair], panel: &[PanelRow]) -> i32 {
    let mut sums = [_mm_setzero_si128(); LANES / 4];
    for pair in row {
        let Some(bins) = panel.get(usize::from(pair.index)) else { continue };
        let both = _mm_set1_epi32(zerocopy::transmute!(pair.roots));
        let lanes: [__m128i; LANES / 4] = zerocopy::transmute!(bins.roots);
        for (sum, lanes) in sums.iter_mut().zip(lanes) {
            *sum = _mm_add_epi32(*sum, _mm_madd_epi16(both, lanes));
        }
    }
    let sums: [i32; LANES] = zerocopy::transmute!(sums);
    sums.into_iter().fold(0, i32::max)
}

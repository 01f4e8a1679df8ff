//! The body for machines that always have SSE2, as x86-64 has: one multiply-and-add-pairs for four lines.

#![allow(unsafe_code, reason = "a vector kernel, one of the addresses where unsafe may live")]

use super::LANES;
use crate::matching::{BinPair, PanelRow};
use core::arch::x86_64::{__m128i, _mm_add_epi32, _mm_madd_epi16, _mm_set1_epi32, _mm_setzero_si128};

/// Coefficients in Q30 of one scene row with each of a panel's lines; the same bits as the reference body.
pub(in crate::matching) fn dot_row(row: &[BinPair], panel: &[PanelRow]) -> [i32; LANES] {
    // SAFETY: this file is only compiled for targets that have SSE2, the one feature the function needs.
    unsafe { dot_row_sse2(row, panel) }
}

#[target_feature(enable = "sse2")]
fn dot_row_sse2(row: &[BinPair], panel: &[PanelRow]) -> [i32; LANES] {
    let mut sums = [_mm_setzero_si128(); LANES / 4];
    for pair in row {
        let Some(bins) = panel.get(usize::from(pair.index)) else { continue };
        let both = _mm_set1_epi32(zerocopy::transmute!(pair.roots));
        let lanes: [__m128i; LANES / 4] = zerocopy::transmute!(bins.roots);
        for (sum, lanes) in sums.iter_mut().zip(lanes) {
            *sum = _mm_add_epi32(*sum, _mm_madd_epi16(both, lanes));
        }
    }
    zerocopy::transmute!(sums)
}

//! AVX-512 VNNI: one multiply-and-accumulate-pairs for a whole panel, four pairs of bins under way at a time.

use super::detection;
use crate::matching::kernels::{Body, LANES};
use crate::matching::{BinPair, PanelRow};
use core::arch::x86_64::{
    __m512i, _mm512_add_epi32, _mm512_dpwssd_epi32, _mm512_reduce_max_epi32, _mm512_set1_epi32, _mm512_setzero_si512,
};

/// Sums under way at a time: one multiply-and-accumulate takes as long as four begin.
const UNDER_WAY: usize = 4;

/// The body for machines with AVX-512 VNNI; one exists only where they have it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Avx512(());

impl Avx512 {
    /// The body, if the machine can run it.
    pub(super) fn detect() -> Option<Self> {
        detection::has_avx512_vnni().then_some(Self(()))
    }
}

impl Body for Avx512 {
    #[inline(always)]
    fn best_coefficient(self, row: &[BinPair], panel: &[PanelRow]) -> i32 {
        // SAFETY: `self` is only made where AVX-512 F and VNNI were found.
        unsafe { best_coefficient(row, panel) }
    }
}

#[inline]
#[target_feature(enable = "avx512f,avx512vnni")]
fn best_coefficient(row: &[BinPair], panel: &[PanelRow]) -> i32 {
    const { assert!(LANES == 16, "a panel's row is one vector") };
    let mut sums = [_mm512_setzero_si512(); UNDER_WAY];
    let (groups, rest) = row.as_chunks::<UNDER_WAY>();
    for group in groups {
        for (sum, pair) in sums.iter_mut().zip(group) {
            *sum = added(*sum, pair, panel);
        }
    }
    for (sum, pair) in sums.iter_mut().zip(rest) {
        *sum = added(*sum, pair, panel);
    }
    let [a, b, c, d] = sums;
    let sum = _mm512_add_epi32(_mm512_add_epi32(a, b), _mm512_add_epi32(c, d));
    _mm512_reduce_max_epi32(sum).max(0)
}

#[inline]
#[target_feature(enable = "avx512f,avx512vnni")]
fn added(sum: __m512i, pair: &BinPair, panel: &[PanelRow]) -> __m512i {
    let Some(bins) = panel.get(usize::from(pair.index)) else { return sum };
    let both = _mm512_set1_epi32(zerocopy::transmute!(pair.roots));
    _mm512_dpwssd_epi32(sum, both, zerocopy::transmute!(bins.roots))
}

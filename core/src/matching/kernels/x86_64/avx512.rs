//! AVX-512 VNNI: one multiply-and-accumulate-pairs for a whole panel, four pairs of bins under way at a time.

use super::{detection, prefetch};
use crate::matching::kernels::{Body, LANES, as_far_as_all_go, rows_at};
use crate::matching::{BinPair, PanelRow};
use core::arch::x86_64::{
    __m512i, _mm512_add_epi32, _mm512_dpwssd_epi32, _mm512_max_epi32, _mm512_reduce_max_epi32, _mm512_set1_epi32,
    _mm512_setzero_si512,
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
    const NAME: &'static str = "AVX-512 VNNI";

    #[inline(always)]
    fn best_coefficient(self, row: &[BinPair], panel: &[PanelRow]) -> i32 {
        self.best_of_panels(row, [panel])
    }

    #[inline(always)]
    fn best_of_panels<const PANELS: usize>(self, row: &[BinPair], panels: [&[PanelRow]; PANELS]) -> i32 {
        // SAFETY: `self` is only made where AVX-512 F and VNNI were found.
        unsafe { best_of_panels(row, panels) }
    }

    #[inline(always)]
    fn will_read(self, row: &PanelRow) {
        prefetch(row);
    }
}

#[inline]
#[target_feature(enable = "avx512f,avx512vnni")]
fn best_of_panels<const PANELS: usize>(row: &[BinPair], panels: [&[PanelRow]; PANELS]) -> i32 {
    const { assert!(LANES == 16, "a panel's row is one vector") };
    let mut sums = [[_mm512_setzero_si512(); PANELS]; UNDER_WAY];
    let panels = as_far_as_all_go(panels);
    let (groups, rest) = row.as_chunks::<UNDER_WAY>();
    for group in groups {
        for (sums, pair) in sums.iter_mut().zip(group) {
            add(sums, pair, panels);
        }
    }
    for (sums, pair) in sums.iter_mut().zip(rest) {
        add(sums, pair, panels);
    }
    let [a, b, c, d] = sums;
    let mut best = _mm512_setzero_si512();
    for (((a, b), c), d) in a.into_iter().zip(b).zip(c).zip(d) {
        best = _mm512_max_epi32(best, _mm512_add_epi32(_mm512_add_epi32(a, b), _mm512_add_epi32(c, d)));
    }
    _mm512_reduce_max_epi32(best)
}

#[inline]
#[target_feature(enable = "avx512f,avx512vnni")]
fn add<const PANELS: usize>(sums: &mut [__m512i; PANELS], pair: &BinPair, panels: [&[PanelRow]; PANELS]) {
    let Some(rows) = rows_at(panels, pair.index) else { return };
    let both = _mm512_set1_epi32(zerocopy::transmute!(pair.roots));
    for (sum, bins) in sums.iter_mut().zip(rows) {
        *sum = _mm512_dpwssd_epi32(*sum, both, zerocopy::transmute!(bins.roots));
    }
}

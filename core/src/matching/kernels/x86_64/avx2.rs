//! AVX2: one multiply-and-add-pairs for eight lines.

use super::{detection, prefetch};
use crate::matching::kernels::{Body, LANES, as_far_as_all_go, rows_at};
use crate::matching::{BinPair, PanelRow};
use core::arch::x86_64::{
    __m256i, _mm256_add_epi32, _mm256_madd_epi16, _mm256_max_epi32, _mm256_set1_epi32, _mm256_setzero_si256,
};

/// The body for machines with AVX2; one exists only where they have it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Avx2(());

impl Avx2 {
    /// The body, if the machine can run it.
    pub(super) fn detect() -> Option<Self> {
        detection::has_avx2().then_some(Self(()))
    }
}

impl Body for Avx2 {
    const NAME: &'static str = "AVX2";

    #[inline(always)]
    fn best_coefficient(self, row: &[BinPair], panel: &[PanelRow]) -> i32 {
        self.best_of_panels(row, [panel])
    }

    #[inline(always)]
    fn best_of_panels<const PANELS: usize>(self, row: &[BinPair], panels: [&[PanelRow]; PANELS]) -> i32 {
        // SAFETY: `self` is only made where AVX2 was found.
        unsafe { best_of_panels(row, panels) }
    }

    #[inline(always)]
    fn will_read(self, row: &PanelRow) {
        prefetch(row);
    }
}

#[inline]
#[target_feature(enable = "avx2")]
fn best_of_panels<const PANELS: usize>(row: &[BinPair], panels: [&[PanelRow]; PANELS]) -> i32 {
    let mut sums = [[_mm256_setzero_si256(); LANES / 8]; PANELS];
    let panels = as_far_as_all_go(panels);
    for pair in row {
        let Some(rows) = rows_at(panels, pair.index) else { continue };
        let both = _mm256_set1_epi32(zerocopy::transmute!(pair.roots));
        for (sums, bins) in sums.iter_mut().zip(rows) {
            let lanes: [__m256i; LANES / 8] = zerocopy::transmute!(bins.roots);
            for (sum, lanes) in sums.iter_mut().zip(lanes) {
                *sum = _mm256_add_epi32(*sum, _mm256_madd_epi16(both, lanes));
            }
        }
    }
    let mut best = _mm256_setzero_si256();
    for sum in sums.as_flattened() {
        best = _mm256_max_epi32(best, *sum);
    }
    let best: [i32; 8] = zerocopy::transmute!(best);
    best.into_iter().fold(0, i32::max)
}

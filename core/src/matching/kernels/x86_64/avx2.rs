//! AVX2: one multiply-and-add-pairs for eight lines, two pairs of bins under way at a time.

use super::detection;
use crate::matching::kernels::{Body, LANES};
use crate::matching::{BinPair, PanelRow};
use core::arch::x86_64::{__m256i, _mm256_add_epi32, _mm256_madd_epi16, _mm256_set1_epi32, _mm256_setzero_si256};

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
    #[inline(always)]
    fn best_coefficient(self, row: &[BinPair], panel: &[PanelRow]) -> i32 {
        // SAFETY: `self` is only made where AVX2 was found.
        unsafe { best_coefficient(row, panel) }
    }
}

#[inline]
#[target_feature(enable = "avx2")]
fn best_coefficient(row: &[BinPair], panel: &[PanelRow]) -> i32 {
    let mut sums = [[_mm256_setzero_si256(); LANES / 8]; 2];
    let (couples, single) = row.as_chunks::<2>();
    for couple in couples {
        for (sums, pair) in sums.iter_mut().zip(couple) {
            add(sums, pair, panel);
        }
    }
    for pair in single {
        add(&mut sums[0], pair, panel);
    }
    let [even, odd] = sums;
    let sums: [i32; LANES] =
        zerocopy::transmute!([_mm256_add_epi32(even[0], odd[0]), _mm256_add_epi32(even[1], odd[1])]);
    sums.into_iter().fold(0, i32::max)
}

#[inline]
#[target_feature(enable = "avx2")]
fn add(sums: &mut [__m256i; LANES / 8], pair: &BinPair, panel: &[PanelRow]) {
    let Some(bins) = panel.get(usize::from(pair.index)) else { return };
    let both = _mm256_set1_epi32(zerocopy::transmute!(pair.roots));
    let lanes: [__m256i; LANES / 8] = zerocopy::transmute!(bins.roots);
    for (sum, lanes) in sums.iter_mut().zip(lanes) {
        *sum = _mm256_add_epi32(*sum, _mm256_madd_epi16(both, lanes));
    }
}

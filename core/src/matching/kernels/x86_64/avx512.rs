//! AVX-512 VNNI: one multiply-and-accumulate-pairs for a whole panel, four pairs of bins under way at a time; bytes of tables
//! by gathers, or from registers.

use super::{detection, prefetch};
use crate::matching::kernels::{Body, LANES, as_far_as_all_go, rows_at};
use crate::matching::{BinPair, PanelRow};
use core::arch::x86_64::{
    __m512i, _mm512_add_epi32, _mm512_and_si512, _mm512_cmplt_epu32_mask, _mm512_dpwssd_epi32,
    _mm512_mask_i32gather_epi32, _mm512_max_epi32, _mm512_permutex2var_epi32, _mm512_reduce_max_epi32,
    _mm512_set1_epi32, _mm512_setzero_si512, _mm512_slli_epi32, _mm512_srli_epi32, _mm512_srlv_epi32,
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

    #[inline(always)]
    fn bytes_at<const N: usize>(self, table: &[[u8; 4]], places: &[u32; N]) -> [u32; N] {
        // SAFETY: `self` is only made where AVX-512 F was found.
        in_all_lanes(places, |places| unsafe { bytes_at(table, places) })
    }

    #[inline(always)]
    fn bytes_of_few<const N: usize>(self, table: &[[u8; 4]; 32], places: &[u32; N]) -> [u32; N] {
        // SAFETY: `self` is only made where AVX-512 F was found.
        in_all_lanes(places, |places| unsafe { bytes_of_few(table, places) })
    }
}

/// Does with a whole vector what is asked for `N` numbers.
#[inline(always)]
fn in_all_lanes<const N: usize>(numbers: &[u32; N], work: impl FnOnce(__m512i) -> __m512i) -> [u32; N] {
    const { assert!(N <= LANES, "a vector holds them") };
    let mut lanes = [0; LANES];
    lanes[..N].copy_from_slice(numbers);
    let lanes: [u32; LANES] = zerocopy::transmute!(work(zerocopy::transmute!(lanes)));
    core::array::from_fn(|lane| lanes[lane])
}

/// Four bytes are read for each place, and all but the one that was asked for are dropped.
#[inline]
#[target_feature(enable = "avx512f")]
fn bytes_at(table: &[[u8; 4]], places: __m512i) -> __m512i {
    let quads = _mm512_srli_epi32::<2>(places);
    let within = _mm512_cmplt_epu32_mask(quads, _mm512_set1_epi32(table.len().min(1 << 30) as i32));
    let (none, bytes) = (_mm512_setzero_si512(), table.as_ptr().cast());
    // SAFETY: the index of a quad is below 2^30, so not negative as a signed one, and only those below the table's length
    // are read; a gather needs no alignment, and of lanes that are masked out it reads nothing.
    let four = unsafe { _mm512_mask_i32gather_epi32::<4>(none, within, quads, bytes) };
    byte_of(four, places)
}

/// The table lies in two vectors.
#[inline]
#[target_feature(enable = "avx512f")]
fn bytes_of_few(table: &[[u8; 4]; 32], places: __m512i) -> __m512i {
    let [low, high]: [__m512i; 2] = zerocopy::transmute!(*table);
    byte_of(_mm512_permutex2var_epi32(low, _mm512_srli_epi32::<2>(places), high), places)
}

/// Of the four bytes from which each place was read, the one at it.
#[inline]
#[target_feature(enable = "avx512f")]
fn byte_of(four: __m512i, places: __m512i) -> __m512i {
    let bits = _mm512_slli_epi32::<3>(_mm512_and_si512(places, _mm512_set1_epi32(3)));
    _mm512_and_si512(_mm512_srlv_epi32(four, bits), _mm512_set1_epi32(0xff))
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

//! WebAssembly's 128-bit vectors: one multiply-and-add-pairs for four lines.

use super::{Body, LANES};
use crate::matching::{BinPair, PanelRow};
use core::arch::wasm32::{i32x4_add, i32x4_dot_i16x8, i32x4_splat, v128};

/// The body for WebAssembly; one exists only in code that may use vectors.
#[derive(Debug, Clone, Copy)]
pub(super) struct Simd128;

impl Body for Simd128 {
    const NAME: &'static str = "WebAssembly SIMD";

    #[inline(always)]
    fn best_coefficient(self, row: &[BinPair], panel: &[PanelRow]) -> i32 {
        let mut sums = [i32x4_splat(0); LANES / 4];
        for pair in row {
            let Some(bins) = panel.get(usize::from(pair.index)) else { continue };
            let both = i32x4_splat(zerocopy::transmute!(pair.roots));
            let lanes: [v128; LANES / 4] = zerocopy::transmute!(bins.roots);
            for (sum, lanes) in sums.iter_mut().zip(lanes) {
                *sum = i32x4_add(*sum, i32x4_dot_i16x8(both, lanes));
            }
        }
        let sums: [i32; LANES] = zerocopy::transmute!(sums);
        sums.into_iter().fold(0, i32::max)
    }
}

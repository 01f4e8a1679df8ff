//! NEON, which every 64-bit Arm has: one multiply-and-accumulate for the first bins of four lines, one for the second.

#![allow(unsafe_code, reason = "vector kernels, one of the addresses where unsafe may live")]

use super::{Body, LANES};
use crate::matching::{BinPair, PanelRow};
use core::arch::aarch64::{
    int16x4_t, int16x8x2_t, int32x4_t, vdup_n_s16, vdupq_n_s32, vget_high_s16, vget_low_s16, vld2q_s16, vmaxq_s32,
    vmaxvq_s32, vmlal_s16,
};

/// The body for 64-bit Arm; one exists only in code for machines with NEON.
#[derive(Debug, Clone, Copy)]
pub(super) struct Neon;

impl Body for Neon {
    const NAME: &'static str = "NEON";

    #[inline(always)]
    fn best_coefficient(self, row: &[BinPair], panel: &[PanelRow]) -> i32 {
        // SAFETY: this is compiled only where all code may use NEON.
        unsafe { best_coefficient(row, panel) }
    }
}

#[inline]
#[target_feature(enable = "neon")]
fn best_coefficient(row: &[BinPair], panel: &[PanelRow]) -> i32 {
    let mut sums = [vdupq_n_s32(0); LANES / 4];
    for pair in row {
        let Some(bins) = panel.get(usize::from(pair.index)) else { continue };
        let [even, odd] = pair.roots.map(|root| vdup_n_s16(root));
        let (eights, _) = bins.roots.as_chunks::<8>();
        for (sums, eight) in sums.as_chunks_mut::<2>().0.iter_mut().zip(eights) {
            let int16x8x2_t(evens, odds) = parted(eight);
            sums[0] = added(sums[0], [even, odd], [vget_low_s16(evens), vget_low_s16(odds)]);
            sums[1] = added(sums[1], [even, odd], [vget_high_s16(evens), vget_high_s16(odds)]);
        }
    }
    let [a, b, c, d] = sums;
    vmaxvq_s32(vmaxq_s32(vmaxq_s32(a, b), vmaxq_s32(c, d))).max(0)
}

/// The first bins of eight lines, and the second ones.
#[inline]
#[target_feature(enable = "neon")]
fn parted(lanes: &[[i16; 2]; 8]) -> int16x8x2_t {
    // SAFETY: sixteen halfwords are there to be read, at any alignment.
    unsafe { vld2q_s16(lanes.as_ptr().cast()) }
}

/// `sum` and the products of both bins, wrapping.
#[inline]
#[target_feature(enable = "neon")]
fn added(sum: int32x4_t, roots: [int16x4_t; 2], lanes: [int16x4_t; 2]) -> int32x4_t {
    vmlal_s16(vmlal_s16(sum, roots[0], lanes[0]), roots[1], lanes[1])
}

//! The reference body: plain Rust, for any machine.

use super::LANES;
use crate::matching::{BinPair, PanelRow};

/// Coefficients in Q30 of one scene row with each of a panel's lines.
#[cfg_attr(
    all(target_arch = "x86_64", target_feature = "sse2", not(test)),
    expect(dead_code, reason = "the other body runs there")
)]
pub(in crate::matching) fn dot_row(row: &[BinPair], panel: &[PanelRow]) -> [i32; LANES] {
    let mut sums = [0_i32; LANES];
    for pair in row {
        let Some(bins) = panel.get(usize::from(pair.index)) else { continue };
        let [even, odd] = pair.roots.map(i32::from);
        // By Cauchy and Schwarz no partial sum of unit rows passes 2^30 by more than rounding.
        for (sum, lane) in sums.iter_mut().zip(&bins.roots) {
            *sum = sum.wrapping_add(even * i32::from(lane[0]) + odd * i32::from(lane[1]));
        }
    }
    sums
}

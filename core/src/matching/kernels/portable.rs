//! The reference body: plain Rust that the compiler vectorises.

use super::LANES;
use crate::matching::{BinPair, PanelRow};

/// Coefficients in Q30 of one scene row with each of a panel's lines.
pub(in crate::matching) fn dot_row(row: &[BinPair], panel: &[PanelRow]) -> [i32; LANES] {
    let mut sums = [0_i32; LANES];
    for pair in row {
        let Some(bins) = panel.get(usize::from(pair.index)) else { continue };
        let [even, odd] = pair.roots.map(i32::from);
        for (sum, lane) in sums.iter_mut().zip(&bins.roots) {
            // By Cauchy and Schwarz no partial sum of unit rows passes 2^30 by more than rounding.
            *sum = sum.wrapping_add(even * i32::from(lane[0]) + odd * i32::from(lane[1]));
        }
    }
    sums
}

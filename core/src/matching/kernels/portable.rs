//! The reference body: plain Rust, for any machine.

use super::{Body, LANES};
use crate::matching::{BinPair, PanelRow};

/// The body that needs nothing.
#[derive(Debug, Clone, Copy)]
pub(super) struct Portable;

impl Body for Portable {
    const NAME: &'static str = "portable";

    #[inline(always)]
    fn best_coefficient(self, row: &[BinPair], panel: &[PanelRow]) -> i32 {
        let mut sums = [0_i32; LANES];
        for pair in row {
            let Some(bins) = panel.get(usize::from(pair.index)) else { continue };
            let [even, odd] = pair.roots.map(i32::from);
            // By Cauchy and Schwarz no partial sum of unit rows passes 2^30 by more than rounding; others wrap.
            for (sum, lane) in sums.iter_mut().zip(&bins.roots) {
                let both = (even * i32::from(lane[0])).wrapping_add(odd * i32::from(lane[1]));
                *sum = sum.wrapping_add(both);
            }
        }
        sums.into_iter().fold(0, i32::max)
    }
}

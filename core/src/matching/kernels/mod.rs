//! The inner loop of matching: one sparse row against one panel.
//!
//! Several bodies, the same bits: integer sums do not depend on their order.

mod portable;
#[cfg(all(target_arch = "x86_64", target_feature = "sse2"))]
mod sse2;

#[cfg(not(all(target_arch = "x86_64", target_feature = "sse2")))]
pub(super) use portable::dot_row;
#[cfg(all(target_arch = "x86_64", target_feature = "sse2"))]
pub(super) use sse2::dot_row;

/// View lines in a panel: one vector of coefficients.
pub const LANES: usize = 16;

#[cfg(all(test, target_arch = "x86_64", target_feature = "sse2"))]
mod tests {
    use super::*;
    use crate::matching::{BinPair, PanelRow};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn all_bodies_give_the_same_bits(
            row in prop::collection::vec((0_u16..40, any::<[u16; 2]>()), 0..60),
            panel in prop::collection::vec(prop::array::uniform16(any::<[u16; 2]>()), 32),
        ) {
            // Roots are Q15 magnitudes; full ones everywhere also make the sums pass the border of i32.
            let root = |bits: [u16; 2]| bits.map(|bits| (bits >> 1) as i16);
            let row: std::vec::Vec<BinPair> =
                row.into_iter().map(|(index, roots)| BinPair { index, roots: root(roots) }).collect();
            let panel: std::vec::Vec<PanelRow> =
                panel.into_iter().map(|roots| PanelRow { roots: roots.map(root) }).collect();
            prop_assert_eq!(portable::dot_row(&row, &panel), sse2::dot_row(&row, &panel));
        }
    }
}

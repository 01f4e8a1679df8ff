//! The inner loop of matching: one sparse row against one panel.
//!
//! One body today, [`portable`]; a faster one must give the same bits.

mod portable;

pub(super) use portable::dot_row;

/// View lines in a panel: one vector of coefficients.
pub const LANES: usize = 16;

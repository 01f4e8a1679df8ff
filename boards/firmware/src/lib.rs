//! What every edgeloc board runs, whatever its pins and memory: kernels on drawn inputs and golden attempts replayed
//! through the localizer, held against what the host got, bit for bit.
//!
//! The host runs the very same [`replay`] and [`run_kernels`]: it wrote the expected lines with them, and its own tests
//! compare with them.
#![no_std]

mod acceptance;
pub mod budgets;
mod comparison;
mod draw;
pub mod golden;
mod kernels;
pub mod looks;
mod replay;

pub use acceptance::{Verdict, accept};
pub use comparison::{Comparison, Mismatch};
pub use kernels::run_kernels;
pub use replay::{Counts, MEMORY_WORDS, ReplayError, SCENE_CAPACITY, compare, replay};

//! What every edgeloc board runs, whatever its pins and memory: golden attempts replayed through the localizer and
//! held against what the host got, bit for bit.
//!
//! The host runs the very same [`replay`]: it wrote the expected lines with it, and its own tests compare with it.
#![no_std]

pub mod looks;
mod replay;

pub use replay::{Counts, MEMORY_WORDS, Mismatch, ReplayError, SCENE_CAPACITY, compare, replay};

//! Worlds: straight edges to be seen and surfaces that hide them.
//!
//! World frame: metres, z up, the floor a robot drives on at z = 0.

mod wireframe;

pub use wireframe::{Surfaces, WireframeWorld};

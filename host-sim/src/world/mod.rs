//! Worlds: straight edges to be seen and surfaces that hide them.
//!
//! World frame: metres, z up, the floor a robot drives on at z = 0.

mod crease;
mod crop;
pub mod file;
mod free_space;
pub mod import;
mod mesh;
mod occlusion;
pub mod office;
mod outlines;
mod range_sensor;
mod template;
pub mod viewpoints;
mod visibility;
mod wireframe;

pub use crop::{Rectangle, crop};
pub use free_space::{FreeSpace, FreeSpaceError, FreeSpaceOptions};
pub use occlusion::Occluders;
pub use outlines::Outlines;
pub use range_sensor::{RangeSensor, RangeSensorOptions};
pub use viewpoints::{ReferenceViewpoint, ReferenceViewpoints};
pub use visibility::ViewpointVisibility;
pub use wireframe::{Surfaces, WireframeWorld};

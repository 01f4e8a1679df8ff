//! The workstation side of edgeloc: wire-frame worlds, a stereo rig with its uncertainty sources, world learning,
//! Monte-Carlo trials of the very localiser that ships to the robot, and their reports.
//!
//! ```text
//! world (generated | imported | file) -> visibility -> camera: stereo observation
//!      -> uncertainty (the sources, in pipeline order) -> perturbed observation
//!           |-> learning: triangulate -> stereo edge model per view -> database bytes
//!           |-> monte_carlo: left-image segments -> Scene -> edgeloc::localize::Localizer -> outcome
//! outcomes -> statistics -> sweep -> report
//! ```
//!
//! Arrows between modules point one way: `random, whole_file, map_file < world < camera < uncertainty < learning < scenario < monte_carlo <
//! sweep < report < cli`.

pub mod camera;
pub mod learning;
pub mod map_file;
pub mod monte_carlo;
pub mod random;
pub mod report;
pub mod scenario;
pub mod sweep;
pub mod uncertainty;
pub mod whole_file;
pub mod world;

//! The naive twins: every fast kernel of the localiser once more, in plain `f64`, from the formulae alone.
//!
//! Nothing here is fast, fixed-point or shared with the library's kernels beyond its plain value types, so an error
//! has to be made twice to go unnoticed. Sections are those of Tian, Thacker and Stancu, "A Monte-Carlo Simulation for
//! Optimising a Stereo Vision Based Robotic System"; where the paper is silent the file says which reading it takes.

mod attempt;
mod candidates;
mod character_map;
pub mod gist;
mod histogram;
mod matching;
mod prediction;
mod scene;
mod segment;
mod verification;

pub use attempt::{Attempt, NaiveDecision};
pub use candidates::NaiveCandidates;
pub use character_map::CharacterMap;
pub use histogram::{Histogram, histogram, scene_histograms};
pub use matching::{bhattacharyya_coefficient, view_score};
pub use prediction::predict;
pub use scene::prepare_scene;
pub use segment::NaiveSegment;
pub use verification::{NaiveCloseness, verification_evidence, verification_score};

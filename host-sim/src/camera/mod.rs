//! The stereo rig in a world: what its two images show, and the 3-D segments a stereo matcher gets back from them.

mod corners;
mod observation;
mod observe;
mod pose;
mod triangulation;

pub use corners::corner_pairs;
pub use observation::{StereoFeature, StereoObservation, move_pieces};
pub use observe::{left_segments, observe, observe_pieces};
pub use pose::CameraPose;
pub use triangulation::{MIN_OVERLAP_PX, MIN_SHARED_LENGTH_PX, triangulate_feature, triangulate_pieces};

//! The stereo rig in a world: what its two images show.

mod observation;

pub use observation::{StereoFeature, StereoObservation};

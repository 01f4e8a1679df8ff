//! The uncertainty of edge-based stereo data: what goes wrong between the world and the segments a robot works with.
//!
//! Every source is one file of one shape: its facts, its value (`source!` of `setting.rs`: switch, magnitude and what
//! is its own) and one verb that perturbs an observation (paper, section 4.2). They act in the order of the pipeline,
//! that of the fields of [`Sources`]. A new source is one new file and one line in the list of `sources.rs`.
//!
//! | source | symbol | default | acts in | what it does |
//! |---|---|---|---|---|
//! | [`LateralEdgeShift`] | psi_l | 3 px | both | moves each feature along its image normal |
//! | [`EdgeDetectionLoss`] | psi_e | 11.25 % | both | takes that share of each feature's length away, as gaps |
//! | [`GeometricApproximation`] | psi_g | 0.15 px | both | moves each end point |
//! | [`EpipolarRemoval`] | | 5 degrees | learning | leaves near-horizontal features unmatched |
//! | [`StereoMatch`] | psi_s | 1 % | learning | matches that share of the features wrongly |

mod edge_detection_loss;
mod epipolar_removal;
mod geometric_approximation;
mod lateral_edge_shift;
mod setting;
mod sources;
mod stereo_match;
#[cfg(test)]
mod test_observation;

pub use edge_detection_loss::EdgeDetectionLoss;
pub use epipolar_removal::EpipolarRemoval;
pub use geometric_approximation::GeometricApproximation;
pub use lateral_edge_shift::LateralEdgeShift;
pub use setting::{ActsIn, SourceFacts, SourceSetting};
pub use sources::{NoiseKey, SourceError, Sources};
pub use stereo_match::StereoMatch;

use crate::camera::StereoObservation;
use crate::random::Stream;

/// One cause of error in edge-based stereo data.
pub trait UncertaintySource: SourceSetting {
    /// Perturbs an observation, whether enabled or not. A source that acts on something else than the segments of
    /// images leaves this alone and has a verb of its own.
    fn apply(&self, _observation: &mut StereoObservation, _stream: &mut Stream) {}
}

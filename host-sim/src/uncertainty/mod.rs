//! The uncertainty of edge-based stereo data: what goes wrong between the world and the segments a robot works with.
//!
//! Every source is one file of one shape: a value with its switch, its magnitude and its facts, and one verb that
//! perturbs an observation (paper, section 4.2). They act in the order of the pipeline, that of the fields of
//! [`Sources`]. A new source is one new file and one line in the list of `sources.rs`.
//!
//! | source | symbol | default | what it does |
//! |---|---|---|---|
//! | [`LateralEdgeShift`] | psi_l | 3 px | moves each feature along its image normal |
//! | [`EdgeDetectionLoss`] | psi_e | 11.25 % | takes that share of each feature's length away, as gaps |
//! | [`GeometricApproximation`] | psi_g | 0.15 px | moves each end point |
//! | [`EpipolarRemoval`] | | 5 degrees | leaves near-horizontal features unmatched |
//! | [`StereoMatch`] | psi_s | 1 % | matches that share of the features wrongly |

mod edge_detection_loss;
mod epipolar_removal;
mod geometric_approximation;
mod lateral_edge_shift;
mod sources;
mod stereo_match;
#[cfg(test)]
mod test_observation;

pub use edge_detection_loss::EdgeDetectionLoss;
pub use epipolar_removal::EpipolarRemoval;
pub use geometric_approximation::GeometricApproximation;
pub use lateral_edge_shift::LateralEdgeShift;
pub use sources::{NoiseKey, SourceError, Sources};
pub use stereo_match::StereoMatch;

use crate::camera::StereoObservation;
use crate::random::Stream;

/// One cause of error in edge-based stereo data.
pub trait UncertaintySource {
    /// What is known of the source however it is configured.
    fn facts(&self) -> &'static SourceFacts;

    /// Whether the source acts.
    fn is_enabled(&self) -> bool;

    /// How strongly it acts, in the unit of its facts; 0 changes nothing.
    fn magnitude(&self) -> f64;

    /// Perturbs an observation, whether enabled or not.
    fn apply(&self, observation: &mut StereoObservation, stream: &mut Stream);
}

/// The unchanging part of a source: its row in tables and its place among the random streams.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SourceFacts {
    /// Name of its table in a scenario file.
    pub key: &'static str,
    /// Name for people.
    pub name: &'static str,
    /// Symbol of its magnitude in the paper; empty where the paper has none.
    pub symbol: &'static str,
    /// Unit of its magnitude.
    pub unit: &'static str,
    /// Number of its random stream, never reused: it keeps draws apart and old runs replayable.
    pub stream_id: u16,
    /// Magnitude unless configured.
    pub default_magnitude: f64,
    /// Least and greatest magnitude allowed.
    pub legal_range: (f64, f64),
    /// What causes the error and how it is simulated.
    pub cause: &'static str,
    /// Where cause and magnitude come from.
    pub citation: &'static str,
}

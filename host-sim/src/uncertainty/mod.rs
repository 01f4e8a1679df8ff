//! The uncertainty of edge-based stereo data: what goes wrong between the world and the segments a robot works with.
//!
//! Every source is one file of one shape: its facts, its value (`source!` of `setting.rs`: switch, magnitude and what
//! is its own) and one verb that perturbs an observation (paper, section 4.2). They act in the order of the pipeline,
//! that of the fields of [`Sources`]. A new source is one new file and one line in the list of `sources.rs`.
//!
//! Those with a symbol are the paper's, on by default; the others are ours, off by default. `edgeloc sources` prints
//! each with its legal range, cause and citation.
//!
//! | source | symbol | default | acts in | what it does |
//! |---|---|---|---|---|
//! | [`Clutter`] | | off; 20 % | looks | puts random segments in place of that share of the features |
//! | [`Occlusion`] | | off; 25 % | looks | hides that share of the bearings, in one span |
//! | [`CameraTilt`] | | off; 1 degree | looks | rolls and pitches the camera |
//! | [`PolarityFlips`] | | off; 5 % | looks | swaps the bright and the dark side of that share of the features |
//! | [`LateralEdgeShift`] | psi_l | 3 px | both | moves each feature along its image normal |
//! | [`EdgeDetectionLoss`] | psi_e | 11.25 % | both | takes that share of the length away: gaps and whole features |
//! | [`GeometricApproximation`] | psi_g | 0.15 px | both | moves each end point, in some images farther than in others |
//! | [`ImageNoise`] | (psi_l, psi_g) | 0 grey levels | both | moves pieces and end points as noisy pixels do |
//! | [`EpipolarRemoval`] | | 5 degrees | learning | leaves near-horizontal features unmatched |
//! | [`StereoMatch`] | psi_s | 1 % | learning | matches that share of the features wrongly |
//! | [`CornerDetectionLoss`] | psi_cd | 15 % | calibration | drops that share of the corners of each image |
//! | [`CornerMatch`] | psi_cm | 1 % | calibration | matches that share of the corners wrongly |
//! | [`CameraCalibration`] | psi_c | 1 | both | gives each map's robot wrong parameters of its cameras |
//! | [`Compass`] | | off; 2 degrees | looks | tells the localiser a wrong heading |
//! | [`Odometry`] | | off; 1 % | looks | tells the localiser wrong turns and steps |

mod camera_calibration;
mod camera_tilt;
mod clutter;
mod compass;
mod corner_detection_loss;
mod corner_match;
mod corners;
mod edge_detection_loss;
mod epipolar_removal;
mod geometric_approximation;
mod image_noise;
mod lateral_edge_shift;
mod occlusion;
mod odometry;
mod polarity_flips;
mod setting;
mod sources;
mod stereo_match;
#[cfg(test)]
mod test_observation;

pub use camera_calibration::CameraCalibration;
pub use camera_tilt::CameraTilt;
pub use clutter::Clutter;
pub use compass::Compass;
pub use corner_detection_loss::CornerDetectionLoss;
pub use corner_match::CornerMatch;
pub use edge_detection_loss::EdgeDetectionLoss;
pub use epipolar_removal::EpipolarRemoval;
pub use geometric_approximation::GeometricApproximation;
pub use image_noise::ImageNoise;
pub use lateral_edge_shift::LateralEdgeShift;
pub use occlusion::Occlusion;
pub use odometry::Odometry;
pub use polarity_flips::PolarityFlips;
pub use setting::{ActsIn, SourceFacts, SourceNumber, SourceSetting};
pub use sources::{NoiseKey, SourceError, Sources};
pub use stereo_match::StereoMatch;

use crate::camera::{StereoFeature, StereoObservation};
use crate::random::Stream;

/// One cause of error in edge-based stereo data.
pub trait UncertaintySource: SourceSetting {
    /// Perturbs an observation, whether enabled or not. A source that acts on something else than the segments of
    /// images leaves this alone and has a verb of its own.
    fn apply(&self, _observation: &mut StereoObservation, _stream: &mut Stream) {}

    /// Whether a feature it changes is gone, and what stands in its place is another: the two are not compared.
    fn replaces_features(&self) -> bool {
        false
    }
}

/// Changes every feature by draws of its own, which neither the other features nor what other sources did to them can
/// move.
fn for_each_feature(
    observation: &mut StereoObservation,
    stream: &mut Stream,
    mut change: impl FnMut(&mut StereoFeature, &mut Stream),
) {
    for (index, feature) in observation.features.iter_mut().enumerate() {
        stream.seek(index);
        change(feature, stream);
    }
}

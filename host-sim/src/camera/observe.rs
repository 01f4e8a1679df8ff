//! The two images of the stereo rig at one pose: every visible edge piece projected into both.
//!
//! The left camera's optical centre is the eye: what it sees decides what is visible, and the node's frame starts there.
//! Two simplifications: the right camera is taken to see the same pieces as the left one (12 cm of baseline hide little
//! more), and what only the right camera sees is left out, because it reaches neither a scene nor a model.

use super::{CameraPose, StereoFeature, StereoObservation};
use edgeloc::geometry::{Point3, Segment2, Segment3, StereoRig};

/// The clean images of the rig at `pose` when `pieces` (world frame) are what its left eye can see in any direction.
///
/// One feature per piece that lies in the left image, in the order given; matchable when the right image shows it too.
#[must_use]
pub fn observe_pieces(
    rig: &StereoRig,
    pose: &CameraPose,
    pieces: impl IntoIterator<Item = Segment3>,
) -> StereoObservation {
    let features = pieces.into_iter().filter_map(|piece| observe_piece(rig, pose, &piece)).collect();
    StereoObservation { rig: *rig, features }
}

/// The segments of the left image, matchable or not: what the robot's one camera sees in a trial.
#[must_use]
pub fn left_segments(observation: &StereoObservation) -> Vec<Segment2> {
    observation.features.iter().flat_map(|feature| &feature.left).copied().collect()
}

fn observe_piece(rig: &StereoRig, pose: &CameraPose, piece: &Segment3) -> Option<StereoFeature> {
    let from_left = pose.segment_from_world(piece);
    let left = rig.camera.project_segment(&from_left, rig.near_limit_m)?;
    let beside = |point: Point3| Point3::new(point.x - rig.baseline_m, point.y, point.z);
    let from_right = Segment3 { start: beside(from_left.start), end: beside(from_left.end), ..from_left };
    let right = rig.camera.project_segment(&from_right, rig.near_limit_m);
    Some(StereoFeature { left: vec![left], right: right.into_iter().collect(), is_matchable: right.is_some() })
}

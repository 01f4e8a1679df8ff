//! The two images of the stereo rig at one pose: every visible edge piece projected into both.
//!
//! The left camera's optical centre is the eye: what it sees decides what is visible, and a node's frame starts there.
//! Two simplifications: the right camera is taken to see the same pieces as the left one (12 cm of baseline hide
//! little more), and what only the right camera sees is left out, because it reaches neither a scene nor a model.

use super::{CameraPose, StereoFeature, StereoObservation};
use crate::world::ViewpointVisibility;
use edgeloc::geometry::{Heading, Point3, Segment2, Segment3, StereoRig};

/// The clean images of the rig with its left eye where the visibility was taken, looking towards `heading`.
///
/// Only edges that may lie in the view are asked for their visible parts: turning on the spot shares that work.
#[must_use]
pub fn observe(rig: &StereoRig, visibility: &mut ViewpointVisibility<'_>, heading: Heading) -> StereoObservation {
    let pose = CameraPose::new(visibility.eye(), heading);
    let mut features = Vec::new();
    for (index, edge) in visibility.edges().iter().enumerate() {
        if may_be_in_view(rig, &pose.segment_from_world(edge)) {
            let pieces = visibility.visible_parts(index);
            features.extend(pieces.iter().filter_map(|piece| observe_piece(rig, &pose, piece)));
        }
    }
    StereoObservation { rig: *rig, features }
}

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

/// Whether a segment of the left camera's frame is not wholly beyond one side of the left camera's view.
pub(super) fn may_be_in_view(rig: &StereoRig, segment: &Segment3) -> bool {
    let camera = &rig.camera;
    let (focal, center) = (camera.focal_length_px(), camera.principal_point_px());
    let (right, bottom) = (f32::from(camera.width_px()) - center.x, f32::from(camera.height_px()) - center.y);
    // How far a point lies inside the near limit and each border plane, which pass through the optical centre.
    let insides = |point: Point3| {
        [
            point.z - rig.near_limit_m,
            center.x * point.z + focal * point.x,
            right * point.z - focal * point.x,
            center.y * point.z + focal * point.y,
            bottom * point.z - focal * point.y,
        ]
    };
    let (at_start, at_end) = (insides(segment.start), insides(segment.end));
    at_start.iter().zip(at_end).all(|(&at_start, at_end)| at_start >= 0.0 || at_end >= 0.0)
}

fn observe_piece(rig: &StereoRig, pose: &CameraPose, piece: &Segment3) -> Option<StereoFeature> {
    let from_left = pose.segment_from_world(piece);
    let left = rig.camera.project_segment(&from_left, rig.near_limit_m)?;
    let beside = |point: Point3| Point3::new(point.x - rig.baseline_m, point.y, point.z);
    let from_right = Segment3 { start: beside(from_left.start), end: beside(from_left.end), ..from_left };
    let right = rig.camera.project_segment(&from_right, rig.near_limit_m);
    Some(StereoFeature { left: vec![left], right: right.into_iter().collect(), is_matchable: right.is_some() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;
    use crate::world::{Occluders, WireframeWorld};
    use edgeloc::geometry::{Angle, Polarity};

    const RIG: StereoRig = StereoRig::reference();

    fn random_world(seed: u64) -> WireframeWorld {
        let mut stream = Stream::new(seed, "world", 0, 0);
        let mut edges = Vec::new();
        for _ in 0..400 {
            let mut draw = |low, high| stream.uniform(low, high) as f32;
            let start = Point3::new(draw(-5.0, 5.0), draw(-5.0, 5.0), draw(0.0, 2.5));
            let end = Point3::new(start.x + draw(-2.0, 2.0), start.y + draw(-2.0, 2.0), start.z + draw(-1.0, 1.0));
            edges.push(Segment3 { start, end, polarity: Polarity::LeftBrighter });
        }
        WireframeWorld { edges, ..WireframeWorld::default() }
    }

    #[test]
    fn asking_only_for_edges_that_may_be_in_view_misses_none() {
        for seed in 0..20 {
            let world = random_world(seed);
            let occluders = Occluders::new(&world.surfaces);
            let eye = Point3::new(0.2, -0.3, RIG.camera_height_m);
            let mut visibility = ViewpointVisibility::new(&world, &occluders, eye);
            let heading = Heading::new(Angle::from_degrees(18.0 * seed as f32)).expect("a finite heading");
            let all_pieces = observe_pieces(&RIG, &CameraPose::new(eye, heading), world.edges.iter().copied());
            assert_eq!(observe(&RIG, &mut visibility, heading), all_pieces);
            assert!(all_pieces.features.len() > 20);
        }
    }

    #[test]
    fn clean_pieces_lie_inside_both_images() {
        let world = random_world(99);
        let pose = CameraPose::new(Point3::new(0.0, 0.0, 1.0), Heading::default());
        for feature in observe_pieces(&RIG, &pose, world.edges).features {
            for piece in feature.left.iter().chain(&feature.right) {
                for end in [piece.start(), piece.end()] {
                    assert!((0.0..=640.0).contains(&end.x) && (0.0..=480.0).contains(&end.y), "{end:?}");
                }
            }
        }
    }

    #[test]
    fn the_scene_is_every_left_piece_matchable_or_not() {
        let pose = CameraPose::new(Point3::new(0.0, 0.0, 1.0), Heading::default());
        let mut observation = observe_pieces(&RIG, &pose, random_world(3).edges);
        let count = observation.features.len();
        let doubled = observation.features[0].left[0];
        observation.features[0].left.push(doubled);
        observation.features[1].is_matchable = false;
        assert_eq!(left_segments(&observation).len(), count + 1);
    }
}

//! Corners that both images show: the true ends of edges, where the paper defines its corners by hand (section 4.2).
//!
//! Where a detector finds a corner, edges end or meet; in a wire-frame both are ends of edges. An end counts when it is
//! seen itself: not where an edge disappears behind something or leaves the image, because that place belongs to the
//! view and not to the world. Ends within a centimetre are one corner.

use super::CameraPose;
use super::observe::may_be_in_view;
use crate::world::ViewpointVisibility;
use edgeloc::geometry::{Heading, PinholeCamera, Point2, Point3, StereoRig};
use edgeloc::stereo::CornerPair;
use std::collections::BTreeSet;

/// How far the end of a visible piece may lie from the edge's own end to be that end \[m\].
const SAME_POINT_M: f32 = 1e-4;

/// Ends as near as this are one corner \[1/m\]: the cells of a grid of a centimetre.
const CELLS_PER_M: f32 = 100.0;

/// The corners in both images of the rig, without error, with its left eye where the visibility was taken.
#[must_use]
pub fn corner_pairs(rig: &StereoRig, visibility: &mut ViewpointVisibility<'_>, heading: Heading) -> Vec<CornerPair> {
    let pose = CameraPose::new(visibility.eye(), heading);
    let mut taken = BTreeSet::new();
    let mut pairs = Vec::new();
    for (index, edge) in visibility.edges().iter().enumerate() {
        if !may_be_in_view(rig, &pose.segment_from_world(edge)) {
            continue;
        }
        for piece in visibility.visible_parts(index) {
            for (seen, end) in [(piece.start, edge.start), (piece.end, edge.end)] {
                let is_corner = seen.distance(end) < SAME_POINT_M && taken.insert(cell(end));
                let from_left = pose.camera_from_world(end);
                pairs.extend(is_corner.then(|| pair(rig, from_left)).flatten());
            }
        }
    }
    pairs
}

fn cell(point: Point3) -> [i32; 3] {
    [point.x, point.y, point.z].map(|coordinate| (coordinate * CELLS_PER_M).round() as i32)
}

fn pair(rig: &StereoRig, from_left: Point3) -> Option<CornerPair> {
    if from_left.z < rig.near_limit_m {
        return None;
    }
    let from_right = Point3::new(from_left.x - rig.baseline_m, from_left.y, from_left.z);
    let (left, right) = (rig.camera.project(from_left), rig.camera.project(from_right));
    (is_inside(&rig.camera, left) && is_inside(&rig.camera, right)).then_some(CornerPair { left, right })
}

fn is_inside(camera: &PinholeCamera, point: Point2) -> bool {
    let (width, height) = (f32::from(camera.width_px()), f32::from(camera.height_px()));
    (0.0..=width).contains(&point.x) && (0.0..=height).contains(&point.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{Occluders, Surfaces, WireframeWorld};
    use edgeloc::geometry::{Polarity, Segment3};

    const RIG: StereoRig = StereoRig::reference();

    fn pairs(edges: &[[[f32; 3]; 2]], surfaces: Surfaces) -> Vec<CornerPair> {
        let point = |[x, y, z]: [f32; 3]| Point3::new(x, y, z);
        let edge = |&[start, end]: &[[f32; 3]; 2]| Segment3 {
            start: point(start),
            end: point(end),
            polarity: Polarity::LeftBrighter,
        };
        let world = WireframeWorld { edges: edges.iter().map(edge).collect(), surfaces, ..WireframeWorld::default() };
        let occluders = Occluders::new(&world.surfaces);
        let mut visibility = ViewpointVisibility::new(&world, &occluders, Point3::new(0.0, 0.0, 1.0));
        corner_pairs(&RIG, &mut visibility, Heading::default())
    }

    #[test]
    fn edges_that_meet_make_one_corner_in_one_row_with_the_disparity_of_its_depth() {
        let found =
            pairs(&[[[2.0, 0.5, 0.5], [2.0, 0.5, 1.5]], [[2.0, 0.5, 1.5], [2.0, -0.5, 1.5]]], Surfaces::default());
        assert_eq!(found.len(), 3);
        for pair in found {
            assert!((pair.left.y - pair.right.y).abs() < 1e-4);
            assert!((pair.left.x - pair.right.x - 502.3 * 0.12 / 2.0).abs() < 1e-3);
        }
    }

    #[test]
    fn where_an_edge_is_hidden_or_leaves_the_image_is_no_corner() {
        // A long edge that leaves the image at both sides.
        assert!(pairs(&[[[2.0, 5.0, 1.0], [2.0, -5.0, 1.0]]], Surfaces::default()).is_empty());
        // A wall in front of the right half of an edge: its left end alone is seen.
        let surfaces = Surfaces {
            vertices: vec![
                Point3::new(1.0, 0.0, -9.0),
                Point3::new(1.0, 0.0, 9.0),
                Point3::new(1.0, -9.0, 9.0),
                Point3::new(1.0, -9.0, -9.0),
            ],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        };
        assert_eq!(pairs(&[[[2.0, 0.6, 1.0], [2.0, -0.6, 1.0]]], surfaces).len(), 1);
    }
}

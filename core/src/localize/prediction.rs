//! What the robot would see from a node, looking along a heading: the node's model re-projected.

use crate::database::Node;
use crate::geometry::{Heading, Point3, Segment2, Segment3, StereoRig};
use crate::math;

/// The node's 3-D segments as the left camera of `rig` would see them from the node at `heading`, clipped to the image.
///
/// Departure from the paper, which matches the stored models of adjacent view angles: all views of a node are merged and
/// projected at the measured heading, so nothing is lost between two view angles.
pub fn predict_view<'a>(
    node: &Node<'a>,
    rig: &StereoRig,
    heading: Heading,
) -> impl Iterator<Item = Segment2> + use<'a> {
    let (sin, cos) = math::sin_cos(heading.angle().radians());
    let (camera, near_limit_m) = (rig.camera, rig.near_limit_m);
    let camera_from_node =
        move |point: Point3| Point3::new(point.x * sin - point.y * cos, -point.z, point.x * cos + point.y * sin);
    node.segments().filter_map(move |segment| {
        if camera.is_surely_beside(camera_from_node(segment.start), camera_from_node(segment.end), near_limit_m) {
            return None;
        }
        let in_camera = Segment3 {
            start: camera_from_node(segment.start),
            end: camera_from_node(segment.end),
            polarity: segment.polarity,
        };
        camera.project_segment(&in_camera, near_limit_m)
    })
}

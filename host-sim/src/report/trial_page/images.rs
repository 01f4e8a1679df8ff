//! The images of a look, and the models of nodes laid over them.

use super::super::drawing::line;
use super::super::explanation::scene_drawing;
use crate::monte_carlo::LookImages;
use crate::report::LookExplanation;
use edgeloc::database::Node as MapNode;
use edgeloc::geometry::{Heading, PinholeCamera, Point2, Point3, Segment2, Segment3, StereoRig};
use edgeloc::localize::predict_view;
use svg::Node;
use svg::node::element::{Group, SVG};

/// The left and the right image: what is visible below what the robot works with.
pub(super) fn both_images(images: &LookImages, camera: &PinholeCamera) -> [(&'static str, SVG); 2] {
    let (clean, seen) = (&images.clean.features, &images.perturbed.features);
    let left: Vec<Segment2> = seen.iter().flat_map(|feature| feature.left.iter().copied()).collect();
    let right: Vec<Segment2> = seen.iter().flat_map(|feature| feature.right.iter().copied()).collect();
    let clean_left = clean.iter().flat_map(|feature| feature.left.iter().copied());
    let clean_right = clean.iter().flat_map(|feature| feature.right.iter().copied());
    [
        ("left", scene_drawing(&left, camera).add(underlay("clean", clean_left))),
        ("right", scene_drawing(&right, camera).add(underlay("clean", clean_right))),
    ]
}

/// What the robot saw and what it would see from `node`.
pub(super) fn model_over_scene(node: &MapNode<'_>, rig: &StereoRig, look: &LookExplanation) -> SVG {
    scene_drawing(&look.scene, &rig.camera).add(underlay("predicted", predict_view(node, rig, look.compass)))
}

/// What the robot saw and what it would see of `node`'s model from a place beside it, looking along a heading.
pub(super) fn scene_with_view(
    look: &LookExplanation,
    rig: &StereoRig,
    node: &MapNode<'_>,
    (place, heading): (Point2, Heading),
) -> SVG {
    let (from, angle) = (node.position(), f64::from(heading.angle().radians()));
    let (sin, cos) = (libm::sin(angle) as f32, libm::cos(angle) as f32);
    let in_camera = |point: Point3| {
        let (x, y) = (point.x - (place.x - from.x), point.y - (place.y - from.y));
        Point3::new(x * sin - y * cos, -point.z, x * cos + y * sin)
    };
    let view = node.segments().filter_map(|segment| {
        let (start, end) = (in_camera(segment.start), in_camera(segment.end));
        rig.camera.project_segment(&Segment3 { start, end, ..segment }, rig.near_limit_m)
    });
    scene_drawing(&look.scene, &rig.camera).add(underlay("predicted", view))
}

/// Segments of one class, thin enough not to hide what they are compared with.
fn underlay(class: &str, segments: impl Iterator<Item = Segment2>) -> Group {
    let mut group = Group::new();
    for segment in segments {
        let (start, end) = (segment.start(), segment.end());
        group.append(line(class, (f64::from(start.x), f64::from(start.y)), (f64::from(end.x), f64::from(end.y))));
    }
    group
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;
    use edgeloc::database::{NodeId, TopologicalDatabase};

    #[test]
    fn from_the_node_itself_the_view_is_what_the_library_predicts() {
        let bytes = sample::map_of_posts();
        let map = TopologicalDatabase::open(&bytes).expect("a map");
        let node = map.node(NodeId(1)).expect("a node");
        let look = sample::look_at_posts();
        let svg = scene_with_view(&look, map.rig(), &node, (node.position(), look.compass)).to_string();
        assert_eq!(svg, model_over_scene(&node, map.rig(), &look).to_string());
        let beside = Point2::new(node.position().x + 0.5, node.position().y);
        assert_ne!(svg, scene_with_view(&look, map.rig(), &node, (beside, look.compass)).to_string());
    }
}

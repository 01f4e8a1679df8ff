//! The images of a look, and the models of nodes laid over them.

use super::super::drawing::line;
use super::super::explanation::scene_drawing;
use crate::monte_carlo::LookImages;
use crate::report::LookExplanation;
use edgeloc::database::Node as MapNode;
use edgeloc::geometry::{PinholeCamera, Segment2, StereoRig};
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

/// Segments of one class, thin enough not to hide what they are compared with.
fn underlay(class: &str, segments: impl Iterator<Item = Segment2>) -> Group {
    let mut group = Group::new();
    for segment in segments {
        let (start, end) = (segment.start(), segment.end());
        group.append(line(class, (f64::from(start.x), f64::from(start.y)), (f64::from(end.x), f64::from(end.y))));
    }
    group
}

//! Learning a map: each view of each node perturbed, triangulated and merged into the node's one model.
//!
//! Paper, section 3.1: a node holds the 3-D stereo edge models of its views. Neighbouring views overlap, so from each
//! view only those segments are kept whose midpoint bearing lies within half the view spacing of its axis; together the
//! views then cover the whole turn once, and a node has one merged model in its own frame: origin at the node's
//! position at camera height, axes parallel to the world's.

use super::node_views::{half_spacing_rad, view_heading};
use super::{CalibratedRig, NodeViews};
use crate::camera::{CameraPose, StereoObservation, triangulate_feature};
use crate::uncertainty::{NoiseKey, Sources};
use edgeloc::database::{self, NodeModel, WriteError};
use edgeloc::geometry::{Point2, Point3, Segment3};
use edgeloc::math;
use rayon::prelude::*;

/// What was learned at one node.
#[derive(Debug, Clone, PartialEq)]
pub struct LearnedNode {
    /// Where the left camera stood, in metres in the world frame.
    pub position: Point2,
    /// The merged 3-D segments of all views, node frame.
    pub segments: Vec<Segment3>,
}

/// Learns one map and writes it as a database; `map_index` selects the draw of the noise.
///
/// `robot` is the rig as the robot knows it; the views were seen by the true one.
///
/// # Errors
/// When the map doesn't fit the format, for instance without nodes or views.
pub fn learn(
    robot: &CalibratedRig,
    nodes: &[NodeViews],
    sources: &Sources,
    seed: u64,
    map_index: u64,
) -> Result<Vec<u8>, WriteError> {
    let views_per_node = nodes.first().map_or(0, |node| node.views.len() as u16);
    write_map(robot, views_per_node, &learn_nodes(robot, nodes, sources, seed, map_index))
}

/// Writes what was learned as a database.
///
/// # Errors
/// When it doesn't fit the format, for instance without nodes or views.
pub fn write_map(robot: &CalibratedRig, views_per_node: u16, learned: &[LearnedNode]) -> Result<Vec<u8>, WriteError> {
    let models: Vec<_> =
        learned.iter().map(|node| NodeModel { position: node.position, segments: &node.segments }).collect();
    let mut bytes = vec![0; database::encoded_len(&models).ok_or(WriteError::TooLarge)?];
    database::write(robot.rig(), views_per_node, &models, &mut bytes)?;
    Ok(bytes)
}

/// Learns the model of every node, in order and in parallel; the same whatever the number of threads.
#[must_use]
pub fn learn_nodes(
    robot: &CalibratedRig,
    nodes: &[NodeViews],
    sources: &Sources,
    seed: u64,
    map_index: u64,
) -> Vec<LearnedNode> {
    let learn_one = |(node_index, node): (usize, &NodeViews)| {
        let key_of_view = |view_index| NoiseKey::view(seed, map_index, node_index as u32, view_index);
        learn_node(robot, node, sources, key_of_view)
    };
    nodes.par_iter().enumerate().map(learn_one).collect()
}

fn learn_node(
    robot: &CalibratedRig,
    node: &NodeViews,
    sources: &Sources,
    key_of_view: impl Fn(u16) -> NoiseKey,
) -> LearnedNode {
    let view_count = node.views.len() as u16;
    // Midpoints lie before the camera, so one or two views leave nothing out.
    let sector_slope = if view_count > 2 { math::tan(half_spacing_rad(view_count)) } else { f32::INFINITY };
    let mut segments = Vec::new();
    let mut observation = StereoObservation { rig: *robot.rig(), features: Vec::new() };
    for (view_index, clean) in (0..view_count).zip(&node.views) {
        observation.clone_from(clean);
        sources.apply(&mut observation, &key_of_view(view_index));
        robot.rectify(&mut observation);
        let node_from_camera = CameraPose::new(Point3::default(), view_heading(view_index, view_count));
        let model = observation.features.iter().flat_map(|feature| triangulate_feature(robot.rig(), feature));
        let own = model.filter(|segment| is_in_sector(segment, sector_slope));
        segments.extend(own.map(|segment| node_from_camera.segment_from_camera(&segment)));
    }
    LearnedNode { position: node.position, segments }
}

/// Whether a segment's midpoint, in the camera frame, lies within a sector about the optical axis; of its two borders,
/// at `slope` times the depth to either side, the right one belongs to the next sector.
fn is_in_sector(segment: &Segment3, slope: f32) -> bool {
    let midpoint = segment.start.lerp(segment.end, 0.5);
    (-slope * midpoint.z..slope * midpoint.z).contains(&midpoint.x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;
    use crate::uncertainty::EdgeDetectionLoss;
    use crate::world::{Occluders, WireframeWorld};
    use edgeloc::database::TopologicalDatabase;
    use edgeloc::geometry::{Polarity, StereoRig};
    use edgeloc::stereo::StereoParameters;

    const RIG: StereoRig = StereoRig::reference();
    static ROBOT: std::sync::LazyLock<CalibratedRig> = std::sync::LazyLock::new(|| CalibratedRig::exact(RIG));

    /// Posts in a ring around the origin, 1 to 6 m away, with no surfaces; each post is one vertical edge.
    fn posts() -> WireframeWorld {
        let mut stream = Stream::new(5, "posts", 0, 0);
        let mut edges = Vec::new();
        for index in 0..120_u8 {
            let mut draw = |low, high| stream.uniform(low, high) as f32;
            let (sin, cos) = math::sin_cos((f32::from(index) * 3.0 + 0.3).to_radians());
            let (distance_m, foot_m) = (draw(1.5, 6.0), draw(0.7, 1.0));
            let (x, y) = (2.0 + cos * distance_m, -1.0 + sin * distance_m);
            let polarity = if index % 2 == 0 { Polarity::LeftBrighter } else { Polarity::RightBrighter };
            let (start, end) = (Point3::new(x, y, foot_m), Point3::new(x, y, foot_m + draw(0.2, 0.5)));
            edges.push(Segment3 { start, end, polarity });
        }
        WireframeWorld { edges, ..WireframeWorld::default() }
    }

    fn views() -> Vec<NodeViews> {
        let world = posts();
        let occluders = Occluders::new(&world.surfaces);
        let positions = [Point2::new(2.0, -1.0), Point2::new(2.3, -1.1)];
        NodeViews::observe_all(&RIG, &world, &occluders, &positions, 12)
    }

    #[test]
    fn without_noise_each_edge_is_learned_once_where_it_is() {
        let world = posts();
        for node in learn_nodes(&ROBOT, &views(), &Sources::none(), 1, 0) {
            assert_eq!(node.segments.len(), world.edges.len());
            for edge in &world.edges {
                let in_node = |point: Point3| {
                    Point3::new(point.x - node.position.x, point.y - node.position.y, point.z - RIG.camera_height_m)
                };
                let is_same = |segment: &&Segment3| {
                    let ends = [(segment.start, in_node(edge.start)), (segment.end, in_node(edge.end))];
                    ends.iter().all(|(found, true_end)| found.distance(*true_end) < 0.005)
                };
                let found = node.segments.iter().find(is_same).expect("every edge is in the model");
                assert_eq!(found.polarity, edge.polarity);
            }
        }
    }

    #[test]
    fn a_robot_whose_images_lie_far_off_learns_each_edge_all_the_same() {
        let mut parameters = StereoParameters::ideal(&RIG);
        for camera in [&mut parameters.left, &mut parameters.right] {
            camera.principal_point_px[0] += 100.0;
        }
        let robot = CalibratedRig::believed(RIG, &parameters).expect("side by side");
        for node in learn_nodes(&robot, &views(), &Sources::none(), 1, 0) {
            // Sectors off the axis are a little narrower than the turn between them.
            let (learned, edges) = (node.segments.len(), posts().edges.len());
            assert!(learned * 100 >= edges * 95, "{learned} of {edges}");
        }
    }

    #[test]
    fn each_map_draws_its_own_noise_and_the_same_map_the_same() {
        let (views, sources) = (views(), Sources::default());
        let first = learn(&ROBOT, &views, &sources, 1, 0).expect("a map");
        assert_eq!(first, learn(&ROBOT, &views, &sources, 1, 0).expect("a map"));
        assert_ne!(first, learn(&ROBOT, &views, &sources, 1, 1).expect("a map"));
        assert_ne!(first, learn(&ROBOT, &views, &sources, 2, 0).expect("a map"));
    }

    #[test]
    fn one_thread_and_four_learn_the_same() {
        let (views, sources) = (views(), Sources::default());
        let learn_with = |thread_count| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(thread_count).build().expect("a pool");
            pool.install(|| learn_nodes(&ROBOT, &views, &sources, 1, 0))
        };
        assert_eq!(learn_with(1), learn_with(4));
    }

    #[test]
    fn two_nodes_with_the_same_view_draw_apart() {
        let view = views().swap_remove(0);
        let learned = learn_nodes(&ROBOT, &[view.clone(), view], &Sources::default(), 1, 0);
        assert_ne!(learned[0].segments, learned[1].segments);
    }

    #[test]
    fn gaps_in_the_images_break_the_model_into_more_and_shorter_segments() {
        let sources = Sources { edge_detection_loss: EdgeDetectionLoss::default(), ..Sources::none() };
        let total = |nodes: &[LearnedNode]| nodes[0].segments.iter().map(Segment3::length_m).sum::<f32>();
        let (clean, broken) =
            (learn_nodes(&ROBOT, &views(), &Sources::none(), 1, 0), learn_nodes(&ROBOT, &views(), &sources, 1, 0));
        assert!(broken[0].segments.len() > clean[0].segments.len());
        // A 3-D segment needs the edge in both images, which lose 11.25 % each: 60 % of that together in whole features,
        // the rest in gaps of their own; splinters go as well.
        let kept_whole = 1.0 - 0.6 * 0.1125;
        let kept_between_gaps = (1.0 - 0.1125) / kept_whole;
        let kept_share = total(&broken) / total(&clean);
        assert!((0.68..kept_whole * kept_between_gaps * kept_between_gaps).contains(&kept_share), "{kept_share}");
    }

    #[test]
    fn the_bytes_hold_the_rig_the_views_and_every_segment() {
        let (views, sources) = (views(), Sources::default());
        let bytes = learn(&ROBOT, &views, &sources, 1, 0).expect("a map");
        let database = TopologicalDatabase::open(&bytes).expect("what was just written");
        let learned = learn_nodes(&ROBOT, &views, &sources, 1, 0);
        assert_eq!((database.views_per_node(), *database.rig(), database.node_count()), (12, RIG, 2));
        for (node, learned) in database.nodes().zip(&learned) {
            assert!(node.position().distance(learned.position) < 1e-3);
            assert_eq!(node.segments().len(), learned.segments.len());
            for (stored, segment) in node.segments().zip(&learned.segments) {
                // The format keeps an edge from whichever end makes its left side the brighter one.
                let start = if stored.polarity == segment.polarity { segment.start } else { segment.end };
                assert!(stored.start.distance(start) < 1e-3, "{stored:?} {segment:?}");
            }
        }
    }

    #[test]
    fn a_map_without_nodes_is_refused() {
        assert_eq!(learn(&ROBOT, &[], &Sources::none(), 1, 0), Err(WriteError::Empty));
    }
}

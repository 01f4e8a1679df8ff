//! How well a map explains what was seen while it was learned: the measure that thresholds of the localiser go by.
//!
//! From every node that is asked, some of its views are checked against the model of a node next to it, at the pose that
//! learning knows: the robot as it may stand in the map, with everything that errs in the map and in the looks (the
//! calibration too). The better of the two nearest nodes counts, for one of them may be behind a wall. The median over
//! nodes is the map's self-agreement.

use super::node_views::view_heading;
use super::{CalibratedRig, NodeViews};
use crate::camera::left_segments;
use crate::uncertainty::{NoiseKey, Sources};
use edgeloc::database::{Node, TopologicalDatabase};
use edgeloc::geometry::Segment2;
use edgeloc::localize::{Evidence, LocalizerConfig, PoseCheck};
use rayon::prelude::*;

/// Nodes that are asked, evenly among all.
const ASKED_NODES: usize = 24;
/// Views of each that are checked, evenly around the circle: what the localiser sees in a full turn.
const ASKED_VIEWS: usize = 6;
/// What a pose may be off: as in the closest stage of the localiser's search, position \[m\] and heading \[rad\], and how
/// far apart points are looked up \[px\].
const CLOSENESS: [f32; 3] = [0.03, 0.0, 9.0];

/// The self-agreement of `map`, above 0 to 1; `None` in a map of one node, or when nothing is seen.
#[must_use]
pub fn self_agreement(
    map: &TopologicalDatabase<'_>,
    robot: &CalibratedRig,
    views: &[NodeViews],
    sources: &Sources,
    (seed, map_index): (u64, u64),
) -> Option<f32> {
    let step = views.len().div_ceil(ASKED_NODES).max(1);
    let asked: Vec<usize> = (0..views.len()).step_by(step).collect();
    let ask = |&node: &usize| {
        let looks =
            looks_around(robot, &views[node], sources, |view| NoiseKey::view(seed, map_index, node as u32, view));
        best_agreement(map, &views[node], &nearest_two(map, node), &looks)
    };
    let mut scores: Vec<i32> = asked.par_iter().filter_map(ask).collect();
    scores.sort_unstable();
    let median = *scores.get(scores.len() / 2)? as f32 / (1 << 20) as f32;
    (median > 0.0).then(|| median.min(1.0))
}

/// One look of a node: which view it is and what the robot works with.
type NodeLook = (u16, Vec<Segment2>);

fn looks_around(
    robot: &CalibratedRig,
    node: &NodeViews,
    sources: &Sources,
    key_of_view: impl Fn(u16) -> NoiseKey,
) -> Vec<NodeLook> {
    let step = node.views.len().div_ceil(ASKED_VIEWS).max(1);
    let look = |(view, clean): (u16, &crate::camera::StereoObservation)| {
        let mut observation = clean.clone();
        sources.apply(&mut observation, &key_of_view(view));
        robot.rectify(&mut observation);
        (view, left_segments(&observation))
    };
    (0..).zip(&node.views).step_by(step).map(look).collect()
}

fn nearest_two<'m>(map: &TopologicalDatabase<'m>, node: usize) -> Vec<Node<'m>> {
    let mut others: Vec<Node<'m>> = map.nodes().filter(|other| other.id().0 as usize != node).collect();
    let Some(here) = map.nodes().nth(node).map(|node| node.position()) else { return Vec::new() };
    others.sort_by(|a, b| a.position().distance(here).total_cmp(&b.position().distance(here)));
    others.truncate(2);
    others
}

/// The localiser's score in Q20 of the looks at their true pose, beside the one of the `others` that explains them best.
fn best_agreement(
    map: &TopologicalDatabase<'_>,
    node: &NodeViews,
    others: &[Node<'_>],
    looks: &[NodeLook],
) -> Option<i32> {
    let mut memory = vec![0; PoseCheck::memory_len()];
    let mut evidence = vec![Evidence::default(); others.len()];
    let mut seen_q4 = 0;
    for (view, scene) in looks {
        let heading = view_heading(*view, node.views.len() as u16);
        let mut check = PoseCheck::new(map.rig(), &LocalizerConfig::edgeloc(), scene, &mut memory)
            .expect("memory of the length asked for");
        for (evidence, other) in evidence.iter_mut().zip(others) {
            let offset_m = [node.position.x - other.position().x, node.position.y - other.position().y];
            *evidence = evidence.plus(check.evidence(other, (offset_m, heading), CLOSENESS));
        }
        seen_q4 += check.seen_q4();
    }
    evidence.into_iter().map(|evidence| evidence.score_q20(seen_q4)).max()
}

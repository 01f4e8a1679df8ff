//! How well nodes cover a building, for the verbs that tell or draw it.

use super::console;
use edgeloc::geometry::Point2;
use edgeloc_sim::learning::{SightCoverage, Surroundings};
use edgeloc_sim::scenario::Scenario;
use edgeloc_sim::world::{FreeSpace, Occluders, WireframeWorld};

/// Poor places told.
const TOLD_PLACES: usize = 5;

/// Tells the figures of so many nodes and the largest poor places, on standard error.
pub(super) fn tell(nodes: usize, coverage: &SightCoverage) {
    console::remark(&format!("{nodes} nodes: {}", coverage.describe()));
    for place in coverage.poor.iter().take(TOLD_PLACES) {
        console::remark(&format!("poorly covered: {}", place.describe()));
    }
    let left = coverage.poor.iter().skip(TOLD_PLACES);
    let left_m2 = left.clone().map(|place| place.area_m2).sum::<f64>();
    if left_m2 > 0.0 {
        console::remark(&format!("poorly covered: {} more places of together {left_m2:.2} m2", left.count()));
    }
}

/// The coverage of each row's nodes; rows with the same nodes are looked at once.
pub(super) fn of_rows(
    world: &WireframeWorld,
    space: &FreeSpace,
    scenario: &Scenario,
    nodes: &[Vec<Point2>],
) -> Vec<SightCoverage> {
    let occluders = Occluders::new(&world.surfaces);
    let eye_height_m = scenario.rig.camera_height_m as f32;
    let surroundings = Surroundings { world, occluders: &occluders, space, eye_height_m };
    let mut coverages: Vec<SightCoverage> = Vec::with_capacity(nodes.len());
    for (row, of_row) in nodes.iter().enumerate() {
        let known = nodes[..row].iter().position(|other| other == of_row).map(|other| coverages[other].clone());
        coverages.push(known.unwrap_or_else(|| SightCoverage::of(&surroundings, of_row)));
    }
    coverages
}

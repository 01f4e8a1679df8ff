//! Where a kidnapped robot is put down: the ground truth of a trial, which never reaches the localiser.

use super::Site;
use crate::random::Stream;
use crate::scenario::{Scenario, Start};
use edgeloc::geometry::{Angle, Heading, Point2};

/// The true pose of the left camera at the first look.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TruePose {
    /// Position in the world frame \[m\].
    pub position: Point2,
    /// Yaw of the optical axis.
    pub heading: Heading,
}

/// Draws the start of the `trial`-th trial; the same for every row with the same kind of start.
///
/// # Panics
/// When [`Site::check_start`] would refuse.
#[must_use]
pub fn draw_start(site: &Site, scenario: &Scenario, start: Start, trial: u32) -> TruePose {
    let mut stream = Stream::new(scenario.seed, "start", u64::from(trial), start as u64);
    let position = match start {
        Start::Near => near_a_node(site, scenario.near_radius_m, &mut stream),
        Start::Anywhere => anywhere_learned(site, &mut stream),
        Start::Unlearned => {
            let center = site.unlearned[stream.index(site.unlearned.len())];
            site.free_space.sample_cell(center, &mut stream)
        }
    };
    let turn = Angle::from_radians(stream.uniform(0.0, core::f64::consts::TAU) as f32);
    TruePose { position, heading: Heading::default().turned(turn).expect("a turn below a full one is finite") }
}

/// A point uniform in the free space that is not withheld.
fn anywhere_learned(site: &Site, stream: &mut Stream) -> Point2 {
    loop {
        let point = site.free_space.sample(stream);
        // The nodes are not withheld, so the loop ends.
        if !site.withheld.contains(&site.free_space, point) {
            return point;
        }
    }
}

/// A point uniform in the free part of the disc about a random node.
fn near_a_node(site: &Site, radius_m: f64, stream: &mut Stream) -> Point2 {
    let node = site.nodes[stream.index(site.nodes.len())];
    loop {
        let (dx, dy) = (stream.uniform(-radius_m, radius_m), stream.uniform(-radius_m, radius_m));
        let point = Point2::new(node.x + dx as f32, node.y + dy as f32);
        // The node itself is free, so the loop ends: its surroundings within a cell are free too.
        if dx * dx + dy * dy <= radius_m * radius_m && site.free_space.contains(point) {
            return point;
        }
    }
}

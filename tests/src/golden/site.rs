//! The place of the golden attempts: the generated office, a few nodes in it, and a robot put down and turned there.

use edgeloc::geometry::{Angle, Heading, Point2, Point3, StereoRig};
use edgeloc::math;
use edgeloc_sim::camera::{left_segments, observe};
use edgeloc_sim::learning::{self, CalibratedRig, NodeViews, place_nodes};
use edgeloc_sim::random::Stream;
use edgeloc_sim::uncertainty::{NoiseKey, Sources};
use edgeloc_sim::world::office::{self, OfficeOptions};
use edgeloc_sim::world::{FreeSpace, FreeSpaceOptions, Occluders, ViewpointVisibility, WireframeWorld};

use super::looks_writer::GoldenLook;

/// Decides the office, the places and every draw.
const SEED: u64 = 20;
/// Few, so that an emulated board is through in seconds.
const NODE_COUNT: usize = 10;
/// Views learned at each node.
const VIEW_COUNT: u16 = 12;
/// Segments of a node's joined model at most.
const MAX_SEGMENTS: usize = 700;
/// Greatest distance of a near start from its node, along each axis \[m\].
const NEAR_M: f64 = 0.2;

/// The office and the nodes in it.
#[derive(Debug)]
pub(super) struct Site {
    rig: StereoRig,
    world: WireframeWorld,
    occluders: Occluders,
    free_space: FreeSpace,
    nodes: Vec<Point2>,
}

/// Where a robot is put down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Start {
    /// Close to a node.
    Near,
    /// Anywhere free.
    Anywhere,
}

impl Site {
    /// The office of the golden vectors.
    pub(super) fn office() -> Self {
        let world = office::generate(&OfficeOptions { seed: SEED, ..OfficeOptions::default() });
        let occluders = Occluders::new(&world.surfaces);
        let free_space = FreeSpace::of(&world, &FreeSpaceOptions::default()).expect("an office has free space");
        let nodes = place_nodes(&free_space, NODE_COUNT, SEED).expect("an office has room for a few nodes");
        Self { rig: StereoRig::reference(), world, occluders, free_space, nodes }
    }

    fn draw_start(&self, start: Start, stream: &mut Stream) -> Point2 {
        let node = self.nodes[stream.index(self.nodes.len())];
        loop {
            let mut beside = |coordinate: f32| coordinate + stream.uniform(-NEAR_M, NEAR_M) as f32;
            let near = Point2::new(beside(node.x), beside(node.y));
            match start {
                Start::Anywhere => return self.free_space.sample(stream),
                Start::Near if self.free_space.contains(near) => return near,
                Start::Near => {}
            }
        }
    }

    /// The map of the nodes, learned with every source at its default.
    pub(super) fn learn(&self) -> Vec<u8> {
        let views = NodeViews::observe_all(&self.rig, &self.world, &self.occluders, &self.nodes, VIEW_COUNT);
        let robot = CalibratedRig::exact(self.rig);
        let map = learning::learn(&robot, &views, &Sources::default(), SEED, 0).expect("an office fits the format");
        learning::indexed(&map).expect("a map just learned")
    }

    /// The map of the nodes as the verifying localizer's preset has it learned: joined, and within its budget.
    pub(super) fn learn_joined(&self) -> Vec<u8> {
        let views = NodeViews::observe_all(&self.rig, &self.world, &self.occluders, &self.nodes, VIEW_COUNT);
        let robot = CalibratedRig::exact(self.rig);
        let mut learned = learning::learn_nodes(&robot, &views, &Sources::default(), SEED, 0);
        for node in &mut learned {
            node.segments = learning::join_collinear(&self.rig, &node.segments);
            learning::keep_most_telling(&mut node.segments, MAX_SEGMENTS);
        }
        learning::write_map(&robot, VIEW_COUNT, &learned).expect("an office fits the format")
    }

    /// What a robot sees in `count` looks, turning by `turn` between them, with a perfect compass and without odometry;
    /// `index` draws the start and the noise.
    pub(super) fn looks(
        &self,
        index: u64,
        start: Start,
        turn: Angle,
        count: u32,
        sources: &Sources,
    ) -> Vec<GoldenLook> {
        let mut looks = self.looks_with_odometry(index, start, (turn, count, 0.0), sources);
        looks.iter_mut().for_each(|look| look.motion = None);
        looks
    }

    /// The same with perfect odometry, and before every seventh look a way of `ahead_m` straight ahead after the turn.
    pub(super) fn looks_with_odometry(
        &self,
        index: u64,
        start: Start,
        (turn, count, ahead_m): (Angle, u32, f32),
        sources: &Sources,
    ) -> Vec<GoldenLook> {
        let mut stream = Stream::new(SEED, "start", index, start as u64);
        let mut position = self.draw_start(start, &mut stream);
        let first_turn = Angle::from_radians(stream.uniform(-3.0, 3.0) as f32);
        let mut heading = Heading::new(first_turn).expect("less than half a turn");
        let mut motion = None;
        let mut looks = Vec::new();
        for look in 0..count {
            let eye = Point3::new(position.x, position.y, self.rig.camera_height_m);
            let mut visibility = ViewpointVisibility::new(&self.world, &self.occluders, eye);
            let mut observation = observe(&self.rig, &mut visibility, heading);
            sources.apply(&mut observation, &NoiseKey::look(SEED, index, look));
            let segments = left_segments(&observation);
            looks.push(GoldenLook { heading: Some(heading), spread_rad: 0.0, motion, segments });
            heading = heading.turned(turn).expect("a golden turn is finite");
            let is_moved = look % 6 == 5;
            let way_m = if is_moved { self.free_space.free_way_m(position, heading, ahead_m) } else { 0.0 };
            let (sin, cos) = math::sin_cos(heading.angle().radians());
            position = Point2::new(position.x + way_m * cos, position.y + way_m * sin);
            motion = Some((turn, way_m));
        }
        looks
    }
}

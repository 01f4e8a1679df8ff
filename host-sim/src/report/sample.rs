//! A made-up run for tests of drawings and tables.

use crate::learning::{SightCoverage, Squares};
use crate::monte_carlo::{Outcome, TrialRecord, TruePose};
use crate::random::Stream;
use crate::report::{FreeCells, LookExplanation, Manifest, RunResults, RunTimings, Summary, WorldFacts};
use crate::scenario::{Scenario, Start};
use crate::world::WireframeWorld;
use edgeloc::database::{self, NodeId, NodeModel, TopologicalDatabase};
use edgeloc::geometry::{Angle, Heading, Point2, Point3, Polarity, Segment3, StereoRig};
use edgeloc::localize::predict_view;
use std::time::Duration;

/// Everything a report needs.
pub(crate) struct Sample {
    pub(crate) results: RunResults,
    pub(crate) world: WireframeWorld,
    pub(crate) free: FreeCells,
    pub(crate) coverage: Vec<SightCoverage>,
}

/// A hall of 20 x 15 m with boxes, 48 nodes and 60 trials of each row whose success falls with distance.
pub(crate) fn run() -> Sample {
    let scenario = Scenario { trials: 60, ..Scenario::default() };
    let mut nodes = Vec::new();
    for row in 0_u8..6 {
        for column in 0_u8..8 {
            nodes.push(Point2::new(1.3 + 2.4 * f32::from(column), 1.4 + 2.4 * f32::from(row)));
        }
    }
    let mut stream = Stream::new(1, "sample", 0, 0);
    let mut records = Vec::new();
    for row in &scenario.rows {
        for trial in 0..scenario.trials {
            records.push(record(&mut stream, &row.name, row.start, trial, &nodes));
        }
    }
    let centers = (0_u8..190).flat_map(|x| (0_u8..140).map(move |y| (f32::from(x), f32::from(y))));
    let centers = centers.map(|(x, y)| Point2::new(0.55 + 0.1 * x, 0.55 + 0.1 * y)).collect();
    let look_times = records.iter().map(|record| vec![Duration::from_millis(12); record.looks as usize]);
    let look_times = look_times.collect::<Vec<_>>();
    let (prepare, trials) = (Duration::from_secs(2), Duration::from_secs(31));
    let timings = RunTimings::new(&scenario.rows, &records, &look_times, prepare, trials);
    let nodes = vec![nodes; scenario.rows.len()];
    let summary = Summary::new(&scenario, &nodes, 120.0, &records);
    let world = world();
    let facts = WorldFacts::new(&world, &scenario.world);
    let manifest = Manifest::new(&scenario, facts, 2, None, records.len(), jiff::Timestamp::UNIX_EPOCH).finished();
    let results = RunResults { manifest, scenario, nodes, records, summary, timings };
    let points = vec![Point2::new(0.55, 0.55)];
    let poor_squares = Squares { points, origin: Point2::default(), side_m: 0.1 };
    let coverage = vec![SightCoverage { poor_squares, ..SightCoverage::default() }; results.nodes.len()];
    Sample {
        results,
        world,
        free: FreeCells { centers, origin: Point2::default(), side_m: 0.1, withheld: Vec::new() },
        coverage,
    }
}

fn record(stream: &mut Stream, row: &str, start: Start, trial: u32, nodes: &[Point2]) -> TrialRecord {
    let node = stream.index(nodes.len());
    let reach = if start == Start::Near { 0.3 } else { 1.2 };
    let (dx, dy) = (stream.uniform(-reach, reach), stream.uniform(-reach, reach));
    let place = Point2::new(nodes[node].x + dx as f32, nodes[node].y + dy as f32);
    let distance = place.distance(nodes[node]);
    let is_success = stream.chance(f64::from(0.97 - 0.5 * distance));
    let answered = if is_success { node } else { stream.index(nodes.len()) };
    TrialRecord {
        row: row.to_owned(),
        trial,
        map: trial / 50,
        true_x_m: place.x,
        true_y_m: place.y,
        true_heading_deg: stream.uniform(-180.0, 180.0) as f32,
        nearest_node: node as u32,
        second_nearest_node: node as u32,
        nearest_node_distance_m: distance,
        outcome: Outcome::Localized,
        answered_node: Some(answered as u32),
        answer_distance_m: Some(place.distance(nodes[answered])),
        pose_error_m: None,
        heading_error_deg: None,
        probability: None,
        is_success,
        is_truth_named: is_success,
        is_near_tie: false,
        unknown_kind: None,
        rivals: None,
        end_x_m: place.x,
        end_y_m: place.y,
        driven_m: 0.0,
        looks: 1 + stream.index(if is_success { 4 } else { 12 }) as u32,
        scene_segments: 200,
        scored_nodes: 80,
        leader_score: 1.4,
        runner_up_score: 1.2,
        truth_score: Some(1.3),
        map_bytes: 540_000,
        map_segments: 29_880,
        message: None,
    }
}

fn world() -> WireframeWorld {
    let mut edges = Vec::new();
    let mut rectangle = |x0: f32, y0: f32, x1: f32, y1: f32| {
        let corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)];
        for pair in corners.windows(2) {
            for z in [0.0, 2.5] {
                edges.push(Segment3 {
                    start: Point3::new(pair[0].0, pair[0].1, z),
                    end: Point3::new(pair[1].0, pair[1].1, z),
                    polarity: Polarity::LeftBrighter,
                });
            }
        }
    };
    rectangle(0.0, 0.0, 20.0, 15.0);
    for column in 0_u8..6 {
        for row in 0_u8..4 {
            let (x, y) = (2.0 + 3.0 * f32::from(column), 2.0 + 3.3 * f32::from(row));
            rectangle(x, y, x + 1.2, y + 0.6);
        }
    }
    WireframeWorld { name: "hall".to_owned(), origin: "made up".to_owned(), edges, ..WireframeWorld::default() }
}

/// A map of two places four metres apart, each with posts and boards of its own in front of it, towards +x.
pub(crate) fn map_of_posts() -> Vec<u8> {
    let post = |x: f32, y: f32, low: f32, high: f32| Segment3 {
        start: Point3::new(x, y, low),
        end: Point3::new(x, y + 0.1, high),
        polarity: Polarity::LeftBrighter,
    };
    let first = [(2.0, 0.5), (2.5, -0.4), (4.0, 0.2), (3.0, 1.1), (2.2, -0.9)].map(|(x, y)| post(x, y, -0.5, 0.8));
    let second = [(1.8, -0.7), (3.5, 0.6), (2.6, 0.1), (4.4, -1.4), (3.1, 1.3)].map(|(x, y)| post(x, y, -0.9, 0.4));
    let positions = [Point2::new(1.0, 2.0), Point2::new(5.0, 2.0)];
    let nodes = [(positions[0], &first), (positions[1], &second)];
    let nodes = nodes.map(|(position, segments)| NodeModel { position, segments });
    let mut map = vec![0; 4096];
    let length = database::write(&StereoRig::reference(), 12, &nodes, &mut map).expect("room for the map");
    map.truncate(length);
    map
}

/// The second place of [`map_of_posts`] as it is seen from there, towards +x.
pub(crate) fn look_at_posts() -> LookExplanation {
    let map = map_of_posts();
    let map = TopologicalDatabase::open(&map).expect("a map");
    let node = map.node(NodeId(1)).expect("a second node");
    let scene: Vec<_> = predict_view(&node, map.rig(), Heading::default()).collect();
    LookExplanation {
        look: 1,
        heading_deg: 0.0,
        compass_deg: Some(0.0),
        seen_segments: scene.len(),
        used_segments: scene.len(),
        nodes: Vec::new(),
        decision: "look again after a turn of 60 degrees".to_owned(),
        is_verifying: false,
        pose: None,
        probability: None,
        rivals: Vec::new(),
        scene,
        true_pose: TruePose { position: Point2::default(), heading: Heading::default() },
        compass: Heading::default(),
        compass_spread: Angle::default(),
    }
}

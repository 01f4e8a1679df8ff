//! The workloads, from nothing to pathological, each with its expected answer.
//!
//! The answers are exact integers, the same on every machine and with every kernel: a benchmark that computes something
//! else is not faster but wrong. They change only when the kernels' arithmetic does, on purpose.

use edgeloc::geometry::{Angle, Heading, Point2, Polarity, Segment2, StereoRig};
use edgeloc::localize::LocalizerConfig;
use edgeloc_tests::oracle::{NaiveSegment, prepare_scene};
use edgeloc_tests::tiny_worlds::{all_seeing_node, all_seeing_scene, database_bytes, random_positions, random_room};

/// The rig of all workloads.
pub const RIG: StereoRig = StereoRig::reference();

/// Boxes in the room that the scenes are taken from: 636 edges, about what a node of an office knows.
const BOXES: usize = 52;

/// A scene and a view to match it with, as they enter the matching.
#[derive(Debug, Clone)]
pub struct Workload {
    /// A short name.
    pub name: &'static str,
    /// The scene's segments.
    pub scene: Vec<Segment2>,
    /// The view's segments.
    pub view: Vec<Segment2>,
    /// Pairs of bins, at least one of them not empty, that the scene's histograms have in all.
    pub expected_bin_pairs: usize,
    /// Score of the scene against the view, times 2^30.
    pub expected_score_q30: i32,
}

/// One look at a whole map.
#[derive(Debug, Clone)]
pub struct LookWorkload {
    /// A short name.
    pub name: &'static str,
    /// How the localiser is set.
    pub config: LocalizerConfig,
    /// The map's bytes.
    pub database: Vec<u8>,
    /// Nodes in the map.
    pub nodes: usize,
    /// Heading of the look.
    pub heading: Heading,
    /// The segments of the look.
    pub scene: Vec<Segment2>,
    /// The node that leads after the look.
    pub expected_leader: u32,
    /// Its score, times 2^30.
    pub expected_score_q30: i64,
    /// Candidates left, the leader among them.
    pub expected_candidates: usize,
}

/// One look and poses beside a node that it may have been taken from.
#[derive(Debug, Clone)]
pub struct PoseWorkload {
    /// A short name.
    pub name: &'static str,
    /// Bytes of a map of that node alone.
    pub database: Vec<u8>,
    /// Where the poses are, from the node \[m\].
    pub offsets: Vec<[f32; 2]>,
    /// Heading of the look.
    pub heading: Heading,
    /// The segments of the look.
    pub scene: Vec<Segment2>,
    /// What is explained for all poses together, and what would be in perfect agreement, in Q4 px.
    pub expected_evidence_q4: (i32, i32),
}

/// Every scene with its view, published settings.
#[must_use]
pub fn scenes() -> Vec<Workload> {
    let workload = |name, scene: Vec<Segment2>, view: Vec<Segment2>, expected_bin_pairs, expected_score_q30| Workload {
        name,
        scene,
        view,
        expected_bin_pairs,
        expected_score_q30,
    };
    vec![
        workload("empty", Vec::new(), seen_from(VIEWPOINT, 112), 0, 0),
        workload("bare_wall", seen_from(BESIDE, 3), seen_from(VIEWPOINT, 112), 13, 314_892_349),
        // The mean of an office: 112 segments a look.
        workload("typical", seen_from(BESIDE, 112), seen_from(VIEWPOINT, 112), 6024, 959_361_154),
        // 95 % of looks have 240 segments or fewer; the localiser keeps the longest 150.
        workload("crowded", longest(&seen_from(BESIDE, 240)), longest(&seen_from(VIEWPOINT, 240)), 8862, 985_791_943),
        // Everything falls into the same angle bin, every histogram is like its neighbour.
        workload("all_parallel", parallel(150), parallel(150), 1592, 1_073_736_867),
        // Long segments at all angles through each other: no workload has fuller histograms.
        workload("all_crossing", crossing(150), crossing(120), 24_370, 1_066_502_919),
    ]
}

/// One look at a small and at the reference number of nodes, of the paper's localiser and of the verifying one.
#[must_use]
pub fn looks() -> Vec<LookWorkload> {
    let (paper, verifying) = (LocalizerConfig::paper(), LocalizerConfig::edgeloc());
    let world = random_room(1, BOXES);
    let look = |name, config, nodes: usize, (expected_leader, expected_score_q30, expected_candidates)| {
        let models: Vec<_> =
            random_positions(4, nodes).into_iter().map(|position| all_seeing_node(&world, &RIG, position)).collect();
        LookWorkload {
            name,
            config,
            database: database_bytes(&RIG, &models),
            nodes,
            heading: heading(),
            scene: seen_from(BESIDE, 112),
            expected_leader,
            expected_score_q30,
            expected_candidates,
        }
    };
    vec![
        look("8_nodes", paper, 8, (7, 916_674_167, 4)),
        look("72_nodes", paper, 72, (12, 937_130_882, 32)),
        look("8_nodes_verified", verifying, 8, (7, 770_235_392, 8)),
        look("72_nodes_verified", verifying, 72, (12, 685_177_856, 72)),
    ]
}

/// Looks at a node's place and poses around the one that they were taken from.
#[must_use]
pub fn poses() -> Vec<PoseWorkload> {
    let database = database_bytes(&RIG, &[all_seeing_node(&random_room(1, BOXES), &RIG, VIEWPOINT)]);
    let true_offset = [BESIDE.x - VIEWPOINT.x, BESIDE.y - VIEWPOINT.y];
    let around = [[0.0, 0.0], [0.1, 0.0], [0.0, -0.1], [0.3, 0.3], [-0.3, 0.3], [0.3, -0.3], [-0.3, -0.3], [1.0, 0.5]];
    let offsets: Vec<[f32; 2]> = around.iter().map(|[x, y]| [true_offset[0] + x, true_offset[1] + y]).collect();
    let workload = |name, scene: Vec<Segment2>, expected_evidence_q4| PoseWorkload {
        name,
        database: database.clone(),
        offsets: offsets.clone(),
        heading: heading(),
        scene,
        expected_evidence_q4,
    };
    vec![
        workload("empty", Vec::new(), (0, 2_199_123)),
        workload("bare_wall", seen_from(BESIDE, 3), (71_340, 2_148_135)),
        workload("typical", seen_from(BESIDE, 112), (599_044, 1_498_055)),
        workload("crowded", seen_from(BESIDE, 240), (697_198, 1_191_475)),
        workload("all_crossing", crossing(150), (79_729, 579_228)),
    ]
}

/// Where the view was learned, and where the scene is seen from: 0.3 m apart.
const VIEWPOINT: Point2 = Point2::new(6.8, 4.6);
const BESIDE: Point2 = Point2::new(7.0, 4.8);

fn heading() -> Heading {
    Heading::new(Angle::from_degrees(-150.0)).expect("finite")
}

/// The first `count` segments that enter the matching, each cut to its middle third as fragmented edges are: their median
/// length is that of an office, about 29 px.
fn seen_from(position: Point2, count: usize) -> Vec<Segment2> {
    let world = random_room(1, BOXES);
    let middle_third = |segment: Segment2| {
        let (start, end) = (segment.start(), segment.end());
        Segment2::new(start.lerp(end, 1.0 / 3.0), start.lerp(end, 2.0 / 3.0), segment.polarity()).ok()
    };
    let segments: Vec<Segment2> =
        all_seeing_scene(&world, &RIG, position, heading()).into_iter().filter_map(middle_third).collect();
    let everything = LocalizerConfig { max_segments: 1024, ..LocalizerConfig::paper() };
    let entering: Vec<Segment2> = kept(&segments, &everything);
    assert!(entering.len() >= count, "{} segments enter, {count} are needed", entering.len());
    entering[..count].to_vec()
}

fn longest(segments: &[Segment2]) -> Vec<Segment2> {
    kept(segments, &LocalizerConfig::paper())
}

fn kept(segments: &[Segment2], config: &LocalizerConfig) -> Vec<Segment2> {
    let naive: Vec<NaiveSegment> = segments.iter().map(NaiveSegment::from).collect();
    prepare_scene(&naive, config).into_iter().map(|index| segments[index]).collect()
}

/// Upright segments of 200 px, 4 px apart.
fn parallel(count: u16) -> Vec<Segment2> {
    let upright = |index: u16| {
        let x = 20.0 + 4.0 * f32::from(index);
        Segment2::new(Point2::new(x, 140.0), Point2::new(x, 340.0), Polarity::LeftBrighter).expect("valid")
    };
    (0..count).map(upright).collect()
}

/// Segments from one side of the image to the opposite one, at all places and angles.
fn crossing(count: u16) -> Vec<Segment2> {
    let across = |index: u16| {
        let (from, to) = (f32::from(index * 61 % 240), f32::from(index * 97 % 240));
        let (start, end) = if index.is_multiple_of(2) {
            (Point2::new(2.0 * from, 0.0), Point2::new(639.0 - 2.0 * to, 479.0))
        } else {
            (Point2::new(0.0, 2.0 * from), Point2::new(639.0, 479.0 - 2.0 * to))
        };
        Segment2::new(start, end, Polarity::LeftBrighter).expect("valid")
    };
    (0..count).map(across).collect()
}

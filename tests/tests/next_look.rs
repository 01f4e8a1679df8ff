//! Where the verifying localiser wants to look next: where rivals differ, and from elsewhere when no turn can tell.

use edgeloc::database::{self, NodeId, NodeModel, TopologicalDatabase};
use edgeloc::geometry::{Angle, Heading, Point2, Point3, Polarity, Scene, Segment2, Segment3, StereoRig};
use edgeloc::localize::{
    Decision, HeadingPrior, Localizer, LocalizerConfig, Look, Motion, NextLook, UnknownReason, VerificationConfig,
    predict_view,
};

const RIG: StereoRig = StereoRig::reference();

/// Posts all around, and where `mark_deg` says a few more.
fn posts(mark_deg: Option<f32>) -> Vec<Segment3> {
    let post = |degrees: f32, away_m: f32| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let (x, y) = (away_m * cos, away_m * sin);
        let polarity = Polarity::LeftBrighter;
        Segment3 { start: Point3::new(x, y, -0.8), end: Point3::new(x, y, 0.9), polarity }
    };
    let around = (0_u8..30).map(|index| post(f32::from(index) * 12.0, 2.5 + f32::from(index * 7 % 5) * 0.4));
    let marks = mark_deg.into_iter().flat_map(|degrees| (0_u8..8).map(move |index| (degrees, f32::from(index))));
    around.chain(marks.map(|(degrees, index)| post(degrees + 5.0 * (index - 3.5), 2.0))).collect()
}

/// A map of two places 20 m apart.
fn map_of(models: [&[Segment3]; 2]) -> Vec<u8> {
    let nodes = [0.0, 20.0].into_iter().zip(models);
    let nodes: Vec<_> = nodes.map(|(x, segments)| NodeModel { position: Point2::new(x, 0.0), segments }).collect();
    let mut bytes = vec![0; database::encoded_len(&nodes).expect("a small map")];
    database::write(&RIG, 12, &nodes, &mut bytes).expect("enough room");
    bytes
}

fn config(verification: VerificationConfig) -> LocalizerConfig {
    LocalizerConfig { verification: Some(verification), ..LocalizerConfig::edgeloc() }
}

fn heading(degrees: f32) -> Heading {
    Heading::new(Angle::from_degrees(degrees)).expect("finite")
}

/// A robot at the first node.
struct Robot<'m> {
    map: TopologicalDatabase<'m>,
    localizer: Localizer<'m>,
    degrees: f32,
}

impl<'m> Robot<'m> {
    fn new(bytes: &'m [u8], config: &LocalizerConfig, memory: &'m mut Vec<u64>) -> Self {
        let map = TopologicalDatabase::open(bytes).expect("just written");
        *memory = vec![0; Localizer::memory_len_in(config, &map)];
        let localizer = Localizer::new(map, config, memory).expect("memory of the length asked for");
        Self { map, localizer, degrees: 0.0 }
    }

    fn look(&mut self, motion: Option<Motion>) -> Decision {
        let node = self.map.node(NodeId(0)).expect("two nodes");
        let scene: Vec<Segment2> = predict_view(&node, &RIG, heading(self.degrees)).collect();
        let compass = Some(HeadingPrior::exact(heading(self.degrees)));
        let look = Look { heading: compass, motion_since_last: motion, scene: Scene::new(&scene) };
        self.localizer.observe(&look).expect("a compass")
    }

    /// Looks around until the localiser asks for something else than a turn; with odometry or without.
    fn look_around(&mut self, has_odometry: bool) -> Decision {
        let mut motion = None;
        loop {
            match self.look(motion) {
                Decision::LookAgain { turn, step_m: 0.0 } => {
                    self.degrees += turn.degrees();
                    motion = has_odometry.then(|| Motion::exact_turn(turn));
                }
                other => return other,
            }
        }
    }
}

#[test]
fn the_next_look_goes_where_the_rivals_differ_and_a_fixed_one_onward() {
    let (here, there) = (posts(Some(-120.0)), posts(Some(-60.0)));
    let bytes = map_of([&here, &there]);
    for (next_look, expected_deg) in [(NextLook::Predicted, [-120.0, -60.0]), (NextLook::Fixed, [60.0, 60.0])] {
        let config = config(VerificationConfig { next_look, ..VerificationConfig::reference() });
        let mut memory = Vec::new();
        match Robot::new(&bytes, &config, &mut memory).look(None) {
            Decision::LookAgain { turn, step_m } => {
                let is_expected = expected_deg.iter().any(|expected| (turn.degrees() - expected).abs() < 0.01);
                assert!(is_expected && step_m == 0.0, "{next_look:?}: {turn:?}, {step_m}");
            }
            other => panic!("two places look alike ahead: {other:?}"),
        }
    }
}

#[test]
fn twins_are_looked_at_from_elsewhere_by_a_robot_with_odometry_and_named_by_one_without() {
    let model = posts(None);
    let bytes = map_of([&model, &model]);
    let config = config(VerificationConfig::reference());
    let mut memory = Vec::new();
    match Robot::new(&bytes, &config, &mut memory).look_around(true) {
        Decision::LookAgain { step_m, .. } => assert!(step_m > 0.3 && step_m <= 1.0, "{step_m}"),
        other => panic!("no turn can tell: {other:?}"),
    }
    match Robot::new(&bytes, &config, &mut memory).look_around(false) {
        Decision::Unknown { reason: UnknownReason::Indistinguishable(rivals) } => {
            let nodes: Vec<u32> = rivals.iter().map(|rival| rival.node.0).collect();
            assert!(nodes.contains(&0) && nodes.contains(&1), "{nodes:?}");
        }
        other => panic!("nothing tells twins apart: {other:?}"),
    }
}

#[test]
fn a_robot_that_is_blocked_is_sent_elsewhere_and_at_last_told_that_nothing_tells() {
    let model = posts(None);
    let bytes = map_of([&model, &model]);
    let config = config(VerificationConfig::reference());
    let mut memory = Vec::new();
    let mut robot = Robot::new(&bytes, &config, &mut memory);
    let mut decision = robot.look_around(true);
    let mut tried_deg: Vec<f32> = Vec::new();
    while let Decision::LookAgain { turn, step_m } = decision {
        assert!(step_m > 0.0, "all turns were made");
        robot.degrees += turn.degrees();
        let is_new =
            tried_deg.iter().all(|tried| Angle::from_degrees(robot.degrees - tried).wrapped().degrees().abs() > 30.0);
        assert!(is_new, "{} after {tried_deg:?}", robot.degrees);
        tried_deg.push(robot.degrees);
        assert!(tried_deg.len() < 10, "it has to give up");
        // The way is blocked: it turned, and stands where it stood.
        decision = robot.look(Some(Motion::exact_turn(turn)));
    }
    assert!(tried_deg.len() > 1 && matches!(decision, Decision::Unknown { .. }), "{tried_deg:?} {decision:?}");
}

#[test]
fn without_moves_allowed_none_is_asked_for() {
    let model = posts(None);
    let bytes = map_of([&model, &model]);
    let config = config(VerificationConfig { moves: 0, ..VerificationConfig::reference() });
    let mut memory = Vec::new();
    assert!(matches!(Robot::new(&bytes, &config, &mut memory).look_around(true), Decision::Unknown { .. }));
}

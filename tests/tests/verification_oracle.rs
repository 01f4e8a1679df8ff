//! Geometric verification against its naive twin, and whole attempts in rooms that see through everything.

use edgeloc::database::{NodeId, TopologicalDatabase};
use edgeloc::geometry::{Angle, Heading, Point2, Scene, StereoRig};
use edgeloc::localize::{Decision, HeadingPrior, Localized, Localizer, LocalizerConfig, Look, Motion, PoseCheck};
use edgeloc_tests::oracle::{NaiveCloseness, NaiveSegment, verification_evidence, verification_score};
use edgeloc_tests::tiny_worlds::{
    all_seeing_node, all_seeing_scene, database_bytes, furnished_room, random_positions, random_room,
};

const RIG: StereoRig = StereoRig::reference();
const CONFIG: LocalizerConfig = LocalizerConfig::edgeloc();

fn heading(degrees: f32) -> Heading {
    Heading::new(Angle::from_degrees(degrees)).expect("a finite angle")
}

#[test]
fn scores_equal_the_naive_ones_within_the_grain_of_the_planes() {
    let (mut count, mut sum, mut worst) = (0, 0.0, 0.0_f64);
    for seed in 0..12 {
        let world = random_room(seed, 2 + seed as usize % 7);
        let [at_node, at_robot] = random_positions(seed, 2)[..] else { panic!("two positions") };
        let node = all_seeing_node(&world, &RIG, at_node);
        let bytes = database_bytes(&RIG, std::slice::from_ref(&node));
        let database = TopologicalDatabase::open(&bytes).expect("just written");
        let stored = database.node(NodeId(0)).expect("the one node");
        let model: Vec<_> = stored.segments().collect();
        let looking = heading(seed as f32 * 47.0);
        let scene = all_seeing_scene(&world, &RIG, at_robot, looking);
        let naive_scene: Vec<NaiveSegment> = scene.iter().map(NaiveSegment::from).collect();
        let mut memory = vec![0; PoseCheck::memory_len()];
        let mut check = PoseCheck::new(&RIG, &CONFIG, &scene, &mut memory).expect("memory of the length asked for");
        let true_offset = [at_robot.x - at_node.x, at_robot.y - at_node.y];
        // From the right pose with little tolerance to wrong ones with much.
        for (moved, position_m) in
            [([0.0, 0.0], 0.02_f32), ([0.06, -0.04], 0.05), ([0.3, 0.2], 0.12), ([-1.0, 0.8], 0.12)]
        {
            let offset = [true_offset[0] + moved[0], true_offset[1] + moved[1]];
            let spacing_px = 9.0_f32;
            let evidence = check.evidence(&stored, (offset, looking), [position_m, 0.0, spacing_px]);
            let closeness = NaiveCloseness {
                position_m: f64::from(position_m),
                heading_rad: 0.0,
                spacing_px: f64::from(spacing_px),
            };
            let limits = (f64::from(CONFIG.min_length_px), f64::from(CONFIG.horizontal_exclusion.radians()));
            let radians = f64::from(looking.angle().radians());
            let naive = verification_evidence(&RIG, &naive_scene, &model, (offset, radians), &closeness, limits);
            let score = f64::from(evidence.score_q20(32_000)) / f64::from(1 << 20);
            let difference = (score - verification_score(naive, 2000.0)).abs();
            (count, sum, worst) = (count + 1, sum + difference, worst.max(difference));
        }
    }
    let mean = sum / f64::from(count);
    println!("{count} poses: mean difference {mean:.4}, worst {worst:.4}");
    assert!(mean < 0.015 && worst < 0.06, "mean difference {mean}, worst {worst}");
}

/// Looks around at `position` until the localiser decides; the compass errs by `bias_deg`, and says `spread_deg`.
fn attempt(map: &[u8], position: Point2, (start_deg, bias_deg, spread_deg): (f32, f32, f32)) -> Decision {
    let world = furnished_room();
    let database = TopologicalDatabase::open(map).expect("just written");
    let mut memory = vec![0; Localizer::memory_len(&CONFIG, database.node_count())];
    let mut localizer = Localizer::new(database, &CONFIG, &mut memory).expect("memory of the length asked for");
    let (mut motion, mut degrees) = (None, start_deg);
    for _look in 0..CONFIG.max_looks {
        let scene = all_seeing_scene(&world, &RIG, position, heading(degrees));
        let compass =
            HeadingPrior { mean: heading(degrees + bias_deg), standard_deviation: Angle::from_degrees(spread_deg) };
        let look = Look { heading: Some(compass), motion_since_last: motion, scene: Scene::new(&scene) };
        match localizer.observe(&look).expect("a heading is given") {
            Decision::LookAgain { turn, .. } => {
                motion = Some(Motion::exact_turn(turn));
                degrees += turn.degrees();
            }
            last => return last,
        }
    }
    panic!("no decision after {} looks", CONFIG.max_looks)
}

fn furnished_map() -> Vec<u8> {
    let world = furnished_room();
    let grid = (0..20_u8).map(|index| Point2::new(0.8 + 1.6 * f32::from(index % 5), 0.75 + 1.5 * f32::from(index / 5)));
    let nodes: Vec<_> = grid.map(|position| all_seeing_node(&world, &RIG, position)).collect();
    database_bytes(&RIG, &nodes)
}

fn localized(decision: Decision) -> Localized {
    match decision {
        Decision::Localized(localized) => localized,
        other => panic!("not localized: {other:?}"),
    }
}

#[test]
fn a_robot_between_the_nodes_learns_its_pose() {
    let map = furnished_map();
    for (index, position) in random_positions(3, 8).into_iter().enumerate() {
        let place = localized(attempt(&map, position, (index as f32 * 41.0, 0.0, 0.0)));
        let pose = place.pose.expect("the verifying localiser gives a pose");
        assert!(pose.position.distance(position) < 0.05, "{position:?}: {pose:?}");
        assert!(place.probability.expect("and a probability") > 0.99);
    }
}

#[test]
fn a_compass_that_errs_is_corrected() {
    let map = furnished_map();
    let position = Point2::new(2.4, 3.3);
    for bias_deg in [-4.0_f32, 3.0] {
        let place = localized(attempt(&map, position, (20.0, bias_deg, 3.0)));
        let pose = place.pose.expect("the verifying localiser gives a pose");
        let turned = pose.heading.angle().degrees() - 20.0;
        let error_deg = (turned + 30.0).rem_euclid(60.0) - 30.0;
        assert!(error_deg.abs() < 0.5 && pose.position.distance(position) < 0.08, "bias {bias_deg}: {pose:?}");
    }
}

#[test]
fn an_empty_scene_all_round_is_too_poor() {
    let map = furnished_map();
    let database = TopologicalDatabase::open(&map).expect("just written");
    let mut memory = vec![0; Localizer::memory_len(&CONFIG, database.node_count())];
    let mut localizer = Localizer::new(database, &CONFIG, &mut memory).expect("memory of the length asked for");
    let look =
        Look { heading: Some(HeadingPrior::exact(heading(0.0))), motion_since_last: None, scene: Scene::new(&[]) };
    for _ in 1..CONFIG.max_looks {
        assert!(matches!(localizer.observe(&look), Ok(Decision::LookAgain { .. })));
    }
    assert!(matches!(
        localizer.observe(&look),
        Ok(Decision::Unknown { reason: edgeloc::localize::UnknownReason::SceneTooPoor })
    ));
}

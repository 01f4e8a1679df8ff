//! Scenes, settings and memories that no friend would hand to the localiser: it answers or refuses, and never panics.
//!
//! The development profile keeps overflow checks on, so a number that leaves its type is a panic here.

use edgeloc::database::TopologicalDatabase;
use edgeloc::geometry::{Angle, Heading, Point2, Scene, Segment2, StereoRig};
use edgeloc::localize::{
    ConfigError, Decision, HeadingPrior, Localizer, LocalizerConfig, Look, Motion, ObserveError, StartError,
    UnknownReason,
};
use edgeloc::pgh::{DistanceKind, PghShape, ShapeError};
use edgeloc_tests::strategies::{fixed_cases, polarity};
use edgeloc_tests::tiny_worlds::{
    all_seeing_node, all_seeing_scene, database_bytes, furnished_room, random_positions, random_room,
};
use proptest::collection::vec;
use proptest::prelude::*;

const RIG: StereoRig = StereoRig::reference();

fn heading(degrees: f32) -> Option<HeadingPrior> {
    Heading::new(Angle::from_degrees(degrees)).map(HeadingPrior::exact)
}

fn look(scene: &[Segment2], degrees: f32) -> Look<'_> {
    Look { heading: heading(degrees), motion_since_last: None, scene: Scene::new(scene) }
}

fn segment(start: (f32, f32), end: (f32, f32)) -> Segment2 {
    let point = |(x, y)| Point2::new(x, y);
    Segment2::new(point(start), point(end), edgeloc::geometry::Polarity::RightBrighter).expect("valid")
}

fn furnished_map(nodes: usize) -> Vec<u8> {
    let world = furnished_room();
    let nodes: Vec<_> =
        random_positions(11, nodes).into_iter().map(|position| all_seeing_node(&world, &RIG, position)).collect();
    database_bytes(&RIG, &nodes)
}

/// Runs whole attempts of the same scene in every direction; checks what every answer promises.
fn observe_all_round(bytes: &[u8], config: &LocalizerConfig, scene: &[Segment2]) {
    let database = TopologicalDatabase::open(bytes).expect("just written");
    let node_count = database.node_count();
    let mut memory = vec![0; Localizer::memory_len(config, node_count)];
    let mut localizer = Localizer::new(database, config, &mut memory).expect("memory of the length asked for");
    for degrees in [0.0, 90.0, 180.0, -60.0] {
        let decision = localizer.observe(&look(scene, degrees)).expect("a heading is given");
        assert!(localizer.scene_segment_count() <= usize::from(config.max_segments));
        let highest_score = f64::from(localizer.candidates().iteration()) * 1.001;
        let scores = localizer.candidates().scores();
        assert!(scores.iter().all(|score| (0.0..=highest_score).contains(&score.as_f64())), "{scores:?}");
        if let Decision::Localized(localized) = decision {
            assert!((localized.node.0 as usize) < node_count);
        }
    }
}

/// Coordinates up to the greatest there are, with the extremes drawn often.
fn extreme_coordinate() -> impl Strategy<Value = f32> {
    let limit = Segment2::MAX_COORDINATE_PX;
    prop_oneof![3 => -limit..=limit, 1 => Just(limit), 1 => Just(-limit), 1 => Just(0.0_f32), 2 => 0.0..640.0_f32]
}

fn extreme_segment() -> impl Strategy<Value = Segment2> {
    let point = || (extreme_coordinate(), extreme_coordinate()).prop_map(|(x, y)| Point2::new(x, y));
    // Most tiny ones are shorter than a pixel.
    let tiny = (point(), -1.0..1.0_f32, -0.1..0.1_f32)
        .prop_map(|(start, x, y)| (start, Point2::new(start.x + x, start.y + y)));
    (prop_oneof![3 => (point(), point()), 1 => tiny], polarity())
        .prop_filter_map("a segment", |((start, end), polarity)| Segment2::new(start, end, polarity).ok())
}

/// Settings within the documented ranges, the ends of the ranges drawn often.
fn any_config() -> impl Strategy<Value = LocalizerConfig> {
    let distance = prop_oneof![Just(DistanceKind::Signed), Just(DistanceKind::Unsigned)];
    let bins = || prop_oneof![Just(1_u16), Just(256), 1..=64_u16];
    let shape = (bins(), 1..=64_u16, 0.25..=1024.0_f32, distance, any::<bool>(), any::<bool>()).prop_filter_map(
        "a shape that can be served",
        |(distance_bins, angle_bins, bin_width_px, distance, uses_polarity, interpolates_angle)| {
            let sides = if distance == DistanceKind::Signed { 0.5 } else { 1.0 };
            let max_distance_px = sides * bin_width_px * f32::from(distance_bins);
            let shape =
                PghShape { distance_bins, angle_bins, max_distance_px, distance, uses_polarity, interpolates_angle };
            shape.checked().ok()
        },
    );
    let margin = prop_oneof![Just(0.0_f32), Just(0.1), Just(1000.0)];
    let min_length = prop_oneof![Just(0.0_f32), Just(12.0), Just(2048.0)];
    let exclusion = prop_oneof![Just(0.0_f32), Just(5.0), Just(89.9)];
    (shape, margin, min_length, exclusion, 1..=60_u16, 1..=4_u16).prop_map(
        |(shape, score_margin, min_length_px, exclusion_deg, max_segments, max_looks)| LocalizerConfig {
            shape,
            score_margin,
            turn: Angle::from_degrees(30.0),
            max_looks,
            min_length_px,
            horizontal_exclusion: Angle::from_degrees(exclusion_deg),
            max_segments,
            shortlist: 500,
            verification: None,
        },
    )
}

proptest! {
    #![proptest_config(fixed_cases(150))]

    #[test]
    fn extreme_scenes_are_survived_in_any_setting(
        config in any_config(),
        scene in prop_oneof![4 => vec(extreme_segment(), 0..80), 1 => vec(extreme_segment(), 0..2000)],
    ) {
        observe_all_round(&furnished_map(2), &config, &scene);
    }

    #[test]
    fn extreme_scenes_are_survived_when_verifying(
        scene in prop_oneof![4 => vec(extreme_segment(), 0..80), 1 => vec(extreme_segment(), 0..400)],
        spread_deg in prop_oneof![Just(0.0_f32), Just(5.0), Just(f32::NAN), Just(f32::INFINITY)],
        step_m in prop_oneof![Just(0.0_f32), Just(0.5), Just(f32::NAN), Just(1.0e30)],
    ) {
        let bytes = furnished_map(2);
        let database = TopologicalDatabase::open(&bytes).expect("just written");
        let config = LocalizerConfig { max_looks: 3, ..LocalizerConfig::edgeloc() };
        let mut memory = vec![0; Localizer::memory_len(&config, 2)];
        let mut localizer = Localizer::new(database, &config, &mut memory).expect("memory of the length asked for");
        for degrees in [0.0, 90.0, 180.0, -60.0] {
            let measured = heading(degrees)
                .map(|prior| HeadingPrior { standard_deviation: Angle::from_degrees(spread_deg), ..prior });
            let motion = Motion { step_m: Point2::new(step_m, 0.0), ..Motion::exact_turn(Angle::from_degrees(90.0)) };
            let look = Look { heading: measured, motion_since_last: Some(motion), scene: Scene::new(&scene) };
            let decision = localizer.observe(&look).expect("a heading is given");
            if let Decision::Localized(localized) = decision {
                prop_assert!((localized.node.0 as usize) < 2);
            }
        }
    }

    #[test]
    fn coordinates_that_are_no_numbers_never_become_a_segment(
        good in extreme_coordinate(),
        bad in prop_oneof![Just(f32::NAN), Just(f32::INFINITY), Just(f32::NEG_INFINITY), Just(2048.1_f32), Just(f32::MAX)],
        at in 0..4_usize,
        polarity in polarity(),
    ) {
        let mut coordinates = [good; 4];
        coordinates[at] = bad;
        let [x0, y0, x1, y1] = coordinates;
        prop_assert!(Segment2::new(Point2::new(x0, y0), Point2::new(x1, y1), polarity).is_err());
    }

    #[test]
    fn headings_are_finite_or_none(degrees in any::<f32>()) {
        let heading = Heading::new(Angle::from_radians(degrees));
        prop_assert!(heading.is_none_or(|heading| heading.angle().radians().abs() <= std::f32::consts::PI + 1.0e-5));
    }
}

#[test]
fn two_thousand_identical_or_parallel_or_crossing_segments_are_survived() {
    let bytes = furnished_map(3);
    let limit = Segment2::MAX_COORDINATE_PX;
    let identical = vec![segment((320.0, 10.0), (320.0, 470.0)); 2000];
    let parallel: Vec<_> =
        (0..2000).map(|i| segment((i as f32 - 1000.0, -limit), (i as f32 - 1000.0, limit))).collect();
    let diagonals = [segment((-limit, -limit), (limit, limit)), segment((-limit, limit), (limit, -limit))].repeat(1000);
    for scene in [&identical, &parallel, &diagonals] {
        for uses_polarity in [false, true] {
            for distance in [DistanceKind::Signed, DistanceKind::Unsigned] {
                let shape = PghShape { uses_polarity, distance, ..PghShape::paper() };
                observe_all_round(&bytes, &LocalizerConfig { shape, ..LocalizerConfig::paper() }, scene);
            }
        }
    }
    // As many and as long as the settings allow: the greatest masses there can be.
    let config = LocalizerConfig { max_segments: 1024, ..LocalizerConfig::paper() };
    observe_all_round(&bytes, &config, &diagonals);
    observe_all_round(&bytes, &config, &parallel);
}

#[test]
fn too_small_a_memory_is_refused_with_the_number_needed() {
    let bytes = furnished_map(5);
    let database = TopologicalDatabase::open(&bytes).expect("just written");
    let config = LocalizerConfig::paper();
    let needed = Localizer::memory_len(&config, 5);
    for capacity in [0, 1, 100, needed - 1] {
        let mut memory = vec![0; capacity];
        let error = Localizer::new(database, &config, &mut memory).expect_err("too small");
        let StartError::Memory(error) = error else { panic!("{error}") };
        assert_eq!((error.capacity, error.needed), (capacity, needed));
        assert!(error.to_string().contains(&needed.to_string()), "{error}");
    }
    assert!(Localizer::new(database, &config, &mut vec![u64::MAX; needed]).is_ok());
}

#[test]
fn what_the_memory_held_before_makes_no_difference() {
    let world = furnished_room();
    let bytes = furnished_map(5);
    let config = LocalizerConfig::paper();
    let scene =
        all_seeing_scene(&world, &RIG, Point2::new(3.0, 1.0), Heading::new(Angle::from_degrees(50.0)).expect("finite"));
    let observe = |filling: u64| {
        let database = TopologicalDatabase::open(&bytes).expect("just written");
        let mut memory = vec![filling; Localizer::memory_len(&config, 5)];
        let mut localizer = Localizer::new(database, &config, &mut memory).expect("memory of the length asked for");
        localizer.observe(&look(&scene, 50.0)).expect("a heading is given");
        localizer.candidates().scores().to_vec()
    };
    assert_eq!(observe(0), observe(u64::MAX));
}

#[test]
fn a_look_without_heading_is_refused_and_leaves_no_trace() {
    let world = random_room(2, 5);
    let bytes = furnished_map(4);
    let scene = all_seeing_scene(&world, &RIG, Point2::new(3.0, 3.0), Heading::default());
    let config = LocalizerConfig::paper();
    let database = TopologicalDatabase::open(&bytes).expect("just written");
    let mut memory = vec![0; Localizer::memory_len(&config, 4)];
    let mut localizer = Localizer::new(database, &config, &mut memory).expect("memory of the length asked for");
    let blind = Look { heading: None, ..look(&scene, 0.0) };
    assert_eq!(localizer.observe(&blind), Err(ObserveError::HeadingMissing));
    assert_eq!(localizer.candidates().iteration(), 0);
    localizer.observe(&look(&[], 0.0)).expect("a heading is given");
    assert_eq!(localizer.observe(&blind), Err(ObserveError::HeadingMissing));
    assert_eq!(localizer.candidates().iteration(), 1);
}

#[test]
fn a_robot_that_sees_nothing_is_told_so_and_may_start_again() {
    let bytes = furnished_map(4);
    let config = LocalizerConfig { max_looks: 3, ..LocalizerConfig::paper() };
    let database = TopologicalDatabase::open(&bytes).expect("just written");
    let mut memory = vec![0; Localizer::memory_len(&config, 4)];
    let mut localizer = Localizer::new(database, &config, &mut memory).expect("memory of the length asked for");
    for _attempt in 0..2 {
        for degrees in [0.0, 30.0] {
            let decision = localizer.observe(&look(&[], degrees)).expect("a heading is given");
            assert_eq!(decision, Decision::LookAgain { turn: config.turn, step_m: 0.0 });
        }
        let decision = localizer.observe(&look(&[], 60.0)).expect("a heading is given");
        assert_eq!(decision, Decision::Unknown { reason: UnknownReason::SceneTooPoor });
    }
}

#[test]
fn a_blank_first_look_does_not_favor_the_first_node() {
    let world = furnished_room();
    let bytes = furnished_map(4);
    let position = random_positions(11, 4)[2];
    let heading = Heading::new(Angle::from_degrees(60.0)).expect("finite");
    let scene = all_seeing_scene(&world, &RIG, position, heading);
    let config = LocalizerConfig { score_margin: 0.0, ..LocalizerConfig::paper() };
    let database = TopologicalDatabase::open(&bytes).expect("just written");
    let mut memory = vec![0; Localizer::memory_len(&config, 4)];
    let mut localizer = Localizer::new(database, &config, &mut memory).expect("memory of the length asked for");
    let blank = localizer.observe(&look(&[], 30.0)).expect("a heading is given");
    assert_eq!(blank, Decision::LookAgain { turn: config.turn, step_m: 0.0 });
    let decision = localizer.observe(&look(&scene, 60.0)).expect("a heading is given");
    assert!(matches!(decision, Decision::Localized(localized) if localized.node.0 == 2), "{decision:?}");
}

#[test]
fn settings_out_of_range_are_refused_by_name() {
    let bytes = furnished_map(1);
    let paper = LocalizerConfig::paper();
    let shape = |shape| LocalizerConfig { shape, ..paper };
    let cases = [
        (shape(PghShape { distance_bins: 0, ..paper.shape }), ConfigError::Shape(ShapeError::BinCount)),
        (shape(PghShape { angle_bins: 257, ..paper.shape }), ConfigError::Shape(ShapeError::BinCount)),
        (
            shape(PghShape { max_distance_px: f32::NAN, ..paper.shape }),
            ConfigError::Shape(ShapeError::DistanceBinWidth),
        ),
        (shape(PghShape { max_distance_px: -400.0, ..paper.shape }), ConfigError::Shape(ShapeError::DistanceBinWidth)),
        (shape(PghShape { max_distance_px: 1.0e9, ..paper.shape }), ConfigError::Shape(ShapeError::DistanceBinWidth)),
        (LocalizerConfig { score_margin: f32::NAN, ..paper }, ConfigError::ScoreMargin),
        (LocalizerConfig { score_margin: -0.1, ..paper }, ConfigError::ScoreMargin),
        (LocalizerConfig { turn: Angle::from_radians(f32::INFINITY), ..paper }, ConfigError::Turn),
        (LocalizerConfig { max_looks: 0, ..paper }, ConfigError::MaxLooks),
        (LocalizerConfig { min_length_px: f32::NAN, ..paper }, ConfigError::MinLength),
        (
            LocalizerConfig { horizontal_exclusion: Angle::from_degrees(90.0), ..paper },
            ConfigError::HorizontalExclusion,
        ),
        (LocalizerConfig { max_segments: 0, ..paper }, ConfigError::MaxSegments),
        (LocalizerConfig { max_segments: 1025, ..paper }, ConfigError::MaxSegments),
        (LocalizerConfig { shortlist: 0, ..paper }, ConfigError::Shortlist),
    ];
    for (config, expected) in cases {
        let database = TopologicalDatabase::open(&bytes).expect("just written");
        let error = Localizer::new(database, &config, &mut []).expect_err("out of range");
        assert_eq!(error, StartError::Config(expected), "{error}");
    }
}

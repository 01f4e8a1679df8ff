//! Candidate sets and whole attempts of the localiser against their naive twins.

use edgeloc::database::TopologicalDatabase;
use edgeloc::geometry::{Angle, Heading, Point2, Scene, Segment2, Segment3, StereoRig};
use edgeloc::localize::{
    CandidateSet, Decision, HeadingPrior, Localizer, LocalizerConfig, Look, NodeScore, ScoreMargin, UnknownReason,
};
use edgeloc::matching::ViewScore;
use edgeloc::pgh::PghShape;
use edgeloc_sim::random::Stream;
use edgeloc_sim::world::WireframeWorld;
use edgeloc_tests::oracle::{Attempt, NaiveCandidates, NaiveDecision};
use edgeloc_tests::strategies::fixed_cases;
use edgeloc_tests::tiny_worlds::{
    all_seeing_node, all_seeing_scene, database_bytes, furnished_room, random_positions, random_room,
};
use proptest::collection::vec;
use proptest::prelude::*;
use zerocopy::FromZeros;

const RIG: StereoRig = StereoRig::reference();
const ONE_Q30: f64 = 1_073_741_824.0;

/// Greatest error of one look's view score in these worlds: of 600 scores half are within 1e-5, 99 % within 4e-4, the
/// worst is 2.4e-3. They are of few, upright segments: a whole segment's mass lies within 1 px, at times on a bin border.
const SCORE_ERROR: f64 = 4.0e-3;

proptest! {
    #![proptest_config(fixed_cases(1000))]

    #[test]
    fn candidate_sets_are_identical(
        margin in prop_oneof![Just(0.0_f32), Just(0.1), 0.0..0.5_f32],
        // Sixteenths, so that ties and scores right on the margin happen and are exact in both.
        looks in vec(vec(0..=16_u8, 6), 1..6),
    ) {
        let score_of = |sixteenths: u8| f64::from(sixteenths) / 16.0;
        let mut nodes = [NodeScore::new_zeroed(); 6];
        let mut fast = CandidateSet::new(&mut nodes);
        let mut naive = NaiveCandidates::new(6, f64::from(margin));
        for look in &looks {
            fast.accumulate(|id| ViewScore { q30: (score_of(look[id.0 as usize]) * ONE_Q30) as i32 });
            fast.filter(ScoreMargin::new(margin).expect("in range"));
            naive.accumulate(|node| score_of(look[node]));
            let kept: Vec<bool> = fast.scores().iter().map(NodeScore::is_candidate).collect();
            prop_assert_eq!(&kept, &naive.is_candidate);
            let leader = fast.leading_node().map(|(id, _)| id.0 as usize);
            prop_assert_eq!(leader, Some(naive.leading_node()));
            for (fast, naive) in fast.scores().iter().zip(&naive.scores) {
                prop_assert!((fast.as_f64() - naive).abs() < 1e-9);
            }
        }
    }
}

/// What a robot at `position` sees in each of its looks, less a tenth of the segments, some with their contrast flipped.
fn looks(
    world: &WireframeWorld,
    position: Point2,
    config: &LocalizerConfig,
    seed: u64,
) -> Vec<(Heading, Vec<Segment2>)> {
    let mut stream = Stream::new(seed, "looks", 0, 0);
    let mut heading = Heading::new(Angle::from_degrees(stream.uniform(-180.0, 180.0) as f32)).expect("finite");
    (0..config.max_looks)
        .map(|_| {
            let seen = all_seeing_scene(world, &RIG, position, heading);
            let scene = seen.into_iter().filter(|_| !stream.chance(0.1)).collect();
            let look = (heading, scene);
            heading = heading.turned(config.turn).expect("finite");
            look
        })
        .collect()
}

/// How an attempt of the two localisers went.
#[derive(Debug, PartialEq)]
enum Comparison {
    /// Both came to this decision.
    Decided(NaiveDecision),
    /// Scores came so near to each other that rounding may decide; nothing to compare from there on.
    CloseCall,
}

/// Both localisers take the same looks until they decide.
fn compare_attempts(
    world: &WireframeWorld,
    nodes: &[Point2],
    looks: &[(Heading, Vec<Segment2>)],
    config: &LocalizerConfig,
) -> Comparison {
    let nodes: Vec<_> = nodes.iter().map(|&position| all_seeing_node(world, &RIG, position)).collect();
    let bytes = database_bytes(&RIG, &nodes);
    let database = TopologicalDatabase::open(&bytes).expect("just written");
    let stored: Vec<Vec<Segment3>> = database.nodes().map(|node| node.segments().collect()).collect();
    let mut memory = vec![0; Localizer::memory_len(config, database.node_count())];
    let mut fast = Localizer::new(database, config, &mut memory).expect("memory of the length asked for");
    let mut naive = Attempt::new(&RIG, config, &stored);
    for (i, (heading, scene)) in (1..).zip(looks) {
        let look =
            Look { heading: Some(HeadingPrior::exact(*heading)), motion_since_last: None, scene: Scene::new(scene) };
        let decision = fast.observe(&look).expect("a heading is given");
        let naive_decision = naive.observe(*heading, scene);
        let scores = fast.candidates().scores().iter().zip(&naive.candidates.scores);
        let error = scores.map(|(fast, naive)| (fast.as_f64() - naive).abs()).fold(0.0, f64::max);
        assert!(error < SCORE_ERROR * f64::from(i), "a score differs by {error} after {i} looks");
        if is_close_call(&naive.candidates, f64::from(config.score_margin) / f64::from(i), 2.0 * error) {
            return Comparison::CloseCall;
        }
        let kept: Vec<bool> = fast.candidates().scores().iter().map(NodeScore::is_candidate).collect();
        assert_eq!(kept, naive.candidates.is_candidate, "candidates after {i} looks");
        assert_eq!(in_naive_words(decision), naive_decision, "decision after {i} looks");
        if naive_decision != NaiveDecision::LookAgain {
            return Comparison::Decided(naive_decision);
        }
    }
    panic!("no decision after {} looks", looks.len());
}

/// Whether some score is so near to the leader's or to the margin that rounding may decide.
fn is_close_call(candidates: &NaiveCandidates, margin: f64, error: f64) -> bool {
    let (leader, scores) = (candidates.leading_node(), &candidates.scores);
    let is_near = |node: usize| {
        let behind = scores[leader] - scores[node];
        // Equal scores come from equal views (or none), which both localisers score alike.
        (behind > 0.0 && behind < error) || (behind - margin).abs() < error
    };
    (0..scores.len()).any(|node| node != leader && is_near(node))
}

fn in_naive_words(decision: Decision) -> NaiveDecision {
    match decision {
        Decision::Localized(localized) => {
            assert!(localized.pose.is_none() && localized.probability.is_none(), "paper mode names a node only");
            NaiveDecision::Localized(localized.node.0 as usize)
        }
        Decision::LookAgain { .. } => NaiveDecision::LookAgain,
        Decision::Unknown { reason } => {
            assert_eq!(reason, UnknownReason::SceneTooPoor, "the paper's localiser knows no other reason");
            NaiveDecision::Unknown
        }
    }
}

#[test]
fn attempts_in_random_rooms_equal_the_naive_ones() {
    let (mut decided, mut close_calls) = (0, 0);
    for seed in 0..80 {
        let world = random_room(seed, 2 + seed as usize % 7);
        let shape = PghShape { uses_polarity: seed % 2 == 0, ..PghShape::paper() };
        let score_margin = [0.1, 0.0, 0.3][seed as usize % 3];
        let config =
            LocalizerConfig { shape, score_margin, max_segments: 40, max_looks: 6, ..LocalizerConfig::paper() };
        let positions = random_positions(seed, 7);
        let (robot, nodes) = positions.split_last().expect("seven positions");
        match compare_attempts(&world, nodes, &looks(&world, *robot, &config, seed), &config) {
            Comparison::Decided(_) => decided += 1,
            Comparison::CloseCall => close_calls += 1,
        }
    }
    assert!(decided >= 70, "only {decided} attempts were decided alike, {close_calls} came to a close call");
}

#[test]
fn twin_nodes_take_all_looks_and_the_first_is_the_answer() {
    let world = furnished_room();
    let config = LocalizerConfig { max_looks: 3, ..LocalizerConfig::paper() };
    let place = Point2::new(2.5, 1.5);
    let looks = looks(&world, place, &config, 1);
    let outcome = compare_attempts(&world, &[Point2::new(7.0, 5.0), place, place], &looks, &config);
    assert_eq!(outcome, Comparison::Decided(NaiveDecision::Localized(1)));
}

#[test]
fn attempts_without_any_evidence_end_unknown_in_both() {
    let world = furnished_room();
    let nodes = random_positions(5, 4);
    for score_margin in [0.0, 0.1] {
        let config = LocalizerConfig { score_margin, max_looks: 4, ..LocalizerConfig::paper() };
        let blank: Vec<_> = looks(&world, nodes[0], &config, 1).into_iter().map(|look| (look.0, Vec::new())).collect();
        let outcome = compare_attempts(&world, &nodes, &blank, &config);
        assert_eq!(outcome, Comparison::Decided(NaiveDecision::Unknown));
    }
}

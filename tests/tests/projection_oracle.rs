//! The prediction of a node's view, projected in `f32`, against its naive twin in `f64`.

use edgeloc::database::{NodeId, TopologicalDatabase};
use edgeloc::geometry::{Angle, Heading, Point2, Point3, Segment2, Segment3, StereoRig};
use edgeloc::localize::predict_view;
use edgeloc_tests::oracle::{NaiveSegment, predict};
use edgeloc_tests::strategies::{fixed_cases, polarity};
use edgeloc_tests::tiny_worlds::{TinyNode, all_seeing_node, database_bytes, random_positions, random_room};
use proptest::collection::vec;
use proptest::prelude::*;

const RIG: StereoRig = StereoRig::reference();

/// Greatest distance between the two images of an end point \[px\].
const END_POINT_ERROR_PX: f64 = 0.01;

/// A segment this short may be seen by the one and not by the other \[px\].
const SLIVER_PX: f64 = 0.1;

fn heading(degrees: f32) -> Heading {
    Heading::new(Angle::from_degrees(degrees)).expect("finite")
}

/// Both predictions, less what is hardly there; node coordinates as the database keeps them.
fn predictions(node: &TinyNode, heading: Heading) -> (Vec<Segment2>, Vec<NaiveSegment>) {
    let bytes = database_bytes(&RIG, std::slice::from_ref(node));
    let database = TopologicalDatabase::open(&bytes).expect("just written");
    let node = database.node(NodeId(0)).expect("one node");
    let stored: Vec<Segment3> = node.segments().collect();
    let fast = predict_view(&node, &RIG, heading).filter(|segment| f64::from(segment.length_px()) > SLIVER_PX);
    let naive = predict(&RIG, &stored, f64::from(heading.angle().radians())).into_iter();
    (fast.collect(), naive.filter(|segment| segment.length_px() > SLIVER_PX).collect())
}

fn check(node: &TinyNode, heading: Heading) -> Result<(), TestCaseError> {
    let (fast, naive) = predictions(node, heading);
    prop_assert_eq!(fast.len(), naive.len());
    for (fast, naive) in fast.iter().zip(&naive) {
        let of_fast = NaiveSegment::from(fast);
        prop_assert_eq!(of_fast.polarity, naive.polarity);
        for (fast, naive) in [(of_fast.start, naive.start), (of_fast.end, naive.end)] {
            let error = (fast[0] - naive[0]).hypot(fast[1] - naive[1]);
            prop_assert!(error < END_POINT_ERROR_PX, "{fast:?} and {naive:?} are {error} px apart");
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(fixed_cases(300))]

    #[test]
    fn end_points_of_any_segments_agree(
        ends in vec(((-16.0..16.0_f32, -16.0..16.0_f32, -3.0..3.0_f32), (-2.0..2.0_f32, -2.0..2.0_f32, -2.0..2.0_f32), polarity()), 1..40),
        degrees in -180.0..180.0_f32,
    ) {
        let segments = ends.into_iter().map(|((x, y, z), (dx, dy, dz), polarity)| Segment3 {
            start: Point3::new(x, y, z),
            end: Point3::new(x + dx, y + dy, z + dz),
            polarity,
        });
        check(&TinyNode { position: Point2::default(), segments: segments.collect() }, heading(degrees))?;
    }

    #[test]
    fn views_of_a_room_agree(seed in any::<u64>(), degrees in -180.0..180.0_f32) {
        let world = random_room(seed, 6);
        for position in random_positions(seed, 2) {
            check(&all_seeing_node(&world, &RIG, position), heading(degrees))?;
        }
    }
}

#[test]
fn headings_along_the_axes_agree() {
    let world = random_room(1, 10);
    for degrees in [0.0, 90.0, 180.0, -90.0, 45.0, -179.99] {
        for position in random_positions(1, 8) {
            check(&all_seeing_node(&world, &RIG, position), heading(degrees)).expect("the predictions agree");
        }
    }
}

#[test]
fn looking_along_plus_x_shows_what_lies_there_and_its_left_on_the_left() {
    let upright = |x: f32, y: f32| Segment3 {
        start: Point3::new(x, y, -0.5),
        end: Point3::new(x, y, 0.5),
        polarity: edgeloc::geometry::Polarity::LeftBrighter,
    };
    // One edge ahead, one ahead to the left (+y), one behind.
    let segments = vec![upright(4.0, 0.0), upright(4.0, 1.0), upright(-4.0, 0.0)];
    let (fast, naive) = predictions(&TinyNode { position: Point2::default(), segments }, heading(0.0));
    assert_eq!((fast.len(), naive.len()), (2, 2));
    assert!((fast[0].start().x - 320.0).abs() < 0.01 && fast[1].start().x < 200.0);
    // z is up, the image's y is down.
    assert!(fast[0].start().y > fast[0].end().y);
}

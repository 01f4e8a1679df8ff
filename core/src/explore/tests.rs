//! A robot in rooms drawn with characters, a quarter of a metre each.

use super::*;
use crate::geometry::{Angle, Heading, Point2};
use std::vec::Vec;

const SQUARE_M: f32 = 0.25;
const RAYS: usize = 240;

const ROOM: &[&str] = &[
    "##################",
    "#................#",
    "#................#",
    "#................#",
    "#................#",
    "#.......##.......#",
    "#.......##.......#",
    "#................#",
    "#................#",
    "#................#",
    "#................#",
    "##################",
];

const TWO_ROOMS: &[&str] = &[
    "###################",
    "#........#........#",
    "#........#........#",
    "#........#........#",
    "#.................#",
    "#.................#",
    "#.................#",
    "#.................#",
    "#........#........#",
    "#........#........#",
    "#........#........#",
    "###################",
];

fn config() -> ExploreConfig {
    ExploreConfig { side_cells: 256, ..ExploreConfig::reference() }
}

fn is_wall(map: &[&str], point: Point2) -> bool {
    let index = |coordinate: f32| (coordinate / SQUARE_M) as usize;
    map.get(index(point.y)).and_then(|row| row.as_bytes().get(index(point.x))) != Some(&b'.')
}

fn range_m(map: &[&str], from: Point2, angle: f32) -> f32 {
    let (sin, cos) = crate::math::sin_cos(angle);
    let at = |step: u16| Point2::new(from.x + cos * f32::from(step) * 0.01, from.y + sin * f32::from(step) * 0.01);
    (1..800).find(|&step| is_wall(map, at(step))).map_or(f32::INFINITY, |step| f32::from(step) * 0.01)
}

/// Explores from `start`; every place where the robot scanned, and the end.
fn explored(map: &[&str], start: Point2, config: &ExploreConfig) -> (Vec<Point2>, Ending) {
    let mut cells = std::vec![Cell::EMPTY; Explorer::cell_count(config)];
    let mut explorer = Explorer::new(config, &mut cells).expect("memory for the grid");
    let mut odometry = Odometry::default();
    let mut path = Vec::new();
    loop {
        let place = Point2::new(start.x + odometry.position.x, start.y + odometry.position.y);
        path.push(place);
        let heading = odometry.heading.angle().radians();
        let ranges: Vec<f32> = (0..RAYS)
            .map(|ray| range_m(map, place, heading + ray as f32 * core::f32::consts::TAU / RAYS as f32))
            .collect();
        let scan = RangeScan::new(&ranges, 8.0).expect("a scan");
        match explorer.step(&odometry, &scan) {
            Action::Finish(ending) => {
                assert_eq!(explorer.step(&odometry, &scan), Action::Finish(ending), "the end is the end");
                return (path, ending);
            }
            Action::Move(Motion { turn, advance_m }) => {
                odometry.heading = odometry.heading.turned(turn).expect("a turn");
                let (sin, cos) = crate::math::sin_cos(odometry.heading.angle().radians());
                odometry.position.x += cos * advance_m;
                odometry.position.y += sin * advance_m;
            }
        }
    }
}

#[test]
fn a_closed_room_is_explored_round_its_column_and_called_one() {
    let (path, ending) = explored(ROOM, Point2::new(1.0, 0.8), &config());
    let Ending::ClosedRoom { reachable_m2 } = ending else { panic!("{ending:?}") };
    // 4 m x 2.5 m, less the robot's radius at walls and column.
    assert!((5.0..7.5).contains(&reachable_m2), "{reachable_m2}");
    for corner in [(0.6, 0.6), (3.8, 0.6), (3.8, 2.3), (0.6, 2.3)] {
        let nearest = path.iter().map(|place| place.distance(Point2::new(corner.0, corner.1)));
        assert!(nearest.fold(f32::INFINITY, f32::min) < 1.2, "{corner:?} was not covered");
    }
}

#[test]
fn no_motion_comes_nearer_to_a_wall_than_the_radius() {
    let (path, _) = explored(TWO_ROOMS, Point2::new(0.9, 1.9), &config());
    for pair in path.windows(2) {
        for step in 0..=10_u8 {
            let at = pair[0].lerp(pair[1], f32::from(step) / 10.0);
            let nearest = (0..72_u8).map(|ray| range_m(TWO_ROOMS, at, f32::from(ray) * 0.087_266));
            let nearest = nearest.fold(f32::INFINITY, f32::min);
            assert!(nearest >= config().robot_radius_m, "{nearest} m at {at:?}");
        }
    }
}

#[test]
fn a_doorway_leads_to_the_room_behind_it() {
    let (path, ending) = explored(TWO_ROOMS, Point2::new(0.9, 0.7), &config());
    assert!(!matches!(ending, Ending::StepLimit), "{ending:?}");
    assert!(path.iter().any(|place| place.x > 3.3), "the robot stayed in its room");
}

#[test]
fn the_same_scans_give_the_same_path() {
    let start = Point2::new(1.0, 0.8);
    assert_eq!(explored(TWO_ROOMS, start, &config()), explored(TWO_ROOMS, start, &config()));
}

#[test]
fn a_building_fits_a_grid_of_its_size_from_any_corner() {
    // 128 cells of 5 cm are 6.4 m: the room of 4.5 m fits, but not twice.
    let small = ExploreConfig { side_cells: 128, ..config() };
    for start in [Point2::new(0.7, 0.7), Point2::new(3.7, 2.2)] {
        let (large, small) = (explored(ROOM, start, &config()), explored(ROOM, start, &small));
        assert_eq!(large, small);
    }
}

#[test]
fn a_room_larger_than_the_grid_has_an_end() {
    // 64 cells of 5 cm are 3.2 m, less than the 4 m of the room.
    let small = ExploreConfig { side_cells: 64, max_steps: 2000, ..config() };
    let (_, ending) = explored(ROOM, Point2::new(1.0, 0.8), &small);
    assert!(!matches!(ending, Ending::StepLimit), "{ending:?}");
}

#[test]
fn the_robot_gives_up_after_as_many_motions_as_it_may_make() {
    let short = ExploreConfig { max_steps: 7, ..config() };
    let (path, ending) = explored(ROOM, Point2::new(1.0, 0.8), &short);
    assert_eq!((path.len(), ending), (8, Ending::StepLimit));
}

#[test]
fn a_robot_that_is_walled_in_says_so_at_once() {
    let mut cells = std::vec![Cell::EMPTY; Explorer::cell_count(&config())];
    let mut explorer = Explorer::new(&config(), &mut cells).expect("memory for the grid");
    let scan = RangeScan::new(&[0.26; 360], 8.0).expect("a scan");
    let still = Odometry { position: Point2::default(), heading: Heading::new(Angle::default()).expect("a heading") };
    let action = explorer.step(&still, &scan);
    assert!(matches!(action, Action::Finish(Ending::ClosedRoom { .. })), "{action:?}");
}

#[test]
fn too_little_memory_and_settings_out_of_range_are_refused() {
    let mut cells = [Cell::EMPTY; 64];
    let error = Explorer::new(&config(), &mut cells).expect_err("too little memory");
    assert!(matches!(error, ExploreError::Memory(_)), "{error}");
    for (wrong, expected) in [
        (ExploreConfig { side_cells: 100, ..config() }, ExploreConfigError::SideCells),
        (ExploreConfig { robot_radius_m: f32::NAN, ..config() }, ExploreConfigError::RobotRadius),
        (ExploreConfig { robot_radius_m: 0.9, ..config() }, ExploreConfigError::Cell),
        (ExploreConfig { margin_m: 0.0, ..config() }, ExploreConfigError::Margin),
        (ExploreConfig { wall_gap_m: 0.0, ..config() }, ExploreConfigError::WallGap),
        (ExploreConfig { max_steps: 0, ..config() }, ExploreConfigError::MaxSteps),
    ] {
        assert_eq!(wrong.checked(), Err(expected));
    }
}

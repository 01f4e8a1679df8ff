//! A robot put down anywhere explores the building: it covers what can be reached, touches nothing, and ends by itself.

use edgeloc::explore::Ending;
use edgeloc_sim::learning::{Exploration, ExploringRobot, explore, random_start};
use edgeloc_sim::world::import::{ImportOptions, import};
use edgeloc_sim::world::office::{self, OfficeOptions};
use edgeloc_sim::world::{FreeSpace, FreeSpaceOptions, RangeSensorOptions, WireframeWorld};
use edgeloc_tests::{data_folder, tiny_worlds};
use rayon::prelude::*;

const STARTS: u64 = 20;

struct Explored {
    space: FreeSpace,
    explorations: Vec<Exploration>,
}

/// Explores a world from `count` random starts.
fn explored(world: &WireframeWorld, sensor: &RangeSensorOptions, count: u64) -> Explored {
    let space = FreeSpace::of(world, &FreeSpaceOptions::default()).expect("a building with free space");
    let robot = ExploringRobot::new(world, &space, sensor);
    let from = |seed| explore(&space, &robot, random_start(&space, seed), seed, |_| {}).expect("a free start");
    let explorations = (0..count).into_par_iter().map(from).collect();
    Explored { space, explorations }
}

fn assert_explored_without_collision(world: &WireframeWorld) {
    let Explored { space, explorations } = explored(world, &RangeSensorOptions::default(), STARTS);
    for (seed, exploration) in explorations.iter().enumerate() {
        let coverage = exploration.coverage(&space);
        assert!(coverage >= 0.9, "start {seed} covers {coverage}");
        assert_eq!(exploration.collision_count, 0, "start {seed}");
        assert!(exploration.least_clearance_m >= space.options().robot_radius_m, "start {seed}");
        assert!(matches!(exploration.ending, Ending::Explored { .. }), "start {seed}: {:?}", exploration.ending);
        let nodes = exploration.drop_nodes(&space, 47).expect("room on the path");
        assert!(nodes.iter().all(|&node| space.contains(node)));
    }
}

#[test]
fn the_office_is_explored_from_anywhere_without_a_collision() {
    assert_explored_without_collision(&office::generate(&OfficeOptions::default()));
}

#[test]
fn the_small_house_is_explored_from_anywhere_without_a_collision() {
    let Some(folder) = data_folder("aws_small_house") else { return };
    let path = folder.join("worlds/small_house.world");
    let (world, _) = import(&path, &ImportOptions::default()).expect("the house can be imported");
    assert_explored_without_collision(&world);
}

#[test]
fn a_closed_room_is_explored_and_called_one() {
    for world in [tiny_worlds::bare_room(), tiny_worlds::furnished_room()] {
        let Explored { space, explorations } = explored(&world, &RangeSensorOptions::default(), 5);
        for exploration in &explorations {
            let Ending::ClosedRoom { reachable_m2 } = exploration.ending else {
                panic!("{}: {:?}", world.name, exploration.ending);
            };
            let difference = f64::from(reachable_m2) / space.area_m2() - 1.0;
            assert!(difference.abs() < 0.05, "{reachable_m2} m2 differ from {} m2", space.area_m2());
            assert!(exploration.coverage(&space) > 0.99 && exploration.collision_count == 0);
        }
    }
}

#[test]
fn a_door_to_the_outside_counts_as_closed() {
    let Explored { space, explorations } = explored(&tiny_worlds::open_room(), &RangeSensorOptions::default(), 5);
    assert!(!space.exits().is_empty());
    for exploration in &explorations {
        assert!(!matches!(exploration.ending, Ending::StepLimit), "{:?}", exploration.ending);
        assert!(exploration.coverage(&space) > 0.99 && exploration.collision_count == 0);
        assert!(exploration.path.iter().all(|place| place.x < tiny_worlds::ROOM_SIZE_M[0] + 0.5));
    }
}

#[test]
fn the_same_start_and_seed_give_the_same_path_and_another_seed_another() {
    let world = tiny_worlds::furnished_room();
    let first = explored(&world, &RangeSensorOptions::default(), 3);
    let second = explored(&world, &RangeSensorOptions::default(), 3);
    assert_eq!(first.explorations, second.explorations);
    let robot = ExploringRobot::new(&world, &first.space, &RangeSensorOptions::default());
    let start = random_start(&first.space, 0);
    let other = explore(&first.space, &robot, start, 99, |_| {}).expect("a free start");
    assert_eq!(other.path[0], first.explorations[0].path[0]);
    assert_ne!(other.path, first.explorations[0].path);
}

#[test]
fn nodes_lie_evenly_along_new_ground() {
    let Explored { space, explorations } = explored(&tiny_worlds::bare_room(), &RangeSensorOptions::default(), 3);
    for exploration in &explorations {
        let nodes = exploration.drop_nodes(&space, 12).expect("room on the path");
        assert_eq!(nodes.len(), 12);
        let apart = (0..12).flat_map(|a| (0..a).map(move |b| (a, b))).map(|(a, b)| nodes[a].distance(nodes[b]));
        let nearest = apart.fold(f32::INFINITY, f32::min);
        assert!(nearest > 0.45, "two nodes {nearest} m apart");
        assert!(exploration.drop_nodes(&space, 0).is_err() && exploration.drop_nodes(&space, 100_000).is_err());
    }
}

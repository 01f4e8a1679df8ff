//! The worlds at a glance: what each is made of, where a robot can be in it, and what it sees there.
//!
//! Each row: edges and triangles, free space [m2] and how much of it each of 72 nodes has [m2], then how many segments
//! of 12 px or more a view shows: the mean, and what 5 % and 95 % of the views show at most; 300 poses uniform in free
//! space. A row that changes is a changed world: commit the new row and say why.

use edgeloc::geometry::{Angle, Heading, Point3, StereoRig};
use edgeloc_sim::camera::{left_segments, observe};
use edgeloc_sim::learning::place_nodes;
use edgeloc_sim::random::Stream;
use edgeloc_sim::world::import::{ImportOptions, import};
use edgeloc_sim::world::office::{OfficeOptions, generate};
use edgeloc_sim::world::{FreeSpace, FreeSpaceOptions, Occluders, ViewpointVisibility, WireframeWorld};

const NODE_COUNT: usize = 72;
const POSE_COUNT: usize = 300;
const MIN_LENGTH_PX: f32 = 12.0;

fn row(world: &WireframeWorld) -> String {
    let space = FreeSpace::of(world, &FreeSpaceOptions::default()).expect("free space");
    let nodes = place_nodes(&space, NODE_COUNT, 1).expect("room for the nodes");
    assert!(nodes.iter().all(|&node| space.contains(node)), "a node of {} is not in free space", world.name);
    let counts = segments_in_views(world, &space);
    let mean = counts.iter().sum::<usize>() as f64 / POSE_COUNT as f64;
    format!(
        "{} edges, {} triangles; {:.1} m2, {:.2} m2 a node; {mean:.0} segments, 5 % {}, 95 % {}",
        world.edges.len(),
        world.surfaces.triangles.len(),
        space.area_m2(),
        space.area_m2() / NODE_COUNT as f64,
        counts[POSE_COUNT / 20],
        counts[POSE_COUNT * 19 / 20],
    )
}

/// How many segments each view shows, in rising order.
fn segments_in_views(world: &WireframeWorld, space: &FreeSpace) -> Vec<usize> {
    let rig = StereoRig::reference();
    let occluders = Occluders::new(&world.surfaces);
    let mut stream = Stream::new(1, "views", 0, 0);
    let mut counts: Vec<usize> = (0..POSE_COUNT)
        .map(|_| {
            let position = space.sample(&mut stream);
            let eye = Point3::new(position.x, position.y, rig.camera_height_m);
            let angle = Angle::from_degrees(stream.uniform(-180.0, 180.0) as f32);
            let heading = Heading::new(angle).expect("a finite angle");
            let observation = observe(&rig, &mut ViewpointVisibility::new(world, &occluders, eye), heading);
            left_segments(&observation).iter().filter(|segment| segment.length_px() >= MIN_LENGTH_PX).count()
        })
        .collect();
    counts.sort_unstable();
    counts
}

#[test]
fn the_generated_offices_are_the_table() {
    for (seed, expected) in [
        (1, "7005 edges, 13250 triangles; 164.6 m2, 2.29 m2 a node; 97 segments, 5 % 4, 95 % 238"),
        (2, "7006 edges, 12830 triangles; 161.2 m2, 2.24 m2 a node; 100 segments, 5 % 5, 95 % 261"),
        (3, "7009 edges, 12818 triangles; 163.0 m2, 2.26 m2 a node; 103 segments, 5 % 5, 95 % 245"),
    ] {
        let office = generate(&OfficeOptions { seed, ..OfficeOptions::default() });
        assert_eq!(row(&office), expected, "office of seed {seed}");
    }
}

#[test]
fn the_real_buildings_are_the_table() {
    for (folder, file, expected) in [
        (
            "aws_small_house",
            "worlds/small_house.world",
            "6960 edges, 105627 triangles; 112.4 m2, 1.56 m2 a node; 344 segments, 5 % 32, 95 % 776",
        ),
        (
            "willowgarage",
            "model.sdf",
            "4125 edges, 6861 triangles; 1608.0 m2, 22.33 m2 a node; 16 segments, 5 % 0, 95 % 56",
        ),
    ] {
        let Some(path) = edgeloc_tests::data_folder(folder) else { continue };
        let (building, _) = import(&path.join(file), &ImportOptions::default()).expect("the building is imported");
        assert_eq!(row(&building), expected, "{folder}");
    }
}

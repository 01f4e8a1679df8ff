//! What is free, what is not, and what is refused.

use super::*;
use crate::world::template::{Placement, Template};
use edgeloc::geometry::Point3;

/// A room of 4 m x 3 m from the origin, with walls 0.1 m thick, and a hole of the given width in its east wall.
fn room(hole_m: f32, build: impl FnOnce(&mut Template)) -> WireframeWorld {
    let mut room = Template::new("room");
    for z in [0.0, 2.5] {
        room.add_surface([[-0.1, -0.1, z], [4.1, -0.1, z], [4.1, 3.1, z], [-0.1, 3.1, z]]);
    }
    room.add_solid([-0.1, -0.1, 0.0], [4.1, 0.0, 2.5]);
    room.add_solid([-0.1, 3.0, 0.0], [4.1, 3.1, 2.5]);
    room.add_solid([-0.1, 0.0, 0.0], [0.0, 3.0, 2.5]);
    room.add_solid([4.0, 0.0, 0.0], [4.1, 1.5 - 0.5 * hole_m, 2.5]);
    room.add_solid([4.0, 1.5 + 0.5 * hole_m, 0.0], [4.1, 3.0, 2.5]);
    build(&mut room);
    let mut world = WireframeWorld::default();
    room.place(&Placement::at(0.0, 0.0, 0.0), &mut world);
    world
}

fn free(world: &WireframeWorld) -> Result<FreeSpace, FreeSpaceError> {
    FreeSpace::of(world, &FreeSpaceOptions::default())
}

#[test]
fn a_bare_room_is_free_but_for_the_robots_radius_at_the_walls() {
    let space = free(&room(0.0, |_| {})).expect("a room");
    // 3.5 m x 2.5 m, less up to a cell on each side.
    assert!((8.1..=8.75).contains(&space.area_m2()), "{}", space.describe());
    assert!(space.contains(Point2::new(2.0, 1.5)) && space.contains(Point2::new(0.35, 0.35)));
    for outside in [(0.2, 1.5), (-0.5, 1.5), (5.0, 1.5), (f32::NAN, 1.5), (1e30, 1.5)] {
        assert!(!space.contains(Point2::new(outside.0, outside.1)), "{outside:?}");
    }
}

#[test]
fn the_exits_lie_in_the_hole_of_a_wall() {
    let exits = |hole_m| free(&room(hole_m, |_| {})).expect("a room").exits().to_vec();
    assert!(exits(0.0).is_empty());
    let exits = exits(1.2);
    // Over the width of the hole, less a radius and up to a cell and a half at each jamb, and no farther out than it.
    let across = exits.iter().map(|[a, b]| (a.y - b.y).abs()).sum::<f32>();
    assert!((0.5..=0.71).contains(&across), "{across} m: {exits:?}");
    assert!(exits.iter().flatten().all(|end| end.x > 3.5 && end.x < 5.0 && (end.y - 1.5).abs() <= 0.36), "{exits:?}");
}

#[test]
fn no_surface_within_the_slice_comes_nearer_than_the_radius() {
    let table = [[1.0, 1.0, 0.7], [2.0, 1.8, 0.75]];
    let space = free(&room(0.0, |room| room.add_solid(table[0], table[1]))).expect("a room");
    for center in space.cell_centers() {
        let to_table = center.distance(Point2::new(center.x.clamp(1.0, 2.0), center.y.clamp(1.0, 1.8)));
        let to_wall = center.x.min(4.0 - center.x).min(center.y).min(3.0 - center.y);
        assert!(to_table.min(to_wall) >= 0.25 - 1e-4, "{center:?}");
    }
    assert!(!space.contains(Point2::new(1.5, 1.4)));
}

#[test]
fn carpets_and_lamps_are_no_obstacles() {
    let bare = free(&room(0.0, |_| {})).expect("a room").area_m2();
    let furnished = room(0.0, |room| {
        room.add_solid([1.0, 1.0, 0.0], [2.0, 2.0, 0.02]);
        room.add_solid([1.0, 1.0, 2.2], [2.0, 2.0, 2.4]);
    });
    assert!((free(&furnished).expect("a room").area_m2() - bare).abs() < 1e-9);
}

#[test]
fn an_open_door_does_not_let_the_outside_in() {
    let mut doorway = room(0.9, |_| {});
    let mut without_floor = doorway.clone();
    without_floor.surfaces.triangles.retain(|corners| {
        let [a, b, c] = corners.map(|corner| doorway.surfaces.vertices[corner as usize].z);
        a.max(b).max(c) - a.min(b).min(c) > 0.1
    });
    doorway.surfaces.triangles.reverse();
    for world in [doorway, without_floor] {
        let space = free(&world).expect("a room");
        assert!((8.0..9.5).contains(&space.area_m2()), "{}", space.describe());
        assert!(space.contains(Point2::new(2.0, 1.5)) && !space.contains(Point2::new(4.6, 1.5)));
    }
}

#[test]
fn a_room_open_on_one_side_is_found_by_its_floor_and_ceiling() {
    let space = free(&room(3.0, |_| {})).expect("a room");
    assert!(space.area_m2() > 8.0 && space.describe().contains("between a floor and a ceiling"));
    assert!(!space.contains(Point2::new(4.5, 1.5)));
}

#[test]
fn the_smaller_of_two_rooms_is_left_out_and_stated() {
    let world = room(0.0, |room| room.add_solid([2.5, 0.0, 0.0], [2.6, 3.0, 2.5]));
    let space = free(&world).expect("a room");
    assert_eq!(space.other_region_count(), 1);
    assert!(space.contains(Point2::new(1.0, 1.5)) && !space.contains(Point2::new(3.3, 1.5)));
    assert!((1.9..2.3).contains(&space.other_regions_m2()), "{}", space.describe());
}

#[test]
fn samples_fill_the_free_cells_evenly() {
    let space = free(&room(0.0, |_| {})).expect("a room");
    let mut stream = Stream::new(1, "test", 0, 0);
    let samples: Vec<Point2> = (0..20_000).map(|_| space.sample(&mut stream)).collect();
    assert!(samples.iter().all(|&sample| space.contains(sample)));
    let west = samples.iter().filter(|sample| sample.x < 2.0).count();
    assert!((9_700..10_300).contains(&west), "{west}");
}

#[test]
fn worlds_without_room_or_of_absurd_size_are_refused_with_a_remedy() {
    let error = |world: &WireframeWorld| free(world).expect_err("no room").to_string();
    assert!(error(&WireframeWorld::default()).contains("no surfaces"));
    let narrow = room(0.0, |room| {
        for x in [0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5] {
            room.add_solid([x, 0.0, 0.0], [x + 0.1, 3.0, 2.5]);
        }
    });
    assert!(error(&narrow).contains("smaller robot"));
    let mut far = room(0.0, |_| {});
    far.surfaces.vertices[0].x = -3e30;
    assert!(error(&far).contains("larger cells"));
    far.surfaces.vertices[0].x = f32::NAN;
    assert!(free(&far).is_ok());
    let coarse = FreeSpaceOptions { cell_m: 0.0, ..FreeSpaceOptions::default() };
    assert!(FreeSpace::of(&far, &coarse).expect_err("bad").to_string().contains("cell size"));
}

#[test]
fn countless_triangles_across_a_wide_world_are_refused_at_once() {
    let mut surfaces = Surfaces::default();
    for number in 0..3000_u16 {
        let x = f32::from(number) * 0.001;
        let first = surfaces.vertices.len() as u32;
        surfaces.vertices.extend([(x, 0.0), (x + 0.5, 0.0), (x, 1500.0)].map(|(x, y)| Point3::new(x, y, 0.5)));
        surfaces.triangles.push([first, first + 1, first + 2]);
    }
    let world = WireframeWorld { surfaces, ..WireframeWorld::default() };
    let begun = std::time::Instant::now();
    let said = free(&world).expect_err("ninety million steps").to_string();
    assert!(said.contains("50000000") && said.contains("larger cells"), "{said}");
    assert!(begun.elapsed() < std::time::Duration::from_secs(1), "took {:?}", begun.elapsed());
}

#[test]
fn a_closed_room_beside_a_larger_one_is_the_free_space_around_a_place_in_it() {
    // A wall of 0.1 m parts the room at x = 1.2.
    let world = room(0.0, |room| room.add_solid([1.2, 0.0, 0.0], [1.3, 3.0, 2.5]));
    let around = |x, y| FreeSpace::around(&world, &FreeSpaceOptions::default(), Point2::new(x, y));
    let (larger, smaller) = (free(&world).expect("a room"), around(0.6, 1.5).expect("a place in the smaller room"));
    assert!(smaller.area_m2() < larger.area_m2() && !smaller.contains(Point2::new(3.0, 1.5)));
    assert!((smaller.other_regions_m2() - larger.area_m2()).abs() < 1e-9);
    let error = around(1.25, 1.5).expect_err("in the wall");
    assert!(error.to_string().contains("can't stand at 1.25, 1.5 m"), "{error}");
}

//! Worlds of a few boxes, small enough to reason about, as wire-frames with surfaces and as plain node models.
//!
//! The node models and scenes here see through everything: they need no visibility, learning or uncertainty, so that a
//! test of the localiser tests the localiser alone.

use edgeloc::database::{self, NodeModel};
use edgeloc::geometry::{Heading, Point2, Point3, Polarity, Segment2, Segment3, StereoRig};
use edgeloc_sim::random::Stream;
use edgeloc_sim::world::{Surfaces, WireframeWorld};

/// Length, depth and height of the rooms \[m\]; the floor's corner is the origin.
pub const ROOM_SIZE_M: [f32; 3] = [8.0, 6.0, 2.5];

/// A node as a test makes it by hand.
#[derive(Debug, Clone, Default)]
pub struct TinyNode {
    /// Position in the world frame \[m\].
    pub position: Point2,
    /// Segments in the node frame \[m\].
    pub segments: Vec<Segment3>,
}

/// A bare room: twelve edges, walls, floor and ceiling.
#[must_use]
pub fn bare_room() -> WireframeWorld {
    let mut world = WireframeWorld { name: "bare-room".into(), origin: "by hand".into(), ..WireframeWorld::default() };
    add_box(&mut world, [0.0; 3], ROOM_SIZE_M);
    world
}

/// A room with a doorway, 1 m wide and open to an endless plain: walls alone.
#[must_use]
pub fn open_room() -> WireframeWorld {
    let [length, depth, height] = ROOM_SIZE_M;
    let mut world = WireframeWorld { name: "open-room".into(), origin: "by hand".into(), ..WireframeWorld::default() };
    add_box(&mut world, [-0.1, -0.1, 0.0], [length + 0.1, 0.0, height]);
    add_box(&mut world, [-0.1, depth, 0.0], [length + 0.1, depth + 0.1, height]);
    add_box(&mut world, [-0.1, 0.0, 0.0], [0.0, depth, height]);
    add_box(&mut world, [length, 0.0, 0.0], [length + 0.1, 2.5, height]);
    add_box(&mut world, [length, 3.5, 0.0], [length + 0.1, depth, height]);
    world
}

/// The room with a shelf, a table, a crate and a column, no two alike.
#[must_use]
pub fn furnished_room() -> WireframeWorld {
    let mut world = WireframeWorld { name: "furnished-room".into(), ..bare_room() };
    add_box(&mut world, [0.4, 4.9, 0.0], [1.6, 5.3, 1.9]);
    add_box(&mut world, [3.1, 2.4, 0.0], [4.5, 3.2, 0.75]);
    add_box(&mut world, [6.2, 0.7, 0.0], [6.8, 1.4, 0.5]);
    add_box(&mut world, [6.4, 4.1, 0.0], [6.7, 4.4, 2.5]);
    world
}

/// The room with `boxes` boxes drawn at random by `seed`.
#[must_use]
pub fn random_room(seed: u64, boxes: usize) -> WireframeWorld {
    let origin = format!("{boxes} boxes of seed {seed}");
    let mut world = WireframeWorld { name: "random-room".into(), origin, ..bare_room() };
    let mut stream = Stream::new(seed, "boxes", 0, 0);
    for _ in 0..boxes {
        let mut between = |low: f32, high: f32| stream.uniform(f64::from(low), f64::from(high)) as f32;
        let (width, depth, top) = (between(0.2, 1.8), between(0.2, 1.2), between(0.2, 2.4));
        let (x, y) = (between(0.0, ROOM_SIZE_M[0] - width), between(0.0, ROOM_SIZE_M[1] - depth));
        let bottom = between(0.0, 0.5 * top);
        add_box(&mut world, [x, y, bottom], [x + width, y + depth, top]);
    }
    world
}

/// `count` positions in the room, at least 0.4 m from its walls, drawn by `seed`.
#[must_use]
pub fn random_positions(seed: u64, count: usize) -> Vec<Point2> {
    let mut stream = Stream::new(seed, "nodes", 0, 0);
    let mut within = |length: f32| stream.uniform(0.4, f64::from(length) - 0.4) as f32;
    (0..count).map(|_| Point2::new(within(ROOM_SIZE_M[0]), within(ROOM_SIZE_M[1]))).collect()
}

/// A node that knows every edge of the world.
#[must_use]
pub fn all_seeing_node(world: &WireframeWorld, rig: &StereoRig, position: Point2) -> TinyNode {
    let to_node =
        |point: Point3| Point3::new(point.x - position.x, point.y - position.y, point.z - rig.camera_height_m);
    let segments = world.edges.iter().map(|edge| Segment3 {
        start: to_node(edge.start),
        end: to_node(edge.end),
        polarity: edge.polarity,
    });
    TinyNode { position, segments: segments.collect() }
}

/// What the left camera sees of all edges, through everything.
#[must_use]
pub fn all_seeing_scene(world: &WireframeWorld, rig: &StereoRig, position: Point2, heading: Heading) -> Vec<Segment2> {
    let (sin, cos) = edgeloc::math::sin_cos(heading.angle().radians());
    let to_camera = |point: Point3| Point3::new(point.x * sin - point.y * cos, -point.z, point.x * cos + point.y * sin);
    let node = all_seeing_node(world, rig, position);
    let in_camera = node.segments.iter().map(|segment| Segment3 {
        start: to_camera(segment.start),
        end: to_camera(segment.end),
        polarity: segment.polarity,
    });
    in_camera.filter_map(|segment| rig.camera.project_segment(&segment, rig.near_limit_m)).collect()
}

/// The database of `nodes`, as bytes.
#[must_use]
pub fn database_bytes(rig: &StereoRig, nodes: &[TinyNode]) -> Vec<u8> {
    let models: Vec<NodeModel<'_>> =
        nodes.iter().map(|node| NodeModel { position: node.position, segments: &node.segments }).collect();
    let mut bytes = vec![0; database::encoded_len(&models).expect("a tiny world fits the format")];
    database::write(rig, 12, &models, &mut bytes).expect("a tiny world is valid");
    bytes
}

/// Adds the twelve edges and twelve triangles of an upright box.
fn add_box(world: &mut WireframeWorld, low: [f32; 3], high: [f32; 3]) {
    let corner = |index: usize| {
        let coordinate = |axis: usize| if index >> axis & 1 == 0 { low[axis] } else { high[axis] };
        Point3::new(coordinate(0), coordinate(1), coordinate(2))
    };
    let first_vertex = world.surfaces.vertices.len() as u32;
    world.surfaces.vertices.extend((0..8).map(corner));
    for axis in 0..3 {
        for index in (0..8).filter(|index| index >> axis & 1 == 0) {
            // Both contrasts occur, in no pattern that the order of the end points would tell.
            let polarity = if (index + axis) % 3 == 0 { Polarity::RightBrighter } else { Polarity::LeftBrighter };
            world.edges.push(Segment3 { start: corner(index), end: corner(index | 1 << axis), polarity });
        }
        let (second, third) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
        for face in [0, 1 << axis] {
            let vertex = |index: usize| first_vertex + index as u32;
            let Surfaces { triangles, .. } = &mut world.surfaces;
            triangles.push([vertex(face), vertex(face | second), vertex(face | third)]);
            triangles.push([vertex(face | second), vertex(face | second | third), vertex(face | third)]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_has_twelve_edges_and_twelve_triangles_of_its_own_size() {
        let world = bare_room();
        assert_eq!((world.edges.len(), world.surfaces.triangles.len()), (12, 12));
        let total: f32 = world.edges.iter().map(Segment3::length_m).sum();
        assert!((total - 4.0 * ROOM_SIZE_M.iter().sum::<f32>()).abs() < 1e-4);
        let area = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(|index| world.surfaces.vertices[index as usize]);
            let (u, v) = ([b.x - a.x, b.y - a.y, b.z - a.z], [c.x - a.x, c.y - a.y, c.z - a.z]);
            let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
            0.5 * cross.iter().map(|x| x * x).sum::<f32>().sqrt()
        };
        let surface: f32 = world.surfaces.triangles.iter().map(|&triangle| area(triangle)).sum();
        let [length, depth, height] = ROOM_SIZE_M;
        assert!((surface - 2.0 * (length * depth + depth * height + height * length)).abs() < 1e-3);
    }
}

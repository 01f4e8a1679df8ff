//! A generated office of 20 x 15 x 2.5 m: the kind of place the paper modelled by hand (section 4.1).
//!
//! Rooms lie on both sides of a corridor and are furnished from the same few templates, so that each looks much like
//! the next: the worst case for localisation. The seed decides where walls, doors and furniture stand, never what a
//! desk looks like. At the end clutter (books, papers, boxes) is dealt out at random until the world holds
//! [`OfficeOptions::edge_count`] edges.

mod building;
mod clutter;
mod furniture;
mod joinery;
mod layout;
mod room;
mod walls;

use super::WireframeWorld;
use super::template::Placement;
use crate::random::Stream;
use clutter::Clutter;
use furniture::Furniture;
use layout::Layout;
use room::Furnisher;

/// Length of the office along x, between the outer walls \[m\].
pub const LENGTH_M: f32 = 20.0;

/// Depth of the office along y, between the outer walls \[m\].
pub const DEPTH_M: f32 = 15.0;

/// Height from the floor to the ceiling \[m\].
pub const HEIGHT_M: f32 = 2.5;

/// What decides a generated office.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OfficeOptions {
    /// Decides the layout, the furniture of each room and the clutter. Same seed, same world, bit for bit.
    pub seed: u64,
    /// Clutter is added until the world holds this many edges; an office holds about 5,300 before and 9,200 with
    /// every shelf full, and is left as it is outside of that range.
    pub edge_count: usize,
}

impl Default for OfficeOptions {
    /// Seed 1 and the paper's 7000 edges.
    fn default() -> Self {
        Self { seed: 1, edge_count: 7000 }
    }
}

/// Builds and furnishes the office that `options` ask for.
#[must_use]
pub fn generate(options: &OfficeOptions) -> WireframeWorld {
    let mut world = WireframeWorld {
        name: format!("office-{}", options.seed),
        origin: format!("generated office, seed {}, {} edges asked for", options.seed, options.edge_count),
        ..WireframeWorld::default()
    };
    let layout = Layout::draw(&mut Stream::new(options.seed, "layout", 0, 0));
    building::shell(&layout).place(&Placement::at(0.0, 0.0, 0.0), &mut world);
    joinery::place(&layout, &mut world);
    let furniture = Furniture::new();
    let mut clutter = Clutter::new();
    let stream = |room: usize| Stream::new(options.seed, "furnish", room as u64, 0);
    for (index, room) in layout.rooms.iter().enumerate() {
        Furnisher::room(room, &furniture, stream(index), &mut world, &mut clutter).furnish_room(room);
    }
    let in_corridor = stream(layout.rooms.len());
    Furnisher::corridor(&layout, &furniture, in_corridor, &mut world, &mut clutter).furnish_corridor();
    clutter.deal_out(options.edge_count, &mut Stream::new(options.seed, "clutter", 0, 0), &mut world);
    world
}

#[cfg(test)]
mod tests {
    use super::*;
    use edgeloc::geometry::{Point3, Polarity};

    fn office(seed: u64) -> WireframeWorld {
        generate(&OfficeOptions { seed, ..OfficeOptions::default() })
    }

    #[test]
    fn every_seed_gives_about_7000_edges() {
        for seed in 1..=20 {
            let count = office(seed).edges.len();
            assert!((6_900..=7_100).contains(&count), "seed {seed}: {count}");
        }
    }

    #[test]
    fn the_same_seed_gives_the_same_world_bit_for_bit_and_another_seed_another() {
        assert_eq!(office(3), office(3));
        let (a, b) = (office(3), office(4));
        let common = a.edges.iter().filter(|edge| b.edges.contains(edge)).count();
        assert!(common < a.edges.len() / 4, "{common} common edges");
    }

    #[test]
    fn all_edges_lie_within_the_walls_and_either_side_is_the_brighter_as_often() {
        let world = office(1);
        let inside = |p: Point3| {
            (-0.2..=LENGTH_M + 0.2).contains(&p.x)
                && (-0.2..=DEPTH_M + 0.2).contains(&p.y)
                && (-1e-4..=HEIGHT_M).contains(&p.z)
        };
        assert!(world.edges.iter().all(|edge| inside(edge.start) && inside(edge.end) && edge.length_m() > 0.005));
        let left = world.edges.iter().filter(|edge| edge.polarity == Polarity::LeftBrighter).count();
        assert!((2_800..4_200).contains(&left), "{left} of {}", world.edges.len());
    }

    #[test]
    fn every_edge_lies_on_a_surface() {
        let world = office(2);
        let triangles: Vec<[Point3; 3]> = world
            .surfaces
            .triangles
            .iter()
            .map(|corners| corners.map(|corner| world.surfaces.vertices[corner as usize]))
            .collect();
        for edge in &world.edges {
            let sample = edge.start.lerp(edge.end, 0.37);
            assert!(triangles.iter().any(|triangle| holds(triangle, sample)), "{edge:?} hangs in the air");
        }
    }

    /// Whether a point is within a millimetre of a triangle, the border stretched by as much.
    fn holds([a, b, c]: &[Point3; 3], p: Point3) -> bool {
        let minus = |p: Point3, q: Point3| Point3::new(p.x - q.x, p.y - q.y, p.z - q.z);
        let dot = |p: Point3, q: Point3| p.x * q.x + p.y * q.y + p.z * q.z;
        let (u, v, w) = (minus(*b, *a), minus(*c, *a), minus(p, *a));
        let (uu, uv, vv, wu, wv) = (dot(u, u), dot(u, v), dot(v, v), dot(w, u), dot(w, v));
        let scale = 1.0 / (uu * vv - uv * uv);
        let (s, t) = ((vv * wu - uv * wv) * scale, (uu * wv - uv * wu) * scale);
        let foot = Point3::new(a.x + s * u.x + t * v.x, a.y + s * u.y + t * v.y, a.z + s * u.z + t * v.z);
        s > -0.01 && t > -0.01 && s + t < 1.01 && foot.distance(p) < 1e-3
    }
}

//! The primitive shapes of SDF as meshes, centred on their own origin, in metres.

use super::super::mesh::{MID_GREY, Triangle, TriangleMesh};
use super::placement::Placement;
use nalgebra::Vector3;

/// Sides of a round shape: 11.25 degrees each, well below the crease angle, so that only rims are edges.
const SIDES: u32 = 32;

/// A box of the given size.
pub(super) fn cuboid(size: Vector3<f64>) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for corner in 0..8_u32 {
        let half = |axis: u32| if corner >> axis & 1 == 1 { 0.5 } else { -0.5 };
        mesh.push_vertex(Vector3::new(half(0), half(1), half(2)).component_mul(&size));
    }
    for [a, b, c, d] in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        push_quad(&mut mesh, [a, b, c, d]);
    }
    mesh
}

/// An upright cylinder.
pub(super) fn cylinder(radius_m: f64, length_m: f64) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let bottom = ring(&mut mesh, radius_m, -length_m / 2.0);
    let top = ring(&mut mesh, radius_m, length_m / 2.0);
    let bottom_center = mesh.push_vertex(Vector3::new(0.0, 0.0, -length_m / 2.0));
    let top_center = mesh.push_vertex(Vector3::new(0.0, 0.0, length_m / 2.0));
    push_band(&mut mesh, bottom, top);
    push_fan(&mut mesh, top_center, top, false);
    push_fan(&mut mesh, bottom_center, bottom, true);
    mesh
}

/// A sphere.
pub(super) fn sphere(radius_m: f64) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let south = mesh.push_vertex(Vector3::new(0.0, 0.0, -radius_m));
    let bands = SIDES / 2;
    let rings: Vec<u32> = (1..bands)
        .map(|band| {
            let latitude = core::f64::consts::PI * (f64::from(band) / f64::from(bands) - 0.5);
            ring(&mut mesh, radius_m * libm::cos(latitude), radius_m * libm::sin(latitude))
        })
        .collect();
    let north = mesh.push_vertex(Vector3::new(0.0, 0.0, radius_m));
    for pair in rings.windows(2) {
        push_band(&mut mesh, pair[0], pair[1]);
    }
    push_fan(&mut mesh, south, rings[0], true);
    push_fan(&mut mesh, north, rings[rings.len() - 1], false);
    mesh
}

/// A rectangle across `normal` of the given size; a zero normal counts as up.
pub(super) fn plane(normal: Vector3<f64>, size: [f64; 2]) -> TriangleMesh {
    let normal = normal.try_normalize(0.0).unwrap_or(Vector3::z());
    // The shortest turn from z to the normal, as Gazebo lays a plane; about x when they are opposite.
    let across = Vector3::z().cross(&normal);
    let axis = if across.norm() < 1e-9 { Vector3::x() } else { across };
    let turn = Placement::rotation(axis, libm::atan2(across.norm(), normal.z));
    let mut mesh = TriangleMesh::default();
    for (along_x, along_y) in [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)] {
        mesh.push_vertex(turn.apply(Vector3::new(along_x * size[0], along_y * size[1], 0.0)));
    }
    push_quad(&mut mesh, [0, 1, 2, 3]);
    mesh
}

/// Adds a ring of [`SIDES`] vertices and gives the first's index.
fn ring(mesh: &mut TriangleMesh, radius_m: f64, z: f64) -> u32 {
    let first = u32::try_from(mesh.vertices.len()).expect("primitives are small");
    for side in 0..SIDES {
        let angle = core::f64::consts::TAU * f64::from(side) / f64::from(SIDES);
        mesh.push_vertex(Vector3::new(radius_m * libm::cos(angle), radius_m * libm::sin(angle), z));
    }
    first
}

fn push_band(mesh: &mut TriangleMesh, lower: u32, upper: u32) {
    for side in 0..SIDES {
        let next = (side + 1) % SIDES;
        push_quad(mesh, [lower + side, lower + next, upper + next, upper + side]);
    }
}

fn push_fan(mesh: &mut TriangleMesh, center: u32, ring: u32, faces_down: bool) {
    for side in 0..SIDES {
        let (a, b) = (ring + side, ring + (side + 1) % SIDES);
        push_triangle(mesh, if faces_down { [center, b, a] } else { [center, a, b] });
    }
}

fn push_quad(mesh: &mut TriangleMesh, [a, b, c, d]: [u32; 4]) {
    push_triangle(mesh, [a, b, c]);
    push_triangle(mesh, [a, c, d]);
}

fn push_triangle(mesh: &mut TriangleMesh, corners: [u32; 3]) {
    mesh.triangles.push(Triangle { corners, reflectance: MID_GREY });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::crease::extract;

    /// Six times the volume inside the triangles, positive when all fronts face outwards.
    fn volume(mesh: &TriangleMesh) -> f64 {
        let corner = |index: u32| mesh.vertices[index as usize];
        mesh.triangles
            .iter()
            .map(|t| corner(t.corners[0]).dot(&corner(t.corners[1]).cross(&corner(t.corners[2]))))
            .sum::<f64>()
            / 6.0
    }

    #[test]
    fn primitives_enclose_their_volume() {
        assert!((volume(&cuboid(Vector3::new(1.0, 2.0, 3.0))) - 6.0).abs() < 1e-12);
        assert!((volume(&cylinder(1.0, 2.0)) - core::f64::consts::TAU).abs() < 0.05);
        assert!((volume(&sphere(1.0)) - 4.19).abs() < 0.12);
    }

    #[test]
    fn a_box_has_twelve_edges_a_sphere_none_and_a_cylinder_its_rims() {
        let count = |mesh: &TriangleMesh| extract(mesh, 30.0).segments.len();
        assert_eq!(count(&cuboid(Vector3::new(1.0, 2.0, 3.0))), 12);
        assert_eq!(count(&sphere(0.31)), 0);
        assert_eq!(count(&cylinder(0.5, 1.0)), 64);
        assert_eq!(count(&plane(Vector3::z(), [1.0, 2.0])), 4);
    }

    #[test]
    fn a_plane_faces_its_normal() {
        for normal in [Vector3::x(), -Vector3::z(), Vector3::new(1.0, 2.0, -0.5), Vector3::y()] {
            let mesh = plane(normal, [2.0, 2.0]);
            let [a, b, c] = mesh.triangles[0].corners.map(|index| mesh.vertices[index as usize]);
            let front = (b - a).cross(&(c - a)).normalize();
            assert!((front - normal.normalize()).norm() < 1e-12);
        }
    }
}

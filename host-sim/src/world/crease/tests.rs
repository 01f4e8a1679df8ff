//! Claims about the wire-frame of small hand-made meshes.

use super::*;
use crate::world::mesh::{MID_GREY, Triangle};

fn mesh(points: &[[f64; 3]], faces: &[[u32; 3]]) -> TriangleMesh {
    TriangleMesh {
        vertices: points.iter().copied().map(Vector3::from).collect(),
        triangles: faces.iter().map(|&corners| Triangle { corners, reflectance: MID_GREY }).collect(),
        lines: Vec::new(),
    }
}

/// Two rectangles that share the edge from the origin to (0, 1, 0); the second leans `degrees` out of the plane.
fn hinge(degrees: f64) -> TriangleMesh {
    let (sin, cos) = (libm::sin(degrees.to_radians()), libm::cos(degrees.to_radians()));
    let points =
        [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [cos, 0.0, sin], [cos, 1.0, sin]];
    mesh(&points, &[[0, 1, 2], [1, 3, 2], [0, 4, 1], [1, 4, 5]])
}

#[test]
fn an_edge_shows_beyond_the_crease_angle_only() {
    assert_eq!(extract(&hinge(0.0), 30.0).segments.len(), 4);
    assert_eq!(extract(&hinge(29.0), 30.0).segments.len(), 6);
    assert_eq!(extract(&hinge(31.0), 30.0).segments.len(), 7);
    let shared = |degrees: f64| {
        let origin = Point3::new(0.0, 0.0, 0.0);
        extract(&hinge(degrees), 30.0).segments.iter().any(|edge| edge.start == origin && edge.end.y > 0.5)
    };
    assert!(!shared(29.0) && shared(31.0) && shared(-31.0));
}

#[test]
fn winding_does_not_decide_what_shows() {
    for degrees in [0.0, 10.0, 29.0, 31.0, 90.0] {
        let straight = hinge(degrees);
        let mut turned = straight.clone();
        turned.triangles[2].corners.swap(0, 1);
        turned.triangles[3].corners.swap(0, 1);
        assert_eq!(extract(&straight, 30.0).segments.len(), extract(&turned, 30.0).segments.len());
    }
}

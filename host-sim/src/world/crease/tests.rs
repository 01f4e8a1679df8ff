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

/// A unit cube with its fronts outside.
fn cube() -> TriangleMesh {
    let points: Vec<[f64; 3]> = (0..8_u8).map(|corner| [0, 1, 2].map(|axis| f64::from(corner >> axis & 1))).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    mesh(&points, &quads.map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).concat())
}

fn polarity_of(extraction: &Extraction, start: [f32; 3], end: [f32; 3]) -> Polarity {
    let (start, end) = (Point3::new(start[0], start[1], start[2]), Point3::new(end[0], end[1], end[2]));
    extraction.segments.iter().find(|edge| edge.start == start && edge.end == end).expect("the edge shows").polarity
}

#[test]
fn the_top_of_a_cube_is_brighter_than_its_sides() {
    // Both edges run along +y. Seen from outside, the top lies to the left of the one at x = 1 and to the right of
    // the one at x = 0.
    let extraction = extract(&cube(), 30.0);
    assert_eq!(extraction.segments.len(), 12);
    assert_eq!(polarity_of(&extraction, [1.0, 0.0, 1.0], [1.0, 1.0, 1.0]), Polarity::LeftBrighter);
    assert_eq!(polarity_of(&extraction, [0.0, 0.0, 1.0], [0.0, 1.0, 1.0]), Polarity::RightBrighter);
}

#[test]
fn a_black_top_turns_the_contrast() {
    let mut cube = cube();
    cube.triangles[2].reflectance = 0.0;
    cube.triangles[3].reflectance = 0.0;
    let extraction = extract(&cube, 30.0);
    assert_eq!(polarity_of(&extraction, [1.0, 0.0, 1.0], [1.0, 1.0, 1.0]), Polarity::RightBrighter);
}

#[test]
fn equal_sides_are_told_apart_by_their_geometry_alone() {
    let line = |z: f64| TriangleMesh {
        vertices: vec![Vector3::new(0.0, 0.0, z), Vector3::new(1.0, 0.0, z)],
        lines: vec![[0, 1], [1, 0]],
        ..TriangleMesh::default()
    };
    let polarity = |z: f64| extract(&line(z), 30.0).segments[0].polarity;
    let left = (0..200).filter(|&step| polarity(f64::from(step) * 0.01) == Polarity::LeftBrighter).count();
    assert!((60..140).contains(&left), "{left} of 200 are brighter to the left");
    assert_eq!(polarity(0.5), polarity(0.5));
}

#[test]
fn collinear_and_overlapping_edges_become_one_and_bent_ones_do_not() {
    let lines = |points: &[[f64; 3]], lines: &[[u32; 2]]| {
        let vertices = points.iter().copied().map(Vector3::from).collect();
        extract(&TriangleMesh { vertices, lines: lines.to_vec(), ..TriangleMesh::default() }, 30.0).segments
    };
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [2.0, 0.0, 0.0], [5.0, 0.0, 0.0], [6.0, 0.3, 0.0]];
    // A chain, a piece inside another and one that reaches beyond are one segment of 5 m; the bent one is apart.
    let merged = lines(&points, &[[0, 1], [1, 2], [1, 3], [3, 4], [4, 5]]);
    assert_eq!(
        merged.iter().map(Segment3::length_m).map(|length| (length * 10.0) as i32).collect::<Vec<_>>(),
        [50, 10]
    );
    // Pieces with a gap stay apart.
    assert_eq!(lines(&points, &[[0, 1], [2, 4]]).len(), 2);
    // A circle of 90 pieces bends by 4 degrees at each.
    let circle: Vec<[f64; 3]> = (0..90)
        .map(|step| f64::from(step) * core::f64::consts::TAU / 90.0)
        .map(|angle| [libm::cos(angle), libm::sin(angle), 0.0])
        .collect();
    let around: Vec<[u32; 2]> = (0..90).map(|step| [step, (step + 1) % 90]).collect();
    assert_eq!(lines(&circle, &around).len(), 90);
}

#[test]
fn back_to_back_and_empty_faces_leave_one_clean_surface() {
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0004, 0.0, 0.0], [2.0, 0.0, 0.0]];
    let extraction = extract(&mesh(&points, &[[0, 1, 2], [2, 1, 3], [0, 1, 4], [0, 3, 1]]), 30.0);
    assert_eq!(extraction.triangles, [[0, 1, 2]]);
    assert_eq!(extraction.segments.len(), 3);
}

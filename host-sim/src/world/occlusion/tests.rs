//! The hierarchy against every triangle in turn, and what it makes of copies.

use super::*;
use crate::random::Stream;

/// Triangles of sides up to `size_m` in a cube of 10 m, every fourth along two axes, with some copies.
fn random_triangles(stream: &mut Stream, count: usize, size_m: f64) -> Surfaces {
    let mut surfaces = Surfaces::default();
    for number in 0..count {
        let mut draw = |reach: f64| stream.uniform(-reach, reach) as f32;
        let center = [draw(5.0), draw(5.0), draw(5.0)];
        let first = surfaces.vertices.len() as u32;
        for _ in 0..3 {
            let [x, y, mut z] = center.map(|middle| middle + draw(size_m));
            if number % 4 == 0 {
                z = center[2];
            }
            surfaces.vertices.push(Point3::new(x, y, z));
        }
        let copies = if number % 7 == 0 { 5 } else { 1 };
        surfaces.triangles.extend([[first, first + 1, first + 2]].repeat(copies));
    }
    surfaces
}

/// What the hierarchy must answer: every triangle is asked.
fn is_visible_past_all(surfaces: &Surfaces, from: Point3, to: Point3) -> bool {
    let mut triangles = surfaces.triangles.iter().filter_map(|corners| RayTriangle::new(surfaces, corners));
    Ray::new(from, to).is_none_or(|ray| !triangles.any(|triangle| triangle.blocks(&ray)))
}

#[test]
fn the_hierarchy_answers_as_asking_every_triangle_does() {
    let mut stream = Stream::new(1, "rays", 0, 0);
    let mut visible_count = 0;
    for (count, size_m) in [(0, 1.0), (1, 5.0), (4, 5.0), (40, 2.0), (300, 0.5), (300, 3.0), (1000, 0.1)] {
        let surfaces = random_triangles(&mut stream, count, size_m);
        let occluders = Occluders::new(&surfaces);
        for number in 0..1000 {
            let mut point = || [0; 3].map(|_| stream.uniform(-7.0, 7.0) as f32);
            let (from, mut to) = (point(), point());
            // Rays along a plane and along an axis, on which the boxes are entered by infinite slopes.
            let shared = number % 3;
            to[..shared].copy_from_slice(&from[..shared]);
            let [from, to] = [from, to].map(|[x, y, z]| Point3::new(x, y, z));
            let expected = is_visible_past_all(&surfaces, from, to);
            assert_eq!(occluders.is_visible(from, to), expected, "{count} of {size_m} m: {from:?} to {to:?}");
            visible_count += usize::from(expected);
        }
    }
    assert!((2000..6500).contains(&visible_count), "{visible_count} of 7000: both answers should be common");
}

#[test]
fn a_triangle_copied_countless_times_is_asked_once() {
    let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)];
    let vertices = corners.map(|(x, y)| Point3::new(x, y, x)).to_vec();
    let mut triangles = vec![[0, 1, 2]; 200_000];
    triangles.push([1, 2, 0]);
    let occluders = Occluders::new(&Surfaces { vertices, triangles });
    let [only] = &occluders.nodes[..] else { panic!("coinciding centres can't be split") };
    assert_eq!(only.triangle_count, 2, "the copies, and the one that begins at another corner");
    let through = |x: f32, y: f32| occluders.is_visible(Point3::new(x, y, 2.0), Point3::new(x, y, -2.0));
    assert!(!through(0.3, 0.3) && through(0.8, 0.8));
}

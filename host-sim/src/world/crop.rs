//! One wing of a building: what lies within a rectangle of the floor, from floor to ceiling.
//!
//! Edges and surfaces are cut at the rectangle (Sutherland and Hodgman 1974), so a corridor that leaves it ends open.

use super::{Surfaces, WireframeWorld};
use edgeloc::geometry::{Point2, Point3, Segment3};

/// A rectangle of the floor, world frame \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rectangle {
    /// The corner of least x and y.
    pub min: Point2,
    /// The corner of greatest x and y.
    pub max: Point2,
}

/// Edges that are cut shorter than this are left out \[m\].
const SHORTEST_M: f32 = 0.05;

/// The part of `world` within `rectangle`, under the name `name`.
///
/// Reference viewpoints are made for a whole world and are left out.
#[must_use]
pub fn crop(world: &WireframeWorld, rectangle: &Rectangle, name: String) -> WireframeWorld {
    let Rectangle { min, max } = rectangle;
    let origin = format!("{}, cropped to {},{},{},{} m", world.origin, min.x, min.y, max.x, max.y);
    let edges = world.edges.iter().filter_map(|edge| {
        let [start, end] = cut_polygon(&[edge.start, edge.end], rectangle).try_into().ok()?;
        (start.distance(end) >= SHORTEST_M).then_some(Segment3 { start, end, ..*edge })
    });
    WireframeWorld {
        name,
        origin,
        edges: edges.collect(),
        surfaces: crop_surfaces(&world.surfaces, rectangle),
        reference_viewpoints: None,
    }
}

fn crop_surfaces(surfaces: &Surfaces, rectangle: &Rectangle) -> Surfaces {
    let mut cropped = Surfaces::default();
    for triangle in &surfaces.triangles {
        let corners = cut_polygon(&triangle.map(|corner| surfaces.vertices[corner as usize]), rectangle);
        let first = cropped.vertices.len() as u32;
        let count = corners.len() as u32;
        if count >= 3 {
            cropped.vertices.extend(corners);
            cropped.triangles.extend((1..count - 1).map(|corner| [first, first + corner, first + corner + 1]));
        }
    }
    cropped
}

/// The part of a convex polygon, or of a line given by its two ends, within the rectangle.
fn cut_polygon(corners: &[Point3], rectangle: &Rectangle) -> Vec<Point3> {
    let Rectangle { min, max } = *rectangle;
    let sides: [&dyn Fn(&Point3) -> f32; 4] = [&|p| p.x - min.x, &|p| max.x - p.x, &|p| p.y - min.y, &|p| max.y - p.y];
    let mut corners = corners.to_vec();
    let is_line = corners.len() == 2;
    for inside in sides {
        let mut left = Vec::with_capacity(corners.len() + 1);
        for (index, corner) in corners.iter().enumerate() {
            let next = &corners[(index + 1) % corners.len()];
            let (here, there) = (inside(corner), inside(next));
            if here >= 0.0 {
                left.push(*corner);
            }
            // The way back of a line would cut it a second time.
            if (here < 0.0) != (there < 0.0) && !(is_line && index == 1) {
                left.push(corner.lerp(*next, here / (here - there)));
            }
        }
        corners = left;
    }
    corners
}

#[cfg(test)]
mod tests {
    use super::*;
    use edgeloc::geometry::Polarity;

    const HALL: Rectangle = Rectangle { min: Point2::new(0.0, 0.0), max: Point2::new(4.0, 3.0) };

    fn world() -> WireframeWorld {
        let point = Point3::new;
        let edge = |start, end| Segment3 { start, end, polarity: Polarity::RightBrighter };
        WireframeWorld {
            edges: vec![
                edge(point(1.0, 1.0, 0.0), point(1.0, 1.0, 2.5)),
                edge(point(-2.0, 1.0, 0.0), point(6.0, 1.0, 0.0)),
                edge(point(5.0, 1.0, 0.0), point(5.0, 1.0, 2.5)),
                edge(point(3.99, 1.0, 1.0), point(5.0, 1.0, 1.0)),
            ],
            surfaces: Surfaces {
                vertices: vec![
                    point(-10.0, -10.0, 0.0),
                    point(30.0, -10.0, 0.0),
                    point(-10.0, 30.0, 0.0),
                    point(9.0, 9.0, 1.0),
                ],
                triangles: vec![[0, 1, 2], [1, 2, 3]],
            },
            ..WireframeWorld::default()
        }
    }

    #[test]
    fn edges_end_at_the_rectangle_and_keep_their_polarity() {
        let cropped = crop(&world(), &HALL, "hall".to_owned());
        let ends: Vec<[f32; 2]> = cropped.edges.iter().map(|edge| [edge.start.x, edge.end.x]).collect();
        assert_eq!(ends, [[1.0, 1.0], [0.0, 4.0]]);
        assert!(cropped.edges.iter().all(|edge| edge.polarity == Polarity::RightBrighter));
    }

    #[test]
    fn a_floor_is_cut_to_the_area_of_the_rectangle() {
        let Surfaces { vertices, triangles } = crop(&world(), &HALL, "hall".to_owned()).surfaces;
        let area = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(|corner| vertices[corner as usize]);
            0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)).abs()
        };
        let total: f32 = triangles.iter().map(|triangle| area(*triangle)).sum();
        assert!((total - 12.0).abs() < 1e-4, "{total}");
    }
}

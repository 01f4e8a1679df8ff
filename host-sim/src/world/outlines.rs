//! What of a world's surfaces a robot could touch, seen from above: straight sides in square buckets.
//!
//! Every triangle is cut to a slice of heights, and the sides of what is left are kept as they lie on the floor. So a
//! table top in the slice stands in the way although there is air below it, and a doorstep below the slice does not.

use super::Surfaces;
use super::free_space::{Slab, outline, triangles};
use edgeloc::geometry::{GridWalk, Point2};

/// Side of a bucket \[m\].
const BUCKET_M: f32 = 0.1;

/// The most buckets along both sides together multiplied; beyond that they grow.
const MAX_BUCKETS: f32 = 4e6;

/// The sides of all surfaces in a slice of heights, ready to be looked at and bumped into.
#[derive(Debug, Clone)]
pub struct Outlines {
    west: f32,
    south: f32,
    bucket_m: f32,
    width: usize,
    height: usize,
    sides: Vec<[Point2; 2]>,
    /// For each bucket where its sides begin in `members`, and one more.
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl Outlines {
    /// The sides of `surfaces` between two heights \[m\].
    #[must_use]
    pub fn new(surfaces: &Surfaces, slice_m: (f32, f32)) -> Self {
        Self::with_closed(surfaces, slice_m, &[])
    }

    /// The sides of `surfaces` between two heights \[m\], and what is closed beside them, as by a door.
    #[must_use]
    pub fn with_closed(surfaces: &Surfaces, slice_m: (f32, f32), closed: &[[Point2; 2]]) -> Self {
        let slab = Slab { low: f64::from(slice_m.0), high: f64::from(slice_m.1) };
        let mut sides: Vec<[Point2; 2]> = triangles(surfaces)
            .flat_map(|triangle| outline(&triangle, slab))
            .map(|side| side.map(|[x, y]| Point2::new(x as f32, y as f32)))
            .chain(closed.iter().copied())
            .map(|[a, b]| if (b.x, b.y) < (a.x, a.y) { [b, a] } else { [a, b] })
            .collect();
        let bits = |[a, b]: &[Point2; 2]| [a.x, a.y, b.x, b.y].map(f32::to_bits);
        sides.sort_unstable_by_key(bits);
        sides.dedup_by_key(|side| bits(side));
        let ((west, south), (east, north)) = bounds(&sides);
        let (width_m, height_m) = (east - west, north - south);
        let bucket_m = BUCKET_M.max((width_m * height_m / MAX_BUCKETS).sqrt()).max(width_m.max(height_m) / MAX_BUCKETS);
        let count = |length_m: f32| (length_m / bucket_m) as usize + 1;
        let (width, height) = (count(width_m), count(height_m));
        let mut outlines =
            Self { west, south, bucket_m, width, height, sides, starts: Vec::new(), members: Vec::new() };
        outlines.fill_buckets();
        outlines
    }

    /// The longer side of a rectangle around all of it \[m\].
    #[must_use]
    pub fn extent_m(&self) -> f32 {
        let ((west, south), (east, north)) = bounds(&self.sides);
        (east - west).max(north - south)
    }

    /// Distance along a unit `direction` to the first side, if that is within `reach_m`.
    #[must_use]
    pub fn range_m(&self, from: Point2, direction: (f32, f32), reach_m: f32) -> Option<f32> {
        let start = [(from.x - self.west) / self.bucket_m, (from.y - self.south) / self.bucket_m];
        let mut walk = GridWalk::new(start, [direction.0, direction.1], self.bucket_m);
        let mut nearest = f32::INFINITY;
        while walk.entered <= reach_m {
            if let Some(bucket) = self.bucket(walk.cell[0].into(), walk.cell[1].into()) {
                for &side in self.members_of(bucket) {
                    let met = meets(from, direction, &self.sides[side as usize]);
                    nearest = if met < nearest { met } else { nearest };
                }
            }
            if nearest <= walk.leaves() {
                return (nearest <= reach_m).then_some(nearest);
            }
            walk.advance();
        }
        None
    }

    /// Distance from a point to the nearest side \[m\], at most `reach_m`.
    #[must_use]
    pub fn clearance_m(&self, point: Point2, reach_m: f32) -> f32 {
        let index = |along: f32| libm::floorf(along / self.bucket_m) as i64;
        let (columns, rows) = (
            index(point.x - reach_m - self.west)..=index(point.x + reach_m - self.west),
            index(point.y - reach_m - self.south)..=index(point.y + reach_m - self.south),
        );
        let mut nearest = reach_m;
        for row in rows {
            for bucket in columns.clone().filter_map(|column| self.bucket(column, row)) {
                for &side in self.members_of(bucket) {
                    nearest = nearest.min(distance(point, &self.sides[side as usize]));
                }
            }
        }
        nearest
    }

    fn bucket(&self, column: i64, row: i64) -> Option<usize> {
        let is_inside = (0..self.width as i64).contains(&column) && (0..self.height as i64).contains(&row);
        is_inside.then(|| row as usize * self.width + column as usize)
    }

    fn members_of(&self, bucket: usize) -> &[u32] {
        &self.members[self.starts[bucket] as usize..self.starts[bucket + 1] as usize]
    }

    /// Sorts the sides into the buckets they touch, counting first.
    fn fill_buckets(&mut self) {
        let mut starts = vec![0_u32; self.width * self.height + 1];
        for side in &self.sides {
            self.for_buckets(side, |bucket| starts[bucket + 1] += 1);
        }
        for bucket in 1..starts.len() {
            starts[bucket] += starts[bucket - 1];
        }
        let mut next = starts.clone();
        let mut members = vec![0; starts.last().copied().unwrap_or(0) as usize];
        for (number, side) in (0_u32..).zip(&self.sides) {
            self.for_buckets(side, |bucket| {
                members[next[bucket] as usize] = number;
                next[bucket] += 1;
            });
        }
        (self.starts, self.members) = (starts, members);
    }

    /// The buckets that a side touches, a hair's breadth more: row by row the part of the side in it.
    fn for_buckets(&self, [a, b]: &[Point2; 2], mut touch: impl FnMut(usize)) {
        const HAIR_M: f32 = 1e-4;
        let index =
            |along: f32, count: usize| libm::floorf(along / self.bucket_m).clamp(0.0, count as f32 - 1.0) as usize;
        let (low, high) = (a.y.min(b.y) - HAIR_M, a.y.max(b.y) + HAIR_M);
        for row in index(low - self.south, self.height)..=index(high - self.south, self.height) {
            let (south, north) = (
                self.south + row as f32 * self.bucket_m - HAIR_M,
                self.south + (row + 1) as f32 * self.bucket_m + HAIR_M,
            );
            let at = |y: f32| {
                let t = if (b.y - a.y).abs() < HAIR_M { f32::NAN } else { ((y - a.y) / (b.y - a.y)).clamp(0.0, 1.0) };
                a.x + (b.x - a.x) * t
            };
            let (first, last) = (at(south), at(north));
            let (west, east) = if first.is_nan() || last.is_nan() {
                (a.x.min(b.x), a.x.max(b.x))
            } else {
                (first.min(last), first.max(last))
            };
            let columns = index(west - HAIR_M - self.west, self.width)..=index(east + HAIR_M - self.west, self.width);
            for column in columns {
                touch(row * self.width + column);
            }
        }
    }
}

/// Least and greatest coordinates; zeros when there is nothing.
fn bounds(sides: &[[Point2; 2]]) -> ((f32, f32), (f32, f32)) {
    let Some([first, _]) = sides.first() else { return ((0.0, 0.0), (0.0, 0.0)) };
    sides.iter().flatten().fold(((first.x, first.y), (first.x, first.y)), |(low, high), corner| {
        ((low.0.min(corner.x), low.1.min(corner.y)), (high.0.max(corner.x), high.1.max(corner.y)))
    })
}

/// Where a ray meets a side; infinity when it does not.
fn meets(from: Point2, direction: (f32, f32), [a, b]: &[Point2; 2]) -> f32 {
    let side = (b.x - a.x, b.y - a.y);
    let to_a = (a.x - from.x, a.y - from.y);
    let determinant = direction.1 * side.0 - direction.0 * side.1;
    if determinant == 0.0 {
        return f32::INFINITY;
    }
    let along_ray = (to_a.1 * side.0 - to_a.0 * side.1) / determinant;
    let along_side = (direction.0 * to_a.1 - direction.1 * to_a.0) / determinant;
    // Sides reach a little beyond their ends, so that no ray slips between neighbours.
    if along_ray >= 0.0 && (-1e-5..=1.0 + 1e-5).contains(&along_side) { along_ray } else { f32::INFINITY }
}

/// Distance from a point to a side.
fn distance(point: Point2, [a, b]: &[Point2; 2]) -> f32 {
    let (side, to_point) = ((b.x - a.x, b.y - a.y), (point.x - a.x, point.y - a.y));
    let squared = side.0 * side.0 + side.1 * side.1;
    let t = if squared > 0.0 { ((to_point.0 * side.0 + to_point.1 * side.1) / squared).clamp(0.0, 1.0) } else { 0.0 };
    point.distance(Point2::new(a.x + t * side.0, a.y + t * side.1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::FreeSpaceOptions;
    use edgeloc::geometry::Point3;
    use edgeloc::math;

    const BODY: (f32, f32) = (0.05, 1.15);

    /// A wall in the plane x = 2, from y = -1 to 1 and from `bottom` to `top`.
    fn wall(bottom: f32, top: f32) -> Surfaces {
        let vertices = [(-1.0, bottom), (1.0, bottom), (1.0, top), (-1.0, top)];
        Surfaces {
            vertices: vertices.map(|(y, z)| Point3::new(2.0, y, z)).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        }
    }

    /// A table top 0.74 m high, from x = 1 to 2 and y = -1 to 1, without legs.
    fn table_top() -> Surfaces {
        let vertices = [(1.0, -1.0), (2.0, -1.0), (2.0, 1.0), (1.0, 1.0)];
        Surfaces {
            vertices: vertices.map(|(x, y)| Point3::new(x, y, 0.74)).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        }
    }

    #[test]
    fn a_ray_ends_at_the_wall_and_passes_beside_it() {
        let outlines = Outlines::new(&wall(0.0, 2.5), BODY);
        let range = |x, y, direction| outlines.range_m(Point2::new(x, y), direction, 8.0);
        assert!((range(0.0, 0.0, (1.0, 0.0)).expect("the wall") - 2.0).abs() < 1e-5);
        let (sin, cos) = math::sin_cos(0.4);
        assert!((range(0.0, 0.0, (cos, sin)).expect("the wall") - 2.0 / cos).abs() < 1e-4);
        assert_eq!(range(0.0, 0.0, (-1.0, 0.0)), None);
        assert_eq!(range(0.0, 1.1, (1.0, 0.0)), None);
        assert_eq!(range(-6.5, 0.0, (1.0, 0.0)), None, "beyond its range");
    }

    #[test]
    fn what_the_body_could_touch_is_met_and_nothing_else() {
        assert_eq!(FreeSpaceOptions::default().slice_m, BODY);
        let range = |surfaces: &Surfaces, slice_m| {
            Outlines::new(surfaces, slice_m).range_m(Point2::new(0.0, 0.1), (1.0, 0.0), 8.0)
        };
        assert_eq!(range(&wall(1.2, 2.5), BODY), None, "above the robot");
        assert_eq!(range(&wall(0.0, 0.04), BODY), None, "a doorstep");
        assert!(range(&table_top(), BODY).is_some_and(|met| (met - 1.0).abs() < 1e-4));
        assert_eq!(range(&table_top(), (0.29, 0.31)), None, "a single plane looks under the table");
    }

    #[test]
    fn clearance_is_the_distance_to_the_nearest_side() {
        let outlines = Outlines::new(&wall(0.0, 2.5), BODY);
        let clearance = |x, y| outlines.clearance_m(Point2::new(x, y), 0.5);
        assert!((clearance(1.7, 0.3) - 0.3).abs() < 1e-5);
        assert!((clearance(2.3, 1.4) - 0.5).abs() < 1e-5);
        assert!((clearance(0.0, 0.0) - 0.5).abs() < 1e-6, "no farther than asked");
    }

    #[test]
    fn buckets_lose_no_side_that_asking_every_one_finds() {
        let mut stream = crate::random::Stream::new(3, "sides", 0, 0);
        let mut draw = |low, high| stream.uniform(low, high) as f32;
        let mut surfaces = Surfaces::default();
        for first in (0..300_u32).step_by(3) {
            let (x, y) = (draw(-4.0, 4.0), draw(-3.0, 3.0));
            surfaces
                .vertices
                .extend((0..3).map(|_| Point3::new(x + draw(-0.6, 0.6), y + draw(-0.6, 0.6), draw(0.0, 1.4))));
            surfaces.triangles.push([first, first + 1, first + 2]);
        }
        let outlines = Outlines::new(&surfaces, BODY);
        for _ in 0..2000 {
            let from = Point2::new(draw(-5.0, 5.0), draw(-4.0, 4.0));
            let (sin, cos) = math::sin_cos(draw(0.0, core::f64::consts::TAU));
            let every = outlines.sides.iter().map(|side| meets(from, (cos, sin), side)).fold(f32::INFINITY, f32::min);
            assert_eq!(outlines.range_m(from, (cos, sin), 8.0), (every <= 8.0).then_some(every));
            let nearest = outlines.sides.iter().map(|side| distance(from, side)).fold(0.7, f32::min);
            assert!((outlines.clearance_m(from, 0.7) - nearest).abs() < 1e-6);
        }
    }

    #[test]
    fn without_surfaces_nothing_is_met() {
        let outlines = Outlines::new(&Surfaces::default(), BODY);
        assert_eq!(outlines.range_m(Point2::new(0.0, 0.0), (1.0, 0.0), 8.0), None);
    }
}

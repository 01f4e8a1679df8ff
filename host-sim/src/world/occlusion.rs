//! Occlusion: whether opaque triangles stand between two points.
//!
//! A bounding volume hierarchy over the triangles, split by the surface area heuristic (MacDonald and Booth 1990), and
//! the ray test of Möller and Trumbore (1997). Everything is plain `f32` arithmetic in a fixed order, so the answer is
//! the same on every machine.
//!
//! Edges lie *on* surfaces, so a ray to an edge always ends at a triangle, and it may arrive at any grazing angle. Two
//! rules keep a surface from hiding its own edges:
//! 1. a triangle whose plane passes within [`SAME_PLANE_M`] of the target does not hide it;
//! 2. the ray is stopped [`STOP_SHORT_M`] before the target, as edges and surfaces of real models miss each other a
//!    little. What lies less than that behind a skin shines through.

use super::Surfaces;
use edgeloc::geometry::Point3;

/// A ray ends this much before the point looked at \[m\].
const STOP_SHORT_M: f32 = 0.012;

/// A point this near to the plane of a triangle is not hidden by it \[m\].
const SAME_PLANE_M: f32 = 0.001;

/// Triangles reach this fraction of their sides beyond their border, so that no ray slips between neighbours.
const SEAM: f32 = 2e-6;

/// Boxes are larger than what they hold by this much \[m\], so that rounding never loses a hit.
const BOX_MARGIN_M: f32 = 1e-4;

/// Most triangles in a leaf, except where the centres of different ones coincide.
const LEAF_TRIANGLES: usize = 3;

/// Candidate split planes along the longest side of a node.
const SPLIT_BINS: usize = 12;

/// Below this depth nodes are split in equal halves, which bounds the depth of the tree by 32 more levels.
const SAH_DEPTH: usize = 32;

/// The surfaces of a world, ready to answer whether one point is seen from another.
#[derive(Debug, Clone, Default)]
pub struct Occluders {
    nodes: Vec<BoxNode>,
    triangles: Vec<RayTriangle>,
}

impl Occluders {
    /// Sorts the triangles of `surfaces` into a hierarchy.
    ///
    /// Triangles with an index out of range, a coordinate that is not finite or no area hide nothing and are left out.
    #[must_use]
    pub fn new(surfaces: &Surfaces) -> Self {
        let triangles = surfaces.triangles.iter().filter_map(|corners| RayTriangle::new(surfaces, corners));
        let mut builder = Builder { triangles: triangles.collect(), nodes: Vec::new() };
        if !builder.triangles.is_empty() {
            builder.nodes.push(BoxNode::default());
            builder.split(0, 0, builder.triangles.len(), 0);
        }
        Self { nodes: builder.nodes, triangles: builder.triangles }
    }

    /// Whether nothing stands between the eye at `from` and the point `to`, the last 12 mm excepted.
    #[must_use]
    pub fn is_visible(&self, from: Point3, to: Point3) -> bool {
        self.blocker(from, to, Blocker::default()).is_none()
    }

    /// A triangle that hides `to` from `from`, if any; `likely` is tried first and only changes the time taken.
    pub(crate) fn blocker(&self, from: Point3, to: Point3, likely: Blocker) -> Option<Blocker> {
        let ray = Ray::new(from, to)?;
        if let Some(triangle) = self.triangles.get(likely.0 as usize)
            && triangle.blocks(&ray)
        {
            return Some(likely);
        }
        let mut waiting = [0_u32; 2 * SAH_DEPTH];
        let mut waiting_count = 0;
        let mut current = self.nodes.first()?;
        current.entry(&ray)?;
        loop {
            if current.triangle_count > 0 {
                let first = current.first as usize;
                let leaf = &self.triangles[first..first + current.triangle_count as usize];
                if let Some(hit) = leaf.iter().position(|triangle| triangle.blocks(&ray)) {
                    return Some(Blocker((first + hit) as u32));
                }
            } else {
                let left = current.first as usize;
                let (left_entry, right_entry) = (self.nodes[left].entry(&ray), self.nodes[left + 1].entry(&ray));
                let next = match (left_entry, right_entry) {
                    (Some(left_entry), Some(right_entry)) => {
                        let is_left_nearer = left_entry <= right_entry;
                        waiting[waiting_count] = (left + usize::from(is_left_nearer)) as u32;
                        waiting_count += 1;
                        Some(left + usize::from(!is_left_nearer))
                    }
                    (Some(_), None) => Some(left),
                    (None, Some(_)) => Some(left + 1),
                    (None, None) => None,
                };
                if let Some(next) = next {
                    current = &self.nodes[next];
                    continue;
                }
            }
            if waiting_count == 0 {
                return None;
            }
            waiting_count -= 1;
            current = &self.nodes[waiting[waiting_count] as usize];
        }
    }
}

/// Which triangle stood in the way; the default names none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Blocker(u32);

impl Default for Blocker {
    fn default() -> Self {
        Self(u32::MAX)
    }
}

/// From an eye towards a point: `origin + t * direction`, `t` from 0 to `reach`.
struct Ray {
    origin: [f32; 3],
    direction: [f32; 3],
    inverse: [f32; 3],
    reach: f32,
}

impl Ray {
    /// `None` when the points are closer than the ray is stopped short: then nothing can stand between.
    fn new(from: Point3, to: Point3) -> Option<Self> {
        let length_m = from.distance(to);
        let reach = 1.0 - STOP_SHORT_M / length_m;
        if !(reach > 0.0 && length_m.is_finite()) {
            return None;
        }
        let direction = [to.x - from.x, to.y - from.y, to.z - from.z];
        // Along an axis it does not move on, a ray counts as moving very slowly: zero times infinity would be NaN.
        let inverse = direction.map(|d| if d.abs() < 1e-30 { 1e30 } else { 1.0 / d });
        Some(Self { origin: array(from), direction, inverse, reach })
    }
}

/// A triangle as a corner and the two sides from it.
#[derive(Debug, Clone, Copy)]
struct RayTriangle {
    corner: [f32; 3],
    sides: [[f32; 3]; 2],
    /// [`SAME_PLANE_M`] times the length of the cross product of the sides.
    same_plane: f32,
}

impl RayTriangle {
    fn new(surfaces: &Surfaces, corners: &[u32; 3]) -> Option<Self> {
        let corner = |index: usize| surfaces.vertices.get(corners[index] as usize).copied().map(array);
        let (a, b, c) = (corner(0)?, corner(1)?, corner(2)?);
        let sides = [minus(b, a), minus(c, a)];
        let normal = cross(sides[0], sides[1]);
        let area_squared = dot(normal, normal);
        let same_plane = SAME_PLANE_M * libm::sqrtf(area_squared);
        (area_squared.is_finite() && area_squared > 0.0).then_some(Self { corner: a, sides, same_plane })
    }

    /// Whether the ray meets the triangle, from either side.
    fn blocks(&self, ray: &Ray) -> bool {
        let p = cross(ray.direction, self.sides[1]);
        let determinant = dot(self.sides[0], p);
        if determinant == 0.0 {
            return false;
        }
        let scale = 1.0 / determinant;
        let from_corner = minus(ray.origin, self.corner);
        let u = dot(from_corner, p) * scale;
        if !(-SEAM..=1.0 + SEAM).contains(&u) {
            return false;
        }
        let q = cross(from_corner, self.sides[0]);
        let v = dot(ray.direction, q) * scale;
        if v < -SEAM || u + v > 1.0 + SEAM {
            return false;
        }
        let t = dot(self.sides[1], q) * scale;
        // The determinant is the ray's length across the plane times the length of the cross product.
        t > 0.0 && t < ray.reach && (1.0 - t) * determinant.abs() > self.same_plane
    }

    /// Tells triangles apart, and puts them in some order.
    fn bits(&self) -> [[u32; 3]; 3] {
        [self.corner, self.sides[0], self.sides[1]].map(|vector| vector.map(f32::to_bits))
    }

    fn bounds(&self) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        for axis in 0..3 {
            let (a, b, c) = (0.0_f32, self.sides[0][axis], self.sides[1][axis]);
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            let margin = BOX_MARGIN_M + 10.0 * SEAM * (high - low);
            bounds.low[axis] = self.corner[axis] + low - margin;
            bounds.high[axis] = self.corner[axis] + high + margin;
        }
        bounds
    }
}

/// A node of the tree: a box around either two nodes, one after the other, or a run of triangles.
#[derive(Debug, Clone, Copy, Default)]
struct BoxNode {
    low: [f32; 3],
    first: u32,
    high: [f32; 3],
    triangle_count: u32,
}

impl BoxNode {
    /// Where the ray enters the box; `None` when it passes by.
    fn entry(&self, ray: &Ray) -> Option<f32> {
        let (mut enter, mut leave) = (0.0, ray.reach);
        for axis in 0..3 {
            let low = (self.low[axis] - ray.origin[axis]) * ray.inverse[axis];
            let high = (self.high[axis] - ray.origin[axis]) * ray.inverse[axis];
            enter = larger(enter, smaller(low, high));
            leave = smaller(leave, larger(low, high));
        }
        (enter <= leave).then_some(enter)
    }
}

/// The smaller of two numbers, in one instruction; nothing here is NaN.
fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The larger of two numbers, in one instruction; nothing here is NaN.
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[derive(Clone, Copy)]
struct Bounds {
    low: [f32; 3],
    high: [f32; 3],
}

impl Bounds {
    const EMPTY: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    fn around(triangles: &[RayTriangle]) -> Self {
        triangles.iter().fold(Self::EMPTY, |all, triangle| all.joined(&triangle.bounds()))
    }

    fn joined(mut self, other: &Self) -> Self {
        for axis in 0..3 {
            self.low[axis] = self.low[axis].min(other.low[axis]);
            self.high[axis] = self.high[axis].max(other.high[axis]);
        }
        self
    }

    fn half_area(&self) -> f32 {
        let [x, y, z] = minus(self.high, self.low);
        x * y + y * z + z * x
    }

    fn center(&self, axis: usize) -> f32 {
        0.5 * (self.low[axis] + self.high[axis])
    }
}

struct Builder {
    triangles: Vec<RayTriangle>,
    nodes: Vec<BoxNode>,
}

impl Builder {
    /// Makes `node` hold the triangles `from..to`: as a leaf, or as two children.
    fn split(&mut self, node: usize, from: usize, to: usize, depth: usize) {
        let bounds = Bounds::around(&self.triangles[from..to]);
        self.nodes[node] =
            BoxNode { low: bounds.low, high: bounds.high, first: from as u32, triangle_count: (to - from) as u32 };
        if to - from <= LEAF_TRIANGLES {
            return;
        }
        let Some(middle) = self.partition(from, to, depth) else {
            self.nodes[node].triangle_count = distinct_to_front(&mut self.triangles[from..to]) as u32;
            return;
        };
        let left = self.nodes.len();
        self.nodes.extend([BoxNode::default(); 2]);
        self.nodes[node].first = left as u32;
        self.nodes[node].triangle_count = 0;
        self.split(left, from, middle, depth + 1);
        self.split(left + 1, middle, to, depth + 1);
    }

    /// Orders the triangles `from..to` so that those before the returned index go left; `None` to keep one leaf.
    fn partition(&mut self, from: usize, to: usize, depth: usize) -> Option<usize> {
        let run = &mut self.triangles[from..to];
        let centers = run.iter().fold(Bounds::EMPTY, |all, triangle| {
            let center = [0, 1, 2].map(|axis| triangle.bounds().center(axis));
            all.joined(&Bounds { low: center, high: center })
        });
        let extent = minus(centers.high, centers.low);
        let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
        if extent[axis] <= 0.0 {
            return None;
        }
        let bin_of = |triangle: &RayTriangle| {
            let along = (triangle.bounds().center(axis) - centers.low[axis]) / extent[axis];
            ((along * SPLIT_BINS as f32) as usize).min(SPLIT_BINS - 1)
        };
        if depth < SAH_DEPTH
            && let Some(last_left_bin) = cheapest_split(run, bin_of)
        {
            let middle = stable_partition(run, |triangle| bin_of(triangle) <= last_left_bin);
            return Some(from + middle);
        }
        run.sort_by(|a, b| a.bounds().center(axis).total_cmp(&b.bounds().center(axis)));
        Some(from + run.len() / 2)
    }
}

/// The bin after which to split so that area times count, summed over both sides, is least.
fn cheapest_split(run: &[RayTriangle], bin_of: impl Fn(&RayTriangle) -> usize) -> Option<usize> {
    let mut bins = [(Bounds::EMPTY, 0_usize); SPLIT_BINS];
    for triangle in run {
        let bin = &mut bins[bin_of(triangle)];
        *bin = (bin.0.joined(&triangle.bounds()), bin.1 + 1);
    }
    let join = |bins: &[(Bounds, usize)]| {
        bins.iter().fold((Bounds::EMPTY, 0), |(bounds, count), bin| (bounds.joined(&bin.0), count + bin.1))
    };
    let cost = |(bounds, count): (Bounds, usize)| bounds.half_area() * count as f32;
    (0..SPLIT_BINS - 1)
        .map(|last| (last, join(&bins[..=last]), join(&bins[last + 1..])))
        .filter(|(_, left, right)| left.1 > 0 && right.1 > 0)
        .map(|(last, left, right)| (last, cost(left) + cost(right)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(last, _)| last)
}

/// Moves what `is_left` accepts to the front, keeping both orders, and tells how many.
fn stable_partition(run: &mut [RayTriangle], is_left: impl Fn(&RayTriangle) -> bool) -> usize {
    let (left, right): (Vec<_>, Vec<_>) = run.iter().copied().partition(is_left);
    let middle = left.len();
    run[..middle].copy_from_slice(&left);
    run[middle..].copy_from_slice(&right);
    middle
}

/// Moves one of each of the triangles to the front, and tells how many: a copy hides nothing that the other does not.
fn distinct_to_front(run: &mut [RayTriangle]) -> usize {
    run.sort_by_key(RayTriangle::bits);
    let mut count = 0;
    for index in 0..run.len() {
        if count == 0 || run[index].bits() != run[count - 1].bits() {
            run[count] = run[index];
            count += 1;
        }
    }
    count
}

fn array(point: Point3) -> [f32; 3] {
    [point.x, point.y, point.z]
}

fn minus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests;

//! Which pieces of the world's edges are seen from one point, in any direction.
//!
//! In one of two ways. The paper's (section 4.1): whole edges, as the nearest of the [reference
//! viewpoints](super::ReferenceViewpoints) lists them. And from the surfaces, where every pose has its own exact answer: an edge
//! is cut into equal intervals of about 10 cm, a ray to the middle of each tells
//! whether the interval is seen, and neighbouring seen intervals join into one piece. So a piece ends half way between
//! a seen and an unseen sample, and an edge seen at every sample is kept whole. There is no limit of range: an edge
//! far away is seen as small as it is.

use super::WireframeWorld;
use super::occlusion::{Blocker, Occluders};
use super::viewpoints::EdgeSet;
use edgeloc::geometry::{Point2, Point3, Segment3};
use std::ops::Range;

/// Length of a sampled interval \[m\].
const SAMPLE_SPACING_M: f32 = 0.1;

/// Fewest and most intervals of an edge.
const SAMPLE_COUNTS: (f32, f32) = (3.0, 30.0);

/// Squares along the edge of the cube by which directions are bundled.
const BUNDLES_A_SIDE: usize = 16;

/// What is seen from one eye point.
#[derive(Debug, Clone)]
pub struct ViewpointVisibility<'a> {
    eye: Point3,
    edges: &'a [Segment3],
    seen: Seen<'a>,
}

#[derive(Debug, Clone)]
enum Seen<'a> {
    ThroughSurfaces(SeenPieces<'a>),
    Listed(&'a EdgeSet),
}

/// What is seen between the surfaces; worked out edge by edge when first asked for.
#[derive(Debug, Clone)]
struct SeenPieces<'a> {
    eye: Point3,
    occluders: &'a Occluders,
    pieces: Vec<Segment3>,
    pieces_of_edge: Vec<Option<Range<u32>>>,
    /// For each bundle of directions what last stood in the way there. It only saves time: a ray is blocked or not.
    likely_blockers: Vec<Blocker>,
}

impl<'a> ViewpointVisibility<'a> {
    /// Nothing worked out yet, for an eye at `eye` in the world frame.
    ///
    /// The world's reference viewpoints say what is seen, if it has any; otherwise the `occluders`, which are those of
    /// `world.surfaces`.
    #[must_use]
    pub fn new(world: &'a WireframeWorld, occluders: &'a Occluders, eye: Point3) -> Self {
        let seen = match &world.reference_viewpoints {
            Some(viewpoints) => Seen::Listed(&viewpoints.nearest(Point2::new(eye.x, eye.y)).visible),
            None => Seen::ThroughSurfaces(SeenPieces::new(occluders, world.edges.len(), eye)),
        };
        Self { eye, edges: &world.edges, seen }
    }

    /// What the surfaces leave to be seen, whatever reference viewpoints the world has.
    #[must_use]
    pub(super) fn through_surfaces(world: &'a WireframeWorld, occluders: &'a Occluders, eye: Point3) -> Self {
        let seen = Seen::ThroughSurfaces(SeenPieces::new(occluders, world.edges.len(), eye));
        Self { eye, edges: &world.edges, seen }
    }

    /// Where the eye is, world frame.
    #[must_use]
    pub const fn eye(&self) -> Point3 {
        self.eye
    }

    /// The world's edges, world frame.
    #[must_use]
    pub const fn edges(&self) -> &'a [Segment3] {
        self.edges
    }

    /// The pieces of one edge that are seen, from its start to its end, in the world frame; none when it is hidden.
    ///
    /// # Panics
    /// When the world has no edge of that index.
    pub fn visible_parts(&mut self, edge_index: usize) -> &[Segment3] {
        let edge = &self.edges[edge_index];
        match &mut self.seen {
            Seen::ThroughSurfaces(seen) => seen.pieces_of(edge_index, edge),
            Seen::Listed(visible) if visible.contains(edge_index as u32) => std::slice::from_ref(edge),
            Seen::Listed(_) => &[],
        }
    }
}

impl<'a> SeenPieces<'a> {
    fn new(occluders: &'a Occluders, edge_count: usize, eye: Point3) -> Self {
        Self {
            eye,
            occluders,
            pieces: Vec::new(),
            pieces_of_edge: vec![None; edge_count],
            likely_blockers: vec![Blocker::default(); 6 * BUNDLES_A_SIDE * BUNDLES_A_SIDE],
        }
    }

    fn pieces_of(&mut self, edge_index: usize, edge: &Segment3) -> &[Segment3] {
        let range = match &self.pieces_of_edge[edge_index] {
            Some(range) => range.clone(),
            None => self.look_at(edge_index, edge),
        };
        &self.pieces[range.start as usize..range.end as usize]
    }

    fn look_at(&mut self, edge_index: usize, edge: &Segment3) -> Range<u32> {
        let first_piece = self.pieces.len() as u32;
        let (fewest, most) = SAMPLE_COUNTS;
        let interval_count = libm::ceilf(edge.length_m() / SAMPLE_SPACING_M).clamp(fewest, most);
        let mut run_start = None;
        for interval in 0..=interval_count as u32 {
            let begin = interval as f32 / interval_count;
            let is_seen = interval < interval_count as u32 && {
                let sample = edge.start.lerp(edge.end, (interval as f32 + 0.5) / interval_count);
                self.is_seen(sample)
            };
            match run_start {
                None if is_seen => run_start = Some(begin),
                Some(from) if !is_seen => {
                    let is_whole = from <= 0.0 && interval as f32 >= interval_count;
                    self.pieces.push(if is_whole { *edge } else { edge.part(from, begin) });
                    run_start = None;
                }
                _ => {}
            }
        }
        let range = first_piece..self.pieces.len() as u32;
        self.pieces_of_edge[edge_index] = Some(range.clone());
        range
    }

    fn is_seen(&mut self, sample: Point3) -> bool {
        let likely = &mut self.likely_blockers[bundle(self.eye, sample)];
        match self.occluders.blocker(self.eye, sample, *likely) {
            Some(blocker) => {
                *likely = blocker;
                false
            }
            None => true,
        }
    }
}

/// Which bundle the direction from `eye` to `sample` belongs to: directions are sorted by where they leave a cube round
/// the eye, each side of the cube being divided into squares.
fn bundle(eye: Point3, sample: Point3) -> usize {
    let direction = [sample.x - eye.x, sample.y - eye.y, sample.z - eye.z];
    let size = direction.map(f32::abs);
    let axis = if size[0] >= size[1] && size[0] >= size[2] { 0 } else { 1 + usize::from(size[2] > size[1]) };
    let side = 2 * axis + usize::from(direction[axis] > 0.0);
    // A cast turns NaN into zero and keeps the rest in range.
    let square = |along: f32| ((along / size[axis] + 1.0) * 0.5 * BUNDLES_A_SIDE as f32) as usize;
    let [u, v] = [square(direction[(axis + 1) % 3]), square(direction[(axis + 2) % 3])];
    (side * BUNDLES_A_SIDE + u.min(BUNDLES_A_SIDE - 1)) * BUNDLES_A_SIDE + v.min(BUNDLES_A_SIDE - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;
    use crate::world::Surfaces;
    use edgeloc::geometry::Polarity;

    fn plus(a: Point3, b: Point3, factor: f32) -> Point3 {
        Point3::new(a.x + factor * b.x, a.y + factor * b.y, a.z + factor * b.z)
    }

    /// A box by its center and the vectors from there to the middles of three of its faces.
    struct TurnedBox {
        center: Point3,
        halves: [Point3; 3],
    }

    impl TurnedBox {
        fn new(center: Point3, size: [f32; 3], yaw: f32) -> Self {
            let (sin, cos) = edgeloc::math::sin_cos(yaw);
            let [x, y, z] = size.map(|side| 0.5 * side);
            let halves =
                [Point3::new(x * cos, x * sin, 0.0), Point3::new(-y * sin, y * cos, 0.0), Point3::new(0.0, 0.0, z)];
            Self { center, halves }
        }

        /// The corner on the given side (-1 or 1) along each axis.
        fn corner(&self, sides: [f32; 3]) -> Point3 {
            (0..3).fold(self.center, |corner, axis| plus(corner, self.halves[axis], sides[axis]))
        }

        /// Each edge with the two faces that meet in it, as axis and side.
        fn edges(&self) -> Vec<(Segment3, [(usize, f32); 2])> {
            let mut edges = Vec::new();
            for axis in 0..3 {
                let (second, third) = ((axis + 1) % 3, (axis + 2) % 3);
                for (s, t) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
                    let mut sides = [-1.0; 3];
                    (sides[second], sides[third]) = (s, t);
                    let start = self.corner(sides);
                    sides[axis] = 1.0;
                    let edge = Segment3 { start, end: self.corner(sides), polarity: Polarity::LeftBrighter };
                    edges.push((edge, [(second, s), (third, t)]));
                }
            }
            edges
        }

        /// How far the eye stands before a face \[m\]; negative behind it.
        fn height_above(&self, (axis, side): (usize, f32), eye: Point3) -> f32 {
            let (half, offset) = (self.halves[axis], plus(eye, self.center, -1.0));
            let reach = half.distance(Point3::default());
            side * (offset.x * half.x + offset.y * half.y + offset.z * half.z) / reach - reach
        }

        fn world(&self) -> WireframeWorld {
            let mut surfaces = Surfaces::default();
            for axis in 0..3 {
                for side in [-1.0, 1.0] {
                    let first = surfaces.vertices.len() as u32;
                    for (s, t) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                        let mut sides = [side; 3];
                        (sides[(axis + 1) % 3], sides[(axis + 2) % 3]) = (s, t);
                        surfaces.vertices.push(self.corner(sides));
                    }
                    surfaces.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
                }
            }
            let edges = self.edges().into_iter().map(|(edge, _)| edge).collect();
            WireframeWorld { edges, surfaces, ..WireframeWorld::default() }
        }
    }

    #[test]
    fn of_a_box_exactly_the_edges_of_its_facing_sides_are_seen() {
        let mut stream = Stream::new(1, "boxes", 0, 0);
        let (mut seen_count, mut hidden_count) = (0, 0);
        for _ in 0..3000 {
            let mut draw = |low, high| stream.uniform(low, high) as f32;
            let center = Point3::new(draw(-20.0, 20.0), draw(-20.0, 20.0), draw(0.0, 2.0));
            // The samples of a shorter edge may lie so near its corners that the ray is stopped before the box.
            let size = [draw(0.08, 3.0), draw(0.08, 3.0), draw(0.08, 3.0)];
            let turned_box = TurnedBox::new(center, size, draw(0.0, 6.3));
            let eye = Point3::new(center.x + draw(-6.0, 6.0), center.y + draw(-6.0, 6.0), draw(0.0, 2.5));
            let world = turned_box.world();
            let occluders = Occluders::new(&world.surfaces);
            let mut visibility = ViewpointVisibility::new(&world, &occluders, eye);
            let heights = (0..3).flat_map(|axis| [(axis, -1.0), (axis, 1.0)]);
            if heights.map(|face| turned_box.height_above(face, eye)).fold(f32::MIN, f32::max) < 0.0 {
                continue; // inside the box
            }
            for (index, (edge, faces)) in turned_box.edges().into_iter().enumerate() {
                let height = faces.map(|face| turned_box.height_above(face, eye)).into_iter().fold(f32::MIN, f32::max);
                let parts = visibility.visible_parts(index);
                let what = || format!("edge {index} of {size:?} at {center:?} from {eye:?}, {height} m before a face");
                // Within a millimetre of the plane of a face the answer may be either.
                if height > 1e-3 {
                    assert_eq!(parts, [edge], "{}", what());
                    seen_count += 1;
                } else if height < -0.03 {
                    assert!(parts.is_empty(), "{}", what());
                    hidden_count += 1;
                }
            }
        }
        assert!(seen_count > 20_000 && hidden_count > 4_000, "{seen_count} {hidden_count}");
    }

    /// A wall across the view at x = 2 m, from y = -5 m to `edge_y`, and an edge along y at x = 4 m.
    fn half_hidden_edge(edge_y: f32) -> WireframeWorld {
        let corners = [(-5.0, 0.0), (edge_y, 0.0), (edge_y, 3.0), (-5.0, 3.0)];
        let vertices = corners.map(|(y, z)| Point3::new(2.0, y, z)).to_vec();
        let edge = Segment3 {
            start: Point3::new(4.0, -1.0, 1.0),
            end: Point3::new(4.0, 1.0, 1.0),
            polarity: Polarity::LeftBrighter,
        };
        let surfaces = Surfaces { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]] };
        WireframeWorld { edges: vec![edge], surfaces, ..WireframeWorld::default() }
    }

    #[test]
    fn a_wall_hides_what_is_behind_it_and_cuts_what_passes_it() {
        let seen_from_origin = |edge_y: f32| {
            let world = half_hidden_edge(edge_y);
            let occluders = Occluders::new(&world.surfaces);
            let mut visibility = ViewpointVisibility::new(&world, &occluders, Point3::new(0.0, 0.0, 1.0));
            visibility.visible_parts(0).to_vec()
        };
        assert!(seen_from_origin(1.0).is_empty());
        assert_eq!(seen_from_origin(-3.0), half_hidden_edge(-3.0).edges);
        let [part] = seen_from_origin(0.1)[..] else { panic!("one piece") };
        // The wall's shadow ends at y = 0.2 m, between two samples.
        assert!((part.start.y - 0.2).abs() < 0.051 && (part.end.y - 1.0).abs() < 1e-6, "{part:?}");
    }

    #[test]
    fn rays_do_not_slip_between_the_triangles_of_a_wall() {
        let mut surfaces = Surfaces::default();
        for row in 0..=20_u32 {
            for column in 0..=20 {
                surfaces.vertices.push(Point3::new(3.0, column as f32 * 0.37 - 3.7, row as f32 * 0.13 - 1.3));
                if row < 20 && column < 20 {
                    let corner = row * 21 + column;
                    surfaces.triangles.extend([[corner, corner + 1, corner + 22], [corner, corner + 22, corner + 21]]);
                }
            }
        }
        let occluders = Occluders::new(&surfaces);
        for vertex in &surfaces.vertices {
            let inside = vertex.y.abs() < 3.6 && vertex.z.abs() < 1.2;
            let behind = Point3::new(6.0, 2.0 * vertex.y, 2.0 * vertex.z);
            assert!(!inside || !occluders.is_visible(Point3::default(), behind), "slips past {vertex:?}");
        }
    }

    #[test]
    fn absurd_triangles_hide_nothing_and_break_nothing() {
        let vertices = vec![Point3::new(f32::NAN, 0.0, 0.0), Point3::new(1e30, 0.0, 0.0), Point3::new(1.0, -1.0, -1.0)];
        let triangles = vec![[0, 1, 2], [1, 1, 2], [2, 1, 7]];
        let occluders = Occluders::new(&Surfaces { vertices, triangles });
        assert!(occluders.is_visible(Point3::default(), Point3::new(5.0, 0.0, 0.0)));
        assert!(occluders.is_visible(Point3::default(), Point3::new(f32::NAN, 0.0, 0.0)));
    }
}

//! Templates: components that a generated world repeats, edge for edge identical (paper, section 4.1).
//!
//! A template has its own frame: metres, the origin in the middle of its back on the floor, x along its width, y out of
//! its front, z up. Its edges keep their contrast wherever it is placed, as a real door frame does.

use super::{Surfaces, WireframeWorld};
use crate::random::Stream;
use edgeloc::geometry::{Point3, Polarity, Segment3};

/// One component: edges with their polarity, and the surfaces they lie on.
#[derive(Debug, Clone)]
pub(crate) struct Template {
    edges: Vec<Segment3>,
    surfaces: Surfaces,
    polarities: Stream,
}

impl Template {
    /// An empty template. The `name`, at most eight bytes, fixes the polarities of its edges, in every world alike.
    pub(crate) fn new(name: &str) -> Self {
        Self { edges: Vec::new(), surfaces: Surfaces::default(), polarities: Stream::new(0, name, 0, 0) }
    }

    /// How many edges one copy adds to a world.
    pub(crate) fn edge_count(&self) -> usize {
        self.edges.len()
    }

    /// Adds a straight edge; its surface is added apart.
    pub(crate) fn add_line(&mut self, from: [f32; 3], to: [f32; 3]) {
        let polarity = if self.polarities.chance(0.5) { Polarity::LeftBrighter } else { Polarity::RightBrighter };
        self.edges.push(Segment3 { start: point(from), end: point(to), polarity });
    }

    /// Adds the closed outline through the given points.
    pub(crate) fn add_outline(&mut self, corners: &[[f32; 3]]) {
        for (index, &corner) in corners.iter().enumerate() {
            self.add_line(corner, corners[(index + 1) % corners.len()]);
        }
    }

    /// Adds the outline of an upright rectangle in the plane of constant `y`: a drawer, a door panel, a sheet.
    pub(crate) fn add_front(&mut self, y: f32, (left, right): (f32, f32), (bottom, top): (f32, f32)) {
        self.add_outline(&[[left, y, bottom], [right, y, bottom], [right, y, top], [left, y, top]]);
    }

    /// Adds a flat surface through four corners given in order round it, without edges.
    pub(crate) fn add_surface(&mut self, corners: [[f32; 3]; 4]) {
        let first = self.surfaces.vertices.len() as u32;
        self.surfaces.vertices.extend(corners.map(point));
        self.surfaces.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }

    /// Adds the six faces of an upright box between two opposite corners, without edges.
    pub(crate) fn add_solid(&mut self, low: [f32; 3], high: [f32; 3]) {
        let corner = |index: usize| [0, 1, 2].map(|axis| if index >> axis & 1 == 0 { low[axis] } else { high[axis] });
        for face in [[0, 2, 6, 4], [1, 3, 7, 5], [0, 1, 5, 4], [2, 3, 7, 6], [0, 1, 3, 2], [4, 5, 7, 6]] {
            self.add_surface(face.map(corner));
        }
    }

    /// Adds a thin upright box with its four long edges only.
    pub(crate) fn add_post(&mut self, low: [f32; 3], high: [f32; 3]) {
        self.add_solid(low, high);
        for (x, y) in [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])] {
            self.add_line([x, y, low[2]], [x, y, high[2]]);
        }
    }

    /// Adds a thin lying box with the outline of its upper side only.
    pub(crate) fn add_plate(&mut self, low: [f32; 3], high: [f32; 3]) {
        self.add_solid(low, high);
        let top = high[2];
        self.add_outline(&[
            [low[0], low[1], top],
            [high[0], low[1], top],
            [high[0], high[1], top],
            [low[0], high[1], top],
        ]);
    }

    /// Adds a box that stands on the floor with its back to a wall, without the two edges at its back that nobody sees.
    pub(crate) fn add_case(&mut self, low: [f32; 3], high: [f32; 3]) {
        self.add_post(low, high);
        for z in [low[2], high[2]] {
            self.add_line([low[0], low[1], z], [low[0], high[1], z]);
            self.add_line([low[0], high[1], z], [high[0], high[1], z]);
            self.add_line([high[0], low[1], z], [high[0], high[1], z]);
        }
    }

    /// Adds a thin box that hangs on a wall: the outline of its front, and its sides on the wall.
    pub(crate) fn add_panel(&mut self, low: [f32; 3], high: [f32; 3]) {
        self.add_solid(low, high);
        self.add_front(high[1], (low[0], high[0]), (low[2], high[2]));
        for x in [low[0], high[0]] {
            self.add_line([x, low[1], low[2]], [x, low[1], high[2]]);
        }
    }

    /// Adds a box with its faces and twelve edges.
    pub(crate) fn add_box(&mut self, low: [f32; 3], high: [f32; 3]) {
        self.add_solid(low, high);
        let ring = |z: f32| [[low[0], low[1], z], [high[0], low[1], z], [high[0], high[1], z], [low[0], high[1], z]];
        self.add_outline(&ring(low[2]));
        self.add_outline(&ring(high[2]));
        for (bottom, top) in ring(low[2]).into_iter().zip(ring(high[2])) {
            self.add_line(bottom, top);
        }
    }

    /// Adds a copy to `world`.
    pub(crate) fn place(&self, placement: &Placement, world: &mut WireframeWorld) {
        world.edges.extend(self.edges.iter().map(|edge| placement.apply_to_edge(edge)));
        let first = world.surfaces.vertices.len() as u32;
        world.surfaces.vertices.extend(self.surfaces.vertices.iter().map(|&vertex| placement.apply(vertex)));
        let triangles = self.surfaces.triangles.iter().map(|corners| corners.map(|corner| corner + first));
        world.surfaces.triangles.extend(triangles);
    }
}

/// Where a template stands: mirrored left to right first if asked, then turned about the vertical, then moved.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Placement {
    position: Point3,
    /// Where the template's +x points: cosine and sine of its yaw.
    x_axis: [f32; 2],
    is_mirrored: bool,
}

impl Placement {
    /// At a position, not turned.
    pub(crate) const fn at(x: f32, y: f32, z: f32) -> Self {
        Self { position: Point3::new(x, y, z), x_axis: [1.0, 0.0], is_mirrored: false }
    }

    /// Turned by quarter turns counter-clockwise, exactly.
    pub(crate) const fn turned_quarters(self, quarters: u8) -> Self {
        let x_axis = match quarters % 4 {
            0 => [1.0, 0.0],
            1 => [0.0, 1.0],
            2 => [-1.0, 0.0],
            _ => [0.0, -1.0],
        };
        Self { x_axis, ..self }
    }

    /// Turned to a yaw in degrees, counter-clockwise.
    pub(crate) fn turned_deg(self, yaw_deg: f32) -> Self {
        let (sin, cos) = edgeloc::math::sin_cos(yaw_deg.to_radians());
        Self { x_axis: [cos, sin], ..self }
    }

    /// Mirrored left to right if asked.
    pub(crate) const fn mirrored(self, is_mirrored: bool) -> Self {
        Self { is_mirrored, ..self }
    }

    /// Where the origin of the template comes to be.
    pub(crate) const fn position(&self) -> Point3 {
        self.position
    }

    /// The placement in the world of something placed in this template's frame.
    pub(crate) fn then(&self, inner: &Self) -> Self {
        let position = self.apply(inner.position);
        let [cos, sin] = inner.x_axis;
        let [outer_cos, outer_sin] = self.x_axis;
        let (cos, sin) = if self.is_mirrored { (cos, -sin) } else { (cos, sin) };
        let x_axis = [outer_cos * cos - outer_sin * sin, outer_sin * cos + outer_cos * sin];
        Self { position, x_axis, is_mirrored: self.is_mirrored != inner.is_mirrored }
    }

    fn apply(&self, local: Point3) -> Point3 {
        let x = if self.is_mirrored { -local.x } else { local.x };
        let [cos, sin] = self.x_axis;
        let (east, north) = (x * cos - local.y * sin, x * sin + local.y * cos);
        Point3::new(self.position.x + east, self.position.y + north, self.position.z + local.z)
    }

    /// The edge in the world, its contrast kept: a mirror swaps left and right, and so does walking the other way.
    /// End points are put in the order of their coordinates, so that their order tells nothing.
    fn apply_to_edge(&self, edge: &Segment3) -> Segment3 {
        let (start, end) = (self.apply(edge.start), self.apply(edge.end));
        let polarity = if self.is_mirrored { edge.polarity.flipped() } else { edge.polarity };
        let key = |p: Point3| [p.x, p.y, p.z];
        if key(start) <= key(end) {
            Segment3 { start, end, polarity }
        } else {
            Segment3 { start: end, end: start, polarity: polarity.flipped() }
        }
    }
}

fn point(coordinates: [f32; 3]) -> Point3 {
    Point3::new(coordinates[0], coordinates[1], coordinates[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(template: &Template, placement: Placement) -> WireframeWorld {
        let mut world = WireframeWorld::default();
        template.place(&placement, &mut world);
        world
    }

    #[test]
    fn a_box_has_twelve_edges_on_twelve_triangles() {
        let mut template = Template::new("box");
        template.add_box([-0.5, 0.0, 0.0], [0.5, 0.3, 2.0]);
        let world = placed(&template, Placement::at(3.0, 4.0, 0.0).turned_quarters(1));
        assert_eq!((world.edges.len(), world.surfaces.triangles.len()), (12, 12));
        assert!(world.edges.iter().all(|edge| (2.7..=3.0).contains(&edge.start.x) && edge.end.y >= 3.5));
    }

    #[test]
    fn turning_a_template_half_round_keeps_its_contrast_and_mirroring_reverses_it() {
        let mut template = Template::new("line");
        template.add_line([-0.5, 0.0, 1.0], [0.5, 0.0, 1.0]);
        let as_made = placed(&template, Placement::at(0.0, 0.0, 0.0)).edges[0];
        let turned = placed(&template, Placement::at(0.0, 0.0, 0.0).turned_quarters(2)).edges[0];
        let mirrored = placed(&template, Placement::at(0.0, 0.0, 0.0).mirrored(true)).edges[0];
        assert_eq!((as_made.start, as_made.end), (turned.start, turned.end));
        // What was to the left of the way is, seen from the other side, to the left of the way back.
        assert_eq!(turned.polarity, as_made.polarity.flipped());
        // In the mirror the way runs back (one flip) and left is right (another).
        assert_eq!(mirrored.polarity, as_made.polarity);
    }

    #[test]
    fn a_placement_in_a_mirrored_placement_is_mirrored_with_it() {
        let outer = Placement::at(1.0, 2.0, 0.0).turned_quarters(1).mirrored(true);
        let inner = Placement::at(0.3, 0.2, 0.7).turned_deg(30.0);
        let local = Point3::new(0.1, 0.05, 0.0);
        let (direct, composed) = (outer.apply(inner.apply(local)), outer.then(&inner).apply(local));
        assert!(direct.distance(composed) < 1e-6, "{direct:?} {composed:?}");
    }
}

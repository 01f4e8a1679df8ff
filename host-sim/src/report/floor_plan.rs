//! A world seen from above: every edge projected to the floor, free space tinted, nodes.

use super::drawing::{drawing, tidy, tooltip};
use crate::learning::SightCoverage;
use crate::world::WireframeWorld;
use edgeloc::geometry::Point2;
use std::collections::BTreeSet;
use std::fmt::Write;
use svg::Node;
use svg::node::element::{Circle, Group, Path, SVG};

/// Width of a plan [px of its frame].
const WIDTH_PX: f64 = 1000.0;
/// Room around what the plan must show in metres.
const MARGIN_M: f64 = 0.5;
/// Further room around the free space in metres, so that the walls and furniture that bound it are shown: the robot
/// keeps its own radius away from them.
const BEYOND_FREE_M: f64 = 0.5;
/// Greatest height to width; a taller world is drawn narrower.
const MAX_ASPECT: f64 = 1.5;

/// A world seen from above, ready to be drawn on. North of the drawing is +y.
#[derive(Debug, Clone)]
pub struct FloorPlan {
    min_m: (f64, f64),
    size_m: (f64, f64),
    px_per_m: f64,
    wire: String,
    free: String,
    withheld: String,
    poor: String,
    nodes: Vec<Point2>,
}

/// Free space as a plan shows it: the centres of square cells.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeCells {
    /// Centres of the free cells, world frame.
    pub centers: Vec<Point2>,
    /// A corner of the grid they lie in, world frame.
    pub origin: Point2,
    /// Side of a cell in metres.
    pub side_m: f64,
    /// Centres of the cells that learning left out, row by row of a run; none when nothing is known of rows.
    pub withheld: Vec<Vec<Point2>>,
}

impl FloorPlan {
    /// The plan of a world, its nodes and its free space, as far as they are known.
    ///
    /// It shows the free space and the nodes with a margin; without either the whole world.
    #[must_use]
    pub fn new(world: Option<&WireframeWorld>, free: Option<&FreeCells>, nodes: &[Point2]) -> Self {
        let places = free.map_or(&[][..], |free| &free.centers).iter().chain(nodes);
        let (min_m, max_m) = bounds(places.copied())
            .map(|(min, max)| {
                let room = BEYOND_FREE_M;
                ((min.0 - room, min.1 - room), (max.0 + room, max.1 + room))
            })
            .or_else(|| bounds(world?.edges.iter().flat_map(|edge| [edge.start, edge.end]).map(above)))
            .unwrap_or(((0.0, 0.0), (1.0, 1.0)));
        let min_m = (min_m.0 - MARGIN_M, min_m.1 - MARGIN_M);
        let size_m = (max_m.0 + MARGIN_M - min_m.0, max_m.1 + MARGIN_M - min_m.1);
        let px_per_m = (WIDTH_PX / size_m.0).min(WIDTH_PX * MAX_ASPECT / size_m.1);
        let mut plan = Self {
            min_m,
            size_m,
            px_per_m,
            wire: String::new(),
            free: String::new(),
            withheld: String::new(),
            poor: String::new(),
            nodes: nodes.to_vec(),
        };
        plan.wire = world.map_or_else(String::new, |world| plan.wire_path(world));
        plan.free = free.map_or_else(String::new, |free| plan.free_path(free));
        plan
    }

    /// The same plan with the free cells tinted that learning left out; `free` tells their grid.
    #[must_use]
    pub fn with_withheld(mut self, free: &FreeCells, centers: &[Point2]) -> Self {
        self.withheld = self.free_path(&FreeCells { centers: centers.to_vec(), ..free.clone() });
        self
    }

    /// The plan with the places that its nodes cover poorly.
    #[must_use]
    pub fn with_poor_places(mut self, coverage: &SightCoverage) -> Self {
        let squares = &coverage.poor_squares;
        let (centers, side_m) = (squares.points.clone(), f64::from(squares.side_m));
        self.poor = self.free_path(&FreeCells { centers, origin: squares.origin, side_m, withheld: Vec::new() });
        self
    }

    /// An empty drawing of the plan's size.
    #[must_use]
    pub fn canvas(&self) -> SVG {
        drawing(self.width_px(), self.height_px())
    }

    /// Width of the drawing in pixels.
    #[must_use]
    pub fn width_px(&self) -> f64 {
        self.length_px(self.size_m.0)
    }

    /// Height of the drawing in pixels.
    #[must_use]
    pub fn height_px(&self) -> f64 {
        self.length_px(self.size_m.1)
    }

    /// Where a point of the world frame lies, in pixels of the drawing.
    #[must_use]
    pub fn to_px(&self, point: Point2) -> (f64, f64) {
        let x = (f64::from(point.x) - self.min_m.0) * self.px_per_m;
        let y = (self.min_m.1 + self.size_m.1 - f64::from(point.y)) * self.px_per_m;
        (tidy(x), tidy(y))
    }

    /// A length of the world, in pixels of the drawing.
    #[must_use]
    pub fn length_px(&self, length_m: f64) -> f64 {
        tidy(length_m * self.px_per_m)
    }

    /// Nodes drawn on the plan.
    #[must_use]
    pub fn nodes(&self) -> &[Point2] {
        &self.nodes
    }

    /// Free space and edges.
    #[must_use]
    pub fn background(&self) -> Group {
        Group::new()
            .add(Path::new().set("class", "free").set("d", self.free.as_str()))
            .add(Path::new().set("class", "wire").set("d", self.wire.as_str()))
    }

    /// What learning left out and what the nodes cover poorly, and the nodes, each with its identity as a tooltip.
    #[must_use]
    pub fn node_marks(&self) -> Group {
        let mut group = Group::new();
        if !self.withheld.is_empty() {
            let withheld = Path::new().set("class", "withheld").set("d", self.withheld.as_str());
            group.append(withheld.add(tooltip("not learned")));
        }
        if !self.poor.is_empty() {
            group.append(Path::new().set("class", "poor").set("d", self.poor.as_str()));
        }
        for (id, &node) in self.nodes.iter().enumerate() {
            let (x, y) = self.to_px(node);
            let label = format!("node {id} at {:.2}, {:.2} m", node.x, node.y);
            group
                .append(Circle::new().set("class", "node").set("cx", x).set("cy", y).set("r", 4.5).add(tooltip(label)));
        }
        group
    }

    /// A scale bar of whole metres, in the lower left corner.
    #[must_use]
    pub fn scale_bar(&self) -> Group {
        let length_m = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]
            .into_iter()
            .rfind(|length| length * self.px_per_m < WIDTH_PX / 5.0)
            .unwrap_or(1.0);
        let y = self.height_px() - 14.0;
        let end = 12.0 + length_m * self.px_per_m;
        Group::new()
            .add(super::drawing::line("axis", (12.0, y), (end, y)))
            .add(super::drawing::text("start", (end + 8.0, y + 6.0), format!("{length_m} m")).set("class", "scale"))
    }

    /// All edges from above as one path; equal ones (floor and ceiling, say) once.
    fn wire_path(&self, world: &WireframeWorld) -> String {
        let tenth_px = |point: Point2| {
            let (x, y) = self.to_px(point);
            ((x * 10.0).round() as i64, (y * 10.0).round() as i64)
        };
        let mut lines = BTreeSet::new();
        for edge in &world.edges {
            let (start, end) = (tenth_px(above(edge.start)), tenth_px(above(edge.end)));
            if start != end {
                lines.insert((start.min(end), start.max(end)));
            }
        }
        let mut path = String::new();
        for ((x1, y1), (x2, y2)) in lines {
            let _ = write!(path, "M{} {}L{} {}", tenth(x1), tenth(y1), tenth(x2), tenth(y2));
        }
        path
    }

    /// The free cells as one path, neighbours in a row joined.
    pub(super) fn free_path(&self, free: &FreeCells) -> String {
        let (origin, side_m) = (free.origin, free.side_m);
        let index = |coordinate: f32, origin: f32| (f64::from(coordinate - origin) / side_m).floor() as i64;
        let cells = free.centers.iter().map(|center| (index(center.y, origin.y), index(center.x, origin.x)));
        let cells = cells.collect::<BTreeSet<_>>();
        let mut path = String::new();
        let mut cells = cells.into_iter().peekable();
        while let Some((row, first)) = cells.next() {
            let mut last = first;
            while cells.next_if_eq(&(row, last + 1)).is_some() {
                last += 1;
            }
            let at = |index: i64, origin: f32| (f64::from(origin) + index as f64 * side_m) as f32;
            let corner = Point2::new(at(first, origin.x), at(row + 1, origin.y));
            let (x, y) = self.to_px(corner);
            let (width, height) =
                (self.length_px((last - first + 1) as f64 * free.side_m), self.length_px(free.side_m));
            let _ = write!(path, "M{x} {y}h{width}v{height}h-{width}z");
        }
        path
    }
}

fn above(point: edgeloc::geometry::Point3) -> Point2 {
    Point2::new(point.x, point.y)
}

fn bounds(points: impl Iterator<Item = Point2>) -> Option<((f64, f64), (f64, f64))> {
    points.filter(|point| point.is_finite()).map(|point| (f64::from(point.x), f64::from(point.y))).fold(
        None,
        |bounds, (x, y)| {
            let ((x0, y0), (x1, y1)) = bounds.unwrap_or(((x, y), (x, y)));
            Some(((x0.min(x), y0.min(y)), (x1.max(x), y1.max(y))))
        },
    )
}

fn tenth(tenths: i64) -> String {
    if tenths % 10 == 0 { (tenths / 10).to_string() } else { format!("{:.1}", tenths as f64 / 10.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::Squares;

    #[test]
    fn a_plan_turns_the_world_y_axis_up() {
        let plan = FloorPlan::new(None, None, &[Point2::new(0.0, 0.0), Point2::new(4.0, 2.0)]);
        let (low, high) = (plan.to_px(plan.nodes()[0]), plan.to_px(plan.nodes()[1]));
        assert!(high.0 > low.0 && high.1 < low.1, "{low:?} {high:?}");
    }

    #[test]
    fn neighbouring_free_cells_become_one_rectangle() {
        let centers = [(0.05, 0.05), (0.15, 0.05), (0.35, 0.05)].map(|(x, y)| Point2::new(x, y)).to_vec();
        let plan = FloorPlan::new(
            None,
            Some(&FreeCells { centers, origin: Point2::new(0.0, 0.0), side_m: 0.1, withheld: Vec::new() }),
            &[],
        );
        assert_eq!(plan.free.matches('M').count(), 2);
    }

    #[test]
    fn poor_places_are_drawn_as_squares_below_the_nodes() {
        let points = [(0.31, 0.02), (0.17, 0.02)].map(|(x, y)| Point2::new(x, y)).to_vec();
        let coverage = SightCoverage {
            poor_squares: Squares { points, origin: Point2::new(0.0, 0.0), side_m: 0.15 },
            ..SightCoverage::default()
        };
        let plan = FloorPlan::new(None, None, &[Point2::new(1.0, 1.0)]);
        assert!(!plan.node_marks().to_string().contains("poor"));
        let plan = plan.with_poor_places(&coverage);
        assert_eq!(plan.poor.matches('M').count(), 1, "neighbours are joined: {}", plan.poor);
        assert!(plan.node_marks().to_string().contains("class=\"poor\""));
    }

    #[test]
    fn an_empty_plan_is_still_a_drawing() {
        assert!(FloorPlan::new(None, None, &[]).canvas().to_string().contains("viewBox"));
    }
}

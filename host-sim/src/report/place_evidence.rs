//! What speaks for places after each look of the verifying localiser.
//!
//! The localiser's search stays inside it. What it checks a pose with is open ([`PoseCheck`]), so the places are looked
//! at anew: those of a grid over the building, the best of them posed more closely, and the true pose. The search may
//! have found somewhat better or worse poses. This file alone knows how evidence is asked for.

use super::LookExplanation;
use edgeloc::database::{Node, NodeId, TopologicalDatabase};
use edgeloc::geometry::{Angle, Heading, Point2};
use edgeloc::localize::{Evidence, LocalizerConfig, PoseCheck, lines_to_match};
use edgeloc::math;
use edgeloc::pgh::Line;

/// Places named.
const NAMED_PLACES: usize = 6;
/// Places posed more closely, before the best are named: the true one may agree little by its cell and well by its pose.
const REFINED_PLACES: usize = 60;
/// What is nearer to another place than this is the same place in metres: of those posed more closely, of those named.
const PLACE_RADII_M: [f32; 2] = [0.4, 1.0];
/// Nodes whose models a place is checked with: the nearest.
const MODELS: usize = 2;
/// Least and greatest distance from a node that its model serves in metres.
const REACH_LIMITS_M: (f32, f32) = (0.6, 2.0);
/// Cells of the grid in that distance.
const CELLS_IN_REACH: f32 = 6.0;
/// Step of closer poses, what position and heading may still be off: in cells, cells and standard deviations of the
/// compass.
const STAGES: [(f32, [f32; 2]); 2] = [(1.0 / 3.0, [0.15, 0.5]), (1.0 / 9.0, [0.06, 0.2])];
/// Distance between points that are looked up on the grid and more closely in pixels.
const SPACINGS_PX: [f32; 2] = [14.0, 9.0];

/// A pose and what speaks for it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) position: Point2,
    /// What the compass errs by at the first look, if this is the pose.
    pub(super) heading_error: Angle,
    /// Node whose model agrees best.
    pub(super) node: NodeId,
    /// Agreement over all looks so far; 1 is perfect.
    pub(super) score: f64,
    /// Lead of the best place over it, in the unit of the confidence that an answer asks for.
    pub(super) behind: f64,
}

/// What speaks for places after a look.
#[derive(Debug)]
pub(super) struct PlaceEvidence {
    /// Side of a cell in metres.
    pub(super) cell_m: f32,
    /// Centres of cells with the agreement there.
    pub(super) cells: Vec<(Point2, f64)>,
    /// The best place and its rivals.
    pub(super) places: Vec<Place>,
    /// The true pose.
    pub(super) truth: Place,
}

/// The heading at a look, by the compass at the first look and the turns since.
pub(super) fn told_heading(looks: &[LookExplanation], look: &LookExplanation, error: Angle) -> Heading {
    let Some(first) = looks.first() else { return look.compass };
    let turned = look.true_pose.heading.angle().radians() - first.true_pose.heading.angle().radians();
    first.compass.turned(Angle::from_radians(turned + error.radians())).unwrap_or(look.compass)
}

/// What speaks for places after each of `looks`, of a robot at `truth`.
pub(super) fn place_evidence(
    looks: &[LookExplanation],
    map: &TopologicalDatabase<'_>,
    config: &LocalizerConfig,
    truth: Point2,
) -> Vec<PlaceEvidence> {
    let Some(first) = looks.first() else { return Vec::new() };
    let mut memories = vec![vec![0; PoseCheck::memory_len()]; looks.len()];
    let mut checks = Vec::new();
    for (look, memory) in looks.iter().zip(&mut memories) {
        let check = PoseCheck::new(map.rig(), config, &look.scene, memory).expect("memory of the length asked for");
        let way = told_way(first, look);
        checks.push(Check { check, told: told_heading(looks, look, Angle::default()), way });
    }
    let nodes: Vec<Node<'_>> = map.nodes().collect();
    let reach_m = reach_m(&nodes);
    let cell_m = reach_m / CELLS_IN_REACH;
    let mut checks = Checks { checks, cell_m, spread_rad: first.compass_spread.radians() };
    let mut grid = grid(&nodes, reach_m, cell_m);
    let own_error =
        Angle::from_radians(first.true_pose.heading.angle().radians() - first.compass.angle().radians()).wrapped();
    let (mut seen_q4, mut segments, mut found) = (0, 0, Vec::new());
    for (index, look) in looks.iter().enumerate() {
        seen_q4 += seen_length_q4(look, map, config);
        segments += look.used_segments;
        for cell in &mut grid {
            for (model, evidence) in &mut cell.models {
                *evidence = evidence.plus(checks.on_grid(index, model, cell.center));
            }
        }
        let cells: Vec<Place> = grid.iter().filter_map(|cell| cell.place(seen_q4)).collect();
        let best_cells = apart(cells.clone(), REFINED_PLACES, PLACE_RADII_M[0]);
        let refined = best_cells.into_iter().map(|place| checks.refined(place, &nodes, (index, seen_q4))).collect();
        let mut places = apart(refined, NAMED_PLACES, PLACE_RADII_M[1]);
        let at_truth = nearest(&nodes, truth, f32::INFINITY).into_iter().map(|node| {
            checks.closest(Place { position: truth, heading_error: own_error, ..none(&node) }, &node, (index, seen_q4))
        });
        let Some(mut truth) = at_truth.reduce(better) else { continue };
        let (best, weight) = (places.first().map_or(0.0, |place| place.score), (segments as f64 / 30.0).sqrt());
        for place in places.iter_mut().chain([&mut truth]) {
            place.behind = (best - place.score) * weight;
        }
        // What is drawn is where the robot is at this look.
        let way = checks.checks[index].way;
        let cells = cells.iter().map(|cell| (after(cell, way), cell.score)).collect();
        for place in places.iter_mut().chain([&mut truth]) {
            place.position = after(place, way);
        }
        found.push(PlaceEvidence { cell_m, cells, places, truth });
    }
    found
}

/// The way made from the first look to another, as the compass at the first would have it.
fn told_way(first: &LookExplanation, look: &LookExplanation) -> Point2 {
    let (from, to) = (first.true_pose.position, look.true_pose.position);
    let error_rad = first.compass.angle().radians() - first.true_pose.heading.angle().radians();
    turned(Point2::new(to.x - from.x, to.y - from.y), error_rad)
}

/// Where a robot that was at `place` at the first look is after that way.
fn after(place: &Place, way: Point2) -> Point2 {
    let way = turned(way, place.heading_error.radians());
    Point2::new(place.position.x + way.x, place.position.y + way.y)
}

fn turned(way: Point2, by_rad: f32) -> Point2 {
    let (sin, cos) = math::sin_cos(by_rad);
    Point2::new(way.x * cos - way.y * sin, way.x * sin + way.y * cos)
}

/// One look, ready to be asked.
struct Check<'m> {
    check: PoseCheck<'m>,
    told: Heading,
    way: Point2,
}

/// The looks, ready to be asked.
struct Checks<'m> {
    checks: Vec<Check<'m>>,
    cell_m: f32,
    /// Standard deviation of the compass.
    spread_rad: f32,
}

impl Checks<'_> {
    fn evidence(&mut self, look: usize, node: &Node<'_>, place: &Place, closeness: [f32; 3]) -> Evidence {
        let Check { check, told, way } = &mut self.checks[look];
        let (from, to) = (node.position(), after(place, *way));
        let heading = told.turned(place.heading_error).unwrap_or(*told);
        check.evidence(node, ([to.x - from.x, to.y - from.y], heading), closeness)
    }

    fn on_grid(&mut self, look: usize, node: &Node<'_>, position: Point2) -> Evidence {
        let closeness = [0.4 * self.cell_m, self.spread_rad, SPACINGS_PX[0]];
        self.evidence(look, node, &Place { position, ..none(node) }, closeness)
    }

    /// The agreement of all looks up to the one given with a pose, whose position and heading may be off by `left`.
    fn scored(&mut self, place: Place, node: &Node<'_>, left: [f32; 2], (last, seen_q4): (usize, i32)) -> Place {
        let closeness = [left[0] * self.cell_m, left[1] * self.spread_rad, SPACINGS_PX[1]];
        let looks = 0..=last;
        let evidence =
            looks.fold(Evidence::default(), |sum, look| sum.plus(self.evidence(look, node, &place, closeness)));
        Place { score: score(evidence, seen_q4), ..place }
    }

    fn closest(&mut self, place: Place, node: &Node<'_>, looks: (usize, i32)) -> Place {
        self.scored(place, node, STAGES[STAGES.len() - 1].1, looks)
    }

    /// The best pose about one of the grid.
    fn refined(&mut self, mut place: Place, nodes: &[Node<'_>], looks: (usize, i32)) -> Place {
        let Some(node) = nodes.get(place.node.0 as usize) else { return place };
        let turns: &[f32] = if self.spread_rad > 0.0 { &[0.0, -1.0, 1.0] } else { &[0.0] };
        for (step, left) in STAGES {
            let (center, step_m, step_rad) = (place, step * self.cell_m, 2.0 * step * self.spread_rad);
            let steps = [0.0, -1.0, 1.0];
            let offsets = steps.iter().flat_map(|x| steps.iter().map(move |y| (*x, *y)));
            let poses = offsets.flat_map(|(x, y)| turns.iter().map(move |turn| (x, y, *turn)));
            let around = poses.map(|(x, y, turn)| Place {
                position: Point2::new(center.position.x + x * step_m, center.position.y + y * step_m),
                heading_error: Angle::from_radians(center.heading_error.radians() + turn * step_rad),
                ..center
            });
            place = around.map(|pose| self.scored(pose, node, left, looks)).reduce(better).unwrap_or(place);
        }
        place
    }
}

/// A place of the grid.
struct Cell<'a> {
    center: Point2,
    models: Vec<(Node<'a>, Evidence)>,
}

impl Cell<'_> {
    fn place(&self, seen_q4: i32) -> Option<Place> {
        let places = self.models.iter().map(|(node, evidence)| Place {
            position: self.center,
            score: score(*evidence, seen_q4),
            ..none(node)
        });
        places.reduce(better)
    }
}

/// The cells that a node's model serves.
fn grid<'a>(nodes: &[Node<'a>], reach_m: f32, cell_m: f32) -> Vec<Cell<'a>> {
    let bounds = |along: fn(Point2) -> f32| {
        let all = || nodes.iter().map(|node| along(node.position()));
        (all().fold(f32::INFINITY, f32::min) - reach_m, all().fold(f32::NEG_INFINITY, f32::max) + reach_m)
    };
    let centers = |(low, high): (f32, f32)| {
        (0_u16..).map(move |index| low + f32::from(index) * cell_m).take_while(move |place| *place <= high)
    };
    let (columns, rows) = (bounds(|point| point.x), bounds(|point| point.y));
    let places = centers(columns).flat_map(|x| centers(rows).map(move |y| Point2::new(x, y)));
    let cell = |center| {
        let models: Vec<_> =
            nearest(nodes, center, reach_m).into_iter().map(|node| (node, Evidence::default())).collect();
        (!models.is_empty()).then_some(Cell { center, models })
    };
    places.filter_map(cell).collect()
}

/// The nodes nearest to a place, none of them farther than `reach_m`.
fn nearest<'a>(nodes: &[Node<'a>], place: Point2, reach_m: f32) -> Vec<Node<'a>> {
    let distance = |node: &Node<'_>| node.position().distance(place);
    let mut near: Vec<Node<'a>> = nodes.iter().copied().filter(|node| distance(node) <= reach_m).collect();
    near.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    near.truncate(MODELS);
    near
}

/// As far as nodes are from their neighbours.
fn reach_m(nodes: &[Node<'_>]) -> f32 {
    let to_next = |node: &Node<'_>| {
        let others = nodes.iter().filter(|other| other.id() != node.id());
        others.map(|other| other.position().distance(node.position())).fold(f32::INFINITY, f32::min)
    };
    let mean_m = nodes.iter().map(to_next).sum::<f32>() / nodes.len().max(1) as f32;
    mean_m.clamp(REACH_LIMITS_M.0, REACH_LIMITS_M.1)
}

/// The best places that are no two the same, the best first.
fn apart(mut places: Vec<Place>, most: usize, radius_m: f32) -> Vec<Place> {
    places.sort_by(|a, b| b.score.total_cmp(&a.score));
    let mut kept: Vec<Place> = Vec::new();
    for place in places {
        if kept.len() < most && kept.iter().all(|other| other.position.distance(place.position) > radius_m) {
            kept.push(place);
        }
    }
    kept
}

/// Length of the segments of a look that enter, in Q4 px of an image of 640 x 480 px.
fn seen_length_q4(look: &LookExplanation, map: &TopologicalDatabase<'_>, config: &LocalizerConfig) -> i32 {
    let places = look.scene.iter().take(usize::from(config.max_segments));
    let mut storage: Vec<Line> = places.map(|segment| Line::new(segment, 0, &config.shape)).collect();
    let lines = lines_to_match(look.scene.iter().copied(), config, &mut storage);
    let camera = &map.rig().camera;
    let scale = (640.0 / f32::from(camera.width_px())).min(480.0 / f32::from(camera.height_px()));
    (lines.iter().map(|line| line.length_q4() as f32).sum::<f32>() * scale) as i32
}

fn score(evidence: Evidence, seen_q4: i32) -> f64 {
    f64::from(evidence.score_q20(seen_q4)) / f64::from(1 << 20)
}

fn better(best: Place, other: Place) -> Place {
    if other.score > best.score { other } else { best }
}

/// At a node, without evidence.
fn none(node: &Node<'_>) -> Place {
    Place { position: node.position(), heading_error: Angle::default(), node: node.id(), score: 0.0, behind: 0.0 }
}

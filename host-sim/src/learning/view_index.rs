//! The index of a map of many nodes: what its first stage compares, worked out of the map alone.
//!
//! A node's views are its model re-projected from itself and from four poses about it, along evenly spaced headings. The
//! axes are those along which the views of different places differ most, held against what differs at one place (linear
//! discriminant analysis; Fisher 1936): between a node and the poses about it, and between neighbouring nodes' models seen
//! from nearly the same pose, which have errors of their own.

use crate::random::Stream;
use edgeloc::database::{IndexParts, IndexShape, Node, NodeId, TopologicalDatabase, format};
use edgeloc::geometry::{Angle, Heading, Point2, Point3, Segment2, Segment3, StereoRig};
use edgeloc::gist::{AXES, EdgeLayout, FEATURES, Projection, edge_layout};
use edgeloc::math;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rayon::prelude::*;
use zerocopy::little_endian::I16;

/// Views in a turn, 15 degrees apart: what a look is off by then hardly matters.
const SECTORS: u16 = 24;
/// Poses about a node, along the diagonals of its surroundings \[m\].
const POSES_M: [[f32; 2]; 5] = [[0.0, 0.0], [0.55, 0.55], [-0.55, 0.55], [0.55, -0.55], [-0.55, -0.55]];
/// Nodes that axes are worked out of, at most.
const SAMPLE_NODES: usize = 1500;
/// Pairs of neighbouring nodes that axes are worked out of, at most.
const SAMPLE_PAIRS: usize = 4000;
/// Neighbours are at most so far apart \[m\].
const NEIGHBOR_M: f32 = 2.2;
/// Poses of neighbours that are held against each other are so far apart \[m\].
const PAIR_APART_M: std::ops::Range<f32> = 0.15..0.9;
/// What each number of a layout varies by at one place at least, as a share of the mean.
const SHRINKAGE: f64 = 0.02;

/// The shape of the indices made here.
#[must_use]
pub const fn index_shape() -> IndexShape {
    IndexShape { sectors: SECTORS, poses: POSES_M.len() as u16 }
}

/// The linear map from layouts to codes, as it is written.
#[derive(Debug, Clone, PartialEq)]
pub struct LearnedProjection {
    /// The mean layout.
    pub mean: [I16; FEATURES],
    /// The axes.
    pub axes: Box<[[I16; FEATURES]; AXES]>,
}

impl LearnedProjection {
    /// Works the axes out of the map, or a part of its nodes when there are many.
    #[must_use]
    pub fn learn(map: &TopologicalDatabase<'_>) -> Self {
        let step = map.node_count().div_ceil(SAMPLE_NODES).max(1);
        // Runs of nodes, so that neighbours are among them.
        let mut stream = Stream::new(0, "index", map.node_count() as u64, 0);
        const RUN: usize = 72;
        let runs = (0..map.node_count()).step_by(RUN * step).map(|first| first + RUN * stream.index(step));
        let sample: Vec<NodeId> = runs
            .flat_map(|first| first..first + RUN)
            .filter(|node| *node < map.node_count())
            .map(|node| NodeId(node as u32))
            .collect();
        let pairs = neighbors(map, &sample);
        let sum_up = |sector: u16| Moments::of_sector(map, &sample, &pairs, sector);
        let moments = (0..SECTORS).into_par_iter().map(sum_up).collect::<Vec<_>>();
        moments.into_iter().reduce(Moments::plus).map_or_else(Self::none, |moments| moments.projection())
    }

    fn none() -> Self {
        Self { mean: [I16::new(0); FEATURES], axes: Box::new([[I16::new(0); FEATURES]; AXES]) }
    }

    /// The same as core reads it.
    #[must_use]
    pub fn as_projection(&self) -> Projection<'_> {
        Projection { mean: &self.mean, axes: &self.axes }
    }
}

/// Fills the parts of the index of `map` by `projection`, in parallel; tells `on_nodes` of each node and sector done.
pub fn fill_index(
    map: &TopologicalDatabase<'_>,
    projection: &LearnedProjection,
    parts: &mut IndexParts<'_>,
    on_nodes: &(dyn Fn(usize) + Sync),
) {
    const AT_ONCE: usize = 64;
    *parts.mean = projection.mean;
    *parts.axes = *projection.axes;
    let per_sector = map.node_count() * POSES_M.len();
    let per_chunk = AT_ONCE * POSES_M.len();
    for (sector, codes) in parts.codes.chunks_exact_mut(per_sector).enumerate() {
        codes.par_chunks_mut(per_chunk).enumerate().for_each(|(chunk, codes)| {
            let first = (chunk * AT_ONCE) as u32;
            for (node, codes) in (first..).zip(codes.chunks_exact_mut(POSES_M.len())) {
                let Some(node) = map.node(NodeId(node)) else { continue };
                for (code, pose) in codes.iter_mut().zip(POSES_M) {
                    *code = projection.as_projection().code(&layout(map.rig(), &node, sector as u16, pose));
                }
            }
            on_nodes(codes.len() / POSES_M.len());
        });
    }
}

/// The layout of what a camera sees of a node's model, moved by `pose_m` from the node, in the middle of a sector.
fn layout(rig: &StereoRig, node: &Node<'_>, sector: u16, [x, y]: [f32; 2]) -> EdgeLayout {
    edge_layout(&rig.camera, view(rig, node, sector, [x, y]))
}

fn view<'a>(
    rig: &StereoRig,
    node: &Node<'a>,
    sector: u16,
    [x, y]: [f32; 2],
) -> impl Iterator<Item = Segment2> + use<'a> {
    let heading = Heading::new(Angle::from_degrees(360.0 * f32::from(sector) / f32::from(SECTORS)));
    let (sin, cos) = math::sin_cos(heading.unwrap_or_default().angle().radians());
    let (camera, near_limit_m) = (rig.camera, rig.near_limit_m);
    let in_camera = move |point: Point3| {
        let (east, north) = (point.x - x, point.y - y);
        Point3::new(east * sin - north * cos, -point.z, east * cos + north * sin)
    };
    node.segments().filter_map(move |segment| {
        let segment =
            Segment3 { start: in_camera(segment.start), end: in_camera(segment.end), polarity: segment.polarity };
        let is_behind = segment.start.z < near_limit_m && segment.end.z < near_limit_m;
        if is_behind { None } else { camera.project_segment(&segment, near_limit_m) }
    })
}

/// A node, and a pose about another one that lies close to it.
type Pair = (NodeId, (NodeId, usize));

/// Pairs of neighbours among `sample`, at most [`SAMPLE_PAIRS`].
fn neighbors(map: &TopologicalDatabase<'_>, sample: &[NodeId]) -> Vec<Pair> {
    let places: Vec<(NodeId, Point2)> =
        sample.iter().filter_map(|id| map.node(*id)).map(|node| (node.id(), node.position())).collect();
    let mut pairs = Vec::new();
    for (index, (id, here)) in places.iter().enumerate() {
        // Nodes of a run are neighbours; others are not.
        for (other, there) in places[index.saturating_sub(72)..].iter().take(144).filter(|(other, _)| other != id) {
            if here.distance(*there) > NEIGHBOR_M {
                continue;
            }
            let is_close =
                |[x, y]: &[f32; 2]| PAIR_APART_M.contains(&here.distance(Point2::new(there.x + x, there.y + y)));
            pairs.extend((0..).zip(&POSES_M).filter(|(_, pose)| is_close(pose)).map(|(pose, _)| (*id, (*other, pose))));
        }
    }
    let step = pairs.len().div_ceil(SAMPLE_PAIRS).max(1);
    pairs.into_iter().step_by(step).collect()
}

/// Sums over layouts: of all views, and of differences at one place.
struct Moments {
    views: (f64, DVector<f64>, DMatrix<f64>),
    moved: (f64, DMatrix<f64>),
    neighbors: (f64, DMatrix<f64>),
}

impl Moments {
    fn of_sector(map: &TopologicalDatabase<'_>, sample: &[NodeId], pairs: &[Pair], sector: u16) -> Self {
        let seen = |id: NodeId, pose: usize| -> Vec<f32> {
            let layout = map.node(id).map_or([0; FEATURES], |node| layout(map.rig(), &node, sector, POSES_M[pose]));
            layout.iter().map(|root| f32::from(*root)).collect()
        };
        let centers: Vec<Vec<f32>> = sample.iter().map(|id| seen(*id, 0)).collect();
        let center = |id: &NodeId| -> &[f32] {
            let index = sample.binary_search(id);
            index.map_or(&[], |index| &centers[index])
        };
        let minus = |a: &[f32], b: &[f32]| -> Vec<f32> { a.iter().zip(b).map(|(a, b)| a - b).collect() };
        let every_third = sample.iter().step_by(3);
        let moved = every_third.flat_map(|id| (1..POSES_M.len()).map(move |pose| (id, pose)));
        let moved: Vec<Vec<f32>> = moved.map(|(id, pose)| minus(center(id), &seen(*id, pose))).collect();
        let beside: Vec<Vec<f32>> =
            pairs.iter().map(|(id, (other, pose))| minus(center(id), &seen(*other, *pose))).collect();
        let sum = centers.iter().fold(DVector::zeros(FEATURES), |mut sum: DVector<f64>, layout| {
            sum.iter_mut().zip(layout).for_each(|(sum, root)| *sum += f64::from(*root));
            sum
        });
        Self {
            views: (centers.len() as f64, sum, squares(&centers)),
            moved: (moved.len() as f64, squares(&moved)),
            neighbors: (beside.len() as f64, squares(&beside)),
        }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            views: (self.views.0 + other.views.0, self.views.1 + other.views.1, self.views.2 + other.views.2),
            moved: (self.moved.0 + other.moved.0, self.moved.1 + other.moved.1),
            neighbors: (self.neighbors.0 + other.neighbors.0, self.neighbors.1 + other.neighbors.1),
        }
    }

    /// The axes that tell places apart, the most telling first, in the unit that makes full use of the format.
    fn projection(self) -> LearnedProjection {
        let (count, sum, squares) = self.views;
        let mean = sum / count.max(1.0);
        let among_places = squares / count.max(1.0) - &mean * mean.transpose();
        let mut at_one_place = self.moved.1 / self.moved.0.max(1.0);
        if self.neighbors.0 > 0.0 {
            at_one_place = (at_one_place + self.neighbors.1 / self.neighbors.0) * 0.5;
        }
        let least = SHRINKAGE * at_one_place.trace() / FEATURES as f64 + 1e-9;
        at_one_place += DMatrix::identity(FEATURES, FEATURES) * least;
        let whitening = inverse_root(at_one_place);
        let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(&whitening * among_places * &whitening);
        let mut order: Vec<usize> = (0..FEATURES).collect();
        order.sort_by(|a, b| eigenvalues[*b].total_cmp(&eigenvalues[*a]));
        let axes: Vec<DVector<f64>> =
            order.iter().take(AXES).map(|axis| &whitening * eigenvectors.column(*axis)).collect();
        let greatest = axes.iter().map(DVector::amax).fold(f64::MIN_POSITIVE, f64::max);
        let mut learned = LearnedProjection::none();
        for (written, mean) in learned.mean.iter_mut().zip(&mean) {
            *written = I16::new(mean.round() as i16);
        }
        for (written, axis) in learned.axes.iter_mut().zip(&axes) {
            for (written, part) in written.iter_mut().zip(axis) {
                *written = I16::new((part / greatest * 8191.0).round() as i16);
            }
        }
        learned
    }
}

/// The sum of the outer squares of rows.
fn squares(rows: &[Vec<f32>]) -> DMatrix<f64> {
    let rows =
        DMatrix::from_fn(FEATURES, rows.len(), |row, column| rows[column].get(row).map_or(0.0, |x| f64::from(*x)));
    &rows * rows.transpose()
}

/// The inverse of the symmetric root of a positive matrix.
fn inverse_root(matrix: DMatrix<f64>) -> DMatrix<f64> {
    let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(matrix);
    let scales = eigenvalues.map(|value| 1.0 / value.max(1e-12).sqrt());
    &eigenvectors * DMatrix::from_diagonal(&scales) * eigenvectors.transpose()
}

/// The format and the library agree on the sizes.
const _: () = assert!(format::LAYOUT_LEN == FEATURES && format::CODE_LEN == AXES);

//! Putting a world together, model by model: coordinates checked, wire-frame extracted, entry written in the report.

use super::super::crease;
use super::super::mesh::TriangleMesh;
use super::super::{Surfaces, WireframeWorld};
use super::session::PlacedModel;
use super::{BoundingBox, ImportOptions, ImportProblem, ImportReport, ModelReport};
use edgeloc::geometry::{Point3, Segment3};

/// Largest magnitude of a coordinate, in metres; more means a wrong unit, and costs f32 its millimetres.
const MAX_COORDINATE_M: f64 = 10_000.0;

/// The world so far.
#[derive(Debug, Default)]
pub(super) struct Assembly {
    edges: Vec<Segment3>,
    vertices: Vec<Point3>,
    triangles: Vec<[u32; 3]>,
    element_count: usize,
}

impl Assembly {
    /// Triangles and lines read so far, those left out included.
    pub(super) fn element_count(&self) -> usize {
        self.element_count
    }

    pub(super) fn is_empty(&self) -> bool {
        self.edges.is_empty() && self.triangles.is_empty()
    }

    /// Adds `model` and its entry in the report.
    pub(super) fn add(&mut self, mut model: PlacedModel, options: &ImportOptions, report: &mut ImportReport) {
        let place = || format!("model '{}'", model.name);
        let triangle_count = model.mesh.triangles.len();
        self.element_count += model.mesh.element_count();
        let bad_count = drop_far_coordinates(&mut model.mesh);
        if bad_count > 0 {
            let what = format!(
                "{bad_count} triangles or lines left out: coordinates not finite or beyond {MAX_COORDINATE_M} m"
            );
            report.add(ImportProblem::new(place(), what, "check the mesh and the unit it states"));
        }
        let extraction = crease::extract(&model.mesh, options.crease_deg);
        if !extraction.is_fully_merged {
            let what = "the mesh is so dense that collinear edges were merged in part only";
            report.add(ImportProblem::new(place(), what, "simplify the mesh"));
        }

        let at_least = |least_m: f32| extraction.segments.iter().filter(|edge| edge.length_m() >= least_m).count();
        let segment_count = extraction.segments.len();
        let kept_from = self.edges.len();
        let min_edge_m = options.min_edge_m as f32;
        self.edges.extend(extraction.segments.iter().filter(|edge| edge.length_m() >= min_edge_m));
        report.short_segment_count += segment_count - (self.edges.len() - kept_from);
        report.models.push(ModelReport {
            name: model.name,
            sources: model.sources,
            triangle_count,
            segment_count,
            segments_5cm: at_least(0.05),
            segments_10cm: at_least(0.10),
            edge_length_m: extraction.segments.iter().map(|edge| f64::from(edge.length_m())).sum(),
            bounding_box: BoundingBox::around(used_points(&extraction)),
        });

        let first = u32::try_from(self.vertices.len()).expect("limited triangles have fewer than 2^32 corners");
        self.vertices.extend(extraction.vertices);
        self.triangles.extend(extraction.triangles.iter().map(|triangle| triangle.map(|index| index + first)));
    }

    pub(super) fn into_world(self, name: String, origin: String) -> WireframeWorld {
        let surfaces = Surfaces { vertices: self.vertices, triangles: self.triangles };
        WireframeWorld { name, origin, edges: self.edges, surfaces, reference_viewpoints: None }
    }
}

/// Removes triangles and lines with a coordinate no world has; gives how many.
fn drop_far_coordinates(mesh: &mut TriangleMesh) -> usize {
    let vertices = &mesh.vertices;
    let fits: Vec<bool> =
        vertices.iter().map(|vertex| vertex.iter().all(|&coordinate| coordinate.abs() <= MAX_COORDINATE_M)).collect();
    let before = mesh.element_count();
    mesh.triangles.retain(|triangle| triangle.corners.iter().all(|&index| fits[index as usize]));
    mesh.lines.retain(|line| line.iter().all(|&index| fits[index as usize]));
    for (vertex, fits) in mesh.vertices.iter_mut().zip(fits) {
        if !fits {
            *vertex = nalgebra::Vector3::zeros();
        }
    }
    before - mesh.element_count()
}

/// The points that a triangle or a segment reaches.
fn used_points(extraction: &crease::Extraction) -> impl Iterator<Item = [f32; 3]> {
    let corners = extraction.triangles.iter().flatten().map(|&index| extraction.vertices[index as usize]);
    let ends = extraction.segments.iter().flat_map(|edge| [edge.start, edge.end]);
    corners.chain(ends).map(|point| [point.x, point.y, point.z])
}

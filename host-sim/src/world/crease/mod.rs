//! From triangles to a wire-frame: the edges a camera would see as straight intensity edges.
//!
//! Steps, each a file: vertices closer than 1 mm become one ([`weld`]); an edge between faces that meet at more than
//! the crease angle, or of one face alone, is kept ([`edges`]) with its contrast ([`contrast`]); coincident edges and
//! collinear runs become one segment ([`collinear`]).
//!
//! The order of a segment's end points is lexicographic in (x, y, z) and so says nothing about its polarity.

mod collinear;
mod contrast;
mod edges;
mod weld;

use super::mesh::TriangleMesh;
use edgeloc::geometry::{Point3, Polarity, Segment3};
use nalgebra::Vector3;

/// A straight piece of a kept edge; `contrast` is the brightness left of start -> end less that to the right.
#[derive(Debug, Clone, Copy)]
struct Piece {
    start: Vector3<f64>,
    end: Vector3<f64>,
    contrast: f64,
}

impl Piece {
    fn length_m(&self) -> f64 {
        (self.end - self.start).norm()
    }
}

/// What [`extract`] makes of a mesh.
#[derive(Debug, Default)]
pub(crate) struct Extraction {
    /// Every segment, however short.
    pub(crate) segments: Vec<Segment3>,
    /// Welded corner points.
    pub(crate) vertices: Vec<Point3>,
    /// Faces without area and repeated faces left out.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// False when the mesh was so dense that merging collinear runs stopped early.
    pub(crate) is_fully_merged: bool,
}

/// The wire-frame and the cleaned surface of `mesh`.
pub(crate) fn extract(mesh: &TriangleMesh, crease_deg: f64) -> Extraction {
    let welded = weld::weld(mesh);
    let pieces = edges::creases(&welded, libm::cos(crease_deg.to_radians()));
    let (runs, is_fully_merged) = collinear::merge(&pieces);
    Extraction {
        segments: runs.iter().filter_map(segment).collect(),
        vertices: welded.vertices.iter().map(rounded).collect(),
        triangles: welded.faces.iter().map(|face| face.corners).collect(),
        is_fully_merged,
    }
}

/// The segment of a merged piece, its end points in lexicographic order; `None` if they coincide in f32.
fn segment(piece: &Piece) -> Option<Segment3> {
    let (start, end) = (rounded(&piece.start), rounded(&piece.end));
    let order = [start.x, start.y, start.z]
        .iter()
        .zip([end.x, end.y, end.z])
        .map(|(a, b)| a.total_cmp(&b))
        .find(|order| order.is_ne())?;
    let (start, end, contrast) =
        if order.is_lt() { (start, end, piece.contrast) } else { (end, start, -piece.contrast) };
    let polarity =
        if contrast::is_left_brighter(contrast, start, end) { Polarity::LeftBrighter } else { Polarity::RightBrighter };
    Some(Segment3 { start, end, polarity })
}

fn rounded(point: &Vector3<f64>) -> Point3 {
    // Adding zero turns -0 into 0, so that equal points have equal bits.
    Point3::new(point.x as f32 + 0.0, point.y as f32 + 0.0, point.z as f32 + 0.0)
}

#[cfg(test)]
mod tests;

//! Triangle meshes as importers hand them over: world frame, metres, f64.

use nalgebra::Vector3;

/// A triangle soup with the brightness of its faces, and bare lines that belong to no face.
#[derive(Debug, Clone, Default)]
pub(crate) struct TriangleMesh {
    /// Corner points.
    pub(crate) vertices: Vec<Vector3<f64>>,
    /// Faces; every corner is an index into `vertices`.
    pub(crate) triangles: Vec<Triangle>,
    /// Lines as indices into `vertices`.
    pub(crate) lines: Vec<[u32; 2]>,
}

/// One face, seen from both sides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Triangle {
    /// Corners, counter-clockwise seen from the front.
    pub(crate) corners: [u32; 3],
    /// How much light the face returns, 0 (black) to 1 (white).
    pub(crate) reflectance: f32,
}

/// Reflectance of a face whose material says nothing, or is a picture.
pub(crate) const MID_GREY: f32 = 0.5;

impl TriangleMesh {
    /// Adds a vertex and gives its index.
    pub(crate) fn push_vertex(&mut self, point: Vector3<f64>) -> u32 {
        let index = u32::try_from(self.vertices.len()).expect("importers stop far below 2^32 vertices");
        self.vertices.push(point);
        index
    }
}

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

    /// Triangles and lines together: what limits count.
    pub(crate) fn element_count(&self) -> usize {
        self.triangles.len() + self.lines.len()
    }

    /// The same mesh without the vertices that no triangle or line uses.
    pub(crate) fn without_unused_vertices(mut self) -> Self {
        let mut new_index = vec![None; self.vertices.len()];
        let mut vertices = Vec::new();
        let corners = self.triangles.iter_mut().flat_map(|triangle| &mut triangle.corners);
        for corner in corners.chain(self.lines.iter_mut().flatten()) {
            let old = *corner as usize;
            // The kept vertices are no more than before, so their count fits a u32 too.
            *corner = *new_index[old].get_or_insert_with(|| {
                vertices.push(self.vertices[old]);
                vertices.len() as u32 - 1
            });
        }
        self.vertices = vertices;
        self
    }
}

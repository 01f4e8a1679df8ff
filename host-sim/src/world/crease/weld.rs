//! Welding: vertices within 1 mm of each other become one, faces without area and repeated faces go.
//!
//! A face keeps the normal of its own, unwelded corners: moving a corner by a millimetre would tilt a small face
//! beyond any crease angle.

use super::super::mesh::TriangleMesh;
use nalgebra::Vector3;
use std::collections::{HashMap, HashSet};

/// Vertices closer than this are one, in metres.
const WELD_M: f64 = 1e-3;

/// A face whose double area is below this has no usable normal; in square metres.
const LEAST_DOUBLE_AREA_M2: f64 = 1e-12;

/// A mesh whose faces share vertices.
#[derive(Debug, Default)]
pub(super) struct WeldedMesh {
    pub(super) vertices: Vec<Vector3<f64>>,
    pub(super) faces: Vec<Face>,
    pub(super) lines: Vec<[u32; 2]>,
}

/// A face with three distinct corners.
#[derive(Debug, Clone, Copy)]
pub(super) struct Face {
    pub(super) corners: [u32; 3],
    /// Unit normal, towards whoever sees the corners counter-clockwise.
    pub(super) normal: Vector3<f64>,
    pub(super) reflectance: f32,
}

/// Welds `mesh`; the first vertex of a cluster stands for it.
pub(super) fn weld(mesh: &TriangleMesh) -> WeldedMesh {
    let mut clusters = Clusters::default();
    let welded_index: Vec<u32> = mesh.vertices.iter().map(|&vertex| clusters.index_of(vertex)).collect();
    let weld = |index: u32| welded_index[index as usize];

    let mut faces = Vec::with_capacity(mesh.triangles.len());
    let mut seen = HashSet::new();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.corners.map(|index| mesh.vertices[index as usize]);
        let normal = (b - a).cross(&(c - a));
        let corners = triangle.corners.map(weld);
        let mut key = corners;
        key.sort_unstable();
        let is_degenerate = normal.norm() < LEAST_DOUBLE_AREA_M2 || key[0] == key[1] || key[1] == key[2];
        // Modellers export a two-sided face as two faces back to back; the first stands for both.
        if !is_degenerate && seen.insert(key) {
            faces.push(Face { corners, normal: normal.normalize(), reflectance: triangle.reflectance });
        }
    }
    let lines = mesh.lines.iter().map(|line| line.map(weld)).filter(|[a, b]| a != b).collect();
    WeldedMesh { vertices: clusters.vertices, faces, lines }
}

/// Distinct points, found again through a grid of cells as wide as the weld distance.
#[derive(Debug, Default)]
struct Clusters {
    vertices: Vec<Vector3<f64>>,
    /// First vertex in a cell; the others follow through `next_in_cell`.
    first_in_cell: HashMap<[i64; 3], u32>,
    next_in_cell: Vec<Option<u32>>,
}

impl Clusters {
    /// The vertex that stands for `point`, new if none is near.
    fn index_of(&mut self, point: Vector3<f64>) -> u32 {
        let cell = [point.x, point.y, point.z].map(|coordinate| libm::floor(coordinate / WELD_M) as i64);
        if let Some(found) = self.near(cell, point) {
            return found;
        }
        let index = u32::try_from(self.vertices.len()).expect("no more vertices than the mesh had");
        self.vertices.push(point);
        self.next_in_cell.push(self.first_in_cell.insert(cell, index));
        index
    }

    /// The earliest vertex within the weld distance of `point`.
    fn near(&self, cell: [i64; 3], point: Vector3<f64>) -> Option<u32> {
        let mut earliest: Option<u32> = None;
        for neighbor in 0..27 {
            let [dx, dy, dz] = [neighbor % 3 - 1, neighbor / 3 % 3 - 1, neighbor / 9 - 1];
            let key = [cell[0] + dx, cell[1] + dy, cell[2] + dz];
            let mut candidate = self.first_in_cell.get(&key).copied();
            while let Some(index) = candidate {
                let is_near = (self.vertices[index as usize] - point).norm() <= WELD_M;
                if is_near && earliest.is_none_or(|other| index < other) {
                    earliest = Some(index);
                }
                candidate = self.next_in_cell[index as usize];
            }
        }
        earliest
    }
}

//! Which edges of a welded mesh a camera would see: creases, boundaries and bare lines.
//!
//! An edge is smooth, and so invisible, when its faces lie on both sides of it and all within the crease angle of one
//! plane through it. That reads the same whichever way the faces are wound, and for any number of faces. Where flat
//! faces meet without sharing their vertices (T-junctions) a boundary shows that a camera would not see: 0.3 % of the
//! edge length in an office floor drawn by hand, next to none in furniture.

use super::Piece;
use super::contrast;
use super::weld::{Face, WeldedMesh};

/// A face along an edge; the edge runs from the lower to the higher vertex index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Use {
    low: u32,
    high: u32,
    face_index: u32,
    /// The face's own winding runs along the edge: seen from its front, the face lies to the left.
    is_left: bool,
}

/// The visible edges of `mesh`; `cos_crease` is the cosine of the least visible angle between faces.
pub(super) fn creases(mesh: &WeldedMesh, cos_crease: f64) -> Vec<Piece> {
    let uses = sorted_uses(&mesh.faces);
    let mut pieces = Vec::new();
    for along_edge in uses.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high)) {
        let faces: Vec<(Face, bool)> =
            along_edge.iter().map(|side| (mesh.faces[side.face_index as usize], side.is_left)).collect();
        if !is_smooth(&faces, cos_crease) {
            let (start, end) = (along_edge[0].low, along_edge[0].high);
            pieces.push(Piece {
                start: mesh.vertices[start as usize],
                end: mesh.vertices[end as usize],
                contrast: contrast::across(&faces),
            });
        }
    }
    pieces.extend(mesh.lines.iter().map(|&[start, end]| Piece {
        start: mesh.vertices[start as usize],
        end: mesh.vertices[end as usize],
        contrast: 0.0,
    }));
    pieces
}

fn sorted_uses(faces: &[Face]) -> Vec<Use> {
    let mut uses = Vec::with_capacity(faces.len() * 3);
    for (face_index, face) in faces.iter().enumerate() {
        let face_index = u32::try_from(face_index).expect("importers stop far below 2^32 faces");
        let [a, b, c] = face.corners;
        for (from, to) in [(a, b), (b, c), (c, a)] {
            uses.push(Use { low: from.min(to), high: from.max(to), face_index, is_left: from < to });
        }
    }
    uses.sort_unstable();
    uses
}

/// Whether the faces continue each other across the edge.
///
/// With the normal of each face turned so that the face lies to the left of the edge, faces on opposite sides of a
/// plane have opposite turned normals.
fn is_smooth(faces: &[(Face, bool)], cos_crease: f64) -> bool {
    let turned = |&(face, is_left): &(Face, bool)| if is_left { face.normal } else { -face.normal };
    let Some(first) = faces.first().map(turned) else { return true };
    let cosines = || faces.iter().map(|face| first.dot(&turned(face)));
    cosines().all(|cosine| cosine.abs() >= cos_crease) && cosines().any(|cosine| cosine < 0.0)
}

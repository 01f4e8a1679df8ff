//! The contrast of an edge: which of its two sides looks brighter.
//!
//! A face's brightness is its reflectance times a fixed shading: ambient 0.35 plus 0.65 |n . l| (Lambert, both sides
//! alike) under one light from above whose direction has three different components, so that floors, walls along x
//! and walls along y differ. Left and right are as seen by someone the faces' fronts look at: for an edge direction d
//! and a front normal n, left is n x d, which is the side of the face whose winding runs along d. A face alone stands
//! before a mid-grey background of mean shading. A tie is decided by a hash of the end points in millimetres.

use super::weld::Face;
use edgeloc::geometry::Point3;
use nalgebra::Vector3;

/// Direction towards the light, unit length.
const LIGHT: Vector3<f64> = Vector3::new(0.5195, 0.3117, 0.7956);
const AMBIENT: f64 = 0.35;
/// Brightness behind a boundary edge: mid grey (0.5), shaded 0.62, between a wall along x and one along y.
const BACKGROUND: f64 = 0.31;

/// Brightness left of the edge less that to its right; each face says whether it lies to the left.
pub(super) fn across(faces: &[(Face, bool)]) -> f64 {
    let mean = |wanted: bool| {
        let mut side = faces.iter().filter(|(_, is_left)| *is_left == wanted).map(|(face, _)| brightness(face));
        let first = side.next()?;
        let (sum, count) = side.fold((first, 1.0), |(sum, count), next| (sum + next, count + 1.0));
        Some(sum / count)
    };
    match (mean(true), mean(false)) {
        (Some(left), Some(right)) => left - right,
        (Some(_), None) => one_sided(faces),
        (None, Some(_)) => -one_sided(faces),
        (None, None) => 0.0,
    }
}

/// Whether the left side is brighter, a tie decided by the geometry.
pub(super) fn is_left_brighter(contrast: f64, start: Point3, end: Point3) -> bool {
    if contrast.abs() > 1e-9 { contrast > 0.0 } else { hash(start, end) & 1 == 1 }
}

/// Contrast of faces all wound the same way along the edge: the first against the others, or the background.
fn one_sided(faces: &[(Face, bool)]) -> f64 {
    let mut values = faces.iter().map(|(face, _)| brightness(face));
    let first = values.next().unwrap_or(BACKGROUND);
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), next| (sum + next, count + 1.0));
    first - if count > 0.0 { sum / count } else { BACKGROUND }
}

fn brightness(face: &Face) -> f64 {
    f64::from(face.reflectance) * (AMBIENT + (1.0 - AMBIENT) * face.normal.dot(&LIGHT).abs())
}

/// FNV-1a over the coordinates in millimetres, then mixed so that the lowest bit depends on all.
fn hash(start: Point3, end: Point3) -> u64 {
    let mut hash: u64 = 0xcbf2_9ce4_8422_2325;
    for coordinate in [start.x, start.y, start.z, end.x, end.y, end.z] {
        for byte in (libm::round(f64::from(coordinate) * 1000.0) as i64).to_le_bytes() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        }
    }
    hash ^= hash >> 33;
    hash = hash.wrapping_mul(0xff51_afd7_ed55_8ccd);
    hash ^ (hash >> 33)
}

//! Affine maps of points: poses, scales and node matrices, in f64 metres.

use super::super::mesh::TriangleMesh;
use nalgebra::{Matrix3, Vector3};

/// An affine map, read right to left like the frames it joins: `parent_from_child`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Placement {
    linear: Matrix3<f64>,
    translation: Vector3<f64>,
}

impl Placement {
    /// The map that leaves points alone.
    pub(super) fn identity() -> Self {
        Self { linear: Matrix3::identity(), translation: Vector3::zeros() }
    }

    /// A shift in metres.
    pub(super) fn translation(shift: Vector3<f64>) -> Self {
        Self { linear: Matrix3::identity(), translation: shift }
    }

    /// A scale along each axis.
    pub(super) fn scale(factors: Vector3<f64>) -> Self {
        Self { linear: Matrix3::from_diagonal(&factors), translation: Vector3::zeros() }
    }

    /// A turn by `radians` about `axis` (any length but zero; zero turns nothing), counter-clockwise seen from its tip.
    pub(super) fn rotation(axis: Vector3<f64>, radians: f64) -> Self {
        let Some(axis) = axis.try_normalize(0.0) else { return Self::identity() };
        let (sin, cos) = (libm::sin(radians), libm::cos(radians));
        // Rodrigues' formula.
        let linear = Matrix3::identity() * cos + axis.cross_matrix() * sin + axis * axis.transpose() * (1.0 - cos);
        Self { linear, translation: Vector3::zeros() }
    }

    /// A turn by a quaternion of any length but zero.
    pub(super) fn quaternion([x, y, z, w]: [f64; 4]) -> Self {
        let vector = Vector3::new(x, y, z);
        let square = vector.norm_squared() + w * w;
        if square <= 0.0 {
            return Self::identity();
        }
        let cross = vector.cross_matrix();
        let linear = Matrix3::identity() + (cross * w + cross * cross) * (2.0 / square);
        Self { linear, translation: Vector3::zeros() }
    }

    /// Roll about x, then pitch about y, then yaw about z, all about the fixed axes, in radians (SDF's convention).
    pub(super) fn roll_pitch_yaw(roll: f64, pitch: f64, yaw: f64) -> Self {
        Self::rotation(Vector3::z(), yaw)
            .after(&Self::rotation(Vector3::y(), pitch))
            .after(&Self::rotation(Vector3::x(), roll))
    }

    /// The upper three rows of a row-major 4 x 4 matrix.
    pub(super) fn from_row_major(m: &[f64; 16]) -> Self {
        Self {
            linear: Matrix3::new(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]),
            translation: Vector3::new(m[3], m[7], m[11]),
        }
    }

    /// The map that applies `first`, then `self`.
    pub(super) fn after(&self, first: &Self) -> Self {
        Self { linear: self.linear * first.linear, translation: self.apply(first.translation) }
    }

    /// Where a point goes.
    pub(super) fn apply(&self, point: Vector3<f64>) -> Vector3<f64> {
        self.linear * point + self.translation
    }

    /// Adds `mesh`, placed, to `target`; a mirroring map turns the winding back to face outwards.
    pub(super) fn append(&self, mesh: &TriangleMesh, target: &mut TriangleMesh) {
        let first = u32::try_from(target.vertices.len()).expect("importers stop far below 2^32 vertices");
        target.vertices.extend(mesh.vertices.iter().map(|&vertex| self.apply(vertex)));
        let is_mirrored = self.linear.determinant() < 0.0;
        target.triangles.extend(mesh.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.corners.map(|index| index + first);
            let mut placed = *triangle;
            placed.corners = if is_mirrored { [a, c, b] } else { [a, b, c] };
            placed
        }));
        target.lines.extend(mesh.lines.iter().map(|line| line.map(|index| index + first)));
    }
}

/// Which axis of a file points up; the world's is z.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum UpAxis {
    /// x is up: the file's (x, y, z) becomes (-y, x, z) turned so that x is z.
    X,
    /// y is up, as in glTF: (x, y, z) becomes (x, -z, y).
    Y,
    /// z is up, as in the world.
    #[default]
    Z,
}

impl UpAxis {
    /// The map from the file's axes to the world's.
    pub(super) fn world_from_file(self) -> Placement {
        let linear = match self {
            Self::X => Matrix3::new(0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0),
            Self::Y => Matrix3::new(1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0),
            Self::Z => Matrix3::identity(),
        };
        Placement { linear, translation: Vector3::zeros() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_near(actual: Vector3<f64>, expected: [f64; 3]) {
        assert!((actual - Vector3::from(expected)).norm() < 1e-12, "{actual:?} is not {expected:?}");
    }

    #[test]
    fn roll_pitch_yaw_turns_about_fixed_axes_in_that_order() {
        let quarter = core::f64::consts::FRAC_PI_2;
        let x = Vector3::x();
        assert_near(Placement::roll_pitch_yaw(0.0, 0.0, quarter).apply(x), [0.0, 1.0, 0.0]);
        assert_near(Placement::roll_pitch_yaw(0.0, quarter, 0.0).apply(x), [0.0, 0.0, -1.0]);
        assert_near(Placement::roll_pitch_yaw(quarter, 0.0, quarter).apply(Vector3::y()), [0.0, 0.0, 1.0]);
    }

    #[test]
    fn a_quaternion_turns_like_the_rotation_about_its_axis() {
        let half = 0.3_f64;
        let quaternion = Placement::quaternion([0.0, 2.0 * libm::sin(half), 0.0, 2.0 * libm::cos(half)]);
        let point = Vector3::new(0.3, -1.0, 2.0);
        let turned = Placement::rotation(Vector3::y(), 2.0 * half).apply(point);
        assert_near(quaternion.apply(point), turned.into());
    }

    #[test]
    fn every_up_axis_becomes_z_without_mirroring() {
        for (axis, up) in [(UpAxis::X, Vector3::x()), (UpAxis::Y, Vector3::y()), (UpAxis::Z, Vector3::z())] {
            let map = axis.world_from_file();
            assert_near(map.apply(up), [0.0, 0.0, 1.0]);
            assert!((map.linear.determinant() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_mirrored_mesh_keeps_its_fronts_outside() {
        let mut mesh = TriangleMesh::default();
        for point in [Vector3::zeros(), Vector3::x(), Vector3::y()] {
            mesh.push_vertex(point);
        }
        mesh.triangles.push(crate::world::mesh::Triangle { corners: [0, 1, 2], reflectance: 0.5 });
        let mut placed = TriangleMesh::default();
        Placement::scale(Vector3::new(-1.0, 1.0, 1.0)).append(&mesh, &mut placed);
        let [a, b, c] = placed.triangles[0].corners.map(|index| placed.vertices[index as usize]);
        assert!((b - a).cross(&(c - a)).z > 0.0);
    }
}

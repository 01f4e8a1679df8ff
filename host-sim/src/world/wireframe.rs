//! The wire-frame world: every straight edge that a camera could see, and the surfaces that can hide it.

use super::ReferenceViewpoints;
use edgeloc::geometry::{Point3, Segment3};

/// A wire-frame world with the surfaces that occlude it (paper, section 4.1; the surfaces are ours).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct WireframeWorld {
    /// A short name, fit for a file name.
    pub name: String,
    /// Where it came from: the generator and its seed, or the imported file and its import settings.
    pub origin: String,
    /// Straight edges in the world frame. Polarity is an attribute of the edge; the order of its end points carries
    /// no meaning.
    pub edges: Vec<Segment3>,
    /// Opaque surfaces in the world frame.
    pub surfaces: Surfaces,
    /// Who says what is visible from where, when it is not the surfaces; made for these edges and surfaces. No part of
    /// the world file or the checksum.
    pub reference_viewpoints: Option<ReferenceViewpoints>,
}

/// Opaque triangles, seen and blocking from both sides.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Surfaces {
    /// Corner points, world frame.
    pub vertices: Vec<Point3>,
    /// Triangles as indices into `vertices`.
    pub triangles: Vec<[u32; 3]>,
}

impl WireframeWorld {
    /// CRC-64 of edges and surfaces, bit for bit: worlds of the same sum give the same trials.
    #[must_use]
    pub fn checksum(&self) -> u64 {
        const CRC: crc::Crc<u64> = crc::Crc::<u64>::new(&crc::CRC_64_XZ);
        let mut digest = CRC.digest();
        let mut point = |point: &Point3| {
            for coordinate in [point.x, point.y, point.z] {
                digest.update(&coordinate.to_le_bytes());
            }
        };
        for edge in &self.edges {
            point(&edge.start);
            point(&edge.end);
        }
        self.surfaces.vertices.iter().for_each(&mut point);
        for edge in &self.edges {
            digest.update(&[edge.polarity as u8]);
        }
        for corner in self.surfaces.triangles.iter().flatten() {
            digest.update(&corner.to_le_bytes());
        }
        digest.finalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use edgeloc::geometry::Polarity;

    #[test]
    fn the_checksum_sees_every_part_of_a_world() {
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(x, y)| Point3::new(x, y, 0.0));
        let edge = Segment3 { start: corners[0], end: corners[1], polarity: Polarity::LeftBrighter };
        let surfaces = Surfaces { vertices: corners.to_vec(), triangles: vec![[0, 1, 2]] };
        let world = WireframeWorld { edges: vec![edge], surfaces, ..WireframeWorld::default() };
        let (mut moved, mut flipped, mut covered) = (world.clone(), world.clone(), world.clone());
        moved.edges[0].end.z += 0.001;
        flipped.edges[0].polarity = flipped.edges[0].polarity.flipped();
        covered.surfaces.triangles.push([0, 1, 2]);
        let sums = [&world, &moved, &flipped, &covered].map(WireframeWorld::checksum);
        assert!((1..4).all(|other| sums[other] != sums[0]), "{sums:?}");
    }
}

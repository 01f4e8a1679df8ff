//! The wire-frame world: every straight edge that a camera could see, and the surfaces that can hide it.

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
}

/// Opaque triangles, seen and blocking from both sides.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Surfaces {
    /// Corner points, world frame.
    pub vertices: Vec<Point3>,
    /// Triangles as indices into `vertices`.
    pub triangles: Vec<[u32; 3]>,
}

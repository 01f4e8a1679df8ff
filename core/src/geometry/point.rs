//! Points and vectors in the plane and in space.

/// A point or vector in the plane; pixels in the image frame (x right, y down) unless said otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Point2 {
    /// Coordinate to the right.
    pub x: f32,
    /// Coordinate downwards in the image frame.
    pub y: f32,
}

impl Point2 {
    /// A point from its coordinates.
    #[must_use]
    pub const fn new(x: f32, y: f32) -> Self {
        Self { x, y }
    }

    /// Distance to `other`, in the unit of the coordinates.
    #[must_use]
    pub fn distance(self, other: Self) -> f32 {
        crate::math::length(other.x - self.x, other.y - self.y)
    }

    /// The point a fraction `t` of the way to `other`.
    #[must_use]
    pub fn lerp(self, other: Self, t: f32) -> Self {
        Self { x: self.x + (other.x - self.x) * t, y: self.y + (other.y - self.y) * t }
    }

    /// Whether both coordinates are finite.
    #[must_use]
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }
}

/// A point or vector in space, in metres; its frame is named where it is used.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Point3 {
    /// First coordinate \[m\].
    pub x: f32,
    /// Second coordinate \[m\].
    pub y: f32,
    /// Third coordinate \[m\].
    pub z: f32,
}

impl Point3 {
    /// A point from its coordinates in metres.
    #[must_use]
    pub const fn new(x: f32, y: f32, z: f32) -> Self {
        Self { x, y, z }
    }

    /// Distance to `other` \[m\].
    #[must_use]
    pub fn distance(self, other: Self) -> f32 {
        let (x, y, z) = (other.x - self.x, other.y - self.y, other.z - self.z);
        crate::math::sqrt(x * x + y * y + z * z)
    }

    /// The point a fraction `t` of the way to `other`.
    #[must_use]
    pub fn lerp(self, other: Self, t: f32) -> Self {
        Self {
            x: self.x + (other.x - self.x) * t,
            y: self.y + (other.y - self.y) * t,
            z: self.z + (other.z - self.z) * t,
        }
    }

    /// Whether all coordinates are finite.
    #[must_use]
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.z.is_finite()
    }
}

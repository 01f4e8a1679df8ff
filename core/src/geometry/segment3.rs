//! A straight edge in space.

use super::{Point3, Polarity};

/// A straight edge in space; the frame is named where it is used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment3 {
    /// First end point \[m\].
    pub start: Point3,
    /// Second end point \[m\].
    pub end: Point3,
    /// Which side is brighter in an image of the edge, walking from start to end.
    pub polarity: Polarity,
}

impl Segment3 {
    /// Length \[m\].
    #[must_use]
    pub fn length_m(&self) -> f32 {
        self.start.distance(self.end)
    }

    /// The part between the fractions `from` and `to` of the way from start to end.
    #[must_use]
    pub fn part(&self, from: f32, to: f32) -> Self {
        Self { start: self.start.lerp(self.end, from), end: self.start.lerp(self.end, to), polarity: self.polarity }
    }
}

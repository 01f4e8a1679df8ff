//! The segments of one look.

use super::Segment2;
use core::fmt;

/// What the robot sees in one look at one heading: the segments of one image, borrowed.
#[derive(Debug, Clone, Copy, Default)]
pub struct Scene<'a> {
    segments: &'a [Segment2],
}

impl<'a> Scene<'a> {
    /// A scene of the given segments; any number, none included.
    #[must_use]
    pub const fn new(segments: &'a [Segment2]) -> Self {
        Self { segments }
    }

    /// The segments in the order given.
    #[must_use]
    pub const fn segments(&self) -> &'a [Segment2] {
        self.segments
    }
}

/// An owned scene of at most `CAPACITY` segments, for machines without a heap.
#[derive(Debug, Clone, Default)]
pub struct SceneBuffer<const CAPACITY: usize> {
    segments: heapless::Vec<Segment2, CAPACITY>,
}

impl<const CAPACITY: usize> SceneBuffer<CAPACITY> {
    /// An empty scene.
    #[must_use]
    pub const fn new() -> Self {
        Self { segments: heapless::Vec::new() }
    }

    /// Adds a segment.
    ///
    /// # Errors
    /// When the buffer is full; the buffer is unchanged.
    pub fn push(&mut self, segment: Segment2) -> Result<(), CapacityError> {
        self.segments.push(segment).map_err(|_| CapacityError {
            what: "scene buffer segments",
            capacity: CAPACITY,
            needed: CAPACITY + 1,
        })
    }

    /// Replaces the scene by `segments`.
    ///
    /// # Errors
    /// When there are more than fit: how many; the buffer is unchanged.
    pub fn replace(&mut self, segments: &[Segment2]) -> Result<(), CapacityError> {
        let too_many = CapacityError { what: "scene buffer segments", capacity: CAPACITY, needed: segments.len() };
        self.segments = heapless::Vec::from_slice(segments).map_err(|_| too_many)?;
        Ok(())
    }

    /// Removes all segments.
    pub fn clear(&mut self) {
        self.segments.clear();
    }

    /// The scene held.
    #[must_use]
    pub fn as_scene(&self) -> Scene<'_> {
        Scene::new(&self.segments)
    }
}

/// A fixed capacity was too small.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CapacityError {
    /// What ran out.
    pub what: &'static str,
    /// How many there is room for.
    pub capacity: usize,
    /// How many are needed.
    pub needed: usize,
}

impl fmt::Display for CapacityError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: room for {}, {} needed", self.what, self.capacity, self.needed)
    }
}

impl core::error::Error for CapacityError {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point2, Polarity};

    #[test]
    fn a_scene_too_large_for_its_buffer_says_how_many_are_needed_and_changes_nothing() {
        let segment = Segment2::new(Point2::new(0.0, 0.0), Point2::new(0.0, 9.0), Polarity::LeftBrighter);
        let segments = [segment.expect("valid"); 5];
        let mut buffer = SceneBuffer::<3>::new();
        buffer.replace(&segments[..2]).expect("two fit");
        let error = buffer.replace(&segments).expect_err("five do not");
        assert_eq!((error.capacity, error.needed), (3, 5));
        assert_eq!(buffer.as_scene().segments().len(), 2);
    }
}

//! A straight piece of an edge in an image.

use super::Point2;
use crate::math;
use core::fmt;

/// Which side of an edge is brighter, walking from its start to its end as seen in the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Polarity {
    /// The brighter side lies to the left.
    LeftBrighter,
    /// The brighter side lies to the right.
    RightBrighter,
}

impl Polarity {
    /// The polarity of the same edge walked the other way, or of an edge whose contrast flipped.
    #[must_use]
    pub const fn flipped(self) -> Self {
        match self {
            Self::LeftBrighter => Self::RightBrighter,
            Self::RightBrighter => Self::LeftBrighter,
        }
    }
}

/// A straight edge in the image: two distinct end points in pixels and the contrast polarity.
///
/// Constructed only by [`Segment2::new`], so every value has finite coordinates within
/// [`Segment2::MAX_COORDINATE_PX`] and a length of at least [`Segment2::MIN_LENGTH_PX`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment2 {
    start: Point2,
    end: Point2,
    polarity: Polarity,
}

impl Segment2 {
    /// Largest magnitude of a coordinate \[px\]: the range of the fixed-point histograms.
    pub const MAX_COORDINATE_PX: f32 = 2048.0;

    /// Least length of a segment \[px\]: the resolution of the fixed-point histograms.
    pub const MIN_LENGTH_PX: f32 = 0.0625;

    /// A segment from `start` to `end` in pixels.
    ///
    /// # Errors
    /// When a coordinate is not finite or out of range, or the end points coincide.
    pub fn new(start: Point2, end: Point2, polarity: Polarity) -> Result<Self, SegmentError> {
        for coordinate in [start.x, start.y, end.x, end.y] {
            if !coordinate.is_finite() {
                return Err(SegmentError::NotFinite);
            }
            if math::abs(coordinate) > Self::MAX_COORDINATE_PX {
                return Err(SegmentError::OutOfRange);
            }
        }
        if start.distance(end) < Self::MIN_LENGTH_PX {
            return Err(SegmentError::TooShort);
        }
        Ok(Self { start, end, polarity })
    }

    /// First end point \[px\].
    #[must_use]
    pub const fn start(&self) -> Point2 {
        self.start
    }

    /// Second end point \[px\].
    #[must_use]
    pub const fn end(&self) -> Point2 {
        self.end
    }

    /// Which side is brighter, walking from start to end.
    #[must_use]
    pub const fn polarity(&self) -> Polarity {
        self.polarity
    }

    /// Length \[px\].
    #[must_use]
    pub fn length_px(&self) -> f32 {
        self.start.distance(self.end)
    }

    /// The same edge walked from its other end: end points and polarity swapped.
    #[must_use]
    pub const fn reversed(&self) -> Self {
        Self { start: self.end, end: self.start, polarity: self.polarity.flipped() }
    }
}

/// Why two points do not make a [`Segment2`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SegmentError {
    /// A coordinate is NaN or infinite.
    NotFinite,
    /// A coordinate is beyond [`Segment2::MAX_COORDINATE_PX`].
    OutOfRange,
    /// The end points are closer than [`Segment2::MIN_LENGTH_PX`].
    TooShort,
}

impl fmt::Display for SegmentError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => f.write_str("segment coordinate is not finite"),
            Self::OutOfRange => write!(f, "segment coordinate is beyond {} px", Segment2::MAX_COORDINATE_PX),
            Self::TooShort => write!(f, "segment is shorter than {} px", Segment2::MIN_LENGTH_PX),
        }
    }
}

impl core::error::Error for SegmentError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_coordinates_are_refused() {
        let good = Point2::new(1.0, 2.0);
        for (bad, error) in [
            (Point2::new(f32::NAN, 0.0), SegmentError::NotFinite),
            (Point2::new(0.0, f32::INFINITY), SegmentError::NotFinite),
            (Point2::new(2049.0, 0.0), SegmentError::OutOfRange),
            (good, SegmentError::TooShort),
        ] {
            assert_eq!(Segment2::new(good, bad, Polarity::LeftBrighter), Err(error));
        }
    }
}

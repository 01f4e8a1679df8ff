//! A straight edge in the image in `f64` \[px\], with the direction and length that the histograms ask for.

use edgeloc::geometry::{Polarity, Segment2};
use std::f64::consts::PI;

/// A straight edge in the image \[px\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NaiveSegment {
    /// First end point.
    pub start: [f64; 2],
    /// Second end point.
    pub end: [f64; 2],
    /// Which side is brighter, walking from start to end.
    pub polarity: Polarity,
}

impl NaiveSegment {
    /// A segment from `start` to `end` whose left side is brighter.
    #[must_use]
    pub const fn new(start: [f64; 2], end: [f64; 2]) -> Self {
        Self { start, end, polarity: Polarity::LeftBrighter }
    }

    /// Length \[px\].
    #[must_use]
    pub fn length_px(&self) -> f64 {
        let [x, y] = self.along();
        x.hypot(y)
    }

    /// Midpoint \[px\].
    #[must_use]
    pub fn midpoint(&self) -> [f64; 2] {
        [0.5 * (self.start[0] + self.end[0]), 0.5 * (self.start[1] + self.end[1])]
    }

    /// Direction in the image frame \[rad\].
    ///
    /// Without polarity an edge has no sense: its direction lies in `[0, pi)`. With polarity it lies in `[0, 2 pi)`, from
    /// start to end, turned by pi when the right side is the brighter, so that the order of the end points carries
    /// no meaning either way.
    #[must_use]
    pub fn direction(&self, uses_polarity: bool) -> f64 {
        let [x, y] = self.along();
        let walked = y.atan2(x);
        if !uses_polarity {
            return wrapped(walked, PI);
        }
        match self.polarity {
            Polarity::LeftBrighter => wrapped(walked, 2.0 * PI),
            Polarity::RightBrighter => wrapped(walked + PI, 2.0 * PI),
        }
    }

    /// The angle to the image's horizontal \[rad\], in `[0, pi / 2]`.
    #[must_use]
    pub fn angle_to_horizontal(&self) -> f64 {
        let [x, y] = self.along();
        y.abs().atan2(x.abs())
    }

    fn along(&self) -> [f64; 2] {
        [self.end[0] - self.start[0], self.end[1] - self.start[1]]
    }
}

impl From<&Segment2> for NaiveSegment {
    fn from(segment: &Segment2) -> Self {
        let (start, end) = (segment.start(), segment.end());
        Self {
            start: [f64::from(start.x), f64::from(start.y)],
            end: [f64::from(end.x), f64::from(end.y)],
            polarity: segment.polarity(),
        }
    }
}

/// `angle` modulo `period`, in `[0, period)`.
pub(super) fn wrapped(angle: f64, period: f64) -> f64 {
    let wrapped = angle.rem_euclid(period);
    // A tiny negative angle rounds up to the period itself.
    if wrapped >= period { 0.0 } else { wrapped }
}

//! What the range sensor measures: distances all around, in one turn.

use crate::math;
use core::fmt;

/// Most rays of a scan.
pub const MAX_RAYS: usize = 720;

/// One turn of a planar range sensor.
///
/// Ray `i` of `n` points `i / n` of a turn counter-clockwise from the robot's heading.
#[derive(Debug, Clone, Copy)]
pub struct RangeScan<'a> {
    ranges_m: &'a [f32],
    max_range_m: f32,
}

impl<'a> RangeScan<'a> {
    /// A scan of distances \[m\]; what is not below `max_range_m` (infinity, say) means that nothing was met so far out.
    ///
    /// # Errors
    /// When there are too few or too many rays, a distance is negative or not a number, or the range is not positive.
    pub fn new(ranges_m: &'a [f32], max_range_m: f32) -> Result<Self, ScanError> {
        if !(8..=MAX_RAYS).contains(&ranges_m.len()) {
            return Err(ScanError::RayCount(ranges_m.len()));
        }
        if !(max_range_m > 0.0 && max_range_m <= 1000.0) {
            return Err(ScanError::MaxRange);
        }
        match ranges_m.iter().position(|&range_m| range_m.is_nan() || range_m < 0.0) {
            Some(ray) => Err(ScanError::Range { ray }),
            None => Ok(Self { ranges_m, max_range_m }),
        }
    }

    /// Every ray: its direction from the robot's heading \[rad\], how far nothing was met \[m\], and whether something
    /// was met there.
    pub(super) fn rays(&self) -> impl Iterator<Item = (f32, f32, bool)> + '_ {
        let spacing = core::f32::consts::TAU / self.ranges_m.len() as f32;
        self.ranges_m.iter().enumerate().map(move |(ray, &range_m)| {
            (ray as f32 * spacing, math::min(range_m, self.max_range_m), range_m < self.max_range_m)
        })
    }
}

/// Why a scan is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ScanError {
    /// Too few or too many rays.
    RayCount(usize),
    /// The range of the sensor is not above 0 and up to 1000 m.
    MaxRange,
    /// A distance is negative or not a number.
    Range {
        /// Which ray.
        ray: usize,
    },
}

impl fmt::Display for ScanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::RayCount(count) => write!(f, "{count} rays are not within 8 to {MAX_RAYS}"),
            Self::MaxRange => f.write_str("the sensor's range is not above 0 and up to 1000 m"),
            Self::Range { ray } => write!(f, "the distance of ray {ray} is negative or not a number"),
        }
    }
}

impl core::error::Error for ScanError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_below_the_range_is_nothing_met() {
        let ranges = [1.0, 8.0, f32::INFINITY, 0.0, 2.0, 2.0, 2.0, 2.0];
        let scan = RangeScan::new(&ranges, 8.0).expect("a scan");
        let rays: std::vec::Vec<_> = scan.rays().map(|(_, range_m, is_met)| (range_m.to_bits(), is_met)).collect();
        let expected = [(1.0_f32, true), (8.0, false), (8.0, false), (0.0, true)];
        assert_eq!(rays[..4], expected.map(|(range_m, is_met)| (range_m.to_bits(), is_met)));
    }

    #[test]
    fn distances_that_are_none_are_refused() {
        assert_eq!(RangeScan::new(&[1.0; 7], 8.0).err(), Some(ScanError::RayCount(7)));
        assert_eq!(RangeScan::new(&[1.0; 8], f32::NAN).err(), Some(ScanError::MaxRange));
        let mut ranges = [1.0; 8];
        for wrong in [f32::NAN, -1.0] {
            ranges[3] = wrong;
            assert_eq!(RangeScan::new(&ranges, 8.0).err(), Some(ScanError::Range { ray: 3 }));
        }
    }
}

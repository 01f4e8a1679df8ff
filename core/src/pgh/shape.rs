//! The shape of a pairwise geometric histogram, as a value that a study can vary.

use core::fmt;

/// Number and meaning of the bins of a histogram.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PghShape {
    /// Bins along the perpendicular distance (paper: `n_dist`), 1 to 256; published optimum 15.
    pub distance_bins: u16,
    /// Bins along the relative angle (paper: `n_angle`), 1 to 256; published optimum 32. Bin centres lie at whole
    /// multiples of the bin width, so that parallel and perpendicular lines fall on a centre, not on a border.
    pub angle_bins: u16,
    /// Greatest perpendicular distance that is counted \[px\]; what lies beyond is cut off.
    pub max_distance_px: f32,
    /// Whether distances have a sign.
    pub distance: DistanceKind,
    /// Whether lines are directed by their contrast polarity: relative angles then span 2 pi instead of pi.
    pub uses_polarity: bool,
    /// Whether mass is shared linearly between the two nearest angle bins, or goes to the nearest alone.
    pub interpolates_angle: bool,
}

/// Which side of the reference line counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DistanceKind {
    /// Bins cover `[-max_distance, max_distance]`.
    Signed,
    /// Bins cover `[0, max_distance]`; a segment that crosses the line fills them from 0 on both sides.
    Unsigned,
}

impl PghShape {
    /// The published optimum: 15 x 32 bins, 400 px, signed, undirected lines, interpolated angle.
    #[must_use]
    pub const fn paper() -> Self {
        Self {
            distance_bins: 15,
            angle_bins: 32,
            max_distance_px: 400.0,
            distance: DistanceKind::Signed,
            uses_polarity: false,
            interpolates_angle: true,
        }
    }

    /// The shape itself, if the fixed-point kernels can serve it.
    ///
    /// # Errors
    /// When a number of bins is not within 1 to 256 or a distance bin is not 0.25 to 1024 px wide.
    pub fn checked(self) -> Result<Self, ShapeError> {
        let counts = 1..=256;
        if !counts.contains(&self.distance_bins) || !counts.contains(&self.angle_bins) {
            return Err(ShapeError::BinCount);
        }
        if !(0.25..=1024.0).contains(&self.distance_bin_width_px()) {
            return Err(ShapeError::DistanceBinWidth);
        }
        Ok(self)
    }

    /// Number of bins in all.
    #[must_use]
    pub const fn bin_count(&self) -> usize {
        (self.distance_bins as usize).saturating_mul(self.angle_bins as usize)
    }

    /// Width of a distance bin \[px\].
    #[must_use]
    pub fn distance_bin_width_px(&self) -> f32 {
        let covered = match self.distance {
            DistanceKind::Signed => 2.0 * self.max_distance_px,
            DistanceKind::Unsigned => self.max_distance_px,
        };
        covered / f32::from(self.distance_bins)
    }

    /// The angle after which a line's direction repeats \[rad\]: 2 pi with polarity, else pi.
    #[must_use]
    pub const fn period_radians(&self) -> f32 {
        if self.uses_polarity { core::f32::consts::TAU } else { core::f32::consts::PI }
    }
}

/// Why a [`PghShape`] can't be served.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShapeError {
    /// A number of bins is not within 1 to 256.
    BinCount,
    /// A distance bin is not 0.25 to 1024 px wide.
    DistanceBinWidth,
}

impl fmt::Display for ShapeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::BinCount => "number of histogram bins is not within 1 to 256",
            Self::DistanceBinWidth => "histogram distance bin is not 0.25 to 1024 px wide",
        })
    }
}

impl core::error::Error for ShapeError {}

//! The parameters of the localiser, all in one place.

use super::{ScoreMargin, VerificationConfig};
use crate::geometry::Angle;
use crate::pgh::{PghShape, ShapeError};
use core::fmt;

/// Parameters of the localiser.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalizerConfig {
    /// Shape of the histograms.
    pub shape: PghShape,
    /// Initial margin `B_th` below the leading node, in summed coefficients, 0 to 1000; see
    /// [`ScoreMargin`].
    pub score_margin: f32,
    /// Turn between looks; the paper's example is 30 degrees.
    pub turn: Angle,
    /// Looks from one place, at least 1; 12 turns of 30 degrees are a full circle. After them the paper's localiser answers
    /// the leading node; the verifying one may ask for [moves](VerificationConfig::moves).
    pub max_looks: u16,
    /// Segments shorter than this are dropped, in the scene and in the prediction \[px\], 0 to 2048.
    pub min_length_px: f32,
    /// Segments within this angle of horizontal are dropped, in the scene and in the prediction, 0 (none is) to below
    /// 90 degrees. Stereo models lack them (paper, section 4.2); treating both sides alike is worth ten points.
    pub horizontal_exclusion: Angle,
    /// Segments kept in a scene and in a prediction, the longest first, 1 to 1024.
    pub max_segments: u16,
    /// In maps with an index and more nodes than this, only so many are scored: those that the first stage finds most
    /// similar, 1 to 4096.
    pub shortlist: u16,
    /// Verify hypotheses about every node, and answer with a pose; without, the paper's localiser answers.
    pub verification: Option<VerificationConfig>,
}

impl LocalizerConfig {
    /// The published optimum, with our readings of what the paper leaves open.
    #[must_use]
    pub const fn paper() -> Self {
        Self {
            shape: PghShape::paper(),
            score_margin: 0.1,
            turn: Angle::from_degrees(30.0),
            max_looks: 12,
            min_length_px: 12.0,
            horizontal_exclusion: Angle::from_degrees(5.0),
            max_segments: 150,
            shortlist: 300,
            verification: None,
        }
    }

    /// The verifying localiser: turns of 60 degrees bring new content, six of them are a full circle.
    #[must_use]
    pub const fn edgeloc() -> Self {
        Self {
            turn: Angle::from_degrees(60.0),
            max_looks: 6,
            verification: Some(VerificationConfig::reference()),
            ..Self::paper()
        }
    }

    /// The parameters themselves, if all are in range.
    ///
    /// # Errors
    /// When one is not: the first such.
    pub fn checked(self) -> Result<Self, ConfigError> {
        self.shape.checked().map_err(ConfigError::Shape)?;
        ScoreMargin::new(self.score_margin).ok_or(ConfigError::ScoreMargin)?;
        if !(self.turn.radians().is_finite() && crate::math::abs(self.turn.radians()) <= core::f32::consts::TAU) {
            return Err(ConfigError::Turn);
        }
        if self.max_looks == 0 {
            return Err(ConfigError::MaxLooks);
        }
        if !(0.0..=2048.0).contains(&self.min_length_px) {
            return Err(ConfigError::MinLength);
        }
        if !(0.0..90.0).contains(&self.horizontal_exclusion.degrees()) {
            return Err(ConfigError::HorizontalExclusion);
        }
        if !(1..=1024).contains(&self.max_segments) {
            return Err(ConfigError::MaxSegments);
        }
        if !(1..=4096).contains(&self.shortlist) {
            return Err(ConfigError::Shortlist);
        }
        if self.verification.is_some_and(|verification| !verification.is_legal()) {
            return Err(ConfigError::Verification);
        }
        Ok(self)
    }
}

/// Which parameter is out of range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ConfigError {
    /// The histogram shape.
    Shape(ShapeError),
    /// The score margin is not within 0 to 1000.
    ScoreMargin,
    /// The turn is not within one turn either way.
    Turn,
    /// The number of looks is zero.
    MaxLooks,
    /// The least length is not within 0 to 2048 px.
    MinLength,
    /// The horizontal exclusion is not within 0 to below 90 degrees.
    HorizontalExclusion,
    /// The number of segments is not within 1 to 1024.
    MaxSegments,
    /// The shortlist is not within 1 to 4096.
    Shortlist,
    /// A parameter of the verification is out of its range.
    Verification,
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Shape(error) => return error.fmt(f),
            Self::ScoreMargin => "score margin is not within 0 to 1000",
            Self::Turn => "turn between looks is not within one full turn",
            Self::MaxLooks => "number of looks is zero",
            Self::MinLength => "least segment length is not within 0 to 2048 px",
            Self::HorizontalExclusion => "horizontal exclusion is not within 0 to below 90 degrees",
            Self::MaxSegments => "number of segments is not within 1 to 1024",
            Self::Shortlist => "length of the shortlist is not within 1 to 4096",
            Self::Verification => "a parameter of the verification is out of its range",
        })
    }
}

impl core::error::Error for ConfigError {}

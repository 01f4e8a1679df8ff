//! Golden looks as bytes: what a robot saw and measured, attempt by attempt, without what came of it.
//!
//! Little-endian, no alignment, one part after the other:
//!
//! | part | fields in order |
//! |---|---|
//! | header | 8 bytes `"edgelook"`; u16 version, 4; u16 number of configurations; u32 number of attempts |
//! | configuration | u16 distance bins, u16 angle bins, f32 greatest distance \[px\]; u8 signed, u8 uses polarity, u8 interpolates the angle, u8 zero; f32 score margin; f32 turn \[rad\]; u16 most looks, u16 most segments, u16 shortlist; f32 least length \[px\]; f32 horizontal exclusion \[rad\]; u8 verifies, u8 looks next where predicted; u16 cells per side, u16 headings, u16 refined, u16 finalists, u16 moves; f32 reach, f32 confidence, f32 move \[m\]; zeros where nothing is verified |
//! | attempt | u8 length of its name, the name in UTF-8; u16 index of its configuration; u16 number of looks; u32 words of memory, 0 for as many as it takes; its looks |
//! | look | u8 whether there is a heading, f32 heading and f32 its standard deviation \[rad\]; u8 whether there is odometry, f32 turn \[rad\] and f32 way straight ahead after it \[m\]; u16 number of segments; the segments |
//! | segment | f32 start x and y, f32 end x and y \[px\]; u8 1 where the brighter side lies to the right |
//!
//! Configurations need not be legal: that they are refused is an expectation like any other.

use core::fmt;

use edgeloc::geometry::{Angle, Heading, Point2, Polarity, Segment2, SegmentError};
use edgeloc::localize::{HeadingPrior, LocalizerConfig, Motion, NextLook, VerificationConfig};
use edgeloc::pgh::{DistanceKind, PghShape};

/// The first eight bytes.
pub const MAGIC: [u8; 8] = *b"edgelook";
/// The version this crate reads.
pub const VERSION: u16 = 4;
/// Length of a configuration.
pub const CONFIG_LEN: usize = 58;
/// Length of a segment.
pub const SEGMENT_LEN: usize = 17;

/// Reads golden looks from their beginning to their end.
#[derive(Debug, Clone)]
pub struct LooksReader<'a> {
    configs: &'a [u8],
    attempt_count: u32,
    cursor: Cursor<'a>,
}

/// The head of an attempt; its looks follow.
#[derive(Debug, Clone, Copy)]
pub struct Attempt<'a> {
    /// What it is there for.
    pub name: &'a str,
    /// The localizer's parameters, legal or not.
    pub config: LocalizerConfig,
    /// Looks that follow.
    pub look_count: u16,
    /// Words of memory that the localizer is given; `None` for as many as it takes.
    pub memory_words: Option<usize>,
}

/// The head of a look, and its segments still as bytes.
#[derive(Debug, Clone, Copy)]
pub struct GoldenLook<'a> {
    /// The measured heading, if there is a compass.
    pub heading: Option<HeadingPrior>,
    /// What odometry tells of the way from the look before, if there is odometry.
    pub motion: Option<Motion>,
    segments: &'a [u8],
}

impl<'a> LooksReader<'a> {
    /// Begins to read `bytes`.
    ///
    /// # Errors
    /// When they are not golden looks of this version, or end too early.
    pub fn new(bytes: &'a [u8]) -> Result<Self, LooksError> {
        let mut cursor = Cursor { rest: bytes };
        if cursor.array()? != MAGIC {
            return Err(LooksError::NotLooks);
        }
        let version = cursor.u16()?;
        if version != VERSION {
            return Err(LooksError::Version { found: version });
        }
        let config_count = usize::from(cursor.u16()?);
        let attempt_count = cursor.u32()?;
        let configs = cursor.take(config_count * CONFIG_LEN)?;
        Ok(Self { configs, attempt_count, cursor })
    }

    /// Number of attempts.
    #[must_use]
    pub const fn attempt_count(&self) -> u32 {
        self.attempt_count
    }

    /// The next attempt; call it [`attempt_count`](Self::attempt_count) times, with all looks read between.
    ///
    /// # Errors
    /// When the bytes end or contradict themselves.
    pub fn attempt(&mut self) -> Result<Attempt<'a>, LooksError> {
        let name_len = usize::from(self.cursor.u8()?);
        let name = core::str::from_utf8(self.cursor.take(name_len)?).map_err(|_| LooksError::Name)?;
        let config_index = self.cursor.u16()?;
        let config = self.configs.chunks_exact(CONFIG_LEN).nth(usize::from(config_index));
        let config = config.ok_or(LooksError::ConfigIndex { found: config_index })?;
        let config = read_config(&mut Cursor { rest: config })?;
        let look_count = self.cursor.u16()?;
        let memory_words = Some(self.cursor.u32()? as usize).filter(|&words| words > 0);
        Ok(Attempt { name, config, look_count, memory_words })
    }

    /// The next look of the attempt.
    ///
    /// # Errors
    /// When the bytes end or hold no heading where one is announced.
    pub fn look(&mut self) -> Result<GoldenLook<'a>, LooksError> {
        let has_heading = self.cursor.u8()? != 0;
        let (radians, spread_rad) = (self.cursor.f32()?, self.cursor.f32()?);
        let heading = match has_heading {
            true => Some(HeadingPrior {
                mean: Heading::new(Angle::from_radians(radians)).ok_or(LooksError::Heading)?,
                standard_deviation: Angle::from_radians(spread_rad),
            }),
            false => None,
        };
        let has_odometry = self.cursor.u8()? != 0;
        let (turn, ahead_m) = (Angle::from_radians(self.cursor.f32()?), self.cursor.f32()?);
        let motion = has_odometry.then(|| Motion::exact(turn, ahead_m));
        let segment_count = usize::from(self.cursor.u16()?);
        Ok(GoldenLook { heading, motion, segments: self.cursor.take(segment_count * SEGMENT_LEN)? })
    }

    /// Whether every byte was read.
    #[must_use]
    pub const fn is_at_end(&self) -> bool {
        self.cursor.rest.is_empty()
    }
}

impl GoldenLook<'_> {
    /// The segments seen, each checked as it is read.
    pub fn segments(&self) -> impl Iterator<Item = Result<Segment2, LooksError>> {
        self.segments.chunks_exact(SEGMENT_LEN).map(|bytes| {
            let mut cursor = Cursor { rest: bytes };
            let start = Point2::new(cursor.f32()?, cursor.f32()?);
            let end = Point2::new(cursor.f32()?, cursor.f32()?);
            let polarity = if cursor.u8()? == 0 { Polarity::LeftBrighter } else { Polarity::RightBrighter };
            Segment2::new(start, end, polarity).map_err(LooksError::Segment)
        })
    }
}

fn read_config(cursor: &mut Cursor<'_>) -> Result<LocalizerConfig, LooksError> {
    let (distance_bins, angle_bins, max_distance_px) = (cursor.u16()?, cursor.u16()?, cursor.f32()?);
    let [is_signed, uses_polarity, interpolates_angle, _] = cursor.array()?.map(|flag| flag != 0);
    let distance = if is_signed { DistanceKind::Signed } else { DistanceKind::Unsigned };
    let shape = PghShape { distance_bins, angle_bins, max_distance_px, distance, uses_polarity, interpolates_angle };
    let config = LocalizerConfig {
        shape,
        score_margin: cursor.f32()?,
        turn: Angle::from_radians(cursor.f32()?),
        max_looks: cursor.u16()?,
        max_segments: cursor.u16()?,
        shortlist: cursor.u16()?,
        min_length_px: cursor.f32()?,
        horizontal_exclusion: Angle::from_radians(cursor.f32()?),
        verification: None,
    };
    let [verifies, is_predicted] = cursor.array()?.map(|flag| flag != 0);
    let verification = VerificationConfig {
        next_look: if is_predicted { NextLook::Predicted } else { NextLook::Fixed },
        cells_per_side: cursor.u16()?,
        headings: cursor.u16()?,
        refined: cursor.u16()?,
        finalists: cursor.u16()?,
        moves: cursor.u16()?,
        reach: cursor.f32()?,
        confidence: cursor.f32()?,
        move_m: cursor.f32()?,
    };
    Ok(LocalizerConfig { verification: verifies.then_some(verification), ..config })
}

/// The bytes not yet read.
#[derive(Debug, Clone)]
struct Cursor<'a> {
    rest: &'a [u8],
}

impl<'a> Cursor<'a> {
    fn take(&mut self, length: usize) -> Result<&'a [u8], LooksError> {
        let (taken, rest) = self.rest.split_at_checked(length).ok_or(LooksError::Truncated)?;
        self.rest = rest;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], LooksError> {
        let (taken, rest) = self.rest.split_first_chunk().ok_or(LooksError::Truncated)?;
        self.rest = rest;
        Ok(*taken)
    }

    fn u8(&mut self) -> Result<u8, LooksError> {
        self.array().map(|[byte]| byte)
    }

    fn u16(&mut self) -> Result<u16, LooksError> {
        self.array().map(u16::from_le_bytes)
    }

    fn u32(&mut self) -> Result<u32, LooksError> {
        self.array().map(u32::from_le_bytes)
    }

    fn f32(&mut self) -> Result<f32, LooksError> {
        self.array().map(f32::from_le_bytes)
    }
}

/// Why bytes are not golden looks that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LooksError {
    /// The first bytes are not those of golden looks.
    NotLooks,
    /// They have a version that this program does not read.
    Version {
        /// The version found.
        found: u16,
    },
    /// The bytes end before the looks do.
    Truncated,
    /// An attempt's name is not UTF-8.
    Name,
    /// An attempt names a configuration that is not there.
    ConfigIndex {
        /// The index found.
        found: u16,
    },
    /// A heading is not finite or beyond a thousand turns.
    Heading,
    /// A segment is none.
    Segment(SegmentError),
}

impl fmt::Display for LooksError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotLooks => f.write_str("not golden looks"),
            Self::Version { found } => write!(f, "golden looks of version {found}, expected {VERSION}"),
            Self::Truncated => f.write_str("golden looks are cut off"),
            Self::Name => f.write_str("name of a golden attempt is not UTF-8"),
            Self::ConfigIndex { found } => write!(f, "golden attempt names configuration {found}, which is not there"),
            Self::Heading => f.write_str("golden heading is not finite or beyond a thousand turns"),
            Self::Segment(error) => write!(f, "golden segment: {error}"),
        }
    }
}

impl core::error::Error for LooksError {}

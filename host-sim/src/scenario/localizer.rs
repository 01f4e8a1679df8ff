//! The localiser as a scenario states it; by default the paper's.

use super::decimal;
use edgeloc::geometry::Angle;
use edgeloc::localize::{LocalizerConfig, NextLook, VerificationConfig};
use edgeloc::pgh::{DistanceKind, PghShape};
use serde::{Deserialize, Serialize};

/// The localiser's settings.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LocalizerSettings {
    /// Which localiser.
    pub kind: LocalizerKind,
    /// B_th: how far a node's score may lie below the leader's at the first look (paper, section 3.2).
    pub score_margin: f64,
    /// Turn before the next look in degrees, counter-clockwise.
    pub turn_deg: f64,
    /// Looks from one place; then the paper's localiser answers the leading node, and ours moves or says what it knows.
    pub max_looks: u16,
    /// Shorter image segments are dropped in pixels.
    pub min_length_px: f64,
    /// Image segments this close to the horizontal are dropped on both sides in degrees: stereo models lack them.
    pub horizontal_exclusion_deg: f64,
    /// The longest segments of a scene that enter the matching.
    pub max_segments: u16,
    /// Nodes that are scored in a map with an index and more nodes than that: those most like what is seen.
    pub shortlist: u16,
    /// The pairwise geometric histograms.
    pub pgh: PghSettings,
    /// Geometric verification, with `kind = "edgeloc"`.
    pub verification: VerificationSettings,
}

impl Default for LocalizerSettings {
    fn default() -> Self {
        Self {
            kind: LocalizerKind::Paper,
            score_margin: 0.1,
            turn_deg: 30.0,
            max_looks: 12,
            min_length_px: 12.0,
            horizontal_exclusion_deg: 5.0,
            max_segments: 150,
            shortlist: 300,
            pgh: PghSettings::default(),
            verification: VerificationSettings::default(),
        }
    }
}

impl LocalizerSettings {
    /// The localiser's parameters in a row with or without polarity.
    #[must_use]
    pub fn localizer_config(&self, polarity: bool) -> LocalizerConfig {
        let PghSettings { distance_bins, angle_bins, max_distance_px, signed, angle_interpolation } = self.pgh;
        LocalizerConfig {
            shape: PghShape {
                distance_bins,
                angle_bins,
                max_distance_px: max_distance_px as f32,
                distance: if signed { DistanceKind::Signed } else { DistanceKind::Unsigned },
                uses_polarity: polarity,
                interpolates_angle: angle_interpolation,
            },
            score_margin: self.score_margin as f32,
            turn: Angle::from_degrees(self.turn_deg as f32),
            max_looks: self.max_looks,
            min_length_px: self.min_length_px as f32,
            horizontal_exclusion: Angle::from_degrees(self.horizontal_exclusion_deg as f32),
            max_segments: self.max_segments,
            shortlist: self.shortlist,
            verification: match self.kind {
                LocalizerKind::Paper => None,
                LocalizerKind::Edgeloc => Some(self.verification.config()),
            },
        }
    }
}

/// Which localiser a run uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LocalizerKind {
    /// The paper's: histogram scores summed over looks, candidates within a shrinking margin of the leader.
    Paper,
    /// Ours: poses about every node checked against all looks, answered with a metric pose.
    Edgeloc,
}

/// Size and reading of the pairwise geometric histograms (paper, section 3.2).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PghSettings {
    /// Bins of the perpendicular distance; 15 in the paper.
    pub distance_bins: u16,
    /// Bins of the relative angle; 32 in the paper.
    pub angle_bins: u16,
    /// Greatest perpendicular distance counted in pixels.
    pub max_distance_px: f64,
    /// Whether the two sides of the reference line count apart.
    pub signed: bool,
    /// Whether an angle is shared linearly by the two nearest bins.
    pub angle_interpolation: bool,
}

impl Default for PghSettings {
    fn default() -> Self {
        Self { distance_bins: 15, angle_bins: 32, max_distance_px: 400.0, signed: true, angle_interpolation: true }
    }
}

/// Geometric verification: how many poses are tried, and when the best is sure enough.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct VerificationSettings {
    /// Positions tried along either side of the square about each node; odd.
    pub cells_per_side: u16,
    /// How far that square reaches to either side, in distances from a node to the next.
    pub reach: f64,
    /// Headings that may be tried in every cell: 1 does for 2.5 degrees, 3 beyond, 4 without a compass.
    pub headings: u16,
    /// Lead of the best over its best rival, times the root of the segments seen in thirties, that is answered.
    pub confidence: f64,
    /// Hypotheses posed more closely after each look.
    pub refined: u16,
    /// Hypotheses posed most closely.
    pub finalists: u16,
    /// Where to look next: "predicted", the view that tells rivals apart best, or "fixed", a turn of `turn_deg` on.
    pub next_look: NextLookKind,
    /// Exploratory moves asked for where turns can't tell; none of a robot without odometry.
    pub moves: u16,
    /// Length of a move where there is room in metres.
    pub move_m: f64,
}

/// Where a robot that is not sure yet looks next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NextLookKind {
    /// A turn of `turn_deg` on.
    Fixed,
    /// The view that is predicted to tell the best place from its rivals best.
    Predicted,
}

impl Default for VerificationSettings {
    fn default() -> Self {
        let VerificationConfig {
            cells_per_side,
            reach,
            headings,
            confidence,
            refined,
            finalists,
            next_look,
            moves,
            move_m,
        } = VerificationConfig::reference();
        let next_look = match next_look {
            NextLook::Fixed => NextLookKind::Fixed,
            NextLook::Predicted => NextLookKind::Predicted,
        };
        let (reach, confidence, move_m) = (decimal(reach), decimal(confidence), decimal(move_m));
        Self { cells_per_side, reach, headings, confidence, refined, finalists, next_look, moves, move_m }
    }
}

impl VerificationSettings {
    fn config(&self) -> VerificationConfig {
        let Self { cells_per_side, reach, headings, confidence, refined, finalists, next_look, moves, move_m } = *self;
        let next_look = match next_look {
            NextLookKind::Fixed => NextLook::Fixed,
            NextLookKind::Predicted => NextLook::Predicted,
        };
        let (reach, confidence, move_m) = (reach as f32, confidence as f32, move_m as f32);
        VerificationConfig { cells_per_side, reach, headings, confidence, refined, finalists, next_look, moves, move_m }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_is_the_published_localiser() {
        assert_eq!(LocalizerSettings::default().localizer_config(false), LocalizerConfig::paper());
    }

    #[test]
    fn ours_is_the_library_s_own() {
        let ours = LocalizerSettings {
            kind: LocalizerKind::Edgeloc,
            turn_deg: 60.0,
            max_looks: 6,
            ..LocalizerSettings::default()
        };
        assert_eq!(ours.localizer_config(false), LocalizerConfig::edgeloc());
    }
}

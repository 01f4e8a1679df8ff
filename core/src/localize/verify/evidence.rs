//! What speaks for a hypothesis, in integers.

use zerocopy::{FromBytes, Immutable, IntoBytes};

/// Model length that was predicted, and what of it the scenes explain beyond chance, both weighted, in Q4 px.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, FromBytes, IntoBytes, Immutable)]
#[repr(C)]
pub struct Evidence {
    /// Weighted length times (response - background); negative when the scenes speak against the hypothesis.
    pub explained_q4: i32,
    /// Weighted length times (1 - background): what `explained_q4` would be in perfect agreement.
    pub total_q4: i32,
}

impl Evidence {
    /// The evidence of two looks at the same pose.
    #[must_use]
    pub const fn plus(self, other: Self) -> Self {
        Self {
            explained_q4: self.explained_q4.saturating_add(other.explained_q4),
            total_q4: self.total_q4.saturating_add(other.total_q4),
        }
    }

    /// The one that agrees better with a look, by two models.
    pub(super) fn better(self, other: Self, seen_q4: i32) -> Self {
        if other.score_q20(seen_q4) > self.score_q20(seen_q4) { other } else { self }
    }

    /// Agreement of model and scenes in Q20: 1 for a model that explains all that was seen and nothing else.
    ///
    /// `2 explained / (total + seen + 50 px)`: symmetric, so that neither empty nor crowded models win.
    #[must_use]
    pub fn score_q20(self, seen_q4: i32) -> i32 {
        const SLACK_Q4: i64 = 50 * 16;
        let whole = i64::from(self.total_q4) + i64::from(seen_q4) + SLACK_Q4;
        ((i64::from(self.explained_q4) << 21) / whole.max(1)) as i32
    }
}

/// The evidence of all looks so far for one cell of the grid, in whole px: half the memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, FromBytes, IntoBytes, Immutable)]
#[repr(C)]
pub(super) struct CellEvidence {
    explained_px: i16,
    total_px: u16,
}

impl CellEvidence {
    /// Adds the evidence of a look.
    pub(super) const fn add(&mut self, look: Evidence) {
        let (explained, total) = ((look.explained_q4 + 8) >> 4, (look.total_q4 + 8) >> 4);
        let explained = self.explained_px as i32 + explained;
        let total = self.total_px as i32 + total;
        self.explained_px = if explained > i16::MAX as i32 {
            i16::MAX
        } else if explained <= i16::MIN as i32 {
            -i16::MAX
        } else {
            explained as i16
        };
        self.total_px = if total > u16::MAX as i32 { u16::MAX } else { total as u16 };
    }

    /// Whether the cell was given up.
    pub(super) const fn is_refuted(self) -> bool {
        self.explained_px == i16::MIN
    }

    /// Gives the cell up if it scores less than `floor_q20`, with `seen_q4` of segments seen.
    pub(super) fn refute_below(&mut self, floor_q20: i32, seen_q4: i32) {
        if self.evidence().score_q20(seen_q4) < floor_q20 {
            self.explained_px = i16::MIN;
        }
    }

    /// The evidence in the unit of a hypothesis.
    pub(super) const fn evidence(self) -> Evidence {
        Evidence { explained_q4: (self.explained_px as i32) << 4, total_q4: (self.total_px as i32) << 4 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_model_that_explains_everything_and_nothing_else_scores_one() {
        let perfect = Evidence { explained_q4: 80_000, total_q4: 80_000 };
        let score = f64::from(perfect.score_q20(80_000)) / f64::from(1 << 20);
        assert!((0.99..1.0).contains(&score), "{score}");
    }

    #[test]
    fn empty_and_crowded_models_score_less() {
        let seen_q4 = 16_000;
        let score = |explained_q4, total_q4| Evidence { explained_q4, total_q4 }.score_q20(seen_q4);
        assert!(score(16_000, 16_000) > score(4_000, 4_000));
        assert!(score(16_000, 16_000) > score(16_000, 64_000));
        assert_eq!(score(0, 0), 0);
    }

    #[test]
    fn a_cell_keeps_what_looks_add_to_within_a_pixel_a_look() {
        let mut cell = CellEvidence::default();
        let look = Evidence { explained_q4: -1_234, total_q4: 43_210 };
        cell.add(look);
        cell.add(look);
        let (kept, exact) = (cell.evidence(), look.plus(look));
        assert!((kept.explained_q4 - exact.explained_q4).abs() <= 16 && (kept.total_q4 - exact.total_q4).abs() <= 16);
    }
}

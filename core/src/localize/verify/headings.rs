//! Which headings are tried: about the compass' one, or along and across the building where there is no compass.

use crate::math;

/// Most headings that are tried in a cell of the grid.
pub(super) const MAX_HEADINGS: usize = 9;
/// A compass of less spread than this needs one heading in the grid \[rad\]: 2.5 degrees.
const ONE_HEADING_RAD: f32 = 0.0436;
/// Headings tried about one that the compass tells.
const ABOUT_COMPASS: usize = 3;
/// Standard deviations of the compass to either side that a heading of the grid stands for: where it is the only one,
/// and where it has others beside it.
const COMPASS_LEFT: [f32; 2] = [1.5, 0.7];
/// What the dominant direction may be off \[rad\]: 2 degrees.
const DOMINANT_LEFT_RAD: f32 = 0.035;

/// The headings tried in each cell of the grid, as errors of the heading told at the first look.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Headings {
    errors_rad: [f32; MAX_HEADINGS],
    count: usize,
    /// What each may be off to either side \[rad\].
    pub(super) left_rad: f32,
}

impl Headings {
    /// About what a compass of that spread tells, `most` at most.
    pub(super) fn about_compass(spread_rad: f32, most: usize) -> Self {
        let count = if spread_rad > ONE_HEADING_RAD && most >= ABOUT_COMPASS { ABOUT_COMPASS } else { 1 };
        let left_rad = COMPASS_LEFT[usize::from(count > 1)] * spread_rad;
        let mut errors_rad = [0.0; MAX_HEADINGS];
        for (index, error_rad) in errors_rad.iter_mut().enumerate().take(count) {
            *error_rad = (index as f32 - (count / 2) as f32) * 2.0 * left_rad;
        }
        Self { errors_rad, count, left_rad }
    }

    /// Along and across the building, both ways, `most` at most: the heading at the first look is `turn_rad` and quarter
    /// turns more.
    pub(super) fn quarter_turns(turn_rad: f32, most: usize) -> Self {
        let mut errors_rad = [0.0; MAX_HEADINGS];
        let count = most.min(4);
        for (index, error_rad) in errors_rad.iter_mut().enumerate().take(count) {
            *error_rad = turn_rad + index as f32 * core::f32::consts::FRAC_PI_2;
        }
        Self { errors_rad, count, left_rad: DOMINANT_LEFT_RAD }
    }

    /// The errors tried.
    pub(super) fn errors_rad(&self) -> &[f32] {
        &self.errors_rad[..self.count]
    }

    /// Whether the other headings are these, within what they may be off.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        let nearest = |error: &f32| {
            other.errors_rad().iter().map(|other| math::abs(error - other)).fold(f32::INFINITY, math::min)
        };
        self.count == other.count && self.errors_rad().iter().all(|error| nearest(error) <= 0.75 * self.left_rad)
    }
}

//! The exploratory moves of an attempt: how many were made, and where the way was blocked.

use super::kept_looks::KeptLooks;
use crate::geometry::Angle;
use crate::math;

/// Blocked ways that are remembered; a robot that met more of them is not asked to move again.
const BLOCKED: usize = 3;
/// A way this near to a blocked one is blocked too \[rad\]: 40 degrees.
const ALIKE_RAD: f32 = 0.7;

/// Moves asked for and made.
#[derive(Debug, Default)]
pub(super) struct Moves {
    made: u16,
    /// The heading of the move that was asked for last, until it is known what became of it \[rad\].
    asked_rad: Option<f32>,
    blocked_rad: [f32; BLOCKED],
    blocked: usize,
}

impl Moves {
    /// Whether the robot may be asked to move, `most` times in all.
    pub(super) const fn may_be_more(&self, most: u16) -> bool {
        self.made < most && self.blocked < BLOCKED
    }

    /// Remembers that a turn and a step were asked for after the last of `looks`.
    pub(super) fn ask(&mut self, looks: &KeptLooks<'_>, turn: Angle) {
        self.asked_rad = looks.here().last().map(|last| last.heading_rad + turn.radians());
    }

    /// Sees from the last of `looks` what became of the move asked for: the robot stands elsewhere, or where it stood.
    pub(super) fn look(&mut self, looks: &KeptLooks<'_>) {
        let is_elsewhere = looks.here().len() == 1;
        if is_elsewhere {
            self.blocked = 0;
        }
        let Some(asked_rad) = self.asked_rad.take() else { return };
        if is_elsewhere {
            self.made += 1;
        } else if let Some(place) = self.blocked_rad.get_mut(self.blocked) {
            *place = asked_rad;
            self.blocked += 1;
        }
    }

    /// Whether a robot that stands here was blocked on the way along a heading as told.
    pub(super) fn is_blocked(&self, heading_rad: f32) -> bool {
        let is_alike =
            |blocked: &f32| math::abs(Angle::from_radians(heading_rad - blocked).wrapped().radians()) < ALIKE_RAD;
        self.blocked_rad[..self.blocked].iter().any(is_alike)
    }
}

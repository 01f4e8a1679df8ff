//! The lines of a scene by field, in blocks that a vector machine takes at once.

use super::Line;
use zerocopy::{FromBytes, Immutable, IntoBytes};

/// Lines in a block: one vector of the widest machine. Where there are no vectors, one line at a time stays in registers.
pub(super) const BLOCK: usize = if cfg!(target_pointer_width = "64") { WIDEST } else { 1 };

/// Memory is for whole blocks of this many on every machine, so that all ask for the same.
pub(super) const WIDEST: usize = 16;

/// Some lines of a scene, field by field; places left empty hold lines without mass.
#[derive(Debug, Clone, Copy, PartialEq, FromBytes, IntoBytes, Immutable)]
#[repr(C)]
pub struct LineBlock {
    pub(super) start_x_q4: [i32; BLOCK],
    pub(super) start_y_q4: [i32; BLOCK],
    pub(super) end_x_q4: [i32; BLOCK],
    pub(super) end_y_q4: [i32; BLOCK],
    /// Masses in units of 1/256 px: 16 times a length in Q4 px.
    pub(super) mass: [f32; BLOCK],
    pub(super) direction: [i32; BLOCK],
}

impl LineBlock {
    /// A block of no lines.
    pub const EMPTY: Self = Self {
        start_x_q4: [0; BLOCK],
        start_y_q4: [0; BLOCK],
        end_x_q4: [0; BLOCK],
        end_y_q4: [0; BLOCK],
        mass: [0.0; BLOCK],
        direction: [0; BLOCK],
    };

    /// Number of blocks to keep for up to `lines` lines.
    #[must_use]
    pub const fn count_for(lines: usize) -> usize {
        lines.div_ceil(WIDEST) * (WIDEST / BLOCK)
    }

    /// Up to [`BLOCK`] lines.
    pub(super) fn of(lines: &[Line]) -> Self {
        let mut block = Self::EMPTY;
        for (place, line) in lines.iter().enumerate().take(BLOCK) {
            [block.start_x_q4[place], block.start_y_q4[place]] = line.start_q4;
            [block.end_x_q4[place], block.end_y_q4[place]] = line.end_q4;
            block.mass[place] = (line.length_q4 << 4) as f32;
            block.direction[place] = line.direction as i32;
        }
        block
    }
}

//! The paper's localiser's memory: one slice from the caller, divided once.

use super::extent::Extent;
use super::{LocalizerConfig, NodeScore};
use crate::geometry::CapacityError;
use crate::matching::{BinPair, Panel, PanelRow, RootRows};
use crate::pgh::{HistogramBuilder, Line, LineBlock};
use zerocopy::{FromBytes, IntoBytes};

/// The parts that the caller's memory is divided into.
#[derive(Debug)]
pub(super) struct Workspace<'m> {
    pub(super) scene_lines: &'m mut [Line],
    pub(super) view_lines: &'m mut [Line],
    pub(super) masses: &'m mut [i32],
    pub(super) line_blocks: &'m mut [LineBlock],
    pub(super) scene_pairs: &'m mut [BinPair],
    pub(super) scene_row_ends: &'m mut [u32],
    pub(super) panel_rows: &'m mut [PanelRow],
    pub(super) best_coefficients: &'m mut [i32],
    pub(super) node_scores: &'m mut [NodeScore],
    pub(super) similarities: &'m mut [i16],
}

/// How many items each part has.
struct Lengths {
    lines: usize,
    masses: usize,
    line_blocks: usize,
    pairs: usize,
    panel_rows: usize,
    nodes: usize,
    similarities: usize,
}

impl Lengths {
    const fn of(config: &LocalizerConfig, extent: Extent) -> Self {
        let (lines, bins) = (config.max_segments as usize, config.shape.bin_count());
        Self {
            lines,
            masses: HistogramBuilder::memory_len(&config.shape),
            line_blocks: LineBlock::count_for(lines),
            pairs: RootRows::pairs_len(lines, bins),
            panel_rows: Panel::rows_len(bins),
            nodes: extent.nodes,
            similarities: extent.compared,
        }
    }
}

/// Number of `u64` that a localiser works on.
pub(super) const fn memory_len(config: &LocalizerConfig, extent: Extent) -> usize {
    let lengths = Lengths::of(config, extent);
    sum(&[
        words::<Line>(lengths.lines),
        words::<Line>(lengths.lines),
        words::<i32>(lengths.masses),
        words::<LineBlock>(lengths.line_blocks),
        words::<BinPair>(lengths.pairs),
        words::<u32>(lengths.lines),
        words::<PanelRow>(lengths.panel_rows),
        words::<i32>(lengths.lines),
        words::<NodeScore>(lengths.nodes),
        words::<i16>(lengths.similarities),
    ])
}

/// Saturates, as [`words`] does.
pub(super) const fn sum(parts: &[usize]) -> usize {
    let (mut total, mut part) = (0_usize, 0);
    while part < parts.len() {
        total = total.saturating_add(parts[part]);
        part += 1;
    }
    total
}

/// Saturates, so that a configuration out of range asks for more memory than there is and is refused.
pub(super) const fn words<T>(count: usize) -> usize {
    count.saturating_mul(size_of::<T>()).div_ceil(size_of::<u64>()).saturating_add(slack::<T>())
}

/// Words that may be skipped before items that begin with a larger boundary than a word's.
const fn slack<T>() -> usize {
    align_of::<T>().div_ceil(size_of::<u64>()) - 1
}

impl<'m> Workspace<'m> {
    /// Divides the beginning of `memory`, at least [`memory_len`] long.
    pub(super) fn divide(
        memory: &'m mut [u64],
        config: &LocalizerConfig,
        extent: Extent,
    ) -> Result<Self, CapacityError> {
        let lengths = Lengths::of(config, extent);
        let too_small = CapacityError {
            what: "localizer memory in 64-bit words",
            capacity: memory.len(),
            needed: memory_len(config, extent),
        };
        let mut rest = Rest::new(memory);
        let mut divide = || {
            Some(Self {
                scene_lines: rest.take(lengths.lines)?,
                view_lines: rest.take(lengths.lines)?,
                masses: rest.take(lengths.masses)?,
                line_blocks: rest.take(lengths.line_blocks)?,
                scene_pairs: rest.take(lengths.pairs)?,
                scene_row_ends: rest.take(lengths.lines)?,
                panel_rows: rest.take(lengths.panel_rows)?,
                best_coefficients: rest.take(lengths.lines)?,
                node_scores: rest.take(lengths.nodes)?,
                similarities: rest.take(lengths.similarities)?,
            })
        };
        divide().ok_or(too_small)
    }
}

/// What is left of the caller's memory.
#[derive(Debug)]
pub(super) struct Rest<'m> {
    words: &'m mut [u64],
}

impl<'m> Rest<'m> {
    pub(super) const fn new(words: &'m mut [u64]) -> Self {
        Self { words }
    }

    /// The next `count` items.
    pub(super) fn take<T: FromBytes + IntoBytes>(&mut self, count: usize) -> Option<&'m mut [T]> {
        let (taken, rest) = core::mem::take(&mut self.words).split_at_mut_checked(words::<T>(count))?;
        self.words = rest;
        let skipped = taken.as_ptr().align_offset(align_of::<T>().max(size_of::<u64>()));
        let taken = taken.get_mut(skipped..)?;
        let (items, _) = <[T]>::mut_from_prefix_with_elems(taken.as_mut_bytes(), count).ok()?;
        Some(items)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stated_length_is_just_enough() {
        let config = LocalizerConfig::paper();
        const NEEDED: usize = memory_len(&LocalizerConfig::paper(), Extent::whole(72));
        let mut memory = [0; NEEDED];
        assert!(Workspace::divide(&mut memory, &config, Extent::whole(72)).is_ok());
        let error = Workspace::divide(&mut memory[1..], &config, Extent::whole(72)).expect_err("one word short");
        assert_eq!((error.capacity, error.needed), (NEEDED - 1, NEEDED));
    }
}

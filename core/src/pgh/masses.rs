//! A histogram on its way: masses first, then their roots.

use super::block::{BLOCK, LineBlock, WIDEST};
use super::frame::{Frame, Reach};
use super::one_by_one;
use super::root::root_q15;
use super::{DistanceKind, PghShape};
use core::ops::Range;

/// Columns behind the last angle bin, for what belongs to the first ones after the wrap.
const WRAPPED: usize = 2;

/// Columns of the grids, whole vectors.
pub(super) const fn stride_of(angle_bins: usize, block: usize) -> usize {
    (angle_bins + WRAPPED).next_multiple_of(block)
}

/// Masses in units of 1/256 px of length.
#[derive(Debug)]
pub(super) struct Masses<'m> {
    distance_bins: usize,
    angle_bins: usize,
    distance: DistanceKind,
    /// `[distance + 1][stride]`: masses in the first and the last distance bin of each line; empty between histograms.
    ends: &'m mut [i32],
    /// The same of mass differences along the distance axis, for the bins between.
    steps: &'m mut [i32],
    /// `[distance][angle]`: the histogram, and up to three bins more.
    bins: &'m mut [i32],
    /// Indices of the pairs of bins that aren't empty; or the roots of pairs.
    indices: &'m mut [i32],
}

/// What is known of the masses of a histogram.
#[derive(Debug)]
pub(super) struct Filled {
    /// One by their total.
    per_mass: f32,
    /// The pairs of bins that may hold any.
    pairs: Range<usize>,
}

impl Filled {
    /// `None` if there is no mass.
    #[inline(always)]
    fn of(total: u32, pairs: Range<usize>) -> Option<Self> {
        (total > 0).then(|| Self { per_mass: 1.0 / total as f32, pairs })
    }
}

impl<'m> Masses<'m> {
    /// The same on every machine, whatever its stride.
    const fn grid_len(shape: &PghShape) -> usize {
        (shape.distance_bins as usize + 1).saturating_mul(stride_of(shape.angle_bins as usize, WIDEST))
    }

    const fn bins_len(shape: &PghShape) -> usize {
        shape.bin_count().next_multiple_of(4)
    }

    /// Number of `i32` they lie in.
    pub(super) const fn memory_len(shape: &PghShape) -> usize {
        2 * Self::grid_len(shape) + Self::bins_len(shape) + Self::bins_len(shape) / 2 + WIDEST - 1
    }

    /// No masses, in `memory` of [`Self::memory_len`].
    pub(super) fn new(shape: &PghShape, memory: &'m mut [i32]) -> Self {
        // The grids begin with a cache line; where that can't be told they may lie anywhere.
        let unaligned = memory.as_ptr().align_offset(size_of::<[i32; WIDEST]>()).min(WIDEST - 1);
        let (ends, memory) = memory[unaligned..].split_at_mut(Self::grid_len(shape));
        let (steps, memory) = memory.split_at_mut(Self::grid_len(shape));
        let (bins, indices) = memory.split_at_mut(Self::bins_len(shape));
        ends.fill(0);
        steps.fill(0);
        bins.fill(0);
        Self {
            distance_bins: usize::from(shape.distance_bins),
            angle_bins: usize::from(shape.angle_bins),
            distance: shape.distance,
            ends,
            steps,
            bins,
            indices,
        }
    }

    /// Brings together what all lines of the `blocks` have in `frame`; `None` if that is nothing.
    #[inline(always)]
    pub(super) fn gather(&mut self, frame: &Frame<'_>, blocks: &[LineBlock]) -> Option<Filled> {
        if BLOCK == 1 { self.add_one_by_one(frame, blocks) } else { self.add_blocks(frame, blocks) }
    }

    #[inline(always)]
    fn add_one_by_one(&mut self, frame: &Frame<'_>, lines: &[LineBlock]) -> Option<Filled> {
        let mut total = one_by_one::add(self.bins, frame, lines, self.angle_bins);
        if self.distance == DistanceKind::Unsigned {
            total += one_by_one::add(self.bins, &frame.mirrored(), lines, self.angle_bins);
        }
        Filled::of(total, 0..self.bins.len() / 2)
    }

    #[inline(always)]
    fn add_blocks(&mut self, frame: &Frame<'_>, blocks: &[LineBlock]) -> Option<Filled> {
        let mut reach = Reach::NONE;
        for block in blocks {
            self.add(frame, block, &mut reach);
            if self.distance == DistanceKind::Unsigned {
                self.add(&frame.mirrored(), block, &mut reach);
            }
        }
        let rows = reach.rows();
        let total = self.sum(&rows);
        let bins = rows.start * self.angle_bins..rows.end.min(self.distance_bins) * self.angle_bins;
        // A pair of bins may reach into the row before or behind.
        if let Some(before) = bins.start.checked_sub(1) {
            self.bins[before] = 0;
        }
        if let Some(behind) = self.bins.get_mut(bins.end) {
            *behind = 0;
        }
        Filled::of(total, bins.start / 2..bins.end.div_ceil(2))
    }

    #[inline(always)]
    fn add(&mut self, frame: &Frame<'_>, block: &LineBlock, reach: &mut Reach) {
        let shares = frame.shares(block, reach);
        let stride = stride_of(self.angle_bins, BLOCK) as i32;
        for i in 0..BLOCK {
            let (first, last) = (shares.first[i], shares.last[i]);
            add_pair(self.ends, first, &shares.in_first[i]);
            add_pair(self.ends, last, &shares.in_last[i]);
            if last - first > stride {
                add_pair(self.steps, first + stride, &shares.in_between[i]);
                add_pair(self.steps, last, &shares.in_between[i].map(i32::wrapping_neg));
            }
        }
    }

    /// Brings the `rows` of the grids together in `bins`, leaves them empty and returns the total.
    #[inline(always)]
    fn sum(&mut self, rows: &Range<usize>) -> u32 {
        let (distance_bins, angle_bins, stride) =
            (self.distance_bins, self.angle_bins, stride_of(self.angle_bins, BLOCK));
        let mut totals = [0_i32; BLOCK];
        for column in (0..stride).step_by(BLOCK) {
            let mut running = [0_i32; BLOCK];
            for row in rows.clone() {
                let place = row * stride + column;
                let step = self.steps[place..].first_chunk_mut();
                let end = self.ends[place..].first_chunk_mut();
                let (Some(step), Some(end)) = (step, end) else { break };
                running = sum_of(&running, step);
                let masses = sum_of(&running, end);
                (*step, *end) = ([0; BLOCK], [0; BLOCK]);
                if row == distance_bins {
                    break;
                }
                totals = sum_of(&totals, &masses);
                let bins = &mut self.bins[row * angle_bins..][..angle_bins];
                if let Some(bins) = bins.get_mut(column..).and_then(<[i32]>::first_chunk_mut) {
                    *bins = masses;
                    continue;
                }
                for (column, mass) in (column..angle_bins + WRAPPED).zip(masses) {
                    match column.checked_sub(angle_bins) {
                        None => bins[column] = mass,
                        Some(wrapped) => bins[wrapped.min(angle_bins - 1)] += mass,
                    }
                }
            }
        }
        totals.into_iter().sum::<i32>() as u32
    }

    /// Moves the pairs of bins that aren't empty, among those in `pairs`, to the front of `bins`, their indices to that of
    /// `indices`; returns how many.
    #[inline(always)]
    fn gather_pairs(&mut self, pairs: Range<usize>) -> usize {
        let mut count = 0;
        let (bins, _) = self.bins.as_chunks_mut::<2>();
        for first in pairs.clone().step_by(32) {
            let mut filled = 0_u32;
            for (bit, [even, odd]) in bins[first..pairs.end].iter().take(32).enumerate() {
                filled |= if even | odd != 0 { 1 << bit } else { 0 };
            }
            while filled != 0 {
                let index = first + filled.trailing_zeros() as usize;
                filled &= filled - 1;
                let pair = bins[index];
                let (Some(place), Some(bins)) = (self.indices.get_mut(count), bins.get_mut(count)) else { break };
                (*place, *bins) = (index as i32, pair);
                count += 1;
            }
        }
        count
    }

    /// Takes the masses and calls `put(index, roots)` for each pair of bins that aren't both empty.
    #[inline(always)]
    pub(super) fn take(&mut self, filled: Filled, put: impl FnMut(u16, [i16; 2])) {
        if BLOCK == 1 { self.take_one_by_one(filled, put) } else { self.take_gathered(filled, put) }
    }

    /// Empties the bins.
    #[inline(always)]
    fn take_one_by_one(&mut self, Filled { per_mass, .. }: Filled, mut put: impl FnMut(u16, [i16; 2])) {
        let mut index = 0_u16;
        for [a, b, c, d] in self.bins.as_chunks_mut().0 {
            for pair in [[a, b], [c, d]] {
                if *pair[0] | *pair[1] != 0 {
                    put(index, pair.map(|mass| root_q15(core::mem::take(mass), per_mass) as i16));
                }
                index = index.wrapping_add(1);
            }
        }
    }

    #[inline(always)]
    fn take_gathered(&mut self, Filled { per_mass, pairs }: Filled, mut put: impl FnMut(u16, [i16; 2])) {
        let count = self.gather_pairs(pairs);
        let (indices, roots) = (&self.indices[..count], &mut self.bins[..2 * count]);
        for root in &mut *roots {
            *root = root_q15(*root, per_mass);
        }
        for (index, [even, odd]) in indices.iter().zip(roots.as_chunks().0) {
            put(*index as u16, [*even as i16, *odd as i16]);
        }
    }

    /// The same for a receiver that takes empty pairs too, as long as all others are among them: where there are vectors,
    /// telling them apart takes longer than their roots.
    #[inline(always)]
    pub(super) fn take_dense(&mut self, filled: Filled, mut put: impl FnMut(u16, [i16; 2])) {
        if BLOCK == 1 {
            return self.take(filled, put);
        }
        let Filled { per_mass, pairs } = filled;
        let roots: &mut [[i16; 2]] = zerocopy::transmute_mut!(&mut self.indices[pairs.clone()]);
        let bins = &self.bins[2 * pairs.start..2 * pairs.end];
        for (root, mass) in roots.as_flattened_mut().iter_mut().zip(bins) {
            *root = root_q15(*mass, per_mass) as i16;
        }
        for (index, roots) in pairs.zip(roots) {
            put(index as u16, *roots);
        }
    }
}

#[inline(always)]
fn sum_of(a: &[i32; BLOCK], b: &[i32; BLOCK]) -> [i32; BLOCK] {
    core::array::from_fn(|i| a[i] + b[i])
}

#[inline(always)]
fn add_pair(grid: &mut [i32], place: i32, pair: &[i32; 2]) {
    // No place is negative: one comparison is enough.
    let place = place as u32 as usize;
    if let Some([a, b]) = grid.get_mut(place..place + 2) {
        *a += pair[0];
        *b += pair[1];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pgh::Line;
    use crate::pgh::frame::Axes;
    use crate::pgh::strategies::{any_segments, any_shape};
    use proptest::prelude::*;
    use std::vec;
    use std::vec::Vec;

    type Pairs = Vec<(u16, [i16; 2])>;

    /// The histograms about all `lines` in turn as `build` builds them, of blocks of so many lines.
    fn histograms(
        shape: &PghShape,
        lines: &[Line],
        in_block: usize,
        build: impl Fn(&mut Masses<'_>, &Frame<'_>, &[LineBlock], &mut Pairs) -> Option<()>,
    ) -> Vec<Pairs> {
        let axes = Axes::of(shape);
        let mut memory = vec![-1; Masses::memory_len(shape)];
        let mut masses = Masses::new(shape, &mut memory);
        let mut blocks: Vec<LineBlock> = lines.chunks(in_block).map(LineBlock::of).collect();
        let about = |(index, reference): (usize, &Line)| {
            let mut pairs = Pairs::new();
            let own_mass = core::mem::take(&mut blocks[index / in_block].mass[index % in_block]);
            build(&mut masses, &Frame::about(reference, &axes), &blocks, &mut pairs);
            blocks[index / in_block].mass[index % in_block] = own_mass;
            pairs
        };
        lines.iter().enumerate().map(about).collect()
    }

    proptest! {
        #[test]
        fn lines_one_by_one_give_what_blocks_give(shape in any_shape(), segments in any_segments(0..40)) {
            let lines: Vec<Line> = segments.iter().map(|segment| Line::new(segment, 0, &shape)).collect();
            let of_blocks = histograms(&shape, &lines, BLOCK, |masses, frame, blocks, pairs| {
                let filled = masses.add_blocks(frame, blocks)?;
                masses.take_gathered(filled, |index, roots| pairs.push((index, roots)));
                Some(())
            });
            let one_by_one = histograms(&shape, &lines, 1, |masses, frame, blocks, pairs| {
                let filled = masses.add_one_by_one(frame, blocks)?;
                masses.take_one_by_one(filled, |index, roots| pairs.push((index, roots)));
                Some(())
            });
            prop_assert_eq!(one_by_one, of_blocks);
        }
    }
}

//! Construction of root histograms.
//!
//! What does not branch is written over blocks of lines, so that it becomes vectors where there are any: a line's span
//! of perpendicular distances, its mass per bin (one division) and the two angle bins that share it. What depends on the
//! place is then two additions of a pair of bins, for the first and the last distance bin of the span; the bins between
//! come from differences that are summed once a histogram. Normalisation and square roots follow, for pairs of bins that
//! are not empty.
//!
//! Departures from the plain formula: coordinates are rounded to 1/16 px, distances to 1/4096 bin, masses to 1/256 px.
//! Coefficients within a scene of ten lines or more differ from exact arithmetic by less than 2e-4 in the mean and 7e-3 at
//! worst (a sliver of mass over a bin border, magnified by the root), view scores of twenty or more by less than 3e-4:
//! measured against the naive `f64` twin.

use super::block::BLOCK;
use super::root::{nearest, root_q15};
use super::{DistanceKind, Line, LineBlock, PghShape, ShapeError};
use crate::geometry::{CapacityError, Segment2};
use core::fmt;

/// Positions along the distance axis have this many fractional bits of a bin.
const POSITION_BITS: u32 = 12;
const BIN: i32 = 1 << POSITION_BITS;

/// Columns behind the last angle bin, for what belongs to the first ones after the wrap.
const WRAPPED: usize = 2;

/// Builds the root histogram of one line of a scene after another.
#[derive(Debug)]
pub struct HistogramBuilder<'m> {
    distance_bins: usize,
    angle_bins: usize,
    distance: DistanceKind,
    interpolates_angle: bool,
    /// Bins per px of distance.
    bins_per_px: f32,
    /// Fractional bits of a position before it is cut to [`POSITION_BITS`]: as many as fit.
    wide_bits: u32,
    /// The lines of the scene.
    blocks: &'m mut [LineBlock],
    line_count: usize,
    scratch: Scratch<'m>,
}

/// Masses on their way to a histogram, in units of 1/256 px of length.
#[derive(Debug)]
struct Scratch<'m> {
    /// `[distance + 1][angle + 2]`: masses in the first and the last distance bin of each line.
    ends: &'m mut [i32],
    /// The same of mass differences along the distance axis, for the bins between.
    steps: &'m mut [i32],
    /// `[distance][angle]`: the histogram, and a bin more for an odd number of them.
    masses: &'m mut [i32],
}

impl Scratch<'_> {
    const fn grid_len(shape: &PghShape) -> usize {
        (shape.distance_bins as usize + 1).saturating_mul(shape.angle_bins as usize + WRAPPED)
    }

    const fn masses_len(shape: &PghShape) -> usize {
        2 * shape.bin_count().div_ceil(2)
    }
}

impl<'m> HistogramBuilder<'m> {
    /// Number of `i32` a builder for `shape` works on.
    #[must_use]
    pub const fn memory_len(shape: &PghShape) -> usize {
        2 * Scratch::grid_len(shape) + Scratch::masses_len(shape)
    }

    /// A builder for histograms of `shape`, working in `memory`, for scenes of as many lines as `blocks` hold.
    ///
    /// # Errors
    /// When the kernels can't serve the shape, or `memory` is shorter than [`Self::memory_len`].
    pub fn new(shape: &PghShape, memory: &'m mut [i32], blocks: &'m mut [LineBlock]) -> Result<Self, BuilderError> {
        let shape = shape.checked().map_err(BuilderError::Shape)?;
        let (capacity, needed) = (memory.len(), Self::memory_len(&shape));
        let too_small = CapacityError { what: "histogram masses", capacity, needed };
        let memory = memory.get_mut(..needed).ok_or(BuilderError::Memory(too_small))?;
        let (ends, memory) = memory.split_at_mut(Scratch::grid_len(&shape));
        let (steps, masses) = memory.split_at_mut(Scratch::grid_len(&shape));
        let bins_per_px = 1.0 / shape.distance_bin_width_px();
        // The farthest two points can be apart, and the offset of a signed axis.
        let reach = 3.0 * Segment2::MAX_COORDINATE_PX * bins_per_px + f32::from(shape.distance_bins / 2 + 2);
        Ok(Self {
            distance_bins: usize::from(shape.distance_bins),
            angle_bins: usize::from(shape.angle_bins),
            distance: shape.distance,
            interpolates_angle: shape.interpolates_angle,
            bins_per_px,
            wide_bits: (reach as u32).leading_zeros() - 1,
            blocks,
            line_count: 0,
            scratch: Scratch { ends, steps, masses },
        })
    }

    /// Takes the lines that histograms are to be built of.
    ///
    /// # Errors
    /// When there are more than the builder has room for; it has none then.
    #[inline(always)]
    pub fn load(&mut self, lines: &[Line]) -> Result<(), CapacityError> {
        self.line_count = 0;
        let capacity = self.blocks.len() * BLOCK;
        if lines.len() > capacity {
            return Err(CapacityError { what: "histogram lines", capacity, needed: lines.len() });
        }
        for (block, lines) in self.blocks.iter_mut().zip(lines.chunks(BLOCK)) {
            *block = LineBlock::of(lines);
        }
        self.line_count = lines.len();
        Ok(())
    }

    /// Builds the histogram of all lines loaded but `reference`, one of them, about that one; `index` is its place.
    ///
    /// Calls `put(index, roots)` for each pair of bins `2 index` and `2 index + 1` that aren't both empty, in ascending
    /// order; a bin is `distance bin x angle bins + angle bin`, a root the square root of its share of the mass in Q15.
    #[inline(always)]
    pub fn build(&mut self, reference: &Line, index: usize, mut put: impl FnMut(u16, [i16; 2])) {
        self.scratch.ends.fill(0);
        self.scratch.steps.fill(0);
        let Some(own_length) = self.swap_length(index, 0) else { return };
        let frame = Frame::about(reference, self);
        let blocks = self.line_count.div_ceil(BLOCK);
        for block in &self.blocks[..blocks] {
            self.scratch.add(&frame, block);
            if self.distance == DistanceKind::Unsigned {
                self.scratch.add(&frame.mirrored(), block);
            }
        }
        self.swap_length(index, own_length);
        let total = self.scratch.sum(self.distance_bins, self.angle_bins);
        if total == 0 {
            return;
        }
        let pairs = self.scratch.gather_pairs();
        let per_mass = 1.0 / total as f32;
        let (indices, roots) = (&self.scratch.steps[..pairs], &mut self.scratch.ends[..2 * pairs]);
        for root in &mut *roots {
            *root = root_q15(*root, per_mass);
        }
        for (index, [even, odd]) in indices.iter().zip(roots.as_chunks().0) {
            put(*index as u16, [*even as i16, *odd as i16]);
        }
    }

    /// Replaces the length of a line and returns what it was; `None` where there is no line.
    fn swap_length(&mut self, index: usize, length_q4: i32) -> Option<i32> {
        let block = self.blocks[..self.line_count.div_ceil(BLOCK)].get_mut(index / BLOCK)?;
        Some(core::mem::replace(&mut block.length_q4[index % BLOCK], length_q4))
    }
}

/// A reference line with its histogram's axes.
#[derive(Debug, Clone, Copy)]
struct Frame {
    /// Normal of the reference line, in bins per 1/16 px with [`HistogramBuilder::wide_bits`].
    normal: [i32; 2],
    /// Position of the image's origin, less the axis' least, in the same unit.
    offset: i32,
    /// From there to [`POSITION_BITS`].
    shift: u32,
    /// Greatest position, in Q12 bins.
    end: i32,
    /// Least width of a span, 1 px, in Q12 bins.
    least_span: i32,
    direction: i32,
    angle_bins: i32,
    /// Half an angle bin in Q16 where the nearest bin takes all, none where two share.
    angle_offset: i32,
    /// Which bits of an angle's position between two bins count.
    angle_mask: i32,
    stride: i32,
}

impl Frame {
    fn about(reference: &Line, builder: &HistogramBuilder<'_>) -> Self {
        let scale = i64::from((builder.bins_per_px * (1_u64 << builder.wide_bits) as f32) as i32);
        // From Q30 normals to positions of coordinates in Q4 px.
        let normal = reference.normal_q30.map(|part| ((i64::from(part) * scale) >> (30 + 4)) as i32);
        let [x, y] = reference.midpoint_q4;
        let middle = match builder.distance {
            DistanceKind::Signed => (builder.distance_bins as i32) << (builder.wide_bits - 1),
            DistanceKind::Unsigned => 0,
        };
        let offset = middle.wrapping_sub(normal[0].wrapping_mul(x).wrapping_add(normal[1].wrapping_mul(y)));
        Self {
            normal,
            offset,
            shift: builder.wide_bits - POSITION_BITS,
            end: builder.distance_bins as i32 * BIN,
            least_span: ((builder.bins_per_px * BIN as f32) as i32).max(1),
            direction: reference.direction as i32,
            angle_bins: builder.angle_bins as i32,
            angle_offset: if builder.interpolates_angle { 0 } else { 0x8000 },
            angle_mask: if builder.interpolates_angle { 0xffff } else { 0 },
            stride: (builder.angle_bins + WRAPPED) as i32,
        }
    }

    /// The same with the normal to the other side.
    fn mirrored(&self) -> Self {
        let normal = self.normal.map(|part| -part);
        Self { normal, offset: self.offset.wrapping_neg(), ..*self }
    }

    /// Position of a point along the distance axis, in Q12 bins.
    #[inline(always)]
    fn position(&self, x_q4: i32, y_q4: i32) -> i32 {
        // Each product may pass the border of i32; the sum is within reach.
        let wide = self.normal[0].wrapping_mul(x_q4).wrapping_add(self.normal[1].wrapping_mul(y_q4));
        wide.wrapping_add(self.offset) >> self.shift
    }

    /// What each line of a block adds to the grid.
    #[inline(always)]
    fn shares(&self, block: &LineBlock) -> Shares {
        let mut shares = Shares::NONE;
        for i in 0..BLOCK {
            let a = self.position(block.start_x_q4[i], block.start_y_q4[i]);
            let b = self.position(block.end_x_q4[i], block.end_y_q4[i]);
            let (low, high) = (a.min(b), a.max(b));
            let span = (high - low).max(self.least_span);
            let low = if high - low < self.least_span { ((low + high) >> 1) - (self.least_span >> 1) } else { low };
            // A mass is 16 times a length in Q4 px.
            let density = (block.length_q4[i] << 4) as f32 / span as f32;
            let (low, high) = (low.max(0).min(self.end), (low + span).max(0).min(self.end));

            let (first, last) = (low >> POSITION_BITS, high >> POSITION_BITS);
            let border = (first + 1) << POSITION_BITS;
            let in_first = (high.min(border) - low) as f32;
            let in_last = (high - border.max(last << POSITION_BITS)).max(0) as f32;

            let relative = (block.direction[i] - self.direction) & 0xffff;
            let angle = relative * self.angle_bins + self.angle_offset;
            let column = angle >> 16;
            shares.first[i] = first * self.stride + column;
            shares.last[i] = last * self.stride + column;

            let above = (angle & self.angle_mask) as f32 * (1.0 / 65_536.0);
            let split = |mass: f32| {
                let (whole, above) = (nearest(mass), nearest(mass * above));
                [whole - above, above]
            };
            shares.in_first[i] = split(density * in_first);
            shares.in_last[i] = split(density * in_last);
            shares.in_between[i] = split(density * BIN as f32);
        }
        shares
    }
}

/// What the lines of a block add to the grid: masses for two neighbouring angle bins each.
#[derive(Debug)]
struct Shares {
    /// Places of the first distance bins, and of the last, which may be the same.
    first: [i32; BLOCK],
    last: [i32; BLOCK],
    in_first: [[i32; 2]; BLOCK],
    in_last: [[i32; 2]; BLOCK],
    /// In each bin between the two; means nothing if there is none.
    in_between: [[i32; 2]; BLOCK],
}

impl Shares {
    const NONE: Self = Self {
        first: [0; BLOCK],
        last: [0; BLOCK],
        in_first: [[0; 2]; BLOCK],
        in_last: [[0; 2]; BLOCK],
        in_between: [[0; 2]; BLOCK],
    };
}

impl Scratch<'_> {
    #[inline(always)]
    fn add(&mut self, frame: &Frame, block: &LineBlock) {
        let shares = frame.shares(block);
        for i in 0..BLOCK {
            let (first, last) = (shares.first[i], shares.last[i]);
            add_pair(self.ends, first, shares.in_first[i]);
            add_pair(self.ends, last, shares.in_last[i]);
            if last - first > frame.stride {
                add_pair(self.steps, first + frame.stride, shares.in_between[i]);
                add_pair(self.steps, last, shares.in_between[i].map(i32::wrapping_neg));
            }
        }
    }

    /// Brings everything together in `masses` and returns the total.
    #[inline(always)]
    fn sum(&mut self, distance_bins: usize, angle_bins: usize) -> u32 {
        let stride = angle_bins + WRAPPED;
        // First what wrapped: written shortly before it is read as part of a vector, it would have to be waited for.
        for grid in [&mut *self.ends, &mut *self.steps] {
            for row in grid.chunks_exact_mut(stride).take(distance_bins) {
                match row {
                    [first, second, .., wrapped_first, wrapped_second] => {
                        *first += *wrapped_first;
                        *second += *wrapped_second;
                    }
                    [only, wrapped_first, wrapped_second] => *only += *wrapped_first + *wrapped_second,
                    _ => {}
                }
            }
        }
        let mut running = [].as_slice();
        let rows = self.steps.chunks_exact_mut(stride).zip(self.ends.chunks_exact(stride));
        for ((steps, ends), masses) in rows.zip(self.masses.chunks_exact_mut(angle_bins)).take(distance_bins) {
            let (steps, ends) = (&mut steps[..angle_bins], &ends[..angle_bins]);
            for (step, running) in steps.iter_mut().zip(running) {
                *step += running;
            }
            for ((mass, end), step) in masses.iter_mut().zip(ends).zip(&*steps) {
                *mass = end + step;
            }
            running = steps;
        }
        let (masses, odd) = self.masses.split_at_mut(distance_bins * angle_bins);
        odd.fill(0);
        masses.iter().sum::<i32>() as u32
    }

    /// Moves the pairs of bins that aren't empty to the front of `ends`, their indices to that of `steps`.
    #[inline(always)]
    fn gather_pairs(&mut self) -> usize {
        let mut count = 0;
        let (ends, _) = self.ends.as_chunks_mut::<2>();
        let mut gather = |index, pair: [i32; 2]| {
            let (Some(place), Some(end)) = (self.steps.get_mut(count), ends.get_mut(count)) else { return };
            (*place, *end) = (index, pair);
            let both: u64 = zerocopy::transmute!(pair);
            count += usize::from(both != 0);
        };
        // Most pairs are empty, and so are their neighbours.
        let (fours, rest) = self.masses.as_chunks::<8>();
        for (four, masses) in (0..).zip(fours) {
            if masses.iter().fold(0, |any, mass| any | mass) != 0 {
                for (index, pair) in (4 * four..).zip(masses.as_chunks::<2>().0) {
                    gather(index, *pair);
                }
            }
        }
        for (index, pair) in (4 * fours.len() as i32..).zip(rest.as_chunks::<2>().0) {
            gather(index, *pair);
        }
        count
    }
}

#[inline(always)]
fn add_pair(grid: &mut [i32], place: i32, pair: [i32; 2]) {
    let place = place as u32 as usize;
    if let Some([a, b]) = grid.get_mut(place..place.wrapping_add(2)) {
        *a += pair[0];
        *b += pair[1];
    }
}

/// Why a builder can't be made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BuilderError {
    /// The kernels can't serve the shape.
    Shape(ShapeError),
    /// The memory is too small.
    Memory(CapacityError),
}

impl fmt::Display for BuilderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shape(error) => error.fmt(f),
            Self::Memory(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for BuilderError {}

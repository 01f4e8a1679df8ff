//! The first stage in maps of many nodes: which of them are worth an exact look.
//!
//! A look's [gist](crate::gist) is compared with those of all nodes in the sector of its heading, several views of each
//! from poses about it. Similarities add up over looks **at the same pose**; a node counts as its best pose does.

use crate::database::{NodeId, ViewIndex};
use crate::geometry::{PinholeCamera, Segment2};
use crate::gist::{Code, Projection, add_similarities, edge_layout};
use crate::math;
use core::f32::consts::TAU;

/// Most headings that a look is compared at.
const MOST_HEADINGS: usize = 16;

/// All nodes of an indexed map with their similarity so far.
#[derive(Debug)]
pub(super) struct FirstStage<'m> {
    index: ViewIndex<'m>,
    camera: PinholeCamera,
    /// Sums for each pose about each node.
    sums: &'m mut [i16],
}

impl<'m> FirstStage<'m> {
    /// Of the nodes in `index`, with a sum for each of their poses.
    pub(super) fn new(index: ViewIndex<'m>, camera: PinholeCamera, sums: &'m mut [i16]) -> Self {
        sums.fill(0);
        Self { index, camera, sums }
    }

    /// Forgets all looks.
    pub(super) fn clear(&mut self) {
        self.sums.fill(0);
    }

    /// The gist of a look.
    pub(super) fn code(&self, segments: &[Segment2]) -> Code {
        let projection = Projection { mean: self.index.mean(), axes: self.index.axes() };
        projection.code(&edge_layout(&self.camera, segments.iter().copied()))
    }

    /// Adds the similarities of a look that may have been along any of `headings_rad`; sixteen at most.
    pub(super) fn add(&mut self, code: &Code, headings_rad: impl Iterator<Item = f32>) {
        let mut sectors: [&[Code]; MOST_HEADINGS] = [&[]; MOST_HEADINGS];
        let mut asked = [u16::MAX; MOST_HEADINGS];
        let mut count = 0;
        for heading_rad in headings_rad {
            let sector = self.sector_of(heading_rad);
            if count < MOST_HEADINGS && !asked[..count].contains(&sector) {
                (sectors[count], asked[count]) = (self.index.sector(sector), sector);
                count += 1;
            }
        }
        add_similarities(code, &sectors[..count], self.sums);
    }

    /// The nodes most similar so far, `count` of them, by identity; of equals the first.
    pub(super) fn best(&self, count: usize) -> impl Iterator<Item = NodeId> {
        let (floor, mut at_floor) = self.floor(count);
        (0..).zip(self.node_sums()).filter_map(move |(node, sum)| {
            let is_best = sum > floor || (sum == floor && at_floor > 0);
            at_floor -= usize::from(is_best && sum == floor);
            is_best.then_some(NodeId(node))
        })
    }

    fn sector_of(&self, heading_rad: f32) -> u16 {
        let sectors = f32::from(self.index.shape().sectors);
        let turns = heading_rad / TAU;
        // Less than a turn; the last half sector belongs to the first.
        ((turns - math::floor(turns)) * sectors + 0.5) as u16 % self.index.shape().sectors
    }

    fn node_sums(&self) -> impl Iterator<Item = i16> {
        let poses = self.sums.chunks_exact(usize::from(self.index.shape().poses));
        poses.map(|poses| poses.iter().fold(i16::MIN, |best, sum| best.max(*sum)))
    }

    /// The sum that the `count`-th best node has, and how many of those with that sum are among the best: counted by the
    /// upper, then by the lower byte.
    fn floor(&self, count: usize) -> (i16, usize) {
        let keys = || self.node_sums().map(|sum| sum.cast_unsigned() ^ 0x8000);
        let mut left = count.max(1);
        let mut pick = |counts: &[usize; 256]| {
            for (byte, &count) in counts.iter().enumerate().rev() {
                if count >= left {
                    return byte as u16;
                }
                left -= count;
            }
            0
        };
        let mut counts = [0_usize; 256];
        keys().for_each(|key| counts[usize::from(key >> 8)] += 1);
        let upper = pick(&counts);
        counts.fill(0);
        keys().filter(|key| key >> 8 == upper).for_each(|key| counts[usize::from(key & 0xff)] += 1);
        let floor = upper << 8 | pick(&counts);
        ((floor ^ 0x8000).cast_signed(), left)
    }
}

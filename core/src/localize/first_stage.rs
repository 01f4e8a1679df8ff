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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::database::{self, IndexShape, NodeModel, TopologicalDatabase};
    use crate::geometry::{Point2, StereoRig};
    use proptest::prelude::*;
    use std::vec;
    use std::vec::Vec;

    /// A map of so many empty nodes with an index of two sectors and two poses.
    fn map(nodes: usize) -> Vec<u8> {
        let nodes = vec![NodeModel { position: Point2::default(), segments: &[] }; nodes];
        let mut bytes = vec![0; database::encoded_len(&nodes).expect("small")];
        database::write(&StereoRig::reference(), 12, &nodes, &mut bytes).expect("legal");
        let shape = IndexShape { sectors: 2, poses: 2 };
        let length = database::indexed_len(&TopologicalDatabase::open(&bytes).expect("a map"), shape).expect("small");
        bytes.resize(length, 0);
        database::begin_index(&mut bytes, shape).expect("room enough");
        database::seal(&mut bytes).expect("whole");
        bytes
    }

    proptest! {
        #[test]
        fn the_best_are_those_that_sorting_finds(
            sums in prop::collection::vec((-40_i16..40, prop_oneof![Just(i16::MIN), Just(i16::MAX), -300_i16..300]), 1..60),
            count in 1_usize..70,
        ) {
            let bytes = map(sums.len());
            let map = TopologicalDatabase::open(&bytes).expect("sealed");
            let mut memory = vec![0; 2 * sums.len()];
            let index = map.index().expect("an index");
            let stage = FirstStage::new(*index, map.rig().camera, &mut memory);
            for (places, (a, b)) in stage.sums.chunks_exact_mut(2).zip(&sums) {
                places.copy_from_slice(&[*a, *b]);
            }
            let mut order: Vec<u32> = (0..sums.len() as u32).collect();
            let of = |node: &u32| { let (a, b) = sums[*node as usize]; a.max(b) };
            order.sort_by_key(|node| core::cmp::Reverse(of(node)));
            order.truncate(count);
            order.sort_unstable();
            let best: Vec<u32> = stage.best(count).map(|node| node.0).collect();
            prop_assert_eq!(best, order);
        }
    }

    #[test]
    fn a_heading_belongs_to_the_sector_about_it() {
        let bytes = map(1);
        let map = TopologicalDatabase::open(&bytes).expect("sealed");
        let mut memory = [0; 2];
        let stage = FirstStage::new(*map.index().expect("an index"), map.rig().camera, &mut memory);
        let sectors = [0.0, 1.5, 1.6, 3.2, 4.7, 4.8, 6.2, -0.1, -3.0, 40.0].map(|heading| stage.sector_of(heading));
        assert_eq!(sectors, [0, 0, 1, 1, 1, 0, 0, 0, 1, 1]);
    }
}

//! The verifying localiser's memory: one slice from the caller, divided once.

use super::check::VIEW_CAPACITY;
use super::distance_planes::DistancePlanes;
use super::evidence::CellEvidence;
use super::hypothesis::Hypothesis;
use super::kept_looks::LookPose;
use super::search::CHILDREN;
use super::slots::Slot;
use super::view::ViewSegment;
use super::{Evidence, SeenSegment, VerificationConfig};
use crate::geometry::CapacityError;
use crate::gist::Code;
use crate::localize::extent::Extent;
use crate::localize::workspace::{Rest, sum, words};
use crate::localize::{LocalizerConfig, NodeScore};

/// The parts that the caller's memory is divided into.
#[derive(Debug)]
pub(super) struct Memory<'m> {
    pub(super) planes: &'m mut [u8; DistancePlanes::BYTES],
    pub(super) view: &'m mut [ViewSegment],
    pub(super) cells: &'m mut [CellEvidence],
    pub(super) poses: &'m mut [LookPose],
    pub(super) segments: &'m mut [SeenSegment],
    pub(super) ranked: &'m mut [Hypothesis],
    pub(super) refined: &'m mut [Hypothesis],
    pub(super) children: &'m mut [Evidence],
    pub(super) node_scores: &'m mut [NodeScore],
    pub(super) slots: &'m mut [Slot],
    pub(super) chosen: &'m mut [u32],
    pub(super) codes: &'m mut [Code],
    pub(super) similarities: &'m mut [i16],
}

/// Number of `u64` that a verifying localiser works on.
pub(in crate::localize) const fn memory_len(
    config: &LocalizerConfig,
    verification: &VerificationConfig,
    extent: Extent,
) -> usize {
    let looks_here = config.max_looks as usize;
    let looks = looks_here.saturating_mul(verification.places());
    let (slots, codes) = chosen_lens(extent, looks);
    sum(&[
        words::<u8>(DistancePlanes::BYTES),
        words::<ViewSegment>(VIEW_CAPACITY),
        words::<CellEvidence>(extent.scored.saturating_mul(verification.poses_per_node())),
        words::<LookPose>(looks),
        words::<SeenSegment>(looks_here.saturating_mul(config.max_segments as usize)),
        words::<Hypothesis>(extent.scored.saturating_mul(VerificationConfig::PER_NODE)),
        words::<Hypothesis>(verification.refined as usize),
        words::<Evidence>((verification.refined as usize).saturating_mul(CHILDREN)),
        words::<NodeScore>(extent.nodes),
        words::<Slot>(slots),
        words::<u32>(slots),
        words::<Code>(codes),
        words::<i16>(extent.compared),
    ])
}

/// Slots, and gists of looks: none where every node has its grid.
const fn chosen_lens(extent: Extent, looks: usize) -> (usize, usize) {
    if extent.has_first_stage() { (extent.scored, looks) } else { (0, 0) }
}

impl<'m> Memory<'m> {
    /// Divides the beginning of `memory`, at least [`memory_len`] long.
    pub(super) fn divide(
        memory: &'m mut [u64],
        config: &LocalizerConfig,
        verification: &VerificationConfig,
        extent: Extent,
    ) -> Result<Self, CapacityError> {
        let too_small = CapacityError {
            what: "localizer memory in 64-bit words",
            capacity: memory.len(),
            needed: memory_len(config, verification, extent),
        };
        let looks_here = usize::from(config.max_looks);
        let looks = looks_here.saturating_mul(verification.places());
        let refined = usize::from(verification.refined);
        let (slots, codes) = chosen_lens(extent, looks);
        let mut rest = Rest::new(memory);
        let mut divide = || {
            Some(Self {
                planes: rest.take(DistancePlanes::BYTES)?.try_into().ok()?,
                view: rest.take(VIEW_CAPACITY)?,
                cells: rest.take(extent.scored.saturating_mul(verification.poses_per_node()))?,
                poses: rest.take(looks)?,
                segments: rest.take(looks_here.saturating_mul(usize::from(config.max_segments)))?,
                ranked: rest.take(extent.scored.saturating_mul(VerificationConfig::PER_NODE))?,
                refined: rest.take(refined)?,
                children: rest.take(refined.saturating_mul(CHILDREN))?,
                node_scores: rest.take(extent.nodes)?,
                slots: rest.take(slots)?,
                chosen: rest.take(slots)?,
                codes: rest.take(codes)?,
                similarities: rest.take(extent.compared)?,
            })
        };
        divide().ok_or(too_small)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONFIG: LocalizerConfig = LocalizerConfig::edgeloc();
    const VERIFICATION: VerificationConfig = VerificationConfig::reference();

    #[test]
    fn the_stated_length_is_just_enough() {
        for extent in [Extent::whole(3), Extent::indexed(&CONFIG, 1007, 5)] {
            let needed = memory_len(&CONFIG, &VERIFICATION, extent);
            let mut memory = std::vec![0; needed];
            assert!(Memory::divide(&mut memory, &CONFIG, &VERIFICATION, extent).is_ok());
            let error = Memory::divide(&mut memory[1..], &CONFIG, &VERIFICATION, extent).expect_err("one word short");
            assert_eq!((error.capacity, error.needed), (needed - 1, needed));
        }
    }

    #[test]
    fn an_office_of_72_nodes_takes_at_most_256_kib() {
        assert!(memory_len(&CONFIG, &VERIFICATION, Extent::whole(72)) * 8 <= 256 * 1024);
    }
}

//! The verifying localiser's memory: one slice from the caller, divided once.

use super::check::VIEW_CAPACITY;
use super::distance_planes::DistancePlanes;
use super::evidence::CellEvidence;
use super::hypothesis::Hypothesis;
use super::kept_looks::LookPose;
use super::search::CHILDREN;
use super::view::ViewSegment;
use super::{Evidence, SeenSegment, VerificationConfig};
use crate::geometry::CapacityError;
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
}

/// Number of `u64` that a verifying localiser works on.
pub(in crate::localize) const fn memory_len(
    config: &LocalizerConfig,
    verification: &VerificationConfig,
    node_count: usize,
) -> usize {
    let (places, looks) = (verification.places(), config.max_looks as usize);
    sum(&[
        words::<u8>(DistancePlanes::BYTES),
        words::<ViewSegment>(VIEW_CAPACITY),
        words::<CellEvidence>(node_count.saturating_mul(verification.poses_per_node())),
        words::<LookPose>(looks.saturating_mul(places)),
        words::<SeenSegment>(looks.saturating_mul(config.max_segments as usize)),
        words::<Hypothesis>(node_count.saturating_mul(VerificationConfig::PER_NODE)),
        words::<Hypothesis>(verification.refined as usize),
        words::<Evidence>((verification.refined as usize).saturating_mul(CHILDREN)),
        words::<NodeScore>(node_count),
    ])
}

impl<'m> Memory<'m> {
    /// Divides the beginning of `memory`, at least [`memory_len`] long.
    pub(super) fn divide(
        memory: &'m mut [u64],
        config: &LocalizerConfig,
        verification: &VerificationConfig,
        node_count: usize,
    ) -> Result<Self, CapacityError> {
        let too_small = CapacityError {
            what: "localizer memory in 64-bit words",
            capacity: memory.len(),
            needed: memory_len(config, verification, node_count),
        };
        let (places, looks) = (verification.places(), usize::from(config.max_looks));
        let refined = usize::from(verification.refined);
        let mut rest = Rest::new(memory);
        let mut divide = || {
            Some(Self {
                planes: rest.take(DistancePlanes::BYTES)?.try_into().ok()?,
                view: rest.take(VIEW_CAPACITY)?,
                cells: rest.take(node_count.saturating_mul(verification.poses_per_node()))?,
                poses: rest.take(looks.saturating_mul(places))?,
                segments: rest.take(looks.saturating_mul(usize::from(config.max_segments)))?,
                ranked: rest.take(node_count.saturating_mul(VerificationConfig::PER_NODE))?,
                refined: rest.take(refined)?,
                children: rest.take(refined.saturating_mul(CHILDREN))?,
                node_scores: rest.take(node_count)?,
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
        const NEEDED: usize = memory_len(&CONFIG, &VERIFICATION, 3);
        let mut memory = std::vec![0; NEEDED];
        assert!(Memory::divide(&mut memory, &CONFIG, &VERIFICATION, 3).is_ok());
        let error = Memory::divide(&mut memory[1..], &CONFIG, &VERIFICATION, 3).expect_err("one word short");
        assert_eq!((error.capacity, error.needed), (NEEDED - 1, NEEDED));
    }

    #[test]
    fn an_office_of_72_nodes_takes_at_most_256_kib() {
        assert!(memory_len(&CONFIG, &VERIFICATION, 72) * 8 <= 256 * 1024);
    }
}

//! The evidence of one look for one pose, for those who want to see behind a decision.

use super::check::{Checker, Closeness, VIEW_CAPACITY};
use super::distance_planes::DistancePlanes;
use super::view::ViewSegment;
use super::{Evidence, SeenSegment};
use crate::database::Node;
use crate::geometry::{CapacityError, Heading, Segment2, StereoRig};
use crate::localize::LocalizerConfig;
use crate::localize::segment_filter::SegmentFilter;
use crate::localize::workspace::{Rest, sum, words};

/// Checks poses beside nodes against one look: what the verifying localiser does, without its search.
#[derive(Debug)]
pub struct PoseCheck<'m> {
    checker: Checker<'m>,
    seen_q4: i32,
}

impl<'m> PoseCheck<'m> {
    /// Segments of a look that can enter.
    pub const MAX_SEGMENTS: usize = 1024;

    /// Number of `u64` of working memory.
    #[must_use]
    pub const fn memory_len() -> usize {
        sum(&[
            words::<u8>(DistancePlanes::BYTES),
            words::<ViewSegment>(VIEW_CAPACITY),
            words::<SeenSegment>(Self::MAX_SEGMENTS),
        ])
    }

    /// Draws the segments of a look in `memory` of at least [`Self::memory_len`] words; of more than
    /// [`Self::MAX_SEGMENTS`] the first.
    ///
    /// # Errors
    /// When the memory is too small.
    pub fn new(
        rig: &StereoRig,
        config: &LocalizerConfig,
        scene: &[Segment2],
        memory: &'m mut [u64],
    ) -> Result<Self, CapacityError> {
        let too_small =
            CapacityError { what: "pose check in 64-bit words", capacity: memory.len(), needed: Self::memory_len() };
        let mut rest = Rest::new(memory);
        let mut divide = || {
            Some((
                rest.take(DistancePlanes::BYTES)?.try_into().ok()?,
                rest.take(VIEW_CAPACITY)?,
                rest.take(Self::MAX_SEGMENTS)?,
            ))
        };
        let (planes, view, seen): (_, _, &mut [SeenSegment]) = divide().ok_or(too_small)?;
        let mut checker = Checker::new(rig, SegmentFilter::new(config), planes, view);
        let (filter, frame) = (*checker.filter(), *checker.frame());
        let mut count = 0;
        for (place, segment) in seen.iter_mut().zip(scene.iter().filter(|segment| filter.keeps(segment))) {
            *place = SeenSegment::new(segment, &frame);
            count += 1;
        }
        checker.draw_segments(&seen[..count]);
        let seen_q4 = seen[..count].iter().fold(0_i32, |sum, segment| sum.saturating_add(segment.length_q4()));
        Ok(Self { checker, seen_q4 })
    }

    /// Length of the look's segments that entered, in Q4 px: what [`Evidence::score_q20`] asks for.
    #[must_use]
    pub const fn seen_q4(&self) -> i32 {
        self.seen_q4
    }

    /// Evidence for a camera at `offset_m` from the node, axes of the world, looking along `heading`; the position may be
    /// off by `position_m` and the heading by `heading_rad`; points are looked up every `spacing_px`.
    #[must_use]
    pub fn evidence(
        &mut self,
        node: &Node<'_>,
        (offset_m, heading): ([f32; 2], Heading),
        [position_m, heading_rad, spacing_px]: [f32; 3],
    ) -> Evidence {
        self.checker.turn(node, heading.angle().radians(), (offset_m, 0.01));
        self.checker.evidence(offset_m, &Closeness { position_m, heading_rad, spacing_px })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::database::{self, NodeId, NodeModel, TopologicalDatabase};
    use crate::geometry::{Point2, Point3, Polarity, Segment3};
    use proptest::prelude::*;
    use std::vec;
    use std::vec::Vec;

    fn model_segment() -> impl Strategy<Value = Segment3> {
        let point = || (-6.0..6.0_f32, -6.0..6.0_f32, -1.2..1.5_f32).prop_map(|(x, y, z)| Point3::new(x, y, z));
        (point(), point()).prop_map(|(start, end)| Segment3 { start, end, polarity: Polarity::LeftBrighter })
    }

    fn seen_segment() -> impl Strategy<Value = Segment2> {
        let point = || (0.0..640.0_f32, 0.0..480.0_f32).prop_map(|(x, y)| Point2::new(x, y));
        (point(), point()).prop_filter_map("long enough", |(a, b)| Segment2::new(a, b, Polarity::LeftBrighter).ok())
    }

    proptest! {
        // Fewer cameras than lanes, as many, more than a batch; near, far, and beyond what the turned model holds.
        #[test]
        fn cameras_together_see_what_each_sees_alone(
            model in prop::collection::vec(model_segment(), 1..60),
            scene in prop::collection::vec(seen_segment(), 1..30),
            offsets_m in prop::collection::vec([-3.0..3.0_f32, -3.0..3.0_f32], 1..40),
            heading_rad in -3.0..3.0_f32,
            position_m in 0.0..0.3_f32,
        ) {
            let rig = StereoRig::reference();
            let nodes = [NodeModel { position: Point2::new(0.0, 0.0), segments: &model }];
            let mut bytes = vec![0; database::encoded_len(&nodes).expect("one node fits")];
            database::write(&rig, 12, &nodes, &mut bytes).expect("one node fits");
            let database = TopologicalDatabase::open(&bytes).expect("just written");
            let node = database.node(NodeId(0)).expect("one node");
            let mut memory = vec![0; PoseCheck::memory_len()];
            let mut check =
                PoseCheck::new(&rig, &LocalizerConfig::edgeloc(), &scene, &mut memory).expect("enough memory");
            check.checker.turn(&node, heading_rad, ([0.0; 2], 2.0));
            let closeness = Closeness { position_m, heading_rad: 0.01, spacing_px: 14.0 };
            let mut together = vec![Evidence::default(); offsets_m.len()];
            check.checker.evidence_of_all(&offsets_m, &closeness, &mut together);
            let alone: Vec<Evidence> =
                offsets_m.iter().map(|offset_m| check.checker.evidence(*offset_m, &closeness)).collect();
            prop_assert_eq!(together, alone);
        }
    }
}

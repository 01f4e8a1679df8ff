//! The looks of an attempt, kept until its end so that closer hypotheses can be checked against all of them.

use super::SeenSegment;
use super::dominant::DominantDirection;
use super::image_frame::ImageFrame;
use crate::geometry::{Angle, Heading, Point2, Segment2};
use crate::localize::segment_filter::SegmentFilter;
use crate::localize::{HeadingPrior, Motion};
use crate::math;
use zerocopy::{FromBytes, Immutable, IntoBytes};

/// How the camera stood at a look, as far as compass and odometry tell.
#[derive(Debug, Clone, Copy, PartialEq, Default, FromBytes, IntoBytes, Immutable)]
#[repr(C)]
pub(super) struct LookPose {
    /// Heading at the look if the compass did not err at the first \[rad\].
    pub(super) heading_rad: f32,
    /// Way made since the first look, axes of the world \[m\].
    pub(super) way_m: [f32; 2],
    segment_count: u32,
}

/// All looks of the attempt.
#[derive(Debug)]
pub(super) struct KeptLooks<'m> {
    poses: &'m mut [LookPose],
    /// `max_segments` places for each look.
    segments: &'m mut [SeenSegment],
    count: usize,
    seen_q4: i32,
    /// Standard deviation of the compass at the first look \[rad\]; none without a compass.
    compass_spread_rad: Option<f32>,
    /// Directions of edges relative to the first look's heading as [`LookPose`] has it.
    dominant: DominantDirection,
}

impl<'m> KeptLooks<'m> {
    pub(super) fn new(poses: &'m mut [LookPose], segments: &'m mut [SeenSegment]) -> Self {
        Self { poses, segments, count: 0, seen_q4: 0, compass_spread_rad: None, dominant: DominantDirection::NONE }
    }

    pub(super) fn clear(&mut self) {
        (self.count, self.seen_q4) = (0, 0);
        self.dominant = DominantDirection::NONE;
    }

    pub(super) const fn count(&self) -> usize {
        self.count
    }

    pub(super) const fn is_full(&self) -> bool {
        self.count == self.poses.len()
    }

    /// Segments of all looks.
    pub(super) fn segment_count(&self) -> u32 {
        self.poses[..self.count].iter().fold(0, |sum, pose| sum.saturating_add(pose.segment_count))
    }

    /// Length of all segments of all looks in Q4 px.
    pub(super) const fn seen_q4(&self) -> i32 {
        self.seen_q4
    }

    /// Standard deviation of the compass at the first look \[rad\]; none without a compass.
    pub(super) const fn compass_spread_rad(&self) -> Option<f32> {
        self.compass_spread_rad
    }

    /// Where most level edges run, relative to the heading of the first look \[rad\], modulo a quarter turn.
    pub(super) fn dominant_rad(&self) -> Option<f32> {
        self.dominant.peak_rad()
    }

    pub(super) fn pose(&self, look: usize) -> LookPose {
        self.poses.get(look).copied().unwrap_or_default()
    }

    /// The segments of a look that entered.
    pub(super) fn segments(&self, look: usize) -> &[SeenSegment] {
        let capacity = self.segments.len() / self.poses.len().max(1);
        &self.segments[look * capacity..][..self.pose(look).segment_count as usize]
    }

    /// Keeps a look: the longest of its segments, and how the camera stood. Does nothing when there is no room.
    pub(super) fn push(
        &mut self,
        (heading, motion): (Option<HeadingPrior>, Option<Motion>),
        segments: &[Segment2],
        filter: &SegmentFilter,
        frame: &ImageFrame,
    ) {
        if self.is_full() {
            return;
        }
        let capacity = self.segments.len() / self.poses.len();
        let places = &mut self.segments[self.count * capacity..][..capacity];
        let mut kept = 0;
        for segment in segments.iter().filter(|segment| filter.keeps(segment)) {
            let new = SeenSegment::new(segment, frame);
            if let Some(place) = places.get_mut(kept) {
                *place = new;
                kept += 1;
            } else if let Some(shortest) = places.iter_mut().min_by_key(|place| place.length_q4())
                && shortest.length_q4() < new.length_q4()
            {
                *shortest = new;
            }
        }
        self.seen_q4 = places[..kept].iter().fold(self.seen_q4, |sum, seen| sum.saturating_add(seen.length_q4()));
        let (heading_rad, way_m) = self.next_pose(heading, motion);
        if self.compass_spread_rad.is_none() {
            self.dominant.add_image(segments, heading_rad, frame);
        }
        self.poses[self.count] = LookPose { heading_rad, way_m, segment_count: kept as u32 };
        self.count += 1;
    }

    /// Whether a look can be placed beside those before it: by compass or odometry, and the first of all by anything.
    pub(super) const fn can_place(&self, heading: Option<HeadingPrior>, motion: Option<Motion>) -> bool {
        self.count == 0 || heading.is_some() || motion.is_some()
    }

    /// The compass speaks at the first look; after that odometry, where there is one, tells better.
    fn next_pose(&mut self, heading: Option<HeadingPrior>, motion: Option<Motion>) -> (f32, [f32; 2]) {
        let measured = heading.map_or(0.0, |heading| heading.mean.angle().radians());
        let Some(last) = self.count.checked_sub(1).map(|last| self.pose(last)) else {
            // Beyond half a radian, and where it makes no sense, the search would not find the heading anyway.
            self.compass_spread_rad = heading.map(|heading| {
                let spread_rad = math::abs(heading.standard_deviation.radians());
                if spread_rad < 0.5 { spread_rad } else { 0.5 }
            });
            return (measured, [0.0; 2]);
        };
        let Some(motion) = motion.filter(|motion| motion.step_m.is_finite()) else { return (measured, last.way_m) };
        let (sin, cos) = math::sin_cos(last.heading_rad);
        let Point2 { x: forward, y: left } = motion.step_m;
        let way_m = [last.way_m[0] + forward * cos - left * sin, last.way_m[1] + forward * sin + left * cos];
        let turned = Heading::new(Angle::from_radians(last.heading_rad + motion.turn.radians()));
        (turned.map_or(measured, |heading| heading.angle().radians()), way_m)
    }
}

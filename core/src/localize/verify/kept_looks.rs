//! The looks of an attempt, kept until its end so that closer hypotheses can be checked against all of them.

use super::SeenSegment;
use super::dominant::DominantDirection;
use super::image_frame::ImageFrame;
use crate::geometry::{Angle, Heading, Point2, Segment2};
use crate::localize::segment_filter::SegmentFilter;
use crate::localize::{HeadingPrior, Motion};
use crate::math;
use zerocopy::{FromBytes, Immutable, IntoBytes};

/// A heading known better than this beside the first look's is taken as it is told \[rad\]: 0.2 degrees.
const EXACT_HEADING_RAD: f32 = 0.0035;
/// Standard deviations to either side at which a heading that is known less well is tried too.
const SPREADS: f32 = 1.2;
/// A robot that drove less stands where it stood \[m\].
pub(super) const LEAST_MOVE_M: f32 = 0.25;

/// How the camera stood at a look, as far as compass and odometry tell.
#[derive(Debug, Clone, Copy, PartialEq, Default, FromBytes, IntoBytes, Immutable)]
#[repr(C)]
pub(super) struct LookPose {
    /// Heading at the look if the compass did not err at the first \[rad\].
    pub(super) heading_rad: f32,
    /// Way made since the first look if the compass did not err there, axes of the world \[m\].
    pub(super) way_m: [f32; 2],
    /// Standard deviation of the heading beside that of the first look \[rad\].
    pub(super) heading_spread_rad: f32,
    /// What the heading is off beside that of the first look, as it was fitted \[rad\].
    pub(super) drift_rad: f32,
    /// Standard deviation of the way, along either axis \[m\].
    pub(super) way_spread_m: f32,
    pub(super) segments_end: u32,
    /// Length of its segments in Q4 px.
    pub(super) seen_q4: i32,
}

impl LookPose {
    /// What its heading may be off beside that of the first look: nothing, or to either side \[rad\].
    pub(super) fn heading_errors_rad(&self) -> impl Iterator<Item = f32> + use<> {
        let step_rad = SPREADS * self.heading_spread_rad;
        let tried = if self.heading_spread_rad > EXACT_HEADING_RAD { 3 } else { 1 };
        [0.0, -step_rad, step_rad].into_iter().take(tried)
    }

    /// What is left of that beside the errors tried \[rad\].
    pub(super) fn heading_left_rad(&self) -> f32 {
        if self.heading_spread_rad > EXACT_HEADING_RAD {
            0.4 * self.heading_spread_rad
        } else {
            self.heading_spread_rad
        }
    }

    /// Whether it was taken after a move, not merely after turns that drifted.
    pub(super) fn is_elsewhere(&self) -> bool {
        math::length(self.way_m[0], self.way_m[1]) >= LEAST_MOVE_M
    }

    /// The way made since the first look if the compass erred by that much there, axes of the world \[m\].
    pub(super) fn way_m_if(&self, heading_error_rad: f32) -> [f32; 2] {
        let [x, y] = self.way_m;
        let (sin, cos) = math::sin_cos(heading_error_rad);
        [x * cos - y * sin, x * sin + y * cos]
    }
}

/// All looks of the attempt.
#[derive(Debug)]
pub(super) struct KeptLooks<'m> {
    poses: &'m mut [LookPose],
    /// Those of all looks, one behind the other.
    segments: &'m mut [SeenSegment],
    /// Segments of a look at most.
    max_segments: usize,
    count: usize,
    /// The first look from where the robot stands now.
    first_here: usize,
    has_odometry: bool,
    seen_q4: i32,
    /// Standard deviation of the compass at the first look \[rad\]; none without a compass.
    compass_spread_rad: Option<f32>,
    /// Directions of edges relative to the first look's heading as [`LookPose`] has it.
    dominant: DominantDirection,
}

impl<'m> KeptLooks<'m> {
    pub(super) fn new(poses: &'m mut [LookPose], segments: &'m mut [SeenSegment], max_segments: u16) -> Self {
        Self {
            poses,
            segments,
            max_segments: usize::from(max_segments),
            count: 0,
            first_here: 0,
            has_odometry: false,
            seen_q4: 0,
            compass_spread_rad: None,
            dominant: DominantDirection::NONE,
        }
    }

    pub(super) fn clear(&mut self) {
        (self.count, self.first_here, self.seen_q4) = (0, 0, 0);
        self.has_odometry = false;
        self.dominant = DominantDirection::NONE;
    }

    pub(super) const fn count(&self) -> usize {
        self.count
    }

    /// Whether there is no room for a look more, or too little to be worth one.
    pub(super) const fn is_full(&self) -> bool {
        self.count == self.poses.len() || self.segments.len() - self.segment_count() as usize <= self.max_segments / 4
    }

    /// Whether the robot told of its motion since the look before.
    pub(super) const fn has_odometry(&self) -> bool {
        self.has_odometry
    }

    /// The looks from where the robot stands now.
    pub(super) fn here(&self) -> &[LookPose] {
        &self.poses[self.first_here..self.count]
    }

    /// Segments of all looks.
    pub(super) const fn segment_count(&self) -> u32 {
        if self.count == 0 { 0 } else { self.poses[self.count - 1].segments_end }
    }

    /// Room for segments that belong to no look.
    pub(super) fn spare(&mut self) -> &mut [SeenSegment] {
        let taken = self.segment_count() as usize;
        &mut self.segments[taken..]
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

    /// Corrects what the heading of a look is off beside that of the first.
    pub(super) fn drift(&mut self, look: usize, by_rad: f32) {
        if let Some(pose) = self.poses.get_mut(look) {
            pose.drift_rad += by_rad;
        }
    }

    /// Takes no heading for off beside that of the first look.
    pub(super) fn forget_drift(&mut self) {
        self.poses.iter_mut().for_each(|pose| pose.drift_rad = 0.0);
    }

    /// Length of the segments of a look in Q4 px.
    pub(super) fn seen_q4_in(&self, look: usize) -> i32 {
        self.pose(look).seen_q4
    }

    /// The segments of a look that entered.
    pub(super) fn segments(&self, look: usize) -> &[SeenSegment] {
        let first = look.checked_sub(1).map_or(0, |before| self.pose(before).segments_end);
        &self.segments[first as usize..self.pose(look).segments_end as usize]
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
        let taken = self.segment_count();
        let places = &mut self.segments[taken as usize..];
        let capacity = places.len().min(self.max_segments);
        let places = &mut places[..capacity];
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
        let seen_q4 = places[..kept].iter().fold(0_i32, |sum, seen| sum.saturating_add(seen.length_q4()));
        self.seen_q4 = self.seen_q4.saturating_add(seen_q4);
        let pose = LookPose { segments_end: taken + kept as u32, seen_q4, ..self.next_pose(heading, motion) };
        if self.compass_spread_rad.is_none() {
            self.dominant.add_image(segments, pose.heading_rad, frame);
        }
        let before = self.pose(self.first_here.min(self.count.saturating_sub(1))).way_m;
        if math::length(pose.way_m[0] - before[0], pose.way_m[1] - before[1]) >= LEAST_MOVE_M {
            self.first_here = self.count;
        }
        self.poses[self.count] = pose;
        self.count += 1;
    }

    /// Whether a look can be placed beside those before it: by compass or odometry, and the first of all by anything.
    pub(super) const fn can_place(&self, heading: Option<HeadingPrior>, motion: Option<Motion>) -> bool {
        self.count == 0 || heading.is_some() || motion.is_some()
    }

    /// The compass speaks at the first look; after that the more exact of compass and odometry.
    fn next_pose(&mut self, compass: Option<HeadingPrior>, motion: Option<Motion>) -> LookPose {
        let told = compass.map(|compass| {
            // Beyond half a radian the search would not find the heading anyway.
            (compass.mean.angle().radians(), sane(compass.standard_deviation.radians()))
        });
        let Some(last) = self.count.checked_sub(1).map(|last| self.pose(last)) else {
            self.compass_spread_rad = told.map(|(_, spread_rad)| spread_rad);
            return LookPose { heading_rad: told.map_or(0.0, |(told_rad, _)| told_rad), ..LookPose::default() };
        };
        let motion = motion.filter(|motion| motion.step_m.is_finite());
        self.has_odometry = motion.is_some();
        let mut next = LookPose { heading_spread_rad: 0.5, drift_rad: 0.0, ..last };
        if let Some(motion) = motion {
            let (sin, cos) = math::sin_cos(last.heading_rad);
            let Point2 { x: forward, y: left } = motion.step_m;
            next.way_m = [last.way_m[0] + forward * cos - left * sin, last.way_m[1] + forward * sin + left * cos];
            next.way_spread_m = math::length(
                math::length(last.way_spread_m, sane(motion.step_standard_deviation_m)),
                math::length(forward, left) * last.heading_spread_rad,
            );
            if let Some(turned) = Heading::new(Angle::from_radians(last.heading_rad + motion.turn.radians())) {
                next.heading_rad = turned.angle().radians();
                next.heading_spread_rad =
                    math::length(last.heading_spread_rad, sane(motion.turn_standard_deviation.radians()));
            }
        }
        // Without a compass at the first look headings are relative to it, and what a compass tells later is not.
        if let Some((told_rad, spread_rad)) = told.filter(|_| self.compass_spread_rad.is_some() || motion.is_none())
            && (spread_rad < next.heading_spread_rad || next.heading_spread_rad >= 0.5)
        {
            (next.heading_rad, next.heading_spread_rad) = (told_rad, spread_rad);
        }
        next
    }
}

/// A standard deviation that makes sense: not negative, half a metre or radian at most.
fn sane(spread: f32) -> f32 {
    let spread = math::abs(spread);
    if spread < 0.5 { spread } else { 0.5 }
}

//! One hypothesis against one look: what the model predicts is looked up in the distance planes.

use super::Evidence;
use super::cameras::{BATCH, Cameras};
use super::channel::channel_in_lane;
use super::distance_planes::{DistancePlanes, PIXEL_PX};
use super::frustum::Frustum;
use super::image_frame::ImageFrame;
use super::kept_looks::{KeptLooks, LookPose};
use super::lane_image::LaneImage;
use super::lanes::{LANES, Lane, MAX_POINTS, Tables, any};
use super::responses::{Responses, WIDTHS};
use super::seen_segment::SeenSegment;
use super::view::{ViewSegment, turn_model};
use crate::database::Node;
use crate::geometry::{Point2, StereoRig, inside_part};
use crate::localize::segment_filter::SegmentFilter;
use crate::matching::{Body, Work, run};
use crate::math;

/// Segments of a node that can be seen from near it at a heading; a node that shows more shows the first so many.
pub(super) const VIEW_CAPACITY: usize = 384;
/// Tolerance of the prediction apart from the pose \[px\]: lateral shift and the width of edges.
const FIXED_TOLERANCE_PX: f32 = 6.0;
/// Pixels of a plane to one of the normal image.
const PLANE_PER_PX: f32 = 1.0 / PIXEL_PX;
/// Error of the model itself \[m\].
const MODEL_ERROR_M: f32 = 0.012;
/// Weights of the four response widths: what is predicted loosely counts less.
const WEIGHTS: [f32; WIDTHS] = [1.0, 0.8, 0.55, 0.3];

/// How exactly a hypothesis is posed, and how closely it is looked at.
#[derive(Debug, Clone, Copy)]
pub(super) struct Closeness {
    /// Uncertainty of the position \[m\].
    pub(super) position_m: f32,
    /// Uncertainty of the heading \[rad\].
    pub(super) heading_rad: f32,
    /// Distance between points that are looked up \[px\].
    pub(super) spacing_px: f32,
}

impl Closeness {
    /// As closely, for the camera as it stood at a look, whose heading is one of those it may have had.
    pub(super) fn at(self, look: &LookPose) -> Self {
        Self {
            position_m: math::length(self.position_m, look.way_spread_m),
            heading_rad: math::length(self.heading_rad, look.heading_left_rad()),
            ..self
        }
    }

    /// As closely, for the camera as it stood at a look, whose heading may be off by all its spread.
    pub(super) fn loosely_at(self, look: &LookPose) -> Self {
        Self { heading_rad: math::length(self.heading_rad, look.heading_spread_rad), ..self.at(look) }
    }
}

/// A projected model segment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Projected {
    pub(super) start_px: [f32; 2],
    pub(super) end_px: [f32; 2],
    /// Inverse depths of start and end \[1/m\].
    pub(super) inverse_depth: [f32; 2],
}

/// Checks hypotheses against the look that is drawn, with the model that is turned to it.
#[derive(Debug)]
pub(super) struct Checker<'m> {
    planes: DistancePlanes<'m>,
    responses: Responses,
    frame: ImageFrame,
    filter: SegmentFilter,
    frustum: Frustum,
    storage: &'m mut [ViewSegment],
    view_count: usize,
    /// Sine and cosine of the heading that the model is turned to.
    sin_cos: (f32, f32),
    drawn_look: Option<usize>,
}

impl<'m> Checker<'m> {
    pub(super) fn new(
        rig: &StereoRig,
        filter: SegmentFilter,
        planes: &'m mut [u8; DistancePlanes::BYTES],
        storage: &'m mut [ViewSegment],
    ) -> Self {
        let frame = ImageFrame::new(&rig.camera);
        Self {
            planes: DistancePlanes::new(planes),
            responses: Responses::new(),
            frame,
            filter,
            frustum: Frustum::new(&frame, rig.near_limit_m),
            storage,
            view_count: 0,
            sin_cos: (0.0, 1.0),
            drawn_look: None,
        }
    }

    pub(super) const fn frame(&self) -> &ImageFrame {
        &self.frame
    }

    pub(super) const fn filter(&self) -> &SegmentFilter {
        &self.filter
    }

    pub(super) const fn heading_sin_cos(&self) -> (f32, f32) {
        self.sin_cos
    }

    pub(super) fn view(&self) -> &[ViewSegment] {
        &self.storage[..self.view_count]
    }

    pub(super) const fn drawn_look(&self) -> Option<usize> {
        self.drawn_look
    }

    /// Forgets what is drawn: the looks are others now.
    pub(super) fn forget(&mut self) {
        self.drawn_look = None;
    }

    /// Draws a look, unless it is already.
    pub(super) fn draw(&mut self, looks: &KeptLooks<'_>, look: usize) {
        if self.drawn_look != Some(look) {
            self.draw_segments(looks.segments(look));
            self.drawn_look = Some(look);
        }
    }

    /// Draws segments that belong to no look.
    pub(super) fn draw_segments(&mut self, segments: &[SeenSegment]) {
        self.planes.redraw(segments);
        self.responses.measure_background(&self.planes);
        self.drawn_look = None;
    }

    /// Turns a node's model to a heading, for cameras within `reach_m` of `offset_m` from the node.
    pub(super) fn turn(&mut self, node: &Node<'_>, heading_rad: f32, (offset_m, reach_m): ([f32; 2], f32)) {
        self.sin_cos = math::sin_cos(heading_rad);
        let center = self.in_camera(offset_m);
        self.view_count = turn_model(node, self.sin_cos, self.frustum.sides(), (center, reach_m), self.storage);
        for segment in &mut self.storage[..self.view_count] {
            segment.measure(center, self.frame.focal_px);
        }
    }

    /// An offset along the axes of the world as one to the right and forward.
    pub(super) fn in_camera(&self, offset_m: [f32; 2]) -> [f32; 2] {
        let ([x, y], (sin, cos)) = (offset_m, self.sin_cos);
        [x * sin - y * cos, x * cos + y * sin]
    }

    /// Evidence for a camera at `offset_m` from the node, axes of the world.
    pub(super) fn evidence(&self, offset_m: [f32; 2], closeness: &Closeness) -> Evidence {
        let mut found = [Evidence::default()];
        self.evidence_of_all(&[offset_m], closeness, &mut found);
        found[0]
    }

    /// Evidence for cameras at `offsets_m` from the node, axes of the world, a place in `found` for each.
    pub(super) fn evidence_of_all(&self, offsets_m: &[[f32; 2]], closeness: &Closeness, found: &mut [Evidence]) {
        for (offsets_m, found) in offsets_m.chunks(BATCH).zip(found.chunks_mut(BATCH)) {
            let cameras = Cameras::new(offsets_m.iter().map(|offset_m| self.in_camera(*offset_m)), self.frustum);
            run(Batch { checker: self, cameras: &cameras, closeness, found });
        }
    }

    /// How many points of a segment are looked up, when they are to lie `per_px` to a pixel.
    fn point_count(segment: &ViewSegment, per_px: f32) -> usize {
        ((segment.extent_px * per_px + 0.5) as usize).clamp(1, MAX_POINTS)
    }

    /// Evidence for as many cameras as there are places in `found`, `N` at a time.
    #[inline(always)]
    fn evidence_in_lanes<const N: usize>(
        &self,
        body: impl Body,
        cameras: &Cameras,
        closeness: &Closeness,
        found: &mut [Evidence],
    ) {
        const { assert!(BATCH.is_multiple_of(N), "the lanes of a batch come in whole vectors") };
        let focal = self.frame.focal_px;
        let (position, model) = (focal * closeness.position_m, focal * MODEL_ERROR_M);
        let heading = focal * closeness.heading_rad;
        let tolerance = Tolerance {
            fixed_part: FIXED_TOLERANCE_PX * FIXED_TOLERANCE_PX + heading * heading,
            depth_part: position * position + model * model,
        };
        let per_px = 1.0 / closeness.spacing_px;
        let mut explained = [0.0; BATCH];
        let mut total = [0.0; BATCH];
        for segment in self.view() {
            let Some(planes) = cameras.planes_across(segment.start, segment.end) else { continue };
            let count = Self::point_count(segment, per_px);
            for first in (0..found.len()).step_by(N) {
                let part = cameras.seen_part((segment.start, segment.end), first, planes);
                if !any(&part.is_any()) {
                    continue;
                }
                let segment = (segment.start, segment.end);
                let image = LaneImage::of(segment, &cameras.offsets::<N>(first), &part, (&self.frame, &self.filter));
                if image.is_any_seen() {
                    let [more_explained, more_total] = self.evidence_of_segment(body, &image, &tolerance, count);
                    add(&mut explained, first, &more_explained);
                    add(&mut total, first, &more_total);
                }
            }
        }
        for (index, found) in found.iter_mut().enumerate().take(BATCH) {
            *found = Evidence { explained_q4: in_q4(explained[index]), total_q4: in_q4(total[index]) };
        }
    }

    /// What a segment explains and what it would at most, in 1/255 px.
    #[inline(always)]
    fn evidence_of_segment<const N: usize>(
        &self,
        body: impl Body,
        image: &LaneImage<N>,
        tolerance: &Tolerance,
        count: usize,
    ) -> [Lane<f32, N>; 2] {
        let mut width = [0_u32; N];
        let mut channel = [0_u32; N];
        for lane in 0..N {
            width[lane] = tolerance.width(image.inverse_depth[lane]);
            channel[lane] = channel_in_lane(image.way[0][lane], image.way[1][lane]);
        }
        let share = PLANE_PER_PX * POINT_SHARES[count];
        let mut first = [[0.0; N]; 2];
        let mut step = [[0.0; N]; 2];
        for axis in 0..2 {
            for lane in 0..N {
                step[axis][lane] = image.way[axis][lane] * share;
                first[axis][lane] = image.start[axis][lane] * PLANE_PER_PX + 0.5 * step[axis][lane];
            }
        }
        let mut place = [0_u32; N];
        let mut weight_px = [0.0; N];
        for lane in 0..N {
            place[lane] = WIDTHS as u32 * channel[lane] + width[lane];
            weight_px[lane] = image.seen_px[lane] * WEIGHTS[width[lane] as usize & 3];
        }
        let background = body.bytes_at(self.responses.backgrounds(), &place);
        let tables = Tables { planes: self.planes.all(), responses: self.responses.table() };
        let sum = tables.sum(body, count, (first, step), &channel, &width);
        let (mut explained, mut total) = ([0.0; N], [0.0; N]);
        for lane in 0..N {
            let (mean, background) = (sum[lane] as f32 * POINT_SHARES[count], background[lane] as i32 as f32);
            explained[lane] = weight_px[lane] * (mean - background);
            total[lane] = weight_px[lane] * (255.0 - background);
        }
        [explained, total]
    }

    /// Image of a model segment for a camera at `offset_m` (right, forward), cut at the near limit and the border.
    pub(super) fn project(&self, segment: &ViewSegment, offset_m: [f32; 2]) -> Option<Projected> {
        let (frame, near_m, [left, right]) = (&self.frame, self.frustum.near_m(), self.frustum.sides());
        let moved = |p: [f32; 3]| [p[0] - offset_m[0], p[1], p[2] - offset_m[1]];
        let (mut start, mut end) = (moved(segment.start), moved(segment.end));
        if start[2] < near_m {
            if end[2] < near_m {
                return None;
            }
            start = cut_near(start, end, near_m);
        } else if end[2] < near_m {
            end = cut_near(end, start, near_m);
        }
        let is_right = start[0] > right * start[2] && end[0] > right * end[2];
        let is_left = start[0] < -left * start[2] && end[0] < -left * end[2];
        if is_left || is_right {
            return None;
        }
        let (start_inverse, end_inverse) = (1.0 / start[2], 1.0 / end[2]);
        let image = |p: [f32; 3], inverse: f32| {
            let scale = frame.focal_px * inverse;
            [frame.center_px[0] + p[0] * scale, frame.center_px[1] + p[1] * scale]
        };
        let (start, end) = (image(start, start_inverse), image(end, end_inverse));
        let point = |[x, y]: [f32; 2]| Point2::new(x, y);
        let (enter, leave) = inside_part(point(start), point(end), frame.width_px, frame.height_px)?;
        let at = |t: f32| [start[0] + (end[0] - start[0]) * t, start[1] + (end[1] - start[1]) * t];
        let inverse_at = |t: f32| start_inverse + (end_inverse - start_inverse) * t;
        Some(Projected {
            start_px: at(enter),
            end_px: at(leave),
            inverse_depth: [inverse_at(enter), inverse_at(leave)],
        })
    }
}

/// What the image of a model segment may be off, by the uncertainty of the pose \[px^2\].
#[derive(Debug)]
struct Tolerance {
    fixed_part: f32,
    /// Of a segment a metre away.
    depth_part: f32,
}

impl Tolerance {
    /// The width of the response to a segment.
    #[inline(always)]
    fn width(&self, inverse_depth: f32) -> u32 {
        let tolerance = self.fixed_part + self.depth_part * inverse_depth * inverse_depth;
        u32::from(tolerance > 100.0) + u32::from(tolerance > 400.0) + u32::from(tolerance > 1600.0)
    }
}

/// Poses that are checked together.
struct Batch<'a, 'm> {
    checker: &'a Checker<'m>,
    cameras: &'a Cameras,
    closeness: &'a Closeness,
    found: &'a mut [Evidence],
}

impl Work for Batch<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<B: Body>(self, body: B) {
        /// Lanes that leave few idle where there are few cameras.
        const HALF: usize = LANES.div_ceil(2);
        let Self { checker, cameras, closeness, found } = self;
        if found.len() == 1 {
            checker.evidence_in_lanes::<1>(body, cameras, closeness, found);
        } else if found.len() <= HALF {
            checker.evidence_in_lanes::<HALF>(body, cameras, closeness, found);
        } else {
            checker.evidence_in_lanes::<LANES>(body, cameras, closeness, found);
        }
    }
}

/// `1 / count`.
const POINT_SHARES: [f32; MAX_POINTS + 1] = {
    let mut shares = [0.0; MAX_POINTS + 1];
    let mut count = 1;
    while count <= MAX_POINTS {
        shares[count] = 1.0 / count as f32;
        count += 1;
    }
    shares
};

/// A length in 1/255 px as one in Q4 px.
fn in_q4(length_per_255: f32) -> i32 {
    math::round_to_i32(length_per_255 * (16.0 / 255.0))
}

/// Adds `more` to as many of `sums` from the `first` on.
#[inline(always)]
fn add<const N: usize>(sums: &mut [f32; BATCH], first: usize, more: &Lane<f32, N>) {
    let Some(sums) = sums.get_mut(first..).and_then(<[f32]>::first_chunk_mut::<N>) else { return };
    for (sum, more) in sums.iter_mut().zip(more) {
        *sum += more;
    }
}

/// The point where the way from `behind` to `before` comes into view.
fn cut_near(behind: [f32; 3], before: [f32; 3], near_m: f32) -> [f32; 3] {
    let t = (near_m - behind[2]) / (before[2] - behind[2]);
    [behind[0] + (before[0] - behind[0]) * t, behind[1] + (before[1] - behind[1]) * t, near_m]
}

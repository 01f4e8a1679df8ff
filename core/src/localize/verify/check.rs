//! One hypothesis against one look: what the model predicts is looked up in the distance planes.

use super::Evidence;
use super::channel::channel_of;
use super::distance_planes::{COLUMNS, DistancePlanes, ROWS};
use super::image_frame::ImageFrame;
use super::kept_looks::KeptLooks;
use super::responses::Responses;
use super::seen_segment::SeenSegment;
use super::view::{ViewSegment, turn_model};
use crate::database::Node;
use crate::geometry::{Point2, StereoRig, inside_part};
use crate::localize::segment_filter::SegmentFilter;
use crate::math;

/// Segments of a node that can be seen from near it at a heading; a node that shows more shows the first so many.
pub(super) const VIEW_CAPACITY: usize = 512;
/// Tolerance of the prediction apart from the pose \[px\]: lateral shift and the width of edges.
const FIXED_TOLERANCE_PX: f32 = 6.0;
/// Error of the model itself \[m\].
const MODEL_ERROR_M: f32 = 0.012;
/// Weights of the four response widths, in Q8: what is predicted loosely counts less.
const WEIGHTS_Q8: [i32; 4] = [256, 205, 141, 77];

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
    near_m: f32,
    /// Slopes of the left and right border of the view.
    view_slopes: [f32; 2],
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
        planes: &'m mut [u8],
        storage: &'m mut [ViewSegment],
    ) -> Self {
        let frame = ImageFrame::new(&rig.camera);
        let left = frame.center_px[0] / frame.focal_px;
        let right = (frame.width_px - frame.center_px[0]) / frame.focal_px;
        Self {
            planes: DistancePlanes::new(planes),
            responses: Responses::new(),
            frame,
            filter,
            near_m: rig.near_limit_m,
            view_slopes: [left, right],
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
        self.view_count = turn_model(node, self.sin_cos, self.view_slopes, (center, reach_m), self.storage);
    }

    /// An offset along the axes of the world as one to the right and forward.
    pub(super) fn in_camera(&self, offset_m: [f32; 2]) -> [f32; 2] {
        let ([x, y], (sin, cos)) = (offset_m, self.sin_cos);
        [x * sin - y * cos, x * cos + y * sin]
    }

    /// Evidence for a camera at `offset_m` from the node, axes of the world.
    pub(super) fn evidence(&self, offset_m: [f32; 2], closeness: &Closeness) -> Evidence {
        let offset = self.in_camera(offset_m);
        let focal = self.frame.focal_px;
        let (position, model) = (focal * closeness.position_m, focal * MODEL_ERROR_M);
        let depth_part = position * position + model * model;
        let heading = focal * closeness.heading_rad;
        let fixed_part = FIXED_TOLERANCE_PX * FIXED_TOLERANCE_PX + heading * heading;
        let per_px = 1.0 / closeness.spacing_px;
        let mut evidence = Evidence::default();
        for segment in self.view() {
            let Some(projected) = self.project(segment, offset) else { continue };
            let (start, end) = (projected.start_px, projected.end_px);
            let (dx, dy) = (end[0] - start[0], end[1] - start[1]);
            let (width_px, height_px) = (dx.abs(), dy.abs());
            let length = octagonal_length(width_px, height_px);
            if length < self.filter.min_length_px || height_px < self.filter.horizontal_slope * width_px {
                continue;
            }
            let inverse_depth = 0.5 * (projected.inverse_depth[0] + projected.inverse_depth[1]);
            let tolerance = fixed_part + depth_part * inverse_depth * inverse_depth;
            let width =
                usize::from(tolerance > 100.0) + usize::from(tolerance > 400.0) + usize::from(tolerance > 1600.0);
            let channel = channel_of(dx, dy);
            let (plane, table) = (self.planes.plane(channel), self.responses.table(width));
            let count = ((length * per_px + 0.5) as i32).max(1);
            let share = 0.25 / count as f32;
            let (step_x, step_y) = (dx * share, dy * share);
            let (mut x, mut y) = (start[0] * 0.25 + 0.5 * step_x, start[1] * 0.25 + 0.5 * step_y);
            let mut sum = 0_i32;
            for _ in 0..count {
                let (column, row) = ((x as usize).min(COLUMNS - 1), (y as usize).min(ROWS - 1));
                sum += i32::from(table[usize::from(plane[row * COLUMNS + column])]);
                x += step_x;
                y += step_y;
            }
            let background = i32::from(self.responses.background(channel, width));
            let weight = (length * 16.0) as i32 * WEIGHTS_Q8[width] / 256;
            // At most 16,384 x 255: far from the border of i32.
            evidence.explained_q4 += weight * (sum / count - background) / 255;
            evidence.total_q4 += weight * (255 - background) / 255;
        }
        evidence
    }

    /// Image of a model segment for a camera at `offset_m` (right, forward), cut at the near limit and the border.
    pub(super) fn project(&self, segment: &ViewSegment, offset_m: [f32; 2]) -> Option<Projected> {
        let (frame, near_m, [left, right]) = (&self.frame, self.near_m, self.view_slopes);
        let moved = |p: [f32; 3]| [p[0] - offset_m[0], p[1], p[2] - offset_m[1]];
        let (mut start, mut end) = (moved(segment.start), moved(segment.end));
        if start[2] < near_m {
            if end[2] < near_m {
                return None;
            }
            start = cut(start, end, near_m);
        } else if end[2] < near_m {
            end = cut(end, start, near_m);
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

/// The point where the way from `behind` to `before` comes into view.
fn cut(behind: [f32; 3], before: [f32; 3], near_m: f32) -> [f32; 3] {
    let t = (near_m - behind[2]) / (before[2] - behind[2]);
    [behind[0] + (before[0] - behind[0]) * t, behind[1] + (before[1] - behind[1]) * t, near_m]
}

/// Length of a vector by its sides' magnitudes, within 1.3 %: no square root.
fn octagonal_length(width: f32, height: f32) -> f32 {
    let (long, short) = if width > height { (width, height) } else { (height, width) };
    math::max(0.99 * long + 0.197 * short, 0.84 * long + 0.561 * short)
}

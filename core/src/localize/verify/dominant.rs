//! The direction that most of the horizontal edges of a building run along, or across.
//!
//! Without a compass it tells the heading up to quarter turns: in the images of the looks it is found relative to the
//! robot, in the map relative to the world.

use crate::database::TopologicalDatabase;
use crate::geometry::Segment2;
use crate::localize::verify::image_frame::ImageFrame;
use crate::math;
use core::f32::consts::FRAC_PI_2;

/// Bins of a quarter turn, one degree each.
const BINS: usize = 90;
/// Bins to either side of the best that share in it.
const HALF_WINDOW: usize = 3;
/// Image lines steeper than this are uprights, which have no direction.
const STEEPEST: f32 = 2.0;
/// Model segments that climb more than this share of their length are not level.
const LEVEL: f32 = 0.1;

/// Most nodes whose edges tell how a building lies.
const MOST_NODES: usize = 1024;

/// Lengths of edges by their direction, modulo a quarter turn.
#[derive(Debug, Clone)]
pub(super) struct DominantDirection {
    lengths: [u32; BINS],
}

impl DominantDirection {
    pub(super) const NONE: Self = Self { lengths: [0; BINS] };

    /// Adds the segments of an image, as if all stood for level edges; `heading_rad` is that of the optical axis.
    pub(super) fn add_image(&mut self, segments: &[Segment2], heading_rad: f32, frame: &ImageFrame) {
        let ray = |x: f32, y: f32| {
            [
                (x * frame.scale - frame.center_px[0]) / frame.focal_px,
                (y * frame.scale - frame.center_px[1]) / frame.focal_px,
            ]
        };
        for segment in segments {
            let (start, end) = (segment.start(), segment.end());
            if math::abs(end.y - start.y) > STEEPEST * math::abs(end.x - start.x) {
                continue;
            }
            let ([ax, ay], [bx, by]) = (ray(start.x, start.y), ray(end.x, end.y));
            // The normal of the plane through the camera and the line; a level direction in it has no part downwards.
            let normal = [ay - by, bx - ax, ax * by - ay * bx];
            let level = math::length(normal[0], normal[2]);
            let whole = math::length(level, normal[1]);
            // A line at the height of the camera says nothing: its plane is level.
            if whole > 0.0 {
                let to_the_right = math::atan2(normal[2], -normal[0]);
                self.add(heading_rad - to_the_right, segment.length_px() * level / whole);
            }
        }
    }

    /// Adds all level edges of a map; of one with many nodes, those of some, evenly among all.
    pub(super) fn of_map(database: &TopologicalDatabase<'_>) -> Self {
        let mut direction = Self::NONE;
        let step = database.node_count().div_ceil(MOST_NODES);
        for segment in database.nodes().step_by(step.max(1)).flat_map(|node| node.segments()) {
            let (dx, dy) = (segment.end.x - segment.start.x, segment.end.y - segment.start.y);
            let across = math::length(dx, dy);
            if math::abs(segment.end.z - segment.start.z) <= LEVEL * across {
                direction.add(math::atan2(dy, dx), 100.0 * across);
            }
        }
        direction
    }

    fn add(&mut self, angle_rad: f32, length: f32) {
        let turns = angle_rad / FRAC_PI_2;
        let bin = ((turns - math::floor(turns)) * BINS as f32) as usize % BINS;
        self.lengths[bin] = self.lengths[bin].saturating_add(math::min(length, 1e6) as u32);
    }

    /// The dominant direction in radians, 0 to below a quarter turn; `None` when nothing was added.
    pub(super) fn peak_rad(&self) -> Option<f32> {
        let lengths = &self.lengths;
        let at = move |bin: usize| u64::from(lengths[bin % BINS]);
        let window = |first: usize| (0..=2 * HALF_WINDOW).map(move |step| at(first + step));
        let mut best = (0, 0_u64);
        for first in 0..BINS {
            let sum = window(first).sum();
            if sum > best.1 {
                best = (first, sum);
            }
        }
        let (first, sum) = best;
        let moment = (0..).zip(window(first)).map(|(step, length): (u64, u64)| step * length).sum::<u64>();
        let bin = first as f32 + 0.5 + moment as f32 / sum as f32;
        let bin = if bin >= BINS as f32 { bin - BINS as f32 } else { bin };
        (sum > 0).then_some(bin * FRAC_PI_2 / BINS as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{PinholeCamera, Point3, Polarity, Segment3};
    use std::vec::Vec;

    #[test]
    fn level_edges_of_a_turned_box_tell_its_direction_and_uprights_do_not_disturb() {
        let camera = PinholeCamera::reference();
        let frame = ImageFrame::new(&camera);
        for degrees in [3.0_f32, 20.0, 44.0, 71.0, 88.5] {
            let (sin, cos) = math::sin_cos(degrees.to_radians());
            // Camera frame of a heading of zero: world x is forward, world y to the left.
            let point = |along: f32, across: f32, height: f32| {
                let (x, y) = (4.0 + along * cos - across * sin, along * sin + across * cos);
                Point3::new(-y, -height, x)
            };
            let edge = |start, end| Segment3 { start, end, polarity: Polarity::LeftBrighter };
            let mut edges = Vec::new();
            for height in [-0.9_f32, -0.4, 0.7, 1.2] {
                for side in [-1.0_f32, 1.0] {
                    edges.push(edge(point(-1.0, side, height), point(1.0, side, height)));
                    edges.push(edge(point(side, -1.0, height), point(side, 1.0, height)));
                    edges.push(edge(point(side, side, -0.9), point(side, side, height)));
                }
            }
            let seen: Vec<Segment2> = edges.iter().filter_map(|edge| camera.project_segment(edge, 0.1)).collect();
            let mut direction = DominantDirection::NONE;
            direction.add_image(&seen, 0.0, &frame);
            let found = direction.peak_rad().expect("edges were seen").to_degrees();
            let off = (found - degrees + 45.0).rem_euclid(90.0) - 45.0;
            assert!(off.abs() < 1.5, "{degrees}: {found}");
        }
    }

    #[test]
    fn nothing_seen_tells_nothing() {
        assert_eq!(DominantDirection::NONE.peak_rad(), None);
    }
}

//! What the last scan met around the robot, and whether a motion keeps clear of it.

use super::scan::{MAX_RAYS, RangeScan};
use crate::geometry::Point2;
use crate::math;

/// Points farther away than this play no part in the next motion \[m\].
const REACH_M: f32 = 2.0;

/// The points met near the robot, from its center along the axes of the odometry \[m\].
#[derive(Debug)]
pub(super) struct NearField {
    points: heapless::Vec<Point2, MAX_RAYS>,
}

impl NearField {
    pub(super) const fn new() -> Self {
        Self { points: heapless::Vec::new() }
    }

    /// Takes in a scan made at a heading \[rad\].
    pub(super) fn update(&mut self, heading_rad: f32, scan: &RangeScan<'_>) {
        self.points.clear();
        for (direction, range_m, is_met) in scan.rays() {
            if is_met && range_m < REACH_M {
                let (sin, cos) = math::sin_cos(heading_rad + direction);
                // A scan has no more rays than there is room.
                let _ = self.points.push(Point2::new(cos * range_m, sin * range_m));
            }
        }
    }

    /// Distance from the robot's center to the nearest point \[m\].
    pub(super) fn clearance_m(&self) -> f32 {
        self.points.iter().fold(REACH_M, |least, point| math::min(least, math::length(point.x, point.y)))
    }

    /// Least distance of a point from the straight way to `target` \[m\].
    pub(super) fn clearance_on_way_m(&self, target: Point2) -> f32 {
        let length_squared = target.x * target.x + target.y * target.y;
        let squared = self.points.iter().fold(REACH_M * REACH_M, |least, point| {
            let along = point.x * target.x + point.y * target.y;
            let t = if along <= 0.0 || length_squared <= 0.0 { 0.0 } else { math::min(along / length_squared, 1.0) };
            let (dx, dy) = (point.x - t * target.x, point.y - t * target.y);
            math::min(least, dx * dx + dy * dy)
        });
        math::sqrt(squared)
    }

    /// Whether a point lies within `reach_m` to the right of a heading \[rad\].
    pub(super) fn has_wall_at_right(&self, heading_rad: f32, reach_m: f32) -> bool {
        let (sin, cos) = math::sin_cos(heading_rad);
        self.points.iter().any(|point| {
            let to_right = point.x * sin - point.y * cos;
            to_right > 0.0 && math::length(point.x, point.y) < reach_m
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wall 1 m east of the robot, from rays every degree.
    fn wall_in_the_east() -> NearField {
        let mut ranges = [f32::INFINITY; 360];
        for (degree, range_m) in ranges.iter_mut().enumerate() {
            let cos = math::sin_cos((degree as f32).to_radians()).1;
            *range_m = if cos > 0.1 { 1.0 / cos } else { f32::INFINITY };
        }
        let mut near = NearField::new();
        near.update(0.0, &RangeScan::new(&ranges, 8.0).expect("a scan"));
        near
    }

    #[test]
    fn a_way_towards_a_wall_loses_clearance_and_one_along_it_none() {
        let near = wall_in_the_east();
        let on_way = |x, y| near.clearance_on_way_m(Point2::new(x, y));
        assert!((near.clearance_m() - 1.0).abs() < 1e-4);
        assert!((on_way(0.4, 0.0) - 0.6).abs() < 1e-4);
        assert!((on_way(0.0, 0.5) - 1.0).abs() < 1e-3 && (on_way(-0.5, 0.0) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn the_right_hand_side_turns_with_the_heading() {
        let near = wall_in_the_east();
        assert!(near.has_wall_at_right(core::f32::consts::FRAC_PI_2, 1.2));
        assert!(!near.has_wall_at_right(-core::f32::consts::FRAC_PI_2, 1.2));
        assert!(!near.has_wall_at_right(core::f32::consts::FRAC_PI_2, 0.9));
    }
}

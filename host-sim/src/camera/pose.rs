//! Where a camera stands and looks, and the change between the world's and its own frame.
//!
//! World: metres, z up. Camera: metres, x right, y down, z forward; the optical axis is horizontal.

use edgeloc::geometry::{Heading, Point3, Segment3};
use edgeloc::math;

/// Position and heading of one camera with a horizontal optical axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraPose {
    eye: Point3,
    sin_heading: f32,
    cos_heading: f32,
}

impl CameraPose {
    /// A camera with its optical centre at `eye` (world frame), its axis pointing to `heading`.
    #[must_use]
    pub fn new(eye: Point3, heading: Heading) -> Self {
        let (sin_heading, cos_heading) = math::sin_cos(heading.angle().radians());
        Self { eye, sin_heading, cos_heading }
    }

    /// A point of the world in this camera's frame.
    #[must_use]
    pub fn camera_from_world(&self, point: Point3) -> Point3 {
        let (dx, dy) = (point.x - self.eye.x, point.y - self.eye.y);
        Point3::new(
            dx * self.sin_heading - dy * self.cos_heading,
            self.eye.z - point.z,
            dx * self.cos_heading + dy * self.sin_heading,
        )
    }

    /// A point of this camera's frame in the world.
    #[must_use]
    pub fn world_from_camera(&self, point: Point3) -> Point3 {
        Point3::new(
            self.eye.x + point.x * self.sin_heading + point.z * self.cos_heading,
            self.eye.y - point.x * self.cos_heading + point.z * self.sin_heading,
            self.eye.z - point.y,
        )
    }

    /// A segment of the world in this camera's frame, polarity carried over.
    #[must_use]
    pub fn segment_from_world(&self, segment: &Segment3) -> Segment3 {
        Segment3 {
            start: self.camera_from_world(segment.start),
            end: self.camera_from_world(segment.end),
            polarity: segment.polarity,
        }
    }

    /// A segment of this camera's frame in the world, polarity carried over.
    #[must_use]
    pub fn segment_from_camera(&self, segment: &Segment3) -> Segment3 {
        Segment3 {
            start: self.world_from_camera(segment.start),
            end: self.world_from_camera(segment.end),
            polarity: segment.polarity,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use edgeloc::geometry::Angle;

    fn pose(degrees: f32) -> CameraPose {
        let heading = Heading::new(Angle::from_degrees(degrees)).expect("a finite heading");
        CameraPose::new(Point3::new(3.0, -2.0, 1.0), heading)
    }

    #[test]
    fn what_lies_ahead_left_and_above_is_forward_negative_x_and_negative_y() {
        // Heading 90 degrees looks along +y, so the world's -x lies to the left.
        let seen = pose(90.0).camera_from_world(Point3::new(2.0, 3.0, 1.5));
        assert!(seen.distance(Point3::new(-1.0, -0.5, 5.0)) < 1e-5, "{seen:?}");
    }

    #[test]
    fn going_to_the_camera_frame_and_back_changes_nothing() {
        for degrees in [0.0, 30.0, 123.0, -170.0] {
            let point = Point3::new(-4.0, 7.5, 2.25);
            let back = pose(degrees).world_from_camera(pose(degrees).camera_from_world(point));
            assert!(back.distance(point) < 1e-5, "{degrees}: {back:?}");
        }
    }
}

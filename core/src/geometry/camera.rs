//! The pinhole camera: projection of points and segments, with clipping.

use super::{Point2, Point3, Segment2, Segment3};
use crate::math;
use core::fmt;

/// An ideal pinhole camera without distortion, square pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PinholeCamera {
    width_px: u16,
    height_px: u16,
    focal_length_px: f32,
    principal_point_px: Point2,
}

impl PinholeCamera {
    /// The camera of the reference rig: 640 x 480 px, 65 degrees wide, principal point at the centre.
    #[must_use]
    pub const fn reference() -> Self {
        // 502.3 px = 320 px / tan(32.5 degrees).
        Self { width_px: 640, height_px: 480, focal_length_px: 502.3, principal_point_px: Point2::new(320.0, 240.0) }
    }

    /// A camera from its image size, focal length and principal point, all in pixels.
    ///
    /// # Errors
    /// When a side is zero or above 2048 px, the focal length not within 1 to 100,000 px, or the principal point
    /// outside the image.
    pub fn new(size_px: (u16, u16), focal_length_px: f32, principal_point_px: Point2) -> Result<Self, CameraError> {
        let (width_px, height_px) = size_px;
        let side_fits = |side: u16| side > 0 && f32::from(side) <= Segment2::MAX_COORDINATE_PX;
        if !side_fits(width_px) || !side_fits(height_px) {
            return Err(CameraError::ImageSize);
        }
        if !(1.0..=100_000.0).contains(&focal_length_px) {
            return Err(CameraError::FocalLength);
        }
        let inside = (0.0..=f32::from(width_px)).contains(&principal_point_px.x)
            && (0.0..=f32::from(height_px)).contains(&principal_point_px.y);
        if !inside {
            return Err(CameraError::PrincipalPoint);
        }
        Ok(Self { width_px, height_px, focal_length_px, principal_point_px })
    }

    /// Image width \[px\].
    #[must_use]
    pub const fn width_px(&self) -> u16 {
        self.width_px
    }

    /// Image height \[px\].
    #[must_use]
    pub const fn height_px(&self) -> u16 {
        self.height_px
    }

    /// Focal length \[px\].
    #[must_use]
    pub const fn focal_length_px(&self) -> f32 {
        self.focal_length_px
    }

    /// Where the optical axis meets the image \[px\].
    #[must_use]
    pub const fn principal_point_px(&self) -> Point2 {
        self.principal_point_px
    }

    /// Image of a point of the camera frame with `z > 0`; not clipped to the image.
    #[must_use]
    pub fn project(&self, point: Point3) -> Point2 {
        let scale = self.focal_length_px / point.z;
        Point2::new(self.principal_point_px.x + point.x * scale, self.principal_point_px.y + point.y * scale)
    }

    /// Image of a segment of the camera frame, cut at `near_limit_m` and at the image border.
    ///
    /// `None` when nothing of it is seen. Direction and polarity carry over. `near_limit_m` must be positive.
    #[must_use]
    pub fn project_segment(&self, segment: &Segment3, near_limit_m: f32) -> Option<Segment2> {
        let (start, end) = clip_near(segment.start, segment.end, near_limit_m)?;
        let (start, end) = self.clip_to_image(self.project(start), self.project(end))?;
        Segment2::new(start, end, segment.polarity).ok()
    }

    /// Whether [`Self::project_segment`] surely sees nothing of the segment from `start` to `end`, both within 100 m:
    /// nearer than the limit, or to the left or to the right of the image as a whole. Cheap; most of what a node knows is
    /// beside the image.
    ///
    /// A point lies to the left where `principal x * z + focal length * x < 0`. That is linear, so that the part beyond the
    /// near limit does as well. What must not be seen here is told apart by a margin of more than a hundred times the
    /// rounding of this and of the projection.
    #[inline]
    pub(crate) fn is_surely_beside(&self, start: Point3, end: Point3, near_limit_m: f32) -> bool {
        const MARGIN_M: f32 = 100.0 * 1.0e-5;
        let (left, right) = (self.principal_point_px.x, f32::from(self.width_px) - self.principal_point_px.x);
        let margin = MARGIN_M * (self.focal_length_px + f32::from(self.width_px));
        let from_left = |point: Point3| left * point.z + self.focal_length_px * point.x;
        let from_right = |point: Point3| right * point.z - self.focal_length_px * point.x;
        (start.z < near_limit_m && end.z < near_limit_m)
            || (from_left(start) < -margin && from_left(end) < -margin)
            || (from_right(start) < -margin && from_right(end) < -margin)
    }

    /// The part of the segment from `start` to `end` inside the image rectangle.
    #[must_use]
    pub fn clip_to_image(&self, start: Point2, end: Point2) -> Option<(Point2, Point2)> {
        let (width, height) = (f32::from(self.width_px), f32::from(self.height_px));
        let (enter, leave) = inside_part(start, end, width, height)?;
        let within = |coordinate, side| math::max(math::min(coordinate, side), 0.0);
        let inside = |p: Point2| Point2::new(within(p.x, width), within(p.y, height));
        Some((inside(start.lerp(end, enter)), inside(start.lerp(end, leave))))
    }
}

/// The fractions of the way from `start` to `end` between which it lies in the rectangle from the origin to `width` and
/// `height` (Liang and Barsky 1984).
pub(crate) fn inside_part(start: Point2, end: Point2, width: f32, height: f32) -> Option<(f32, f32)> {
    let (dx, dy) = (end.x - start.x, end.y - start.y);
    let borders = [(-dx, start.x), (dx, width - start.x), (-dy, start.y), (dy, height - start.y)];
    let (mut enter, mut leave) = (0.0_f32, 1.0_f32);
    for (outward, room) in borders {
        if outward < 0.0 {
            enter = math::max(enter, room / outward);
        } else if outward > 0.0 {
            leave = math::min(leave, room / outward);
        } else if room < 0.0 {
            return None;
        }
    }
    (enter < leave).then_some((enter, leave))
}

/// The part of a segment of the camera frame with `z >= near_limit_m`.
fn clip_near(start: Point3, end: Point3, near_limit_m: f32) -> Option<(Point3, Point3)> {
    let (start_in, end_in) = (start.z >= near_limit_m, end.z >= near_limit_m);
    if start_in && end_in {
        return Some((start, end));
    }
    if !start_in && !end_in {
        return None;
    }
    let mut cut = start.lerp(end, (near_limit_m - start.z) / (end.z - start.z));
    cut.z = near_limit_m;
    Some(if start_in { (start, cut) } else { (cut, end) })
}

/// Why numbers do not make a [`PinholeCamera`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CameraError {
    /// A side of the image is zero or above 2048 px.
    ImageSize,
    /// The focal length is not within 1 to 100,000 px.
    FocalLength,
    /// The principal point lies outside the image.
    PrincipalPoint,
}

impl fmt::Display for CameraError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ImageSize => "image side is not within 1 to 2048 px",
            Self::FocalLength => "focal length is not within 1 to 100,000 px",
            Self::PrincipalPoint => "principal point is outside the image",
        })
    }
}

impl core::error::Error for CameraError {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Polarity;
    use proptest::prelude::*;

    const CAMERA: PinholeCamera = PinholeCamera::reference();

    fn segment(start: (f32, f32, f32), end: (f32, f32, f32)) -> Segment3 {
        Segment3 {
            start: Point3::new(start.0, start.1, start.2),
            end: Point3::new(end.0, end.1, end.2),
            polarity: Polarity::LeftBrighter,
        }
    }

    #[test]
    fn the_reference_camera_sees_65_degrees() {
        let half = math::atan2(0.5 * f32::from(CAMERA.width_px()), CAMERA.focal_length_px());
        assert!((2.0 * half.to_degrees() - 65.0).abs() < 0.02);
    }

    #[test]
    fn a_vertical_edge_ahead_projects_to_the_middle_column() {
        let seen = CAMERA.project_segment(&segment((0.0, -0.5, 2.0), (0.0, 0.5, 2.0)), 0.15).expect("in view");
        assert!((seen.start().x - 320.0).abs() < 1e-3 && (seen.length_px() - 251.15).abs() < 0.01);
    }

    #[test]
    fn a_segment_through_the_camera_plane_is_cut_at_the_near_limit_and_the_border() {
        let seen = CAMERA.project_segment(&segment((0.1, 0.2, -1.0), (0.1, 0.2, 3.0)), 0.15).expect("partly in view");
        for point in [seen.start(), seen.end()] {
            assert!((0.0..=640.0).contains(&point.x) && (0.0..=480.0).contains(&point.y));
        }
    }

    #[test]
    fn segments_behind_or_beside_the_view_are_not_seen() {
        assert!(CAMERA.project_segment(&segment((0.0, 0.0, -1.0), (0.0, 1.0, -1.0)), 0.15).is_none());
        assert!(CAMERA.project_segment(&segment((9.0, -0.5, 1.0), (9.0, 0.5, 1.0)), 0.15).is_none());
    }

    fn told_apart() -> impl Strategy<Value = (PinholeCamera, f32, Segment3)> {
        let camera = (1.0..2000.0_f32, 1_u16..2048, 0.0..1.0_f32).prop_map(|(focal_length_px, width, at)| {
            let principal = Point2::new(f32::from(width) * at, 100.0);
            PinholeCamera::new((width, 200), focal_length_px, principal).expect("in range")
        });
        // Anywhere, and within rounding of the borders of the view and of the near limit.
        let end = (-46.0..46.0_f32, -33.0..33.0_f32, -46.0..46.0_f32, 0..5_u8, -3.0e-3..3.0e-3_f32);
        (camera, 0.01..1.0_f32, end.clone(), end).prop_map(|(camera, near_limit_m, start, end)| {
            let point = |(x, y, z, place, off): (f32, f32, f32, u8, f32)| {
                let border = |column_px: f32| (column_px - camera.principal_point_px.x) / camera.focal_length_px;
                match place {
                    0 => Point3::new(border(0.0) * z + off, y, z),
                    1 => Point3::new(border(f32::from(camera.width_px)) * z + off, y, z),
                    2 => Point3::new(x, y, near_limit_m + off),
                    3 => Point3::new(border(0.0) * near_limit_m + off, y, near_limit_m + 0.1 * off),
                    _ => Point3::new(x, y, z),
                }
            };
            (camera, near_limit_m, Segment3 { start: point(start), end: point(end), polarity: Polarity::LeftBrighter })
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn what_is_surely_beside_is_not_seen((camera, near_limit_m, segment) in told_apart()) {
            let is_beside = camera.is_surely_beside(segment.start, segment.end, near_limit_m);
            prop_assert!(!is_beside || camera.project_segment(&segment, near_limit_m).is_none());
        }
    }

    #[test]
    fn most_of_what_is_not_seen_is_told_beforehand() {
        let (mut unseen, mut beside) = (0, 0);
        for degrees in 0..360 {
            let (sin, cos) = math::sin_cos((degrees as f32).to_radians());
            let post = segment((4.0 * sin, -0.5, 4.0 * cos), (4.0 * sin, 0.5, 4.0 * cos));
            unseen += usize::from(CAMERA.project_segment(&post, 0.15).is_none());
            beside += usize::from(CAMERA.is_surely_beside(post.start, post.end, 0.15));
        }
        assert_eq!((unseen, beside), (295, 295));
    }
}

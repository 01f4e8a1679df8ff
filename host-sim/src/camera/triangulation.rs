//! Rectified stereo: a 3-D segment of the left camera's frame from a piece in the left and a piece in the right image.
//!
//! Epipolar lines are image rows. Over the rows that both pieces cover, each piece gives its x; at both ends of that
//! overlap, with disparity d = x_left - x_right, the point is z = f b / d, x = (x_left - c_x) z / f,
//! y = (row - c_y) z / f.
//!
//! Near-horizontal pieces are ill-conditioned: where a line rises by one row in m columns, a vertical error of e rows
//! is an error of m e columns in the disparity, m = 11.4 at 5 degrees; exactly horizontal ones have no overlap at all.
//! The matcher leaves out those within 5 degrees of the horizontal (the epipolar removal among the uncertainty sources);
//! here an overlap below [`MIN_OVERLAP_PX`] is refused, and with it what is shorter than [`MIN_SHARED_LENGTH_PX`].

use super::StereoFeature;
use edgeloc::geometry::{Point2, Point3, Segment2, Segment3, StereoRig};

/// Least number of rows that both pieces must cover, in pixels.
pub const MIN_OVERLAP_PX: f32 = 1.0;

/// Least length of the shared part in the left image, in pixels.
///
/// The localiser leaves out what is shorter than 12 px, and turning on the spot lengthens an image by 1.4 at most
/// within the reference field of view: what
/// falls short of this is a splinter between two gaps that would only fill the map (a quarter of it, in an office).
pub const MIN_SHARED_LENGTH_PX: f32 = 6.0;

/// The 3-D segments of one feature in the left camera's frame: one for each left and right piece that share rows.
///
/// None when the feature is not matchable. `rig` is the rig as calibrated, which may differ from the one that made the
/// images.
pub fn triangulate_feature<'a>(rig: &'a StereoRig, feature: &'a StereoFeature) -> impl Iterator<Item = Segment3> + 'a {
    let left_pieces: &[Segment2] = if feature.is_matchable { &feature.left } else { &[] };
    left_pieces
        .iter()
        .flat_map(move |left| feature.right.iter().filter_map(move |right| triangulate_pieces(rig, left, right)))
}

/// The 3-D segment of a left and a right piece in the left camera's frame, directed and polarised like the left one.
///
/// `None` when they share fewer than [`MIN_OVERLAP_PX`] rows or [`MIN_SHARED_LENGTH_PX`] of the left piece, or when at either
/// end the disparity is not positive or the depth is outside the rig's `nearest_model_m` to `farthest_model_m`.
#[must_use]
pub fn triangulate_pieces(rig: &StereoRig, left: &Segment2, right: &Segment2) -> Option<Segment3> {
    let (left_top, left_bottom) = rows(left);
    let (right_top, right_bottom) = rows(right);
    let (top, bottom) = (left_top.max(right_top), left_bottom.min(right_bottom));
    if bottom - top < MIN_OVERLAP_PX {
        return None;
    }
    let (start_row, end_row) = if left.start().y <= left.end().y { (top, bottom) } else { (bottom, top) };
    let start = Point2::new(column(left, start_row), start_row);
    let end = Point2::new(column(left, end_row), end_row);
    if start.distance(end) < MIN_SHARED_LENGTH_PX {
        return None;
    }
    let point = |left_point: Point2| triangulate_point(rig, left_point, column(right, left_point.y));
    Some(Segment3 { start: point(start)?, end: point(end)?, polarity: left.polarity() })
}

fn triangulate_point(rig: &StereoRig, left: Point2, right_x_px: f32) -> Option<Point3> {
    let camera = &rig.camera;
    let disparity_px = left.x - right_x_px;
    if disparity_px <= 0.0 {
        return None;
    }
    let depth_m = camera.focal_length_px() * rig.baseline_m / disparity_px;
    if !(rig.nearest_model_m..=rig.farthest_model_m).contains(&depth_m) {
        return None;
    }
    let center = camera.principal_point_px();
    let scale = depth_m / camera.focal_length_px();
    Some(Point3::new((left.x - center.x) * scale, (left.y - center.y) * scale, depth_m))
}

/// First and last row that a piece covers.
fn rows(piece: &Segment2) -> (f32, f32) {
    let (start, end) = (piece.start().y, piece.end().y);
    (start.min(end), start.max(end))
}

/// Where the line of a piece crosses a row; the piece covers at least [`MIN_OVERLAP_PX`] rows.
fn column(piece: &Segment2, row: f32) -> f32 {
    let (start, end) = (piece.start(), piece.end());
    start.x + (row - start.y) * ((end.x - start.x) / (end.y - start.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{CameraPose, observe_pieces};
    use edgeloc::geometry::{Angle, Heading, Polarity};

    const RIG: StereoRig = StereoRig::reference();

    fn pose() -> CameraPose {
        let heading = Heading::new(Angle::from_degrees(37.0)).expect("a finite heading");
        CameraPose::new(Point3::new(4.0, 3.0, 1.0), heading)
    }

    /// A world segment between two points given in the camera frame.
    fn world_segment(start: (f32, f32, f32), end: (f32, f32, f32)) -> Segment3 {
        pose().segment_from_camera(&Segment3 {
            start: Point3::new(start.0, start.1, start.2),
            end: Point3::new(end.0, end.1, end.2),
            polarity: Polarity::RightBrighter,
        })
    }

    fn piece(start: (f32, f32), end: (f32, f32)) -> Segment2 {
        Segment2::new(Point2::new(start.0, start.1), Point2::new(end.0, end.1), Polarity::LeftBrighter)
            .expect("a segment")
    }

    #[test]
    fn a_noise_free_segment_comes_back_within_a_millimetre_at_two_metres() {
        for (start, end) in [
            ((0.1, -0.4, 2.0), (0.1, 0.4, 2.0)),
            ((0.3, 0.4, 2.0), (-0.2, -0.3, 2.2)),
            ((-0.5, 0.1, 2.0), (0.5, 0.25, 2.0)),
            ((0.2, 0.3, 1.6), (0.25, 0.4, 2.4)),
        ] {
            let world = world_segment(start, end);
            let seen = observe_pieces(&RIG, &pose(), [world]);
            let model: Vec<_> = triangulate_feature(&RIG, &seen.features[0]).collect();
            assert_eq!(model.len(), 1, "{start:?} {end:?}");
            let back = pose().segment_from_camera(&model[0]);
            assert!(back.start.distance(world.start) < 1e-3, "{:?} {:?}", back.start, world.start);
            assert!(back.end.distance(world.end) < 1e-3, "{:?} {:?}", back.end, world.end);
            assert_eq!(back.polarity, world.polarity);
        }
    }

    #[test]
    fn a_segment_cut_differently_by_the_two_image_borders_still_lies_on_its_line() {
        let world = world_segment((-1.5, -0.3, 2.0), (0.2, 0.3, 2.0));
        let seen = observe_pieces(&RIG, &pose(), [world]);
        let model: Vec<_> = triangulate_feature(&RIG, &seen.features[0]).collect();
        assert_eq!(model.len(), 1);
        for end in [model[0].start, model[0].end] {
            assert!((end.z - 2.0).abs() < 1e-3 && (end.x - (end.y + 0.3) / 0.6 * 1.7 + 1.5).abs() < 2e-3, "{end:?}");
        }
    }

    #[test]
    fn an_edge_outside_the_right_image_is_seen_but_not_matchable() {
        // At 2 m the left image reaches 1.27 m to the left, the right image 1.15 m.
        let seen = observe_pieces(&RIG, &pose(), [world_segment((-1.2, -0.3, 2.0), (-1.2, 0.3, 2.0))]);
        assert!(!seen.features[0].is_matchable && seen.features[0].right.is_empty());
        assert_eq!(triangulate_feature(&RIG, &seen.features[0]).count(), 0);
    }

    #[test]
    fn gaps_in_either_image_make_one_segment_for_each_shared_run_of_rows() {
        let feature = StereoFeature {
            left: vec![piece((340.0, 100.0), (340.0, 180.0)), piece((340.0, 200.0), (340.0, 300.0))],
            right: vec![piece((310.0, 100.0), (310.0, 150.0)), piece((310.0, 170.0), (310.0, 300.0))],
            is_matchable: true,
        };
        let rows: Vec<_> = triangulate_feature(&RIG, &feature)
            .map(|segment| (RIG.camera.project(segment.start).y, RIG.camera.project(segment.end).y))
            .collect();
        let expected = [(100.0, 150.0), (170.0, 180.0), (200.0, 300.0)];
        assert_eq!(rows.len(), expected.len());
        for (found, expected) in rows.iter().zip(expected) {
            assert!((found.0 - expected.0).abs() < 0.01 && (found.1 - expected.1).abs() < 0.01, "{rows:?}");
        }
    }

    #[test]
    fn too_little_in_common_and_impossible_depths_are_refused() {
        let left = piece((340.0, 100.0), (345.0, 200.0));
        let refused = [
            piece((310.0, 199.5), (315.0, 300.0)),
            piece((310.0, 195.0), (315.0, 300.0)),
            piece((310.0, 250.0), (315.0, 300.0)),
            // Behind the camera, at infinity, beyond 16 m (3.8 px), nearer than 0.25 m (241 px).
            piece((350.0, 100.0), (355.0, 200.0)),
            piece((340.0, 100.0), (345.0, 200.0)),
            piece((337.0, 100.0), (342.0, 200.0)),
            piece((90.0, 100.0), (95.0, 200.0)),
        ];
        for right in refused {
            assert_eq!(triangulate_pieces(&RIG, &left, &right), None, "{right:?}");
        }
        assert!(triangulate_pieces(&RIG, &left, &piece((310.0, 100.0), (315.0, 200.0))).is_some());
        let level = piece((300.0, 150.0), (400.0, 150.0));
        assert_eq!(triangulate_pieces(&RIG, &level, &piece((270.0, 150.0), (370.0, 150.0))), None);
    }
}

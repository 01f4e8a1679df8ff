//! What the camera would see from a node at a heading: the node's 3-D segments, turned, cut and projected in `f64`.

use super::NaiveSegment;
use edgeloc::geometry::{PinholeCamera, Point3, Segment3, StereoRig};

/// The image of node-frame segments (origin at the camera, z up) for a camera looking along `heading` \[rad\].
///
/// Those not seen at all are left out.
#[must_use]
pub fn predict(rig: &StereoRig, segments: &[Segment3], heading: f64) -> Vec<NaiveSegment> {
    let near_limit = f64::from(rig.near_limit_m);
    let image_of = |segment: &Segment3| {
        let ends = [camera_from_node(segment.start, heading), camera_from_node(segment.end, heading)];
        let [start, end] = keep_inside(ends, |point| point[2] - near_limit)?;
        let [start, end] = clip_to_image(&rig.camera, [project(&rig.camera, start), project(&rig.camera, end)])?;
        Some(NaiveSegment { start, end, polarity: segment.polarity })
    };
    segments.iter().filter_map(image_of).collect()
}

/// Camera frame: x right, y down, z forward.
fn camera_from_node(point: Point3, heading: f64) -> [f64; 3] {
    let [x, y, z] = [point.x, point.y, point.z].map(f64::from);
    let (sin, cos) = heading.sin_cos();
    [x * sin - y * cos, -z, x * cos + y * sin]
}

fn project(camera: &PinholeCamera, [x, y, z]: [f64; 3]) -> [f64; 2] {
    let (focal_length, principal_point) = (f64::from(camera.focal_length_px()), camera.principal_point_px());
    [f64::from(principal_point.x) + focal_length * x / z, f64::from(principal_point.y) + focal_length * y / z]
}

fn clip_to_image(camera: &PinholeCamera, mut ends: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
    let (width, height) = (f64::from(camera.width_px()), f64::from(camera.height_px()));
    ends = keep_inside(ends, |point| point[0])?;
    ends = keep_inside(ends, |point| width - point[0])?;
    ends = keep_inside(ends, |point| point[1])?;
    keep_inside(ends, |point| height - point[1])
}

/// The part of a segment where `room`, linear along it, is not negative (Sutherland and Hodgman, one border at a time).
fn keep_inside<const N: usize>(ends: [[f64; N]; 2], room: impl Fn(&[f64; N]) -> f64) -> Option<[[f64; N]; 2]> {
    let [start, end] = ends;
    let (at_start, at_end) = (room(&start), room(&end));
    if at_start < 0.0 && at_end < 0.0 {
        return None;
    }
    let border = |from: [f64; N], to: [f64; N], fraction: f64| {
        std::array::from_fn(|axis| from[axis] + (to[axis] - from[axis]) * fraction)
    };
    let crossing = border(start, end, at_start / (at_start - at_end));
    Some([if at_start < 0.0 { crossing } else { start }, if at_end < 0.0 { crossing } else { end }])
}

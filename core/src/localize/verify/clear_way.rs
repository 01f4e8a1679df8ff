//! How far a robot can drive before it meets something that the map knows.

use crate::database::Node;
use crate::geometry::Point3;
use crate::math;

/// Half the width of the way that has to be clear \[m\].
const HALF_WIDTH_M: f32 = 0.35;
/// What is higher above the camera than this is passed below \[m\].
const HEADROOM_M: f32 = 0.3;
/// Distance between points of a segment that are looked at \[m\].
const SPACING_M: f32 = 0.2;

/// The way straight ahead to the nearest edge of `node`'s model \[m\], from a camera at `offset_m` from the node along the
/// heading given by its sine and cosine; `most_m` where nothing is nearer.
pub(super) fn clear_way_m(node: &Node<'_>, offset_m: [f32; 2], (sin, cos): (f32, f32), most_m: f32) -> f32 {
    let mut clear_m = most_m;
    for segment in node.segments() {
        let (start, end) = (segment.start, segment.end);
        let way = Point3::new(end.x - start.x, end.y - start.y, end.z - start.z);
        let count = (math::length(math::length(way.x, way.y), way.z) / SPACING_M) as u16 + 1;
        for index in 0..=count {
            let t = f32::from(index) / f32::from(count);
            let (x, y) = (start.x + way.x * t - offset_m[0], start.y + way.y * t - offset_m[1]);
            let (ahead_m, aside_m) = (x * cos + y * sin, x * sin - y * cos);
            let is_in_the_way = math::abs(aside_m) < HALF_WIDTH_M && start.z + way.z * t < HEADROOM_M;
            if is_in_the_way && ahead_m > 0.0 && ahead_m < clear_m {
                clear_m = ahead_m;
            }
        }
    }
    clear_m
}

//! Matched corners of generic views, drawn as a rig sees them: scattered, some of them wrong matches.

use edgeloc::geometry::Point2;
use edgeloc::math::double;
use edgeloc::stereo::{CornerPair, StereoParameters};
use edgeloc_sim::random::Stream;

/// Standard deviation of a corner's position, in x and in y of either image \[px\].
pub const NOISE_PX: f64 = 0.15;

/// Share of wrong matches.
const MISMATCH: f64 = 0.01;

/// A corner somewhere in the left image, 1 to 6 m away, as the two cameras see it.
#[must_use]
pub fn corner(rig: &StereoParameters, stream: &mut Stream) -> CornerPair {
    let pixel = |at: [f64; 2], stream: &mut Stream| {
        let [x, y] = stream.circular_gaussian();
        Point2::new((at[0] + x * NOISE_PX) as f32, (at[1] + y * NOISE_PX) as f32)
    };
    let [x, y] = rig.left.direction([stream.uniform(0.0, 640.0), stream.uniform(0.0, 480.0)]);
    let depth_m = stream.uniform(1.0, 6.0);
    let [beside_x, beside_y, beside_z] = moved(rig, [x * depth_m, y * depth_m, depth_m]);
    let left = pixel(rig.left.pixel([x, y]), stream);
    let mut right = pixel(rig.right.pixel([beside_x / beside_z, beside_y / beside_z]), stream);
    if stream.chance(MISMATCH) {
        // A wrong match, anywhere in a circle of 10 px.
        let (angle, radius) = (stream.uniform(0.0, core::f64::consts::TAU), 10.0 * stream.unit().sqrt());
        let (sin, cos) = double::sin_cos(angle);
        right = Point2::new(right.x + (radius * cos) as f32, right.y + (radius * sin) as f32);
    }
    CornerPair { left, right }
}

/// A point of the left camera's frame in the right one's: R p + T, R by its axis and angle.
fn moved(rig: &StereoParameters, p: [f64; 3]) -> [f64; 3] {
    let w = rig.rotation_rad;
    let angle = w.iter().map(|w| w * w).sum::<f64>().sqrt();
    let n = w.map(|w| w / angle);
    let (sin, cos) = double::sin_cos(angle);
    let dot: f64 = n.iter().zip(p).map(|(n, p)| n * p).sum();
    let cross = [n[1] * p[2] - n[2] * p[1], n[2] * p[0] - n[0] * p[2], n[0] * p[1] - n[1] * p[0]];
    [0, 1, 2].map(|axis| p[axis] * cos + cross[axis] * sin + n[axis] * dot * (1.0 - cos) + rig.translation_m[axis])
}

//! A synthetic observation for the statistics tests of the sources.

use super::UncertaintySource;
use crate::camera::{StereoFeature, StereoObservation};
use crate::random::Stream;
use edgeloc::geometry::{Point2, Polarity, Segment2, StereoRig};
use edgeloc::math;
use edgeloc::stereo::CornerPair;

/// `count` matchable features of random direction, 10 to 250 px long, with disparities of 20 px.
pub(super) fn observation(count: usize) -> StereoObservation {
    let mut stream = Stream::new(1, "sample", 0, 0);
    let features = (0..count)
        .map(|_| {
            let mut draw = |low: f64, high: f64| stream.uniform(low, high) as f32;
            let (sin, cos) = math::sin_cos(draw(0.0, core::f64::consts::TAU));
            let (length_px, start) = (draw(10.0, 250.0), Point2::new(draw(270.0, 370.0), draw(220.0, 260.0)));
            let segment = |x: f32| {
                let end = Point2::new(x + cos * length_px, start.y + sin * length_px);
                Segment2::new(Point2::new(x, start.y), end, Polarity::LeftBrighter).expect("a segment")
            };
            let (left, right) = (vec![segment(start.x)], vec![segment(start.x - 20.0)]);
            StereoFeature { left, right, is_matchable: true }
        })
        .collect();
    StereoObservation { rig: StereoRig::reference(), features }
}

/// The observation of `count` features after one source.
pub(super) fn perturbed(source: &dyn UncertaintySource, count: usize) -> StereoObservation {
    let mut observation = observation(count);
    source.apply(&mut observation, &mut unit_stream());
    observation
}

/// `count` corners, no two alike.
pub(super) fn corners(count: usize) -> Vec<CornerPair> {
    let point = |index: usize, shift: f32| Point2::new(100.0 + index as f32 * 0.5 - shift, 50.0 + index as f32 * 0.25);
    (0..count).map(|index| CornerPair { left: point(index, 0.0), right: point(index, 20.0) }).collect()
}

/// A stream for one test.
pub(super) fn unit_stream() -> Stream {
    Stream::new(2, "test", 0, 0)
}

/// Signed distance from the first segment's line to the second segment's ends.
pub(super) fn offsets_px(before: &Segment2, after: &Segment2) -> [f32; 2] {
    let (start, end) = (before.start(), before.end());
    let normal = Point2::new((start.y - end.y) / before.length_px(), (end.x - start.x) / before.length_px());
    [after.start(), after.end()].map(|point| (point.x - start.x) * normal.x + (point.y - start.y) * normal.y)
}

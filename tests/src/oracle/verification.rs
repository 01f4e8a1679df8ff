//! Geometric verification in `f64`: distances to segments instead of distance planes, functions instead of tables.
//!
//! Departures that remain, and that the tolerance of the comparison covers: the library measures chamfer distances
//! between quarter-resolution pixels, rounds responses to 1/255, wide ones by half a distance unit, and lengths by an octagon, and
//! measures the background by every other row.

use super::{NaiveSegment, predict};
use edgeloc::geometry::{Point3, Segment3, StereoRig};
use std::f64::consts::PI;

/// Channels of orientation over pi.
const CHANNELS: usize = 8;
/// Upper tolerance \[px\], response width \[px\] and weight, from close to loose.
const WIDTHS: [(f64, f64, f64); 4] =
    [(10.0, 7.0, 1.0), (20.0, 14.0, 0.8), (40.0, 28.0, 0.55), (f64::INFINITY, 56.0, 0.3)];

/// How closely a hypothesis is posed: position \[m\], heading \[rad\] and the distance of looked-up points \[px\].
#[derive(Debug, Clone, Copy)]
pub struct NaiveCloseness {
    /// Uncertainty of the position \[m\].
    pub position_m: f64,
    /// Uncertainty of the heading \[rad\].
    pub heading_rad: f64,
    /// Distance between points that are looked up \[px\].
    pub spacing_px: f64,
}

/// Explained and total length \[px\] for a camera at `offset` from the node, looking along `heading`.
///
/// `scene` and the prediction enter from `min_length_px` on and unless within `exclusion` of horizontal \[rad\].
#[must_use]
pub fn verification_evidence(
    rig: &StereoRig,
    scene: &[NaiveSegment],
    model: &[Segment3],
    (offset, heading): ([f32; 2], f64),
    closeness: &NaiveCloseness,
    (min_length_px, exclusion): (f64, f64),
) -> (f64, f64) {
    let keeps =
        |segment: &&NaiveSegment| segment.length_px() >= min_length_px && segment.angle_to_horizontal() >= exclusion;
    let scene: Vec<NaiveSegment> = scene.iter().filter(keeps).copied().collect();
    let moved = |p: Point3| Point3::new(p.x - offset[0], p.y - offset[1], p.z);
    let (mut explained, mut total) = (0.0, 0.0);
    for segment in model {
        let from_camera = Segment3 { start: moved(segment.start), end: moved(segment.end), ..*segment };
        for image in predict(rig, &[from_camera], heading).iter().filter(keeps) {
            let tolerance = tolerance_px(rig, &from_camera, image, heading, closeness);
            let (_, width, weight) = WIDTHS[WIDTHS.iter().filter(|(limit, ..)| tolerance > *limit).count()];
            let channel = channels(image)[0];
            let alike: Vec<&NaiveSegment> = scene.iter().filter(|seen| channels(seen).contains(&channel)).collect();
            let count = (image.length_px() / closeness.spacing_px).round().max(1.0) as usize;
            let response: f64 = (0..count)
                .map(|index| {
                    let t = (index as f64 + 0.5) / count as f64;
                    response_at(
                        &alike,
                        [0, 1].map(|axis| image.start[axis] + (image.end[axis] - image.start[axis]) * t),
                        width,
                    )
                })
                .sum::<f64>()
                / count as f64;
            let background = background(rig, &alike, width);
            explained += weight * image.length_px() * (response - background);
            total += weight * image.length_px() * (1.0 - background);
        }
    }
    (explained, total)
}

/// `2 explained / (total + seen + 50 px)`.
#[must_use]
pub fn verification_score((explained, total): (f64, f64), seen_px: f64) -> f64 {
    2.0 * explained / (total + seen_px + 50.0)
}

/// How far a predicted segment may lie off: 6 px, and what position, model and heading may be off.
fn tolerance_px(
    rig: &StereoRig,
    segment: &Segment3,
    image: &NaiveSegment,
    heading: f64,
    closeness: &NaiveCloseness,
) -> f64 {
    let focal = f64::from(rig.camera.focal_length_px());
    let inverse_depth = inverse_depth_at(rig, segment, image, heading);
    let squares = [
        6.0,
        focal * closeness.position_m * inverse_depth,
        focal * 0.012 * inverse_depth,
        focal * closeness.heading_rad,
    ];
    squares.iter().map(|part| part * part).sum::<f64>().sqrt()
}

/// Inverse depth in the middle of the image of a segment: linear along the image, so by the plane through the camera.
fn inverse_depth_at(rig: &StereoRig, segment: &Segment3, image: &NaiveSegment, heading: f64) -> f64 {
    let (sin, cos) = heading.sin_cos();
    let in_camera = |p: Point3| {
        let [x, y, z] = [p.x, p.y, p.z].map(f64::from);
        [x * sin - y * cos, -z, x * cos + y * sin]
    };
    let (start, end) = (in_camera(segment.start), in_camera(segment.end));
    let focal = f64::from(rig.camera.focal_length_px());
    let center = rig.camera.principal_point_px();
    let [u, v] =
        [(image.midpoint()[0] - f64::from(center.x)) / focal, (image.midpoint()[1] - f64::from(center.y)) / focal];
    // The point start + t (end - start) on the ray (u, v, 1): by the coordinate that changes more across the ray.
    let along = [0, 1, 2].map(|axis| end[axis] - start[axis]);
    let by_column = (start[0] - u * start[2], along[0] - u * along[2]);
    let by_row = (start[1] - v * start[2], along[1] - v * along[2]);
    let (at, change) = if by_column.1.abs() > by_row.1.abs() { by_column } else { by_row };
    1.0 / (start[2] - at / change * along[2])
}

/// The nearest channel and the next nearest.
fn channels(segment: &NaiveSegment) -> [usize; 2] {
    let position = segment.direction(false) / PI * CHANNELS as f64;
    let nearest = position.round();
    let next = if position > nearest { nearest + 1.0 } else { nearest + 7.0 };
    [nearest as usize % CHANNELS, next as usize % CHANNELS]
}

fn response_at(alike: &[&NaiveSegment], point: [f64; 2], width: f64) -> f64 {
    let distance = alike.iter().map(|seen| distance_to(seen, point)).fold(f64::INFINITY, f64::min);
    // Planes measure up to 51 pixels of 4 px.
    if distance >= 204.0 { 0.0 } else { (-0.5 * (distance / width).powi(2)).exp() }
}

fn distance_to(segment: &NaiveSegment, point: [f64; 2]) -> f64 {
    let along = [segment.end[0] - segment.start[0], segment.end[1] - segment.start[1]];
    let away = [point[0] - segment.start[0], point[1] - segment.start[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    let t = ((away[0] * along[0] + away[1] * along[1]) / square).clamp(0.0, 1.0);
    (away[0] - t * along[0]).hypot(away[1] - t * along[1])
}

/// The mean response over the image, by every fourth pixel of the planes.
fn background(rig: &StereoRig, alike: &[&NaiveSegment], width: f64) -> f64 {
    let (columns, rows) = (rig.camera.width_px() / 16, rig.camera.height_px() / 16);
    let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let sum: f64 = cells
        .map(|(column, row)| response_at(alike, [f64::from(column) * 16.0 + 8.0, f64::from(row) * 16.0 + 8.0], width))
        .sum();
    sum / f64::from(columns * rows)
}

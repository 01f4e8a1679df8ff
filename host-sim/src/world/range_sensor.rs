//! The robot's range sensor: one turn of rays over the floor, each as high as the robot.
//!
//! A ray is a vertical sheet through the robot's whole height ([`FreeSpaceOptions::slice_m`]) that ends where any of it
//! first meets a surface, as when the points of a depth camera or of a laser of many planes are flattened to one scan.
//! So the sensor sees exactly what the robot's body could touch. A laser of a single plane does not: from 0.3 m it
//! looks between the legs of a table whose top stands in the robot's way. [`RangeSensorOptions::slice_m`] can be set to
//! such a plane; then the robot does run into tables.

use super::{FreeSpaceOptions, Outlines, Surfaces};
use crate::random::Stream;
use edgeloc::geometry::{Heading, Point2};
use edgeloc::math;

/// What the sensor is like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RangeSensorOptions {
    /// Rays of a turn.
    pub ray_count: u16,
    /// How far it sees \[m\].
    pub max_range_m: f32,
    /// Standard deviation of a distance \[m\].
    pub noise_m: f32,
    /// Heights between which it sees \[m\].
    pub slice_m: (f32, f32),
}

impl Default for RangeSensorOptions {
    /// 360 rays of 8 m with 1 cm of noise, over the robot's whole height.
    fn default() -> Self {
        Self { ray_count: 360, max_range_m: 8.0, noise_m: 0.01, slice_m: FreeSpaceOptions::default().slice_m }
    }
}

/// A range sensor in a world.
#[derive(Debug, Clone)]
pub struct RangeSensor {
    options: RangeSensorOptions,
    outlines: Outlines,
}

impl RangeSensor {
    /// A sensor among `surfaces`.
    #[must_use]
    pub fn new(surfaces: &Surfaces, options: &RangeSensorOptions) -> Self {
        Self::with_closed(surfaces, options, &[])
    }

    /// A sensor among `surfaces`, and what is closed beside them, as by a door.
    #[must_use]
    pub fn with_closed(surfaces: &Surfaces, options: &RangeSensorOptions, closed: &[[Point2; 2]]) -> Self {
        Self { options: *options, outlines: Outlines::with_closed(surfaces, options.slice_m, closed) }
    }

    /// What the sensor is like.
    #[must_use]
    pub const fn options(&self) -> &RangeSensorOptions {
        &self.options
    }

    /// One turn from `position`, the first ray along `heading`, the others counter-clockwise; infinity where nothing is
    /// met. `noise` is the stream of this scan.
    #[must_use]
    pub fn scan(&self, position: Point2, heading: Heading, noise: &mut Stream) -> Vec<f32> {
        let RangeSensorOptions { ray_count, max_range_m, noise_m, .. } = self.options;
        let spacing = core::f32::consts::TAU / f32::from(ray_count);
        let errors = std::iter::repeat_with(|| noise.circular_gaussian()).flatten();
        let ranges = (0..ray_count).zip(errors).map(|(ray, error)| {
            let (sin, cos) = math::sin_cos(heading.angle().radians() + f32::from(ray) * spacing);
            let met = self.outlines.range_m(position, (cos, sin), max_range_m)?;
            let range_m = (met + error as f32 * noise_m).max(0.0);
            (range_m < max_range_m).then_some(range_m)
        });
        ranges.map(|range_m| range_m.unwrap_or(f32::INFINITY)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use edgeloc::geometry::Point3;

    #[test]
    fn noise_has_its_spread_and_its_stream_decides_it() {
        let vertices = [(-1.0, 0.0), (1.0, 0.0), (1.0, 2.0), (-1.0, 2.0)];
        let wall = Surfaces {
            vertices: vertices.map(|(y, z)| Point3::new(2.0, y, z)).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        };
        let sensor = RangeSensor::new(&wall, &RangeSensorOptions { noise_m: 0.05, ..RangeSensorOptions::default() });
        let scan = |scan| sensor.scan(Point2::new(1.0, 0.0), Heading::default(), &mut Stream::new(1, "range", scan, 0));
        assert_eq!(scan(0), scan(0));
        assert_ne!(scan(0), scan(1));
        assert!(scan(0)[180].is_infinite(), "nothing behind the robot");
        let errors: Vec<f32> = (0..2000).map(|number| scan(number)[0] - 1.0).collect();
        let mean = errors.iter().sum::<f32>() / 2000.0;
        let spread = (errors.iter().map(|error| error * error).sum::<f32>() / 2000.0).sqrt();
        assert!(mean.abs() < 0.005 && (spread - 0.05).abs() < 0.004, "{mean} {spread}");
    }
}

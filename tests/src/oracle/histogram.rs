//! The pairwise geometric histogram of a reference line over a scene (paper, section 3.2), bin by bin in `f64`.
//!
//! Readings where the paper is silent:
//! 1. The reference segment itself does not enter its own histogram.
//! 2. A segment's mass is its length, spread evenly over the span of the perpendicular distances of its end points,
//!    widened about its middle to at least 1 px. What lies beyond the greatest distance is cut.
//! 3. With unsigned distances a segment that crosses the reference line fills both sides from 0 with the same density,
//!    that is, the span is folded at 0.
//! 4. Angle bins have their centres at `k * period / angle_bins`; the mass goes to the two nearest centres linearly, or
//!    without interpolation all to the nearest.

use super::NaiveSegment;
use super::segment::wrapped;
use edgeloc::pgh::{DistanceKind, PghShape};
use std::f64::consts::PI;

/// Least width of the span of distances that a segment's mass is spread over \[px\].
const LEAST_SPAN_PX: f64 = 1.0;

/// One pairwise geometric histogram: masses by distance bin and angle bin.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram {
    /// Number of distance bins.
    pub distance_bins: usize,
    /// Number of angle bins.
    pub angle_bins: usize,
    /// Mass of bin `distance * angle_bins + angle`.
    pub masses: Vec<f64>,
}

impl Histogram {
    /// Mass of one bin.
    #[must_use]
    pub fn mass(&self, distance_bin: usize, angle_bin: usize) -> f64 {
        self.masses[distance_bin * self.angle_bins + angle_bin]
    }

    /// Sum of all masses.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.masses.iter().sum()
    }

    /// The same histogram with sum 1; an empty one stays empty.
    #[must_use]
    pub fn normalized(mut self) -> Self {
        let total = self.total();
        if total > 0.0 {
            for mass in &mut self.masses {
                *mass /= total;
            }
        }
        self
    }
}

/// The histogram about the segment at `reference_index`, in pixels of length, not normalised.
#[must_use]
pub fn histogram(shape: &PghShape, segments: &[NaiveSegment], reference_index: usize) -> Histogram {
    let (distance_bins, angle_bins) = (usize::from(shape.distance_bins), usize::from(shape.angle_bins));
    let mut histogram = Histogram { distance_bins, angle_bins, masses: vec![0.0; distance_bins * angle_bins] };
    let reference = &segments[reference_index];
    for (index, segment) in segments.iter().enumerate() {
        if index == reference_index {
            continue;
        }
        let distance_masses = distance_masses(shape, span(shape, reference, segment), segment.length_px());
        for (angle_bin, share) in angle_shares(shape, reference, segment) {
            for (distance_bin, mass) in distance_masses.iter().enumerate() {
                histogram.masses[distance_bin * angle_bins + angle_bin] += mass * share;
            }
        }
    }
    histogram
}

/// The normalised histogram about each segment in turn.
#[must_use]
pub fn scene_histograms(shape: &PghShape, segments: &[NaiveSegment]) -> Vec<Histogram> {
    (0..segments.len()).map(|index| histogram(shape, segments, index).normalized()).collect()
}

/// Least and greatest signed perpendicular distance of `segment` from the line through `reference` \[px\].
fn span(shape: &PghShape, reference: &NaiveSegment, segment: &NaiveSegment) -> (f64, f64) {
    let direction = reference.direction(shape.uses_polarity);
    let (normal, foot) = ([-direction.sin(), direction.cos()], reference.midpoint());
    let distance = |point: [f64; 2]| normal[0] * (point[0] - foot[0]) + normal[1] * (point[1] - foot[1]);
    let (first, second) = (distance(segment.start), distance(segment.end));
    let (least, greatest) = (first.min(second), first.max(second));
    let lacking = (LEAST_SPAN_PX - (greatest - least)).max(0.0);
    (least - 0.5 * lacking, greatest + 0.5 * lacking)
}

/// The mass that each distance bin receives from `mass` spread evenly over the span.
fn distance_masses(shape: &PghShape, (least, greatest): (f64, f64), mass: f64) -> Vec<f64> {
    let (bins, max_distance) = (f64::from(shape.distance_bins), f64::from(shape.max_distance_px));
    let density = mass / (greatest - least);
    let overlap = |from: f64, to: f64| (greatest.min(to) - least.max(from)).max(0.0);
    (0..shape.distance_bins)
        .map(|bin| {
            let bin = f64::from(bin);
            match shape.distance {
                DistanceKind::Signed => {
                    let edge = |bin: f64| max_distance * (2.0 * bin / bins - 1.0);
                    density * overlap(edge(bin), edge(bin + 1.0))
                }
                DistanceKind::Unsigned => {
                    let edge = |bin: f64| max_distance * bin / bins;
                    density * (overlap(edge(bin), edge(bin + 1.0)) + overlap(-edge(bin + 1.0), -edge(bin)))
                }
            }
        })
        .collect()
}

/// The angle bins that receive the segment, with the share of its mass for each; shares sum to 1.
fn angle_shares(shape: &PghShape, reference: &NaiveSegment, segment: &NaiveSegment) -> [(usize, f64); 2] {
    let period = if shape.uses_polarity { 2.0 * PI } else { PI };
    let bins = usize::from(shape.angle_bins);
    let relative_angle =
        wrapped(segment.direction(shape.uses_polarity) - reference.direction(shape.uses_polarity), period);
    let position = relative_angle / period * f64::from(shape.angle_bins);
    let below = position.floor();
    let fraction = position - below;
    let share_above = match shape.interpolates_angle {
        true => fraction,
        false if fraction >= 0.5 => 1.0,
        false => 0.0,
    };
    let bin = below as usize;
    [(bin % bins, 1.0 - share_above), ((bin + 1) % bins, share_above)]
}

#[cfg(test)]
#[path = "histogram_tests.rs"]
mod tests;

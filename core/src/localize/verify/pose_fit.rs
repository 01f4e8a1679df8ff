//! The metric pose with its covariance: model segments laid onto the seen ones, by least squares.
//!
//! Each model segment that finds a seen one near it, alike in direction, is one measurement of the distance across it
//! (its points share the lateral shift of the edge). Five rounds of Gauss and Newton with weights after Cauchy. What the
//! heading of each look is off beside the first one's, for odometry drifts, is fitted along with the pose and eliminated
//! look by look (Schur's complement).
//!
//! Simpler than it is: drifts are taken for independent, though odometry's add up, and the way made is not corrected by
//! them; what a look's way may be off is stated in full.

use super::check::{Checker, Projected};
use super::hypothesis::Hypothesis;
use super::kept_looks::{KeptLooks, LookPose};
use super::seen_segment::SeenSegment;
use crate::database::TopologicalDatabase;
use crate::math;

/// Standard deviation of a segment across itself: 3 px of uniform lateral shift.
const SHIFT_PX: f32 = 1.8;
/// Error of the model across itself \[m\].
const MODEL_M: f32 = 0.02;
/// Partners lie at most this far off, round after round \[px\].
const GATES_PX: [f32; 5] = [24.0, 16.0, 12.0, 9.0, 9.0];
/// Sine of the greatest difference of partners in direction.
const MAX_SINE: f32 = 0.12;
/// A pose that moves farther than this was no fit \[m\].
const MAX_MOVE_M: f32 = 0.15;
/// What a pose that could not be fitted may be off in heading \[rad\]: 2 degrees.
const UNFITTED_RAD: f32 = 0.035;

/// A pose at the first look and its covariance: x, y \[m\] and heading \[rad\].
#[derive(Debug, Clone, Copy)]
pub(super) struct FittedPose {
    pub(super) offset_m: [f32; 2],
    pub(super) heading_error_rad: f32,
    covariance: [[f32; 3]; 3],
    /// How the last look's drift depends on the pose.
    last: Drift,
}

impl FittedPose {
    /// The hypothesis as it is.
    fn unfitted(hypothesis: &Hypothesis) -> Self {
        let mut covariance = [[0.0; 3]; 3];
        for (axis, spread) in [MAX_MOVE_M, MAX_MOVE_M, UNFITTED_RAD].into_iter().enumerate() {
            covariance[axis][axis] = spread * spread;
        }
        let Hypothesis { offset_m, heading_error_rad, .. } = *hypothesis;
        Self { offset_m, heading_error_rad, covariance, last: Drift::default() }
    }

    /// The covariance of the pose at the last look: that at the first, carried along the way, and what odometry adds.
    pub(super) fn covariance_at(&self, last: &LookPose) -> [[f32; 3]; 3] {
        let [x, y] = last.way_m_if(self.heading_error_rad);
        let Drift { variance, slope, .. } = self.last;
        let by_pose = slope.map(|slope| -variance * slope);
        let carried = [[1.0, 0.0, -y], [0.0, 1.0, x], [by_pose[0], by_pose[1], 1.0 + by_pose[2]]];
        let half = carried.map(|row| [0, 1, 2].map(|column: usize| dot(row, self.covariance[column])));
        let mut covariance = half.map(|row| [0, 1, 2].map(|column: usize| dot(row, carried[column])));
        let added = [last.way_spread_m * last.way_spread_m, last.way_spread_m * last.way_spread_m, variance];
        for (axis, added) in added.into_iter().enumerate() {
            covariance[axis][axis] += added;
        }
        covariance
    }
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Fits the pose of `hypothesis` to all looks, and what each of their headings drifted beside the first.
pub(super) fn fit(
    hypothesis: &Hypothesis,
    database: &TopologicalDatabase<'_>,
    checker: &mut Checker<'_>,
    looks: &mut KeptLooks<'_>,
) -> FittedPose {
    let unfitted = FittedPose::unfitted(hypothesis);
    let mut pose = unfitted;
    for gate_px in GATES_PX {
        let mut normal = Normal::prior(looks.compass_spread_rad(), pose.heading_error_rad);
        for look in 0..looks.count() {
            let (Some(node), at) = (database.node(hypothesis.node()), looks.pose(look)) else { continue };
            let way_m = at.way_m_if(pose.heading_error_rad);
            let offset_m = [pose.offset_m[0] + way_m[0], pose.offset_m[1] + way_m[1]];
            checker.turn(&node, at.heading_rad + at.drift_rad + pose.heading_error_rad, (offset_m, 0.05));
            let mut drift = Drift::prior(&at);
            normal.add_look(checker, (offset_m, way_m), looks.segments(look), gate_px, &mut drift);
            let drifted_rad = normal.eliminate(&mut drift);
            looks.drift(look, drifted_rad);
            pose.last = drift;
        }
        let Some((step, covariance)) = normal.solve() else {
            looks.forget_drift();
            return unfitted;
        };
        // The drift was best for the pose before the step; the next round sees to the other looks.
        looks.drift(looks.count().saturating_sub(1), -pose.last.variance * dot(pose.last.slope, step));
        pose.offset_m = [pose.offset_m[0] + step[0], pose.offset_m[1] + step[1]];
        pose.heading_error_rad += step[2];
        pose.covariance = covariance;
    }
    let moved = math::length(pose.offset_m[0] - hypothesis.offset_m[0], pose.offset_m[1] - hypothesis.offset_m[1]);
    if moved > MAX_MOVE_M {
        looks.forget_drift();
        return unfitted;
    }
    pose
}

/// What one look says of its drift: the part of the normal equations that no other look shares.
#[derive(Debug, Clone, Copy, Default)]
struct Drift {
    square: f32,
    /// Products with the step of the pose.
    slope: [f32; 3],
    right: f32,
    /// Of the drift, were the pose known: once it is eliminated \[rad^2\].
    variance: f32,
}

impl Drift {
    /// As odometry has it.
    fn prior(at: &LookPose) -> Self {
        let weight = weight_of(at.heading_spread_rad);
        Self { square: weight, right: -at.drift_rad * weight, ..Self::default() }
    }

    fn add(&mut self, measurement: &Measurement, by_heading: f32) {
        let Measurement { slope, distance_px, weight } = measurement;
        self.square += weight * by_heading * by_heading;
        for (sum, slope) in self.slope.iter_mut().zip(slope) {
            *sum += weight * by_heading * slope;
        }
        self.right -= weight * by_heading * distance_px;
    }
}

/// The weight of what is known with a standard deviation.
fn weight_of(spread_rad: f32) -> f32 {
    1.0 / math::max(spread_rad * spread_rad, 1e-10)
}

/// Normal equations of the step (x, y, heading).
#[derive(Debug)]
struct Normal {
    matrix: [[f32; 3]; 3],
    right: [f32; 3],
}

impl Normal {
    /// The position known to half a metre, the heading as the compass has it, if there is one.
    fn prior(compass_spread_rad: Option<f32>, heading_error_rad: f32) -> Self {
        let heading_weight = compass_spread_rad.map_or(0.0, weight_of);
        Self {
            matrix: [[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, heading_weight]],
            right: [0.0, 0.0, -heading_error_rad * heading_weight],
        }
    }

    /// Adds a look from `offset_m` from the node, after a way that turns with the heading at the first look.
    fn add_look(
        &mut self,
        checker: &Checker<'_>,
        (offset_m, way_m): ([f32; 2], [f32; 2]),
        seen: &[SeenSegment],
        gate_px: f32,
        drift: &mut Drift,
    ) {
        let offset = checker.in_camera(offset_m);
        for segment in checker.view() {
            let Some(projected) = checker.project(segment, offset) else { continue };
            if let Some(mut measurement) = measure(checker, &projected, seen, gate_px) {
                let [by_x, by_y, by_heading] = measurement.slope;
                measurement.slope[2] = by_heading + by_y * way_m[0] - by_x * way_m[1];
                self.add(&measurement);
                drift.add(&measurement, by_heading);
            }
        }
    }

    /// Leaves the drift of a look to its best for any pose; returns that for the pose as it is \[rad\].
    fn eliminate(&mut self, drift: &mut Drift) -> f32 {
        drift.variance = 1.0 / drift.square;
        for row in 0..3 {
            for column in 0..3 {
                self.matrix[row][column] -= drift.variance * drift.slope[row] * drift.slope[column];
            }
            self.right[row] -= drift.variance * drift.slope[row] * drift.right;
        }
        drift.variance * drift.right
    }

    fn add(&mut self, measurement: &Measurement) {
        let Measurement { slope, distance_px, weight } = measurement;
        for row in 0..3 {
            for column in 0..3 {
                self.matrix[row][column] += weight * slope[row] * slope[column];
            }
            self.right[row] -= weight * slope[row] * distance_px;
        }
    }

    /// The step and the inverse of the matrix.
    fn solve(&self) -> Option<([f32; 3], [[f32; 3]; 3])> {
        let m = &self.matrix;
        let minor = |r: usize, c: usize| {
            let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
            m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
        };
        let determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
        if !(determinant > 0.0 && determinant.is_finite()) {
            return None;
        }
        let inverse = [0, 1, 2].map(|row: usize| [0, 1, 2].map(|column: usize| minor(column, row) / determinant));
        let step = inverse.map(|row| row[0] * self.right[0] + row[1] * self.right[1] + row[2] * self.right[2]);
        Some((step, inverse))
    }
}

/// How far a model segment lies from its partner, and how that changes with the pose.
#[derive(Debug)]
struct Measurement {
    slope: [f32; 3],
    distance_px: f32,
    weight: f32,
}

/// Compares a projected segment with the nearest seen one that is alike, at three points along it.
fn measure(checker: &Checker<'_>, model: &Projected, seen: &[SeenSegment], gate_px: f32) -> Option<Measurement> {
    let (dx, dy) = (model.end_px[0] - model.start_px[0], model.end_px[1] - model.start_px[1]);
    let length = math::length(dx, dy);
    let filter = checker.filter();
    if length < filter.min_length_px || dy.abs() < filter.horizontal_slope * dx.abs() {
        return None;
    }
    let direction = [dx / length, dy / length];
    let frame = checker.frame();
    let (sin, cos) = checker.heading_sin_cos();
    let (mut slope, mut distance, mut inverse_sum, mut count) = ([0.0_f32; 3], 0.0_f32, 0.0_f32, 0.0_f32);
    let shares = [0.17_f32, 0.5, 0.83];
    let points = shares.map(|t| [model.start_px[0] + dx * t, model.start_px[1] + dy * t]);
    for ((t, point), partner) in shares.into_iter().zip(points).zip(nearest(points, direction, seen, gate_px)) {
        let Some((away, normal)) = partner else { continue };
        let inverse = model.inverse_depth[0] + (model.inverse_depth[1] - model.inverse_depth[0]) * t;
        let focal = frame.focal_px;
        let (u, v) = ((point[0] - frame.center_px[0]) / focal, (point[1] - frame.center_px[1]) / focal);
        let right = -normal[0] * focal * inverse;
        let forward = (normal[0] * u + normal[1] * v) * focal * inverse;
        let turn = focal * (normal[0] * (1.0 + u * u) + normal[1] * u * v);
        slope[0] += right * sin + forward * cos;
        slope[1] += forward * sin - right * cos;
        slope[2] += turn;
        distance += away;
        inverse_sum += inverse;
        count += 1.0;
    }
    if count < 1.0 {
        return None;
    }
    let mean_inverse = inverse_sum / count;
    let model_px = focal_error_px(frame.focal_px, mean_inverse);
    let variance = SHIFT_PX * SHIFT_PX + model_px * model_px;
    let distance_px = distance / count;
    // Short pieces of one edge share its shift: a full measurement takes 60 px.
    let share = math::min(length / 60.0, 1.0) * count / 3.0;
    let weight = share / (variance + 0.25 * distance_px * distance_px);
    Some(Measurement { slope: slope.map(|sum| sum / count), distance_px, weight })
}

fn focal_error_px(focal_px: f32, inverse_depth: f32) -> f32 {
    focal_px * MODEL_M * inverse_depth
}

/// Signed distance \[px\] of each of the `points` to the nearest seen segment alike in direction, with that segment's normal.
fn nearest<const POINTS: usize>(
    points: [[f32; 2]; POINTS],
    direction: [f32; 2],
    seen: &[SeenSegment],
    gate_px: f32,
) -> [Option<(f32, [f32; 2])>; POINTS] {
    let mut partners = [None::<(f32, [f32; 2])>; POINTS];
    for segment in seen {
        let (dx, dy) = segment.direction_q4();
        let (dx, dy) = (dx as f32 * 0.0625, dy as f32 * 0.0625);
        // Unnormalised first: most segments fail here, without a square root.
        let square = dx * dx + dy * dy;
        let sine = dx * direction[1] - dy * direction[0];
        if sine * sine > MAX_SINE * MAX_SINE * square {
            continue;
        }
        let start = segment.start_q4.map(|q4| f32::from(q4) * 0.0625);
        for (best, point) in partners.iter_mut().zip(points) {
            let (px, py) = (point[0] - start[0], point[1] - start[1]);
            let along = px * dx + py * dy;
            let across = dx * py - dy * px;
            if along < 0.0 || along > square || across * across > gate_px * gate_px * square {
                continue;
            }
            let length = math::sqrt(square);
            let away = across / length;
            if best.is_none_or(|(nearest, _)| away.abs() < nearest.abs()) {
                *best = Some((away, [-dy / length, dx / length]));
            }
        }
    }
    partners
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What makes all equations of `x` hold, by Gauss's elimination.
    fn solved<const N: usize>(mut matrix: [[f64; N]; N], mut right: [f64; N]) -> [f64; N] {
        for pivot in 0..N {
            for row in pivot + 1..N {
                let factor = matrix[row][pivot] / matrix[pivot][pivot];
                let above = matrix[pivot];
                matrix[row].iter_mut().zip(above).for_each(|(cell, above)| *cell -= factor * above);
                right[row] -= factor * right[pivot];
            }
        }
        for pivot in (0..N).rev() {
            for column in pivot + 1..N {
                right[pivot] -= matrix[pivot][column] * right[column];
            }
            right[pivot] /= matrix[pivot][pivot];
        }
        right
    }

    #[test]
    fn drifts_eliminated_look_by_look_are_those_of_all_equations_at_once() {
        const SPREADS: [f32; 2] = [0.01, 0.05];
        // A step of x, y and heading, then a drift for each of two looks.
        let (mut matrix, mut right) = ([[0.0_f64; 5]; 5], [0.0_f64; 5]);
        let mut normal = Normal::prior(Some(0.04), 0.01);
        (matrix[0][0], matrix[1][1], matrix[2][2]) = (4.0, 4.0, f64::from(weight_of(0.04)));
        right[2] = -0.01 * f64::from(weight_of(0.04));
        let mut last = Drift::default();
        let mut drift_rad = 0.0;
        for (look, spread_rad) in SPREADS.into_iter().enumerate() {
            let mut drift = Drift::prior(&LookPose { heading_spread_rad: spread_rad, ..LookPose::default() });
            matrix[3 + look][3 + look] = f64::from(weight_of(spread_rad));
            for index in 0..6_u8 {
                let (phase, by_heading) = (f32::from(index) + 2.0 * look as f32, 300.0 + 40.0 * f32::from(index));
                let (across, along) = math::sin_cos(phase);
                // The look's way turns with the heading at the first: its slope differs from that of its own drift.
                let slope = [90.0 * across, 60.0 * along, by_heading + 50.0 * along];
                let measurement = Measurement { slope, distance_px: 2.0 * across + 1.0, weight: 0.2 + 0.1 * along };
                normal.add(&measurement);
                drift.add(&measurement, by_heading);
                let mut whole = [slope[0], slope[1], slope[2], 0.0, 0.0].map(f64::from);
                whole[3 + look] = f64::from(by_heading);
                let (weight, distance) = (f64::from(measurement.weight), f64::from(measurement.distance_px));
                for row in 0..5 {
                    for column in 0..5 {
                        matrix[row][column] += weight * whole[row] * whole[column];
                    }
                    right[row] -= weight * whole[row] * distance;
                }
            }
            drift_rad = normal.eliminate(&mut drift);
            last = drift;
        }
        let expected = solved(matrix, right);
        let (step, covariance) = normal.solve().expect("enough was measured");
        drift_rad -= last.variance * dot(last.slope, step);
        for (found, expected) in
            step.into_iter().chain([drift_rad]).zip([0, 1, 2, 4].map(|index: usize| expected[index]))
        {
            assert!((f64::from(found) - expected).abs() < 2e-3 * expected.abs() + 1e-6, "{found} for {expected}");
        }
        // The covariance of the heading at the last look, carried there, is that of the step and the drift together.
        let fitted = FittedPose { offset_m: [0.0; 2], heading_error_rad: 0.0, covariance, last };
        let at = fitted.covariance_at(&LookPose::default());
        let mut unit = [0.0; 5];
        (unit[2], unit[4]) = (1.0, 1.0);
        let column = solved(matrix, unit);
        let expected = column[2] + column[4];
        assert!((f64::from(at[2][2]) - expected).abs() < 0.01 * expected, "{} for {expected}", at[2][2]);
    }
}

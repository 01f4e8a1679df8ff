//! Over many robots, the errors of a calibration are as large and as correlated as its covariance says.

use edgeloc::geometry::{Point2, StereoRig};
use edgeloc::math::double;
use edgeloc::stereo::{Calibration, CornerPair, PARAMETER_COUNT, ParameterMatrix, ParameterVector, StereoParameters};
use edgeloc_sim::random::Stream;
use rayon::prelude::*;

const ROBOTS: u64 = 400;
const NOISE_PX: f64 = 0.15;
/// Standard deviations of the prior, as after a bench calibration. From one twice as wide, what the four updates carry
/// on is bent by what they don't know yet: the mean chi-squared of the best direction, 200,000 times sharper than that
/// prior, is then 1.5 instead of 1.2.
const PRIOR: [f64; PARAMETER_COUNT] =
    [3.0, 1e-3, 2.0, 2.0, 0.01, 3.0, 1e-3, 2.0, 2.0, 0.01, 5e-3, 5e-3, 5e-3, 5e-4, 5e-4, 5e-4];
/// A direction of the parameters is identified when the corners divide its variance by this.
const IDENTIFIED: f64 = 4.0;

fn prior_deviation() -> ParameterVector {
    ParameterVector::from_column_slice(&PRIOR)
}

/// The rig that is meant to be built: its cameras look inwards a little, as those on a robot's head do.
fn meant() -> StereoParameters {
    StereoParameters { rotation_rad: [0.01, -0.05, 0.02], ..StereoParameters::ideal(&StereoRig::reference()) }
}

/// The rig that was built: off by errors of the prior's size.
fn built(stream: &mut Stream) -> StereoParameters {
    let error = ParameterVector::from_fn(|index, _| PRIOR[index] * stream.circular_gaussian()[0]);
    StereoParameters::from_vector(&(meant().to_vector() + error))
}

/// A corner somewhere in the left image, 1 to 6 m away, as the two cameras see it.
fn corner(rig: &StereoParameters, stream: &mut Stream) -> CornerPair {
    let pixel = |at: [f64; 2], stream: &mut Stream| {
        let [x, y] = stream.circular_gaussian();
        Point2::new((at[0] + x * NOISE_PX) as f32, (at[1] + y * NOISE_PX) as f32)
    };
    let [x, y] = rig.left.direction([stream.uniform(0.0, 640.0), stream.uniform(0.0, 480.0)]);
    let depth_m = stream.uniform(1.0, 6.0);
    let [beside_x, beside_y, beside_z] = moved(rig, [x * depth_m, y * depth_m, depth_m]);
    let left = pixel(rig.left.pixel([x, y]), stream);
    let mut right = pixel(rig.right.pixel([beside_x / beside_z, beside_y / beside_z]), stream);
    if stream.chance(0.01) {
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

/// One robot's calibration from four views: squared errors along the independent directions, in their own variances,
/// and by how much the corners divided the prior's variance there.
fn squared_errors(robot: u64) -> Vec<(f64, f64)> {
    let mut stream = Stream::new(11, "robot", robot, 0);
    let truth = built(&mut stream);
    let mut calibration = Calibration::from_prior(&meant(), &prior_deviation()).expect("a prior");
    for _ in 0..4 {
        let view: Vec<CornerPair> = (0..40).map(|_| corner(&truth, &mut stream)).collect();
        calibration.update(&view, NOISE_PX).expect("a calibration");
    }
    let error = (calibration.estimate().to_vector() - truth.to_vector()).component_div(&prior_deviation());
    // In units of the prior the information is 1 where nothing was learned.
    let information =
        ParameterMatrix::from_fn(|row, column| calibration.information()[(row, column)] * PRIOR[row] * PRIOR[column]);
    let directions = information.symmetric_eigen();
    let along = |index: usize| {
        let gain = directions.eigenvalues[index];
        let miss = directions.eigenvectors.column(index).dot(&error);
        (miss * miss * gain, gain)
    };
    let mut found: Vec<(f64, f64)> = (0..PARAMETER_COUNT).map(along).collect();
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    found
}

#[test]
fn errors_lie_inside_their_covariance_in_every_identified_direction() {
    let robots: Vec<Vec<(f64, f64)>> = (0..ROBOTS).into_par_iter().map(squared_errors).collect();
    let mut identified = 0;
    for direction in 0..PARAMETER_COUNT {
        let mean = |value: fn(&(f64, f64)) -> f64| {
            robots.iter().map(|robot| value(&robot[direction])).sum::<f64>() / ROBOTS as f64
        };
        let (chi_squared, gain) = (mean(|found| found.0), mean(|found| found.1));
        println!("direction {direction}: mean chi-squared {chi_squared:.3}, variance divided by {gain:.1}");
        // The mean of 400 chi-squared numbers of one degree of freedom has a standard deviation of 0.07.
        if gain > IDENTIFIED {
            identified += 1;
            assert!((0.75..1.25).contains(&chi_squared), "direction {direction}: {chi_squared}");
        }
    }
    assert!(identified >= 6, "{identified} directions");
    // The length of T is what the prior said, for every robot.
    assert!(robots.iter().all(|robot| robot.last().is_some_and(|found| (found.1 - 1.0).abs() < 0.01)));
}

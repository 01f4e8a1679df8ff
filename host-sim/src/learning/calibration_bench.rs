//! The calibration that a robot makes of its own rig, simulated: from corners of generic views, by the paper's equation (2).
//!
//! A robot begins with what a bench told it once, by boards ([`PRIOR`]), then stands at a dozen places of its world and
//! matches corners. What that leaves uncertain is the covariance C_a behind psi_c = 1. The scenario's seed decides the
//! views' noise and the bench's errors, so C_a belongs to a world, a rig, the corner sources and a seed; it is worked out
//! once for them. The errors that a map's robot has are drawn from it.

use super::CalibratedRig;
use crate::camera::corner_pairs;
use crate::random::Stream;
use crate::uncertainty::{CornerDetectionLoss, CornerMatch, GeometricApproximation, Sources};
use crate::world::{FreeSpace, Occluders, ViewpointVisibility, WireframeWorld};
use edgeloc::geometry::{Angle, Heading, Point2, Point3, StereoRig};
use edgeloc::stereo::{
    Calibration, CalibrationError, CalibrationUpdate, CornerPair, CorrelatedErrors, PARAMETER_COUNT, ParameterVector,
    StereoParameters,
};
use rayon::prelude::*;
use std::sync::{Arc, Mutex, PoisonError};

/// Standard deviations of the parameters after a bench calibration with boards, in the order of
/// [`PARAMETERS`](edgeloc::stereo::PARAMETERS): focal lengths and optical centres as shares of the focal length,
/// translations as shares of the baseline, the rest in its own unit.
///
/// Of the size that resampling thirteen real pairs of boards gave, 640 x 480 px at 84 mm: focal length 2.9 px, centre 2
/// px, distortion 0.008, rotations 3 mrad, translation 0.2, 0.1 and 1.5 mm.
pub const PRIOR: [f64; PARAMETER_COUNT] =
    [0.006, 0.001, 0.004, 0.004, 0.01, 0.006, 0.001, 0.004, 0.004, 0.01, 0.003, 0.003, 0.003, 0.0025, 0.0025, 0.015];

/// How well the bench knows the disparity of a far point ahead, in pixels: from any distant edge.
///
/// Without it the independent spreads of [`PRIOR`] would allow two optical centres to be off apart by several pixels,
/// which no bench overlooks and no corner tells.
pub const FAR_DISPARITY_PX: f64 = 0.3;

/// Views that the robot takes of its world.
const VIEW_COUNT: usize = 12;

/// Turn from one view to the next, in turns: the golden ratio, which spreads any number of views evenly.
const TURN: f64 = 0.618_033_988_749_895;

/// The corners that a rig sees in a world, and the calibrations made from them.
#[derive(Debug)]
pub struct CalibrationBench {
    rig: StereoRig,
    views: Vec<Vec<CornerPair>>,
    known: Mutex<Vec<(Conditions, Arc<CorrelatedErrors>)>>,
}

/// What a calibration depends on besides the world and the rig.
#[derive(Debug, Clone, PartialEq)]
struct Conditions {
    seed: u64,
    noise: GeometricApproximation,
    loss: CornerDetectionLoss,
    mismatch: CornerMatch,
}

/// A simulated calibration, with what it began from.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedCalibration {
    /// The true parameters.
    pub truth: StereoParameters,
    /// After the bench, before any view.
    pub before: Calibration,
    /// After all views.
    pub after: Calibration,
    /// What each view did; a view that could not be used is left out.
    pub updates: Vec<CalibrationUpdate>,
}

impl CalibrationBench {
    /// Looks around, without error, from places drawn in free space; `occluders` are those of the world's surfaces.
    ///
    /// The places are not the nodes, so that a robot's calibration is the same for any nodes.
    #[must_use]
    pub fn observe(
        rig: &StereoRig,
        world: &WireframeWorld,
        occluders: &Occluders,
        free_space: &FreeSpace,
        seed: u64,
    ) -> Self {
        let mut stream = Stream::new(seed, "calviews", 0, 0);
        let places: Vec<Point2> = (0..VIEW_COUNT).map(|_| free_space.sample(&mut stream)).collect();
        Self::observe_from(rig, world, occluders, &places)
    }

    fn observe_from(rig: &StereoRig, world: &WireframeWorld, occluders: &Occluders, places: &[Point2]) -> Self {
        let observe_view = |(view, place): (usize, &Point2)| {
            let eye = Point3::new(place.x, place.y, rig.camera_height_m);
            let turn = Angle::from_degrees((360.0 * TURN * view as f64) as f32);
            let heading = Heading::new(turn).expect("a few turns are finite");
            corner_pairs(rig, &mut ViewpointVisibility::new(world, occluders, eye), heading)
        };
        let views = places.par_iter().enumerate().map(observe_view).collect();
        Self { rig: *rig, views, known: Mutex::default() }
    }

    /// The rig as the robot of the `map_index`-th map knows it.
    ///
    /// # Panics
    /// When the errors leave no rig, which takes a hundred times the bench's standard deviations.
    #[must_use]
    pub fn calibrated_rig(&self, sources: &Sources, seed: u64, map_index: u64) -> CalibratedRig {
        let source = &sources.camera_calibration;
        if !source.acts() {
            return CalibratedRig::exact(self.rig);
        }
        let error = source.draw_error(&self.errors(sources, seed), seed, map_index);
        let believed = StereoParameters::from_vector(&(StereoParameters::ideal(&self.rig).to_vector() + error));
        CalibratedRig::believed(self.rig, &believed).expect("errors of some percent leave two cameras side by side")
    }

    /// Calibrates, as the robot does.
    ///
    /// # Panics
    /// When the prior is no prior, which its constants exclude.
    #[must_use]
    pub fn calibrate(&self, sources: &Sources, seed: u64) -> SimulatedCalibration {
        let truth = StereoParameters::ideal(&self.rig);
        let before = self.after_the_bench(&truth, seed);
        let (mut after, mut updates) = (before.clone(), Vec::new());
        for (view_index, clean) in self.views.iter().enumerate() {
            let mut corners = clean.clone();
            sources.perturb_corners(&mut corners, seed, view_index as u64);
            // A view without a minimum teaches nothing and changes nothing.
            updates.extend(after.update(&corners, sources.corner_noise_px()).ok());
        }
        SimulatedCalibration { truth, before, after, updates }
    }

    fn errors(&self, sources: &Sources, seed: u64) -> Arc<CorrelatedErrors> {
        let conditions = Conditions {
            seed,
            noise: sources.geometric_approximation,
            loss: sources.corner_detection_loss,
            mismatch: sources.corner_match,
        };
        // What is known stays right even if another thread broke down beside it.
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, errors)) = known.iter().find(|(of, _)| *of == conditions) {
            return Arc::clone(errors);
        }
        let calibration = self.calibrate(sources, seed).after;
        let errors = Arc::new(CorrelatedErrors::of(&calibration).expect("a prior leaves nothing unknown"));
        known.push((conditions, Arc::clone(&errors)));
        errors
    }

    /// What the bench tells: the truth with errors of its own spread.
    fn after_the_bench(&self, truth: &StereoParameters, seed: u64) -> Calibration {
        let about = |mean: &StereoParameters| bench_prior(mean, 1.0).expect("a rig has a prior");
        let spread = CorrelatedErrors::of(&about(truth)).expect("a prior leaves nothing unknown");
        let mut stream = Stream::new(seed, "bench", 0, 0);
        let gaussians = core::array::from_fn(|_| stream.circular_gaussian()[0]);
        about(&StereoParameters::from_vector(&(truth.to_vector() + spread.error(&gaussians, 1.0))))
    }
}

/// What a bench that found `mean` leaves known of a rig: to [`PRIOR`] and [`FAR_DISPARITY_PX`], `times` as vague.
///
/// # Errors
/// When the values can't be those of two cameras, or `times` is not positive.
pub fn bench_prior(mean: &StereoParameters, times: f64) -> Result<Calibration, CalibrationError> {
    let (focal_length_px, baseline_m) = (mean.left.focal_length_px, mean.baseline_m());
    let deviation = ParameterVector::from_fn(|index, _| {
        let unit = match index {
            0 | 2 | 3 | 5 | 7 | 8 => focal_length_px,
            13..=15 => baseline_m,
            _ => 1.0,
        };
        PRIOR[index] * unit * times
    });
    let mut calibration = Calibration::from_prior(mean, &deviation)?;
    calibration.know_far_disparity(FAR_DISPARITY_PX * times)?;
    Ok(calibration)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::CameraCalibration;
    use crate::world::FreeSpaceOptions;
    use crate::world::office::{self, OfficeOptions};

    fn bench() -> CalibrationBench {
        let world = office::generate(&OfficeOptions::default());
        let occluders = Occluders::new(&world.surfaces);
        let free_space = FreeSpace::of(&world, &FreeSpaceOptions::default()).expect("an office has free space");
        CalibrationBench::observe(&StereoRig::reference(), &world, &occluders, &free_space, 1)
    }

    #[test]
    fn the_robots_own_views_sharpen_what_the_bench_told() {
        let found = bench().calibrate(&Sources::default(), 1);
        let (before, after) = (found.before.standard_errors(), found.after.standard_errors());
        let (before, after) = (before.expect("positive"), after.expect("positive"));
        // Rotations about x and z, and the vertical optical centres: what moves points across the rows.
        for index in [10, 12] {
            assert!(after[index] < 0.7 * before[index], "{index}: {} {}", before[index], after[index]);
        }
        assert!((after[13] / before[13] - 1.0).abs() < 0.01, "the baseline stays as the bench had it");
        let used: usize = found.updates.iter().map(|update| update.used_pairs).sum();
        assert!(used > 200, "{used} pairs");
    }

    #[test]
    fn a_robot_is_calibrated_once_a_map_and_exactly_when_the_source_is_off() {
        let (bench, sources) = (bench(), Sources::default());
        let first = bench.calibrated_rig(&sources, 1, 0);
        assert_eq!(first, bench.calibrated_rig(&sources, 1, 0));
        assert_ne!(first, bench.calibrated_rig(&sources, 1, 1));
        for magnitude in [0.0, 1.0] {
            let camera_calibration = CameraCalibration { enabled: magnitude < 0.5, magnitude };
            let off = Sources { camera_calibration, ..Sources::default() };
            assert_eq!(bench.calibrated_rig(&off, 1, 0), CalibratedRig::exact(StereoRig::reference()));
        }
    }

    #[test]
    fn without_a_corner_the_bench_is_all_there_is() {
        let world = WireframeWorld::default();
        let occluders = Occluders::new(&world.surfaces);
        for places in [&[][..], &[Point2::default()][..]] {
            let bench = CalibrationBench::observe_from(&StereoRig::reference(), &world, &occluders, places);
            let found = bench.calibrate(&Sources::default(), 1);
            assert_eq!(found.before, found.after);
        }
    }
}

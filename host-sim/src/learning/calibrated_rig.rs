//! The rig as its robot knows it, and the images as the robot therefore takes them.
//!
//! The true cameras are ideal and stand side by side; the robot believes otherwise and straightens what is straight. It
//! rectifies every look by the parameters it believes in, left image and right, before it matches, learns or
//! localises: so the left segments of a trial bear the same error as the views its map was learned from. What it
//! rectifies to is the nominal camera, which one is free to choose, and the baseline it believes in: that is the rig
//! its map states. The wrong parameters show where left and right are wrong apart, in depths, and in a frame that is
//! turned and bent a little.

use crate::camera::{StereoObservation, move_pieces};
use edgeloc::geometry::StereoRig;
use edgeloc::stereo::{CalibrationError, ParameterVector, Rectification, StereoParameters};

/// A rig and what its robot does to its images.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibratedRig {
    rig: StereoRig,
    rectification: Option<Rectification>,
    errors: ParameterVector,
}

impl CalibratedRig {
    /// A rig whose robot knows it exactly.
    #[must_use]
    pub fn exact(rig: StereoRig) -> Self {
        Self { rig, rectification: None, errors: ParameterVector::zeros() }
    }

    /// A rig whose robot believes these parameters.
    ///
    /// # Errors
    /// When they can't be those of two cameras side by side.
    pub fn believed(rig: StereoRig, parameters: &StereoParameters) -> Result<Self, CalibrationError> {
        let rectification = Rectification::new(parameters, &rig.camera)?;
        let errors = parameters.to_vector() - StereoParameters::ideal(&rig).to_vector();
        let rig = StereoRig { baseline_m: rectification.baseline_m() as f32, ..rig };
        Ok(Self { rig, rectification: Some(rectification), errors })
    }

    /// The rig that the robot triangulates with and states in its map.
    #[must_use]
    pub const fn rig(&self) -> &StereoRig {
        &self.rig
    }

    /// What each parameter that the robot believes is off the truth, in the order and units of
    /// [`PARAMETERS`](edgeloc::stereo::PARAMETERS).
    #[must_use]
    pub const fn errors(&self) -> &ParameterVector {
        &self.errors
    }

    /// Moves the segments of both images to where the robot believes that they lie; a segment by its ends, though a
    /// wrong distortion bends it.
    pub fn rectify(&self, observation: &mut StereoObservation) {
        let Some(rectification) = &self.rectification else { return };
        for feature in &mut observation.features {
            move_pieces(&mut feature.left, |piece| {
                (rectification.left(piece.start()), rectification.left(piece.end()))
            });
            move_pieces(&mut feature.right, |piece| {
                (rectification.right(piece.start()), rectification.right(piece.end()))
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{CameraPose, observe_pieces, triangulate_feature};
    use edgeloc::geometry::{Heading, Point3, Polarity, Segment3};

    const RIG: StereoRig = StereoRig::reference();

    /// A post two metres ahead, as the true rig sees it.
    fn post() -> StereoObservation {
        let (start, end) = (Point3::new(2.0, 0.2, 0.6), Point3::new(2.0, 0.2, 1.4));
        let pose = CameraPose::new(Point3::new(0.0, 0.0, 1.0), Heading::default());
        observe_pieces(&RIG, &pose, [Segment3 { start, end, polarity: Polarity::LeftBrighter }])
    }

    fn depth_m(robot: &CalibratedRig) -> f32 {
        let mut seen = post();
        robot.rectify(&mut seen);
        let model: Vec<Segment3> = triangulate_feature(robot.rig(), &seen.features[0]).collect();
        model[0].start.z
    }

    #[test]
    fn an_exact_robot_sees_what_is_there_to_the_bit() {
        let mut seen = post();
        CalibratedRig::exact(RIG).rectify(&mut seen);
        assert_eq!(seen, post());
    }

    #[test]
    fn a_robot_that_believes_the_truth_sees_it_as_well() {
        let robot = CalibratedRig::believed(RIG, &StereoParameters::ideal(&RIG)).expect("side by side");
        assert!((depth_m(&robot) - 2.0).abs() < 1e-3);
    }

    #[test]
    fn a_wrong_baseline_scales_depths_and_a_wrong_optical_centre_shifts_disparities() {
        let mut parameters = StereoParameters::ideal(&RIG);
        parameters.translation_m[0] *= 1.1;
        let robot = CalibratedRig::believed(RIG, &parameters).expect("side by side");
        let greatest = robot.errors().iter().fold(0.0, |greatest: f64, error| greatest.max(error.abs()));
        assert!((greatest - 0.012).abs() < 1e-6, "a tenth of 12 cm is all that is off");
        assert!((depth_m(&robot) - 2.2).abs() < 1e-3 && (robot.rig().baseline_m - 0.132).abs() < 1e-6);

        let mut parameters = StereoParameters::ideal(&RIG);
        parameters.right.principal_point_px[0] += 3.0;
        let robot = CalibratedRig::believed(RIG, &parameters).expect("side by side");
        let disparity_px = RIG.camera.focal_length_px() * RIG.baseline_m / 2.0;
        assert!((depth_m(&robot) - 2.0 * disparity_px / (disparity_px + 3.0)).abs() < 1e-3);
    }
}

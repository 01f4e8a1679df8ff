//! Two real cameras: what is known of them, how matched corners refine it, and how their images become rectified ones.
//!
//! The paper's calibration (section 4.2, equation 2, after Thacker and Mayhew 1991). A robot needs no board for it: any
//! views with corners seen by both cameras will do. [`StereoParameters`] is the paper's S = F(f, a_x, a_y, o_x, o_y, k,
//! R, T), [`Calibration`] holds an estimate of it with its inverse covariance, which every batch of [`CornerPair`]s adds
//! to, [`CorrelatedErrors`] gives errors that are correlated as the covariance says, and [`Rectification`] is what the
//! robot does with the result: from then on its images are those of a [`StereoRig`](crate::geometry::StereoRig).
//!
//! # What corner pairs can't tell
//!
//! A pair tells only whether its two lines of sight meet, one number a pair. That says nothing of how long the baseline
//! is: make the world and the baseline twice as large and every image stays. So the length of T keeps for ever the
//! spread that the prior gives it. Cameras that look in parallel, as robots carry them, also leave the horizontal
//! distance between the two optical centres to the prior: shifting one image along its rows moves no point off its
//! epipolar line. The focal length common to both cameras is hardly seen either. What is seen well is what moves a point
//! across the rows: rotation about all three axes, the vertical optical centres against each other, the ratio of the
//! focal lengths, distortion, and the direction of T.
//!
//! # What the covariance does not know of
//!
//! The lens has the paper's one distortion coefficient. Where a real lens has more, a second radial term or a decentring,
//! what they do to the corners is the same at the same pixel, does not average out, and is taken for what is hardly seen
//! otherwise. On the real pairs of a chessboard, lenses with k2 = 0.1 and a decentring of 1e-3 made 376 +- 28 px of a focal
//! length of 536.5 px known as 520 +- 50 px before, and a T that points ahead, though corners fit their epipolar lines to
//! 0.11 px: a good fit is no sign that the model holds. Straightened of both terms the same corners gave 515 +- 31 px,
//! fitted to 0.10 px, and every parameter that could be compared was within 1.5 standard errors. So a robot with such
//! lenses straightens its corners first, by what a bench told it of them, or its prior pins the focal length, which leaves
//! T's z and the distortion some 3 standard errors off there.
//!
//! Everything here is double precision: the normal equations have condition numbers beyond single precision. A
//! calibration takes some 15 kB of stack.

mod calibration;
mod camera_model;
mod correlated_errors;
mod epipolar;
mod parameters;
mod rectification;

pub use calibration::{Calibration, CalibrationError, CalibrationUpdate};
pub use camera_model::CameraParameters;
pub use correlated_errors::CorrelatedErrors;
pub use epipolar::{CornerPair, epipolar_distance_px};
pub use parameters::{PARAMETER_COUNT, PARAMETERS, ParameterFacts, ParameterMatrix, ParameterVector, StereoParameters};
pub use rectification::Rectification;

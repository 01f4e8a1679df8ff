//! Global localisation of a robot from the straight edges it sees.
//!
//! The library that ships to the robot: no heap, no `std`, no IO, no clock, no random numbers of its own.
//! The simulator, the tests, the firmware and the robot all go through the same one verb,
//! [`localize::Localizer::observe`].
//!
//! # The way through the house
//!
//! ```text
//! Scene [Segment2] ---------------------> pgh::build (one histogram per reference line)
//!                                                          |
//! compass Heading -> database: nodes still in play,        |
//! their 3-D segments re-projected at that heading -> pgh   v
//!                                                 matching::bhattacharyya -> ViewScore
//!                                                          |
//!                                 localize::CandidateSet (accumulate per node, B_max - B_th / i)
//!                                 or, instead of both, poses about every node checked against all looks
//!                                                          v
//!                        Decision::{Localized, LookAgain { turn, step_m }, Unknown { reason }}
//! ```
//!
//! | module | what it holds |
//! |---|---|
//! | [`math`] | the few float functions we use, from one backend on every machine |
//! | [`geometry`] | angles, headings, segments, scenes, the pinhole camera |
//! | [`stereo`] | two real cameras: calibration from matched corners, with its covariance, and rectification |
//! | [`pgh`] | pairwise geometric histograms: shape and fixed-point construction |
//! | [`matching`] | Bhattacharyya coefficients of histograms, score of a scene against a view |
//! | [`gist`] | the gist of a view in 64 bytes: a first stage for maps of many places |
//! | [`database`] | the topological database as a written byte format, read in place |
//! | [`explore`] | exploring a building by wall following, from an unknown start |
//! | [`localize`] | candidate filtering and the localiser itself |
//!
//! # Same bits everywhere
//!
//! Histograms, coefficients, scores and margins are integers; float arithmetic is left to projection and to the
//! rounding of segments, where it is plain IEEE single precision in source order with `libm` for the functions. A trial
//! therefore gives the identical decision and scores on every machine; the gate proves it for x86-64, 64-bit Arm,
//! Cortex-M4, M7 and M33 (emulated) and WebAssembly.
#![no_std]

#[cfg(test)]
extern crate std;

pub mod database;
pub mod explore;
pub mod geometry;
pub mod gist;
pub mod localize;
pub mod matching;
pub mod math;
pub mod pgh;
pub mod stereo;

/// The example of the README, so that it is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct ReadmeExample;

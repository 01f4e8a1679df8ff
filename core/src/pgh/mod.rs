//! Pairwise geometric histograms (PGH): the descriptor of a scene.
//!
//! A histogram about a *reference line* holds where all other segments of the scene lie relative to it: their
//! perpendicular distances and relative angles, weighted by length (paper, section 3.2; Evans, Thacker and Mayhew
//! 1993). A scene has one histogram for each of its segments. What is kept is the histogram's **root form**: each bin
//! of the histogram, normalised to sum 1, as its square root in Q15. The Bhattacharyya coefficient of two histograms is
//! then a dot product.
//!
//! All machines agree on every bit: sums are of integers, in any order, and what is rounded before is integer arithmetic
//! or single-precision additions, multiplications and divisions, which IEEE 754 rounds alike everywhere.
//!
//! 1. Image coordinates are rounded to 1/16 px (Q4), normals to Q30, directions to [`BinaryAngle`]s.
//! 2. A segment's mass is spread evenly over the span of its perpendicular distances: its first and its last bin by
//!    themselves, those between one by one, or where there are vectors through a difference array that is summed once;
//!    being integers, what is added and taken away cancels exactly.
//! 3. Square roots come from two steps of Newton's iteration, within two thirds of a unit of the last place of Q15.
//!
//! [`BinaryAngle`]: crate::geometry::BinaryAngle

mod block;
mod builder;
mod frame;
mod line;
mod longest_lines;
mod masses;
mod one_by_one;
mod root;
mod shape;
#[cfg(test)]
pub(crate) mod strategies;

pub use block::LineBlock;
pub use builder::{BuilderError, HistogramBuilder};
pub use line::Line;
pub use longest_lines::LongestLines;
pub use shape::{DistanceKind, PghShape, ShapeError};

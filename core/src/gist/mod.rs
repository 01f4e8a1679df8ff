//! The gist of a view: where in the image edges of which direction lie, in a few bytes.
//!
//! A first stage for maps of many places. The image is pooled into an [edge layout](edge_layout): the length of edges by
//! cell of a coarse grid and by direction, brighter side included, as square roots. A [`Projection`], worked out with the
//! map from what changes a layout when a robot stands beside a node and what tells nodes apart, makes a [`Code`] of it:
//! directions in which displaced views of one place hardly differ come first (linear discriminant analysis; Fisher 1936).
//! The similarity of two views is the dot product of their codes, and [`add_similarities`] goes through all of a map.
//!
//! Sums are integers, so all machines agree on every bit; sampling points of a segment are plain IEEE single precision in
//! source order.

mod code;
mod layout;
mod scan;

pub use code::{AXES, Code, Projection};
pub use layout::{EdgeLayout, FEATURES, edge_layout};
pub use scan::{ONE, add_similarities};

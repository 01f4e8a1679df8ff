//! Points, angles, segments, scenes and the pinhole camera.
//!
//! Frames, stated once: **image** = pixels, x right, y down, origin at the top left; **camera** = metres, x right,
//! y down, z forward; **world** = metres, z up. A [`Heading`] is the yaw of the optical axis in the world frame,
//! counter-clockwise from +x.

mod angle;
mod camera;
mod grid_walk;
mod heading;
mod point;
mod scene;
mod segment2;
mod segment3;
mod stereo_rig;

pub use angle::{Angle, BinaryAngle};
pub(crate) use camera::inside_part;
pub use camera::{CameraError, PinholeCamera};
pub use grid_walk::GridWalk;
pub use heading::Heading;
pub use point::{Point2, Point3};
pub use scene::{CapacityError, Scene, SceneBuffer};
pub use segment2::{Polarity, Segment2, SegmentError};
pub use segment3::Segment3;
pub use stereo_rig::{RigError, StereoRig};

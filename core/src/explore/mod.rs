//! Exploring a building from an unknown start: wall following with object avoidance (paper, section 3.1), and what it
//! takes to leave nothing out.
//!
//! The paper names wall following as its example of a simple path planning strategy. Followed to the letter it misses
//! islands, the middle of halls and every room whose door it does not come along, and never knows that it is done. So
//! the robot keeps a coarse grid of what it has seen, in memory of the caller:
//!
//! 1. it **follows the wall** on its right hand as long as that covers new floor ([`Explorer`]);
//! 2. when it does not, because the loop has closed, the robot **goes to the nearest place** that it has not been near
//!    or beside which it has not seen, over floor that it knows ([`Cell`]);
//! 3. when there is no such place the building is explored: the robot says so, and whether it was one closed room
//!    ([`Ending`]).
//!
//! Every motion is checked against the scan it is decided on: nothing seen comes nearer than the robot's radius and a
//! margin. What the robot needs from outside is a range sensor that sees whatever its body could touch, and odometry
//! that does not drift over the building; correcting it is not this module's subject.

mod closed_room;
mod config;
mod explorer;
mod grid;
mod near_field;
mod scan;
mod search;
#[cfg(test)]
mod tests;

pub use config::{ExploreConfig, ExploreConfigError};
pub use explorer::{Action, Ending, ExploreError, Explorer, Motion, Odometry};
pub use grid::Cell;
pub use scan::{MAX_RAYS, RangeScan, ScanError};

//! What the localiser answers after each look.

use super::Rivals;
use crate::database::NodeId;
use crate::geometry::{Angle, Heading, Point2};

/// The answer to a look.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Decision {
    /// The robot is at this place.
    Localized(Localized),
    /// Not sure yet: turn, drive, look and observe again. A caller that can't, or not all the way, reports in the next
    /// look what it did instead.
    LookAgain {
        /// The turn asked for.
        turn: Angle,
        /// How far to drive straight ahead after the turn, where there is room \[m\]; 0 where a turn may do, and always
        /// for a robot that reports no motion.
        step_m: f32,
    },
    /// The localiser can't tell.
    Unknown {
        /// Why not.
        reason: UnknownReason,
    },
}

/// Where the robot is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Localized {
    /// The node that the robot is at.
    pub node: NodeId,
    /// The metric pose; absent in paper mode, which names a node only.
    pub pose: Option<PoseEstimate>,
    /// Probability that the answer is right; absent in paper mode.
    pub probability: Option<f32>,
}

/// A metric pose with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseEstimate {
    /// Position at the last look in the world frame \[m\].
    pub position: Point2,
    /// Heading at the last look.
    pub heading: Heading,
    /// Covariance of (x, y, heading) at the last look in m, m and rad.
    pub covariance: [[f32; 3]; 3],
}

/// Why the localiser can't tell where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum UnknownReason {
    /// No look of the attempt showed enough to compare with any node.
    SceneTooPoor,
    /// What was seen agrees with no place of the map.
    OutsideMap,
    /// Several places agree with what was seen, and no look could tell them apart.
    Indistinguishable(Rivals),
}

impl core::fmt::Display for UnknownReason {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::SceneTooPoor => f.write_str("no look showed enough edges to compare with any node"),
            Self::OutsideMap => f.write_str("what was seen agrees with no place of the map"),
            Self::Indistinguishable(rivals) => {
                f.write_str("several places agree with what was seen:")?;
                for (index, rival) in rivals.iter().enumerate() {
                    let comma = if index == 0 { "" } else { "," };
                    write!(f, "{comma} {} ({:.0} %)", rival.node, 100.0 * rival.probability)?;
                }
                Ok(())
            }
        }
    }
}

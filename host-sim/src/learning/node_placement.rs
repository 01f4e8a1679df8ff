//! Where the nodes of a map go: spread over the free space, to where they are in sight, or dropped along a path that the
//! robot explored.

use super::{ExplorationError, ExploringRobot, PlaceNodesError, Surroundings, explore, place_in_sight, place_nodes};
use crate::random::Stream;
use crate::world::{FreeSpace, RangeSensorOptions};
use edgeloc::geometry::Point2;
use serde::{Deserialize, Serialize};

/// Where the nodes go.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NodePlacement {
    /// Spread evenly over the free space ([`place_nodes`]).
    #[default]
    Spread,
    /// So that nearly every place has one near it in sight ([`place_in_sight`]).
    Coverage,
    /// Dropped evenly along the path of a robot that explores ([`explore()`]), as the paper has it.
    Explore,
}

impl NodePlacement {
    /// Places `count` nodes in the free space of a building; `seed` selects where each way begins.
    ///
    /// # Errors
    /// When there is no room for so many, or the world can't be explored.
    pub fn place(
        self,
        surroundings: &Surroundings<'_>,
        count: usize,
        seed: u64,
    ) -> Result<Vec<Point2>, NodePlacementError> {
        let Surroundings { world, space, .. } = *surroundings;
        match self {
            Self::Spread => Ok(place_nodes(space, count, seed)?),
            Self::Coverage => Ok(place_in_sight(surroundings, count, seed)?),
            Self::Explore => {
                let robot = ExploringRobot::new(world, space, &RangeSensorOptions::default());
                let exploration = explore(space, &robot, random_start(space, seed), seed, |_| {})?;
                Ok(exploration.drop_nodes(space, count)?)
            }
        }
    }
}

/// Where a robot that explores is put down when nobody says where.
#[must_use]
pub fn random_start(space: &FreeSpace, seed: u64) -> Point2 {
    space.sample(&mut Stream::new(seed, "explore", 1, 0))
}

/// Why there are no nodes.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NodePlacementError {
    /// There is no room for so many.
    #[error(transparent)]
    Count(#[from] PlaceNodesError),
    /// The world can't be explored.
    #[error(transparent)]
    Exploration(#[from] ExplorationError),
}

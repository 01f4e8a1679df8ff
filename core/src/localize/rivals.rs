//! Places that can't be told apart.

use crate::database::NodeId;
use crate::geometry::Point2;

/// A place the robot may be at.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rival {
    /// The node nearest to it.
    pub node: NodeId,
    /// Position in the world frame \[m\].
    pub position: Point2,
    /// Probability that the robot is there, if it is at one of the places named.
    pub probability: f32,
}

/// A few places the robot may be at, the likeliest first.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rivals {
    places: [Rival; Self::CAPACITY],
    count: usize,
}

impl Rivals {
    /// Most places that are named.
    pub const CAPACITY: usize = 8;

    /// The places, the likeliest first.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &Rival> {
        self.places.iter().take(self.count)
    }

    /// Adds a place; whether there was room.
    pub(super) fn push(&mut self, rival: Rival) -> bool {
        let Some(place) = self.places.get_mut(self.count) else { return false };
        *place = rival;
        self.count += 1;
        true
    }

    /// Scales the probabilities so that they sum to one.
    pub(super) fn normalize(&mut self) {
        let sum = self.iter().fold(0.0, |sum, rival| sum + rival.probability);
        for rival in self.places.iter_mut().take(self.count) {
            rival.probability /= sum;
        }
    }

    /// Leaves out what is less likely than `least`.
    pub(super) fn retain_likelier(&mut self, least: f32) {
        self.count = self.iter().take_while(|rival| rival.probability >= least).count();
    }
}

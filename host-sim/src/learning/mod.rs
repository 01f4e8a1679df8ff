//! World learning: from what a stereo rig sees at the nodes to the bytes of a topological database.

mod learn;
mod node_views;
mod place_nodes;

pub use learn::{LearnedNode, learn, learn_nodes};
pub use node_views::NodeViews;
pub use place_nodes::{PlaceNodesError, place_nodes};

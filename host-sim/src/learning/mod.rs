//! World learning: from what a stereo rig sees at the nodes to the bytes of a topological database.

mod budget;
mod calibrated_rig;
mod calibration_bench;
mod exploration;
mod explore;
mod join;
mod joined_map;
mod learn;
mod node_placement;
mod node_views;
mod place_nodes;
mod places;
mod self_agreement;
mod sight_coverage;
mod sight_placement;
mod view_index;
mod withheld;

pub use budget::keep_most_telling;
pub use calibrated_rig::CalibratedRig;
pub use calibration_bench::{CalibrationBench, FAR_DISPARITY_PX, PRIOR, SimulatedCalibration, bench_prior};
pub use exploration::{COVER_REACH_M, Exploration};
pub use explore::{ExplorationError, ExplorationProgress, ExploringRobot, explore};
pub use join::join_collinear;
pub use joined_map::{JoinError, MapPart, index_map, indexed, join_maps};
pub use learn::{LearnedNode, learn, learn_nodes, write_map};
pub use node_placement::{NodePlacement, NodePlacementError, random_start};
pub use node_views::NodeViews;
pub use place_nodes::{PlaceNodesError, place_nodes};
pub use places::Surroundings;
pub use self_agreement::self_agreement;
pub use sight_coverage::{POOR_M, PoorPlace, SightCoverage, Squares};
pub use sight_placement::{NEAR_M, place_in_sight};
pub use view_index::{LearnedProjection, fill_index, index_shape};
pub use withheld::{UNLEARNED_WAY_M, Withheld};

//! Geometric verification: what would be seen from a pose beside a node, checked against what is seen.
//!
//! Per look, seen segments become distance planes, one for each of eight orientations at quarter resolution
//! ([`distance_planes`]). Per hypothesis, the node's model is projected and looked up in them; how far off it may lie
//! depends on its depth and on how closely the hypothesis is posed ([`check`]). Evidence adds up over looks **at the
//! same pose** ([`evidence`]): for every cell of a grid about every node, and, from the segments of all looks, anew for
//! the best of them posed more closely ([`search`]). In maps of many nodes a first stage chooses about which of them there is
//! a grid ([`shortlist`]). The lead of the best place over its rivals ([`judgement`]) and its agreement with what was seen
//! decide ([`stop_rule`]). Until they do, the robot looks where its rivals are predicted to look different, and when it has
//! looked all around it moves a little ([`next_look`]). Least squares give the metric pose ([`pose_fit`]).
//!
//! Responses and looks add up as integers, the evidence of a pose over a look's segments in single precision, segment by
//! segment. All of that, and projection, is plain IEEE arithmetic in source order, without a function that machines round
//! differently.

mod cameras;
mod chamfer;
mod channel;
mod check;
mod clear_way;
mod config;
mod distance_planes;
mod dominant;
mod evidence;
mod frustum;
mod headings;
mod hypothesis;
mod image_frame;
mod judgement;
mod kept_looks;
mod lane_image;
mod lanes;
mod memory;
mod models;
mod moves;
mod next_look;
mod pose_check;
mod pose_fit;
mod responses;
mod search;
mod seen_segment;
mod shortlist;
mod slots;
mod spacing;
mod stop_rule;
mod verifying;
mod view;

pub use config::{NextLook, VerificationConfig};
pub use evidence::Evidence;
pub(super) use memory::memory_len;
pub use pose_check::PoseCheck;
use seen_segment::SeenSegment;
pub(super) use verifying::VerifyingLocalizer;

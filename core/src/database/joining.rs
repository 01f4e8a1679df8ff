//! Many maps made into one, in pieces that need no room for the whole.

use super::format::{HEADER_LEN, NODE_LEN, NodeEntry};
use super::writer::{header_of, position_mm};
use super::{Node, TopologicalDatabase, format};
use crate::geometry::Point2;
use zerocopy::IntoBytes;

/// The header of a map of so many nodes and segments, learned by the rig of `like` with as many views a node, before
/// [`seal`](super::seal) states its checksum; `None` if the map would pass 4 GiB. The agreement as in
/// [`state_self_agreement`](super::state_self_agreement).
#[must_use]
pub fn joined_header(
    like: &TopologicalDatabase<'_>,
    (node_count, segment_count): (usize, usize),
    self_agreement: Option<f32>,
) -> Option<[u8; HEADER_LEN]> {
    let length = format::total_len(node_count, segment_count, (0, 0))?;
    let mut header = header_of(like.rig(), like.views_per_node(), [length, node_count, segment_count]);
    header.self_agreement = self_agreement.unwrap_or(0.0).into();
    let mut bytes = [0; HEADER_LEN];
    bytes.copy_from_slice(header.as_bytes());
    Some(bytes)
}

/// The bytes of a node moved by `by`, whose segments begin at `first_segment`; `None` beyond 2000 km.
#[must_use]
pub fn moved_node(node: &Node<'_>, by: Point2, first_segment: u32) -> Option<[u8; NODE_LEN]> {
    let from = node.position();
    let entry = NodeEntry {
        position_mm: position_mm(Point2::new(from.x + by.x, from.y + by.y))?,
        first_segment: first_segment.into(),
        segment_count: (node.segments().len() as u32).into(),
    };
    let mut bytes = [0; NODE_LEN];
    bytes.copy_from_slice(entry.as_bytes());
    Some(bytes)
}

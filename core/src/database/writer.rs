//! Writing a topological database into bytes.

use super::format::{self, HEADER_LEN, Header, NODE_LEN, NodeEntry, SegmentEntry};
use super::{OpenError, TopologicalDatabase};
use crate::geometry::{Point2, Point3, Polarity, Segment3, StereoRig};
use crate::math;
use core::fmt;
use zerocopy::little_endian::{I16, I32};
use zerocopy::{FromBytes, IntoBytes};

/// What was learned at one node.
#[derive(Debug, Clone, Copy)]
pub struct NodeModel<'a> {
    /// Position in the world frame \[m\], within 2000 km.
    pub position: Point2,
    /// Its merged 3-D segments in the node frame \[m\] (see [`Node::segments`](super::Node::segments)), each coordinate
    /// within 32.767 m.
    pub segments: &'a [Segment3],
}

/// Bytes that [`write()`] needs for `nodes`; `None` if the database would pass 4 GiB.
#[must_use]
pub fn encoded_len(nodes: &[NodeModel<'_>]) -> Option<usize> {
    let segment_count = nodes.iter().try_fold(0_usize, |count, node| count.checked_add(node.segments.len()))?;
    format::total_len(nodes.len(), segment_count, (0, 0))
}

/// Writes the database of `nodes`, learned by `rig` with so many views a node, to the beginning of `out`.
///
/// Returns the number of bytes written. Coordinates are rounded to millimetres.
///
/// # Errors
/// When there is no node or no view, a number does not fit the format, or `out` is too short. What `out`
/// then holds is of no use.
pub fn write(
    rig: &StereoRig,
    views_per_node: u16,
    nodes: &[NodeModel<'_>],
    out: &mut [u8],
) -> Result<usize, WriteError> {
    if nodes.is_empty() || views_per_node == 0 {
        return Err(WriteError::Empty);
    }
    rig.checked().map_err(WriteError::Rig)?;
    let length = encoded_len(nodes).ok_or(WriteError::TooLarge)?;
    let capacity = out.len();
    let out = out.get_mut(..length).ok_or(WriteError::OutputTooShort { capacity, needed: length })?;
    let (header_bytes, tables) = out.split_at_mut(HEADER_LEN);
    let (node_bytes, segment_bytes) = tables.split_at_mut(nodes.len() * NODE_LEN);
    header_bytes.fill(0);

    let mut segment_slots = segment_bytes.chunks_exact_mut(format::SEGMENT_LEN);
    let mut first_segment = 0_u32;
    for (index, (node, node_slot)) in nodes.iter().zip(node_bytes.chunks_exact_mut(NODE_LEN)).enumerate() {
        let entry = node_entry(node, first_segment).ok_or(WriteError::PositionOutOfRange { node: index })?;
        node_slot.copy_from_slice(entry.as_bytes());
        for (segment, slot) in node.segments.iter().zip(&mut segment_slots) {
            let entry = segment_entry(segment).ok_or(WriteError::SegmentOutOfRange { node: index })?;
            slot.copy_from_slice(entry.as_bytes());
        }
        first_segment += node.segments.len() as u32;
    }

    let mut header = header_of(rig, views_per_node, [length, nodes.len(), first_segment as usize]);
    header_bytes.copy_from_slice(header.as_bytes());
    header.crc = format::checksum(out).into();
    out[..HEADER_LEN].copy_from_slice(header.as_bytes());
    Ok(length)
}

/// States in a database how well it explains what was seen while it was learned; see [`format`](mod@super::format).
///
/// # Errors
/// When `bytes` are no database, or the agreement is not above 0 and at most 1.
pub fn state_self_agreement(bytes: &mut [u8], agreement: f32) -> Result<(), StateError> {
    if !(agreement > 0.0 && agreement <= 1.0) {
        return Err(StateError::Agreement);
    }
    let length = TopologicalDatabase::open(bytes).map_err(StateError::Open)?.byte_len();
    let database = &mut bytes[..length];
    change_header(database, |header| header.self_agreement = agreement.into());
    state_checksum(database);
    Ok(())
}

/// States the checksum of a whole database.
pub(super) fn state_checksum(database: &mut [u8]) {
    let checksum = format::checksum(database);
    change_header(database, |header| header.crc = checksum.into());
}

pub(super) fn change_header(database: &mut [u8], change: impl FnOnce(&mut Header)) {
    if let Ok((header, _)) = Header::mut_from_prefix(database) {
        change(header);
    }
}

/// Why an agreement can't be stated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StateError {
    /// It is not above 0 and at most 1.
    Agreement,
    /// The bytes are no database.
    Open(OpenError),
}

impl fmt::Display for StateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Agreement => f.write_str("agreement is not above 0 and at most 1"),
            Self::Open(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for StateError {}

pub(super) fn header_of(rig: &StereoRig, views_per_node: u16, lengths: [usize; 3]) -> Header {
    let [length, node_count, segment_count] = lengths.map(|value| (value as u32).into());
    Header {
        magic: format::MAGIC,
        version: format::VERSION.into(),
        views_per_node: views_per_node.into(),
        crc: 0.into(),
        length,
        node_count,
        segment_count,
        image_size_px: [rig.camera.width_px().into(), rig.camera.height_px().into()],
        focal_length_px: rig.camera.focal_length_px().into(),
        principal_point_px: [rig.camera.principal_point_px().x.into(), rig.camera.principal_point_px().y.into()],
        baseline_m: rig.baseline_m.into(),
        camera_height_m: rig.camera_height_m.into(),
        near_limit_m: rig.near_limit_m.into(),
        model_depths_m: [rig.nearest_model_m.into(), rig.farthest_model_m.into()],
        self_agreement: 0.0.into(),
        sectors: 0.into(),
        poses: 0.into(),
    }
}

fn node_entry(node: &NodeModel<'_>, first_segment: u32) -> Option<NodeEntry> {
    Some(NodeEntry {
        position_mm: position_mm(node.position)?,
        first_segment: first_segment.into(),
        segment_count: (node.segments.len() as u32).into(),
    })
}

pub(super) fn position_mm(position: Point2) -> Option<[I32; 2]> {
    let mm = |metres: f32| -> Option<I32> {
        let millimetres = math::round(metres * 1000.0);
        (math::abs(millimetres) <= 2.0e9).then(|| (millimetres as i32).into())
    };
    Some([mm(position.x)?, mm(position.y)?])
}

fn segment_entry(segment: &Segment3) -> Option<SegmentEntry> {
    let (start, end) = match segment.polarity {
        Polarity::LeftBrighter => (segment.start, segment.end),
        Polarity::RightBrighter => (segment.end, segment.start),
    };
    Some(SegmentEntry { start_mm: point_mm(start)?, end_mm: point_mm(end)? })
}

fn point_mm(point: Point3) -> Option<[I16; 3]> {
    let mm = |metres: f32| -> Option<I16> {
        let millimetres = math::round(metres * 1000.0);
        (math::abs(millimetres) <= 32_767.0).then(|| (millimetres as i16).into())
    };
    Some([mm(point.x)?, mm(point.y)?, mm(point.z)?])
}

/// Why a database can't be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WriteError {
    /// There is no node, or no view at a node.
    Empty,
    /// The rig makes no sense.
    Rig(crate::geometry::RigError),
    /// The database would pass the 4 GiB that its format can hold.
    TooLarge,
    /// The bytes given are too few.
    OutputTooShort {
        /// Bytes there are.
        capacity: usize,
        /// Bytes needed.
        needed: usize,
    },
    /// A node's position is not finite or beyond 2000 km.
    PositionOutOfRange {
        /// Index of the node.
        node: usize,
    },
    /// A segment has a coordinate that is not finite or beyond 32.767 m of its node.
    SegmentOutOfRange {
        /// Index of the node.
        node: usize,
    },
}

impl fmt::Display for WriteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => f.write_str("a database needs at least one node and one view"),
            Self::Rig(error) => error.fmt(f),
            Self::TooLarge => f.write_str("database would pass 4 GiB"),
            Self::OutputTooShort { capacity, needed } => {
                write!(f, "database output: room for {capacity} bytes, {needed} needed")
            }
            Self::PositionOutOfRange { node } => write!(f, "position of node {node} is beyond 2000 km"),
            Self::SegmentOutOfRange { node } => write!(f, "a segment of node {node} is beyond 32.767 m"),
        }
    }
}

impl core::error::Error for WriteError {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::database::{NodeId, OpenError, TopologicalDatabase};

    fn segment(x: f32, polarity: Polarity) -> Segment3 {
        Segment3 { start: Point3::new(x, 0.0, -1.0), end: Point3::new(x, 0.5, 1.25), polarity }
    }

    #[test]
    fn what_is_written_is_read() {
        let (first, second) = (
            [segment(1.0, Polarity::LeftBrighter)],
            [segment(2.0, Polarity::RightBrighter), segment(-3.5, Polarity::LeftBrighter)],
        );
        let nodes = [
            NodeModel { position: Point2::new(1.5, -2.25), segments: &first },
            NodeModel { position: Point2::new(0.0, 4.0), segments: &[] },
            NodeModel { position: Point2::new(9.0, 9.0), segments: &second },
        ];
        let mut bytes = [0; 256];
        let length = write(&StereoRig::reference(), 12, &nodes, &mut bytes).expect("fits");
        assert_eq!(Some(length), encoded_len(&nodes));
        let database = TopologicalDatabase::open(&bytes).expect("just written");
        assert_eq!(*database.rig(), StereoRig::reference());
        assert_eq!((database.node_count(), database.segment_count(), database.views_per_node()), (3, 3, 12));
        let node = database.node(NodeId(2)).expect("three nodes");
        assert_eq!(node.position(), Point2::new(9.0, 9.0));
        let swapped = node.segments().next().expect("two segments");
        assert_eq!(swapped.start, Point3::new(2.0, 0.5, 1.25));
        assert_eq!(swapped.polarity, Polarity::LeftBrighter);
        assert!(database.node(NodeId(3)).is_none());
    }

    #[test]
    fn too_little_room_says_how_much_is_needed() {
        let nodes = [NodeModel { position: Point2::default(), segments: &[] }];
        let error = write(&StereoRig::reference(), 12, &nodes, &mut [0; 87]).expect_err("88 bytes needed");
        assert_eq!(error, WriteError::OutputTooShort { capacity: 87, needed: 88 });
    }

    #[test]
    fn an_agreement_is_stated_afterwards_and_read_again() {
        let nodes = [NodeModel { position: Point2::default(), segments: &[] }];
        let mut bytes = [0; 90];
        write(&StereoRig::reference(), 12, &nodes, &mut bytes).expect("room enough");
        assert_eq!(TopologicalDatabase::open(&bytes).expect("just written").self_agreement(), None);
        state_self_agreement(&mut bytes, 0.625).expect("a share");
        assert_eq!(TopologicalDatabase::open(&bytes).expect("its checksum follows").self_agreement(), Some(0.625));
        for wrong in [0.0, 1.5, f32::NAN] {
            assert_eq!(state_self_agreement(&mut bytes, wrong), Err(StateError::Agreement));
        }
        assert!(matches!(state_self_agreement(&mut bytes[..40], 0.5), Err(StateError::Open(_))));
    }

    #[test]
    fn far_and_undefined_segments_are_refused() {
        for x in [33.0, f32::NAN, f32::INFINITY] {
            let segments = [segment(x, Polarity::LeftBrighter)];
            let nodes = [NodeModel { position: Point2::default(), segments: &segments }];
            let mut bytes = [0; 128];
            let error = write(&StereoRig::reference(), 12, &nodes, &mut bytes).expect_err("out of range");
            assert_eq!(error, WriteError::SegmentOutOfRange { node: 0 });
            assert_eq!(TopologicalDatabase::open(&bytes).expect_err("not written"), OpenError::NotADatabase);
        }
    }
}

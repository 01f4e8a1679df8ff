//! The byte format of a topological database, version 3.
//!
//! Little-endian, no alignment needed. Offsets in bytes:
//!
//! | offset | type | content |
//! |---:|---|---|
//! | 0 | 8 bytes | magic `"edgemap\n"` |
//! | 8 | u16 | version, 3 |
//! | 10 | u16 | views learned at each node, at least 1 |
//! | 12 | u32 | CRC-32 (ISO-HDLC) of the whole database but these four bytes |
//! | 16 | u32 | length of the whole database; bytes after it are ignored |
//! | 20 | u32 | number of nodes N, at least 1 |
//! | 24 | u32 | number of segments S of all nodes |
//! | 28 | u16, u16 | image width and height \[px\] |
//! | 32 | f32 | focal length \[px\] |
//! | 36 | f32, f32 | principal point x and y \[px\] |
//! | 44 | f32 | stereo baseline \[m\] |
//! | 48 | f32 | camera height \[m\] |
//! | 52 | f32 | near limit \[m\] |
//! | 56 | f32, f32 | least and greatest depth of a stereo match that was kept \[m\] |
//! | 64 | f32 | self-agreement, above 0 to 1; 0 when it was not measured |
//! | 68 | u16 | sectors K of the index; 0 when there is none |
//! | 70 | u16 | poses P about each node that the index has views from; 0 when there is none |
//! | 72 | N x 16 | the nodes |
//! | 72 + 16 N | S x 12 | the segments, node after node |
//! | 72 + 16 N + 12 S | | the index, if there is one |
//!
//! The self-agreement is how well the map explains what was seen while it was learned: what the verifying localiser's
//! score is for a robot that stands at one node, looks around, and is told its pose beside another.
//!
//! A node is
//!
//! | offset | type | content |
//! |---:|---|---|
//! | 0 | i32, i32 | position x and y in the world frame \[mm\] |
//! | 8 | u32 | index of its first segment: the sum of the counts before it |
//! | 12 | u32 | number of its segments |
//!
//! A segment is six i16: start x, y, z and end x, y, z \[mm\] in the node frame (origin at the node at camera height, axes
//! parallel to the world's). Its contrast polarity is the order of the two points: walking from start to end as seen in
//! an image, the brighter side lies to the left.
//!
//! The index is a first stage for maps of many nodes, the [`gist`](crate::gist) of each node's views:
//!
//! | offset | type | content |
//! |---:|---|---|
//! | 0 | 512 x i16 | the mean edge layout |
//! | 1024 | 64 x 512 x i16 | the axes of the projection |
//! | 66,560 | K x N x P x 64 x i8 | the codes: sector after sector, in it node after node, of it pose after pose |
//!
//! Sector k holds views along the heading k / K of a turn. Which poses a node's views are from is left to who made the
//! index; those of one number are all moved alike.
//!
//! A database of one node with one segment and without an index, in full:
//!
//! ```text
//! 0x00 65 64 67 65 6d 61 70 0a | magic
//! 0x08 03 00 0c 00 91 23 9f b2 | version 3; 12 views; checksum 0xb29f2391
//! 0x10 64 00 00 00 01 00 00 00 | 100 bytes; 1 node
//! 0x18 01 00 00 00 80 02 e0 01 | 1 segment; 640 x 480 px
//! 0x20 66 26 fb 43 00 00 a0 43 | focal length 502.3 px; principal point x 320 px,
//! 0x28 00 00 70 43 8f c2 f5 3d | y 240 px; baseline 0.12 m
//! 0x30 00 00 80 3f 9a 99 19 3e | camera height 1 m; near limit 0.15 m
//! 0x38 00 00 80 3e 00 00 80 41 | matches from 0.25 m to 16 m
//! 0x40 00 00 00 00 00 00 00 00 | self-agreement not measured; no index
//! 0x48 dc 05 00 00 30 f8 ff ff | node 0 at 1.5, -2 m;
//! 0x50 00 00 00 00 01 00 00 00 | its first segment is 0, it has 1
//! 0x58 d0 07 f4 01 ee 02 | from 2, 0.5, 0.75 m
//! 0x5e d0 07 f4 01 06 ff | to 2, 0.5, -0.25 m; the brighter side is to the left of this way
//! ```
//!
//! A reader refuses any other version; a writer of a changed layout raises it.

use core::ops::Range;
use zerocopy::little_endian::{F32, I16, I32, U16, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

/// The first eight bytes.
pub const MAGIC: [u8; 8] = *b"edgemap\n";
/// The version this crate reads and writes.
pub const VERSION: u16 = 3;
/// Where the checksum itself lies.
pub const CRC_BYTES: Range<usize> = 12..16;
/// Length of the header.
pub const HEADER_LEN: usize = size_of::<Header>();
/// Length of a node.
pub const NODE_LEN: usize = size_of::<NodeEntry>();
/// Length of a segment.
pub const SEGMENT_LEN: usize = size_of::<SegmentEntry>();
/// Numbers of an edge layout.
pub const LAYOUT_LEN: usize = 512;
/// Length of a code.
pub const CODE_LEN: usize = 64;
/// Most sectors of an index, and most poses.
pub const MOST_SECTORS_AND_POSES: (u16, u16) = (360, 64);

/// The checksum of a database: of all its bytes but [`CRC_BYTES`].
#[must_use]
pub fn checksum(database: &[u8]) -> u32 {
    const CRC: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
    let mut digest = CRC.digest();
    for guarded in [database.get(..CRC_BYTES.start), database.get(CRC_BYTES.end..)].into_iter().flatten() {
        digest.update(guarded);
    }
    digest.finalize()
}

#[derive(Debug, Clone, Copy, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub(super) struct Header {
    pub(super) magic: [u8; 8],
    pub(super) version: U16,
    pub(super) views_per_node: U16,
    pub(super) crc: U32,
    pub(super) length: U32,
    pub(super) node_count: U32,
    pub(super) segment_count: U32,
    pub(super) image_size_px: [U16; 2],
    pub(super) focal_length_px: F32,
    pub(super) principal_point_px: [F32; 2],
    pub(super) baseline_m: F32,
    pub(super) camera_height_m: F32,
    pub(super) near_limit_m: F32,
    pub(super) model_depths_m: [F32; 2],
    pub(super) self_agreement: F32,
    pub(super) sectors: U16,
    pub(super) poses: U16,
}

#[derive(Debug, Clone, Copy, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub(super) struct NodeEntry {
    pub(super) position_mm: [I32; 2],
    pub(super) first_segment: U32,
    pub(super) segment_count: U32,
}

#[derive(Debug, Clone, Copy, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub(super) struct SegmentEntry {
    pub(super) start_mm: [I16; 3],
    pub(super) end_mm: [I16; 3],
}

/// What an index begins with: the mean layout and the axes.
#[derive(Debug, Clone, Copy, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub(super) struct IndexHead {
    pub(super) mean: [I16; LAYOUT_LEN],
    pub(super) axes: [[I16; LAYOUT_LEN]; CODE_LEN],
}

/// Length of a database, if it fits the format; `index` is the number of sectors and of poses.
pub(super) fn total_len(node_count: usize, segment_count: usize, index: (u16, u16)) -> Option<usize> {
    let nodes = node_count.checked_mul(NODE_LEN)?;
    let segments = segment_count.checked_mul(SEGMENT_LEN)?;
    let index = match code_count(node_count, index)? {
        0 => 0,
        codes => codes.checked_mul(CODE_LEN)?.checked_add(size_of::<IndexHead>())?,
    };
    let length = HEADER_LEN.checked_add(nodes)?.checked_add(segments)?.checked_add(index)?;
    u32::try_from(length).is_ok().then_some(length)
}

/// Number of codes of an index.
pub(super) fn code_count(node_count: usize, (sectors, poses): (u16, u16)) -> Option<usize> {
    node_count.checked_mul(usize::from(sectors))?.checked_mul(usize::from(poses))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_above_states_the_true_lengths() {
        assert_eq!((HEADER_LEN, NODE_LEN, SEGMENT_LEN), (72, 16, 12));
    }
}

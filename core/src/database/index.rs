//! The index of a map of many nodes: the codes of their views, read in place, and how one is added to a map.

use super::format::{self, CODE_LEN, HEADER_LEN, IndexHead, LAYOUT_LEN, MOST_SECTORS_AND_POSES};
use super::writer::{change_header, state_checksum};
use super::{OpenError, TopologicalDatabase};
use core::fmt;
use zerocopy::FromBytes;
use zerocopy::little_endian::I16;

/// How many views of each node an index has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct IndexShape {
    /// Headings, evenly about the turn from +x on, 1 to 360.
    pub sectors: u16,
    /// Poses about the node, 1 to 64.
    pub poses: u16,
}

impl IndexShape {
    fn is_legal(self) -> bool {
        let (most_sectors, most_poses) = MOST_SECTORS_AND_POSES;
        (1..=most_sectors).contains(&self.sectors) && (1..=most_poses).contains(&self.poses)
    }
}

/// The views of all nodes in a few bytes each.
#[derive(Debug, Clone, Copy)]
pub struct ViewIndex<'a> {
    shape: IndexShape,
    head: &'a IndexHead,
    codes: &'a [[i8; CODE_LEN]],
}

impl<'a> ViewIndex<'a> {
    /// The index that `bytes` begin with: within the outer option none when the shape makes no sense, within the inner none
    /// when the map has none.
    pub(super) fn read(bytes: &'a [u8], node_count: usize, (sectors, poses): (u16, u16)) -> Option<Option<Self>> {
        if (sectors, poses) == (0, 0) {
            return Some(None);
        }
        let shape = IndexShape { sectors, poses };
        if !shape.is_legal() {
            return None;
        }
        let (head, codes) = IndexHead::ref_from_prefix(bytes).ok()?;
        let count = format::code_count(node_count, (sectors, poses))?;
        let (codes, _) = <[[i8; CODE_LEN]]>::ref_from_prefix_with_elems(codes, count).ok()?;
        Some(Some(Self { shape, head, codes }))
    }

    /// How many views of each node there are.
    #[must_use]
    pub const fn shape(&self) -> IndexShape {
        self.shape
    }

    /// The mean edge layout.
    #[must_use]
    pub const fn mean(&self) -> &'a [I16; LAYOUT_LEN] {
        &self.head.mean
    }

    /// The axes of the projection.
    #[must_use]
    pub const fn axes(&self) -> &'a [[I16; LAYOUT_LEN]; CODE_LEN] {
        &self.head.axes
    }

    /// The codes of a sector's views, node after node, of each pose after pose; of sectors the index does not have, none.
    #[must_use]
    pub fn sector(&self, sector: u16) -> &'a [[i8; CODE_LEN]] {
        let count = self.codes.len() / usize::from(self.shape.sectors);
        let first = usize::from(sector).saturating_mul(count);
        self.codes.get(first..).and_then(|codes| codes.get(..count)).unwrap_or_default()
    }

    pub(super) fn byte_len(&self) -> usize {
        size_of::<IndexHead>() + size_of_val(self.codes)
    }
}

/// Bytes of the map `database` with an index of that shape; `None` if it would pass 4 GiB.
#[must_use]
pub fn indexed_len(database: &TopologicalDatabase<'_>, shape: IndexShape) -> Option<usize> {
    format::total_len(database.node_count(), database.segment_count(), (shape.sectors, shape.poses))
}

/// The parts of an index that are to be filled.
#[derive(Debug)]
pub struct IndexParts<'a> {
    /// The mean edge layout.
    pub mean: &'a mut [I16; LAYOUT_LEN],
    /// The axes of the projection.
    pub axes: &'a mut [[I16; LAYOUT_LEN]; CODE_LEN],
    /// All codes, as [`ViewIndex::sector`] has them, sector after sector.
    pub codes: &'a mut [[i8; CODE_LEN]],
}

/// Makes room for an index behind the map at the beginning of `out`, in place of the one that it has. The map is whole
/// again once the parts are filled and [`seal`] has stated its checksum.
///
/// # Errors
/// When the shape makes no sense, `out` does not begin with a map, or is shorter than [`indexed_len`].
pub fn begin_index(out: &mut [u8], shape: IndexShape) -> Result<IndexParts<'_>, IndexError> {
    if !shape.is_legal() {
        return Err(IndexError::Shape);
    }
    let (node_count, segment_count) = {
        let map = TopologicalDatabase::open(out).map_err(IndexError::Open)?;
        (map.node_count(), map.segment_count())
    };
    let counts = (shape.sectors, shape.poses);
    let length = format::total_len(node_count, segment_count, counts).ok_or(IndexError::TooLarge)?;
    let capacity = out.len();
    let out = out.get_mut(..length).ok_or(IndexError::OutputTooShort { capacity, needed: length })?;
    change_header(out, |header| {
        (header.sectors, header.poses) = (shape.sectors.into(), shape.poses.into());
        header.length = (length as u32).into();
    });
    let tables = HEADER_LEN + node_count * format::NODE_LEN + segment_count * format::SEGMENT_LEN;
    let parts = IndexHead::mut_from_prefix(&mut out[tables..]).ok().and_then(|(head, codes)| {
        let codes = <[[i8; CODE_LEN]]>::mut_from_bytes(codes).ok()?;
        Some(IndexParts { mean: &mut head.mean, axes: &mut head.axes, codes })
    });
    parts.ok_or(IndexError::TooLarge)
}

/// States the checksum of the map at the beginning of `bytes`, whose header tells its length; returns that.
///
/// # Errors
/// When `bytes` are shorter than that.
pub fn seal(bytes: &mut [u8]) -> Result<usize, IndexError> {
    let capacity = bytes.len();
    let needed = format::Header::ref_from_prefix(bytes).map_or(HEADER_LEN, |(header, _)| header.length.get() as usize);
    let map = bytes.get_mut(..needed).ok_or(IndexError::OutputTooShort { capacity, needed })?;
    state_checksum(map);
    Ok(needed)
}

/// Why an index can't be added to a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IndexError {
    /// The number of sectors is not within 1 to 360, or that of poses not within 1 to 64.
    Shape,
    /// The bytes are no map.
    Open(OpenError),
    /// The map would pass the 4 GiB that its format can hold.
    TooLarge,
    /// The bytes given are too few.
    OutputTooShort {
        /// Bytes there are.
        capacity: usize,
        /// Bytes needed.
        needed: usize,
    },
}

impl fmt::Display for IndexError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shape => f.write_str("an index has 1 to 360 sectors and 1 to 64 poses"),
            Self::Open(error) => error.fmt(f),
            Self::TooLarge => f.write_str("database would pass 4 GiB with the index"),
            Self::OutputTooShort { capacity, needed } => {
                write!(f, "database output: room for {capacity} bytes, {needed} needed")
            }
        }
    }
}

impl core::error::Error for IndexError {}

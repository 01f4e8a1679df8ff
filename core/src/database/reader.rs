//! Reading a topological database in place.

use super::ViewIndex;
use super::format::{self, HEADER_LEN, Header, NodeEntry, SegmentEntry};
use crate::geometry::{CameraError, PinholeCamera, Point2, Point3, Polarity, RigError, Segment3, StereoRig};
use core::fmt;
use zerocopy::{FromBytes, IntoBytes};

/// Identity of a node: its index in the database.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct NodeId(pub u32);

impl fmt::Display for NodeId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "node {}", self.0)
    }
}

/// The places that were learned, read in place from bytes that were checked when opened.
#[derive(Debug, Clone, Copy)]
pub struct TopologicalDatabase<'a> {
    rig: StereoRig,
    views_per_node: u16,
    self_agreement: f32,
    nodes: &'a [NodeEntry],
    segments: &'a [SegmentEntry],
    index: Option<ViewIndex<'a>>,
}

impl<'a> TopologicalDatabase<'a> {
    /// Checks `bytes` and opens the database at their beginning.
    ///
    /// Guarantees afterwards: magic, version and CRC are right; the counts fit the bytes; there is at least one node;
    /// every node's segments lie inside the table; an index has rows for all nodes; the rig is
    /// [valid](StereoRig::checked). Takes one pass over the bytes.
    ///
    /// # Errors
    /// When any of that does not hold: the first thing that is wrong.
    pub fn open(bytes: &'a [u8]) -> Result<Self, OpenError> {
        let (header, _) = Header::ref_from_prefix(bytes)
            .map_err(|_| OpenError::Truncated { length: bytes.len(), needed: HEADER_LEN })?;
        if header.magic != format::MAGIC {
            return Err(OpenError::NotADatabase);
        }
        if header.version.get() != format::VERSION {
            return Err(OpenError::Version { found: header.version.get() });
        }
        let (node_count, segment_count) = (header.node_count.get() as usize, header.segment_count.get() as usize);
        let length = header.length.get() as usize;
        let index_shape = (header.sectors.get(), header.poses.get());
        if format::total_len(node_count, segment_count, index_shape) != Some(length) {
            return Err(OpenError::Counts);
        }
        let bytes = bytes.get(..length).ok_or(OpenError::Truncated { length: bytes.len(), needed: length })?;
        if format::checksum(bytes) != header.crc.get() {
            return Err(OpenError::Checksum);
        }
        if node_count == 0 || header.views_per_node.get() == 0 {
            return Err(OpenError::Empty);
        }
        let rig = rig_of(header)?;
        let tables = &bytes[HEADER_LEN..];
        let (nodes, tables) =
            <[NodeEntry]>::ref_from_prefix_with_elems(tables, node_count).map_err(|_| OpenError::Counts)?;
        let (segments, index) =
            <[SegmentEntry]>::ref_from_prefix_with_elems(tables, segment_count).map_err(|_| OpenError::Counts)?;
        let index = ViewIndex::read(index, node_count, index_shape).ok_or(OpenError::Index)?;
        let mut expected_first = 0_u64;
        for node in nodes {
            if u64::from(node.first_segment.get()) != expected_first {
                return Err(OpenError::Counts);
            }
            expected_first += u64::from(node.segment_count.get());
        }
        if expected_first != segment_count as u64 {
            return Err(OpenError::Counts);
        }
        let self_agreement = header.self_agreement.get();
        if !(0.0..=1.0).contains(&self_agreement) {
            return Err(OpenError::SelfAgreement);
        }
        Ok(Self { rig, views_per_node: header.views_per_node.get(), self_agreement, nodes, segments, index })
    }

    /// The rig that the database was learned with.
    #[must_use]
    pub const fn rig(&self) -> &StereoRig {
        &self.rig
    }

    /// Views learned at each node.
    #[must_use]
    pub const fn views_per_node(&self) -> u16 {
        self.views_per_node
    }

    /// How well the map explains what was seen while it was learned, 0 to 1, if that was measured.
    #[must_use]
    pub fn self_agreement(&self) -> Option<f32> {
        (self.self_agreement > 0.0).then_some(self.self_agreement)
    }

    /// The index of the nodes' views, if the map has one.
    #[must_use]
    pub const fn index(&self) -> Option<&ViewIndex<'a>> {
        self.index.as_ref()
    }

    /// The same map as if it had no index.
    #[must_use]
    pub fn without_index(self) -> Self {
        Self { index: None, ..self }
    }

    /// The bytes of all segments, node after node.
    #[must_use]
    pub fn segment_bytes(&self) -> &'a [u8] {
        self.segments.as_bytes()
    }

    /// Length of the database in bytes.
    #[must_use]
    pub fn byte_len(&self) -> usize {
        let index = self.index.as_ref().map_or(0, ViewIndex::byte_len);
        HEADER_LEN + size_of_val(self.nodes) + size_of_val(self.segments) + index
    }

    /// Number of nodes, at least one.
    #[must_use]
    pub const fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// Number of segments of all nodes.
    #[must_use]
    pub const fn segment_count(&self) -> usize {
        self.segments.len()
    }

    /// The node with the given identity, if there is one.
    #[must_use]
    pub fn node(&self, id: NodeId) -> Option<Node<'a>> {
        let entry = self.nodes.get(id.0 as usize)?;
        let first = entry.first_segment.get() as usize;
        let segments = self.segments.get(first..)?.get(..entry.segment_count.get() as usize)?;
        Some(Node { id, entry, segments })
    }

    /// All nodes, by identity.
    pub fn nodes(&self) -> impl Iterator<Item = Node<'a>> {
        let database = *self;
        (0..self.nodes.len() as u32).filter_map(move |id| database.node(NodeId(id)))
    }
}

fn rig_of(header: &Header) -> Result<StereoRig, OpenError> {
    let [width_px, height_px] = header.image_size_px.map(|side| side.get());
    let [x, y] = header.principal_point_px.map(|coordinate| coordinate.get());
    let camera = PinholeCamera::new((width_px, height_px), header.focal_length_px.get(), Point2::new(x, y));
    let [nearest_model_m, farthest_model_m] = header.model_depths_m.map(|depth| depth.get());
    let rig = StereoRig {
        camera: camera.map_err(OpenError::Camera)?,
        baseline_m: header.baseline_m.get(),
        camera_height_m: header.camera_height_m.get(),
        near_limit_m: header.near_limit_m.get(),
        nearest_model_m,
        farthest_model_m,
    };
    rig.checked().map_err(OpenError::Rig)
}

/// A place where views were learned.
#[derive(Debug, Clone, Copy)]
pub struct Node<'a> {
    id: NodeId,
    entry: &'a NodeEntry,
    segments: &'a [SegmentEntry],
}

impl<'a> Node<'a> {
    /// Its identity.
    #[must_use]
    pub const fn id(&self) -> NodeId {
        self.id
    }

    /// Position in the world frame \[m\].
    #[must_use]
    pub fn position(&self) -> Point2 {
        let [x, y] = self.entry.position_mm.map(|mm| mm.get() as f32 * 0.001);
        Point2::new(x, y)
    }

    /// Its 3-D segments in the node frame \[m\]: origin at the node at camera height, axes parallel to the world's, z up.
    pub fn segments(&self) -> impl ExactSizeIterator<Item = Segment3> + use<'a> {
        let metres = |mm: zerocopy::little_endian::I16| f32::from(mm.get()) * 0.001;
        let point = move |[x, y, z]: [zerocopy::little_endian::I16; 3]| Point3::new(metres(x), metres(y), metres(z));
        self.segments.iter().map(move |entry| Segment3 {
            start: point(entry.start_mm),
            end: point(entry.end_mm),
            polarity: Polarity::LeftBrighter,
        })
    }
}

/// Why bytes are not a topological database that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OpenError {
    /// The bytes end before the database does.
    Truncated {
        /// Bytes there are.
        length: usize,
        /// Bytes needed, as far as known.
        needed: usize,
    },
    /// The first bytes are not those of a topological database.
    NotADatabase,
    /// The database has a version that this program does not read.
    Version {
        /// The version found.
        found: u16,
    },
    /// The checksum does not match: the bytes were changed or damaged.
    Checksum,
    /// Counts and lengths contradict each other.
    Counts,
    /// There is no node, or a node without views.
    Empty,
    /// The self-agreement is not within 0 to 1.
    SelfAgreement,
    /// The index has more sectors or poses than any, or the one without the other.
    Index,
    /// The camera makes no sense.
    Camera(CameraError),
    /// The rig makes no sense.
    Rig(RigError),
}

impl fmt::Display for OpenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Truncated { length, needed } => write!(f, "database is cut off: {length} bytes of {needed}"),
            Self::NotADatabase => f.write_str("not a topological database"),
            Self::Version { found } => write!(f, "database version {found}, expected {}", format::VERSION),
            Self::Checksum => f.write_str("database checksum does not match: the bytes are damaged"),
            Self::Counts => f.write_str("database counts contradict each other"),
            Self::Empty => f.write_str("database holds no node or no views"),
            Self::SelfAgreement => f.write_str("database self-agreement is not within 0 to 1"),
            Self::Index => f.write_str("database index has no legal number of sectors or poses"),
            Self::Camera(error) => write!(f, "database camera: {error}"),
            Self::Rig(error) => write!(f, "database rig: {error}"),
        }
    }
}

impl core::error::Error for OpenError {}

//! The topological database: the places that were learned, as bytes read in place.
//!
//! A [`TopologicalDatabase`] is a view of bytes in flash, in a memory map or in RAM. [`TopologicalDatabase::open`] checks
//! everything once; after that nothing fails. [`mod@format`] is the byte format, [`write()`] makes the bytes, [`begin_index`]
//! makes room for an index of many nodes' views.

pub mod format;
mod index;
mod joining;
mod reader;
mod writer;

pub use index::{IndexError, IndexParts, IndexShape, ViewIndex, begin_index, indexed_len, seal};
pub use joining::{joined_header, moved_node};
pub use reader::{Node, NodeId, OpenError, TopologicalDatabase};
pub use writer::{NodeModel, StateError, WriteError, encoded_len, state_self_agreement, write};

//! The topological database: the places that were learned, as bytes read in place.
//!
//! A [`TopologicalDatabase`] is a view of bytes in flash, in a memory map or in RAM. [`TopologicalDatabase::open`] checks
//! everything once; after that nothing fails. [`mod@format`] is the byte format, [`write()`] makes the bytes.

pub mod format;
mod reader;
mod writer;

pub use reader::{Node, NodeId, OpenError, TopologicalDatabase};
pub use writer::{NodeModel, StateError, WriteError, encoded_len, state_self_agreement, write};

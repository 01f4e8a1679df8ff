//! What the benchmarks measure: declared workloads, each with the answer that it must give before it is timed.

pub mod stored_view;
pub mod workloads;

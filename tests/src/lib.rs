//! Whole-system tests of edgeloc: naive oracles, golden vectors and the real data they run on.

pub mod corner_pairs;
pub mod golden;
pub mod matcher;
pub mod oracle;
pub mod strategies;
pub mod tiny_worlds;

use std::path::PathBuf;

/// The folder `name` of the real data, or `None` with a loud line on standard error when it is absent.
///
/// The data lives under the environment variable `EDGELOC_DATA`, by default `../shared/data` beside the repository.
#[must_use]
pub fn data_folder(name: &str) -> Option<PathBuf> {
    let default = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    let folder = std::env::var_os("EDGELOC_DATA").map_or_else(default, PathBuf::from).join(name);
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("SKIPPED: no folder {} (set EDGELOC_DATA to the folder that holds {name})", folder.display());
    None
}

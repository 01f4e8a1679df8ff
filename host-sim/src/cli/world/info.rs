//! `world info`: what a world file holds.

use super::description::{JSON_FIELDS, WorldDescription};
use crate::cli::console::Format;
use crate::cli::worlds;
use clap::Args;
use miette::Result;
use std::path::PathBuf;

/// Describe a world: edges, surfaces, size, free space.
#[derive(Debug, Args)]
#[command(after_help = format!(
    "Examples:\n  edgeloc world info small_house.edgeworld\n  edgeloc world info office-7.edgeworld --format json\n\n\
     JSON (--format json): {JSON_FIELDS}."
))]
pub(in crate::cli) struct Info {
    /// World file (.edgeworld).
    file: PathBuf,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

impl Info {
    pub(super) fn execute(&self) -> Result<()> {
        WorldDescription::new(&worlds::read(&self.file)?, &self.file).print(self.format)
    }
}

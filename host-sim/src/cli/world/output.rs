//! Where a new world goes: what `generate` and `import` share.

use super::file_stem;
use crate::cli::console::{self, Format};
use clap::Args;
use edgeloc_sim::world::{WireframeWorld, file};
use miette::{IntoDiagnostic, Result};
use std::path::PathBuf;

/// Where a new world goes.
#[derive(Debug, Args)]
pub(super) struct WorldOutput {
    /// World file to write [default: the name of the world, .edgeworld].
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Overwrite the world file.
    #[arg(long)]
    force: bool,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    pub(super) format: Format,
}

impl WorldOutput {
    /// Writes the world; its file.
    pub(super) fn save(&self, world: &WireframeWorld) -> Result<PathBuf> {
        let path =
            self.output.clone().unwrap_or_else(|| PathBuf::from(format!("{}.edgeworld", file_stem(&world.name))));
        console::check_overwrite(&path, self.force)?;
        file::save(world, &path).into_diagnostic()?;
        Ok(path)
    }
}

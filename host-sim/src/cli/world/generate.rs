//! `world generate`: the furnished office of a seed.

use super::description::{JSON_FIELDS, WorldDescription};
use super::output::WorldOutput;
use clap::Args;
use edgeloc_sim::world::office;
use miette::Result;

/// Generate a furnished office of 20 x 15 x 2.5 m; the same seed gives the same office.
#[derive(Debug, Args)]
#[command(after_help = format!(
    "Examples:\n  edgeloc world generate --seed 7\n  edgeloc world generate --edges 6000 -o small.edgeworld\n\n\
     JSON (--format json): {JSON_FIELDS}."
))]
pub(in crate::cli) struct Generate {
    /// Seed of the office.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Straight edges asked for; an office holds about 5,500 to 8,000.
    #[arg(long, default_value_t = 7000, value_parser = clap::value_parser!(u32).range(0..=100_000))]
    edges: u32,
    #[command(flatten)]
    output: WorldOutput,
}

impl Generate {
    pub(super) fn execute(&self) -> Result<()> {
        let options = office::OfficeOptions { seed: self.seed, edge_count: self.edges as usize };
        let world = office::generate(&options);
        let path = self.output.save(&world)?;
        WorldDescription::new(&world, &path).print(self.output.format)
    }
}

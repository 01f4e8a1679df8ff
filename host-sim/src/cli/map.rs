//! `map`: what a map file holds; an index for one; a campus of many buildings.

use super::console::{self, Format};
use super::{progress, scale};
use clap::{Args, Subcommand};
use edgeloc::database::{OpenError, TopologicalDatabase};
use edgeloc_sim::learning::{self, index_shape};
use edgeloc_sim::map_file::MapFile;
use edgeloc_sim::monte_carlo::Campus;
use edgeloc_sim::scenario::RigSettings;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Describe maps, and make those of many nodes.
#[derive(Debug, Subcommand)]
#[command(after_help = "Examples:\n  edgeloc map info office-1.edgemap\n  edgeloc map campus --nodes 10000\n  \
                        edgeloc map index large.edgemap -o large-indexed.edgemap")]
pub(super) enum Map {
    Info(Info),
    Index(Index),
    Campus(MakeCampus),
}

impl Map {
    pub(super) fn execute(self) -> Result<()> {
        match self {
            Self::Info(verb) => verb.execute(),
            Self::Index(verb) => verb.execute(),
            Self::Campus(verb) => verb.execute(),
        }
    }
}

/// The fields that `--format json` prints for a map, for the help.
pub(super) const JSON_FIELDS: &str = "\
file, size_bytes, nodes, views_per_node, index_sectors and index_poses (0 without an index), segments, segments_per_node_min, segments_per_node_median, \
segments_per_node_max, rig (as in a scenario: width_px, height_px, focal_length_px, principal_point_x_px, principal_point_y_px, baseline_m, camera_height_m, near_limit_m, nearest_model_m, farthest_model_m), positions (node, x_m, y_m, segments)";

/// Check a map (checksum, bounds) and describe it: nodes, segments, rig, size.
#[derive(Debug, Args)]
#[command(after_help = format!(
    "Examples:\n  edgeloc map info office-1.edgemap\n  edgeloc map info office-1.edgemap --format json\n\n\
                        JSON (--format json): {JSON_FIELDS}."
))]
pub(super) struct Info {
    /// Map file (.edgemap).
    file: PathBuf,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

impl Info {
    fn execute(&self) -> Result<()> {
        MapDescription::new(&self.file, &mapped(&self.file)?)?.print(self.format)
    }
}

/// Add an index to a map of many nodes, or make the one it has anew: the localiser then scores only the nodes most like
/// what it sees.
///
/// `edgeloc learn` does so by itself when a map has more nodes than localizer.shortlist.
#[derive(Debug, Args)]
#[command(after_help = format!("Examples:\n  edgeloc map index large.edgemap -o large-indexed.edgemap\n\n\
                        JSON (--format json): {JSON_FIELDS}."))]
pub(super) struct Index {
    /// Map file (.edgemap).
    file: PathBuf,
    /// Map to write.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Overwrite it.
    #[arg(long)]
    force: bool,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

impl Index {
    fn execute(&self) -> Result<()> {
        console::check_overwrite(&self.output, self.force)?;
        let nodes = {
            let bytes = mapped(&self.file)?;
            TopologicalDatabase::open(&bytes).map_err(|error| not_sound(&self.file, error))?.node_count()
        };
        let bar = progress::bar(nodes * usize::from(index_shape().sectors), "views indexed");
        learning::index_map(&self.file, &self.output, &|views| bar.steps(views)).into_diagnostic()?;
        drop(bar);
        MapDescription::new(&self.output, &mapped(&self.output)?)?.print(self.format)
    }
}

/// Learn a campus: generated offices of consecutive seeds, 40 m apart, in one map with an index.
///
/// Buildings are learned in parallel, as the scenario `edgeloc` has it, and kept in a folder beside the map: after a break
/// the same command goes on. Neither the buildings nor the map have to fit into memory.
#[derive(Debug, Args)]
#[command(after_help = format!("Examples:\n  edgeloc map campus --nodes 1000\n  \
                        edgeloc map campus --nodes 100000 --seed 5000 -o large.edgemap\n\n\
                        JSON (--format json): {JSON_FIELDS}."))]
pub(super) struct MakeCampus {
    /// Nodes, rounded up to whole buildings of 72.
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    nodes: u32,
    /// Seed of the first office.
    #[arg(long, default_value_t = 1000, value_name = "SEED")]
    seed: u64,
    /// Map to write.
    #[arg(short, long, value_name = "FILE", default_value = "campus.edgemap")]
    output: PathBuf,
    /// Overwrite it.
    #[arg(long)]
    force: bool,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

impl MakeCampus {
    fn execute(&self) -> Result<()> {
        console::check_overwrite(&self.output, self.force)?;
        let campus = Campus::new(self.seed, &[]).into_diagnostic()?;
        if self.output.exists() {
            std::fs::remove_file(&self.output).into_diagnostic()?;
        }
        let buildings = self.nodes.div_ceil(campus.nodes_per_building());
        scale::make_map(&campus, buildings, &self.output.with_extension("buildings"), &self.output)?;
        MapDescription::new(&self.output, &mapped(&self.output)?)?.print(self.format)
    }
}

/// The bytes of a map file, brought in as they are read.
fn mapped(path: &Path) -> Result<MapFile> {
    MapFile::open(path).into_diagnostic().wrap_err_with(|| format!("the map {} can't be read", path.display()))
}

fn not_sound(file: &Path, error: OpenError) -> miette::Report {
    miette!(help = "`edgeloc learn` writes maps (.edgemap)", "{} is not a sound map: {error}", file.display())
}

/// What is known of a map, as `--format json` prints it.
#[derive(Debug, Serialize)]
pub(super) struct MapDescription {
    file: PathBuf,
    size_bytes: usize,
    nodes: usize,
    views_per_node: u16,
    index_sectors: u16,
    index_poses: u16,
    segments: usize,
    segments_per_node_min: usize,
    segments_per_node_median: usize,
    segments_per_node_max: usize,
    rig: RigSettings,
    positions: Vec<NodeLine>,
}

#[derive(Debug, Serialize)]
struct NodeLine {
    node: u32,
    x_m: f32,
    y_m: f32,
    segments: usize,
}

impl MapDescription {
    /// Describes the map in `bytes`, read from or written to `file`.
    pub(super) fn new(file: &Path, bytes: &[u8]) -> Result<Self> {
        let map = TopologicalDatabase::open(bytes).map_err(|error| not_sound(file, error))?;
        let positions = map.nodes().map(|node| NodeLine {
            node: node.id().0,
            x_m: node.position().x,
            y_m: node.position().y,
            segments: node.segments().len(),
        });
        let positions = positions.collect::<Vec<_>>();
        let mut counts = positions.iter().map(|node| node.segments).collect::<Vec<_>>();
        counts.sort_unstable();
        Ok(Self {
            file: file.to_owned(),
            size_bytes: map.byte_len(),
            nodes: map.node_count(),
            views_per_node: map.views_per_node(),
            index_sectors: map.index().map_or(0, |index| index.shape().sectors),
            index_poses: map.index().map_or(0, |index| index.shape().poses),
            segments: map.segment_count(),
            segments_per_node_min: counts.first().copied().unwrap_or(0),
            segments_per_node_median: counts.get(counts.len() / 2).copied().unwrap_or(0),
            segments_per_node_max: counts.last().copied().unwrap_or(0),
            rig: RigSettings::from(map.rig()),
            positions,
        })
    }

    /// Prints the description.
    pub(super) fn print(&self, format: Format) -> Result<()> {
        if format == Format::Json {
            return console::print_json(self);
        }
        let rig = &self.rig;
        let lines = [
            ("map", self.file.display().to_string()),
            (
                "size",
                format!(
                    "{} bytes, {:.1} kB a node",
                    self.size_bytes,
                    self.size_bytes as f64 / 1e3 / self.nodes.max(1) as f64
                ),
            ),
            ("nodes", format!("{} of {} views", self.nodes, self.views_per_node)),
            (
                "segments",
                format!(
                    "{}; a node {} to {}, median {}",
                    self.segments,
                    self.segments_per_node_min,
                    self.segments_per_node_max,
                    self.segments_per_node_median
                ),
            ),
            (
                "rig",
                format!(
                    "{} x {} px, focal length {} px, baseline {} m, {} m above the floor, models from {} to {} m",
                    rig.width_px,
                    rig.height_px,
                    rig.focal_length_px,
                    rig.baseline_m,
                    rig.camera_height_m,
                    rig.nearest_model_m,
                    rig.farthest_model_m
                ),
            ),
            (
                "index",
                match self.index_sectors {
                    0 => "none: every node is scored".to_owned(),
                    sectors => {
                        format!("views along {sectors} headings from {} poses about each node", self.index_poses)
                    }
                },
            ),
            ("checksum", "right".to_owned()),
        ];
        console::print(&console::facts(&lines).to_string())
    }
}

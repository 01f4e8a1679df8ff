//! `map`: what a map file holds.

use super::console::{self, Format};
use clap::{Args, Subcommand};
use edgeloc::database::TopologicalDatabase;
use edgeloc_sim::scenario::RigSettings;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::Serialize;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Longest map read [bytes].
const MAX_MAP_BYTES: u64 = 1 << 30;

/// Describe maps.
#[derive(Debug, Subcommand)]
#[command(after_help = "Examples:\n  edgeloc map info office-1.edgemap")]
pub(super) enum Map {
    Info(Info),
}

impl Map {
    pub(super) fn execute(self) -> Result<()> {
        let Self::Info(verb) = self;
        verb.execute()
    }
}

/// The fields that `--format json` prints for a map, for the help.
pub(super) const JSON_FIELDS: &str = "\
file, size_bytes, nodes, views_per_node, segments, segments_per_node_min, segments_per_node_median, \
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
        let bytes = read(&self.file)
            .into_diagnostic()
            .wrap_err_with(|| format!("the map {} can't be read", self.file.display()))?;
        MapDescription::new(&self.file, &bytes)?.print(self.format)
    }
}

/// The bytes of a map file.
fn read(path: &Path) -> std::io::Result<Vec<u8>> {
    // Asked before opening: a pipe would wait for a writer, a device never end.
    if !std::fs::metadata(path)?.is_file() {
        return Err(std::io::Error::other("it is not a file"));
    }
    let mut bytes = Vec::new();
    std::fs::File::open(path)?.take(MAX_MAP_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_MAP_BYTES {
        return Err(std::io::Error::other("it is larger than any map (1 GiB)"));
    }
    Ok(bytes)
}

/// What is known of a map, as `--format json` prints it.
#[derive(Debug, Serialize)]
pub(super) struct MapDescription {
    file: PathBuf,
    size_bytes: usize,
    nodes: usize,
    views_per_node: u16,
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
        let map = TopologicalDatabase::open(bytes).map_err(|error| {
            miette!(help = "`edgeloc learn` writes maps (.edgemap)", "{} is not a sound map: {error}", file.display())
        })?;
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
            size_bytes: bytes.len(),
            nodes: map.node_count(),
            views_per_node: map.views_per_node(),
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
            ("checksum", "right".to_owned()),
        ];
        console::print(&console::facts(&lines).to_string())
    }
}

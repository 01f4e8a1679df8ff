//! What the localizer costs, counted in instructions on the golden looks: `budget NAME COUNT`, one line each.
//!
//! | name | what is counted |
//! |---|---|
//! | `histogram_pair` | one scene histogram against one view histogram, every one of 100 against every one of 96, with nothing left out; the mean |
//! | `scene_histograms_100` | the histograms of a scene of 100 segments, ready for matching |
//! | `paper_look_72` | one whole look of the paper's localizer over 72 nodes |
//! | `verified_look_72` | the same look of the verifying localizer, on a map as it is learned for that one; not sure yet, it chooses the next turn |
//!
//! The maps of 72 nodes have the ten of a golden map again and again. The looks are the first of the golden attempts in which
//! about as many segments are matched as in a mean look at the office, 112.

use core::fmt;
use core::hint::black_box;

use edgeloc::database::{self, NodeId, NodeModel, TopologicalDatabase};
use edgeloc::geometry::{Point2, Segment2, Segment3};
use edgeloc::localize::{Decision, HeadingPrior, Localizer, LocalizerConfig, Look, lines_to_match};
use edgeloc::matching::{BinPair, LANES, Panel, PanelRow, RootRows, best_coefficient};
use edgeloc::pgh::{HistogramBuilder, Line, LineBlock, PghShape};
use heapless::Vec;

use crate::SCENE_CAPACITY;
use crate::looks::LooksReader;

/// Counts instructions.
pub trait Stopwatch {
    /// How many `work` takes.
    fn instructions(&mut self, work: impl FnOnce()) -> u64;
}

/// Bytes that the map of 72 nodes has room for.
pub const MAP_BYTES: usize = 1 << 20;

const CONFIG: LocalizerConfig = LocalizerConfig::paper();
const SHAPE: PghShape = CONFIG.shape;
const BINS: usize = SHAPE.bin_count();

/// Histograms of the scene and of the view.
const SCENE: usize = 100;
const VIEW: usize = 6 * LANES;

/// Nodes of the larger map.
const NODES: usize = 72;

/// Segments that the golden map has room for.
const SEGMENTS: usize = 12_000;

/// Memory of a builder of histograms.
struct BuilderMemory {
    masses: [i32; HistogramBuilder::memory_len(&SHAPE)],
    blocks: [LineBlock; LineBlock::count_for(SCENE)],
}

impl BuilderMemory {
    const EMPTY: Self = Self {
        masses: [0; HistogramBuilder::memory_len(&SHAPE)],
        blocks: [LineBlock::EMPTY; LineBlock::count_for(SCENE)],
    };

    fn builder(&mut self) -> Result<HistogramBuilder<'_>, fmt::Error> {
        HistogramBuilder::new(&SHAPE, &mut self.masses, &mut self.blocks).map_err(|_| fmt::Error)
    }
}

/// What is seen in a look.
struct Seen {
    heading: HeadingPrior,
    segments: Vec<Segment2, SCENE_CAPACITY>,
    lines: Vec<Line, SCENE>,
}

/// Counts everything on the paper's `map` and on the verifying localizer's `joined_map`, with `looks`, and writes the lines
/// to `out`; `memory` is the localizer's, `larger_map` at least [`MAP_BYTES`] long.
///
/// # Errors
/// When `out` fails, or the golden map and looks are not fit for it.
pub fn count_instructions(
    [map, joined_map]: [&[u8]; 2],
    looks: &[u8],
    memory: &mut [u64],
    larger_map: &mut [u8],
    stopwatch: &mut impl Stopwatch,
    out: &mut impl fmt::Write,
) -> fmt::Result {
    let mut reader = LooksReader::new(looks).map_err(|_| fmt::Error)?;
    let (Some(scene), Some(view)) = (next_seen(&mut reader), next_seen(&mut reader)) else { return Err(fmt::Error) };
    let pair = count_pair(&scene.lines, &view.lines[..VIEW], stopwatch, out)?;
    writeln!(out, "budget histogram_pair {pair}")?;
    for (name, config, map) in [("paper", CONFIG, map), ("verified", unsure(), joined_map)] {
        let length = repeat_nodes(map, larger_map)?;
        let database = TopologicalDatabase::open(&larger_map[..length]).map_err(|_| fmt::Error)?;
        let mut localizer = Localizer::new(database, &config, memory).map_err(|_| fmt::Error)?;
        let (instructions, decision) = count_look(&mut localizer, &scene, stopwatch)?;
        if name == "verified" && !matches!(decision, Decision::LookAgain { .. }) {
            return Err(fmt::Error);
        }
        writeln!(out, "budget {name}_look_72 {instructions}")?;
    }
    Ok(())
}

/// The verifying localizer that no look makes sure.
fn unsure() -> LocalizerConfig {
    let mut config = LocalizerConfig::edgeloc();
    if let Some(verification) = &mut config.verification {
        verification.confidence = 100.0;
    }
    config
}

fn count_look(
    localizer: &mut Localizer<'_>,
    scene: &Seen,
    stopwatch: &mut impl Stopwatch,
) -> Result<(u64, Decision), fmt::Error> {
    let look = Look {
        heading: Some(scene.heading),
        motion_since_last: None,
        scene: edgeloc::geometry::Scene::new(&scene.segments),
    };
    let mut answer = None;
    let instructions = stopwatch.instructions(|| answer = Some(localizer.observe(black_box(&look))));
    match answer {
        Some(Ok(decision)) => Ok((instructions, decision)),
        _ => Err(fmt::Error),
    }
}

/// The next look with enough segments, but not too many.
fn next_seen(reader: &mut LooksReader<'_>) -> Option<Seen> {
    loop {
        let attempt = reader.attempt().ok()?;
        let mut found = None;
        for _ in 0..attempt.look_count {
            let look = reader.look().ok()?;
            let segments: Vec<Segment2, SCENE_CAPACITY> =
                look.segments().take(SCENE_CAPACITY).collect::<Result<_, _>>().ok()?;
            let Some(first) = segments.first() else { continue };
            let mut storage = [Line::new(first, 0, &SHAPE); CONFIG.max_segments as usize];
            let lines = lines_to_match(segments.iter().copied(), &CONFIG, &mut storage);
            if found.is_none() && (SCENE..SCENE + 25).contains(&lines.len()) {
                let lines = Vec::from_slice(&lines[..SCENE]).ok()?;
                found = Some(Seen { heading: look.heading?, segments, lines });
            }
        }
        if found.is_some() {
            return found;
        }
    }
}

/// Builds the scene's histograms, writes what that took, and returns what a pair of histograms takes.
fn count_pair(
    scene: &[Line],
    view: &[Line],
    stopwatch: &mut impl Stopwatch,
    out: &mut impl fmt::Write,
) -> Result<u64, fmt::Error> {
    let mut builder_memory = BuilderMemory::EMPTY;
    let mut builder = builder_memory.builder()?;
    let mut pairs = [BinPair { index: 0, roots: [0; 2] }; RootRows::pairs_len(SCENE, BINS)];
    let mut ends = [0; SCENE];
    let mut rows = RootRows::new(&mut pairs, &mut ends);
    let mut built = Ok(());
    let instructions = stopwatch.instructions(|| built = rows.rebuild(&mut builder, black_box(scene)));
    built.map_err(|_| fmt::Error)?;
    writeln!(out, "budget scene_histograms_100 {instructions}")?;

    let mut panels = [[PanelRow { roots: [[0; 2]; LANES] }; Panel::rows_len(BINS)]; VIEW / LANES];
    builder.load(view).map_err(|_| fmt::Error)?;
    for (index, line) in view.iter().enumerate() {
        let panel = &mut panels[index / LANES];
        builder.build(line, index, |pair, roots| panel[usize::from(pair)].roots[index % LANES] = roots);
    }
    let instructions = stopwatch.instructions(|| {
        for panel in &panels {
            for row in rows.rows() {
                black_box(best_coefficient(black_box(row), black_box(panel)));
            }
        }
    });
    let bin_pairs: usize = rows.rows().map(<[BinPair]>::len).sum();
    writeln!(out, "{bin_pairs} pairs of bins in {} scene histograms", scene.len())?;
    let count = (scene.len() * view.len()) as u64;
    Ok((instructions + count / 2) / count)
}

/// Writes a map whose nodes are those of `map` again and again; returns its length.
fn repeat_nodes(map: &[u8], larger_map: &mut [u8]) -> Result<usize, fmt::Error> {
    let database = TopologicalDatabase::open(map).map_err(|_| fmt::Error)?;
    let mut segments: Vec<Segment3, SEGMENTS> = Vec::new();
    let mut ranges: Vec<(Point2, usize, usize), NODES> = Vec::new();
    for index in 0..NODES {
        match ranges.get(index.wrapping_sub(database.node_count())).copied() {
            Some(range) => ranges.push(range).map_err(|_| fmt::Error)?,
            None => {
                let node = database.node(NodeId(index as u32)).ok_or(fmt::Error)?;
                let start = segments.len();
                for segment in node.segments() {
                    segments.push(segment).map_err(|_| fmt::Error)?;
                }
                ranges.push((node.position(), start, segments.len())).map_err(|_| fmt::Error)?;
            }
        }
    }
    let models: Vec<NodeModel<'_>, NODES> =
        ranges.iter().map(|&(position, start, end)| NodeModel { position, segments: &segments[start..end] }).collect();
    let length = database::encoded_len(&models).ok_or(fmt::Error)?;
    let bytes = larger_map.get_mut(..length).ok_or(fmt::Error)?;
    database::write(database.rig(), database.views_per_node(), &models, bytes).map_err(|_| fmt::Error)?;
    Ok(length)
}

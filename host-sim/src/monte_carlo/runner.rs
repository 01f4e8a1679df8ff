//! All trials of a scenario, in parallel, with the same rows whatever the number of threads.

use super::looks::Looks;
use super::trial::Trial;
use super::{LookEvent, Site, TrialRecord, TruePose, draw_start};
use crate::scenario::{Row, Scenario, Start};
use edgeloc::database::{OpenError, TopologicalDatabase, WriteError};
use edgeloc::localize::Localizer;
use rayon::prelude::*;
use std::time::Duration;

/// The results of a run.
#[derive(Debug)]
pub struct RunOutcome {
    /// One record a trial, by row in the scenario's order, then by trial.
    pub records: Vec<TrialRecord>,
    /// Wall time of the localiser for each look of each record, in the same order.
    pub look_times: Vec<Vec<Duration>>,
    /// Size of a map \[bytes\], the mean over all that were learned.
    pub map_bytes: f64,
    /// Segments in the model of a node, the mean over all that were learned.
    pub segments_per_node: f64,
}

/// Runs all trials of `scenario` in the current thread pool and tells `on_trial` of each as it ends.
///
/// # Errors
/// When a map can't be learned.
pub fn run(site: &Site, scenario: &Scenario, on_trial: &(dyn Fn(&TrialRecord) + Sync)) -> Result<RunOutcome, RunError> {
    let map_count = scenario.trials.div_ceil(scenario.trials_per_map);
    let blocks = (0..map_count).into_par_iter().map(|map| run_block(site, scenario, map, on_trial));
    let blocks: Vec<Block> = blocks.collect::<Result<_, _>>()?;

    let mean = |value: fn(&Block) -> f64| blocks.iter().map(value).sum::<f64>() / f64::from(map_count);
    let (map_bytes, segments_per_node) = (mean(|block| block.map_bytes), mean(|block| block.segments_per_node));
    let row_index = |name: &str| scenario.rows.iter().position(|row| row.name == name);
    let mut trials: Vec<Timed> = blocks.into_iter().flat_map(|block| block.trials).collect();
    trials.sort_by_key(|(record, _)| (row_index(&record.row), record.trial));
    let (records, look_times) = trials.into_iter().unzip();
    Ok(RunOutcome { records, look_times, map_bytes, segments_per_node })
}

/// Runs one trial again, or a robot put down at a pose of one's own, and tells `watch` of every look.
///
/// `start` of `None` draws the trial's own pose: the record is then the one of the run.
///
/// # Errors
/// When the map can't be learned.
pub fn replay(
    site: &Site,
    scenario: &Scenario,
    row: &Row,
    trial: u32,
    start: Option<TruePose>,
    watch: impl FnMut(&LookEvent<'_>),
) -> Result<TrialRecord, RunError> {
    let map = trial / scenario.trials_per_map;
    let bytes = site.learn_map(scenario, map)?;
    let database = TopologicalDatabase::open(&bytes)?;
    let start = start.unwrap_or_else(|| draw_start(site, scenario, row.start, trial));
    let mut looks = Looks::new(site, scenario, trial, start);
    let mut memory = vec![0; memory_len(scenario, database.node_count())];
    Ok(Trial { site, scenario, row, trial, map, start }.run(database, &mut memory, &mut looks, watch))
}

type Timed = (TrialRecord, Vec<Duration>);

/// The trials that share one map.
struct Block {
    trials: Vec<Timed>,
    map_bytes: f64,
    segments_per_node: f64,
}

fn run_block(
    site: &Site,
    scenario: &Scenario,
    map: u32,
    on_trial: &(dyn Fn(&TrialRecord) + Sync),
) -> Result<Block, RunError> {
    let bytes = site.learn_map(scenario, map)?;
    let database = TopologicalDatabase::open(&bytes)?;
    let first = map * scenario.trials_per_map;
    let last = scenario.trials.min(first + scenario.trials_per_map);
    let starts = || {
        [Start::Near, Start::Anywhere].into_iter().filter(|start| scenario.rows.iter().any(|row| row.start == *start))
    };
    let tasks: Vec<(u32, Start)> = (first..last).flat_map(|trial| starts().map(move |start| (trial, start))).collect();

    let run_rows = |memory: &mut Vec<u64>, (trial, start): (u32, Start)| {
        let pose = draw_start(site, scenario, start, trial);
        let mut looks = Looks::new(site, scenario, trial, pose);
        let rows = scenario.rows.iter().filter(|row| row.start == start);
        let run_row = |row| {
            let mut times = Vec::new();
            let trial = Trial { site, scenario, row, trial, map, start: pose };
            let record = trial.run(database, memory, &mut looks, |look| times.push(look.localizer_time));
            on_trial(&record);
            (record, times)
        };
        rows.map(run_row).collect::<Vec<Timed>>()
    };
    let memory = || vec![0; memory_len(scenario, database.node_count())];
    let trials = tasks.into_par_iter().map_init(memory, run_rows).flatten_iter().collect();
    let segments_per_node = database.segment_count() as f64 / database.node_count() as f64;
    Ok(Block { trials, map_bytes: bytes.len() as f64, segments_per_node })
}

/// Words of memory for the hungriest row.
fn memory_len(scenario: &Scenario, node_count: usize) -> usize {
    // Rows differ in polarity alone, which needs no memory.
    Localizer::memory_len(&scenario.localizer.localizer_config(true), node_count)
}

/// Why trials can't be run.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// What was learned does not fit the database format.
    #[error("the learned map can't be written: {0}")]
    Write(#[from] WriteError),
    /// The map just learned does not open.
    #[error("the learned map does not open: {0}")]
    Open(#[from] OpenError),
}

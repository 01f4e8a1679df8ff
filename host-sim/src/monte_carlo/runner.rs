//! All trials of a scenario, in parallel, with the same rows whatever the number of threads.
//!
//! Rows are settings on common random numbers, so what several of them need is worked out once: a site for each way of
//! learning, a map for each site, sources and draw of noise, a pose for each kind of start, what is visible from it, the
//! clean images, the scene through each set of sources, and of rows that differ in name alone the whole trial, times
//! and all. A row gives the same records as it does alone.
//!
//! Trials go map by map, so that never more than a few maps of each kind are in memory.

use super::looks::Looks;
use super::sites::Sites;
use super::trial::Trial;
use super::{SiteError, TrialRecord, draw_start};
use crate::scenario::Setting;
use edgeloc::database::{OpenError, TopologicalDatabase, WriteError};
use edgeloc::localize::Localizer;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// The results of a run.
#[derive(Debug)]
pub struct RunOutcome {
    /// One record a trial, by row in the scenario's order, then by trial.
    pub records: Vec<TrialRecord>,
    /// Wall time of the localiser for each look of each record, in the same order.
    pub look_times: Vec<Vec<Duration>>,
}

/// One trial as it ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TimedTrial {
    /// Index of its row.
    pub row: usize,
    /// What is kept of it.
    pub record: TrialRecord,
    /// Wall time of the localiser for each look.
    pub look_times: Vec<Duration>,
}

impl RunOutcome {
    /// The results of trials that ended in any order.
    #[must_use]
    pub fn of(mut trials: Vec<TimedTrial>) -> Self {
        trials.sort_by_key(|trial| (trial.row, trial.record.trial));
        let (records, look_times) = trials.into_iter().map(|trial| (trial.record, trial.look_times)).unzip();
        Self { records, look_times }
    }
}

/// Which trials of a run are to be done, and when to stop early.
pub struct Part<'p> {
    /// Indices of the trials, of every row that has them.
    pub trials: Range<u32>,
    /// Whether a trial, by the index of its row and its own, was done before.
    pub is_done: &'p (dyn Fn(usize, u32) -> bool + Sync),
    /// Asked before each trial; the rest is left out once it is true.
    pub should_stop: &'p (dyn Fn() -> bool + Sync),
}

impl fmt::Debug for Part<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Part").field("trials", &self.trials).finish_non_exhaustive()
    }
}

/// Runs all trials of the scenario that `sites` were prepared for, in the current thread pool, and tells `on_trial` of each
/// as it ends.
///
/// # Errors
/// When a map can't be learned.
pub fn run(sites: &Sites, on_trial: &(dyn Fn(&TrialRecord) + Sync)) -> Result<RunOutcome, RunError> {
    let trials = Mutex::new(Vec::new());
    let keep = |trial: TimedTrial| {
        on_trial(&trial.record);
        trials.lock().unwrap_or_else(PoisonError::into_inner).push(trial);
    };
    let all = Part { trials: 0..sites.trials(), is_done: &|_, _| false, should_stop: &|| false };
    run_part(sites, &all, &keep)?;
    Ok(RunOutcome::of(trials.into_inner().unwrap_or_else(PoisonError::into_inner)))
}

/// Runs a part of the trials and hands each to `on_trial` as it ends, in any order and from any thread.
///
/// # Errors
/// When a map can't be learned.
pub fn run_part(sites: &Sites, part: &Part<'_>, on_trial: &(dyn Fn(TimedTrial) + Sync)) -> Result<(), RunError> {
    let trials_per_map = sites.trials_per_map();
    let maps: Vec<u32> = (part.trials.start / trials_per_map..part.trials.end.div_ceil(trials_per_map)).collect();
    // Maps of few trials are worked on together, so that every thread has something to do.
    let at_once = (8 * rayon::current_num_threads()).div_ceil(trials_per_map as usize);
    for maps in maps.chunks(at_once) {
        maps.par_iter().try_for_each(|&map| run_block(sites, part, map, on_trial))?;
    }
    Ok(())
}

/// Runs the trials of a part that share one draw of the map's noise.
fn run_block(sites: &Sites, part: &Part<'_>, map: u32, on_trial: &(dyn Fn(TimedTrial) + Sync)) -> Result<(), RunError> {
    let settings = sites.settings();
    let first = map * sites.trials_per_map();
    let last = first.saturating_add(sites.trials_per_map());
    let trials = first.max(part.trials.start)..last.min(part.trials.end);
    let is_open = |row: usize, trial: u32| trial < settings[row].scenario.trials && !(part.is_done)(row, trial);
    let poses = same(settings.len(), |a, b| sites.share_pose(a, b));
    let open_rows = |trial: u32, rows: &[usize]| -> (u32, Vec<usize>) {
        (trial, rows.iter().copied().filter(|&row| is_open(row, trial)).collect())
    };
    let tasks = trials.flat_map(|trial| poses.iter().map(move |rows| (trial, rows)));
    let tasks: Vec<(u32, Vec<usize>)> =
        tasks.map(|(trial, rows)| open_rows(trial, rows)).filter(|(_, rows)| !rows.is_empty()).collect();

    let is_needed = |row: usize| tasks.iter().any(|(_, rows)| rows.contains(&row));
    let kinds: Vec<Vec<usize>> = same(settings.len(), |a, b| sites.share_map(a, b))
        .into_iter()
        .filter(|rows| rows.iter().any(|&row| is_needed(row)) && !(part.should_stop)())
        .collect();
    let learn = |rows: &Vec<usize>| sites.of_row(rows[0]).learn_map(&settings[rows[0]].scenario, map);
    let bytes: Vec<Vec<u8>> = kinds.par_iter().map(learn).collect::<Result<_, _>>()?;
    let mut maps = vec![None; settings.len()];
    for (rows, bytes) in kinds.iter().zip(&bytes) {
        let opened = (TopologicalDatabase::open(bytes)?, bytes.len() as u32);
        rows.iter().for_each(|&row| maps[row] = Some(opened));
    }

    let run_rows = |memory: &mut Vec<u64>, (trial, rows): &(u32, Vec<usize>)| {
        let Some(&any) = rows.first() else { return };
        let (site, Setting { row, scenario }) = (sites.of_row(any), &settings[any]);
        let start = draw_start(site, scenario, row.start, *trial);
        let mut looks = Looks::new(site, scenario.seed, *trial, map);
        let mut ended: Vec<TimedTrial> = Vec::new();
        for &row in rows {
            let timed = if let Some(twin) = ended.iter().find(|other| sites.are_alike(other.row, row)) {
                let record = TrialRecord { row: settings[row].row.name.clone(), ..twin.record.clone() };
                TimedTrial { row, record, look_times: twin.look_times.clone() }
            } else {
                // A map is missing only when the run was told to stop before it was learned.
                let Some((database, map_bytes)) = maps[row].filter(|_| !(part.should_stop)()) else { return };
                let mut look_times = Vec::new();
                let trial =
                    Trial { site: sites.of_row(row), setting: &settings[row], trial: *trial, map, map_bytes, start };
                let record = trial.run(database, memory, &mut looks, |look| look_times.push(look.localizer_time));
                TimedTrial { row, record, look_times }
            };
            if rows.iter().any(|&other| other > row && sites.are_alike(other, row)) {
                ended.push(timed.clone());
            }
            on_trial(timed);
        }
    };
    let needed = |row: usize| maps[row].map_or(0, |(map, _)| memory_len(&settings[row], &map));
    let memory_len = (0..settings.len()).map(needed).max().unwrap_or(0);
    tasks.par_iter().for_each_init(|| vec![0; memory_len], run_rows);
    Ok(())
}

/// The numbers below `count` in groups of the same, in order of their first member.
fn same(count: usize, is_same: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for number in 0..count {
        match groups.iter_mut().find(|group| is_same(group[0], number)) {
            Some(group) => group.push(number),
            None => groups.push(vec![number]),
        }
    }
    groups
}

/// Words of memory for the localiser of a setting.
pub(super) fn memory_len(setting: &Setting, map: &TopologicalDatabase<'_>) -> usize {
    Localizer::memory_len_in(&setting.localizer_config(), map)
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
    /// The site has no place of the kind that trials start in.
    #[error(transparent)]
    Start(#[from] SiteError),
}

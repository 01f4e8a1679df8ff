//! The shards of a run put together: the results of the whole, or the sentence why these folders are not one run.

use super::{Manifest, RunResults, RunTimings, Summary};
use crate::monte_carlo::{RunOutcome, Shard, TimedTrial, count_trials};
use crate::scenario::Scenario;
use miette::Diagnostic;
use std::collections::BTreeMap;
use std::time::Duration;
use thiserror::Error;

/// A shard as its folder holds it.
#[derive(Debug)]
pub struct ShardResults {
    /// How its folder is called in errors.
    pub folder: String,
    /// Its results.
    pub results: RunResults,
    /// Wall times of the looks of each of its records.
    pub look_times: Vec<Vec<Duration>>,
}

/// The results of the whole run, with the wall times of the looks of each record.
///
/// Everything but wall times, the command and the machine is what the run would have given in one piece.
///
/// # Errors
/// When a shard is missing, doubled, incomplete or of another run.
pub fn merge(mut shards: Vec<ShardResults>) -> Result<(RunResults, Vec<Vec<Duration>>), MergeError> {
    let Some(first) = shards.first() else { return Err(MergeError::Nothing) };
    let count = shard_of(first)?.count;
    let mut folder_of: BTreeMap<u32, &str> = BTreeMap::new();
    for part in &shards {
        let shard = shard_of(part)?;
        check_same_run(first, part)?;
        if let Some(other) = folder_of.insert(shard.index, &part.folder) {
            return Err(MergeError::Doubled { shard, folders: [other.to_owned(), part.folder.clone()] });
        }
        check_complete(part, shard)?;
    }
    let missing: Vec<String> = (1..=count)
        .filter(|index| !folder_of.contains_key(index))
        .map(|index| Shard { index, count }.to_string())
        .collect();
    if !missing.is_empty() {
        return Err(MergeError::Missing { shards: missing.join(", ") });
    }

    shards.sort_by_key(|part| part.results.manifest.shard.map(|shard| shard.index));
    let sum = |time: fn(&RunTimings) -> f64| {
        Duration::from_secs_f64(shards.iter().map(|part| time(&part.results.timings)).sum::<f64>().max(0.0))
    };
    let (prepare, trials) = (sum(|timings| timings.prepare_s), sum(|timings| timings.trials_s));
    let started = shards.iter().map(|part| part.results.manifest.started_utc.clone()).min().unwrap_or_default();
    let finished = shards.iter().filter_map(|part| part.results.manifest.finished_utc.clone()).max();

    let mut ended = Vec::new();
    let mut whole = None;
    for part in shards {
        let RunResults { manifest, scenario, nodes, records, summary, .. } = part.results;
        let row_of = |name: &str| {
            let place = scenario.rows.iter().position(|row| row.name == name);
            place.expect("check_complete refuses rows that the scenario lacks")
        };
        let timed = records.into_iter().zip(part.look_times);
        ended.extend(timed.map(|(record, look_times)| TimedTrial { row: row_of(&record.row), record, look_times }));
        whole.get_or_insert((manifest, scenario, nodes, summary.free_area_m2));
    }
    let Some((manifest, scenario, nodes, free_area_m2)) = whole else { return Err(MergeError::Nothing) };
    let RunOutcome { records, look_times } = RunOutcome::of(ended);
    let command = Manifest::command_line();
    let results = RunResults {
        manifest: Manifest {
            command,
            shard: None,
            trials: records.len(),
            started_utc: started,
            finished_utc: finished,
            ..manifest
        },
        summary: Summary::new(&scenario, &nodes, free_area_m2, &records),
        timings: RunTimings::new(&scenario.rows, &records, &look_times, prepare, trials),
        nodes,
        records,
        scenario,
    };
    Ok((results, look_times))
}

fn shard_of(part: &ShardResults) -> Result<Shard, MergeError> {
    part.results.manifest.shard.ok_or_else(|| MergeError::Whole { folder: part.folder.clone() })
}

/// Whether two folders belong to one run: program, world, scenario, nodes and number of shards. Where the files of the
/// world lie is each machine's own business; their checksums decide.
fn check_same_run(first: &ShardResults, other: &ShardResults) -> Result<(), MergeError> {
    let (a, b) = (&first.results, &other.results);
    let count = |results: &RunResults| results.manifest.shard.map(|shard| shard.count);
    let visibility =
        |results: &RunResults| results.manifest.world.visibility.as_ref().map(|facts| facts.checksum.clone());
    let scenario = |results: &RunResults| {
        let scenario = &results.scenario;
        Scenario { world: scenario.world.without_paths(), ..scenario.clone() }
    };
    let what = if !a.manifest.is_of_same_program(&b.manifest) {
        "the version of the program"
    } else if a.manifest.world.checksum != b.manifest.world.checksum {
        "the world"
    } else if visibility(a) != visibility(b) {
        "what is visible in the world"
    } else if scenario(a) != scenario(b) {
        "the scenario"
    } else if a.nodes != b.nodes {
        "the nodes"
    } else if count(a) != count(b) {
        "the number of shards"
    } else {
        return Ok(());
    };
    Err(MergeError::Foreign { folder: other.folder.clone(), other: first.folder.clone(), what })
}

/// Whether a shard holds each of its trials once.
fn check_complete(part: &ShardResults, shard: Shard) -> Result<(), MergeError> {
    let RunResults { scenario, records, .. } = &part.results;
    let refused = |reason: String| MergeError::Incomplete { folder: part.folder.clone(), reason };
    let trials = shard.trials(scenario).map_err(|error| refused(error.to_string()))?;
    let settings = scenario.settings().map_err(|illegal| refused(illegal.to_string()))?;
    let expected = count_trials(&settings, &trials);
    if let Some(record) = records.iter().find(|record| scenario.row(Some(&record.row)).is_none()) {
        return Err(refused(format!("the scenario has no row {:?}", record.row)));
    }
    let mut found: Vec<(&str, u32)> = records.iter().map(|record| (record.row.as_str(), record.trial)).collect();
    found.sort_unstable();
    found.dedup();
    if let Some((row, trial)) = found.iter().find(|(_, trial)| !trials.contains(trial)) {
        return Err(refused(format!("trial {trial} of row {row:?} is not of this shard")));
    }
    if found.len() != expected || records.len() != expected {
        return Err(refused(format!(
            "it has {} trials, {} of them different, instead of {expected}",
            records.len(),
            found.len()
        )));
    }
    Ok(())
}

/// Why folders can't be put together.
#[derive(Debug, Clone, PartialEq, Eq, Error, Diagnostic)]
pub enum MergeError {
    /// No folder.
    #[error("there is no shard to merge")]
    Nothing,
    /// A run that is whole already.
    #[error("{folder} holds a whole run, not a shard")]
    #[diagnostic(help("shards are made by `edgeloc run --shard K/N`"))]
    Whole {
        /// The folder.
        folder: String,
    },
    /// A part is not there.
    #[error("shards are missing: {shards}")]
    #[diagnostic(help("run them with `edgeloc run SCENARIO --shard K/N` and give all their folders"))]
    Missing {
        /// Which.
        shards: String,
    },
    /// A part is there twice.
    #[error("shard {shard} is there twice: {} and {}", folders[0], folders[1])]
    #[diagnostic(help("leave one of the two out"))]
    Doubled {
        /// The shard.
        shard: Shard,
        /// Both folders.
        folders: [String; 2],
    },
    /// A part of another run.
    #[error("{folder} is not of the same run as {other}: {what} differs")]
    #[diagnostic(help("manifest.json and scenario.toml of both folders tell how; leave the wrong one out"))]
    Foreign {
        /// The folder that differs.
        folder: String,
        /// The folder it differs from.
        other: String,
        /// In what.
        what: &'static str,
    },
    /// A part does not hold its trials.
    #[error("{folder} is damaged: {reason}")]
    #[diagnostic(help("run this shard again"))]
    Incomplete {
        /// The folder.
        folder: String,
        /// What is wrong.
        reason: String,
    },
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::manifest::VisibilityFacts;
    use crate::report::sample;
    use crate::scenario::{Building, VisibilityChoice, WorldChoice};
    use std::path::Path;

    /// The sample's run in `count` parts.
    fn parts(count: u32) -> Vec<ShardResults> {
        let whole = sample::run().results;
        let part = |index| {
            let shard = Shard { index, count };
            let trials = shard.trials(&whole.scenario).expect("not too many");
            let mut results = whole.clone();
            results.records.retain(|record| trials.contains(&record.trial));
            results.manifest.shard = Some(shard);
            results.manifest.trials = results.records.len();
            let look_times = vec![vec![Duration::from_millis(12)]; results.records.len()];
            ShardResults { folder: format!("part-{index}"), results, look_times }
        };
        (1..=count).map(part).collect()
    }

    #[test]
    fn shards_in_any_order_give_the_whole_run() {
        let whole = sample::run().results;
        let mut shards = parts(3);
        shards.rotate_left(1);
        let (merged, look_times) = merge(shards).expect("all shards");
        assert_eq!((merged.records, merged.summary, merged.nodes), (whole.records, whole.summary, whole.nodes));
        assert_eq!((merged.manifest.shard, merged.manifest.trials), (None, 240));
        assert_eq!(look_times.len(), 240);
    }

    #[test]
    fn shards_made_in_different_folders_are_one_run() {
        let mut shards = parts(2);
        for part in &mut shards {
            let folder = Path::new("/").join(&part.folder);
            part.results.scenario.world = WorldChoice {
                building: Building::File { file: folder.join("hall.edgeworld") },
                visibility: VisibilityChoice::File(folder.join("hall.views")),
            };
            let file = Some(folder.join("hall.views").display().to_string());
            let checksum = "5".to_owned();
            part.results.manifest.world.visibility = Some(VisibilityFacts { file, viewpoints: 9, checksum });
        }
        assert_eq!(merge(shards).expect("one run").0.records.len(), 240);
    }

    #[test]
    fn missing_doubled_foreign_and_damaged_shards_are_named() {
        let refused = |change: fn(&mut Vec<ShardResults>)| {
            let mut shards = parts(3);
            change(&mut shards);
            merge(shards).expect_err("not one run").to_string()
        };
        let foreign = |what: &str| format!("part-3 is not of the same run as part-1: {what} differs");
        assert_eq!(refused(|shards| drop(shards.remove(1))), "shards are missing: 2/3");
        assert_eq!(refused(Vec::clear), "there is no shard to merge");
        assert_eq!(refused(|s| s[1].results.manifest.shard = None), "part-2 holds a whole run, not a shard");
        assert_eq!(refused(|s| s[2].results.scenario.seed = 2), foreign("the scenario"));
        assert_eq!(refused(|s| s[2].results.manifest.world.checksum = "0".to_owned()), foreign("the world"));
        let version = refused(|s| s[2].results.manifest.program_version = "9".to_owned());
        assert_eq!(version, foreign("the version of the program"));
        let count = refused(|s| s[2].results.manifest.shard = Some(Shard { index: 3, count: 4 }));
        assert_eq!(count, foreign("the number of shards"));
        let doubled = refused(|shards| shards.extend(parts(3).into_iter().skip(2)));
        assert_eq!(doubled, "shard 3/3 is there twice: part-3 and part-3");
        let torn = refused(|s| drop(s[0].results.records.pop()));
        assert!(torn.contains("part-1 is damaged"), "{torn}");
        let unknown = refused(|s| s[0].results.records[0].row = "far".to_owned());
        assert!(unknown.contains("the scenario has no row \"far\""), "{unknown}");
        let strange = refused(|s| s[0].results.records[0].trial = 59);
        assert!(strange.contains("trial 59 of row"), "{strange}");
    }
}

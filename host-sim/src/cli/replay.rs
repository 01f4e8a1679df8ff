//! `replay`: one trial of a finished run again, explained and compared with what the run recorded.

use super::attempt::{Attempt, JSON_FIELDS};
use super::console::{self, Format};
use super::report::{open, world_of};
use super::scenario_args::find_setting;
use super::world::file_stem;
use clap::Args;
use edgeloc_sim::monte_carlo::{Site, TrialRecord};
use miette::{IntoDiagnostic, Result, miette};
use serde_json::{Map, Value};
use std::path::PathBuf;

/// Replay one trial of a finished run, explained look by look; fails when it does not come out as recorded.
#[derive(Debug, Args)]
#[command(after_help = format!("Examples:\n  edgeloc replay runs/latest --trial 17\n  \
                        edgeloc replay runs/2026-01-31-paper --row 'anywhere, polarity' --trial 3\n\n\
                        JSON (--format json): {JSON_FIELDS}."))]
pub(super) struct Replay {
    /// Folder of the run.
    run: PathBuf,
    /// Trial of the row.
    #[arg(long, value_name = "I")]
    trial: u32,
    /// Row of the run; the first when not given.
    #[arg(long, value_name = "NAME")]
    row: Option<String>,
    /// Folder for the drawings [default: replay-<row>-<trial> in the run's folder]; drawings of the same name are
    /// overwritten.
    #[arg(short, long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

impl Replay {
    pub(super) fn execute(self) -> Result<()> {
        let (folder, results) = open(&self.run)?;
        let scenario = &results.scenario;
        let setting = find_setting(scenario, self.row.as_deref())?;
        let row = &setting.row;
        let recorded = results.records.iter().find(|record| record.row == row.name && record.trial == self.trial);
        let recorded = recorded.ok_or_else(|| {
            let last = setting.scenario.trials.saturating_sub(1);
            miette!(help = format!("trials count from 0 to {last}"), "there is no trial {} in the run", self.trial)
        })?;
        let site = Site::prepare(world_of(&results)?, &setting.scenario).into_diagnostic()?;
        let default_out = || folder.path().join(format!("replay-{}-{}", file_stem(&row.name), self.trial));
        let out = self.out.clone().unwrap_or_else(default_out);
        let attempt = Attempt::make(&site, &setting, self.trial, None, &out)?;
        attempt.print(self.format)?;
        if attempt.record != *recorded {
            return Err(miette!(
                help = "a run replays with the version of the program that made it; manifest.json names it",
                "the replay differs from the run in {}",
                differences(recorded, &attempt.record)
            ));
        }
        console::remark("the replay equals the run's record");
        Ok(())
    }
}

/// The fields in which two records differ, with both values.
fn differences(recorded: &TrialRecord, replayed: &TrialRecord) -> String {
    let fields = |record| match serde_json::to_value(record) {
        Ok(Value::Object(fields)) => fields,
        _ => Map::new(),
    };
    let (recorded, replayed) = (fields(recorded), fields(replayed));
    let differing = recorded.iter().filter(|(field, value)| replayed.get(*field) != Some(value));
    let words = differing.map(|(field, value)| {
        let now = replayed.get(field).unwrap_or(&Value::Null);
        format!("{field} (recorded {value}, replayed {now})")
    });
    words.collect::<Vec<_>>().join(", ")
}

//! The command line: one verb, one file; `world` has a folder for its own.
//!
//! Results go to standard output, progress, remarks and errors to standard error. Exit codes: 0 done, 1 failed, 2 wrong
//! usage of the command line.

mod attempt;
mod calibrate;
mod compare;
mod console;
mod coverage;
mod demo;
mod explore;
mod figures;
mod interruption;
mod learn;
mod locate;
mod map;
mod merge;
mod optimise;
mod power;
mod progress;
mod replay;
mod report;
mod run;
mod scale;
mod scenario_args;
mod sources;
mod summary_table;
mod trials;
mod validate;
mod vectors;
mod world;
mod worlds;

use clap::{Parser, Subcommand};
use miette::Result;
use std::process::ExitCode;
use tracing_subscriber::EnvFilter;
use vectors::Vectors;

/// Global localisation of a robot from straight stereo edges: worlds, maps, kidnapped-robot trials and their reports.
#[derive(Debug, Parser)]
#[command(name = "edgeloc", version, after_help = EXAMPLES, max_term_width = 110)]
struct Arguments {
    #[command(subcommand)]
    verb: Option<Verb>,
    /// Log to standard error what is done (-v) and in detail (-vv).
    #[arg(short, long, global = true, action = clap::ArgAction::Count)]
    verbose: u8,
    /// On x86-64, use no wider vector instructions than these: the same results bit for bit, only slower.
    #[arg(long, global = true, value_name = "SET")]
    vectors: Option<Vectors>,
}

const EXAMPLES: &str = "\
Examples:
  edgeloc                                        the demo: both localisers in the bundled office, a report
  edgeloc run smoke                              does everything work? a few seconds
  edgeloc world import small_house.world         make a world of a building
  edgeloc run paper --world small_house.edgeworld
  edgeloc validate                               the default localiser in five worlds, one table
  edgeloc replay runs/latest --trial 17          one trial of a run, look by look
  edgeloc compare runs/ONE runs/OTHER            is the one setting better? a paired test

Exit codes: 0 done, 1 failed, 2 wrong usage of the command line.";

#[derive(Debug, Subcommand)]
enum Verb {
    Demo(demo::Demo),
    #[command(subcommand)]
    World(world::World),
    Explore(explore::Explore),
    Learn(learn::Learn),
    Calibrate(calibrate::Calibrate),
    #[command(subcommand)]
    Map(map::Map),
    Locate(locate::Locate),
    Run(run::Run),
    Replay(replay::Replay),
    Report(report::Report),
    Figures(figures::Figures),
    Compare(compare::Compare),
    Merge(merge::Merge),
    Power(power::Power),
    Sources(sources::Sources),
    Optimise(optimise::Optimise),
    Validate(validate::Validate),
    Scale(scale::Scale),
}

impl Default for Verb {
    fn default() -> Self {
        Self::Demo(demo::Demo::default())
    }
}

/// Reads the command line and does what it asks.
pub(crate) fn main() -> ExitCode {
    let arguments = Arguments::parse();
    start_log(arguments.verbose);
    let done =
        arguments.vectors.map_or(Ok(()), Vectors::set).and_then(|()| execute(arguments.verb.unwrap_or_default()));
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            console::remark(&format!("{error:?}"));
            ExitCode::FAILURE
        }
    }
}

fn execute(verb: Verb) -> Result<()> {
    match verb {
        Verb::Demo(verb) => verb.execute(),
        Verb::World(verb) => verb.execute(),
        Verb::Explore(verb) => verb.execute(),
        Verb::Learn(verb) => verb.execute(),
        Verb::Calibrate(verb) => verb.execute(),
        Verb::Map(verb) => verb.execute(),
        Verb::Locate(verb) => verb.execute(),
        Verb::Run(verb) => verb.execute(),
        Verb::Replay(verb) => verb.execute(),
        Verb::Report(verb) => verb.execute(),
        Verb::Figures(verb) => verb.execute(),
        Verb::Compare(verb) => verb.execute(),
        Verb::Merge(verb) => verb.execute(),
        Verb::Power(verb) => verb.execute(),
        Verb::Sources(verb) => verb.execute(),
        Verb::Optimise(verb) => verb.execute(),
        Verb::Validate(verb) => verb.execute(),
        Verb::Scale(verb) => verb.execute(),
    }
}

/// Log lines of this program at the level asked for; `RUST_LOG` overrules.
fn start_log(verbose: u8) {
    let level =
        ["off", "edgeloc=info,edgeloc_sim=info", "edgeloc=debug,edgeloc_sim=debug"][usize::from(verbose.min(2))];
    let filter = EnvFilter::try_from_default_env().unwrap_or_else(|_| EnvFilter::new(level));
    tracing_subscriber::fmt().with_env_filter(filter).with_writer(std::io::stderr).init();
}

//! `cargo gate`: the one command that checks everything, alone on a fresh machine and in continuous integration.
//!
//! It runs its steps in order, streams what they print, goes on after a failure, and ends with a table of what
//! passed, failed and was skipped. It fails when a step failed, and under `CI=true` also when one was skipped.

mod arguments;
mod budgets;
mod setup;
mod steps;
mod summary;
mod workspace;

use std::io::Write;
use std::process::ExitCode;
use std::time::Instant;

use arguments::Request;
use steps::{STEPS, Step};
use summary::{StepReport, Summary};
use workspace::Workspace;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments::parse(&arguments, STEPS) {
        Ok(Request::Help) => {
            print!("{}", arguments::help(STEPS));
            ExitCode::SUCCESS
        }
        Ok(Request::Run { steps, is_blessing }) => run(&steps, is_blessing),
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// Runs the chosen steps one after the other and prints the summary.
fn run(chosen: &[&'static Step], is_blessing: bool) -> ExitCode {
    let workspace = match Workspace::find(is_blessing) {
        Ok(workspace) => workspace,
        Err(error) => {
            eprintln!("error: {error}");
            return ExitCode::from(2);
        }
    };
    let mut reports = Vec::with_capacity(chosen.len());
    for step in chosen {
        println!("\n==> {}: {}", step.name, step.about);
        flush();
        let start = Instant::now();
        let outcome = (step.run)(&workspace);
        reports.push(StepReport { name: step.name, outcome, elapsed: start.elapsed() });
    }
    let is_ci = std::env::var_os("CI").is_some_and(|value| value == "true");
    let summary = Summary { reports, is_ci };
    print!("\n{summary}");
    flush();
    if summary.is_success() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Pushes our own lines out before a child writes its own; a closed pipe is the reader's choice, not an error.
fn flush() {
    let _ = std::io::stdout().flush();
}

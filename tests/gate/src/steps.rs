//! The steps of the gate, in the order they run.

use std::process::Command;

use crate::budgets::{self, Budgets, Counts};
use crate::setup::{self, Program};
use crate::summary::Outcome;
use crate::workspace::{Workspace, run, run_all, run_together};

/// One named check.
#[derive(Debug)]
pub(crate) struct Step {
    /// What one types to run it alone.
    pub(crate) name: &'static str,
    /// What it checks, in a line.
    pub(crate) about: &'static str,
    /// Whether the full gate runs it.
    pub(crate) is_in_full: bool,
    /// Whether `cargo gate quick` runs it.
    pub(crate) is_quick: bool,
    /// The check itself.
    pub(crate) run: fn(&Workspace) -> Outcome,
}

/// Every step, in order.
pub(crate) static STEPS: &[Step] = &[
    full("setup", "targets and system packages that the other steps need", setup::run_setup),
    quick("format", "the sources are formatted", format),
    quick("lint", "compiler and clippy have nothing to say", lint),
    full("docs", "the documentation builds and its links hold", docs),
    full("tests", "unit, whole-system, layering and documentation tests", tests),
    Step {
        name: "units",
        about: "the tests that take seconds: unit tests and layering",
        is_in_full: false,
        is_quick: true,
        run: units,
    },
    full("buildings", "the data of real buildings is there, so that their tests did run", buildings),
    full("benches", "every benchmark runs once", benches),
    full("thumb", "the library builds for Cortex-M without std", thumb),
    full("qemu", "kernels and localizer on emulated Cortex-M4, M7 and M33 give the host's bits, within budget", qemu),
    full("aarch64", "the same on an emulated 64-bit Arm", aarch64),
    full("wasm", "the same in WebAssembly", wasm),
    Step {
        name: "miri",
        about: "Miri on the tests that hold the SSE2 and AVX2 bodies against each other (needs a nightly toolchain)",
        is_in_full: false,
        is_quick: false,
        run: miri,
    },
];

/// Targets the library is built for to show that it needs no `std`.
pub(crate) const THUMB_TARGETS: [&str; 2] = ["thumbv7em-none-eabihf", "thumbv8m.main-none-eabihf"];

/// The boards that QEMU emulates; each folder holds the board's target and its runner.
const QEMU_BOARDS: [&str; 3] = ["boards/qemu-mps2-an386", "boards/qemu-mps2-an500", "boards/qemu-mps2-an505"];

/// What the boards may cost.
const BUDGETS: &str = "boards/budgets.toml";

/// A 64-bit Arm under Linux, and WebAssembly: their folders hold targets and runners too.
const AARCH64_BOARD: &str = "boards/linux";
const WASM_BOARD: &str = "boards/wasm";

/// The targets of those two.
pub(crate) const HOSTED_TARGETS: [&str; 2] = ["aarch64-unknown-linux-musl", "wasm32-unknown-unknown"];

const fn full(name: &'static str, about: &'static str, run: fn(&Workspace) -> Outcome) -> Step {
    Step { name, about, is_in_full: true, is_quick: false, run }
}

const fn quick(name: &'static str, about: &'static str, run: fn(&Workspace) -> Outcome) -> Step {
    Step { name, about, is_in_full: true, is_quick: true, run }
}

fn format(workspace: &Workspace) -> Outcome {
    run_all([workspace.cargo("", "fmt --all --check"), workspace.cargo("boards", "fmt --all --check")])
}

fn lint(workspace: &Workspace) -> Outcome {
    let ours = workspace.cargo("", "clippy --locked --workspace --all-targets -- -D warnings");
    let boards = QEMU_BOARDS.into_iter().chain([AARCH64_BOARD, WASM_BOARD]);
    run_all([ours].into_iter().chain(boards.map(|board| workspace.cargo(board, "clippy --locked -- -D warnings"))))
}

fn docs(workspace: &Workspace) -> Outcome {
    let strict = |mut command: Command| {
        command.env("RUSTDOCFLAGS", "-D warnings");
        command
    };
    run_all([
        strict(workspace.cargo("", "doc --locked --workspace --no-deps")),
        strict(
            workspace.cargo(QEMU_BOARDS[0], "doc --locked --no-deps --package edgeloc-firmware --package edgeloc-qemu"),
        ),
    ])
}

fn tests(workspace: &Workspace) -> Outcome {
    run_all([workspace.cargo("", "test --locked --workspace --no-fail-fast")])
}

fn units(workspace: &Workspace) -> Outcome {
    run_all([
        workspace.cargo("", "test --locked --workspace --no-fail-fast --lib --bins"),
        workspace.cargo("", "test --locked --package edgeloc-tests --test layering"),
    ])
}

/// Tests that need the data of real buildings say `SKIPPED:` when it is absent, but the test runner keeps the words of
/// passing tests to itself: so the gate says it.
fn buildings(workspace: &Workspace) -> Outcome {
    let folder = workspace.data_folder();
    if folder.join("aws_small_house").is_dir() {
        return Outcome::Passed;
    }
    Outcome::Skipped(format!(
        "no folder aws_small_house in {} (set EDGELOC_DATA): tests on real buildings did not run",
        folder.display()
    ))
}

/// `cargo test` rather than `cargo bench`: criterion then runs each benchmark once, without a second optimised build.
fn benches(workspace: &Workspace) -> Outcome {
    run_all([workspace.cargo("", "test --locked --package edgeloc-benches --benches")])
}

fn thumb(workspace: &Workspace) -> Outcome {
    run_all(
        THUMB_TARGETS.map(|target| workspace.cargo("", &format!("build --locked --package edgeloc --target {target}"))),
    )
}

/// Each board's own cargo configuration names its target and its runner, which ends the emulator after a time limit.
/// Emulators are slow and have one thread: once everything is built, they run side by side.
fn qemu(workspace: &Workspace) -> Outcome {
    if let Some(reason) = setup::missing(setup::ARM_EMULATOR) {
        return Outcome::Skipped(reason);
    }
    let build = run_all(QEMU_BOARDS.map(|board| workspace.cargo(board, "build --locked --release")));
    if build != Outcome::Passed {
        return build;
    }
    match run_together(QEMU_BOARDS.map(|board| workspace.cargo(board, "run --quiet --locked --release"))) {
        Ok(outputs) => hold_budgets(workspace, &outputs),
        Err(reason) => Outcome::Failed(reason),
    }
}

/// Holds what the boards counted against their budgets, or makes it the budgets.
fn hold_budgets(workspace: &Workspace, outputs: &[String]) -> Outcome {
    let path = workspace.file(BUDGETS);
    let names = QEMU_BOARDS.map(|board| board.trim_start_matches("boards/").to_owned());
    let counted: Budgets = names.into_iter().zip(outputs.iter().map(|output| budgets::counted(output))).collect();
    if workspace.is_blessing() {
        return match budgets::write(&path, &counted) {
            Ok(()) => Outcome::Passed,
            Err(error) => Outcome::Failed(format!("{BUDGETS} can't be written: {error}")),
        };
    }
    let committed = match budgets::read(&path) {
        Ok(committed) => committed,
        Err(error) => return Outcome::Failed(format!("{BUDGETS} can't be read: {error}")),
    };
    let hold = |(board, counts): (&String, &Counts)| {
        budgets::violations(board, committed.get(board), counts, |line| println!("{line}"))
    };
    let violations: Vec<String> = counted.iter().flat_map(hold).collect();
    if violations.is_empty() { Outcome::Passed } else { Outcome::Failed(violations.join("; ")) }
}

fn aarch64(workspace: &Workspace) -> Outcome {
    run_board(workspace, AARCH64_BOARD, setup::AARCH64_EMULATOR)
}

fn wasm(workspace: &Workspace) -> Outcome {
    run_board(workspace, WASM_BOARD, setup::WASM_ENGINE)
}

/// Interprets the tests that hold the bodies against each other, on one drawn input each; that of whole histograms would take
/// minutes. The square root is not to be assembly there.
fn miri(workspace: &Workspace) -> Outcome {
    let nightly = |arguments: &str| {
        let mut command = workspace.tool("rustup", "");
        command.args(["run", "nightly", "cargo", "miri"]).args(arguments.split_whitespace());
        command
    };
    if run(nightly("--version")).is_err() {
        let remedy = "rustup toolchain install nightly --profile minimal --component miri --component rust-src";
        return Outcome::Skipped(format!("no nightly toolchain with Miri; install it: {remedy}"));
    }
    let mut command = nightly(
        "test --locked --package edgeloc --features libm/force-soft-floats --lib -- same_coefficients same_bytes",
    );
    command.env("PROPTEST_CASES", "1").env("MIRIFLAGS", "-Zmiri-disable-isolation");
    command.env("RUSTFLAGS", "-Ctarget-feature=+avx2,+bmi1,+bmi2,+lzcnt,+popcnt");
    match run_together([command]) {
        Ok([output]) if output.contains("ok. 2 passed") => Outcome::Passed,
        Ok(_) => Outcome::Failed("the tests to interpret are not there by these names".to_owned()),
        Err(reason) => Outcome::Failed(reason),
    }
}

fn run_board(workspace: &Workspace, board: &str, runner: Program) -> Outcome {
    match setup::missing(runner) {
        Some(reason) => Outcome::Skipped(reason),
        None => run_all([workspace.cargo(board, "run --locked --release")]),
    }
}

#[cfg(test)]
mod tests_of_the_table {
    use super::*;

    #[test]
    fn names_are_unique_and_none_is_quick() {
        for (index, step) in STEPS.iter().enumerate() {
            assert_ne!(step.name, "quick");
            assert!(STEPS[..index].iter().all(|earlier| earlier.name != step.name), "{} twice", step.name);
        }
    }

    #[test]
    fn what_a_step_needs_is_set_up_before_it() {
        assert_eq!(STEPS[0].name, "setup");
    }
}

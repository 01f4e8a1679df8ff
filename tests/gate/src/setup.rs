//! What the steps need on the machine: compiler targets through rustup, programs through Debian's packages.

use std::process::{Command, Stdio};

use crate::steps::{HOSTED_TARGETS, THUMB_TARGETS};
use crate::summary::Outcome;
use crate::workspace::{Workspace, run};

/// A program and the Debian package that brings it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Program {
    name: &'static str,
    package: &'static str,
}

/// Emulates the Cortex-M boards.
pub(crate) const ARM_EMULATOR: Program = Program { name: "qemu-system-arm", package: "qemu-system-arm" };

/// Runs programs of a 64-bit Arm.
pub(crate) const AARCH64_EMULATOR: Program = Program { name: "qemu-aarch64", package: "qemu-user" };

/// Runs WebAssembly.
pub(crate) const WASM_ENGINE: Program = Program { name: "node", package: "nodejs" };

/// Tests the editor's page.
const BROWSER: Program = Program { name: "chromium", package: "chromium" };

/// All programs that steps need.
const PROGRAMS: [Program; 4] = [ARM_EMULATOR, AARCH64_EMULATOR, WASM_ENGINE, BROWSER];

/// The one command, before the names of packages.
const INSTALL: &str = "apt-get install --no-install-recommends";

/// Installs what is missing. A target that can't be added is a failure; a package that needs another user is a skip.
pub(crate) fn run_setup(workspace: &Workspace) -> Outcome {
    if let Err(reason) = add_targets(workspace) {
        return Outcome::Failed(reason);
    }
    let missing = PROGRAMS.into_iter().filter(|program| !is_present(program.name));
    let missing = missing.map(|program| program.package).collect::<Vec<_>>().join(" ");
    if missing.is_empty() {
        return Outcome::Passed;
    }
    if !is_root() {
        return Outcome::Skipped(format!("missing: {missing}; install: sudo {INSTALL} {missing}"));
    }
    match install(workspace, &missing) {
        Ok(()) => Outcome::Passed,
        Err(reason) => Outcome::Failed(reason),
    }
}

/// Why a program can't be used, with the remedy; `None` when it is there.
pub(crate) fn missing(Program { name, package }: Program) -> Option<String> {
    (!is_present(name)).then(|| format!("{name} is missing; install it: sudo {INSTALL} {package}"))
}

/// Adds the targets that are not installed yet; without a missing one the network is not touched.
fn add_targets(workspace: &Workspace) -> Result<(), String> {
    let listed = workspace.tool("rustup", "").args(["target", "list", "--installed"]).output();
    let listed = listed.map_err(|error| format!("`rustup target list` can't be started: {error}"))?;
    let installed = String::from_utf8_lossy(&listed.stdout);
    let missing = missing_targets(&installed);
    if missing.is_empty() {
        return Ok(());
    }
    let mut command = workspace.tool("rustup", "");
    command.args(["target", "add"]).args(missing);
    run(command)
}

/// The targets that a list of installed ones, one a line, lacks.
fn missing_targets(installed: &str) -> Vec<&'static str> {
    let targets = THUMB_TARGETS.into_iter().chain(HOSTED_TARGETS);
    targets.filter(|target| installed.lines().all(|line| line.trim() != *target)).collect()
}

fn install(workspace: &Workspace, packages: &str) -> Result<(), String> {
    let apt = |arguments: &str| {
        let mut command = workspace.tool("apt-get", "");
        command.env("DEBIAN_FRONTEND", "noninteractive").args(arguments.split_whitespace());
        run(command)
    };
    // A mirror that can't be reached matters only if a package can't be had: the installation decides.
    let _ = apt("update");
    apt(&format!("install --yes --no-install-recommends {packages}"))
}

fn is_present(program: &str) -> bool {
    let quiet = Command::new(program).arg("--version").stdin(Stdio::null()).stdout(Stdio::null()).status();
    quiet.is_ok_and(|status| status.success())
}

fn is_root() -> bool {
    Command::new("id").arg("-u").output().is_ok_and(|output| output.stdout == b"0\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_targets_not_yet_installed_are_added() {
        let all = [THUMB_TARGETS, HOSTED_TARGETS].concat();
        assert_eq!(missing_targets(""), all);
        assert_eq!(missing_targets(&format!("x86_64-unknown-linux-gnu\n{}\n", all[0])), all[1..]);
        assert!(missing_targets(&all.join("\n")).is_empty());
    }

    #[test]
    fn a_program_that_does_not_exist_is_not_present() {
        assert!(!is_present("no-such-program-anywhere"));
    }
}

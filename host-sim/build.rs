//! Tells the program which commit it was built from, for the manifests of its runs: `-dirty` follows when the program's
//! sources differ from that commit. Silent outside the workspace's own repository.

use std::path::Path;
use std::process::Command;

/// What the program is made of, from this folder.
const SOURCES: [&str; 8] =
    ["build.rs", "Cargo.toml", "scenarios", "src", "../Cargo.lock", "../Cargo.toml", "../core", "../README.md"];

fn main() {
    // A change of a source can turn the tree dirty or clean again.
    for source in SOURCES {
        println!("cargo::rerun-if-changed={source}");
    }
    // The workspace may have been unpacked inside a repository that has nothing to do with it.
    if git(&["rev-parse", "--show-prefix"]).as_deref() != Some("host-sim/") {
        return;
    }
    if let Some(commit) = git(&["rev-parse", "HEAD"]) {
        let changes = git(&[&["status", "--porcelain", "--"][..], &SOURCES].concat());
        let mark = if changes.is_some_and(|changes| changes.is_empty()) { "" } else { "-dirty" };
        println!("cargo::rustc-env=EDGELOC_GIT_COMMIT={commit}{mark}");
    }
    // The log of HEAD changes with every commit and checkout.
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"])
        && Path::new(&log).exists()
    {
        println!("cargo::rerun-if-changed={log}");
    }
}

fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
}

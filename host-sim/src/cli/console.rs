//! Standard output and files: tables, JSON, and never a file overwritten unasked.

use clap::ValueEnum;
use comfy_table::{ContentArrangement, Table, presets};
use edgeloc_sim::whole_file;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::Serialize;
use std::io::{ErrorKind, Write};
use std::path::Path;

/// How results are printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(super) enum Format {
    /// Tables and sentences for people.
    #[default]
    Text,
    /// One JSON value for programs; units stand in the names of the fields.
    Json,
}

/// Prints to standard output.
pub(super) fn print(text: &str) -> Result<()> {
    let mut output = std::io::stdout().lock();
    let ending = if text.ends_with('\n') { "" } else { "\n" };
    match write!(output, "{text}{ending}").and_then(|()| output.flush()) {
        // Whoever read the output has seen enough: `edgeloc ... | head`.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        done => done.into_diagnostic().wrap_err("standard output can't be written"),
    }
}

/// Prints a value as JSON.
pub(super) fn print_json(value: &impl Serialize) -> Result<()> {
    print(&serde_json::to_string_pretty(value).into_diagnostic()?)
}

/// Tells something that is no result, on standard error.
pub(super) fn remark(text: &str) {
    // Without a standard error there is nobody to tell.
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// A number of things: `1 node`, `2 nodes`.
pub(super) fn count(number: impl Into<u64>, what: &str) -> String {
    match number.into() {
        1 => format!("1 {what}"),
        number => format!("{number} {what}s"),
    }
}

/// An empty table in the program's style.
pub(super) fn table(header: &[&str]) -> Table {
    let mut table = Table::new();
    table.load_style(presets::UTF8_FULL_CONDENSED).set_content_arrangement(ContentArrangement::Dynamic);
    table.set_header(header.iter().copied());
    table
}

/// A table of one fact a line.
pub(super) fn facts(lines: &[(&str, String)]) -> Table {
    let mut table = Table::new();
    table.load_style(presets::NOTHING).set_content_arrangement(ContentArrangement::Dynamic);
    for (name, value) in lines {
        table.add_row([*name, value.as_str()]);
    }
    table
}

/// Refuses to overwrite a file unless `force`; says so when it will.
pub(super) fn check_overwrite(path: &Path, force: bool) -> Result<()> {
    if !path.exists() {
        return Ok(());
    }
    if force {
        remark(&format!("{} is overwritten", path.display()));
        return Ok(());
    }
    Err(miette!(help = "choose another name, or overwrite it with --force", "{} exists already", path.display()))
}

/// Writes a file whole or not at all.
pub(super) fn write_file(path: &Path, content: &[u8]) -> Result<()> {
    whole_file::write(path, content).into_diagnostic().wrap_err_with(|| format!("{} can't be written", path.display()))
}

//! The arrows of the house, held as tables: which module and which package may know which, where `unsafe` lives, and
//! where float functions come from.
//!
//! The sources are scanned as tokens, comments and literals left out, so a link in a doc comment is no arrow. Every
//! check is shown to fail on a sample beside it.

mod float_functions;
mod modules;
mod packages;
mod source;
mod unsafe_addresses;

use std::fs;
use std::path::{Path, PathBuf};

/// The repository's root.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Every file below `folder` of the repository that `is_wanted`, as path from the root and text, in path order; what is
/// built and what is hidden is left out.
fn files_below(folder: &str, is_wanted: fn(&Path) -> bool) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut folders = vec![PathBuf::from(folder)];
    while let Some(folder) = folders.pop() {
        let entries = fs::read_dir(root().join(&folder)).unwrap_or_else(|error| panic!("{folder:?}: {error}"));
        for entry in entries {
            let entry = entry.expect("a folder that opens can be listed");
            let name = entry.file_name().into_string().expect("file names are UTF-8");
            let path = folder.join(&name);
            if entry.file_type().expect("a listed file has a type").is_dir() {
                if name != "target" && !name.starts_with('.') {
                    folders.push(path);
                }
            } else if is_wanted(&path) {
                let text = fs::read_to_string(root().join(&path)).expect("sources are UTF-8");
                found.push((path.to_str().expect("paths are UTF-8").to_owned(), text));
            }
        }
    }
    found.sort();
    found
}

/// Every Rust source below `folder`.
fn rust_files_below(folder: &str) -> Vec<(String, String)> {
    files_below(folder, |path| path.extension().is_some_and(|extension| extension == "rs"))
}

#[test]
fn every_source_of_the_repository_is_found() {
    let paths: Vec<String> = rust_files_below("tests").into_iter().map(|(path, _)| path).collect();
    assert!(paths.contains(&"tests/tests/layering/main.rs".to_owned()), "{paths:?}");
}

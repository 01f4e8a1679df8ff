//! The folders an import may read from, and bounded reading of their files.
//!
//! A world names its models and meshes by `model://` and relative paths. They are looked for in the world's own
//! folder, in the `models/` folder beside or inside it, and in folders the user adds; nothing outside these is read,
//! however the path or a symbolic link is laid. Letter case is forgiven and named, since worlds are written on
//! machines that don't tell it.

use super::ImportProblem;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Component, Path, PathBuf};

/// Largest file read, in bytes: 128 MiB, thirty times the largest mesh of a furnished flat.
const MAX_FILE_BYTES: u64 = 128 << 20;

/// Most bytes read in one import: 1 GiB.
const MAX_TOTAL_BYTES: u64 = 1 << 30;

/// A file found in the library.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct FoundFile {
    /// Canonical path.
    pub(super) path: PathBuf,
    /// The path as people should read it: relative to its root.
    pub(super) shown: String,
}

/// The folders searched, and how much was read from them.
#[derive(Debug)]
pub(super) struct Library {
    /// Canonical folders; no file outside them is read.
    roots: Vec<PathBuf>,
    /// Folders whose sub-folders are models.
    model_folders: Vec<PathBuf>,
    /// The folder of the imported file.
    home: PathBuf,
    bytes_read: u64,
}

impl Library {
    /// The library around the imported file.
    pub(super) fn around(file: &Path, extra_model_folders: &[PathBuf]) -> Result<Self, ImportProblem> {
        let canonical = |path: &Path| {
            path.canonicalize().map_err(|error| {
                ImportProblem::new(path.display().to_string(), error.to_string(), "check the path and its permissions")
            })
        };
        let parent = file.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let home = canonical(parent)?;
        let beside = home.parent().map(|grandparent| grandparent.join("models"));
        let mut model_folders = vec![home.join("models"), home.clone()];
        model_folders.extend(beside);
        let mut roots = Vec::new();
        for folder in &model_folders {
            if let Ok(folder) = folder.canonicalize() {
                roots.push(folder);
            }
        }
        for folder in extra_model_folders {
            let folder = canonical(folder)?;
            model_folders.push(folder.clone());
            roots.push(folder);
        }
        Ok(Self { roots, model_folders, home, bytes_read: 0 })
    }

    /// The file the import began with, wherever it is.
    pub(super) fn start(&self, file: &Path) -> FoundFile {
        let shown = file.file_name().map_or_else(|| file.display().to_string(), |name| name.to_string_lossy().into());
        FoundFile { path: file.to_path_buf(), shown }
    }

    /// Folders in which models are looked for, for messages.
    pub(super) fn searched(&self) -> String {
        let folders: Vec<String> = self.model_folders.iter().map(|folder| folder.display().to_string()).collect();
        folders.join(", ")
    }

    /// Finds what `uri` names, seen from a file in `folder`. A letter case that differs is noted in `notes`.
    pub(super) fn find(&self, uri: &str, folder: &Path, notes: &mut Vec<String>) -> Result<FoundFile, String> {
        if let Some(rest) = uri.strip_prefix("model://") {
            return self.find_in_models(rest, notes);
        }
        let relative = uri.strip_prefix("file://").unwrap_or(uri);
        if relative.contains("://") {
            return Err(format!("{uri}: only model://, file:// and relative paths are read"));
        }
        let mut bases = vec![folder.to_path_buf()];
        bases.extend(self.roots.iter().cloned());
        self.find_below(&bases, relative, notes)
    }

    fn find_in_models(&self, rest: &str, notes: &mut Vec<String>) -> Result<FoundFile, String> {
        let (model, inside) = rest.split_once('/').unwrap_or((rest, ""));
        // A model's own file names its meshes by the model's name, which is the name of its folder.
        let is_home = self.home.file_name().is_some_and(|name| name.eq_ignore_ascii_case(model));
        if is_home && let Ok(found) = self.find_below(std::slice::from_ref(&self.home), inside, notes) {
            return Ok(found);
        }
        self.find_below(&self.model_folders, rest, notes)
    }

    fn find_below(&self, bases: &[PathBuf], relative: &str, notes: &mut Vec<String>) -> Result<FoundFile, String> {
        let mut refusal = None;
        for base in bases {
            let Some(path) = follow(base, Path::new(relative), notes) else { continue };
            let Ok(path) = path.canonicalize() else { continue };
            if let Some(root) = self.roots.iter().find(|root| path.starts_with(root)) {
                let below = path.strip_prefix(root).unwrap_or(&path);
                return Ok(FoundFile { shown: below.display().to_string(), path });
            }
            refusal = Some(format!("{relative} lies outside the world's folders"));
        }
        Err(refusal.unwrap_or_else(|| format!("{relative} not found")))
    }

    /// Reads a file whole.
    pub(super) fn read(&mut self, file: &FoundFile) -> Result<Vec<u8>, ImportProblem> {
        let fail = |what: String, remedy: &str| Err(ImportProblem::new(&file.shown, what, remedy));
        let length = match fs::metadata(&file.path) {
            Ok(metadata) if metadata.is_file() => metadata.len(),
            Ok(_) => return fail("is not a file".into(), "name a file"),
            Err(error) => return fail(error.to_string(), "check the path and its permissions"),
        };
        if length > MAX_FILE_BYTES {
            let what = format!("has {length} bytes, more than the {MAX_FILE_BYTES} that are read");
            return fail(what, "split or simplify the mesh");
        }
        self.bytes_read += length;
        if self.bytes_read > MAX_TOTAL_BYTES {
            let what = format!("brings this import beyond {MAX_TOTAL_BYTES} bytes");
            return fail(what, "split the world");
        }
        let mut bytes = Vec::new();
        // A file that grows meanwhile is still bounded.
        match File::open(&file.path).and_then(|open| open.take(MAX_FILE_BYTES).read_to_end(&mut bytes)) {
            Ok(_) => Ok(bytes),
            Err(error) => fail(error.to_string(), "check the file and its permissions"),
        }
    }
}

/// Walks `relative` down from `base`, forgiving letter case; `None` if there is no such path.
fn follow(base: &Path, relative: &Path, notes: &mut Vec<String>) -> Option<PathBuf> {
    let mut path = base.to_path_buf();
    for component in relative.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => path.push(".."),
            Component::RootDir | Component::Prefix(_) => path = PathBuf::from(component.as_os_str()),
            Component::Normal(name) => {
                if path.join(name).symlink_metadata().is_ok() {
                    path.push(name);
                    continue;
                }
                let mut alike: Vec<_> = fs::read_dir(&path)
                    .ok()?
                    .filter_map(|entry| entry.ok().map(|entry| entry.file_name()))
                    .filter(|entry| entry.eq_ignore_ascii_case(name))
                    .collect();
                alike.sort();
                let found = alike.into_iter().next()?;
                notes.push(format!("{} is spelt {} on disk", name.display(), found.display()));
                path.push(found);
            }
        }
    }
    path.exists().then_some(path)
}

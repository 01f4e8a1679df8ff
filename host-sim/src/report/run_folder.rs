//! The folder of a run: `manifest.json`, `scenario.toml`, `trials.csv`, `nodes.csv`, `summary.json`, `timings.json`,
//! `look_times.csv`, `report.html`.
//!
//! Every file but the journal is written whole or not at all, so that none is ever half there. A folder is never reused. It is made when the run begins, with `manifest.json`, `scenario.toml` and a journal of the trials that ended, from
//! which an interrupted run goes on; when the run is complete, the results take the journal's place.

use super::timings::{look_times_csv, read_look_times};
use super::{Journal, Manifest, RunTimings, Summary, trials_csv};
use crate::monte_carlo::TrialRecord;
use crate::scenario::{Row, Scenario, ScenarioError};
use crate::whole_file;
use edgeloc::geometry::Point2;
use miette::Diagnostic;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::Duration;
use thiserror::Error;

/// Longest file read back \[bytes\]: 4096 for each trial of the largest run. The longest line of `trials.csv` has about 450
/// of a record with a row name of nothing but quotes, 1600 of a message with nothing but wide characters, and 30 for each
/// of some 50 parameters.
const MAX_FILE_BYTES: u64 = 4096 * Scenario::MAX_TOTAL_TRIALS;

/// All that is known of a finished run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunResults {
    /// Where the run comes from.
    pub manifest: Manifest,
    /// What was run.
    pub scenario: Scenario,
    /// Where the nodes of each row are, world frame.
    pub nodes: Vec<Vec<Point2>>,
    /// One record a trial.
    pub records: Vec<TrialRecord>,
    /// The figures.
    pub summary: Summary,
    /// The wall times.
    pub timings: RunTimings,
}

/// The folder of a run.
#[derive(Debug, Clone)]
pub struct RunFolder {
    path: PathBuf,
}

/// A line of `nodes.csv`.
#[derive(Serialize, Deserialize)]
struct NodeLine {
    row: String,
    node: usize,
    x_m: f32,
    y_m: f32,
}

impl RunFolder {
    /// A new folder `<date>-<name>` in `parent`, with a number when that is taken.
    ///
    /// # Errors
    /// When it can't be made.
    pub fn create(parent: &Path, date: &str, name: &str) -> Result<Self, RunFolderError> {
        let failed = |path: &Path| RunFolderError::writing(path.to_owned());
        fs::create_dir_all(parent).map_err(failed(parent))?;
        for attempt in 1.. {
            let suffix = if attempt == 1 { String::new() } else { format!("-{attempt}") };
            let path = parent.join(format!("{date}-{name}{suffix}"));
            match fs::create_dir(&path) {
                Ok(()) => return Ok(Self { path }),
                Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists && attempt < 100_000 => {}
                Err(error) => return Err(failed(&path)(error)),
            }
        }
        unreachable!("the last attempt returns")
    }

    /// The folder at `path`, made when there is none: for one of several runs in a folder.
    ///
    /// # Errors
    /// When it can't be made.
    pub fn at(path: PathBuf) -> Result<Self, RunFolderError> {
        match fs::create_dir_all(&path) {
            Ok(()) => Ok(Self { path }),
            Err(error) => Err(RunFolderError::writing(path)(error)),
        }
    }

    /// The folder of a finished run.
    ///
    /// # Errors
    /// When it is not one.
    pub fn open(path: &Path) -> Result<Self, RunFolderError> {
        let (folder, manifest) = Self::open_any(path)?;
        match manifest.finished_utc {
            Some(_) => Ok(folder),
            None => Err(RunFolderError::Unfinished { path: path.to_owned() }),
        }
    }

    /// The folder of a run that was interrupted, with what is known of it.
    ///
    /// # Errors
    /// When it is not one.
    pub fn open_unfinished(path: &Path) -> Result<(Self, Manifest, Scenario), RunFolderError> {
        let (folder, manifest) = Self::open_any(path)?;
        if manifest.finished_utc.is_some() {
            return Err(RunFolderError::Finished { path: path.to_owned() });
        }
        let scenario = folder.read_scenario()?;
        Ok((folder, manifest, scenario))
    }

    fn open_any(path: &Path) -> Result<(Self, Manifest), RunFolderError> {
        let folder = Self { path: path.to_owned() };
        if !path.join("manifest.json").is_file() {
            return Err(RunFolderError::NotARun { path: path.to_owned() });
        }
        let manifest = folder.read_json("manifest.json")?;
        Ok((folder, manifest))
    }

    /// Writes what is known when a run begins.
    ///
    /// # Errors
    /// When a file can't be written.
    pub fn begin(&self, manifest: &Manifest, scenario: &Scenario) -> Result<(), RunFolderError> {
        self.write("scenario.toml", scenario.to_toml().as_bytes())?;
        self.write("manifest.json", &to_json(manifest))?;
        Ok(())
    }

    /// Its path.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a file whole or not at all.
    ///
    /// # Errors
    /// When it can't be written.
    pub fn write(&self, file: &str, content: &[u8]) -> Result<PathBuf, RunFolderError> {
        let path = self.path.join(file);
        whole_file::write(&path, content).map_err(RunFolderError::writing(path.clone()))?;
        Ok(path)
    }

    /// Writes the results, the manifest last.
    ///
    /// # Errors
    /// When a file can't be written.
    pub fn write_results(&self, results: &RunResults, look_times: &[Vec<Duration>]) -> Result<(), RunFolderError> {
        let table = |path: &str, bytes: Result<Vec<u8>, csv::Error>| {
            let bytes = bytes.map_err(|error| RunFolderError::writing(self.path.join(path))(error.into()))?;
            self.write(path, &bytes)
        };
        let settings = results.scenario.settings().map_err(|illegal| self.damaged("scenario.toml", &illegal))?;
        let nodes = results.scenario.rows.iter().zip(&results.nodes).flat_map(|(row, nodes)| {
            let line = |(node, at): (usize, &Point2)| NodeLine { row: row.name.clone(), node, x_m: at.x, y_m: at.y };
            nodes.iter().enumerate().map(line)
        });
        self.write("scenario.toml", results.scenario.to_toml().as_bytes())?;
        table("trials.csv", trials_csv::write(&results.records, &settings))?;
        table("nodes.csv", to_csv(nodes))?;
        table("look_times.csv", look_times_csv(&results.records, look_times))?;
        self.write("summary.json", &to_json(&results.summary))?;
        self.write("timings.json", &to_json(&results.timings))?;
        self.write("manifest.json", &to_json(&results.manifest))?;
        // The results, by now on the disk, hold all that is in it. Without it nothing is lost, with it nothing is wrong.
        let _ = fs::remove_file(self.path.join(Journal::FILE));
        Ok(())
    }

    /// Reads the results back.
    ///
    /// # Errors
    /// When a file is missing or is not what it should be.
    pub fn read_results(&self) -> Result<RunResults, RunFolderError> {
        let scenario = self.read_scenario()?;
        let settings = scenario.settings().map_err(|illegal| self.damaged("scenario.toml", &illegal))?;
        let lines: Vec<NodeLine> = self.read_table("nodes.csv")?;
        let nodes_of = |row: &Row| {
            let lines = lines.iter().filter(|line| line.row == row.name);
            lines.map(|line| Point2::new(line.x_m, line.y_m)).collect()
        };
        let records = trials_csv::read(&self.read("trials.csv")?, &settings)
            .map_err(|reason| self.damaged("trials.csv", &reason))?;
        Ok(RunResults {
            manifest: self.read_json("manifest.json")?,
            nodes: scenario.rows.iter().map(nodes_of).collect(),
            records,
            scenario,
            summary: self.read_json("summary.json")?,
            timings: self.read_json("timings.json")?,
        })
    }

    fn read_scenario(&self) -> Result<Scenario, RunFolderError> {
        let text = self.read("scenario.toml")?;
        let scenario = Scenario::parse(&text, &self.path.join("scenario.toml").display().to_string())?;
        scenario.check().map_err(|illegal| self.damaged("scenario.toml", &illegal))?;
        Ok(scenario)
    }

    /// Reads the wall times of the looks of `records` back.
    ///
    /// # Errors
    /// When the file is missing or is not what it should be.
    pub fn read_look_times(&self, records: &[TrialRecord]) -> Result<Vec<Vec<Duration>>, RunFolderError> {
        let path = self.path.join("look_times.csv");
        let file = fs::File::open(&path).map_err(|source| RunFolderError::Read { path, source })?;
        read_look_times(file, records).map_err(|error| self.damaged("look_times.csv", &error))
    }

    /// Lets `latest` beside the folder point at it, where the system has symbolic links.
    ///
    /// # Errors
    /// When the link can't be made, or something else of that name is in the way.
    pub fn link_latest(&self) -> Result<(), RunFolderError> {
        Self::link_latest_to(&self.path)
    }

    /// The same for a folder that need not be of a run.
    ///
    /// # Errors
    /// As [`Self::link_latest`].
    pub fn link_latest_to(path: &Path) -> Result<(), RunFolderError> {
        let (Some(parent), Some(name)) = (path.parent(), path.file_name()) else { return Ok(()) };
        let (link, partial) = (parent.join("latest"), parent.join(".latest.partial"));
        if link.symlink_metadata().is_ok_and(|metadata| !metadata.is_symlink()) {
            let in_the_way = std::io::Error::other("something that is not a link is in the way; move it");
            return Err(RunFolderError::writing(link)(in_the_way));
        }
        let _ = fs::remove_file(&partial);
        symlink(Path::new(name), &partial)
            .and_then(|()| fs::rename(&partial, &link))
            .map_err(RunFolderError::writing(link))
    }

    fn read(&self, file: &str) -> Result<String, RunFolderError> {
        let path = self.path.join(file);
        read_text(&path, MAX_FILE_BYTES).map_err(|source| RunFolderError::Read { path, source })
    }

    fn read_json<T: DeserializeOwned>(&self, file: &str) -> Result<T, RunFolderError> {
        serde_json::from_str(&self.read(file)?).map_err(|error| self.damaged(file, &error))
    }

    fn read_table<T: DeserializeOwned>(&self, file: &str) -> Result<Vec<T>, RunFolderError> {
        let text = self.read(file)?;
        let lines = csv::Reader::from_reader(text.as_bytes()).into_deserialize().collect::<Result<_, _>>();
        lines.map_err(|error| self.damaged(file, &error))
    }

    fn damaged(&self, file: &str, reason: &dyn std::fmt::Display) -> RunFolderError {
        RunFolderError::Damaged { path: self.path.join(file), reason: reason.to_string() }
    }
}

/// The text of a file of at most `max_bytes`.
fn read_text(path: &Path, max_bytes: u64) -> std::io::Result<String> {
    // Asked before opening: a pipe would wait for a writer.
    if !fs::metadata(path)?.is_file() {
        return Err(std::io::Error::other("it is not a file"));
    }
    let mut text = String::new();
    // One byte more than allowed tells too long from just fitting.
    let length = fs::File::open(path)?.take(max_bytes + 1).read_to_string(&mut text)? as u64;
    if length > max_bytes {
        return Err(std::io::Error::other(format!("it is longer than {max_bytes} bytes, which no run writes")));
    }
    Ok(text)
}

#[cfg(unix)]
fn symlink(target: &Path, link: &Path) -> std::io::Result<()> {
    std::os::unix::fs::symlink(target, link)
}

#[cfg(not(unix))]
fn symlink(target: &Path, link: &Path) -> std::io::Result<()> {
    fs::write(link, target.display().to_string())
}

/// Lines as CSV, the columns named as their fields.
pub(super) fn to_csv<T: Serialize>(lines: impl IntoIterator<Item = T>) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for line in lines {
        writer.serialize(line)?;
    }
    writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))
}

fn to_json<T: Serialize>(value: &T) -> Vec<u8> {
    let mut json = serde_json::to_vec_pretty(value).expect("results are plain values");
    json.push(b'\n');
    json
}

/// Why a run folder can't be written or read.
#[derive(Debug, Error, Diagnostic)]
pub enum RunFolderError {
    /// Writing fails.
    #[error("{} can't be written: {source}", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// Reading fails.
    #[error("{} can't be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The folder holds no finished run.
    #[error("{} holds no finished run: there is no manifest.json in it", path.display())]
    #[diagnostic(help("give the folder of a finished run, such as runs/latest; `edgeloc run` makes one"))]
    NotARun {
        /// The folder.
        path: PathBuf,
    },
    /// The run was interrupted, or is still under way.
    #[error("the run in {} is not finished", path.display())]
    #[diagnostic(help("finish it, where it was interrupted: edgeloc run --resume {}", path.display()))]
    Unfinished {
        /// The folder.
        path: PathBuf,
    },
    /// There is nothing to resume.
    #[error("the run in {} is finished", path.display())]
    #[diagnostic(help("look at it: edgeloc report {}", path.display()))]
    Finished {
        /// The folder.
        path: PathBuf,
    },
    /// Another process works on the run.
    #[error("the run in {} is under way: another process writes its journal", path.display())]
    #[diagnostic(help("wait for that process, or end it; then edgeloc run --resume {}", path.display()))]
    UnderWay {
        /// The folder.
        path: PathBuf,
    },
    /// A file is not what the program wrote.
    #[error("{} is damaged or of another version: {reason}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// The scenario is not legal.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scenario(#[from] ScenarioError),
}

impl RunFolderError {
    fn writing(path: PathBuf) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::Write { path, source }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    #[test]
    fn results_read_back_as_written() {
        let parent = tempfile::tempdir().expect("a temporary folder");
        let results = sample::run().results;
        let folder = RunFolder::create(parent.path(), "2026-01-02", "hall").expect("a new folder");
        let look_times = vec![vec![Duration::from_millis(3)]; results.records.len()];
        folder.write_results(&results, &look_times).expect("written");
        let read = RunFolder::open(folder.path()).expect("a run").read_results().expect("readable");
        assert!(read == results, "something changed on the way through the folder");
        let one_look = folder.read_look_times(&results.records).expect("readable");
        assert_eq!(one_look, look_times);
    }

    #[test]
    fn a_second_run_of_the_day_gets_its_own_folder_and_latest_follows() {
        let parent = tempfile::tempdir().expect("a temporary folder");
        let create = || RunFolder::create(parent.path(), "2026-01-02", "hall").expect("a new folder");
        let (first, second) = (create(), create());
        assert_ne!(first.path(), second.path());
        for folder in [first, second] {
            folder.link_latest().expect("a link");
            let target = parent.path().join("latest").canonicalize().expect("a target");
            assert_eq!(target, folder.path().canonicalize().expect("a folder"));
        }
    }

    #[test]
    fn an_unfinished_or_damaged_folder_is_refused_by_name() {
        let parent = tempfile::tempdir().expect("a temporary folder");
        let folder = RunFolder::create(parent.path(), "2026-01-02", "hall").expect("a new folder");
        assert!(matches!(RunFolder::open(folder.path()), Err(RunFolderError::NotARun { .. })));
        let results = sample::run().results;
        folder.begin(&Manifest { finished_utc: None, ..results.manifest.clone() }, &results.scenario).expect("written");
        assert!(matches!(RunFolder::open(folder.path()), Err(RunFolderError::Unfinished { .. })));
        let (_, _, scenario) = RunFolder::open_unfinished(folder.path()).expect("an unfinished run");
        assert_eq!(scenario, results.scenario);
        folder.write_results(&results, &[]).expect("written");
        assert!(matches!(RunFolder::open_unfinished(folder.path()), Err(RunFolderError::Finished { .. })));
        folder.write("trials.csv", b"row,trial\nnear,many\n").expect("written");
        let error = folder.read_results().expect_err("damaged").to_string();
        assert!(error.contains("trials.csv"), "{error}");
    }

    #[test]
    fn a_file_too_long_is_refused_not_cut() {
        let parent = tempfile::tempdir().expect("a temporary folder");
        let path = parent.path().join("trials.csv");
        fs::write(&path, "12345").expect("written");
        assert_eq!(read_text(&path, 5).expect("it just fits"), "12345");
        let error = read_text(&path, 4).expect_err("too long").to_string();
        assert!(error.contains("longer than 4 bytes"), "{error}");
    }
}

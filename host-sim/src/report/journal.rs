//! `journal.ndjson`: the trials of an unfinished run, one JSON value a line, appended as they end, each with the wall time
//! that the run had taken by then.
//!
//! A line is written whole; what a crash leaves of the last one is dropped when the run goes on. The order is that in which
//! trials ended, the results sort them. The file is locked while a process writes it and removed when the run is complete.

use super::RunFolderError;
use crate::monte_carlo::TimedTrial;
use serde::{Deserialize, Serialize};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{BufRead, BufReader, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// An appended line goes to the disk at once, with those before it, when the last one did so this long ago.
const SYNC_INTERVAL: Duration = Duration::from_secs(1);

/// The journal of a run under way.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    begun: Instant,
    elapsed_before: Duration,
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    file: File,
    synced: Instant,
    failure: Option<std::io::Error>,
}

/// A line of the journal.
#[derive(Serialize, Deserialize)]
struct Line<T> {
    /// Wall time of learning and trials, in this process and those before it, until the trial ended.
    elapsed: Duration,
    trial: T,
}

impl Journal {
    /// Name of the file in the run's folder.
    pub const FILE: &str = "journal.ndjson";

    /// Opens the journal in `folder`, made when there is none, and reads the trials in it; cuts off half a last line.
    ///
    /// # Errors
    /// When the file can't be opened or read, another process writes it, or a line is not a trial.
    pub fn open(folder: &Path) -> Result<(Self, Vec<TimedTrial>), RunFolderError> {
        let path = folder.join(Self::FILE);
        let reading = |source| RunFolderError::Read { path: path.clone(), source };
        let mut options = OpenOptions::new();
        let mut file = options.read(true).append(true).create(true).open(&path).map_err(reading)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(RunFolderError::UnderWay { path: folder.to_owned() }),
            Err(TryLockError::Error(source)) => return Err(reading(source)),
        }
        let (mut trials, mut elapsed_before) = (Vec::new(), Duration::ZERO);
        let mut lines = BufReader::new(&mut file);
        let (mut line, mut whole_bytes) = (Vec::new(), 0);
        while lines.read_until(b'\n', &mut line).map_err(reading)? > 0 && line.ends_with(b"\n") {
            whole_bytes += line.len() as u64;
            let read: Line<TimedTrial> = serde_json::from_slice(&line).map_err(|error| RunFolderError::Damaged {
                path: path.clone(),
                reason: format!("line {}: {error}", trials.len() + 1),
            })?;
            elapsed_before = read.elapsed;
            trials.push(read.trial);
            line.clear();
        }
        file.set_len(whole_bytes).and_then(|()| file.seek(SeekFrom::End(0))).map_err(reading)?;
        let state = Mutex::new(State { file, synced: Instant::now(), failure: None });
        Ok((Self { path, begun: Instant::now(), elapsed_before, state }, trials))
    }

    /// Wall time since the journal was opened, and before that in every process until its last trial ended.
    #[must_use]
    pub fn elapsed(&self) -> Duration {
        self.elapsed_before + self.begun.elapsed()
    }

    /// Appends a trial that ended. A failure is kept for [`Self::close`]; later trials are not written then.
    pub fn append(&self, trial: &TimedTrial) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let line = Line { elapsed: self.elapsed(), trial };
        let mut line = serde_json::to_vec(&line).expect("a trial is plain values");
        line.push(b'\n');
        if state.failure.is_some() {
            return;
        }
        let is_due = state.synced.elapsed() >= SYNC_INTERVAL;
        let written = state.file.write_all(&line).and_then(|()| if is_due { state.file.sync_data() } else { Ok(()) });
        if is_due {
            state.synced = Instant::now();
        }
        state.failure = written.err();
    }

    /// Whether a trial could not be written, so that going on is in vain.
    #[must_use]
    pub fn has_failed(&self) -> bool {
        self.state.lock().unwrap_or_else(PoisonError::into_inner).failure.is_some()
    }

    /// Brings every line to the disk.
    ///
    /// # Errors
    /// When a trial could not be written.
    pub fn close(self) -> Result<(), RunFolderError> {
        let state = self.state.into_inner().unwrap_or_else(PoisonError::into_inner);
        let done = state.failure.map_or_else(|| state.file.sync_data(), Err);
        done.map_err(|source| RunFolderError::Write { path: self.path, source })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    fn trials() -> Vec<TimedTrial> {
        let records = sample::run().results.records.into_iter().take(3);
        records.map(|record| TimedTrial { row: 0, record, look_times: vec![Duration::from_nanos(1_234_567)] }).collect()
    }

    #[test]
    fn trials_come_back_as_they_were_and_half_a_last_line_is_dropped() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let trials = trials();
        let (journal, none) = Journal::open(folder.path()).expect("a journal");
        assert_eq!(none, []);
        trials[..2].iter().for_each(|trial| journal.append(trial));
        let elapsed = journal.elapsed();
        journal.close().expect("written");

        let path = folder.path().join(Journal::FILE);
        let mut torn = std::fs::read(&path).expect("a file");
        let whole = torn.len();
        torn.extend_from_within(..40);
        std::fs::write(&path, &torn).expect("written");
        let (journal, read) = Journal::open(folder.path()).expect("a journal");
        assert_eq!(read, trials[..2]);
        assert!(journal.elapsed_before > Duration::ZERO && journal.elapsed_before <= elapsed);
        assert!(journal.elapsed() > journal.elapsed_before);
        assert_eq!(std::fs::metadata(&path).expect("a file").len(), whole as u64);
        journal.append(&trials[2]);
        journal.close().expect("written");
        assert_eq!(Journal::open(folder.path()).expect("a journal").1, trials);
    }

    #[test]
    fn a_line_that_is_no_trial_and_a_second_writer_are_refused() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let first = Journal::open(folder.path()).expect("a journal");
        assert!(matches!(Journal::open(folder.path()), Err(RunFolderError::UnderWay { .. })));
        drop(first);
        std::fs::write(folder.path().join(Journal::FILE), "{}\n").expect("written");
        let error = Journal::open(folder.path()).expect_err("damaged").to_string();
        assert!(error.contains("line 1"), "{error}");
    }
}

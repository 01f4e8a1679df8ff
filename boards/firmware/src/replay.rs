//! Golden attempts through the localizer: one line of text for each look, the same on every machine.
//!
//! A line holds the whole decision in its debug form, whose shortest round-trip floats tell any two bit patterns of a
//! number apart, the number of segments that entered the matching, and every node's accumulated score as an integer.

use core::fmt::{self, Write};

use edgeloc::database::{OpenError, TopologicalDatabase};
use edgeloc::geometry::{CapacityError, Scene, SceneBuffer};
use edgeloc::localize::{Decision, Localizer, Look, ObserveError};

use crate::comparison::{Comparison, Mismatch};
use crate::looks::{GoldenLook, LooksError, LooksReader};

/// Segments of a look that the firmware has room for; a look with more is refused with an error.
pub const SCENE_CAPACITY: usize = 1024;

/// Words of working memory that are enough for every golden attempt.
pub const MEMORY_WORDS: usize = 1 << 18;

/// Longest line.
const LINE_CAPACITY: usize = 3072;

type Line = heapless::String<LINE_CAPACITY>;

/// What a comparison went through.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Attempts replayed.
    pub attempts: u32,
    /// Looks among them.
    pub looks: u32,
    /// Lines that differ from what was expected, are missing or are left over.
    pub mismatches: u32,
}

/// Replays `looks` on `map` and holds every line against `expected`; each that differs goes to `on_mismatch`.
///
/// # Errors
/// When the looks or the map can't be replayed at all.
pub fn compare(
    map: &[u8],
    looks: &[u8],
    expected: &str,
    memory: &mut [u64],
    on_mismatch: impl FnMut(Mismatch<'_>),
) -> Result<Counts, ReplayError> {
    let mut comparison = Comparison::new(expected, on_mismatch);
    let counts = replay(map, looks, memory, |line| comparison.line(line))?;
    let (_, mismatches) = comparison.finish();
    Ok(Counts { mismatches, ..counts })
}

/// Replays `looks` on `map` and hands each line, without its end, to `on_line`.
///
/// # Errors
/// When the looks or the map can't be replayed at all.
pub fn replay(
    map: &[u8],
    looks: &[u8],
    memory: &mut [u64],
    mut on_line: impl FnMut(&str),
) -> Result<Counts, ReplayError> {
    let database = TopologicalDatabase::open(map).map_err(ReplayError::Map)?;
    let mut reader = LooksReader::new(looks).map_err(ReplayError::Looks)?;
    let mut scene = SceneBuffer::new();
    let mut counts = Counts::default();
    for attempt_index in 0..reader.attempt_count() {
        let attempt = reader.attempt().map_err(ReplayError::Looks)?;
        let words = attempt.memory_words.unwrap_or_else(|| Localizer::memory_len_in(&attempt.config, &database));
        let capacity = memory.len();
        let memory = memory.get_mut(..words);
        let memory =
            memory.ok_or(ReplayError::Memory(CapacityError { what: "replay memory", capacity, needed: words }))?;
        let mut line = Line::new();
        let mut started = Localizer::new(database, &attempt.config, memory);
        counts.attempts += 1;
        if let Err(error) = &started {
            write!(line, "{attempt_index} {}: {error:?}", attempt.name).map_err(|_| ReplayError::LineTooLong)?;
            on_line(&line);
        }
        for look_index in 1..=attempt.look_count {
            let look = reader.look().map_err(ReplayError::Looks)?;
            let Ok(localizer) = &mut started else { continue };
            let answer = observe(localizer, &look, &mut scene)?;
            line.clear();
            write!(line, "{attempt_index}.{look_index} {}: ", attempt.name)
                .and_then(|()| write_state(&mut line, &answer, localizer))
                .map_err(|_| ReplayError::LineTooLong)?;
            on_line(&line);
            counts.looks += 1;
        }
    }
    if reader.is_at_end() { Ok(counts) } else { Err(ReplayError::LeftOver) }
}

/// One look as a robot takes it: the segments into a buffer of fixed size, then the localizer's one verb.
fn observe(
    localizer: &mut Localizer<'_>,
    look: &GoldenLook<'_>,
    buffer: &mut SceneBuffer<SCENE_CAPACITY>,
) -> Result<Result<Decision, ObserveError>, ReplayError> {
    buffer.clear();
    for segment in look.segments() {
        if let Err(error) = buffer.push(segment.map_err(ReplayError::Looks)?) {
            return Ok(Err(ObserveError::Capacity(error)));
        }
    }
    let scene: Scene<'_> = buffer.as_scene();
    Ok(localizer.observe(&Look { heading: look.heading, motion_since_last: look.motion, scene }))
}

/// The answer, the segments that were matched and all scores; a node that dropped out has a minus behind its score.
fn write_state(line: &mut Line, answer: &Result<Decision, ObserveError>, localizer: &Localizer<'_>) -> fmt::Result {
    write!(line, "{answer:?}, {} segments, scores", localizer.scene_segment_count())?;
    for score in localizer.candidates().scores() {
        write!(line, " {}{}", score.sum_q30, if score.is_candidate() { "" } else { "-" })?;
    }
    Ok(())
}

/// Why golden looks can't be replayed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReplayError {
    /// The map does not open.
    Map(OpenError),
    /// The looks can't be read.
    Looks(LooksError),
    /// The memory given is too small for an attempt.
    Memory(CapacityError),
    /// A line is longer than a line may be.
    LineTooLong,
    /// Bytes follow the last attempt.
    LeftOver,
}

impl fmt::Display for ReplayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Map(error) => error.fmt(f),
            Self::Looks(error) => error.fmt(f),
            Self::Memory(error) => error.fmt(f),
            Self::LineTooLong => write!(f, "a line of the replay is longer than {LINE_CAPACITY} bytes"),
            Self::LeftOver => f.write_str("bytes follow the last golden attempt"),
        }
    }
}

impl core::error::Error for ReplayError {}

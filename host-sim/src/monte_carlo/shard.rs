//! A run in parts: each shard runs a contiguous block of the trials of every row, on a machine of its own if need be.

use crate::scenario::{Scenario, Setting};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// The `index`-th of `count` parts of a run, from 1; written `2/3`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// Which part, from 1.
    pub index: u32,
    /// Parts in all.
    pub count: u32,
}

impl Shard {
    /// The trials of this part: whole maps where there are maps enough, so that none is learned twice.
    ///
    /// # Errors
    /// When there are more parts than trials.
    pub fn trials(&self, scenario: &Scenario) -> Result<Range<u32>, ShardError> {
        let most = scenario.rows.iter().map(|row| row.trials.unwrap_or(scenario.trials)).max().unwrap_or(0);
        let maps = most.div_ceil(scenario.trials_per_map);
        if self.count > most {
            return Err(ShardError::TooMany { count: self.count, trials: most });
        }
        let (parts, size) = if self.count <= maps { (maps, scenario.trials_per_map) } else { (most, 1) };
        let border = |index: u32| {
            let part = u64::from(index) * u64::from(parts) / u64::from(self.count);
            (part * u64::from(size)).min(u64::from(most)) as u32
        };
        Ok(border(self.index - 1)..border(self.index))
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let parts = text.split_once('/').and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
        match parts {
            Some((index, count)) if (1..=count).contains(&index) => Ok(Self { index, count }),
            _ => Err(ShardError::Text),
        }
    }
}

/// Trials of all rows together among those of the given indices.
#[must_use]
pub fn count_trials(settings: &[Setting], trials: &Range<u32>) -> usize {
    let of_row = |setting: &Setting| setting.scenario.trials.min(trials.end).saturating_sub(trials.start);
    settings.iter().map(|setting| of_row(setting) as usize).sum()
}

/// Why a run can't be parted so.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ShardError {
    /// Not a part of a whole.
    #[error("write K/N, the K-th of N parts, from 1: 1/4, 2/4, 3/4 and 4/4")]
    Text,
    /// Some part would be empty.
    #[error("a row has at most {trials} trials, too few for {count} shards; ask for fewer")]
    TooMany {
        /// Parts asked for.
        count: u32,
        /// Trials of the longest row.
        trials: u32,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_take_each_trial_once_and_whole_maps_while_there_are_enough() {
        for (trials, trials_per_map) in [(12, 4), (963, 50), (5, 50), (7, 1), (1, 1)] {
            let mut scenario = Scenario { trials: trials.min(3), trials_per_map, ..Scenario::default() };
            scenario.rows[1].trials = Some(trials);
            for count in 1..=trials.min(40) {
                let parts: Vec<_> =
                    (1..=count).map(|index| Shard { index, count }.trials(&scenario).expect("not too many")).collect();
                assert_eq!(parts.iter().cloned().flatten().collect::<Vec<_>>(), (0..trials).collect::<Vec<_>>());
                assert!(parts.iter().all(|part| !part.is_empty()), "{parts:?}");
                let is_whole = |part: &Range<u32>| part.start.is_multiple_of(trials_per_map);
                assert!(count > trials.div_ceil(trials_per_map) || parts.iter().all(is_whole), "{parts:?}");
            }
            let too_many = Shard { index: 1, count: trials + 1 }.trials(&scenario);
            assert_eq!(too_many, Err(ShardError::TooMany { count: trials + 1, trials }));
        }
    }

    #[test]
    fn a_shard_is_written_as_a_part_of_a_whole() {
        assert_eq!("2/3".parse(), Ok(Shard { index: 2, count: 3 }));
        assert_eq!(Shard { index: 2, count: 3 }.to_string(), "2/3");
        for text in ["0/3", "4/3", "3", "a/b", "1/0", "-1/2", ""] {
            assert_eq!(text.parse::<Shard>(), Err(ShardError::Text), "{text}");
        }
    }
}

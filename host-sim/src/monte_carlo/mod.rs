//! Kidnapped-robot trials: a robot is put down somewhere, looks around and says where it is.

mod campus;
mod campus_trials;
mod look_images;
mod looks;
mod record;
mod replay;
mod runner;
mod shard;
mod site;
mod sites;
mod start;
mod statistics;
mod trial;

pub use campus::{Campus, CampusError};
pub use campus_trials::{CampusRecord, CampusStart, ExactScan};
pub use look_images::{LookImages, SourceEffect};
pub use record::{Outcome, TrialRecord, UnknownKind};
pub use replay::{Replay, replay};
pub use runner::{Part, RunError, RunOutcome, TimedTrial, run, run_part};
pub use shard::{Shard, ShardError, count_trials};
pub use site::{Site, SiteError};
pub use sites::{PrepareError, Sites};
pub use start::{TruePose, draw_start};
pub use statistics::{
    PairedCounts, SuccessRate, clustered_interval, difference_interval, mcnemar, paired_difference_interval,
    success_interval,
};
pub use trial::LookEvent;

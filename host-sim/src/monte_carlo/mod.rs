//! Kidnapped-robot trials: a robot is put down somewhere, looks around and says where it is.

mod record;
mod statistics;

pub use record::{Outcome, TrialRecord};
pub use statistics::{SuccessRate, success_interval};

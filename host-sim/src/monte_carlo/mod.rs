//! Kidnapped-robot trials: a robot is put down somewhere, looks around and says where it is.

mod record;

pub use record::{Outcome, TrialRecord};

//! The localiser: looks in, decisions out.

mod candidates;
mod config;
mod decision;
mod extent;
mod first_stage;
mod localizer;
mod look;
mod paper;
mod prediction;
mod rivals;
mod score_margin;
mod segment_filter;
mod verify;
mod workspace;

pub use candidates::{CandidateSet, NodeScore};
pub use config::{ConfigError, LocalizerConfig};
pub use decision::{Decision, Localized, PoseEstimate, UnknownReason};
pub use localizer::{Localizer, ObserveError, StartError};
pub use look::{HeadingPrior, Look, Motion};
pub use paper::lines_to_match;
pub use prediction::predict_view;
pub use rivals::{Rival, Rivals};
pub use score_margin::ScoreMargin;
pub use verify::{Evidence, NextLook, PoseCheck, VerificationConfig};

//! Studies: many settings on common random numbers, what their differences prove, and the search for better ones.
//!
//! [`Demand`] says before a run how many trials separate two settings, [`holm`] corrects the p-values of many
//! comparisons, and [`search`] optimises by successive halving with evidence that may be read at any time.

mod axis;
mod evidence;
mod front;
mod halving;
mod holm;
mod power;
mod sample;

pub use axis::{Axis, draw_points};
pub use evidence::{is_proven, log_evidence};
pub use front::{Merit, front_ranks};
pub use halving::{ALPHA, FAR_BELOW, Fate, Schedule, Stage, Standing, choose, confirmed_front, search};
pub use holm::holm;
pub use power::{Demand, independent_discordance};
pub use sample::{Sample, TrialResult};

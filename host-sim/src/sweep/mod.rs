//! Studies: many settings on common random numbers, what their differences prove, and the search for better ones.
//!
//! A study is a scenario of many rows; [`figures_of`] and [`compare_with_default`] read it, [`PAPER_CLAIMS`] is what it is
//! held against. [`Demand`] says before a run how many trials separate two settings, [`holm`] corrects the p-values of many
//! comparisons, and [`search`] optimises by successive halving with evidence that may be read at any time.

mod axis;
mod evaluate;
mod evidence;
mod figures;
mod front;
mod halving;
mod holm;
mod paper;
mod power;
mod preset;
mod sample;

pub use axis::{Axis, draw_points};
pub use evaluate::{samples, stage_scenario};
pub use evidence::{is_proven, log_evidence};
pub use figures::{
    Against, DefaultComparison, Figure, against_row, compare_with_default, figure_and_setting, figures_of,
    with_anywhere,
};
pub use front::{Merit, front_ranks};
pub use halving::{ALPHA, FAR_BELOW, Fate, LEAST_TRIALS, Schedule, Stage, Standing, choose, confirmed_front, search};
pub use holm::holm;
pub use paper::{PAPER_CLAIMS, PAPER_OPENINGS, PaperClaim, PaperOpening, paper_claim};
pub use power::{Demand, independent_discordance};
pub use preset::preset_toml;
pub use sample::{Sample, TrialResult};

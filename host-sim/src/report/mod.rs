//! What is left of a run: its folder, its figures, and a page to look at.
//!
//! [`RunFolder`] holds everything needed to repeat a run; [`page()`] makes one self-contained HTML file of it, drawings
//! inline and without scripts. The drawings serve the command line too.

mod charts;
mod drawing;
mod explanation;
mod floor_plan;
mod manifest;
mod page;
mod run_folder;
mod summary;
mod timings;
mod trials_csv;
mod trials_plan;

#[cfg(test)]
mod sample;

pub use charts::{looks_histogram, rate_strip, success_by_distance};
pub use drawing::to_svg_file;
pub use explanation::{LookExplanation, NodeStanding, scene_drawing, sight};
pub use floor_plan::{FloorPlan, FreeCells};
pub use manifest::{HostFacts, Manifest, WorldFacts};
pub use page::{page, replay_command};
pub use run_folder::{RunFolder, RunFolderError, RunResults};
pub use summary::{MapFacts, PAPER_INTERVAL, PAPER_RATE, RowSummary, Summary, worst_trials};
pub use timings::{RowTimings, RunTimings};
pub use trials_plan::{trial_marks, trials_plan};

//! What is left of a run: its folder, its figures, and a page to look at.
//!
//! [`RunFolder`] holds everything needed to repeat a run; [`page()`] makes one self-contained HTML file of it, drawings
//! inline and without scripts. The drawings serve the command line too.

mod answers;
mod axes;
mod charts;
mod comparison;
mod document;
mod drawing;
mod explanation;
mod exploration_plan;
mod figure_chart;
mod figure_lines;
mod figures_page;
mod floor_plan;
mod journal;
mod manifest;
mod merge;
mod page;
mod pareto_chart;
mod place_evidence;
mod run_folder;
mod scale;
mod search_lines;
mod search_page;
mod summary;
mod timings;
mod trial_page;
mod trials_csv;
mod trials_plan;
mod validation;
mod validation_page;

#[cfg(test)]
mod sample;

pub use answers::{AnswerFigures, ReliabilityBin, Share, expected_calibration_error, reliability};
pub use charts::{looks_histogram, rate_strip, reliability_chart, success_by_distance};
pub use comparison::{Comparison, NotPaired, Pairs, RunRow, Side};
pub use drawing::to_svg_file;
pub use explanation::{AnsweredPose, LookExplanation, NodeStanding, PossiblePlace, answer_words, scene_drawing, sight};
pub use exploration_plan::exploration_plan;
pub use figure_chart::figure_chart;
pub use figure_lines::{FigureLine, TestKind, figure_lines, figures_csv, lines_of_figure};
pub use figures_page::{figures_page, power_sentence};
pub use floor_plan::{FloorPlan, FreeCells};
pub use journal::Journal;
pub use manifest::{HostFacts, Manifest, WorldFacts};
pub use merge::{MergeError, ShardResults, merge};
pub use page::{page, replay_command};
pub use pareto_chart::{Cost, pareto_chart};
pub use run_folder::{RunFolder, RunFolderError, RunResults};
pub use scale::{ScaleFacts, ScaleLine, scale_chart, scale_csv};
pub use search_lines::{SearchLine, search_csv, search_lines};
pub use search_page::{SearchFacts, search_page};
pub use summary::{MapFacts, PAPER_INTERVAL, PAPER_RATE, RowSummary, Summary, worst_trials};
pub use timings::{RowTimings, RunTimings};
pub use trial_page::{TrialFacts, trial_page};
pub use trials_plan::{trial_marks, trials_plan};
pub use validation::{TotalLine, ValidationRow, WorldLine, validation, validation_csv};
pub use validation_page::validation_page;

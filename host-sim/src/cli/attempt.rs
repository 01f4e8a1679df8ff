//! One attempt explained: what `locate` and `replay` share.

use super::console::{self, Format};
use super::worlds;
use edgeloc_sim::monte_carlo::{Replay, Site, SourceEffect, TrialRecord, TruePose};
use edgeloc_sim::report::{FloorPlan, LookExplanation, TrialFacts, answer_words, to_svg_file, trial_page};
use edgeloc_sim::scenario::Setting;
use miette::{IntoDiagnostic, Result, WrapErr};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The fields that `--format json` prints for an attempt, for the help.
pub(super) const JSON_FIELDS: &str = "\
record = the trial's line of trials.csv (row, trial, map = draw of the map's noise, true_x_m, true_y_m, \
true_heading_deg, nearest_node, second_nearest_node, nearest_node_distance_m, outcome, answered_node, answer_distance_m \
from the true position to it, pose_error_m, heading_error_deg and probability of an answered pose, is_success, \
is_truth_named by the answer or the rivals, is_near_tie, unknown_kind and rivals where there is no answer, end_x_m and end_y_m at the last look, driven_m in exploratory moves, looks, \
scene_segments, scored_nodes, leader_score, runner_up_score, truth_score, map_bytes, \
map_segments, message of an error); parameters, by their keys in a scenario, as they were applied; looks (look, heading_deg, compass_deg told \
to the localiser (null without a compass), seen_segments, used_segments, decision in words; pose answered (x_m, y_m, heading_deg, covariance \
of x, y and heading in m, m, rad) and its probability, if the localiser gives them, or rivals (node, x_m, y_m, probability), the \
places between which it can't tell; and nodes, of each its score, \
was_candidate and is_candidate: before and after the look); effects, of each look what each uncertainty source did to both \
images (source, magnitude, unit, features, changed_features, removed_features, added_features, pieces and length_px before and after, rms_shift_px, \
greatest_shift_px, flipped_pieces, unmatched_features); page, with every intermediate as a picture; drawings, the files";

/// One attempt, as `--format json` prints it.
#[derive(Debug, Serialize)]
pub(super) struct Attempt {
    /// The trial's line of trials.csv.
    pub(super) record: TrialRecord,
    /// What was applied.
    parameters: BTreeMap<String, String>,
    /// What happened, look by look.
    looks: Vec<LookExplanation>,
    /// What the uncertainty sources did to the images of each look.
    effects: Vec<Vec<SourceEffect>>,
    /// The page with every intermediate.
    page: PathBuf,
    /// Drawings of the looks.
    drawings: Vec<PathBuf>,
}

impl Attempt {
    /// Makes the attempt and draws its looks into `folder`.
    pub(super) fn make(
        site: &Site,
        setting: &Setting,
        trial: u32,
        start: Option<TruePose>,
        folder: &Path,
    ) -> Result<Self> {
        let mut looks = Vec::new();
        let replay = Replay::new(site, setting, trial, start).into_diagnostic()?;
        let config = setting.localizer_config();
        let record = replay.run(|event| looks.push(LookExplanation::new(looks.len() + 1, event, &config)));
        let record = record.into_diagnostic()?;
        let plan = FloorPlan::new(Some(&site.world), Some(&worlds::free_cells(&site.free_space)), &site.nodes);
        std::fs::create_dir_all(folder)
            .into_diagnostic()
            .wrap_err_with(|| format!("the folder {} can't be made", folder.display()))?;
        let mut drawings = Vec::new();
        for look in &looks {
            let path = folder.join(format!("look-{:02}.svg", look.look));
            let drawing = look.to_svg(&plan, &site.rig.camera, &record);
            console::write_file(&path, to_svg_file(drawing).as_bytes())?;
            drawings.push(path);
        }
        let parameters = setting.parameters().into_iter().collect();
        let poses: Vec<_> = looks.iter().map(|look| look.true_pose).collect();
        let images = replay.look_images(&poses);
        let robot = site.calibrated_rig(&setting.scenario.uncertainty, setting.scenario.seed, record.map);
        let facts = TrialFacts {
            record: &record,
            parameters: &parameters,
            config,
            robot: &robot,
            map: replay.map().into_diagnostic()?,
            plan: &plan,
            looks: &looks,
            images: &images,
        };
        let page = folder.join("trial.html");
        console::write_file(&page, trial_page(&facts).as_bytes())?;
        let effects = images.into_iter().map(|images| images.effects).collect();
        Ok(Self { record, parameters, looks, effects, page, drawings })
    }

    /// Prints the attempt.
    pub(super) fn print(&self, format: Format) -> Result<()> {
        if format == Format::Json {
            return console::print_json(self);
        }
        let record = &self.record;
        console::print(&format!(
            "truth: {:.2}, {:.2} m, heading {:.1} degrees; {}nearest nodes {} ({:.2} m) and {}\n",
            record.true_x_m,
            record.true_y_m,
            record.true_heading_deg,
            if record.driven_m > 0.0 {
                format!("after {:.2} m of moves {:.2}, {:.2} m; ", record.driven_m, record.end_x_m, record.end_y_m)
            } else {
                String::new()
            },
            record.nearest_node,
            record.nearest_node_distance_m,
            record.second_nearest_node
        ))?;
        for look in &self.looks {
            console::print(&look.to_text(record))?;
        }
        let answer = answer_words(record);
        let verdict = if record.is_success { "right" } else { "wrong" };
        let looks = if record.looks == 1 { "look" } else { "looks" };
        console::print(&format!("answer after {} {looks}: {answer}: {verdict}", record.looks))?;
        console::print(&format!("every intermediate: {}", self.page.display()))?;
        match (self.drawings.first(), self.drawings.last()) {
            (Some(first), Some(last)) if first != last => {
                console::print(&format!("drawings: {} to {}", first.display(), last.display()))
            }
            (Some(only), _) => console::print(&format!("drawing: {}", only.display())),
            _ => Ok(()),
        }
    }
}

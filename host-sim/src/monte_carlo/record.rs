//! What is kept of one trial: one line of `trials.csv`. No wall times, so that runs compare byte for byte.

use serde::{Deserialize, Serialize};

/// How a trial ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// The localiser named a node.
    Localized,
    /// The localiser said that it can't tell.
    Unknown,
    /// The localiser refused a look or broke down: a failure of ours, counted as a failed trial.
    Error,
}

/// Why a trial ended without an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum UnknownKind {
    /// No look showed enough to compare.
    SceneTooPoor,
    /// What was seen agrees with no place of the map.
    OutsideMap,
    /// Several places agree with it.
    Indistinguishable,
}

/// One kidnapped-robot trial: where the robot truly was, what it answered and how it got there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialRecord {
    /// Name of the row (setting) of the run.
    pub row: String,
    /// Index of the trial in its row, from 0; the same index means the same robot pose in rows with the same start.
    pub trial: u32,
    /// Index of the map's noise draw that this trial used.
    pub map: u32,
    /// True position of the left camera in the world frame \[m\].
    pub true_x_m: f32,
    /// True position of the left camera in the world frame \[m\].
    pub true_y_m: f32,
    /// True heading at the first look \[degrees\], counter-clockwise from +x.
    pub true_heading_deg: f32,
    /// The node nearest to the true position at the last look.
    pub nearest_node: u32,
    /// The second nearest node (equal to the nearest in a map of one node).
    pub second_nearest_node: u32,
    /// Distance from there to the nearest node \[m\].
    pub nearest_node_distance_m: f32,
    /// How the trial ended.
    pub outcome: Outcome,
    /// The node answered, if any.
    pub answered_node: Option<u32>,
    /// Distance from the true position to the answered node \[m\], if any.
    pub answer_distance_m: Option<f32>,
    /// Distance from the true position to the position answered \[m\], if any.
    pub pose_error_m: Option<f32>,
    /// How far the heading answered is off the true one at the last look \[degrees\], positive when turned too far to the
    /// left, if any.
    pub heading_error_deg: Option<f32>,
    /// Probability that the answer is right as the localiser has it, if it states one.
    pub probability: Option<f32>,
    /// Whether the trial ended right: the answered node is one of the two nearest (the paper's definition), so that "I
    /// can't tell" is a failure; but that alone is right where the robot started unlearned, at a place that no map knows.
    pub is_success: bool,
    /// Whether the trial ended right, or without an answer but with the truth among the rivals named: one of them within
    /// 1 m of the true position, or naming the nearest node.
    pub is_truth_named: bool,
    /// Whether the position answered lies within 0.5 m of the true one though the node is not one of the two nearest.
    pub is_near_tie: bool,
    /// Why there is no answer, if there is none.
    pub unknown_kind: Option<UnknownKind>,
    /// The rivals named instead of an answer, the likeliest first: `node@x,y:probability`, positions in metres, with
    /// blanks between them.
    pub rivals: Option<String>,
    /// True position at the last look in the world frame \[m\]: that at the first, unless the robot moved. Answers, nodes
    /// and errors are of it.
    pub end_x_m: f32,
    /// True position at the last look in the world frame \[m\].
    pub end_y_m: f32,
    /// Way driven in exploratory moves \[m\]; the answer is of where the robot stands after them.
    pub driven_m: f32,
    /// Looks taken.
    pub looks: u32,
    /// Segments of all looks together that entered the matching.
    pub scene_segments: u32,
    /// Nodes scored in all looks together: the work of the localiser, alike on every machine.
    pub scored_nodes: u32,
    /// Accumulated score of the leading node, Bhattacharyya coefficients summed over looks.
    pub leader_score: f64,
    /// Accumulated score of the best other node still a candidate before the last look; 0 when there is none.
    pub runner_up_score: f64,
    /// Accumulated score of the better of the two nearest nodes, if it was still a candidate.
    pub truth_score: Option<f64>,
    /// Size of the map that the trial used, in bytes.
    pub map_bytes: u32,
    /// Segments in the models of all nodes of that map.
    pub map_segments: u32,
    /// What the localiser said when the outcome is an error.
    pub message: Option<String>,
}

impl TrialRecord {
    /// Whether both trials put the robot down at the same pose, to the bit.
    #[must_use]
    pub fn has_pose_of(&self, other: &Self) -> bool {
        let pose = |record: &Self| [record.true_x_m, record.true_y_m, record.true_heading_deg].map(f32::to_bits);
        pose(self) == pose(other)
    }
}

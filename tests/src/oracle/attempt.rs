//! A whole attempt of the paper's localiser (section 3.2, Fig. 1a) in `f64`.
//!
//! Where the paper is silent: when `max_looks` looks leave several candidates the leading node is the answer; when no look
//! of the attempt gave any node a score above 0 there is no answer.

use super::{Histogram, NaiveCandidates, NaiveSegment, predict, prepare_scene, scene_histograms, view_score};
use edgeloc::geometry::{Heading, Segment2, Segment3, StereoRig};
use edgeloc::localize::LocalizerConfig;

/// The naive answer to a look.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NaiveDecision {
    /// The robot is at the node of this index.
    Localized(usize),
    /// Turn and look again.
    LookAgain,
    /// The localiser can't tell.
    Unknown,
}

/// One attempt: all nodes' 3-D segments and what was accumulated so far.
#[derive(Debug, Clone)]
pub struct Attempt<'a> {
    rig: &'a StereoRig,
    config: &'a LocalizerConfig,
    /// The segments of each node in the node frame.
    nodes: &'a [Vec<Segment3>],
    /// Scores and candidates so far.
    pub candidates: NaiveCandidates,
}

impl<'a> Attempt<'a> {
    /// An attempt with all nodes in play.
    #[must_use]
    pub fn new(rig: &'a StereoRig, config: &'a LocalizerConfig, nodes: &'a [Vec<Segment3>]) -> Self {
        let candidates = NaiveCandidates::new(nodes.len(), f64::from(config.score_margin));
        Self { rig, config, nodes, candidates }
    }

    /// Takes one look into account and decides.
    pub fn observe(&mut self, heading: Heading, scene: &[Segment2]) -> NaiveDecision {
        let (scene, scene_histograms) = self.described(&scene.iter().map(NaiveSegment::from).collect::<Vec<_>>());
        let heading = f64::from(heading.angle().radians());
        let node_score = |node: usize| {
            let (_, view_histograms) = self.described(&predict(self.rig, &self.nodes[node], heading));
            view_score(&scene, &scene_histograms, &view_histograms)
        };
        let mut candidates = self.candidates.clone();
        candidates.accumulate(node_score);
        self.candidates = candidates;
        self.decide()
    }

    /// The segments that enter the matching, with their histograms.
    fn described(&self, segments: &[NaiveSegment]) -> (Vec<NaiveSegment>, Vec<Histogram>) {
        let kept: Vec<NaiveSegment> =
            prepare_scene(segments, self.config).into_iter().map(|index| segments[index]).collect();
        let histograms = scene_histograms(&self.config.shape, &kept);
        (kept, histograms)
    }

    fn decide(&self) -> NaiveDecision {
        let leader = self.candidates.leading_node();
        let has_evidence = self.candidates.scores[leader] > 0.0;
        let has_looked_enough = self.candidates.looks() >= u32::from(self.config.max_looks);
        match (has_evidence, has_looked_enough) {
            (true, _) if self.candidates.candidate_count() == 1 => NaiveDecision::Localized(leader),
            (true, true) => NaiveDecision::Localized(leader),
            (false, true) => NaiveDecision::Unknown,
            (_, false) => NaiveDecision::LookAgain,
        }
    }
}

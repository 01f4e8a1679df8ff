//! The nodes still in play (paper, section 3.2): scores accumulate, the margin shrinks as `B_th / i`.
//!
//! The paper does not say whether accumulated scores are a sum or a mean; here they are a plain sum. Nor what a look
//! without any score does; here it drops no node, even with a margin of zero.

/// Accumulated scores of the nodes, and which are still candidates.
#[derive(Debug, Clone)]
pub struct NaiveCandidates {
    score_margin: f64,
    looks: u32,
    /// The sum of a node's view scores over the looks it was matched in.
    pub scores: Vec<f64>,
    /// Whether a node is still a candidate.
    pub is_candidate: Vec<bool>,
}

impl NaiveCandidates {
    /// All nodes in play, nothing seen.
    #[must_use]
    pub fn new(node_count: usize, score_margin: f64) -> Self {
        Self { score_margin, looks: 0, scores: vec![0.0; node_count], is_candidate: vec![true; node_count] }
    }

    /// Adds one look's scores (asked for candidates only) and drops the nodes that fell behind the margin.
    pub fn accumulate(&mut self, mut view_score: impl FnMut(usize) -> f64) {
        self.looks += 1;
        for node in 0..self.scores.len() {
            if self.is_candidate[node] {
                self.scores[node] += view_score(node);
            }
        }
        let leader = self.leading_node();
        if self.scores[leader] <= 0.0 {
            return;
        }
        let least = self.scores[leader] - self.score_margin / f64::from(self.looks);
        for node in 0..self.scores.len() {
            self.is_candidate[node] &= node == leader || self.scores[node] > least;
        }
    }

    /// The candidate of the best score; the first of equals. There must be a node.
    #[must_use]
    pub fn leading_node(&self) -> usize {
        let mut candidates = (0..self.scores.len()).filter(|&node| self.is_candidate[node]);
        let first = candidates.next().expect("the leader always stays a candidate");
        candidates.fold(first, |best, node| if self.scores[node] > self.scores[best] { node } else { best })
    }

    /// How many nodes are still candidates.
    #[must_use]
    pub fn candidate_count(&self) -> usize {
        self.is_candidate.iter().filter(|&&is_candidate| is_candidate).count()
    }

    /// Looks accumulated so far.
    #[must_use]
    pub const fn looks(&self) -> u32 {
        self.looks
    }
}

//! How far below the leader a node may stay and still be a candidate.

/// The margin `B_th` below the leading node's accumulated score, in Q30 coefficients (paper, section 3.2).
///
/// The paper names 0.1 in its conclusion and 0.01 in section 5; only 0.1 is among the values it tests, and is our
/// default.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ScoreMargin {
    initial_q30: i64,
}

impl ScoreMargin {
    /// The initial margin `B_th` as a sum of coefficients, 0 to 1000; `None` outside.
    #[must_use]
    pub fn new(score: f32) -> Option<Self> {
        (0.0..=1000.0).contains(&score).then(|| Self { initial_q30: (f64::from(score) * f64::from(1 << 30)) as i64 })
    }

    /// The margin `B_i = B_th / i` of the `iteration`-th look, counted from 1.
    #[must_use]
    pub const fn at_iteration(self, iteration: u32) -> i64 {
        let divisor = if iteration == 0 { 1 } else { iteration };
        self.initial_q30 / divisor as i64
    }
}

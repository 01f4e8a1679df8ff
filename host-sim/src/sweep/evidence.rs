//! Evidence that one setting beats another, valid whenever one looks: an e-process on discordant pairs.
//!
//! A p-value may be read once, at a number of trials fixed before. A search reads after every rung and stops when it
//! likes what it sees; with p-values it would call equal settings different far more often than it says. So it bets
//! instead (Ville 1939; Robbins 1970; Ramdas et al. 2023): of n discordant pairs w were won by the setting that is said
//! to be better, and
//!
//! ```text
//! E = 2 * 2^n * (integral over p from 1/2 to 1 of p^w (1 - p)^(n - w))
//! ```
//!
//! is the capital of one who begins with 1 and bets on every p above one half alike. If the setting is no better, E is a
//! supermartingale: the probability that it *ever* reaches 1 / alpha is at most alpha, however long one goes on and
//! whenever one stops. Among many pairs of settings each gets its share of alpha (Bonferroni), for the pairs that are
//! looked at are chosen by the data.
//!
//! The claim takes discordant pairs as independent. Trials that share a map share its noise, so a rate is one over the
//! maps drawn as well; the confirmation on fresh maps is what counts in the end.

use crate::monte_carlo::mcnemar;
use core::f64::consts::LN_2;

/// Natural logarithm of the capital E after `wins` and `losses` of discordant pairs.
#[must_use]
pub fn log_evidence(wins: u64, losses: u64) -> f64 {
    let (won, lost) = (wins as f64, losses as f64);
    let log_beta = libm::lgamma(won + 1.0) + libm::lgamma(lost + 1.0) - libm::lgamma(won + lost + 2.0);
    // The integral is the beta function times the share of its density above one half: a tail of n + 1 fair coins,
    // which is half of what McNemar's two-sided test gives.
    let above_half =
        if wins >= losses { 1.0 - 0.5 * mcnemar(losses, wins + 1) } else { 0.5 * mcnemar(wins, losses + 1) };
    (won + lost + 1.0) * LN_2 + log_beta + libm::log(above_half)
}

/// Whether `wins` against `losses` prove the better setting at level `alpha` among `comparisons` that are watched.
#[must_use]
pub fn is_proven(wins: u64, losses: u64, alpha: f64, comparisons: usize) -> bool {
    log_evidence(wins, losses) >= libm::log(comparisons.max(1) as f64 / alpha)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;

    #[test]
    fn the_capital_begins_at_one_and_is_the_integral() {
        assert!(log_evidence(0, 0).abs() < 1e-12);
        for (wins, losses) in [(1, 0), (0, 1), (7, 2), (3, 9), (40, 20)] {
            let steps = 200_000;
            let term = |step: i32| {
                let p = 0.5 + 0.5 * (f64::from(step) + 0.5) / f64::from(steps);
                libm::pow(2.0 * p, f64::from(wins)) * libm::pow(2.0 * (1.0 - p), f64::from(losses))
            };
            let integral = (0..steps).map(term).sum::<f64>() / f64::from(steps);
            let ours = libm::exp(log_evidence(wins as u64, losses as u64));
            assert!((ours / integral - 1.0).abs() < 1e-4, "{wins} to {losses}: {ours} {integral}");
        }
    }

    #[test]
    fn fair_coins_watched_at_every_toss_hardly_ever_prove_anything() {
        let studies = 2000;
        let alarms = (0..studies).filter(|&study| {
            let mut stream = Stream::new(3, "coins", study, 0);
            let (mut wins, mut losses) = (0, 0);
            (0..400).any(|_| {
                *if stream.chance(0.5) { &mut wins } else { &mut losses } += 1;
                is_proven(wins, losses, 0.05, 1)
            })
        });
        let share = alarms.count() as f64 / studies as f64;
        // A p-value of 0.05 read at every toss would alarm in about half of the studies.
        assert!(share <= 0.05, "{share}");
    }

    #[test]
    fn a_setting_that_wins_two_of_three_is_proven_in_time() {
        let mut stream = Stream::new(4, "coins", 0, 0);
        let (mut wins, mut losses) = (0, 0);
        while !is_proven(wins, losses, 0.05, 992) && wins + losses < 2000 {
            *if stream.chance(2.0 / 3.0) { &mut wins } else { &mut losses } += 1;
        }
        assert!(wins + losses < 500, "{wins} to {losses}");
        assert!(!is_proven(losses, wins, 0.05, 1));
    }
}

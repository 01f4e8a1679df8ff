//! The search: successive halving on paired trials, then a confirmation on trials that nobody has seen.
//!
//! All settings meet the same robot poses and noise. After each rung the better half goes on and gets as many trials as
//! the whole rung before it, so that those who matter are known best. "Better" is the front in success, work and size of
//! the map ([`front_ranks`]), within a front the higher success; a setting [`FAR_BELOW`] the best is not worth being
//! cheap.
//!
//! A setting leaves in one of two ways, and the two mean different things:
//!
//! - **beaten**: a setting that costs no more has won enough discordant pairs ([`is_proven`]). With all pairs of
//!   settings sharing [`ALPHA`], the probability that *any* setting of a search is called beaten by one that is in
//!   truth no better is at most 5 %, however often the search looks: that is the search's stopping rule, and when it
//!   leaves no more than the finalists the search ends and the trials it saved go to the confirmation.
//! - **halved**: the trials were needed elsewhere. Nothing is claimed.
//!
//! The rates of the rungs flatter those that they chose. So no rate, interval or test of a report comes from them: the
//! finalists and the origin run once more, on fresh maps, poses and noise, a number of trials fixed before.

use super::{Sample, front_ranks, is_proven};

/// A setting whose rate lies further than this below the best goes before all others.
pub const FAR_BELOW: f64 = 0.1;
/// Probability that any setting is called beaten that is not.
pub const ALPHA: f64 = 0.05;
/// Trials of each setting in any stage below which nothing is chosen: rates of fewer are hardly rates.
pub const LEAST_TRIALS: u32 = 5;
/// Share of all trials that the rungs may use.
const SEARCH_SHARE: f64 = 0.6;

/// How many trials go where.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Schedule {
    /// Settings at the start; the first is the origin that all are compared with.
    pub settings: usize,
    /// Settings left for the confirmation.
    pub finalists: usize,
    /// Trials of all settings together.
    pub trials_total: u64,
}

/// A part of the search; each has random draws of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// The rung of this index, from 0.
    Rung(usize),
    /// The finalists' fresh trials.
    Confirmation,
}

/// How a setting fared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fate {
    /// It reached the confirmation.
    Finalist,
    /// A setting that costs no more was proven better.
    Beaten {
        /// The rung after which it left, from 0.
        rung: usize,
        /// Index of the better setting.
        by: usize,
    },
    /// It was not among the better half.
    Halved {
        /// The rung after which it left, from 0.
        rung: usize,
    },
}

/// What became of one setting.
#[derive(Debug, Clone, PartialEq)]
pub struct Standing {
    /// Its trials in the rungs.
    pub searched: Sample,
    /// Its trials in the confirmation, if it was there.
    pub confirmed: Option<Sample>,
    /// How it fared.
    pub fate: Fate,
}

impl Schedule {
    /// Rungs until no more than the finalists are left.
    #[must_use]
    pub fn rung_count(&self) -> usize {
        let (mut settings, mut rungs) = (self.settings, 0);
        while settings > self.finalists.max(1) {
            settings = self.after_rung(settings);
            rungs += 1;
        }
        rungs
    }

    /// Trials of each of the `alive` settings of a rung.
    fn rung_trials(&self, alive: usize) -> u32 {
        let share = self.trials_total as f64 * SEARCH_SHARE / (self.rung_count().max(1) * alive.max(1)) as f64;
        (share as u32).max(1)
    }

    /// The least trials of all settings together that give each of them [`LEAST_TRIALS`] in every stage.
    #[must_use]
    pub fn least_trials_total(&self) -> u64 {
        let is_enough = |trials_total: u64| {
            let schedule = Self { trials_total, ..*self };
            let (mut alive, mut spent, mut least) = (self.settings, 0, u32::MAX);
            for _ in 0..self.rung_count() {
                least = least.min(schedule.rung_trials(alive));
                spent += u64::from(schedule.rung_trials(alive)) * alive as u64;
                alive = self.after_rung(alive);
            }
            // The origin is confirmed even when it is no finalist.
            let confirmed = (alive + 1).min(self.settings) as u64;
            least >= LEAST_TRIALS && trials_total.saturating_sub(spent) >= confirmed * u64::from(LEAST_TRIALS)
        };
        let mut trials_total = self.settings as u64 * u64::from(LEAST_TRIALS);
        while !is_enough(trials_total) {
            trials_total += 1;
        }
        trials_total
    }

    fn after_rung(&self, settings: usize) -> usize {
        settings.div_ceil(2).max(self.finalists.max(1))
    }
}

/// Searches: `evaluate` runs the settings of the given indices, the given number of trials each, and answers in their
/// order.
///
/// # Errors
/// The first error of `evaluate`.
pub fn search<E>(
    schedule: &Schedule,
    mut evaluate: impl FnMut(Stage, &[usize], u32) -> Result<Vec<Sample>, E>,
) -> Result<Vec<Standing>, E> {
    let begin = Standing { searched: Sample::default(), confirmed: None, fate: Fate::Finalist };
    let mut standings = vec![begin; schedule.settings];
    let mut alive: Vec<usize> = (0..schedule.settings).collect();
    let mut spent = 0;
    for rung in 0..schedule.rung_count() {
        if alive.len() <= schedule.finalists.max(1) {
            break;
        }
        let trials = schedule.rung_trials(alive.len());
        for (&setting, sample) in alive.iter().zip(evaluate(Stage::Rung(rung), &alive, trials)?) {
            standings[setting].searched.extend(sample);
        }
        spent += u64::from(trials) * alive.len() as u64;
        let places = schedule.after_rung(alive.len());
        drop_beaten(&mut standings, &mut alive, rung);
        drop_worse(&mut standings, &mut alive, rung, places);
    }
    // The origin is what everything is held against, whether it came this far or not.
    if !alive.contains(&0) {
        alive.insert(0, 0);
    }
    let trials = (schedule.trials_total.saturating_sub(spent) / alive.len().max(1) as u64).clamp(1, 1_000_000) as u32;
    for (&setting, sample) in alive.iter().zip(evaluate(Stage::Confirmation, &alive, trials)?) {
        standings[setting].confirmed = Some(sample);
    }
    Ok(standings)
}

/// Takes out every setting that one of no higher cost is proven to beat.
fn drop_beaten(standings: &mut [Standing], alive: &mut Vec<usize>, rung: usize) {
    // Every ordered pair of settings is watched from the start, whoever is left.
    let comparisons = standings.len() * standings.len().saturating_sub(1);
    let beater = |standings: &[Standing], loser: usize| {
        alive.iter().copied().find(|&rival| {
            let (one, other) = (&standings[rival].searched, &standings[loser].searched);
            let counts = one.against(other);
            one.merit().is_no_costlier_than(&other.merit())
                && is_proven(counts.only_a, counts.only_b, ALPHA, comparisons)
        })
    };
    let beaten: Vec<(usize, usize)> =
        alive.iter().filter_map(|&loser| beater(standings, loser).map(|by| (loser, by))).collect();
    for &(loser, by) in &beaten {
        standings[loser].fate = Fate::Beaten { rung, by };
    }
    alive.retain(|setting| beaten.iter().all(|(loser, _)| loser != setting));
}

/// Keeps the best `places` settings.
fn drop_worse(standings: &mut [Standing], alive: &mut Vec<usize>, rung: usize, places: usize) {
    let merits: Vec<_> = alive.iter().map(|&setting| standings[setting].searched.merit()).collect();
    let ranks = front_ranks(&merits);
    let best = merits.iter().map(|merit| merit.success).fold(0.0, f64::max);
    let mut order: Vec<usize> = (0..alive.len()).collect();
    order.sort_by(|&a, &b| {
        let is_far_below = |index: usize| merits[index].success < best - FAR_BELOW;
        (is_far_below(a), ranks[a])
            .cmp(&(is_far_below(b), ranks[b]))
            .then(merits[b].success.total_cmp(&merits[a].success))
            .then(merits[a].work.total_cmp(&merits[b].work))
    });
    for &place in order.iter().skip(places) {
        standings[alive[place]].fate = Fate::Halved { rung };
    }
    alive.retain(|&setting| standings[setting].fate == Fate::Finalist);
}

/// The confirmed settings on the front, by index.
#[must_use]
pub fn confirmed_front(standings: &[Standing]) -> Vec<usize> {
    let confirmed = confirmed_merits(standings);
    let ranks = front_ranks(&confirmed.iter().map(|(_, merit)| *merit).collect::<Vec<_>>());
    confirmed.iter().zip(ranks).filter(|(_, rank)| *rank == 0).map(|((setting, _), _)| *setting).collect()
}

/// The setting to take: the one of least work among the confirmed whose rate lies at most `within` below the best.
#[must_use]
pub fn choose(standings: &[Standing], within: f64) -> Option<usize> {
    let confirmed = confirmed_merits(standings);
    let best = confirmed.iter().map(|(_, merit)| merit.success).fold(0.0, f64::max);
    let near_best = confirmed.iter().filter(|(_, merit)| merit.success >= best - within);
    let cheapest = near_best.min_by(|(_, a), (_, b)| {
        a.work.total_cmp(&b.work).then(a.map_bytes.total_cmp(&b.map_bytes)).then(b.success.total_cmp(&a.success))
    });
    cheapest.map(|(setting, _)| *setting)
}

fn confirmed_merits(standings: &[Standing]) -> Vec<(usize, super::Merit)> {
    let merit = |(setting, standing): (usize, &Standing)| standing.confirmed.as_ref().map(|run| (setting, run.merit()));
    standings.iter().enumerate().filter_map(merit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;
    use crate::sweep::TrialResult;
    use core::convert::Infallible;

    /// Settings of known rate and work, on paired trials: a trial is as hard for one as for the other.
    fn simulate(rates: &[f64], works: &[f64], schedule: Schedule) -> Vec<Standing> {
        search(&schedule, |stage, settings, trials| {
            let stage = match stage {
                Stage::Rung(rung) => rung as u64,
                Stage::Confirmation => 99,
            };
            let sample = |&setting: &usize| Sample {
                trials: (0..trials)
                    .map(|trial| TrialResult {
                        is_success: Stream::new(5, "fake", stage, u64::from(trial)).unit() < rates[setting],
                        looks: 1,
                        work: works[setting],
                    })
                    .collect(),
                map_bytes: 1.0,
                localizer_s: 0.0,
            };
            Ok::<_, Infallible>(settings.iter().map(sample).collect())
        })
        .expect("nothing fails")
    }

    #[test]
    fn the_better_of_two_obviously_different_settings_is_kept() {
        let schedule = Schedule { settings: 2, finalists: 1, trials_total: 400 };
        for (rates, better) in [([0.9, 0.5], 0), ([0.5, 0.9], 1)] {
            let standings = simulate(&rates, &[1.0; 2], schedule);
            assert_eq!(standings[better].fate, Fate::Finalist);
            assert_eq!(standings[1 - better].fate, Fate::Beaten { rung: 0, by: better });
            assert_eq!(choose(&standings, 0.01), Some(better));
            assert!(standings[0].confirmed.is_some(), "the origin is always confirmed");
        }
    }

    #[test]
    fn a_costlier_winner_beats_nobody_and_both_stand_on_the_front() {
        let schedule = Schedule { settings: 2, finalists: 2, trials_total: 2000 };
        let standings = simulate(&[0.85, 0.9], &[1.0, 5.0], schedule);
        assert_eq!(confirmed_front(&standings), [0, 1]);
        assert_eq!((choose(&standings, 0.01), choose(&standings, 0.2)), (Some(1), Some(0)));
    }

    #[test]
    fn settings_far_below_the_best_go_first_however_cheap() {
        let schedule = Schedule { settings: 4, finalists: 2, trials_total: 2000 };
        let standings = simulate(&[0.9, 0.3, 0.88, 0.2], &[5.0, 1.0, 4.0, 0.5], schedule);
        let fates: Vec<bool> = standings.iter().map(|standing| standing.fate == Fate::Finalist).collect();
        assert_eq!(fates, [true, false, true, false]);
    }

    #[test]
    fn the_least_total_gives_every_setting_its_trials_in_every_stage_and_one_less_does_not() {
        for (settings, finalists) in [(32, 8), (4, 2), (5, 1), (2, 1), (3, 8), (100, 1)] {
            let least = Schedule { settings, finalists, trials_total: 0 }.least_trials_total();
            let fewest = |trials_total: u64| {
                let mut fewest = u32::MAX;
                let schedule = Schedule { settings, finalists, trials_total };
                // The origin is worst, so that it is confirmed beside the finalists.
                let standings = search(&schedule, |_, alive, trials| {
                    fewest = fewest.min(trials);
                    let sample = |&setting: &usize| Sample {
                        trials: (0..trials)
                            .map(|_| TrialResult { is_success: setting > 0, looks: 1, work: 1.0 })
                            .collect(),
                        map_bytes: 1.0,
                        localizer_s: 0.0,
                    };
                    Ok::<_, Infallible>(alive.iter().map(sample).collect())
                });
                assert!(standings.is_ok());
                fewest
            };
            assert_eq!(fewest(least), LEAST_TRIALS, "{settings} settings, {finalists} finalists");
            assert!(fewest(least - 1) < LEAST_TRIALS, "{settings} settings, {finalists} finalists: {least}");
        }
    }

    #[test]
    fn all_trials_are_spent_and_none_more() {
        for (settings, finalists, trials_total) in [(32, 8, 20_000), (5, 2, 1000), (2, 8, 500)] {
            let schedule = Schedule { settings, finalists, trials_total };
            let rates: Vec<f64> = (0..settings).map(|index| 0.8 + 0.001 * index as f64).collect();
            let standings = simulate(&rates, &vec![1.0; settings], schedule);
            let spent = standings.iter().map(|standing| {
                standing.searched.trials.len() + standing.confirmed.as_ref().map_or(0, |run| run.trials.len())
            });
            let spent = spent.sum::<usize>() as u64;
            assert!(spent <= trials_total && spent > trials_total * 9 / 10, "{spent} of {trials_total}");
        }
    }
}

//! What the answers of a row are worth: how many there are, how many are wrong, how far off the poses, how honest the
//! probabilities. A localiser that may say "I can't tell" is judged by more than its success rate.

use crate::monte_carlo::{Outcome, SuccessRate, TrialRecord};
use crate::scenario::Start;
use serde::{Deserialize, Serialize};

/// Bins of the reliability curve, of equally many answers each.
const RELIABILITY_BINS: usize = 10;
/// Answers below which a bin of the reliability curve says too little: there are fewer bins then.
const LEAST_ANSWERS_PER_BIN: usize = 20;

/// A share of a row's trials or answers, with its 95 % Wilson interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// How many.
    pub count: u64,
    /// Of how many.
    pub of: u64,
    /// The share, a fraction; none of none.
    pub rate: Option<f64>,
    /// Lower end of the interval, a fraction.
    pub low: f64,
    /// Upper end of the interval, a fraction.
    pub high: f64,
}

impl Share {
    /// The share of those that are so.
    #[must_use]
    pub fn of(are_so: impl IntoIterator<Item = bool>) -> Self {
        let SuccessRate { successes, trials } = SuccessRate::of(are_so);
        Self::from_counts(successes, trials)
    }

    /// `count` of so many.
    #[must_use]
    pub fn from_counts(count: u64, of: u64) -> Self {
        let rate = SuccessRate { successes: count, trials: of };
        let (low, high) = rate.success_interval();
        Self { count, of, rate: rate.rate(), low, high }
    }
}

/// What the answers of a row are worth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AnswerFigures {
    /// Trials that were answered with a place, of all trials.
    pub coverage: Share,
    /// Wrong answers, of all answers. Where starts are unlearned every answer is wrong, and they count of all trials.
    pub false_accepts: Share,
    /// Trials answered rightly, or with the truth among the rivals named, of all trials.
    pub truth_named: Share,
    /// Answers whose pose is within half a metre of the truth though the node is not one of the two nearest.
    pub near_ties: u64,
    /// Median distance of the poses answered from the truth in metres; none without poses.
    pub pose_error_median_m: Option<f64>,
    /// 95 % of the poses answered are nearer to the truth than this, in metres.
    pub pose_error_95_m: Option<f64>,
    /// 99 % of the poses answered are nearer to the truth than this, in metres.
    pub pose_error_99_m: Option<f64>,
    /// Median of how far the headings answered are off, either way, in degrees.
    pub heading_error_median_deg: Option<f64>,
    /// Expected calibration error of the probabilities stated, a fraction; see [`expected_calibration_error`].
    pub calibration_error: Option<f64>,
}

impl AnswerFigures {
    /// The figures of `records`, trials with one kind of start.
    #[must_use]
    pub fn new(start: Start, records: &[&TrialRecord]) -> Self {
        let is_answered = |record: &&&TrialRecord| record.outcome == Outcome::Localized;
        let answers: Vec<&TrialRecord> = records.iter().filter(is_answered).copied().collect();
        let coverage = Share::from_counts(answers.len() as u64, records.len() as u64);
        let is_metric = start != Start::Unlearned;
        let errors = |error: fn(&TrialRecord) -> Option<f32>| -> Vec<f64> {
            let errors = answers.iter().filter(|_| is_metric).filter_map(|record| error(record));
            let mut errors: Vec<f64> = errors.map(|error| f64::from(error.abs())).collect();
            errors.sort_by(f64::total_cmp);
            errors
        };
        let (pose, heading) = (errors(|record| record.pose_error_m), errors(|record| record.heading_error_deg));
        Self {
            coverage,
            false_accepts: if start == Start::Unlearned {
                coverage
            } else {
                Share::of(answers.iter().map(|record| !record.is_success))
            },
            truth_named: Share::of(records.iter().map(|record| record.is_truth_named)),
            near_ties: records.iter().filter(|record| record.is_near_tie).count() as u64,
            pose_error_median_m: quantile(&pose, 0.5),
            pose_error_95_m: quantile(&pose, 0.95),
            pose_error_99_m: quantile(&pose, 0.99),
            heading_error_median_deg: quantile(&heading, 0.5),
            calibration_error: expected_calibration_error(&reliability(answers.iter().copied())),
        }
    }
}

/// A bin of the reliability curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReliabilityBin {
    /// Mean of the probabilities stated.
    pub stated: f64,
    /// How many of the answers are right.
    pub right: SuccessRate,
}

/// The reliability curve of the answers that state a probability, by rising probability: bins of equally many answers,
/// because most probabilities are close to one (Nguyen and O'Connor 2015).
#[must_use]
pub fn reliability<'r>(records: impl Iterator<Item = &'r TrialRecord>) -> Vec<ReliabilityBin> {
    let answers = records.filter(|record| record.outcome == Outcome::Localized);
    let stated = answers.filter_map(|record| Some((f64::from(record.probability?), record.is_success)));
    let mut stated: Vec<(f64, bool)> = stated.collect();
    stated.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let bins = (stated.len() / LEAST_ANSWERS_PER_BIN).clamp(1, RELIABILITY_BINS);
    let border = |bin: usize| bin * stated.len() / bins;
    let bin = |bin: usize| {
        let answers = &stated[border(bin)..border(bin + 1)];
        ReliabilityBin {
            stated: answers.iter().map(|(probability, _)| probability).sum::<f64>() / answers.len() as f64,
            right: SuccessRate::of(answers.iter().map(|(_, is_right)| *is_right)),
        }
    };
    if stated.is_empty() { Vec::new() } else { (0..bins).map(bin).collect() }
}

/// Mean distance, weighed by answers, between the probability stated and the rate that came true (Naeini et al. 2015);
/// none without answers.
#[must_use]
pub fn expected_calibration_error(bins: &[ReliabilityBin]) -> Option<f64> {
    let answers: u64 = bins.iter().map(|bin| bin.right.trials).sum();
    let distance = |bin: &ReliabilityBin| Some((bin.stated - bin.right.rate()?).abs() * bin.right.trials as f64);
    (answers > 0).then(|| bins.iter().filter_map(distance).sum::<f64>() / answers as f64)
}

/// The value that a share of the `sorted` values does not exceed, linear between neighbours; none of none.
fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let place = share * sorted.len().checked_sub(1)? as f64;
    let (low, high) = (sorted.get(place.floor() as usize)?, sorted.get(place.ceil() as usize)?);
    Some(low + (high - low) * (place - place.floor()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    fn records(count: usize, change: impl Fn(usize, &mut TrialRecord)) -> Vec<TrialRecord> {
        let base = sample::run().results.records.swap_remove(0);
        let record = |index| {
            let mut record = TrialRecord { outcome: Outcome::Localized, is_success: true, ..base.clone() };
            record.is_truth_named = true;
            change(index, &mut record);
            record
        };
        (0..count).map(record).collect()
    }

    fn figures(start: Start, records: &[TrialRecord]) -> AnswerFigures {
        AnswerFigures::new(start, &records.iter().collect::<Vec<_>>())
    }

    #[test]
    fn unknown_is_a_failure_but_no_false_accept_and_errors_are_of_answers_alone() {
        let records = records(100, |index, record| {
            record.pose_error_m = Some(0.01 * index as f32);
            record.heading_error_deg = Some(if index.is_multiple_of(2) { -0.5 } else { 0.5 });
            if index >= 90 {
                record.outcome = Outcome::Unknown;
                (record.pose_error_m, record.heading_error_deg) = (None, None);
                (record.is_success, record.is_truth_named) = (false, index < 96);
            } else if index >= 87 {
                (record.is_success, record.is_truth_named, record.is_near_tie) = (false, false, index == 89);
            }
        });
        let found = figures(Start::Anywhere, &records);
        assert_eq!((found.coverage.count, found.coverage.of), (90, 100));
        assert_eq!((found.false_accepts.count, found.false_accepts.of, found.near_ties), (3, 90, 1));
        assert_eq!((found.truth_named.count, found.truth_named.of), (93, 100));
        let is_near = |found: Option<f64>, expected: f64| found.is_some_and(|found| (found - expected).abs() < 1e-6);
        assert!(is_near(found.pose_error_median_m, 0.445) && is_near(found.pose_error_95_m, 0.8455), "{found:?}");
        assert!(is_near(found.pose_error_99_m, 0.8811) && is_near(found.heading_error_median_deg, 0.5), "{found:?}");
    }

    #[test]
    fn every_answer_in_an_unlearned_place_is_a_false_accept_of_all_trials() {
        let records = records(40, |index, record| {
            record.pose_error_m = Some(9.0);
            record.is_success = index >= 2;
            if record.is_success {
                record.outcome = Outcome::Unknown;
            }
        });
        let found = figures(Start::Unlearned, &records);
        assert_eq!((found.false_accepts.count, found.false_accepts.of), (2, 40));
        assert_eq!((found.coverage, found.pose_error_median_m), (found.false_accepts, None));
    }

    #[test]
    fn a_curve_of_honest_probabilities_is_straight_and_overconfidence_has_an_error() {
        let stated = |index: usize| if index.is_multiple_of(2) { 0.75 } else { 1.0 };
        let honest = records(400, |index, record| {
            record.probability = Some(stated(index));
            record.is_success = !index.is_multiple_of(8);
        });
        let bins = reliability(honest.iter());
        assert_eq!((bins.len(), bins[0].right.trials), (10, 40));
        assert!(expected_calibration_error(&bins).is_some_and(|error| error < 1e-9), "{bins:?}");

        let boastful = records(400, |index, record| {
            record.probability = Some(1.0);
            record.is_success = !index.is_multiple_of(4);
        });
        let error = expected_calibration_error(&reliability(boastful.iter()));
        assert!(error.is_some_and(|error| (error - 0.25).abs() < 1e-9), "{error:?}");

        let silent = records(50, |_, record| record.probability = None);
        assert_eq!(expected_calibration_error(&reliability(silent.iter())), None);
    }
}

//! Progress on standard error: rate, time to go and the success rate so far; silent unless it is a terminal.

use edgeloc_sim::monte_carlo::{SuccessRate, TimedTrial, TrialRecord};
use edgeloc_sim::scenario::Scenario;
use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::Mutex;
use std::time::Duration;

const BAR: &str = "{bar:24} {pos}/{len} trials, {rate}, {eta} to go  {msg}";

/// A turning wheel beside what is being done, until it is dropped.
pub(super) fn wheel(what: &'static str) -> Wheel {
    let bar = ProgressBar::new_spinner().with_message(what);
    bar.enable_steady_tick(Duration::from_millis(100));
    Wheel { bar }
}

/// See [`wheel`].
pub(super) struct Wheel {
    bar: ProgressBar,
}

impl Wheel {
    /// Says anew what is being done.
    pub(super) fn say(&self, what: String) {
        self.bar.set_message(what);
    }
}

impl Drop for Wheel {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// A bar of `count` steps, until it is dropped.
pub(super) fn bar(count: usize, what: &'static str) -> Bar {
    let style = ProgressStyle::with_template("{bar:24} {pos}/{len} {msg}, {eta} to go");
    let bar = ProgressBar::new(count as u64).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar.enable_steady_tick(Duration::from_millis(200));
    Bar { bar: bar.with_message(what) }
}

/// See [`bar`].
pub(super) struct Bar {
    bar: ProgressBar,
}

impl Bar {
    /// Counts a step.
    pub(super) fn step(&self) {
        self.steps(1);
    }

    /// Counts so many steps.
    pub(super) fn steps(&self, count: usize) {
        self.bar.inc(count as u64);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// The progress of a run.
pub(super) struct TrialProgress {
    bar: ProgressBar,
    rates: Mutex<BTreeMap<String, SuccessRate>>,
}

impl TrialProgress {
    /// The bar of all trials of a scenario.
    pub(super) fn new(scenario: &Scenario) -> Self {
        Self::going_on(scenario.total_trials() as usize, &[])
    }

    /// The bar of so many trials, some of them done before.
    pub(super) fn going_on(trials: usize, done: &[TimedTrial]) -> Self {
        let style = ProgressStyle::with_template(BAR).unwrap_or_else(|_| ProgressStyle::default_bar());
        let style = style.with_key("rate", |state: &ProgressState, output: &mut dyn Write| {
            let _ = write!(output, "{:.1}/s", state.per_sec());
        });
        let bar = ProgressBar::new(trials as u64).with_style(style);
        bar.enable_steady_tick(Duration::from_millis(200));
        let progress = Self { bar, rates: Mutex::default() };
        done.iter().for_each(|trial| progress.count(&trial.record));
        // The rate is of what is done from now on.
        progress.bar.reset_eta();
        progress
    }

    /// Counts a trial that ended.
    pub(super) fn count(&self, record: &TrialRecord) {
        if let Ok(mut rates) = self.rates.lock() {
            let rate = rates.entry(record.row.clone()).or_default();
            rate.trials += 1;
            rate.successes += u64::from(record.is_success);
            self.bar.set_message(format!("{}: {rate}", record.row));
        }
        self.bar.inc(1);
    }
}

impl Drop for TrialProgress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

//! The table at the end: what passed, what failed, what was skipped and why, and the exit code that follows.

use std::fmt;
use std::time::Duration;

/// How a step ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Everything in it was run and is in order.
    Passed,
    /// Something is wrong, named here.
    Failed(String),
    /// It could not be run here, for this reason.
    Skipped(String),
}

/// One step that was asked for.
#[derive(Debug)]
pub(crate) struct StepReport {
    pub(crate) name: &'static str,
    pub(crate) outcome: Outcome,
    pub(crate) elapsed: Duration,
}

/// All steps that were asked for.
#[derive(Debug)]
pub(crate) struct Summary {
    pub(crate) reports: Vec<StepReport>,
    /// Continuous integration: nothing may be skipped.
    pub(crate) is_ci: bool,
}

impl Summary {
    /// Whether the gate lets this pass.
    pub(crate) fn is_success(&self) -> bool {
        self.failed() == 0 && !(self.is_ci && self.skipped() > 0)
    }

    fn failed(&self) -> usize {
        self.reports.iter().filter(|report| matches!(report.outcome, Outcome::Failed(_))).count()
    }

    fn skipped(&self) -> usize {
        self.reports.iter().filter(|report| matches!(report.outcome, Outcome::Skipped(_))).count()
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for report in &self.reports {
            let time = format!("{:.1} s", report.elapsed.as_secs_f64());
            let (word, reason) = match &report.outcome {
                Outcome::Passed => ("passed", ""),
                Outcome::Failed(reason) => ("FAILED", reason.as_str()),
                Outcome::Skipped(reason) => ("SKIPPED", reason.as_str()),
            };
            let line = format!("{:<10} {word:<8} {time:>9}  {reason}", report.name);
            writeln!(f, "{}", line.trim_end())?;
        }
        let (failed, skipped) = (self.failed(), self.skipped());
        if self.is_ci && skipped > 0 {
            writeln!(f, "CI=true: a skipped step fails the gate")?;
        }
        write!(f, "{} passed, {failed} failed", self.reports.len() - failed - skipped)?;
        if skipped > 0 {
            write!(f, ", {skipped} skipped")?;
        }
        writeln!(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn summary(is_ci: bool, outcomes: &[Outcome]) -> Summary {
        let report = |outcome: &Outcome| StepReport {
            name: "sample",
            outcome: outcome.clone(),
            elapsed: Duration::from_millis(1250),
        };
        Summary { reports: outcomes.iter().map(report).collect(), is_ci }
    }

    fn failed() -> Outcome {
        Outcome::Failed("2 tests".to_owned())
    }

    fn skipped() -> Outcome {
        Outcome::Skipped("no emulator".to_owned())
    }

    #[test]
    fn one_failure_among_many_fails_the_gate() {
        assert!(summary(false, &[Outcome::Passed, Outcome::Passed]).is_success());
        assert!(!summary(false, &[Outcome::Passed, failed(), Outcome::Passed]).is_success());
    }

    #[test]
    fn a_skip_fails_only_under_ci() {
        assert!(summary(false, &[Outcome::Passed, skipped()]).is_success());
        assert!(!summary(true, &[Outcome::Passed, skipped()]).is_success());
        assert!(summary(true, &[Outcome::Passed]).is_success());
    }

    #[test]
    fn the_last_line_counts_steps_and_stands_alone() {
        let text = summary(true, &[Outcome::Passed, failed(), skipped()]).to_string();
        assert_eq!(text.lines().last(), Some("1 passed, 1 failed, 1 skipped"));
        assert!(text.contains("sample     FAILED       1.2 s  2 tests\n"), "{text}");
        let clean = summary(false, &[Outcome::Passed]).to_string();
        assert_eq!(clean.lines().last(), Some("1 passed, 0 failed"));
    }
}

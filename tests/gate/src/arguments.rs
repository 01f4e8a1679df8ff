//! What was asked for: the whole gate, its quick part, or steps by name.

use std::fmt;

use crate::steps::Step;

/// A command line understood.
#[derive(Debug)]
pub(crate) enum Request {
    /// Print the help.
    Help,
    /// Run steps.
    Run {
        /// Which, in the gate's order.
        steps: Vec<&'static Step>,
        /// Whether what is counted becomes the budget.
        is_blessing: bool,
    },
}

/// Makes budgets of what is counted.
const BLESS: &str = "--bless";

/// A word of the command line that is neither a step nor an option.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct UnknownStep {
    word: String,
    known: Vec<&'static str>,
}

impl fmt::Display for UnknownStep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no step is called `{}`; the steps are: {} (or `quick`)", self.word, self.known.join(", "))
    }
}

/// Reads the arguments after the program's name. No argument means every step of the full gate.
pub(crate) fn parse(arguments: &[String], steps: &'static [Step]) -> Result<Request, UnknownStep> {
    if arguments.iter().any(|word| word == "--help" || word == "-h" || word == "help") {
        return Ok(Request::Help);
    }
    let is_blessing = arguments.iter().any(|word| word == BLESS);
    let arguments: Vec<&String> = arguments.iter().filter(|word| *word != BLESS).collect();
    let unknown = |word: &&&String| **word != "quick" && steps.iter().all(|step| step.name != **word);
    if let Some(word) = arguments.iter().find(unknown) {
        return Err(UnknownStep { word: (*word).clone(), known: steps.iter().map(|step| step.name).collect() });
    }
    let is_named = |name: &str| arguments.iter().any(|word| *word == name);
    let is_chosen = |step: &&Step| {
        if arguments.is_empty() { step.is_in_full } else { is_named(step.name) || (is_named("quick") && step.is_quick) }
    };
    Ok(Request::Run { steps: steps.iter().filter(is_chosen).collect(), is_blessing })
}

/// The help: what the gate does, its steps and examples.
pub(crate) fn help(steps: &[Step]) -> String {
    let mut text = String::from(
        "Checks everything, or the steps named.\n\n\
         Usage: cargo gate [quick | STEP...] [--bless]\n\n\
         --bless makes the instruction budgets of boards what they take today.\n\n\
         Steps (* also in quick, + only in quick or by name):\n",
    );
    for step in steps {
        let mark = match (step.is_in_full, step.is_quick) {
            (false, _) => '+',
            (true, true) => '*',
            (true, false) => ' ',
        };
        text.push_str(&format!("  {:<10}{mark} {}\n", step.name, step.about));
    }
    text.push_str(
        "\nExamples:\n  \
         cargo gate               all of it, as continuous integration runs it\n  \
         cargo gate quick         what to run before every commit\n  \
         cargo gate thumb qemu    two steps alone\n\n\
         Environment:\n  \
         CI=true            a skipped step fails the gate\n  \
         EDGELOC_DATA       folder of the real buildings' data (default: ../shared/data)\n  \
         CARGO_TARGET_DIR   where everything is built\n",
    );
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::summary::Outcome;

    const fn step(name: &'static str, is_in_full: bool, is_quick: bool) -> Step {
        Step { name, about: "sample", is_in_full, is_quick, run: |_| Outcome::Passed }
    }

    static SAMPLE: &[Step] = &[step("setup", true, false), step("lint", true, true), step("units", false, true)];

    fn chosen(words: &[&str]) -> Vec<&'static str> {
        let words: Vec<String> = words.iter().map(|&word| word.to_owned()).collect();
        match parse(&words, SAMPLE).expect("the words are known") {
            Request::Run { steps, .. } => steps.iter().map(|step| step.name).collect(),
            Request::Help => panic!("no help was asked for"),
        }
    }

    #[test]
    fn no_argument_means_the_full_gate() {
        assert_eq!(chosen(&[]), ["setup", "lint"]);
    }

    #[test]
    fn blessing_is_no_step() {
        assert_eq!(chosen(&["--bless"]), ["setup", "lint"]);
        let words = ["--bless".to_owned(), "lint".to_owned()];
        assert!(matches!(parse(&words, SAMPLE), Ok(Request::Run { is_blessing: true, .. })));
        assert!(matches!(parse(&words[1..], SAMPLE), Ok(Request::Run { is_blessing: false, .. })));
    }

    #[test]
    fn quick_takes_the_quick_steps_and_may_be_extended() {
        assert_eq!(chosen(&["quick"]), ["lint", "units"]);
        assert_eq!(chosen(&["quick", "setup"]), ["setup", "lint", "units"]);
    }

    #[test]
    fn named_steps_run_once_each_in_the_order_of_the_gate() {
        assert_eq!(chosen(&["units", "setup", "units"]), ["setup", "units"]);
    }

    #[test]
    fn an_unknown_step_is_refused_with_the_list() {
        let error = parse(&["lint".to_owned(), "lnit".to_owned()], SAMPLE).expect_err("`lnit` is no step");
        assert_eq!(error.to_string(), "no step is called `lnit`; the steps are: setup, lint, units (or `quick`)");
    }

    #[test]
    fn help_wins_and_names_every_step() {
        let words = ["lint".to_owned(), "--help".to_owned()];
        assert!(matches!(parse(&words, SAMPLE), Ok(Request::Help)));
        let text = help(SAMPLE);
        assert!(SAMPLE.iter().all(|step| text.contains(step.name)), "{text}");
    }
}

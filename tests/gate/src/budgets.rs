//! Instruction budgets: what boards count is held against a committed file.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use std::{fs, io};

/// A count may exceed its budget by so many hundredths.
const TOLERANCE_PERCENT: u64 = 3;

const REMEDY: &str = "if that is meant: cargo gate qemu --bless";

const HEAD: &str = "\
# What the localizer may cost on each emulated board, in instructions; `cargo gate` fails above 3 % more, and
# `cargo gate qemu --bless` writes the file anew. What is counted: boards/firmware/src/budgets.rs.
";

/// Counts by name.
pub(crate) type Counts = BTreeMap<String, u64>;

/// Counts by board.
pub(crate) type Budgets = BTreeMap<String, Counts>;

/// The counts among the lines that a board printed: `budget NAME COUNT`.
pub(crate) fn counted(output: &str) -> Counts {
    let read = |line: &str| {
        let (name, count) = line.strip_prefix("budget ")?.split_once(' ')?;
        Some((name.to_owned(), count.trim().parse().ok()?))
    };
    output.lines().filter_map(read).collect()
}

/// Reads the committed budgets.
pub(crate) fn read(path: &Path) -> io::Result<Budgets> {
    fs::read_to_string(path).map(|text| parse(&text))
}

/// Replaces the committed budgets.
pub(crate) fn write(path: &Path, budgets: &Budgets) -> io::Result<()> {
    fs::write(path, format(budgets))
}

fn parse(text: &str) -> Budgets {
    let mut budgets = Budgets::new();
    let mut board = String::new();
    for line in text.lines() {
        if let Some(name) = line.strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
            name.clone_into(&mut board);
        } else if let Some((name, count)) = line.split_once('=')
            && let Ok(count) = count.trim().replace('_', "").parse()
        {
            budgets.entry(board.clone()).or_default().insert(name.trim().to_owned(), count);
        }
    }
    budgets
}

fn format(budgets: &Budgets) -> String {
    let mut text = HEAD.to_owned();
    for (board, counts) in budgets {
        // Writing to a string can't fail.
        let _ = writeln!(text, "\n[{board}]");
        for (name, count) in counts {
            let _ = writeln!(text, "{name} = {}", grouped(*count));
        }
    }
    text
}

/// A number with its digits in groups of three.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push('_');
        }
        text.push(digit);
    }
    text
}

/// What is wrong with a board's counts; lines about each count go to `say`.
pub(crate) fn violations(
    board: &str,
    budgets: Option<&Counts>,
    counted: &Counts,
    mut say: impl FnMut(String),
) -> Vec<String> {
    let none = Counts::new();
    let budgets = budgets.unwrap_or(&none);
    let mut found = Vec::new();
    for (name, &count) in counted {
        let Some(&budget) = budgets.get(name) else {
            found.push(format!("{board} has no budget for {name}; {REMEDY}"));
            continue;
        };
        let percent = 100.0 * (count as f64 / budget as f64 - 1.0);
        say(format!("{board}: {name} takes {} instructions, {percent:+.1} % of its budget", grouped(count)));
        if count * 100 > budget * (100 + TOLERANCE_PERCENT) {
            found.push(format!(
                "{board}: {name} takes {} instructions for {}; {REMEDY}",
                grouped(count),
                grouped(budget)
            ));
        } else if count * 100 < budget * (100 - TOLERANCE_PERCENT) {
            say(format!("{board}: {name} has become cheaper; keep that: cargo gate qemu --bless"));
        }
    }
    for name in budgets.keys().filter(|name| !counted.contains_key(*name)) {
        found.push(format!("{board} did not count {name}"));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counts(pair: u64) -> Counts {
        Counts::from([("histogram_pair".to_owned(), pair)])
    }

    fn violations_of(pair: u64) -> Vec<String> {
        violations("board", Some(&counts(1000)), &counts(pair), |_| ())
    }

    #[test]
    fn a_budget_is_kept_up_to_the_tolerance() {
        assert!(violations_of(500).is_empty());
        assert!(violations_of(1030).is_empty());
        assert_eq!(violations_of(1031).len(), 1);
    }

    #[test]
    fn a_count_without_a_budget_and_a_budget_without_a_count_are_found() {
        assert_eq!(violations("board", None, &counts(1), |_| ()).len(), 1);
        assert_eq!(violations("board", Some(&counts(1)), &Counts::new(), |_| ()).len(), 1);
    }

    #[test]
    fn what_becomes_cheaper_is_told() {
        let mut said = Vec::new();
        violations("board", Some(&counts(1000)), &counts(900), |line| said.push(line));
        assert_eq!(said.len(), 2);
    }

    #[test]
    fn counts_are_found_among_other_lines() {
        assert_eq!(counted("3 looks\nbudget histogram_pair 109\nbudget broken\n"), counts(109));
    }

    #[test]
    fn the_file_is_read_as_it_was_written() {
        let budgets = Budgets::from([("a".to_owned(), counts(1_234_567)), ("b".to_owned(), counts(89))]);
        let text = format(&budgets);
        assert!(text.contains("[a]\nhistogram_pair = 1_234_567\n"), "{text}");
        assert_eq!(parse(&text), budgets);
    }
}

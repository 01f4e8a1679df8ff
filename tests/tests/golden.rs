//! The golden vectors are what is made today, cover what they should, and the comparison finds a single wrong bit.

use std::sync::LazyLock;

use edgeloc_firmware::{MEMORY_WORDS, Mismatch, compare};
use edgeloc_tests::golden::Golden;

/// What is made today, worked out once for all tests.
static MADE: LazyLock<Golden> = LazyLock::new(Golden::make);

/// What is committed; under `EDGELOC_BLESS` what is made today is saved first.
static COMMITTED: LazyLock<Golden> = LazyLock::new(|| {
    if std::env::var_os("EDGELOC_BLESS").is_some() {
        MADE.save().expect("the fixtures can be written");
    }
    Golden::load().expect("golden vectors are committed")
});

/// The lines that a replay of `golden` disagrees with.
fn mismatches(golden: &Golden) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let note = |line: Mismatch<'_>| found.push((line.expected.to_owned(), line.actual.to_owned()));
    let counts = compare(&golden.map, &golden.looks, &golden.expected, &mut vec![0; MEMORY_WORDS], note)
        .expect("golden vectors can be replayed");
    assert_eq!(counts.mismatches as usize, found.len());
    found
}

#[test]
fn the_committed_vectors_are_what_is_made_today() {
    let (made, committed) = (&*MADE, &*COMMITTED);
    let remedy = "if that is meant: EDGELOC_BLESS=1 cargo test -p edgeloc-tests --test golden, and commit the change";
    for (old, new) in [
        (&committed.expected, &made.expected),
        (&committed.kernels, &made.kernels),
        (&committed.learned, &made.learned),
    ] {
        if let Some((old, new)) = old.lines().zip(new.lines()).find(|(old, new)| old != new) {
            panic!("the golden answers changed, first\n  from {old}\n  to   {new}\n{remedy}");
        }
        assert!(old == new, "there are more or fewer golden answers than committed; {remedy}");
    }
    assert!(committed.map == made.map, "the golden map changed; {remedy}");
    assert!(committed.joined_map == made.joined_map, "the golden joined map changed; {remedy}");
    assert!(committed.looks == made.looks, "the golden looks changed; {remedy}");
}

#[test]
fn this_machine_agrees_with_the_committed_answers() {
    assert_eq!(mismatches(&COMMITTED), []);
}

#[test]
fn a_wrong_score_a_missing_and_a_surplus_line_are_found() {
    let golden = COMMITTED.clone();
    let last_digit = golden.expected.trim_end().len() - 1;
    let mut wrong = golden.clone();
    let digit = if wrong.expected.as_bytes()[last_digit] == b'0' { "1" } else { "0" };
    wrong.expected.replace_range(last_digit..=last_digit, digit);
    assert_eq!(mismatches(&wrong).len(), 1);

    let mut missing = golden.clone();
    missing.expected.truncate(golden.expected.trim_end().rfind('\n').expect("many lines"));
    assert_eq!(mismatches(&missing).len(), 1);

    let mut surplus = golden;
    surplus.expected.push_str("one more\n");
    assert_eq!(mismatches(&surplus), [("one more".to_owned(), String::new())]);
}

#[test]
fn every_kind_of_answer_is_covered() {
    let expected = &COMMITTED.expected;
    let count = |part: &str| expected.lines().filter(|line| line.contains(part)).count();
    assert!(count("Ok(") + count("Err(") >= 200, "{} looks", expected.lines().count());
    for part in [
        "Ok(Localized",
        "Ok(LookAgain { turn: Angle { radians: 0.5",
        "Ok(LookAgain { turn: Angle { radians: -1.3",
        "Ok(Unknown { reason: SceneTooPoor })",
        "Err(HeadingMissing)",
        "scene buffer segments",
        "localizer memory in 64-bit words",
        "Config(Shape(BinCount))",
        "Config(ScoreMargin)",
        "Config(MaxLooks)",
    ] {
        assert!(count(part) > 0, "no golden answer holds `{part}`");
    }
}

#[test]
fn every_kind_of_thing_learned_is_covered() {
    let learned = &COMMITTED.learned;
    for part in [
        "rejected_pairs: 0",
        "rejected_pairs: 1",
        "rig 3.3: (Ok(",
        "rig 3 error: Ok(",
        "Err(Deviation), Err(Noise), Err(Corner { index: 0 }), Err(Parameters)",
        "Finish(ClosedRoom",
        "Finish(Explored",
        "Finish(StepLimit)",
    ] {
        assert!(learned.contains(part), "nothing learned holds `{part}`");
    }
}

#[test]
fn damaged_looks_are_errors() {
    let golden = &*COMMITTED;
    let mut memory = vec![0; MEMORY_WORDS];
    for length in 0..1000 {
        let cut = &golden.looks[..length];
        assert!(compare(&golden.map, cut, "", &mut memory, |_| ()).is_err(), "cut to {length} bytes");
    }
    assert!(compare(&golden.map, b"edgelook\x03\0\0\0\0\0\0\0", "", &mut memory, |_| ()).is_err());
    assert!(compare(&golden.looks, &golden.looks, "", &mut memory, |_| ()).is_err());
}

//! Lines held against the lines expected, one by one.

/// A line that is not as expected; an empty one is missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mismatch<'a> {
    /// What the host got.
    pub expected: &'a str,
    /// What this machine got.
    pub actual: &'a str,
}

/// A comparison under way.
#[derive(Debug)]
pub struct Comparison<'e, F> {
    expected: core::str::Lines<'e>,
    on_mismatch: F,
    lines: u32,
    mismatches: u32,
}

impl<'e, F: FnMut(Mismatch<'_>)> Comparison<'e, F> {
    /// Nothing compared yet; each line that differs will go to `on_mismatch`.
    pub fn new(expected: &'e str, on_mismatch: F) -> Self {
        Self { expected: expected.lines(), on_mismatch, lines: 0, mismatches: 0 }
    }

    /// Compares the next line.
    pub fn line(&mut self, actual: &str) {
        let expected = self.expected.next().unwrap_or_default();
        self.lines += 1;
        self.note(expected, actual);
    }

    /// Lines compared, and how many differ, are left over or are missing.
    pub fn finish(mut self) -> (u32, u32) {
        while let Some(left_over) = self.expected.next() {
            self.note(left_over, "");
        }
        (self.lines, self.mismatches)
    }

    fn note(&mut self, expected: &str, actual: &str) {
        if expected != actual {
            self.mismatches += 1;
            (self.on_mismatch)(Mismatch { expected, actual });
        }
    }
}

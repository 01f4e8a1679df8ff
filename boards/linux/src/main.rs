//! The localizer on a Linux machine: kernels and golden attempts, held against the golden answers.
//!
//! Exit codes: 0 when all that was compared is as expected, 1 when something differs, 2 when nothing could be compared.

use std::fmt;
use std::process::ExitCode;

use edgeloc_firmware::{MEMORY_WORDS, accept, golden};

fn main() -> ExitCode {
    match accept(&golden::MAP, &mut vec![0; MEMORY_WORDS], &mut Console) {
        Ok(verdict) => verdict.exit_code().into(),
        Err(fmt::Error) => 2.into(),
    }
}

/// The standard output.
struct Console;

impl fmt::Write for Console {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        print!("{text}");
        Ok(())
    }
}

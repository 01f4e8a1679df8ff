//! What a machine has to show before it may localize robots: kernels and localizer give the host's bits.

use core::fmt;

use crate::{Comparison, Counts, Mismatch, compare, golden, run_kernels};

/// Mismatches printed in full.
const PRINTED: u32 = 5;

/// How a machine did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Every line is the host's.
    Agrees,
    /// At least one is not.
    Differs,
    /// The golden attempts can't be replayed.
    CantReplay,
}

impl Verdict {
    /// The program's exit code.
    #[must_use]
    pub const fn exit_code(self) -> u8 {
        match self {
            Self::Agrees => 0,
            Self::Differs => 1,
            Self::CantReplay => 2,
        }
    }
}

/// Runs the kernels on drawn inputs and replays the golden attempts on `map`, the bytes of [`golden::MAP`], in `memory`
/// of [`MEMORY_WORDS`](crate::MEMORY_WORDS); what there is to say goes to `out`.
///
/// # Errors
/// When `out` fails.
pub fn accept(map: &[u8], memory: &mut [u64], out: &mut impl fmt::Write) -> Result<Verdict, fmt::Error> {
    let mut printed = 0;
    let mut written = Ok(());
    let mut print = |line: Mismatch<'_>, out: &mut dyn fmt::Write| {
        if printed < PRINTED {
            printed += 1;
            written = written.and(writeln!(out, "expected {}\n     got {}", line.expected, line.actual));
        }
    };
    let mut kernels = Comparison::new(golden::KERNELS, |line: Mismatch<'_>| print(line, out));
    run_kernels(|line| kernels.line(line));
    let (kernel_lines, differing_kernels) = kernels.finish();
    let replayed = compare(map, golden::LOOKS, golden::ANSWERS, memory, |line| print(line, out));
    written?;
    if differing_kernels > 0 {
        writeln!(out, "{differing_kernels} of {kernel_lines} kinds of kernel input differ from the host's")?;
    }
    match replayed {
        Ok(Counts { attempts, looks, mismatches: 0 }) => {
            writeln!(out, "{kernel_lines} kinds of kernel input and {looks} looks in {attempts} attempts compared")?;
            Ok(if differing_kernels == 0 { Verdict::Agrees } else { Verdict::Differs })
        }
        Ok(counts) => {
            writeln!(out, "{} of {} looks differ from the host's", counts.mismatches, counts.looks)?;
            Ok(Verdict::Differs)
        }
        Err(error) => {
            writeln!(out, "the golden attempts can't be replayed: {error}")?;
            Ok(Verdict::CantReplay)
        }
    }
}

//! The localizer on a Cortex-M7 under QEMU: golden attempts on a map in flash, held against the host's answers.
//!
//! Exits through semihosting: 0 when every decision and every score is the host's, 1 when one differs, 2 when nothing
//! could be compared, 101 after a panic, 102 after a fault.
#![no_std]
#![no_main]

use cortex_m::singleton;
use cortex_m_rt::{ExceptionFrame, entry, exception};
use edgeloc_firmware::{MEMORY_WORDS, Mismatch, compare};
use semihosting::{eprintln, println, process};

/// The map, in the section that the linker puts into the big memory.
// SAFETY: the section's name is ours alone, and it holds nothing but constant bytes.
#[unsafe(link_section = ".db")]
static MAP: [u8; include_bytes!("../../../tests/fixtures/golden/office.map").len()] =
    *include_bytes!("../../../tests/fixtures/golden/office.map");

static LOOKS: &[u8] = include_bytes!("../../../tests/fixtures/golden/looks.bin");
static EXPECTED: &str = include_str!("../../../tests/fixtures/golden/expected.txt");

/// Mismatches printed in full.
const PRINTED: u32 = 5;

#[entry]
fn main() -> ! {
    let memory = singleton!(: [u64; MEMORY_WORDS] = [0; MEMORY_WORDS]).expect("the entry point runs once");
    let mut printed = 0;
    let print = |line: Mismatch<'_>| {
        if printed < PRINTED {
            printed += 1;
            eprintln!("expected {}\n     got {}", line.expected, line.actual);
        }
    };
    match compare(&MAP, LOOKS, EXPECTED, memory, print) {
        Ok(counts) if counts.mismatches == 0 => {
            println!("{} looks in {} attempts: decisions and scores are the host's", counts.looks, counts.attempts);
            process::exit(0)
        }
        Ok(counts) => {
            eprintln!("{} of {} looks differ from the host's", counts.mismatches, counts.looks);
            process::exit(1)
        }
        Err(error) => {
            eprintln!("the golden attempts can't be replayed: {error}");
            process::exit(2)
        }
    }
}

// SAFETY: the handler touches no state of the interrupted program.
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    eprintln!("hard fault at {:#010x}", frame.pc());
    process::exit(102)
}

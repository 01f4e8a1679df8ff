//! What the Cortex-M boards that QEMU emulates share: the console and the exit through semihosting, and memory to work in.
//!
//! Exit codes: 0 when all that was compared is the host's, 1 when something differs, 2 when nothing could be compared,
//! 101 after a panic, 102 after a fault.
#![no_std]

use core::fmt;

use cortex_m::singleton;
use cortex_m_rt::ExceptionFrame;
use edgeloc_firmware::{MEMORY_WORDS, accept};
use semihosting::{eprintln, print, process};

/// Holds the board against the host, with the golden map as it lies in its memory, and exits.
pub fn run(map: &[u8]) -> ! {
    let memory = singleton!(: [u64; MEMORY_WORDS] = [0; MEMORY_WORDS]).expect("the entry point runs once");
    match accept(map, memory, &mut Console) {
        Ok(verdict) => process::exit(verdict.exit_code().into()),
        Err(fmt::Error) => process::exit(2),
    }
}

/// Tells of a fault and exits.
pub fn fault(frame: &ExceptionFrame) -> ! {
    eprintln!("hard fault at {:#010x}", frame.pc());
    process::exit(102)
}

/// The standard output of the emulator.
struct Console;

impl fmt::Write for Console {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        print!("{text}");
        Ok(())
    }
}

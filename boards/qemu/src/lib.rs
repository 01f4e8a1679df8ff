//! What the Cortex-M boards that QEMU emulates share: the console and the exit through semihosting, and memory to work in.
//!
//! Emulated time counts instructions: with `-icount shift=7` each takes 128 ns.
//!
//! Exit codes: 0 when all that was compared is the host's, 1 when something differs, 2 when nothing could be compared,
//! 101 after a panic, 102 after a fault.
#![no_std]

use core::fmt;

use cortex_m::singleton;
use cortex_m_rt::ExceptionFrame;
use edgeloc_firmware::budgets::{MAP_BYTES, Stopwatch, count_instructions};
use edgeloc_firmware::{MEMORY_WORDS, Verdict, accept, golden};
use semihosting::{eprintln, print, process};

/// A timer of 32 bits that counts down (CMSDK APB timer), as all these boards have one.
#[derive(Debug)]
pub struct Timer {
    registers: *mut u32,
    megahertz: u64,
    /// Instructions that a count of nothing gives.
    overhead: u64,
}

const CONTROL: usize = 0;
const VALUE: usize = 1;
const RELOAD: usize = 2;

impl Timer {
    /// Starts the timer whose registers lie at `address` and which counts at `megahertz`.
    ///
    /// # Safety
    /// The board has such a timer there, and nothing else uses it.
    // SAFETY: only a board knows its timers; what it has to promise is said above.
    #[must_use]
    pub unsafe fn start(address: usize, megahertz: u64) -> Self {
        let registers = address as *mut u32;
        // SAFETY: the caller says that these are the timer's registers, and they are ours.
        unsafe {
            registers.add(RELOAD).write_volatile(u32::MAX);
            registers.add(VALUE).write_volatile(u32::MAX);
            registers.add(CONTROL).write_volatile(1);
        }
        let mut timer = Self { registers, megahertz, overhead: 0 };
        timer.overhead = timer.instructions(|| ());
        timer
    }

    fn value(&self) -> u32 {
        // SAFETY: `start` was told that this is the timer's register; to read it changes nothing.
        unsafe { self.registers.add(VALUE).read_volatile() }
    }
}

impl Stopwatch for Timer {
    fn instructions(&mut self, work: impl FnOnce()) -> u64 {
        let start = self.value();
        work();
        let nanoseconds = u64::from(start.wrapping_sub(self.value())) * 1000 / self.megahertz;
        ((nanoseconds + 64) / 128).saturating_sub(self.overhead)
    }
}

/// Holds the board against the host, with the golden map as it lies in its memory, counts instructions and exits.
pub fn run(map: &[u8], mut timer: Timer) -> ! {
    let memory = singleton!(: [u64; MEMORY_WORDS] = [0; MEMORY_WORDS]).expect("the entry point runs once");
    let larger_map = singleton!(: [u8; MAP_BYTES] = [0; MAP_BYTES]).expect("the entry point runs once");
    let verdict = accept(map, memory, &mut Console).unwrap_or(Verdict::CantReplay);
    let counted =
        count_instructions([map, golden::JOINED_MAP], golden::LOOKS, memory, larger_map, &mut timer, &mut Console);
    match counted {
        Ok(()) => process::exit(verdict.exit_code().into()),
        Err(fmt::Error) => {
            eprintln!("instructions can't be counted");
            process::exit(2)
        }
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

//! A Cortex-M7 under QEMU: starts, reads the memory where maps lie, and exits through semihosting.
//!
//! A panic exits with 101, a fault with 102.
#![no_std]
#![no_main]

use cortex_m_rt::{ExceptionFrame, entry, exception};
use semihosting::{eprintln, println, process};

/// A known pattern in the section that holds maps.
// SAFETY: nothing else is placed in this section by name, and no code is run from it.
#[unsafe(link_section = ".db")]
static PATTERN: [u8; 1 << 16] = [7; 1 << 16];

#[entry]
fn main() -> ! {
    let is_intact = core::hint::black_box(&PATTERN).iter().all(|&byte| byte == 7);
    println!("map memory at {:p}: {}", PATTERN.as_ptr(), if is_intact { "intact" } else { "damaged" });
    process::exit(i32::from(!is_intact))
}

// SAFETY: the handler touches no state of the interrupted program.
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    eprintln!("hard fault at {:#010x}", frame.pc());
    process::exit(102)
}

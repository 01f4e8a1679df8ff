//! The localizer on a Cortex-M4 under QEMU: kernels and golden attempts, held against the host's answers.
#![no_std]
#![no_main]

use cortex_m_rt::{ExceptionFrame, entry, exception};
use edgeloc_firmware::golden;
use edgeloc_qemu::Timer;

/// The map, in the section that the linker puts into the big memory.
// SAFETY: the section's name is ours alone, and it holds nothing but constant bytes.
#[unsafe(link_section = ".db")]
static MAP: [u8; golden::MAP.len()] = golden::MAP;

#[entry]
fn main() -> ! {
    // SAFETY: the board's first timer lies there, and this is its only user.
    let timer = unsafe { Timer::start(0x4000_0000, 25) };
    edgeloc_qemu::run(&MAP, timer)
}

// SAFETY: the handler touches no state of the interrupted program.
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    edgeloc_qemu::fault(frame)
}

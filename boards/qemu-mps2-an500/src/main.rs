//! The localizer on a Cortex-M7 under QEMU: kernels and golden attempts, held against the host's answers.
#![no_std]
#![no_main]

use cortex_m_rt::{ExceptionFrame, entry, exception};
use edgeloc_firmware::golden;

/// The map, in the section that the linker puts into the big memory.
// SAFETY: the section's name is ours alone, and it holds nothing but constant bytes.
#[unsafe(link_section = ".db")]
static MAP: [u8; golden::MAP.len()] = golden::MAP;

#[entry]
fn main() -> ! {
    edgeloc_qemu::run(&MAP)
}

// SAFETY: the handler touches no state of the interrupted program.
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    edgeloc_qemu::fault(frame)
}

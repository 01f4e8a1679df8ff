//! The localizer in WebAssembly: kernels and golden attempts, held against the golden answers.
//!
//! The module imports one function, `print(address, length)` for text in its memory, and exports `accept`, whose result
//! is 0 when all that was compared is as expected, 1 when something differs, 2 when nothing could be compared.

use std::fmt;

use edgeloc_firmware::{MEMORY_WORDS, golden};

/// Compares; what there is to say goes to the host's `print`.
// SAFETY: no other symbol of the module has this name.
#[unsafe(no_mangle)]
pub extern "C" fn accept() -> u32 {
    match edgeloc_firmware::accept(&golden::MAP, &mut vec![0; MEMORY_WORDS], &mut Console) {
        Ok(verdict) => verdict.exit_code().into(),
        Err(fmt::Error) => 2,
    }
}

fn main() {}

// SAFETY: the signature is the one that the module's user is told to provide.
unsafe extern "C" {
    fn print(address: *const u8, length: usize);
}

/// The host's `print`.
struct Console;

impl fmt::Write for Console {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        // SAFETY: the host reads the text, which lies there until it returns.
        unsafe { print(text.as_ptr(), text.len()) };
        Ok(())
    }
}

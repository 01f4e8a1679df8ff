//! Ctrl-C during a run: the first ends it after the trials under way, a second one at once.

use super::console;
use std::process;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};

static IS_ASKED: AtomicBool = AtomicBool::new(false);

/// Exit code of a program that was interrupted, as shells expect it.
const INTERRUPTED: i32 = 130;

/// From now on an interruption is kept for [`is_asked`].
pub(super) fn listen() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // Where no handler can be set, Ctrl-C ends the program at once; the journal stands that too.
        let _ = ctrlc::set_handler(|| {
            if IS_ASKED.swap(true, Ordering::Relaxed) {
                process::exit(INTERRUPTED);
            }
            console::remark("ending after the trials under way; once more ends at once");
        });
    });
}

/// Whether the run is to end.
pub(super) fn is_asked() -> bool {
    IS_ASKED.load(Ordering::Relaxed)
}

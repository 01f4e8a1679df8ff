//! edgeloc's matching behind a C interface, so that `peers.py` can measure it beside other libraries in one process.
//!
//! The data is prepared at the first call; every function may be called from one thread at a time.

#![allow(unsafe_code, reason = "a C interface")]

mod look;
mod peak;

pub use look::OfficeLook;

use edgeloc_benches::stored_view::BINS;
use std::ffi::c_char;
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

static LOOK: LazyLock<Mutex<OfficeLook>> = LazyLock::new(|| Mutex::new(OfficeLook::prepare()));

fn look() -> MutexGuard<'static, OfficeLook> {
    LOOK.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Writes the number of scene lines, of views, of view lines in all, of bins and of the scene's bin pairs.
// SAFETY: no other symbol has this name.
#[unsafe(no_mangle)]
pub extern "C" fn edgeloc_sizes(sizes: &mut [u32; 5]) {
    let look = look();
    let numbers = [look.scene_lines(), look.view_lines().len(), look.view_lines().sum(), BINS, look.scene_pairs()];
    *sizes = numbers.map(|number| number as u32);
}

/// Copies the data: the scene's histograms in Q15, the views' and how many lines each view has.
///
/// # Safety
/// There must be room for as many numbers as [`edgeloc_sizes`] says.
// SAFETY: no other symbol has this name.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn edgeloc_copy(scene: *mut i16, views: *mut i16, view_lines: *mut u32) {
    let look = look();
    // SAFETY: the caller has room for all.
    unsafe {
        copy(look.scene_roots(), scene);
        copy(look.view_roots(), views);
        copy(look.view_lines().map(|lines| lines as u32), view_lines);
    }
}

/// Writes all items to `place`.
///
/// # Safety
/// There must be room for them.
// SAFETY: what it asks for is said above.
unsafe fn copy<T>(items: impl Iterator<Item = T>, place: *mut T) {
    for (index, item) in items.enumerate() {
        // SAFETY: the caller has room for all items.
        unsafe { place.add(index).write(item) };
    }
}

/// Writes the best coefficient in Q30 of every scene line with every view, view by view.
///
/// # Safety
/// There must be room for as many numbers as there are scene lines times views.
// SAFETY: no other symbol has this name.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn edgeloc_match(best: *mut i32) {
    let look = look();
    // SAFETY: the caller has room for that many.
    let best = unsafe { std::slice::from_raw_parts_mut(best, look.scene_lines() * look.view_lines().len()) };
    look.best_coefficients(best);
}

/// Builds the scene's histograms, packed for matching.
// SAFETY: no other symbol has this name.
#[unsafe(no_mangle)]
pub extern "C" fn edgeloc_describe() {
    look().describe();
}

/// Builds the scene's histograms as the naive twin does.
// SAFETY: no other symbol has this name.
#[unsafe(no_mangle)]
pub extern "C" fn edgeloc_describe_naively() {
    look().describe_naively();
}

/// Does without bodies above the `level`-th of [`BODIES`] from now on; returns the length of the name of the body that is
/// left, and writes where the name is.
// SAFETY: no other symbol has this name.
#[unsafe(no_mangle)]
pub extern "C" fn edgeloc_limit_body(level: u32, name: &mut *const c_char) -> usize {
    let found = limit(level);
    *name = found.as_ptr().cast();
    found.len()
}

/// Names of the bodies, narrow to wide.
pub const BODIES: [&str; 3] = ["SSE2", "AVX2", "AVX-512 VNNI"];

#[cfg(target_arch = "x86_64")]
fn limit(level: u32) -> &'static str {
    edgeloc::matching::limit_body(BODIES.get(level as usize).copied().unwrap_or_default())
}

#[cfg(not(target_arch = "x86_64"))]
fn limit(_: u32) -> &'static str {
    edgeloc::matching::body_name()
}

/// Multiplies and accumulates pairs of 16-bit numbers with the vectors of the `level`-th of [`BODIES`], in registers, as
/// fast as the machine can; returns how many products were added, 0 where the machine has no such vectors.
// SAFETY: no other symbol has this name.
#[unsafe(no_mangle)]
pub extern "C" fn edgeloc_peak(level: u32) -> u64 {
    peak::run(level)
}

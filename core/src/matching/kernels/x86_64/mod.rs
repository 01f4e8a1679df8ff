//! Bodies for x86-64, chosen at run time by what the machine has.

#![allow(unsafe_code, reason = "vector kernels, one of the addresses where unsafe may live")]

mod avx2;
mod avx512;
mod detection;
mod sse2;

use super::{Body, PanelRow, Work};
use avx2::Avx2;
use avx512::Avx512;
use core::arch::x86_64::{_MM_HINT_T1, _mm_prefetch};
use sse2::Sse2;

/// Asks for a panel's row to be brought near.
#[inline(always)]
fn prefetch(row: &PanelRow) {
    // SAFETY: every x86-64 has SSE, and a hint reads nothing.
    unsafe { _mm_prefetch::<_MM_HINT_T1>(core::ptr::from_ref(row).cast()) };
}

/// Does `work` with the best body that the machine has.
pub(crate) fn run<W: Work>(work: W) -> W::Output {
    if let Some(body) = Avx512::detect() {
        // SAFETY: the body is proof that the machine has the instructions.
        unsafe { run_avx512(work, body) }
    } else if let Some(body) = Avx2::detect() {
        // SAFETY: the body is proof that the machine has the instructions.
        unsafe { run_avx2(work, body) }
    } else {
        work.run(Sse2)
    }
}

/// Does without bodies above `name` from now on, in the whole process; returns the name of the body that is left. For
/// benchmarks and checks: all bodies give the same bits.
pub fn limit_body(name: &str) -> &'static str {
    detection::limit(name == Avx512::NAME, name == Avx512::NAME || name == Avx2::NAME);
    super::body_name()
}

#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn run_avx2<W: Work>(work: W, body: Avx2) -> W::Output {
    work.run(body)
}

#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vnni,bmi1,bmi2,lzcnt,popcnt")]
fn run_avx512<W: Work>(work: W, body: Avx512) -> W::Output {
    work.run(body)
}

/// What comes of the same work with each body that the machine has, by name.
#[cfg(test)]
pub(super) fn run_all<W: Work>(work: impl Fn() -> W) -> std::vec::Vec<(&'static str, W::Output)> {
    let mut outputs = std::vec![("SSE2", work().run(Sse2))];
    if let Some(body) = Avx2::detect() {
        // SAFETY: the body is proof that the machine has the instructions.
        outputs.push(("AVX2", unsafe { run_avx2(work(), body) }));
    }
    if let Some(body) = Avx512::detect() {
        // SAFETY: the body is proof that the machine has the instructions.
        outputs.push(("AVX-512", unsafe { run_avx512(work(), body) }));
    }
    outputs
}

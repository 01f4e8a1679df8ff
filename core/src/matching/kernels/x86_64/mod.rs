//! Bodies for x86-64, chosen at run time by what the machine has.

#![allow(unsafe_code, reason = "vector kernels, one of the addresses where unsafe may live")]

mod avx2;
mod avx512;
mod detection;
mod sse2;

use super::Work;
use avx2::Avx2;
use avx512::Avx512;
use sse2::Sse2;

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

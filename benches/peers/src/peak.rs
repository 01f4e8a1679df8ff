//! The machine's own limit: multiply-and-accumulates of 16-bit pairs that need no memory and wait for nothing.

/// Rounds of a run: some hundred microseconds.
#[cfg(target_arch = "x86_64")]
const ROUNDS: u64 = 50_000;

#[cfg(not(target_arch = "x86_64"))]
pub(crate) const fn run(_: u32) -> u64 {
    0
}

/// Runs the loop of the `level`-th body; returns how many products were added.
#[cfg(target_arch = "x86_64")]
pub(crate) fn run(level: u32) -> u64 {
    // Instructions a round, and products that each adds.
    let (instructions, products) = match level {
        0 => {
            x86_64::sse2(ROUNDS);
            (6, 8)
        }
        1 if std::is_x86_feature_detected!("avx2") => {
            x86_64::avx2(ROUNDS);
            (6, 16)
        }
        2 if std::is_x86_feature_detected!("avx512f") && std::is_x86_feature_detected!("avx512vnni") => {
            x86_64::avx512(ROUNDS);
            (12, 32)
        }
        _ => return 0,
    };
    ROUNDS * instructions * products
}

#[cfg(target_arch = "x86_64")]
mod x86_64 {
    use std::arch::asm;

    /// `pmaddwd` and the addition that it needs, six sums under way.
    pub(super) fn sse2(rounds: u64) {
        // SAFETY: only the registers named are written, and every x86-64 has them.
        unsafe {
            asm!(
                "2:",
                "movdqa xmm6, xmm12", "pmaddwd xmm6, xmm13", "paddd xmm0, xmm6",
                "movdqa xmm7, xmm12", "pmaddwd xmm7, xmm13", "paddd xmm1, xmm7",
                "movdqa xmm8, xmm12", "pmaddwd xmm8, xmm13", "paddd xmm2, xmm8",
                "movdqa xmm9, xmm12", "pmaddwd xmm9, xmm13", "paddd xmm3, xmm9",
                "movdqa xmm10, xmm12", "pmaddwd xmm10, xmm13", "paddd xmm4, xmm10",
                "movdqa xmm11, xmm12", "pmaddwd xmm11, xmm13", "paddd xmm5, xmm11",
                "dec {rounds}",
                "jnz 2b",
                rounds = inout(reg) rounds => _,
                out("xmm0") _, out("xmm1") _, out("xmm2") _, out("xmm3") _, out("xmm4") _, out("xmm5") _,
                out("xmm6") _, out("xmm7") _, out("xmm8") _, out("xmm9") _, out("xmm10") _, out("xmm11") _,
                out("xmm12") _, out("xmm13") _,
                options(nomem, nostack),
            );
        }
    }

    /// `vpmaddwd` and the addition that it needs, six sums under way.
    pub(super) fn avx2(rounds: u64) {
        // SAFETY: only the registers named are written; the caller has asked whether the machine has them.
        unsafe {
            asm!(
                "2:",
                "vpmaddwd ymm6, ymm12, ymm13", "vpaddd ymm0, ymm0, ymm6",
                "vpmaddwd ymm7, ymm12, ymm13", "vpaddd ymm1, ymm1, ymm7",
                "vpmaddwd ymm8, ymm12, ymm13", "vpaddd ymm2, ymm2, ymm8",
                "vpmaddwd ymm9, ymm12, ymm13", "vpaddd ymm3, ymm3, ymm9",
                "vpmaddwd ymm10, ymm12, ymm13", "vpaddd ymm4, ymm4, ymm10",
                "vpmaddwd ymm11, ymm12, ymm13", "vpaddd ymm5, ymm5, ymm11",
                "dec {rounds}",
                "jnz 2b",
                "vzeroupper",
                rounds = inout(reg) rounds => _,
                out("xmm0") _, out("xmm1") _, out("xmm2") _, out("xmm3") _, out("xmm4") _, out("xmm5") _,
                out("xmm6") _, out("xmm7") _, out("xmm8") _, out("xmm9") _, out("xmm10") _, out("xmm11") _,
                out("xmm12") _, out("xmm13") _, out("xmm14") _, out("xmm15") _,
                options(nomem, nostack),
            );
        }
    }

    /// `vpdpwssd`, twelve sums under way.
    pub(super) fn avx512(rounds: u64) {
        // SAFETY: only the registers named are written; the caller has asked whether the machine has them.
        unsafe {
            asm!(
                "2:",
                "vpdpwssd zmm0, zmm12, zmm13", "vpdpwssd zmm1, zmm12, zmm13", "vpdpwssd zmm2, zmm12, zmm13",
                "vpdpwssd zmm3, zmm12, zmm13", "vpdpwssd zmm4, zmm12, zmm13", "vpdpwssd zmm5, zmm12, zmm13",
                "vpdpwssd zmm6, zmm12, zmm13", "vpdpwssd zmm7, zmm12, zmm13", "vpdpwssd zmm8, zmm12, zmm13",
                "vpdpwssd zmm9, zmm12, zmm13", "vpdpwssd zmm10, zmm12, zmm13", "vpdpwssd zmm11, zmm12, zmm13",
                "dec {rounds}",
                "jnz 2b",
                "vzeroupper",
                rounds = inout(reg) rounds => _,
                out("xmm0") _, out("xmm1") _, out("xmm2") _, out("xmm3") _, out("xmm4") _, out("xmm5") _,
                out("xmm6") _, out("xmm7") _, out("xmm8") _, out("xmm9") _, out("xmm10") _, out("xmm11") _,
                out("xmm12") _, out("xmm13") _, out("xmm14") _, out("xmm15") _,
                options(nomem, nostack),
            );
        }
    }
}

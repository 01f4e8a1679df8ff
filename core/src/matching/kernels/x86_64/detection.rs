//! Which vector instructions the machine has and the operating system keeps, asked once.
//!
//! `std::is_x86_feature_detected!` is not for a library without `std`; this asks the same questions.

#[cfg(not(miri))]
use core::arch::x86_64::{__cpuid, __cpuid_count, _xgetbv};
use core::sync::atomic::{AtomicU8, Ordering};

const KNOWN: u8 = 1;
const AVX2: u8 = 2;
const AVX512: u8 = 4;

/// What was found, 0 before anyone asked. Any thread may use any of it, so no order is needed.
static FOUND: AtomicU8 = AtomicU8::new(0);

pub(super) fn has_avx2() -> bool {
    found() & AVX2 != 0
}

pub(super) fn has_avx512_vnni() -> bool {
    found() & AVX512 != 0
}

/// Finds of what the machine has only what is allowed, from now on.
pub(super) fn limit(allows_avx512: bool, allows_avx2: bool) {
    let allowed = KNOWN | if allows_avx2 { AVX2 } else { 0 } | if allows_avx512 { AVX512 } else { 0 };
    FOUND.store(ask() & allowed, Ordering::Relaxed);
}

fn found() -> u8 {
    match FOUND.load(Ordering::Relaxed) {
        0 => {
            let found = ask();
            FOUND.store(found, Ordering::Relaxed);
            found
        }
        found => found,
    }
}

/// Miri has no processor to be asked, only what it was told when it compiled this; AVX-512 it does not know.
#[cfg(miri)]
fn ask() -> u8 {
    let has_all = cfg!(all(
        target_feature = "avx2",
        target_feature = "bmi1",
        target_feature = "bmi2",
        target_feature = "lzcnt",
        target_feature = "popcnt"
    ));
    KNOWN | if has_all { AVX2 } else { 0 }
}

#[cfg(not(miri))]
fn ask() -> u8 {
    let has = |register: u32, bits: &[u32]| bits.iter().all(|bit| register >> bit & 1 == 1);
    if __cpuid(0).eax < 7 || __cpuid(0x8000_0000).eax < 0x8000_0001 {
        return KNOWN;
    }
    let (first, seventh, extended) = (__cpuid(1), __cpuid_count(7, 0), __cpuid(0x8000_0001));
    // XSAVE, enabled by the operating system, and AVX; POPCNT; then LZCNT.
    if !has(first.ecx, &[23, 26, 27, 28]) || !has(extended.ecx, &[5]) {
        return KNOWN;
    }
    // SAFETY: the operating system has enabled XSAVE, as was just asked, so XGETBV is there.
    let kept = unsafe { extended_control() };
    let mut found = KNOWN;
    // SSE and AVX registers are kept; BMI1, AVX2, BMI2.
    if has(kept, &[1, 2]) && has(seventh.ebx, &[3, 5, 8]) {
        found |= AVX2;
        // Masks and all 512-bit registers are kept; AVX-512 F, DQ, BW, VL and VNNI.
        if has(kept, &[5, 6, 7]) && has(seventh.ebx, &[16, 17, 30, 31]) && has(seventh.ecx, &[11]) {
            found |= AVX512;
        }
    }
    found
}

/// Which registers the operating system keeps.
#[cfg(not(miri))]
#[target_feature(enable = "xsave")]
fn extended_control() -> u32 {
    // SAFETY: register 0 exists wherever XGETBV does.
    unsafe { _xgetbv(0) as u32 }
}

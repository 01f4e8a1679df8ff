//! The DSP extension of Cortex-M4, M7, M33 and later: one multiply-and-accumulate-pairs (SMLAD) a line, for half a panel
//! at a time, whose sums stay in registers. A compiler left to it spills them: twice the instructions.

#![allow(unsafe_code, reason = "an instruction without an intrinsic, at one of the addresses where unsafe may live")]

use super::Body;
use super::envelope::{Envelopes, HALF, RootWords};
use crate::matching::{BinPair, PanelRow};
use core::arch::asm;

/// The body for processors with the DSP extension; one exists only in code for them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Smlad;

impl Body for Smlad {
    const NAME: &'static str = "SMLAD";

    #[inline(always)]
    fn best_coefficient(self, row: &[BinPair], panel: &[PanelRow]) -> i32 {
        best_of_half::<0>(row, panel).max(best_of_half::<HALF>(row, panel))
    }

    fn raise_best<'a>(self, rows: impl Iterator<Item = &'a [BinPair]>, panel: &[PanelRow], best: &mut [i32]) {
        let mut envelopes = Envelopes::of(panel, self);
        for (row, best) in rows.zip(best) {
            envelopes.raise_best(self, row, best, |half, row| match half {
                0 => best_of_half::<0>(row, panel),
                _ => best_of_half::<HALF>(row, panel),
            });
        }
    }
}

impl RootWords for Smlad {
    #[inline(always)]
    fn greater(self, a: u32, b: u32) -> u32 {
        let more: u32;
        // SAFETY: a subtraction within registers.
        unsafe {
            asm!("uqsub16 {}, {}, {}", lateout(reg) more, in(reg) a, in(reg) b, options(pure, nomem, nostack));
        }
        b.wrapping_add(more)
    }

    #[inline(always)]
    fn plus_products(self, sum: u32, a: u32, b: u32) -> u32 {
        let more: u32;
        // SAFETY: multiplications and additions within registers.
        unsafe {
            asm!("smlad {}, {}, {}, {}", lateout(reg) more, in(reg) a, in(reg) b, in(reg) sum, options(pure, nomem, nostack));
        }
        more
    }
}

/// The best of the lines from `FIRST` on, or 0.
#[inline(never)]
fn best_of_half<const FIRST: usize>(row: &[BinPair], panel: &[PanelRow]) -> i32 {
    const {
        assert!(HALF == 8 && (FIRST == 0 || FIRST == HALF), "eight sums, of one half or the other");
        assert!(size_of::<BinPair>() == 6 && core::mem::offset_of!(BinPair, roots) == 2);
        assert!(size_of::<PanelRow>() == 64 && align_of::<PanelRow>() >= 4);
    }
    if row.is_empty() {
        return 0;
    }
    let pairs = row.as_ptr_range();
    let mut sums = [0_i32; HALF];
    let [a, b, c, d, e, f, g, h] = &mut sums;
    // SAFETY: pairs are read from the first to before the last one's end, at least one. A panel's row is read only at
    // an index below their number, and within its 64 bytes; its loads of two words are aligned, as the type is. Single
    // words may lie unaligned, as they do in compiled code for these processors. r6 and r7, which can't be named as
    // operands, and the stack pointer are restored; all other registers written are outputs.
    unsafe {
        asm!(
            // The number of the panel's rows at sp, the end of the pairs at sp + 4; r10 walks the pairs, r11 is a pair's
            // roots, r12 the panel, r6 a row of it, r7 and lr two lines of that.
            "push {{r0, r1, r6, r7}}",
            "movs r0, #0",
            "movs r1, #0",
            "movs r2, #0",
            "movs r3, #0",
            "movs r4, #0",
            "movs r5, #0",
            "mov r8, r0",
            "mov r9, r0",
            "2:",
            "ldrh r6, [r10], #2",
            "ldr r7, [sp]",
            "ldr r11, [r10], #4",
            "cmp r6, r7",
            "bhs 3f",
            "add r6, r12, r6, lsl #6",
            "ldrd r7, lr, [r6]",
            "smlad r0, r7, r11, r0",
            "smlad r1, lr, r11, r1",
            "ldrd r7, lr, [r6, #8]",
            "smlad r2, r7, r11, r2",
            "smlad r3, lr, r11, r3",
            "ldrd r7, lr, [r6, #16]",
            "smlad r4, r7, r11, r4",
            "smlad r5, lr, r11, r5",
            "ldrd r7, lr, [r6, #24]",
            "smlad r8, r7, r11, r8",
            "smlad r9, lr, r11, r9",
            "3:",
            "ldr r7, [sp, #4]",
            "cmp r10, r7",
            "bne 2b",
            "add sp, #8",
            "pop {{r6, r7}}",
            inout("r0") panel.len() => *a,
            inout("r1") pairs.end => *b,
            out("r2") *c,
            out("r3") *d,
            out("r4") *e,
            out("r5") *f,
            out("r8") *g,
            out("r9") *h,
            inout("r10") pairs.start => _,
            out("r11") _,
            in("r12") panel.as_ptr().cast::<[i16; 2]>().wrapping_add(FIRST),
            out("lr") _,
            options(pure, readonly),
        );
    }
    sums.into_iter().fold(0, i32::max)
}

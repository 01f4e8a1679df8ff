//! Four bytes at a time: what the DSP extension of Cortex-M does in an instruction or two, and vectors do of themselves.

/// Four bytes.
pub(crate) type Quad = [u8; 4];

/// The lesser of each two bytes.
#[cfg(not(edgeloc_body = "smlad"))]
#[inline(always)]
pub(crate) fn lesser(a: Quad, b: Quad) -> Quad {
    [a[0].min(b[0]), a[1].min(b[1]), a[2].min(b[2]), a[3].min(b[3])]
}

/// The sum of each two bytes, 255 where it is more.
#[cfg(not(edgeloc_body = "smlad"))]
#[inline(always)]
pub(crate) fn saturating_sum(a: Quad, b: Quad) -> Quad {
    [a[0].saturating_add(b[0]), a[1].saturating_add(b[1]), a[2].saturating_add(b[2]), a[3].saturating_add(b[3])]
}

#[cfg(edgeloc_body = "smlad")]
pub(crate) use dsp::{lesser, saturating_sum};

#[cfg(edgeloc_body = "smlad")]
mod dsp {
    #![allow(unsafe_code, reason = "instructions without an intrinsic, at one of the addresses where unsafe may live")]

    use super::Quad;
    use core::arch::asm;

    /// The lesser of each two bytes.
    #[inline(always)]
    pub(crate) fn lesser(a: Quad, b: Quad) -> Quad {
        let lesser: u32;
        // SAFETY: registers in, one register out; the flags that select bytes are set and read within.
        unsafe {
            asm!(
                "usub8 {lesser}, {a}, {b}",
                "sel {lesser}, {b}, {a}",
                a = in(reg) u32::from_le_bytes(a),
                b = in(reg) u32::from_le_bytes(b),
                lesser = out(reg) lesser,
                options(pure, nomem, nostack),
            );
        }
        lesser.to_le_bytes()
    }

    /// The sum of each two bytes, 255 where it is more.
    #[inline(always)]
    pub(crate) fn saturating_sum(a: Quad, b: Quad) -> Quad {
        let sum: u32;
        // SAFETY: registers in, one register out.
        unsafe {
            asm!(
                "uqadd8 {sum}, {a}, {b}",
                a = in(reg) u32::from_le_bytes(a),
                b = in(reg) u32::from_le_bytes(b),
                sum = lateout(reg) sum,
                options(pure, nomem, nostack, preserves_flags),
            );
        }
        sum.to_le_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_do_not_disturb_each_other() {
        assert_eq!(lesser([0, 255, 3, 128], [1, 254, 3, 127]), [0, 254, 3, 127]);
        assert_eq!(saturating_sum([0, 255, 250, 128], [5, 5, 5, 127]), [5, 255, 255, 255]);
    }
}

//! Steps of a distance transform, byte by byte: what vectors do of themselves, and the DSP extension of Cortex-M four at a
//! time.

/// Lowers each of `distances` to that in `from` and a `step` more, 255 at most, where this is less.
#[inline(always)]
pub(crate) fn lower_by_step(distances: &mut [u8], from: &[u8], step: u8) {
    #[cfg(edgeloc_body = "smlad")]
    let (distances, from) = lower_quads(distances, from, step);
    for (distance, from) in distances.iter_mut().zip(from) {
        *distance = (*distance).min(from.saturating_add(step));
    }
}

/// Lowers as many as fill fours, and returns the rest.
#[cfg(edgeloc_body = "smlad")]
#[inline(always)]
fn lower_quads<'d, 'f>(distances: &'d mut [u8], from: &'f [u8], step: u8) -> (&'d mut [u8], &'f [u8]) {
    let (quads, rest) = distances.as_chunks_mut();
    let (from_quads, from_rest) = from.as_chunks();
    for (quad, from) in quads.iter_mut().zip(from_quads) {
        *quad = lower_quad(*quad, *from, [step; 4]);
    }
    (rest, from_rest)
}

#[cfg(edgeloc_body = "smlad")]
#[allow(unsafe_code, reason = "instructions without an intrinsic, at one of the addresses where unsafe may live")]
#[inline(always)]
fn lower_quad(distances: [u8; 4], from: [u8; 4], step: [u8; 4]) -> [u8; 4] {
    let lowered: u32;
    // SAFETY: registers in, one register out; the flags that select bytes are set and read within.
    unsafe {
        core::arch::asm!(
            "uqadd8 {lowered}, {from}, {step}",
            "usub8 {unused}, {lowered}, {distances}",
            "sel {lowered}, {distances}, {lowered}",
            from = in(reg) u32::from_le_bytes(from),
            step = in(reg) u32::from_le_bytes(step),
            distances = in(reg) u32::from_le_bytes(distances),
            lowered = out(reg) lowered,
            unused = out(reg) _,
            options(pure, nomem, nostack),
        );
    }
    lowered.to_le_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_do_not_disturb_each_other() {
        let mut distances = [9, 255, 3, 128, 255, 0];
        lower_by_step(&mut distances, &[1, 254, 250, 120, 0, 255], 5);
        assert_eq!(distances, [6, 255, 3, 125, 5, 0]);
    }
}

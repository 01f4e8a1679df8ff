//! Similarities of one view to all of a map.

use super::Code;
use crate::matching::{Body, Work, run};

/// Bits that a similarity is cut by.
const SHIFT: u32 = 4;
/// The similarity of a view to itself, about: looks add up eight times before a sum passes the border of an `i16`.
pub const ONE: i16 = 4032;

/// Adds to each of `sums` how similar `code` is to the row of the same place in `sectors`: in the one where it is most, if
/// there are several. Rows or sums that have no counterpart are left alone.
///
/// One pass over the rows, sixty-four products each, in the widest vectors that the machine has; sums of integers are the
/// same in any order.
pub fn add_similarities(code: &Code, sectors: &[&[Code]], sums: &mut [i16]) {
    run(Scan { code, sectors, sums });
}

/// [`add_similarities`] as work for any machine.
struct Scan<'a> {
    code: &'a Code,
    sectors: &'a [&'a [Code]],
    sums: &'a mut [i16],
}

impl Work for Scan<'_> {
    type Output = ();

    #[inline(always)]
    fn run<B: Body>(self, _: B) {
        let Self { code, sectors, sums } = self;
        let code = code.map(i16::from);
        match sectors {
            [] => {}
            [rows] => {
                for (sum, row) in sums.iter_mut().zip(*rows) {
                    *sum = sum.saturating_add(similarity(&code, row));
                }
            }
            [first, others @ ..] => {
                for (index, (sum, row)) in sums.iter_mut().zip(*first).enumerate() {
                    let others = others.iter().filter_map(|rows| rows.get(index));
                    let best = others.fold(similarity(&code, row), |best, row| best.max(similarity(&code, row)));
                    *sum = sum.saturating_add(best);
                }
            }
        }
    }
}

/// At most 64 x 128 x 128, cut to an `i16` that it can't fill.
#[inline(always)]
fn similarity(code: &[i16; size_of::<Code>()], row: &Code) -> i16 {
    let mut sum = 0_i32;
    for (a, b) in code.iter().zip(row) {
        sum += i32::from(*a) * i32::from(*b);
    }
    (sum >> SHIFT).clamp(-i32::from(i16::MAX), i32::from(i16::MAX)) as i16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_sector_counts_and_sums_saturate() {
        let ([small, large], opposite) = ([[10_i8; 64], [60_i8; 64]], [-60_i8; 64]);
        let mut sums = [0_i16; 2];
        add_similarities(&small, &[&[large, small], &[small, opposite]], &mut sums);
        assert_eq!(sums, [2400, 400]);
        let mut full = [i16::MAX - 5; 1];
        add_similarities(&large, &[&[large]], &mut full);
        assert_eq!(full, [i16::MAX]);
    }

    #[test]
    fn no_sector_and_fewer_rows_leave_sums_alone() {
        let mut sums = [3_i16; 2];
        add_similarities(&[1; 64], &[], &mut sums);
        add_similarities(&[16; 64], &[&[[16; 64]]], &mut sums);
        assert_eq!(sums, [3 + 1024, 3]);
    }
}

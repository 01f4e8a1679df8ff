//! The kernels on drawn inputs: one line of text for each kind of input, the same on every machine.
//!
//! Coefficients, the best of several panels too, are held against a twin in plain arithmetic as they are made, so a machine
//! tells by itself where its kernels err; the digest of a line says that it drew and got what the host did.

use core::fmt::Write;

use edgeloc::geometry::{Point2, Polarity, Segment2};
use edgeloc::matching::{BinPair, LANES, Panel, PanelRow, RootRows, best_coefficient, best_coefficients};
use edgeloc::pgh::{DistanceKind, HistogramBuilder, Line, LineBlock, PghShape};

use crate::draw::{Digest, Draw};

/// Rows of the largest panel, and pairs of the longest row.
const LARGEST: usize = 48;

/// Rows tried with each kind of coefficients.
const ROWS: usize = 400;

/// Lines of the largest scene.
const LINES: usize = 33;

/// Bins of the largest histogram.
const BINS: usize = 30 * 64;

/// Words of a builder for it.
const MASSES: usize = 10_000;

type Text = heapless::String<160>;

/// How the halfwords of rows and panels are drawn.
#[derive(Clone, Copy)]
enum Roots {
    /// As histograms have them: magnitudes, many of them none.
    Sparse,
    /// Magnitudes at their greatest.
    Full,
    /// Anything, the least number among it: sums wrap.
    Any,
    /// The least number alone: every product sum wraps.
    Least,
}

impl Roots {
    fn draw(self, draw: &mut Draw) -> i16 {
        let bits = draw.bits();
        match self {
            Self::Sparse if bits & 3 == 0 => 0,
            Self::Sparse => (bits >> 49) as i16,
            Self::Full => i16::MAX,
            Self::Any if bits & 7 == 0 => i16::MIN,
            Self::Any => (bits >> 48) as i16,
            Self::Least => i16::MIN,
        }
    }
}

/// Runs all kernels and hands each line, without its end, to `on_line`.
pub fn run_kernels(mut on_line: impl FnMut(&str)) {
    for (name, roots) in
        [("sparse", Roots::Sparse), ("full", Roots::Full), ("any", Roots::Any), ("least", Roots::Least)]
    {
        on_line(&coefficients(name, roots));
    }
    let paper = PghShape::paper();
    for (name, shape) in [
        ("paper", paper),
        ("unsigned, polarity", PghShape { distance: DistanceKind::Unsigned, uses_polarity: true, ..paper }),
        ("nearest angle bin", PghShape { interpolates_angle: false, ..paper }),
        ("30 x 64, 600 px", PghShape { distance_bins: 30, angle_bins: 64, max_distance_px: 600.0, ..paper }),
        ("1 x 1", PghShape { distance_bins: 1, angle_bins: 1, ..paper }),
    ] {
        on_line(&histograms(name, &shape));
    }
}

/// Rows and panels of all lengths down to none; some indices point past the panel.
fn coefficients(name: &str, roots: Roots) -> Text {
    let mut draw = Draw::new(roots as u64);
    let mut digest = Digest::new();
    let mut pairs = [BinPair { index: 0, roots: [0; 2] }; LARGEST];
    let mut rows = [PanelRow { roots: [[0; 2]; LANES] }; LARGEST];
    for trial in 0..ROWS {
        let row = &mut pairs[..trial % (LARGEST + 1)];
        let panel = &mut rows[..draw.below(LARGEST as u64 + 1) as usize];
        let beyond = if trial % 3 == 0 { 70_000 } else { LARGEST as u64 };
        for pair in &mut *row {
            let index = draw.below(beyond).min(u64::from(u16::MAX)) as u16;
            *pair = BinPair { index, roots: [roots.draw(&mut draw), roots.draw(&mut draw)] };
        }
        for root in panel.iter_mut().flat_map(|row| row.roots.as_flattened_mut()) {
            *root = roots.draw(&mut draw);
        }
        // One lane decides, each at times, so that none can hide behind another.
        let lane = trial % (LANES + 1);
        if lane < LANES {
            for row in &mut *panel {
                let kept = row.roots[lane];
                row.roots = [[0; 2]; LANES];
                row.roots[lane] = kept;
            }
        }
        let (found, expected) = (best_coefficient(row, panel), twin(row, panel));
        if found != expected {
            return text(format_args!("coefficients, {name}: {found} in trial {trial}, its twin {expected}"));
        }
        digest.add(u64::from(found.unsigned_abs()));
    }
    text(format_args!("coefficients, {name}: {ROWS} rows, {:016x}", digest.0))
}

/// The best coefficient in the plainest arithmetic.
fn twin(row: &[BinPair], panel: &[PanelRow]) -> i32 {
    let product = |pair: &BinPair, lane: usize| {
        let bins = panel.get(usize::from(pair.index)).map_or([0; 2], |row| row.roots[lane]);
        i64::from(pair.roots[0]) * i64::from(bins[0]) + i64::from(pair.roots[1]) * i64::from(bins[1])
    };
    let sum = |lane| row.iter().map(|pair| product(pair, lane)).sum::<i64>() as i32;
    (0..LANES).map(sum).fold(0, i32::max)
}

/// Scenes of no line to some, each met with itself as a view; every second line is drawn about the middle, where sums are
/// fullest.
fn histograms(name: &str, shape: &PghShape) -> Text {
    let mut draw = Draw::new(u64::from(shape.distance_bins) << 32 | u64::from(shape.angle_bins));
    let mut digest = Digest::new();
    let mut masses = [0; MASSES];
    let mut blocks = [LineBlock::EMPTY; LineBlock::count_for(LINES)];
    let mut pairs = [BinPair { index: 0, roots: [0; 2] }; RootRows::pairs_len(LINES, BINS)];
    let mut ends = [0; LINES];
    let mut lines = [None; LINES];
    let mut panel_rows = [PanelRow { roots: [[0; 2]; LANES] }; Panel::rows_len(BINS)];
    let panel_rows = &mut panel_rows[..Panel::rows_len(shape.bin_count())];
    let mut filled = 0;
    for count in [0, 1, 2, 15, 16, 17, LINES] {
        let mut line = 0;
        while line < count {
            let polarity = if draw.bits() & 1 == 0 { Polarity::LeftBrighter } else { Polarity::RightBrighter };
            let mut point = || match line % 2 {
                0 => Point2::new(draw.sixteenths(4096) - 2048.0, draw.sixteenths(4096) - 2048.0),
                _ => Point2::new(300.0 + draw.sixteenths(40), draw.sixteenths(480)),
            };
            if let Ok(segment) = Segment2::new(point(), point(), polarity) {
                lines[line] = Some(Line::new(&segment, line as u32, shape));
                line += 1;
            }
        }
        let lines: heapless::Vec<Line, LINES> = lines[..count].iter().copied().flatten().collect();
        let mut rows = RootRows::new(&mut pairs, &mut ends);
        let mut builder = match HistogramBuilder::new(shape, &mut masses, &mut blocks) {
            Ok(builder) => builder,
            Err(error) => return text(format_args!("histograms, {name}: {error:?}")),
        };
        if let Err(error) = rows.rebuild(&mut builder, &lines) {
            return text(format_args!("histograms, {name}: {error:?}"));
        }
        for row in rows.rows() {
            digest.add(row.len() as u64);
            filled += row.len();
            for BinPair { index, roots: [even, odd] } in row {
                digest.add(u64::from(*index) << 32 | u64::from(*even as u16) << 16 | u64::from(*odd as u16));
            }
        }
        let (mut best, mut expected) = ([0; LINES], [0; LINES]);
        for first in (0..count).step_by(LANES) {
            let mut panel = Panel::new(panel_rows);
            panel.rebuild(&mut builder, &lines, first);
            best_coefficients(&rows, core::slice::from_ref(&panel), &mut best);
            for (row, expected) in rows.rows().zip(&mut expected) {
                *expected = twin(row, panel_rows).max(*expected);
            }
        }
        if best != expected {
            return text(format_args!("histograms, {name}: best coefficients of {count} lines are not their twins"));
        }
        best.iter().for_each(|best| digest.add(u64::from(best.unsigned_abs())));
    }
    text(format_args!("histograms, {name}: {filled} pairs of bins, {:016x}", digest.0))
}

fn text(arguments: core::fmt::Arguments<'_>) -> Text {
    let mut text = Text::new();
    // What does not fit is cut off: the line then differs from what was expected, which is all it has to do.
    let _ = text.write_fmt(arguments);
    text
}

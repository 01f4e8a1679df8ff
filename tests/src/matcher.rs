//! The fixed-point kernels with memory of their own, for tests and benchmarks that go below the localiser.

use edgeloc::geometry::Segment2;
use edgeloc::matching::{BinPair, LANES, Panel, PanelRow, RootRows, ViewScore, score_view};
use edgeloc::pgh::{HistogramBuilder, Line, LineBlock, PghShape};

/// Memory for histograms of one shape.
#[derive(Debug)]
pub struct MatcherMemory {
    shape: PghShape,
    masses: Vec<i32>,
    line_blocks: Vec<LineBlock>,
    pairs: Vec<BinPair>,
    row_ends: Vec<u32>,
    panel_rows: Vec<PanelRow>,
    best_coefficients: Vec<i32>,
}

impl MatcherMemory {
    /// Memory for scenes and views of up to `max_lines` lines.
    #[must_use]
    pub fn new(shape: &PghShape, max_lines: usize) -> Self {
        Self {
            shape: *shape,
            masses: vec![0; HistogramBuilder::memory_len(shape)],
            line_blocks: vec![LineBlock::EMPTY; LineBlock::count_for(max_lines)],
            pairs: vec![BinPair { index: 0, roots: [0; 2] }; RootRows::pairs_len(max_lines, shape.bin_count())],
            row_ends: vec![0; max_lines],
            panel_rows: vec![PanelRow { roots: [[0; 2]; LANES] }; Panel::rows_len(shape.bin_count())],
            best_coefficients: vec![0; max_lines],
        }
    }

    /// A matcher working in this memory.
    pub fn matcher(&mut self) -> Matcher<'_> {
        Matcher {
            builder: HistogramBuilder::new(&self.shape, &mut self.masses, &mut self.line_blocks)
                .expect("memory of the length asked for"),
            rows: RootRows::new(&mut self.pairs, &mut self.row_ends),
            panel: Panel::new(&mut self.panel_rows),
            best_coefficients: &mut self.best_coefficients,
        }
    }
}

/// A scene's histograms and what it takes to score views against them.
#[derive(Debug)]
pub struct Matcher<'m> {
    builder: HistogramBuilder<'m>,
    rows: RootRows<'m>,
    panel: Panel<'m>,
    best_coefficients: &'m mut [i32],
}

impl Matcher<'_> {
    /// Builds the histograms of a scene; returns how many bin pairs they hold.
    pub fn describe(&mut self, scene: &[Line]) -> usize {
        self.rows.rebuild(&mut self.builder, scene).expect("no more lines than there is memory for");
        self.rows.rows().map(<[BinPair]>::len).sum()
    }

    /// Scores the scene described last against a view.
    pub fn score(&mut self, scene: &[Line], view: &[Line]) -> ViewScore {
        score_view(scene, &self.rows, view, &mut self.builder, &mut self.panel, self.best_coefficients)
            .expect("no more lines than there is memory for")
    }
}

/// The fixed-point form of all segments.
#[must_use]
pub fn lines(shape: &PghShape, segments: &[Segment2]) -> Vec<Line> {
    segments.iter().zip(0..).map(|(segment, order)| Line::new(segment, order, shape)).collect()
}

//! A view's histograms kept in memory, as panels to match scenes with again and again.

use edgeloc::matching::{LANES, Panel, PanelRow};
use edgeloc::pgh::{HistogramBuilder, Line, LineBlock, PghShape};

/// Bins of a histogram of the published shape.
pub const BINS: usize = PghShape::paper().bin_count();

/// Rows of a panel.
const ROWS: usize = Panel::rows_len(BINS);

/// A panel's memory, where no vector straddles two cache lines.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub struct PanelMemory([PanelRow; ROWS]);

/// The histograms of a view, [`LANES`] lines a panel; the shape is the published one.
#[must_use]
pub fn stored_view(lines: &[Line]) -> Vec<PanelMemory> {
    let shape = PghShape::paper();
    let empty = PanelMemory([PanelRow { roots: [[0; 2]; LANES] }; ROWS]);
    let mut stored = vec![empty; lines.len().div_ceil(LANES)];
    let mut masses = vec![0; HistogramBuilder::memory_len(&shape)];
    let mut blocks = vec![LineBlock::EMPTY; LineBlock::count_for(lines.len())];
    let mut builder = HistogramBuilder::new(&shape, &mut masses, &mut blocks).expect("memory as asked for");
    builder.load(lines).expect("memory as asked for");
    for (index, memory) in stored.iter_mut().enumerate() {
        Panel::new(&mut memory.0).rebuild(&mut builder, lines, index * LANES);
    }
    stored
}

/// The panels of a view.
pub fn panels(stored: &mut [PanelMemory]) -> Vec<Panel<'_>> {
    stored.iter_mut().map(|memory| Panel::new(&mut memory.0)).collect()
}

/// The histogram of the `line`-th line, bin by bin in Q15.
#[must_use]
pub fn roots(stored: &[PanelMemory], line: usize) -> [i16; BINS] {
    let panel = &stored[line / LANES].0;
    std::array::from_fn(|bin| panel[bin / 2].roots[line % LANES][bin % 2])
}

//! How well a scene matches a view: the length-weighted mean of each scene line's best coefficient.

use super::bhattacharyya::raise_best;
use super::kernels::{self, Body, Work};
use super::{LANES, Panel, RootRows};
use crate::geometry::CapacityError;
use crate::pgh::{HistogramBuilder, Line};

/// Similarity of a scene and a view, from 0 (nothing alike, or nothing to compare) to 1, in Q30.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct ViewScore {
    /// The score times 2^30.
    pub q30: i32,
}

impl ViewScore {
    /// The score as a number.
    #[must_use]
    pub fn as_f64(self) -> f64 {
        f64::from(self.q30) / f64::from(1 << 30)
    }
}

/// Scores the scene `scene_lines`, whose histograms are `scene_rows`, against the lines of a view.
///
/// The view's histograms are built panel by panel, each met by every scene row while it is hot. `best` is scratch of at
/// least as many numbers as there are scene lines.
///
/// # Errors
/// When the view has more lines than the builder has room for.
pub fn score_view(
    scene_lines: &[Line],
    scene_rows: &RootRows<'_>,
    view_lines: &[Line],
    builder: &mut HistogramBuilder<'_>,
    panel: &mut Panel<'_>,
    best: &mut [i32],
) -> Result<ViewScore, CapacityError> {
    kernels::run(Score { scene_lines, scene_rows, view_lines, builder, panel, best })
}

/// [`score_view`] as work for any machine.
pub(super) struct Score<'a, 'r, 'b, 'p> {
    pub(super) scene_lines: &'a [Line],
    pub(super) scene_rows: &'a RootRows<'r>,
    pub(super) view_lines: &'a [Line],
    pub(super) builder: &'a mut HistogramBuilder<'b>,
    pub(super) panel: &'a mut Panel<'p>,
    pub(super) best: &'a mut [i32],
}

impl Work for Score<'_, '_, '_, '_> {
    type Output = Result<ViewScore, CapacityError>;

    #[inline(always)]
    fn run<B: Body>(self, body: B) -> Self::Output {
        let Self { scene_lines, scene_rows, view_lines, builder, panel, best } = self;
        builder.load(view_lines)?;
        best.fill(0);
        for first in (0..view_lines.len()).step_by(LANES) {
            panel.fill(builder, view_lines, first);
            raise_best(body, scene_rows, core::slice::from_ref(&*panel), best);
        }
        let (mut weighted, mut weight) = (0_u64, 0_u64);
        for (line, best) in scene_lines.iter().zip(&*best) {
            // Lengths are below 2^17 and coefficients about 2^30: thousands of lines fit.
            weighted += u64::from(line.length_q4()) * u64::from(best.unsigned_abs());
            weight += u64::from(line.length_q4());
        }
        Ok(ViewScore { q30: weighted.checked_div(weight).unwrap_or(0) as i32 })
    }
}

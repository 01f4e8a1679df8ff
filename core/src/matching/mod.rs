//! Matching of histograms: Bhattacharyya coefficients and the score of a scene against a view.
//!
//! The coefficient of two histograms `a` and `b` is `sum sqrt(a_i) sqrt(b_i)` (Eq. (1), Tian et al., who write D): 1 for
//! equal, 0 for disjoint histograms. It is **not** the Hellinger distance that some libraries call by Bhattacharyya's
//! name. In root form it is a dot product of Q15 numbers, a Q30 integer that can't overflow (Cauchy and Schwarz).
//!
//! A scene's rows are sparse, a view's histograms dense and transposed in panels of [`LANES`] lines: each non-zero pair
//! of scene bins meets [`LANES`] view lines at once, and only the best coefficient of each row is kept. On x86-64 the
//! best of SSE2, AVX2 and AVX-512 that the machine has is taken at run time, for the building of histograms as well; NEON,
//! WebAssembly's vectors and the DSP extension of Cortex-M have bodies that are taken when compiling, all else runs
//! portable code. All give the same bits.

mod bhattacharyya;
mod kernels;
mod view_score;

pub use bhattacharyya::{BinPair, Panel, PanelRow, RootRows, best_coefficient, best_coefficients};
#[cfg(edgeloc_body = "x86_64")]
#[doc(hidden)]
pub use kernels::limit_body;
pub(crate) use kernels::{Body, PRUNES, Work, lower_by_step, run};
pub use kernels::{LANES, body_name};
pub use view_score::{ViewScore, score_view};

//! Which segments of a look or of a prediction enter the matching.

use super::NaiveSegment;
use edgeloc::localize::LocalizerConfig;

/// Indices, ascending, of the segments that enter the matching.
///
/// Out go the short, those nearer to the horizontal than the exclusion (a stereo model lacks them, paper section 4.2
/// "Stereo Match Error") and, of what is left, all but the longest `max_segments`. Lengths of the same 1/16 px count as
/// equal; of equally long ones the first stays.
#[must_use]
pub fn prepare_scene(segments: &[NaiveSegment], config: &LocalizerConfig) -> Vec<usize> {
    let (min_length_px, exclusion) =
        (f64::from(config.min_length_px), f64::from(config.horizontal_exclusion.radians()));
    let mut kept: Vec<usize> = (0..segments.len())
        .filter(|&index| segments[index].length_px() >= min_length_px)
        .filter(|&index| segments[index].angle_to_horizontal() >= exclusion)
        .collect();
    let sixteenths = |index: usize| (segments[index].length_px() * 16.0).round() as u64;
    // A stable sort: equal lengths stay in the order given.
    kept.sort_by_key(|&index| std::cmp::Reverse(sixteenths(index)));
    kept.truncate(usize::from(config.max_segments));
    kept.sort_unstable();
    kept
}

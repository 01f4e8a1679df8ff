//! Similarity of histograms (paper, eq. 1) and the score of a scene against a view.

use super::{Histogram, NaiveSegment};

/// The Bhattacharyya coefficient `sum sqrt(a_i) sqrt(b_i)` of two normalised histograms: 1 when equal, 0 when disjoint.
#[must_use]
pub fn bhattacharyya_coefficient(a: &Histogram, b: &Histogram) -> f64 {
    assert_eq!(a.masses.len(), b.masses.len(), "histograms of one shape compare");
    a.masses.iter().zip(&b.masses).map(|(a, b)| a.sqrt() * b.sqrt()).sum()
}

/// For each scene segment the best coefficient over the view's, averaged with the scene segments' lengths as weights.
///
/// Takes the segments of the scene and the normalised histogram of each, and the view's normalised histograms. 0 when
/// either side is empty.
#[must_use]
pub fn view_score(scene: &[NaiveSegment], scene_histograms: &[Histogram], view_histograms: &[Histogram]) -> f64 {
    assert_eq!(scene.len(), scene_histograms.len(), "each scene segment has its histogram");
    let total_length: f64 = scene.iter().map(NaiveSegment::length_px).sum();
    if scene.is_empty() {
        return 0.0;
    }
    let weighted: f64 = scene
        .iter()
        .zip(scene_histograms)
        .map(|(segment, of_scene)| {
            let best =
                view_histograms.iter().map(|of_view| bhattacharyya_coefficient(of_scene, of_view)).fold(0.0, f64::max);
            segment.length_px() * best
        })
        .sum();
    weighted / total_length
}

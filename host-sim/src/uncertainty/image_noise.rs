//! Image noise: noisy grey levels move every detected edge a little.
//!
//! The paper (section 4.2) has no image noise of its own: its effects on the edge detector and the line fit "are
//! approximated by the following lateral edge shifting and geometric approximation error". So this source is a
//! composite that says how much of the two a given noise amounts to, and it acts through their very displacements:
//!
//! * A Canny detector localises one edgel of a step of height A in white noise of standard deviation n, smoothed by a
//!   Gaussian of any width, to s = sqrt(3/8) n / A px (Canny 1986, localisation criterion, the noise averaged along the edge by
//!   the same Gaussian): noise over gradient.
//! * Smoothing by 1 px makes the errors of edgels within 2 sqrt(pi) = 3.5 px of each other one error. A piece of L px
//!   has N = L / 3.5 independent ones, which move it along its normal by a Gaussian of s / sqrt(N).
//! * A piece ends at single edgels: each end point moves by a circular Gaussian of s.
//!
//! Noise of the sensor is not common to both images, which draw apart.
//!
//! The default is 0 grey levels because psi_l and psi_g at their defaults already are the paper's image noise; more
//! comes on top. psi_g = 0.15 px is what 10 grey levels do to edges of 40.

use super::geometric_approximation::misplaced;
use super::lateral_edge_shift::shifted;
use super::setting::source;
use super::{ActsIn, SourceFacts, UncertaintySource, for_each_feature};
use crate::camera::{StereoObservation, move_pieces};
use crate::random::Stream;

const FACTS: SourceFacts = SourceFacts {
    key: "image_noise",
    name: "image noise",
    symbol: "(psi_l, psi_g)",
    unit: "grey levels",
    stream_id: 6,
    is_enabled_by_default: true,
    default_magnitude: 0.0,
    legal_range: (0.0, 50.0),
    acts_in: ActsIn::Both,
    cause: "noisy pixels move an edge and its end points, by noise over contrast; at the default the paper's image noise \
            is what psi_l and psi_g stand for",
    citation: "Tian et al., section 4.2; Canny 1986, localisation criterion",
};

/// Standard deviation of an edgel's place in pixels, for noise as strong as the edge's contrast: sqrt(3/8).
const EDGEL_ERROR_PX: f64 = 0.612_372_435_695_794_5;

/// Length of an edge with one independent error, in pixels: 2 sqrt(pi) times the detector's smoothing of 1 px.
const INDEPENDENT_LENGTH_PX: f64 = 3.544_907_701_811_032;

source! {
    /// Moves pieces and their end points as noisy pixels do; the magnitude is the noise, in grey levels.
    pub struct ImageNoise: FACTS {
        /// Contrast of an edge, in grey levels.
        pub edge_contrast: f64 in 1.0 to 255.0 = 40.0,
    }
}

impl UncertaintySource for ImageNoise {
    fn apply(&self, observation: &mut StereoObservation, stream: &mut Stream) {
        if self.magnitude <= 0.0 {
            return;
        }
        let edgel_px = EDGEL_ERROR_PX * self.magnitude / self.edge_contrast;
        for_each_feature(observation, stream, |feature, stream| {
            for pieces in [&mut feature.left, &mut feature.right] {
                move_pieces(pieces, |piece| {
                    let independent_count = (f64::from(piece.length_px()) / INDEPENDENT_LENGTH_PX).max(1.0);
                    let [shift, _] = stream.circular_gaussian();
                    let (start, end) = shifted(piece, (shift * edgel_px / independent_count.sqrt()) as f32);
                    (misplaced(start, edgel_px, stream), misplaced(end, edgel_px, stream))
                });
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::test_observation::{observation, offsets_px, perturbed};

    #[test]
    fn zero_magnitude_is_the_identity() {
        let source = ImageNoise { magnitude: 0.0, ..ImageNoise::default() };
        assert_eq!(perturbed(&source, 200), observation(200));
    }

    #[test]
    fn the_default_adds_nothing_to_what_stands_for_it() {
        assert_eq!(perturbed(&ImageNoise::default(), 200), observation(200));
    }

    #[test]
    fn ten_grey_levels_on_an_edge_of_forty_are_psi_g() {
        assert!((EDGEL_ERROR_PX * 10.0 / 40.0 - 0.15).abs() < 0.005);
    }

    #[test]
    fn a_piece_moves_by_noise_over_contrast_and_less_the_longer_it_is() {
        let source = ImageNoise { magnitude: 20.0, ..ImageNoise::default() };
        let (before, after) = (observation(40_000), perturbed(&source, 40_000));
        let edgel_px = 0.612_37 * 20.0 / 40.0;
        for (shortest_px, longest_px) in [(10.0, 40.0), (100.0, 250.0)] {
            let (mut found, mut expected, mut count) = (0.0, 0.0, 0.0);
            for (before, after) in before.features.iter().zip(&after.features) {
                for (before, after) in [(&before.left[0], &after.left[0]), (&before.right[0], &after.right[0])] {
                    let length_px = f64::from(before.length_px());
                    if (shortest_px..longest_px).contains(&length_px) {
                        let [start, end] = offsets_px(before, after).map(f64::from);
                        // The whole piece moves as one, its end points on top of that: half of their variance is left
                        // in the middle.
                        let middle = 0.5 * (start + end);
                        found += middle * middle;
                        expected += edgel_px * edgel_px * (INDEPENDENT_LENGTH_PX / length_px + 0.5);
                        count += 1.0;
                    }
                }
            }
            assert!(count > 5000.0 && (found / expected - 1.0).abs() < 0.05, "{found} {expected} of {count}");
        }
    }

    #[test]
    fn left_and_right_draw_apart() {
        let source = ImageNoise { magnitude: 20.0, ..ImageNoise::default() };
        let (before, after) = (observation(500), perturbed(&source, 500));
        let alike = before.features.iter().zip(&after.features).filter(|(before, after)| {
            let left = offsets_px(&before.left[0], &after.left[0])[0];
            (left - offsets_px(&before.right[0], &after.right[0])[0]).abs() < 1e-3
        });
        assert!(alike.count() < 10);
    }
}

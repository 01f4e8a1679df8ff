//! Edge detection loss: blur and low contrast leave gaps in a detected edge.
//!
//! The share psi_e of the visible length goes (paper, section 4.2), in two ways, since "a part of an extended edge
//! feature can either be totally undetected or be detected with a biased orientation and location":
//!
//! * Whole features: of all features the share w = `whole_share` x psi_e, lost in both images at once, because what has
//!   no contrast has none for either eye.
//! * Gaps: every other piece loses exactly the share g of its length, 1 - psi_e = (1 - w) (1 - g), so that psi_e of the
//!   length goes on average. One gap up to 50 px of length, two up to 150 px and three beyond, of random widths at
//!   random places: gaps and what remains between them split their totals uniformly. Left and right image draw their
//!   own gaps, so that a 3-D segment needs the edge in both. Remains below [`Segment2::MIN_LENGTH_PX`] vanish too, a
//!   share far below one per mille.
//!
//! `whole_share` is 0.6 by default: in real images 14 to 16 % of the length is lost from view to view, and 8 to 11 % of
//! the segments vanish whole while the median one loses 2 %. With 0 each feature loses psi_e in gaps.

use super::setting::source;
use super::{ActsIn, SourceFacts, UncertaintySource, for_each_feature};
use crate::camera::StereoObservation;
use crate::random::Stream;
use edgeloc::geometry::Segment2;

const FACTS: SourceFacts = SourceFacts {
    key: "edge_detection_loss",
    name: "edge detection loss",
    symbol: "psi_e",
    unit: "share of length",
    stream_id: 2,
    is_enabled_by_default: true,
    default_magnitude: 0.1125,
    legal_range: (0.0, 0.3125),
    acts_in: ActsIn::Both,
    cause: "blur and low contrast hide that share of the length of edges, some whole, the others in gaps",
    citation: "Tian et al., section 4.2, after Coupe 2009",
};

/// Greatest length of a piece with one gap, and with two, in pixels.
const GAP_LENGTHS_PX: [f32; 2] = [50.0, 150.0];

/// Most gaps in one piece.
const MAX_GAPS: usize = 3;

source! {
    /// Hides features whole and cuts gaps into the others; the magnitude is psi_e, the share of the length that goes.
    pub struct EdgeDetectionLoss: FACTS {
        /// Share of the loss that takes whole features, from both images; the rest are gaps.
        pub whole_share: f64 in 0.0 to 1.0 = 0.6,
    }
}

impl UncertaintySource for EdgeDetectionLoss {
    fn apply(&self, observation: &mut StereoObservation, stream: &mut Stream) {
        if self.magnitude <= 0.0 {
            return;
        }
        let lost_whole = self.whole_share * self.magnitude;
        let lost_in_gaps = (self.magnitude - lost_whole) / (1.0 - lost_whole);
        for_each_feature(observation, stream, |feature, stream| {
            if stream.chance(lost_whole) {
                feature.left.clear();
                feature.right.clear();
            } else if lost_in_gaps > 0.0 {
                cut_gaps(&mut feature.left, lost_in_gaps, stream);
                cut_gaps(&mut feature.right, lost_in_gaps, stream);
            }
        });
    }
}

/// Cuts the share `lost` of its length out of every piece.
fn cut_gaps(pieces: &mut Vec<Segment2>, lost: f64, stream: &mut Stream) {
    let whole_count = pieces.len();
    for index in 0..whole_count {
        let whole = pieces[index];
        let gap_count = 1 + GAP_LENGTHS_PX.iter().filter(|&&length_px| whole.length_px() > length_px).count();
        let gaps = random_shares(gap_count, stream);
        let remains = random_shares(gap_count + 1, stream);
        let mut from = 0.0;
        for (remain, gap) in remains.iter().zip(gaps.iter().chain([&0.0])).take(gap_count + 1) {
            let to = from + remain * (1.0 - lost);
            pieces.extend(part(&whole, from as f32, to as f32));
            from = to + gap * lost;
        }
    }
    pieces.drain(..whole_count);
}

/// Splits 1 into `count` shares, uniform among all such splits: the spacings of uniform numbers. The rest are 0.
fn random_shares(count: usize, stream: &mut Stream) -> [f64; MAX_GAPS + 1] {
    let mut cuts = [1.0; MAX_GAPS + 1];
    let drawn = &mut cuts[..count - 1];
    drawn.fill_with(|| stream.unit());
    drawn.sort_unstable_by(f64::total_cmp);
    for index in (1..cuts.len()).rev() {
        cuts[index] -= cuts[index - 1];
    }
    cuts
}

/// The part of a piece between two fractions of the way from its start to its end, if long enough to exist.
fn part(piece: &Segment2, from: f32, to: f32) -> Option<Segment2> {
    let at = |fraction: f32| piece.start().lerp(piece.end(), fraction);
    Segment2::new(at(from), at(to), piece.polarity()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::test_observation::{observation, perturbed};

    #[test]
    fn zero_magnitude_is_the_identity() {
        let source = EdgeDetectionLoss { magnitude: 0.0, ..EdgeDetectionLoss::default() };
        assert_eq!(perturbed(&source, 200), observation(200));
    }

    fn in_gaps_alone() -> EdgeDetectionLoss {
        EdgeDetectionLoss { whole_share: 0.0, ..EdgeDetectionLoss::default() }
    }

    fn length_px(pieces: &[Segment2]) -> f64 {
        pieces.iter().map(|piece| f64::from(piece.length_px())).sum()
    }

    #[test]
    fn the_share_psi_of_all_length_is_lost_however_much_of_it_goes_whole() {
        let before = observation(40_000);
        let total_px: f64 = before.features.iter().map(|feature| length_px(&feature.left)).sum();
        for magnitude in [0.1125, 0.3125] {
            for whole_share in [0.0, 0.6, 1.0] {
                let source = EdgeDetectionLoss { magnitude, whole_share, ..EdgeDetectionLoss::default() };
                let after = perturbed(&source, 40_000);
                let kept_px: f64 = after.features.iter().map(|feature| length_px(&feature.left)).sum();
                let lost_share = 1.0 - kept_px / total_px;
                assert!((lost_share - magnitude).abs() < 0.01, "{lost_share} of {magnitude}, {whole_share} whole");
                let whole_count = after.features.iter().filter(|feature| feature.left.is_empty()).count();
                let vanished_share = whole_count as f64 / 40_000.0;
                assert!((vanished_share - whole_share * magnitude).abs() < 0.005, "{vanished_share}");
            }
        }
    }

    #[test]
    fn a_feature_lost_whole_is_lost_in_both_images() {
        let after = perturbed(&EdgeDetectionLoss::default(), 4000);
        assert!(after.features.iter().all(|feature| feature.left.is_empty() == feature.right.is_empty()));
    }

    #[test]
    fn every_feature_not_lost_whole_loses_the_same_share_in_one_to_three_gaps() {
        for magnitude in [0.1125, 0.3125] {
            let source = EdgeDetectionLoss { magnitude, ..EdgeDetectionLoss::default() };
            let (before, after) = (observation(4000), perturbed(&source, 4000));
            let kept_share = (1.0 - magnitude) / (1.0 - 0.6 * magnitude);
            for (before, after) in before.features.iter().zip(&after.features) {
                for (before, after) in [(&before.left, &after.left), (&before.right, &after.right)] {
                    if !after.is_empty() {
                        assert!(after.len() <= MAX_GAPS + 1, "{after:?}");
                        // A remain shorter than the shortest segment may go with its gap.
                        let missing_px = length_px(before) * kept_share - length_px(after);
                        assert!(missing_px > -0.01 && missing_px < 0.0626 * 3.0, "{missing_px} of {before:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn longer_features_have_more_gaps() {
        let after = perturbed(&EdgeDetectionLoss::default(), 4000);
        for (before, after) in observation(4000).features.iter().zip(&after.features) {
            let most = match before.left[0].length_px() {
                length_px if length_px > 150.0 => 4,
                length_px if length_px > 50.0 => 3,
                _ => 2,
            };
            assert!(after.left.len() <= most, "{before:?} {after:?}");
        }
    }

    #[test]
    fn every_tenth_of_an_edge_is_lost_about_as_often() {
        // A little less at the two ends, where gaps lie on one side only.
        let (before, after) = (observation(20_000), perturbed(&in_gaps_alone(), 20_000));
        for tenth in 0..10 {
            let fraction = (tenth as f32 + 0.5) / 10.0;
            let pairs = before.features.iter().zip(&after.features);
            let seen_count = pairs
                .filter(|(before, after)| {
                    let point = before.left[0].start().lerp(before.left[0].end(), fraction);
                    let covers = |piece: &Segment2| {
                        piece.start().distance(point) + point.distance(piece.end()) < piece.length_px() + 1e-3
                    };
                    after.left.iter().any(covers)
                })
                .count();
            let seen_share = seen_count as f64 / 20_000.0;
            assert!((0.86..0.93).contains(&seen_share), "{tenth}: {seen_share}");
        }
    }

    #[test]
    fn left_and_right_draw_their_own_gaps() {
        let after = perturbed(&in_gaps_alone(), 200);
        let share = |pieces: &[Segment2]| pieces[0].length_px() / pieces.iter().map(Segment2::length_px).sum::<f32>();
        let alike = after.features.iter().filter(|feature| (share(&feature.left) - share(&feature.right)).abs() < 1e-4);
        assert!(alike.count() < 10);
    }
}

//! Edge detection loss: blur and low contrast leave gaps in a detected edge.
//!
//! Each piece loses exactly the share psi_e of its length (paper, section 4.2), as one gap up to 50 px of length, two
//! up to 150 px and three beyond, of random widths at random places: gaps and what remains between them split their
//! totals uniformly. Left and right image draw their own gaps, so that a 3-D segment needs the edge in both. Remains
//! below [`Segment2::MIN_LENGTH_PX`] vanish too, a share far below one per mille.

use super::setting::source;
use super::{ActsIn, SourceFacts, UncertaintySource};
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
    cause: "blur and low contrast hide that share of each edge's length, in gaps",
    citation: "Tian et al., section 4.2, after Coupe 2009",
};

/// Greatest length of a piece with one gap, and with two, in pixels.
const GAP_LENGTHS_PX: [f32; 2] = [50.0, 150.0];

/// Most gaps in one piece.
const MAX_GAPS: usize = 3;

source! {
    /// Cuts gaps into each piece; the magnitude is psi_e, the share of the length that goes.
    pub struct EdgeDetectionLoss: FACTS {}
}

impl UncertaintySource for EdgeDetectionLoss {
    fn apply(&self, observation: &mut StereoObservation, stream: &mut Stream) {
        if self.magnitude <= 0.0 {
            return;
        }
        for feature in &mut observation.features {
            self.cut_gaps(&mut feature.left, stream);
            self.cut_gaps(&mut feature.right, stream);
        }
    }
}

impl EdgeDetectionLoss {
    fn cut_gaps(&self, pieces: &mut Vec<Segment2>, stream: &mut Stream) {
        let whole_count = pieces.len();
        for index in 0..whole_count {
            let whole = pieces[index];
            let gap_count = 1 + GAP_LENGTHS_PX.iter().filter(|&&length_px| whole.length_px() > length_px).count();
            let gaps = random_shares(gap_count, stream);
            let remains = random_shares(gap_count + 1, stream);
            let mut from = 0.0;
            for (remain, gap) in remains.iter().zip(gaps.iter().chain([&0.0])).take(gap_count + 1) {
                let to = from + remain * (1.0 - self.magnitude);
                pieces.extend(part(&whole, from as f32, to as f32));
                from = to + gap * self.magnitude;
            }
        }
        pieces.drain(..whole_count);
    }
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

    #[test]
    fn every_feature_loses_the_share_psi_in_one_to_three_gaps() {
        for magnitude in [0.1125, 0.3125] {
            let source = EdgeDetectionLoss { magnitude, ..EdgeDetectionLoss::default() };
            let (before, after) = (observation(4000), perturbed(&source, 4000));
            let (mut length_px, mut kept_px) = (0.0, 0.0);
            for (before, after) in before.features.iter().zip(&after.features) {
                for (before, after) in [(&before.left, &after.left), (&before.right, &after.right)] {
                    let kept: f32 = after.iter().map(Segment2::length_px).sum();
                    assert!((1..=MAX_GAPS + 1).contains(&after.len()), "{after:?}");
                    // A remain shorter than the shortest segment may go with its gap.
                    let missing = f64::from(before[0].length_px()) * (1.0 - magnitude) - f64::from(kept);
                    assert!(missing > -0.01 && missing < 0.0626 * 3.0, "{missing} of {before:?}");
                    length_px += f64::from(before[0].length_px());
                    kept_px += f64::from(kept);
                }
            }
            assert!((1.0 - kept_px / length_px - magnitude).abs() < 1e-3, "{}", 1.0 - kept_px / length_px);
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
        let (before, after) = (observation(20_000), perturbed(&EdgeDetectionLoss::default(), 20_000));
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
        let after = perturbed(&EdgeDetectionLoss::default(), 200);
        let share = |pieces: &[Segment2]| pieces[0].length_px() / pieces.iter().map(Segment2::length_px).sum::<f32>();
        let alike = after.features.iter().filter(|feature| (share(&feature.left) - share(&feature.right)).abs() < 1e-4);
        assert!(alike.count() < 10);
    }
}

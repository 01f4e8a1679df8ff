//! Corner detection loss: a corner seen in one image is not found again in the other.
//!
//! In each image each corner is lost with probability p, drawn anew for each pair of images: p = psi_cd (1 +
//! U(-1, 1) 2 / 3), within 15 +- 10 % at the default and nothing at 0 (paper, section 4.2, after Thacker and Courtney
//! 1992: 85 % of the corners are found again). A pair needs its corner in both images.
//!
//! Corners serve calibration alone: this source reaches a map through the parameters that fewer corners leave less
//! certain.

use super::setting::source;
use super::{ActsIn, SourceFacts, UncertaintySource};
use crate::random::Stream;
use edgeloc::stereo::CornerPair;

const FACTS: SourceFacts = SourceFacts {
    key: "corner_detection_loss",
    name: "corner detection loss",
    symbol: "psi_cd",
    unit: "share of corners",
    stream_id: 7,
    is_enabled_by_default: true,
    default_magnitude: 0.15,
    legal_range: (0.0, 0.6),
    acts_in: ActsIn::Calibration,
    cause: "in each image the corner detector misses that share, +- two thirds of it, before calibration",
    citation: "Tian et al., section 4.2, after Thacker and Courtney 1992",
};

/// How far the share varies from one pair of images to the next: 15 +- 10 %.
const VARIATION: f64 = 2.0 / 3.0;

source! {
    /// Drops corners before calibration; the magnitude is psi_cd, a share of the corners of an image.
    pub struct CornerDetectionLoss: FACTS {}
}

impl UncertaintySource for CornerDetectionLoss {}

impl CornerDetectionLoss {
    /// Drops the pairs of one view that lose their corner in either image.
    pub fn drop_corners(&self, corners: &mut Vec<CornerPair>, stream: &mut Stream) {
        let [in_left, in_right] = [(); 2].map(|()| self.magnitude * (1.0 + VARIATION * stream.uniform(-1.0, 1.0)));
        corners.retain(|_| {
            let (is_lost_left, is_lost_right) = (stream.chance(in_left), stream.chance(in_right));
            !is_lost_left && !is_lost_right
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::test_observation::corners;

    #[test]
    fn zero_magnitude_is_the_identity() {
        let mut kept = corners(200);
        let none = CornerDetectionLoss { magnitude: 0.0, ..CornerDetectionLoss::default() };
        none.drop_corners(&mut kept, &mut Stream::new(1, "test", 0, 0));
        assert_eq!(kept, corners(200));
    }

    #[test]
    fn a_pair_survives_both_images_and_the_share_varies_between_views() {
        let mut shares = Vec::new();
        for view in 0..400 {
            let mut kept = corners(200);
            CornerDetectionLoss::default().drop_corners(&mut kept, &mut Stream::new(1, "test", view, 0));
            shares.push(kept.len() as f64 / 200.0);
        }
        let mean = shares.iter().sum::<f64>() / shares.len() as f64;
        // The two images draw their shares apart, so the means multiply.
        assert!((mean - 0.85 * 0.85).abs() < 0.01, "{mean}");
        let spread = shares.iter().map(|share| (share - mean).powi(2)).sum::<f64>() / shares.len() as f64;
        // Of each image's uniform +- 10 %, and of 200 chances.
        let expected = 2.0 * 0.85 * 0.85 * 0.01 / 3.0 + mean * (1.0 - mean) / 200.0;
        assert!((spread / expected - 1.0).abs() < 0.25, "{spread} {expected}");
    }
}

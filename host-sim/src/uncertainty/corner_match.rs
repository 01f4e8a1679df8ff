//! Corner match error: a wrong corner of the other image is taken for the right one.
//!
//! In each image each corner is moved with probability p to somewhere in a circle of 10 px round it, uniformly by area;
//! p = psi_cm (1 + U(-1, 1)) is drawn anew for each pair of images: within 1 +- 1 % at the default and nothing at 0
//! (paper, section 4.2, after Thacker and Courtney 1992).
//!
//! Corners serve calibration alone. Its wrong matches are far from their epipolar lines and are left out there (see
//! [`edgeloc::stereo`]); what remains of this source is the few that happen to fit.

use super::setting::source;
use super::{ActsIn, SourceFacts, UncertaintySource};
use crate::random::Stream;
use edgeloc::geometry::Point2;
use edgeloc::stereo::CornerPair;

const FACTS: SourceFacts = SourceFacts {
    key: "corner_match",
    name: "corner match error",
    symbol: "psi_cm",
    unit: "share of corners",
    stream_id: 8,
    is_enabled_by_default: true,
    default_magnitude: 0.01,
    legal_range: (0.0, 0.25),
    acts_in: ActsIn::Calibration,
    cause: "in each image that share of the corners, +- as much, is matched up to 10 px beside, before calibration",
    citation: "Tian et al., section 4.2, after Thacker and Courtney 1992",
};

/// Greatest distance of a wrong match from the right one, in pixels.
const MAX_ERROR_PX: f64 = 10.0;

source! {
    /// Moves corners before calibration; the magnitude is psi_cm, a share of the corners of an image.
    pub struct CornerMatch: FACTS {}
}

impl UncertaintySource for CornerMatch {}

impl CornerMatch {
    /// Moves some corners of the pairs of one view.
    pub fn move_corners(&self, corners: &mut [CornerPair], stream: &mut Stream) {
        let [in_left, in_right] = [(); 2].map(|()| self.magnitude * (1.0 + stream.uniform(-1.0, 1.0)));
        for pair in corners {
            for (point, share) in [(&mut pair.left, in_left), (&mut pair.right, in_right)] {
                // Drawn for every corner, so that which ones move does not shift the draws of the others.
                let is_moved = stream.chance(share);
                let (turn, part) = (stream.uniform(0.0, core::f64::consts::TAU), stream.unit());
                if is_moved {
                    let (radius_px, (sin, cos)) = (MAX_ERROR_PX * part.sqrt(), libm::sincos(turn));
                    *point = Point2::new(point.x + (radius_px * cos) as f32, point.y + (radius_px * sin) as f32);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::test_observation::corners;

    fn moved(magnitude: f64, view: u64) -> Vec<CornerPair> {
        let mut moved = corners(500);
        let source = CornerMatch { magnitude, ..CornerMatch::default() };
        source.move_corners(&mut moved, &mut Stream::new(1, "test", view, 0));
        moved
    }

    #[test]
    fn zero_magnitude_is_the_identity() {
        assert_eq!(moved(0.0, 0), corners(500));
    }

    #[test]
    fn the_share_psi_moves_uniformly_inside_the_circle() {
        let mut distances_px = Vec::new();
        for view in 0..200 {
            for (before, after) in corners(500).iter().zip(moved(0.01, view)) {
                for (from, to) in [(before.left, after.left), (before.right, after.right)] {
                    distances_px.extend((from != to).then(|| f64::from(from.distance(to))));
                }
            }
        }
        let count = distances_px.len() as f64;
        assert!((count / 200_000.0 - 0.01).abs() < 0.001, "{count}");
        assert!(distances_px.iter().all(|distance_px| *distance_px <= 10.001));
        // Uniform by area: the mean square of the distance is half of the greatest.
        let mean_square = distances_px.iter().map(|distance_px| distance_px * distance_px).sum::<f64>() / count;
        assert!((mean_square - 50.0).abs() < 3.0, "{mean_square}");
    }
}

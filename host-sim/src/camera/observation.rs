//! What a stereo rig sees at one pose: each visible edge piece in both images.

use edgeloc::geometry::{Point2, Segment2, StereoRig};

/// One look of the stereo rig, before or after the uncertainty sources.
#[derive(Debug, PartialEq)]
pub struct StereoObservation {
    /// The true rig that made the images.
    pub rig: StereoRig,
    /// Every visible piece of an edge.
    pub features: Vec<StereoFeature>,
}

/// One visible piece of one edge as the two images show it.
///
/// An uncertainty source may move or break the pieces in an image, never look at the world behind them.
#[derive(Debug, PartialEq, Default)]
pub struct StereoFeature {
    /// Pieces detected in the left image, in pixels: one before edge detection loss, none when the edge is not
    /// seen there.
    pub left: Vec<Segment2>,
    /// Pieces detected in the right image, in pixels.
    pub right: Vec<Segment2>,
    /// Whether the stereo matcher pairs the left with the right pieces; an unmatched feature is seen but yields no
    /// 3-D segment.
    pub is_matchable: bool,
}

/// Replaces the end points of every piece of one image; `moved` gives the new start and end, in pixels.
///
/// A piece whose new end points make no [`Segment2`] (beyond 2048 px, or coinciding) is dropped: no detector reports
/// it. Pieces moved a little across the image border stay.
pub fn move_pieces(pieces: &mut Vec<Segment2>, mut moved: impl FnMut(&Segment2) -> (Point2, Point2)) {
    pieces.retain_mut(|piece| {
        let (start, end) = moved(piece);
        Segment2::new(start, end, piece.polarity()).map(|segment| *piece = segment).is_ok()
    });
}

// Cloned by hand for `clone_from`, which reuses the memory of the pieces: a map is cloned view by view for each draw
// of its noise.
impl Clone for StereoObservation {
    fn clone(&self) -> Self {
        Self { rig: self.rig, features: self.features.clone() }
    }

    fn clone_from(&mut self, source: &Self) {
        self.rig = source.rig;
        self.features.clone_from(&source.features);
    }
}

impl Clone for StereoFeature {
    fn clone(&self) -> Self {
        Self { left: self.left.clone(), right: self.right.clone(), is_matchable: self.is_matchable }
    }

    fn clone_from(&mut self, source: &Self) {
        self.left.clone_from(&source.left);
        self.right.clone_from(&source.right);
        self.is_matchable = source.is_matchable;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use edgeloc::geometry::Polarity;

    #[test]
    fn a_piece_moved_out_of_the_representable_plane_is_dropped_and_one_across_the_border_stays() {
        let segment = |x: f32| {
            Segment2::new(Point2::new(x, 10.0), Point2::new(x, 90.0), Polarity::LeftBrighter).expect("a segment")
        };
        let mut pieces = vec![segment(1.0), segment(2047.0)];
        let shift = |point: Point2, x: f32| Point2::new(point.x + x, point.y);
        move_pieces(&mut pieces, |piece| {
            let x = if piece.start().x < 100.0 { -3.0 } else { 3.0 };
            (shift(piece.start(), x), shift(piece.end(), x))
        });
        assert_eq!(pieces, [segment(-2.0)]);
    }
}

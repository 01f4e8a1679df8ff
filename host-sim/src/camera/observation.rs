//! What a stereo rig sees at one pose: each visible edge piece in both images.

use edgeloc::geometry::{Segment2, StereoRig};

/// One look of the stereo rig, before or after the uncertainty sources.
#[derive(Debug, Clone)]
pub struct StereoObservation {
    /// The true rig that made the images.
    pub rig: StereoRig,
    /// Every visible piece of an edge.
    pub features: Vec<StereoFeature>,
}

/// One visible piece of one edge as the two images show it.
///
/// An uncertainty source may move or break the pieces in an image, never look at the world behind them.
#[derive(Debug, Clone, Default)]
pub struct StereoFeature {
    /// Pieces detected in the left image [px]; one before edge detection loss, none when the edge is not seen there.
    pub left: Vec<Segment2>,
    /// Pieces detected in the right image [px].
    pub right: Vec<Segment2>,
    /// Whether the stereo matcher pairs the left with the right pieces; an unmatched feature is seen but yields no
    /// 3-D segment.
    pub is_matchable: bool,
}

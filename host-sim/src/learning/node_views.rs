//! What the stereo rig sees at a node before anything goes wrong: worked out once, perturbed once for every map.
//!
//! Only what can reach the node's model is kept: features seen in both images that come within half the view spacing of
//! the optical axis, plus 40 px for what the uncertainty sources may move them (15 px of lateral shift and five
//! standard deviations of end-point error at their greatest legal magnitudes). A third of the work is spared.

use crate::camera::{StereoFeature, StereoObservation, observe};
use crate::world::{Occluders, ViewpointVisibility, WireframeWorld};
use edgeloc::geometry::{Angle, Heading, Point2, Point3, StereoRig};
use edgeloc::math;
use rayon::prelude::*;

/// Farthest that the uncertainty sources move a left piece sideways, in pixels.
const MOVE_MARGIN_PX: f32 = 40.0;

/// The clean stereo observations at one node, at equally spaced headings.
#[derive(Debug, Clone)]
pub struct NodeViews {
    /// Where the left camera stood, in metres in the world frame.
    pub position: Point2,
    /// One observation per view, of what can reach the model; view `i` of `n` looks towards heading `i / n` of a
    /// turn from +x.
    pub views: Vec<StereoObservation>,
}

impl NodeViews {
    /// What `rig` sees at `position` in `view_count` directions; `occluders` are those of the world's surfaces.
    #[must_use]
    pub fn observe(
        rig: &StereoRig,
        world: &WireframeWorld,
        occluders: &Occluders,
        position: Point2,
        view_count: u16,
    ) -> Self {
        let eye = Point3::new(position.x, position.y, rig.camera_height_m);
        let mut visibility = ViewpointVisibility::new(world, occluders, eye);
        let observe_view = |view| {
            let mut observation = observe(rig, &mut visibility, view_heading(view, view_count));
            observation.features.retain(|feature| may_reach_model(rig, feature, view_count));
            observation
        };
        Self { position, views: (0..view_count).map(observe_view).collect() }
    }

    /// What `rig` sees at each of `positions`, in their order, worked out in parallel.
    #[must_use]
    pub fn observe_all(
        rig: &StereoRig,
        world: &WireframeWorld,
        occluders: &Occluders,
        positions: &[Point2],
        view_count: u16,
    ) -> Vec<Self> {
        let observe_one = |&position: &Point2| Self::observe(rig, world, occluders, position, view_count);
        positions.par_iter().map(observe_one).collect()
    }
}

/// Whether a clean feature may still, perturbed, give a segment in the sector of a view.
fn may_reach_model(rig: &StereoRig, feature: &StereoFeature, view_count: u16) -> bool {
    if !feature.is_matchable || view_count <= 2 {
        return feature.is_matchable;
    }
    // A bearing shows in the left image alone: the column is c_x + f tan(bearing).
    let sector_px = rig.camera.focal_length_px() * math::tan(half_spacing_rad(view_count)) + MOVE_MARGIN_PX;
    let center_px = rig.camera.principal_point_px().x;
    feature.left.iter().any(|piece| {
        let (start, end) = (piece.start().x - center_px, piece.end().x - center_px);
        start.max(end) > -sector_px && start.min(end) < sector_px
    })
}

/// Half the angle between neighbouring views, in radians.
pub(super) fn half_spacing_rad(view_count: u16) -> f32 {
    core::f32::consts::PI / f32::from(view_count)
}

/// Heading of view `view` of `view_count`.
pub(super) fn view_heading(view: u16, view_count: u16) -> Heading {
    let turns = f32::from(view) / f32::from(view_count);
    Heading::new(Angle::from_degrees(360.0 * turns)).expect("less than a turn")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twelve_views_stand_thirty_degrees_apart_from_heading_zero() {
        for view in 0..12_u16 {
            let expected = Heading::new(Angle::from_degrees(f32::from(view) * 30.0)).expect("a finite heading");
            let difference = view_heading(view, 12).angle().radians() - expected.angle().radians();
            assert!(Angle::from_radians(difference).wrapped().radians().abs() < 1e-5, "{view}");
        }
    }
}

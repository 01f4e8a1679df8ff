//! What the stereo rig sees at a node before anything goes wrong: worked out once, perturbed once for every map.
//!
//! Features seen in both images are kept, wherever they are: a node learns only a sector of each view, but its robot's
//! calibration error alone may move all of them by some 100 px, image noise single ones as far.

use crate::camera::{StereoObservation, observe};
use crate::world::{Occluders, ViewpointVisibility, WireframeWorld};
use edgeloc::geometry::{Angle, Heading, Point2, Point3, StereoRig};
use rayon::prelude::*;

/// The clean stereo observations at one node, at equally spaced headings.
#[derive(Debug, Clone)]
pub struct NodeViews {
    /// Where the left camera stood, in metres in the world frame.
    pub position: Point2,
    /// One observation per view, of what both images show; view `i` of `n` looks towards heading `i / n` of a
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
            observation.features.retain(|feature| feature.is_matchable);
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

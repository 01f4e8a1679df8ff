//! Reference viewpoints: the paper's way to know what is visible (section 4.1).
//!
//! Points uniformly spread over the free space, 236 in the paper, each with the edges that are to be seen from it; a
//! robot sees what the nearest of them lists. It is an approximation in three ways:
//! 1. edges are listed whole: one that passes behind a cupboard is drawn through it, or not at all;
//! 2. a robot between two viewpoints sees what is seen half a metre away, from there;
//! 3. the nearest is the nearest as the crow flies, though a wall may stand between.
//!
//! The [`mod@file`] that holds them can be edited by hand, and with `edgeloc world edit`.

mod edge_set;
pub mod file;

pub use edge_set::EdgeSet;

use super::{Occluders, ViewpointVisibility, WireframeWorld};
use edgeloc::geometry::{Point2, Point3};
use rayon::prelude::*;

/// How many reference viewpoints the paper has.
pub const PAPER_VIEWPOINT_COUNT: u16 = 236;

/// The share of an edge's length that must be seen for the edge to be listed.
const LEAST_SEEN_SHARE: f32 = 0.5;

/// One point with what is visible from it, in any direction.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceViewpoint {
    /// Its number in the file, unique there.
    pub id: u32,
    /// Where it is, world frame \[m\].
    pub position: Point2,
    /// The edges visible from it, by their index in the world.
    pub visible: EdgeSet,
}

/// The reference viewpoints of one world.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceViewpoints {
    world_name: String,
    world_checksum: u64,
    edge_count: u32,
    camera_height_m: f32,
    viewpoints: Vec<ReferenceViewpoint>,
}

impl ReferenceViewpoints {
    /// What is visible at `positions`, at least one, from the surfaces of `world`: the edges that are seen over at
    /// least half of their length. `on_viewpoint` is told of each that is done.
    ///
    /// # Panics
    /// Without a position.
    #[must_use]
    pub fn from_surfaces(
        world: &WireframeWorld,
        occluders: &Occluders,
        positions: &[Point2],
        camera_height_m: f32,
        on_viewpoint: &(dyn Fn() + Sync),
    ) -> Self {
        assert!(!positions.is_empty(), "a robot needs a nearest viewpoint");
        let look_around = |(id, &position): (usize, &Point2)| {
            let eye = Point3::new(position.x, position.y, camera_height_m);
            let mut visibility = ViewpointVisibility::through_surfaces(world, occluders, eye);
            let is_listed = |&edge: &u32| {
                let parts = visibility.visible_parts(edge as usize);
                let seen_m = parts.iter().map(edgeloc::geometry::Segment3::length_m).sum::<f32>();
                seen_m > 0.0 && seen_m >= LEAST_SEEN_SHARE * world.edges[edge as usize].length_m()
            };
            let visible = (0..world.edges.len() as u32).filter(is_listed).collect();
            on_viewpoint();
            ReferenceViewpoint { id: id as u32, position, visible }
        };
        Self {
            world_name: world.name.clone(),
            world_checksum: world.checksum(),
            edge_count: world.edges.len() as u32,
            camera_height_m,
            viewpoints: positions.par_iter().enumerate().map(look_around).collect(),
        }
    }

    /// The viewpoints, at least one, in the order of the file.
    #[must_use]
    pub fn viewpoints(&self) -> &[ReferenceViewpoint] {
        &self.viewpoints
    }

    /// Height of the eye at which visibility was taken \[m\].
    #[must_use]
    pub const fn camera_height_m(&self) -> f32 {
        self.camera_height_m
    }

    /// The viewpoint that serves a robot at `position`: the nearest; of several, the first.
    #[must_use]
    pub fn nearest(&self, position: Point2) -> &ReferenceViewpoint {
        let distance = |viewpoint: &&ReferenceViewpoint| viewpoint.position.distance(position);
        let nearest = self.viewpoints.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.expect("there is at least one viewpoint")
    }

    /// Shows or hides edges from the viewpoint at `index`; the edges that did change.
    ///
    /// # Panics
    /// When there is no such viewpoint, or no such edge in the world.
    pub fn set_visible(&mut self, index: usize, edges: impl IntoIterator<Item = u32>, is_visible: bool) -> Vec<u32> {
        let visible = &mut self.viewpoints[index].visible;
        let mut changed = Vec::new();
        for edge in edges {
            assert!(edge < self.edge_count, "the world has {} edges, there is no edge {edge}", self.edge_count);
            if visible.set(edge, is_visible) {
                changed.push(edge);
            }
        }
        changed
    }

    /// Whether these viewpoints were made for `world`.
    ///
    /// # Errors
    /// When they were made for another world, or for this one before it changed.
    pub fn check_world(&self, world: &WireframeWorld) -> Result<(), OtherWorld> {
        let checksum = world.checksum();
        if self.world_checksum == checksum && self.edge_count as usize == world.edges.len() {
            return Ok(());
        }
        Err(OtherWorld {
            made_for: self.world_name.clone(),
            made_for_checksum: self.world_checksum,
            world: world.name.clone(),
            world_checksum: checksum,
        })
    }

    /// Whether these viewpoints were taken at the height of a robot's eye, to a millimetre.
    ///
    /// # Errors
    /// When they were taken at another.
    pub fn check_height(&self, camera_height_m: f32) -> Result<(), OtherHeight> {
        if (self.camera_height_m - camera_height_m).abs() <= 1e-3 {
            return Ok(());
        }
        Err(OtherHeight { taken_at_m: self.camera_height_m, camera_height_m })
    }

    /// CRC-64 of the text of the file, bit for bit: viewpoints of the same sum give the same trials.
    #[must_use]
    pub fn checksum(&self) -> u64 {
        crc::Crc::<u64>::new(&crc::CRC_64_XZ).checksum(file::to_text(self).as_bytes())
    }
}

/// The viewpoints belong to another world.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "the viewpoints were made for the world {made_for:?} with checksum {made_for_checksum:016x}, this is {world:?} with \
     {world_checksum:016x}: edge numbers would mean other edges"
)]
pub struct OtherWorld {
    /// Name of the world that they were made for.
    pub made_for: String,
    /// Its checksum.
    pub made_for_checksum: u64,
    /// Name of the world at hand.
    pub world: String,
    /// Its checksum.
    pub world_checksum: u64,
}

/// The viewpoints belong to another eye.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("the viewpoints were taken {taken_at_m} m above the floor, the camera stands {camera_height_m} m above it")]
pub struct OtherHeight {
    /// Height at which they were taken \[m\].
    pub taken_at_m: f32,
    /// Height of the camera at hand \[m\].
    pub camera_height_m: f32,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::Surfaces;
    use edgeloc::geometry::{Polarity, Segment3};

    /// Upright edges at x = 1, 2, 3 m, and a wall at x = 2.5 m from y = 0 on.
    fn world() -> WireframeWorld {
        let edge = |x: f32, y: f32| Segment3 {
            start: Point3::new(x, y, 0.5),
            end: Point3::new(x, y, 1.5),
            polarity: Polarity::LeftBrighter,
        };
        let corners = [(0.0, -9.0), (9.0, -9.0), (9.0, 9.0), (0.0, 9.0)];
        let vertices = corners.map(|(y, z)| Point3::new(2.5, y, z)).to_vec();
        WireframeWorld {
            name: "three".to_owned(),
            edges: vec![edge(1.0, 1.0), edge(2.0, 1.0), edge(3.0, 1.0)],
            surfaces: Surfaces { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]] },
            ..WireframeWorld::default()
        }
    }

    fn viewpoints() -> ReferenceViewpoints {
        let world = world();
        let positions = [Point2::new(0.0, 1.0), Point2::new(4.0, 1.1)];
        ReferenceViewpoints::from_surfaces(&world, &Occluders::new(&world.surfaces), &positions, 1.0, &|| ())
    }

    #[test]
    fn a_viewpoint_lists_what_no_surface_hides_from_it() {
        let viewpoints = viewpoints();
        let listed = |index: usize| viewpoints.viewpoints()[index].visible.iter().collect::<Vec<_>>();
        assert_eq!((listed(0), listed(1)), (vec![0, 1], vec![2]));
    }

    #[test]
    fn the_nearest_viewpoint_serves_and_of_two_the_first() {
        let viewpoints = viewpoints();
        assert_eq!(viewpoints.nearest(Point2::new(1.5, 1.0)).id, 0);
        assert_eq!(viewpoints.nearest(Point2::new(2.5, 1.0)).id, 1);
        let mut twice = viewpoints.clone();
        twice.viewpoints[1].position = twice.viewpoints[0].position;
        assert_eq!(twice.nearest(Point2::new(9.0, 9.0)).id, 0);
    }

    #[test]
    fn a_robot_sees_whole_the_edges_that_the_nearest_viewpoint_lists() {
        let mut viewpoints = viewpoints();
        let seen_from = |viewpoints: &ReferenceViewpoints, x: f32| {
            let world = WireframeWorld { reference_viewpoints: Some(viewpoints.clone()), ..world() };
            let occluders = Occluders::new(&world.surfaces);
            let mut visibility = ViewpointVisibility::new(&world, &occluders, Point3::new(x, 1.0, 1.0));
            (0..3).filter(|&edge| visibility.visible_parts(edge) == [world.edges[edge]]).collect::<Vec<_>>()
        };
        assert_eq!((seen_from(&viewpoints, 0.3), seen_from(&viewpoints, 3.3)), (vec![0, 1], vec![2]));
        assert_eq!(viewpoints.set_visible(0, [0, 2, 1], false), [0, 1]);
        assert_eq!(viewpoints.set_visible(0, [2], true), [2]);
        assert_eq!(seen_from(&viewpoints, 0.3), [2]);
    }

    #[test]
    fn viewpoints_of_another_world_are_refused() {
        let (viewpoints, mut other) = (viewpoints(), world());
        assert_eq!(viewpoints.check_world(&other), Ok(()));
        other.edges[1].end.z = 1.6;
        let error = viewpoints.check_world(&other).expect_err("it has changed").to_string();
        assert!(error.contains("made for the world \"three\""), "{error}");
    }

    #[test]
    fn viewpoints_of_another_height_are_refused_with_both() {
        assert_eq!(viewpoints().check_height(1.0), Ok(()));
        let error = viewpoints().check_height(1.25).expect_err("another eye").to_string();
        assert!(error.contains("taken 1 m") && error.contains("stands 1.25 m"), "{error}");
    }

    #[test]
    fn the_checksum_sees_every_edit() {
        let (before, mut after) = (viewpoints(), viewpoints());
        after.set_visible(1, [0], true);
        assert_ne!(before.checksum(), after.checksum());
        after.set_visible(1, [0], false);
        assert_eq!(before.checksum(), after.checksum());
    }
}

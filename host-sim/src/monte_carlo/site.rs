//! What all trials of a run share: the building, the nodes in it and what a noise-free robot saw from them.

use crate::learning::{
    self, CalibratedRig, CalibrationBench, NodePlacementError, NodeViews, SightCoverage, Surroundings, UNLEARNED_WAY_M,
    Withheld,
};
use crate::scenario::{LocalizerKind, Scenario, Start};
use crate::uncertainty::Sources;
use crate::world::{FreeSpace, FreeSpaceError, FreeSpaceOptions, Occluders, ViewpointVisibility, WireframeWorld};
use edgeloc::database::{self, TopologicalDatabase, WriteError};
use edgeloc::geometry::{Point2, Point3, StereoRig};
use std::sync::Arc;

/// A building made ready for learning and trials.
#[derive(Debug)]
pub struct Site {
    /// The building.
    pub world: Arc<WireframeWorld>,
    /// Its surfaces, ready for visibility rays.
    pub occluders: Arc<Occluders>,
    /// Where the robot can stand.
    pub free_space: Arc<FreeSpace>,
    /// The robot's stereo rig.
    pub rig: StereoRig,
    /// Where the learned nodes are, world frame \[m\].
    pub nodes: Vec<Point2>,
    /// The part of the free space that is not learned.
    pub withheld: Withheld,
    /// Centers of the free cells that no map knows, world frame \[m\]; see [`Start::Unlearned`].
    pub unlearned: Vec<Point2>,
    /// Where the robot's calibrations come from: the same for every set of nodes.
    pub calibration_bench: Arc<CalibrationBench>,
    /// The robot, if it comes calibrated from elsewhere; else each map is learned by one calibrated here.
    pub robot: Option<Arc<CalibratedRig>>,
    node_views: Vec<NodeViews>,
}

impl Site {
    /// Finds the free space of `world`, places the scenario's nodes in it and looks around from each, without noise.
    ///
    /// # Errors
    /// When there is no free space, or not enough for the nodes.
    pub fn prepare(world: WireframeWorld, scenario: &Scenario) -> Result<Self, SiteError> {
        let rig = scenario.rig.stereo_rig().map_err(SiteError::Rig)?;
        let occluders = Arc::new(Occluders::new(&world.surfaces));
        let free_space = Arc::new(FreeSpace::of(&world, &FreeSpaceOptions::default())?);
        let bench = Arc::new(CalibrationBench::observe(&rig, &world, &occluders, &free_space, scenario.seed));
        Self::learned(Arc::new(world), occluders, free_space, bench, rig, scenario)
    }

    /// The same building with the nodes of another `scenario` of the same world, rig and seed.
    ///
    /// # Errors
    /// When there is not enough free space for the nodes.
    pub fn learned_anew(&self, scenario: &Scenario) -> Result<Self, SiteError> {
        let (world, occluders, free_space) = (self.world.clone(), self.occluders.clone(), self.free_space.clone());
        Self::learned(world, occluders, free_space, self.calibration_bench.clone(), self.rig, scenario)
    }

    fn learned(
        world: Arc<WireframeWorld>,
        occluders: Arc<Occluders>,
        free_space: Arc<FreeSpace>,
        calibration_bench: Arc<CalibrationBench>,
        rig: StereoRig,
        scenario: &Scenario,
    ) -> Result<Self, SiteError> {
        let node_count = usize::from(scenario.learning.nodes);
        let surroundings = Surroundings {
            world: &world,
            occluders: &occluders,
            space: &free_space,
            eye_height_m: rig.camera_height_m,
        };
        let mut nodes = scenario.learning.placement.place(&surroundings, node_count, scenario.seed)?;
        let withheld = Withheld::grow(&free_space, scenario.learning.withheld, scenario.seed);
        nodes.retain(|&node| !withheld.contains(&free_space, node));
        if nodes.is_empty() {
            return Err(SiteError::NothingLearned { withheld: scenario.learning.withheld });
        }
        let unlearned = withheld.unlearned_centers(&free_space, &nodes);
        let node_views = NodeViews::observe_all(&rig, &world, &occluders, &nodes, scenario.learning.views);
        let robot = None;
        Ok(Self { world, occluders, free_space, rig, nodes, withheld, unlearned, calibration_bench, robot, node_views })
    }

    /// Whether a robot can be put down so.
    ///
    /// # Errors
    /// When every place of the withheld part is near a learned node.
    pub fn check_start(&self, start: Start) -> Result<(), SiteError> {
        if start == Start::Unlearned && self.unlearned.is_empty() {
            return Err(SiteError::NothingUnlearned);
        }
        Ok(())
    }

    /// Learns the map, with the `map_index`-th draw of the uncertainty sources: the bytes of a topological database, with an
    /// index if it has more nodes than the localiser's shortlist.
    ///
    /// # Errors
    /// When what was learned does not fit the database format.
    pub fn learn_map(&self, scenario: &Scenario, map_index: u32) -> Result<Vec<u8>, WriteError> {
        let robot = self.calibrated_rig(&scenario.uncertainty, scenario.seed, map_index);
        let (seed, map_index) = (scenario.seed, u64::from(map_index));
        let mut learned = learning::learn_nodes(&robot, &self.node_views, &scenario.uncertainty, seed, map_index);
        for node in &mut learned {
            if scenario.learning.join {
                node.segments = learning::join_collinear(robot.rig(), &node.segments);
            }
            learning::keep_most_telling(&mut node.segments, usize::from(scenario.learning.max_segments));
        }
        let mut bytes = learning::write_map(&robot, scenario.learning.views, &learned)?;
        if scenario.localizer.kind == LocalizerKind::Edgeloc {
            let map = TopologicalDatabase::open(&bytes).expect("what was just written");
            let key = (seed, map_index);
            let agreement = learning::self_agreement(&map, &robot, &self.node_views, &scenario.uncertainty, key);
            if let Some(agreement) = agreement {
                database::state_self_agreement(&mut bytes, agreement).expect("a share, of a map just written");
            }
        }
        if self.nodes.len() > usize::from(scenario.localizer.shortlist) {
            bytes = learning::indexed(&bytes).map_err(|_| WriteError::TooLarge)?;
        }
        Ok(bytes)
    }

    /// The rig as the robot of the `map_index`-th map knows it: the one that learned the map and is put down with it.
    #[must_use]
    pub fn calibrated_rig(&self, sources: &Sources, seed: u64, map_index: u32) -> CalibratedRig {
        let calibrated_here = || self.calibration_bench.calibrated_rig(sources, seed, u64::from(map_index));
        self.robot.as_deref().cloned().unwrap_or_else(calibrated_here)
    }

    /// How well the nodes cover the free space.
    #[must_use]
    pub fn coverage(&self) -> SightCoverage {
        let Self { world, occluders, free_space: space, rig, .. } = self;
        let surroundings = Surroundings { world, occluders, space, eye_height_m: rig.camera_height_m };
        SightCoverage::of(&surroundings, &self.nodes)
    }

    /// The density of the nodes: free space for each \[m2\], without what is withheld.
    #[must_use]
    pub fn free_m2_per_node(&self) -> f64 {
        self.learned_m2() / self.nodes.len() as f64
    }

    /// Area of the free space without what is withheld \[m2\].
    #[must_use]
    pub fn learned_m2(&self) -> f64 {
        let cell_m2 = f64::from(self.free_space.cell_m()) * f64::from(self.free_space.cell_m());
        self.free_space.area_m2() - self.withheld.cell_count() as f64 * cell_m2
    }

    /// What can be seen from `position` at camera height.
    #[must_use]
    pub fn viewpoint(&self, position: Point2) -> ViewpointVisibility<'_> {
        let eye = Point3::new(position.x, position.y, self.rig.camera_height_m);
        ViewpointVisibility::new(&self.world, &self.occluders, eye)
    }

    /// The two nodes nearest to `position`, the nearest first; in a site of one node, that node twice.
    #[must_use]
    pub fn two_nearest_nodes(&self, position: Point2) -> [u32; 2] {
        let mut by_distance: Vec<u32> = (0..self.nodes.len() as u32).collect();
        let distance = |node: &u32| self.nodes[*node as usize].distance(position);
        by_distance.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        [by_distance[0], by_distance[by_distance.len().min(2) - 1]]
    }
}

/// Why a building can't be made ready.
#[derive(Debug, thiserror::Error)]
pub enum SiteError {
    /// The rig makes no sense.
    #[error("[rig] {0}")]
    Rig(String),
    /// The robot can stand nowhere.
    #[error(transparent)]
    FreeSpace(#[from] FreeSpaceError),
    /// The nodes can't be placed.
    #[error(transparent)]
    Placement(#[from] NodePlacementError),
    /// All nodes lie in the withheld part.
    #[error("every node lies in the part that learning.withheld = {withheld} keeps from being learned; withhold less")]
    NothingLearned {
        /// The share withheld.
        withheld: f64,
    },
    /// No place is far enough from what is learned.
    #[error(
        "no place lies a walk of {UNLEARNED_WAY_M} m from every learned node, so that nobody can start unlearned; withhold \
         more: learning.withheld"
    )]
    NothingUnlearned,
}

//! A campus: many generated offices, each of a seed of its own, on a lattice far enough apart that none sees another.

use super::{Site, SiteError};
use crate::learning::{self, CalibratedRig, JoinError, MapPart};
use crate::scenario::{Building, Scenario, ScenarioError};
use crate::whole_file;
use crate::world::WireframeWorld;
use crate::world::office::{self, OfficeOptions};
use edgeloc::database::WriteError;
use edgeloc::geometry::Point2;
use rayon::prelude::*;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Buildings stand so far apart, middle to middle, along either axis \[m\].
const PITCH_M: f32 = 40.0;
/// Buildings in a row of the lattice.
const ROW: u32 = 40;

/// Offices of consecutive seeds.
#[derive(Debug, Clone)]
pub struct Campus {
    scenario: Scenario,
    first_seed: u64,
    /// One robot learns all buildings: as it was calibrated in the first.
    robot: Arc<CalibratedRig>,
}

impl Campus {
    /// Offices that the bundled scenario `edgeloc` learns and whose robots it puts down, the first of that seed.
    ///
    /// # Errors
    /// When a setting is illegal, or the first building can't be made ready.
    pub fn new(first_seed: u64, settings: &[String]) -> Result<Self, CampusError> {
        let mut scenario = Scenario::load("edgeloc", settings).map_err(Box::new)?;
        scenario.seed = first_seed;
        let first = Site::prepare(office_of(first_seed), &scenario)?;
        let robot = Arc::new(first.calibrated_rig(&scenario.uncertainty, first_seed, 0));
        Ok(Self { scenario, first_seed, robot })
    }

    /// Nodes of each building.
    #[must_use]
    pub const fn nodes_per_building(&self) -> u32 {
        self.scenario.learning.nodes as u32
    }

    /// The scenario of one building.
    #[must_use]
    pub fn scenario(&self, building: u32) -> Scenario {
        let mut scenario = self.scenario.clone();
        scenario.seed = self.first_seed + u64::from(building);
        scenario.world.building = Building::Office { seed: scenario.seed };
        scenario
    }

    /// Where a building's own origin lies in the world of the campus \[m\].
    #[must_use]
    pub fn origin(&self, building: u32) -> Point2 {
        Point2::new((building % ROW) as f32 * PITCH_M, (building / ROW) as f32 * PITCH_M)
    }

    /// A building made ready for learning and trials, in its own frame.
    ///
    /// # Errors
    /// When its nodes can't be placed.
    pub fn site(&self, building: u32) -> Result<Site, SiteError> {
        let scenario = self.scenario(building);
        let mut site = Site::prepare(office_of(scenario.seed), &scenario)?;
        site.robot = Some(self.robot.clone());
        Ok(site)
    }

    /// The file in `folder` that holds a building's map.
    #[must_use]
    pub fn map_path(&self, folder: &Path, building: u32) -> PathBuf {
        folder.join(format!("office-{}.edgemap", self.first_seed + u64::from(building)))
    }

    /// Learns the first `count` buildings, those whose maps are not in `folder` yet, in parallel; tells `on_building` of each.
    ///
    /// # Errors
    /// When a building can't be learned or a file not be written; those done are kept.
    pub fn learn(&self, folder: &Path, count: u32, on_building: &(dyn Fn() + Sync)) -> Result<(), CampusError> {
        let learn_one = |building: u32| {
            let path = self.map_path(folder, building);
            if !path.exists() {
                let bytes = self.site(building)?.learn_map(&self.scenario(building), 0)?;
                whole_file::write(&path, &bytes).map_err(|error| CampusError::File { path, error })?;
            }
            on_building();
            Ok(())
        };
        // In their order, so that what is learned before a break is the whole of a smaller campus.
        let at_once = 8 * rayon::current_num_threads() as u32;
        (0..count)
            .step_by(at_once as usize)
            .try_for_each(|first| (first..count.min(first + at_once)).into_par_iter().try_for_each(learn_one))
    }
}

impl Campus {
    /// Makes one map of the first `count` buildings, learned before into `folder`, with an index; tells `on_views` of how many
    /// views are done.
    ///
    /// # Errors
    /// When a building's map is missing or the whole can't be written.
    pub fn map(
        &self,
        folder: &Path,
        count: u32,
        output: &Path,
        on_views: &(dyn Fn(usize) + Sync),
    ) -> Result<(), CampusError> {
        let part = |building| MapPart { path: self.map_path(folder, building), origin: self.origin(building) };
        let parts: Vec<MapPart> = (0..count).map(part).collect();
        let plain = output.with_extension("plain");
        learning::join_maps(&parts, &plain, &|| ())?;
        let indexed = learning::index_map(&plain, output, on_views);
        // The error that is reported is the one that mattered.
        let _ = fs::remove_file(&plain);
        Ok(indexed?)
    }

    /// What [`Self::map`] counts to.
    #[must_use]
    pub fn index_steps(&self, count: u32) -> usize {
        (count * self.nodes_per_building()) as usize * usize::from(learning::index_shape().sectors)
    }
}

fn office_of(seed: u64) -> WireframeWorld {
    office::generate(&OfficeOptions { seed, ..OfficeOptions::default() })
}

/// Why a campus can't be learned.
#[derive(Debug, thiserror::Error)]
pub enum CampusError {
    /// A setting is illegal.
    #[error(transparent)]
    Scenario(#[from] Box<ScenarioError>),
    /// A building can't be made ready.
    #[error(transparent)]
    Site(#[from] SiteError),
    /// What was learned does not fit the format.
    #[error("the learned map can't be written: {0}")]
    Write(#[from] WriteError),
    /// The buildings' maps can't be made one.
    #[error(transparent)]
    Join(#[from] JoinError),
    /// A file can't be read or written.
    #[error("{}: {error}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        error: std::io::Error,
    },
}

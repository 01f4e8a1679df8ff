//! One trial again, to be watched: its pose, its map and its images are those of the run.

use super::looks::Looks;
use super::runner::memory_len;
use super::trial::Trial;
use super::{LookEvent, LookImages, RunError, Site, TrialRecord, TruePose, draw_start};
use crate::scenario::Setting;
use edgeloc::database::TopologicalDatabase;

/// A trial of a setting, or a robot put down at a pose of one's own, with the map it has.
#[derive(Debug)]
pub struct Replay<'s> {
    site: &'s Site,
    setting: &'s Setting,
    trial: u32,
    map: u32,
    start: TruePose,
    map_bytes: Vec<u8>,
}

impl<'s> Replay<'s> {
    /// The `trial`-th trial of a setting on a site prepared for its scenario. `start` of `None` draws the trial's own pose:
    /// the record is then the one of the run.
    ///
    /// # Errors
    /// When the map can't be learned, or the setting can't start anywhere.
    pub fn new(site: &'s Site, setting: &'s Setting, trial: u32, start: Option<TruePose>) -> Result<Self, RunError> {
        let scenario = &setting.scenario;
        let map = trial / scenario.trials_per_map;
        let start = match start {
            Some(start) => start,
            None => {
                site.check_start(setting.row.start)?;
                draw_start(site, scenario, setting.row.start, trial)
            }
        };
        let map_bytes = site.learn_map(scenario, map)?;
        Ok(Self { site, setting, trial, map, start, map_bytes })
    }

    /// The map that the robot has.
    ///
    /// # Errors
    /// When it does not open.
    pub fn map(&self) -> Result<TopologicalDatabase<'_>, RunError> {
        Ok(TopologicalDatabase::open(&self.map_bytes)?)
    }

    /// Runs the trial and tells `watch` of every look.
    ///
    /// # Errors
    /// When the map does not open.
    pub fn run(&self, watch: impl FnMut(&LookEvent<'_>)) -> Result<TrialRecord, RunError> {
        let Self { site, setting, trial, map, start, .. } = *self;
        let database = self.map()?;
        let mut memory = vec![0; memory_len(setting, &database)];
        let trial = Trial { site, setting, trial, map, map_bytes: self.map_bytes.len() as u32, start };
        Ok(trial.run(database, &mut memory, &mut self.looks(), watch))
    }

    /// The images of each look again, for the true `poses` from which the robot looked.
    #[must_use]
    pub fn look_images(&self, poses: &[TruePose]) -> Vec<LookImages> {
        let sources = &self.setting.scenario.uncertainty;
        let robot = self.site.calibrated_rig(sources, self.setting.scenario.seed, self.map);
        let mut looks = self.looks();
        let images = |(look, pose): (usize, &TruePose)| {
            LookImages::perturbed(looks.clean(*pose).clone(), sources, &looks.noise_key(look), &robot)
        };
        poses.iter().enumerate().map(images).collect()
    }

    fn looks(&self) -> Looks<'s> {
        Looks::new(self.site, self.setting.scenario.seed, self.trial, self.map)
    }
}

/// Runs one trial again; see [`Replay`].
///
/// # Errors
/// When the map can't be learned.
pub fn replay(
    site: &Site,
    setting: &Setting,
    trial: u32,
    start: Option<TruePose>,
    watch: impl FnMut(&LookEvent<'_>),
) -> Result<TrialRecord, RunError> {
    Replay::new(site, setting, trial, start)?.run(watch)
}

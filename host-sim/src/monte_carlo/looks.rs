//! What the kidnapped robot sees, look after look, with noise. Computed when asked for, once for all rows.

use super::{Site, TruePose};
use crate::camera;
use crate::scenario::Scenario;
use crate::uncertainty::NoiseKey;
use crate::world::ViewpointVisibility;
use edgeloc::geometry::{Heading, Segment2};

/// The looks of one trial: the same for every row that starts the same and turns the same.
#[derive(Debug)]
pub(super) struct Looks<'s> {
    site: &'s Site,
    scenario: &'s Scenario,
    trial: u32,
    visibility: ViewpointVisibility<'s>,
    seen: Vec<(Heading, Vec<Segment2>)>,
}

impl<'s> Looks<'s> {
    pub(super) fn new(site: &'s Site, scenario: &'s Scenario, trial: u32, start: TruePose) -> Self {
        Self { site, scenario, trial, visibility: site.viewpoint(start.position), seen: Vec::new() }
    }

    /// The scene of the `look`-th look, from 0, with the optical axis along `heading`.
    pub(super) fn scene(&mut self, look: usize, heading: Heading) -> &[Segment2] {
        let is_known = self.seen.get(look).is_some_and(|(known, _)| *known == heading);
        if !is_known {
            self.seen.truncate(look);
            let scene = self.take(look, heading);
            self.seen.push((heading, scene));
        }
        &self.seen[look].1
    }

    fn take(&mut self, look: usize, heading: Heading) -> Vec<Segment2> {
        let mut observation = camera::observe(&self.site.rig, &mut self.visibility, heading);
        let key = NoiseKey::look(self.scenario.seed, u64::from(self.trial), look as u32);
        self.scenario.uncertainty.apply(&mut observation, &key);
        camera::left_segments(&observation)
    }
}

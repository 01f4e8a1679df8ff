//! What the kidnapped robot sees, look after look, with noise. Computed when asked for, once for all rows.

use super::{Site, TruePose};
use crate::camera::{self, StereoObservation};
use crate::uncertainty::{NoiseKey, Sources};
use crate::world::ViewpointVisibility;
use edgeloc::geometry::{Heading, Segment2};
use edgeloc::localize::HeadingPrior;

/// The looks of one trial from one pose: the same for every row that turns the same through the same sources.
///
/// Rows that turn differently share what is visible from the pose; rows with other sources share the clean images too.
#[derive(Debug)]
pub(super) struct Looks<'s> {
    site: &'s Site,
    seed: u64,
    trial: u32,
    map: u32,
    visibility: ViewpointVisibility<'s>,
    clean: Vec<(Heading, StereoObservation)>,
    scenes: Vec<SeenScene<'s>>,
}

/// The scene of one look.
#[derive(Debug)]
struct SeenScene<'s> {
    look: usize,
    heading: Heading,
    sources: &'s Sources,
    segments: Vec<Segment2>,
}

impl<'s> Looks<'s> {
    pub(super) fn new(site: &'s Site, seed: u64, trial: u32, map: u32, start: TruePose) -> Self {
        let visibility = site.viewpoint(start.position);
        Self { site, seed, trial, map, visibility, clean: Vec::new(), scenes: Vec::new() }
    }

    /// The scene of the `look`-th look, from 0, with the optical axis along `heading`, through `sources`.
    pub(super) fn scene(&mut self, look: usize, heading: Heading, sources: &'s Sources) -> &[Segment2] {
        let is_asked = |seen: &SeenScene<'_>| seen.look == look && seen.heading == heading && seen.sources == sources;
        let index = self.scenes.iter().position(is_asked).unwrap_or_else(|| {
            let segments = self.take(look, heading, sources);
            self.scenes.push(SeenScene { look, heading, sources, segments });
            self.scenes.len() - 1
        });
        &self.scenes[index].segments
    }

    /// What the compass tells in the `look`-th look, from 0, with the optical axis along `heading`.
    pub(super) fn compass_reading(&self, look: usize, heading: Heading, sources: &Sources) -> Option<HeadingPrior> {
        sources.compass_reading(heading, &self.noise_key(look))
    }

    fn take(&mut self, look: usize, heading: Heading, sources: &Sources) -> Vec<Segment2> {
        let mut observation = self.clean(heading).clone();
        sources.apply(&mut observation, &self.noise_key(look));
        self.site.calibrated_rig(sources, self.seed, self.map).rectify(&mut observation);
        camera::left_segments(&observation)
    }

    /// Both images without noise, with the optical axis along `heading`.
    pub(super) fn clean(&mut self, heading: Heading) -> &StereoObservation {
        let known = self.clean.iter().position(|(known, _)| *known == heading);
        let index = known.unwrap_or_else(|| {
            let observation = camera::observe(&self.site.rig, &mut self.visibility, heading);
            self.clean.push((heading, observation));
            self.clean.len() - 1
        });
        &self.clean[index].1
    }

    /// Which draw of the noise the `look`-th look, from 0, has.
    pub(super) fn noise_key(&self, look: usize) -> NoiseKey {
        NoiseKey::look(self.seed, u64::from(self.trial), look as u32)
    }
}

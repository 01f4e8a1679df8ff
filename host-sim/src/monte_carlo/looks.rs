//! What the kidnapped robot sees, look after look, with noise. Computed when asked for, once for all rows.

use super::{Site, TruePose};
use crate::camera::{self, StereoObservation};
use crate::uncertainty::{NoiseKey, Sources};
use crate::world::ViewpointVisibility;
use edgeloc::geometry::{Angle, Heading, Point2, Segment2};
use edgeloc::localize::{HeadingPrior, Motion};

/// The looks of one trial: the same for every row that turns and moves the same through the same sources.
///
/// Rows that turn differently share what is visible from the pose; rows with other sources share the clean images too.
#[derive(Debug)]
pub(super) struct Looks<'s> {
    site: &'s Site,
    seed: u64,
    trial: u32,
    map: u32,
    places: Vec<Place<'s>>,
    scenes: Vec<SeenScene<'s>>,
}

/// Where the robot looks around from.
#[derive(Debug)]
struct Place<'s> {
    position: Point2,
    visibility: ViewpointVisibility<'s>,
    clean: Vec<(Heading, StereoObservation)>,
}

/// The scene of one look.
#[derive(Debug)]
struct SeenScene<'s> {
    look: usize,
    pose: TruePose,
    sources: &'s Sources,
    segments: Vec<Segment2>,
}

impl<'s> Looks<'s> {
    pub(super) const fn new(site: &'s Site, seed: u64, trial: u32, map: u32) -> Self {
        Self { site, seed, trial, map, places: Vec::new(), scenes: Vec::new() }
    }

    /// The scene of the `look`-th look, from 0, from `pose`, through `sources`.
    pub(super) fn scene(&mut self, look: usize, pose: TruePose, sources: &'s Sources) -> &[Segment2] {
        let is_asked = |seen: &SeenScene<'_>| seen.look == look && seen.pose == pose && seen.sources == sources;
        let index = self.scenes.iter().position(is_asked).unwrap_or_else(|| {
            let segments = self.take(look, pose, sources);
            self.scenes.push(SeenScene { look, pose, sources, segments });
            self.scenes.len() - 1
        });
        &self.scenes[index].segments
    }

    /// What the compass tells in the `look`-th look, from 0, with the optical axis along `heading`.
    pub(super) fn compass_reading(&self, look: usize, heading: Heading, sources: &Sources) -> Option<HeadingPrior> {
        sources.compass_reading(heading, &self.noise_key(look))
    }

    /// What odometry tells in the `look`-th look, from 0, of a turn and a way straight ahead after it \[m\].
    pub(super) fn odometry_reading(&self, look: usize, turn: Angle, ahead_m: f32, sources: &Sources) -> Option<Motion> {
        sources.odometry_reading(turn, ahead_m, &self.noise_key(look))
    }

    fn take(&mut self, look: usize, pose: TruePose, sources: &Sources) -> Vec<Segment2> {
        let mut observation = self.clean(pose).clone();
        sources.apply(&mut observation, &self.noise_key(look));
        self.site.calibrated_rig(sources, self.seed, self.map).rectify(&mut observation);
        camera::left_segments(&observation)
    }

    /// Both images without noise, from `pose`.
    pub(super) fn clean(&mut self, pose: TruePose) -> &StereoObservation {
        let TruePose { position, heading } = pose;
        let known = self.places.iter().position(|place| place.position == position);
        let index = known.unwrap_or_else(|| {
            let visibility = self.site.viewpoint(position);
            self.places.push(Place { position, visibility, clean: Vec::new() });
            self.places.len() - 1
        });
        let Place { visibility, clean, .. } = &mut self.places[index];
        let known = clean.iter().position(|(known, _)| *known == heading);
        let index = known.unwrap_or_else(|| {
            clean.push((heading, camera::observe(&self.site.rig, visibility, heading)));
            clean.len() - 1
        });
        &clean[index].1
    }

    /// Which draw of the noise the `look`-th look, from 0, has.
    pub(super) fn noise_key(&self, look: usize) -> NoiseKey {
        NoiseKey::look(self.seed, u64::from(self.trial), look as u32)
    }
}

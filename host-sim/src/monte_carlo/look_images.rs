//! What happened to the images of a look on their way to the localiser: for those who want to see a trial whole.

use crate::camera::{StereoFeature, StereoObservation};
use crate::learning::CalibratedRig;
use crate::uncertainty::{NoiseKey, SourceSetting, Sources, UncertaintySource};
use edgeloc::geometry::Segment2;
use serde::Serialize;

/// Both images of a look, before and after the uncertainty sources.
#[derive(Debug)]
pub struct LookImages {
    /// What is visible.
    pub clean: StereoObservation,
    /// What the robot works with, rectified by what it knows of its cameras.
    pub perturbed: StereoObservation,
    /// What each source that acted has drawn, in the order of the pipeline.
    pub effects: Vec<SourceEffect>,
}

/// What the draws of one source did to one look.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SourceEffect {
    /// Name of the source's table in a scenario.
    pub source: &'static str,
    /// Its magnitude.
    pub magnitude: f64,
    /// Unit of the magnitude.
    pub unit: &'static str,
    /// Features seen in the look after it.
    pub features: usize,
    /// Features that it changed, and that are still there.
    pub changed_features: usize,
    /// Features of which it left nothing in either image.
    pub removed_features: usize,
    /// Features without an original: seen where there was none, or in place of one that it removed.
    pub added_features: usize,
    /// Pieces in both images before and after it.
    pub pieces: [usize; 2],
    /// Length of all pieces in both images before and after it in pixels.
    pub length_px: [f64; 2],
    /// Root mean square displacement of the end points it moved in pixels; pieces that it cut or added do not count.
    pub rms_shift_px: f64,
    /// Greatest of these displacements in pixels.
    pub greatest_shift_px: f64,
    /// Pieces whose contrast polarity it flipped.
    pub flipped_pieces: usize,
    /// Features to which it denied a stereo match.
    pub unmatched_features: usize,
}

impl LookImages {
    /// What is left of clean images after the sources, as a robot that knows its rig so sees them.
    pub(super) fn perturbed(
        clean: StereoObservation,
        sources: &Sources,
        key: &NoiseKey,
        robot: &CalibratedRig,
    ) -> Self {
        let (mut perturbed, mut before, mut effects) = (clean.clone(), clean.clone(), Vec::new());
        sources.apply_watched(&mut perturbed, key, |source, after| {
            effects.push(SourceEffect::of(source, &before, after));
            before.clone_from(after);
        });
        robot.rectify(&mut perturbed);
        // The compass tells a heading and touches no image; wrong cameras show when the robot rectifies.
        effects.retain(|effect| effect.source != sources.compass.facts().key);
        let calibration: &dyn UncertaintySource = &sources.camera_calibration;
        if let Some(effect) = effects.iter_mut().find(|effect| effect.source == calibration.facts().key) {
            *effect = SourceEffect::of(calibration, &before, &perturbed);
        }
        Self { clean, perturbed, effects }
    }
}

impl SourceEffect {
    fn of(source: &dyn UncertaintySource, before: &StereoObservation, after: &StereoObservation) -> Self {
        let facts = source.facts();
        let mut effect = Self {
            source: facts.key,
            magnitude: source.magnitude(),
            unit: facts.unit,
            features: after.features.iter().filter(|feature| is_seen(feature)).count(),
            changed_features: 0,
            removed_features: 0,
            added_features: after.features.iter().skip(before.features.len()).count(),
            pieces: [before, after].map(|images| pieces(images).count()),
            length_px: [before, after].map(|images| pieces(images).map(|piece| f64::from(piece.length_px())).sum()),
            rms_shift_px: 0.0,
            greatest_shift_px: 0.0,
            flipped_pieces: 0,
            unmatched_features: 0,
        };
        let mut shifts = Shifts::default();
        let pairs = before.features.iter().zip(&after.features);
        for (old, new) in pairs.filter(|(old, new)| old != new) {
            if source.replaces_features() || !is_seen(old) || !is_seen(new) {
                effect.removed_features += usize::from(is_seen(old));
                effect.added_features += usize::from(is_seen(new));
                continue;
            }
            effect.changed_features += 1;
            effect.unmatched_features += usize::from(old.is_matchable && !new.is_matchable);
            let images = [(&old.left, &new.left), (&old.right, &new.right)];
            for (old, new) in images.into_iter().filter(|(old, new)| old.len() == new.len()) {
                for (old, new) in old.iter().zip(new) {
                    effect.flipped_pieces += usize::from(old.polarity() != new.polarity());
                    shifts.add(old.start().distance(new.start()));
                    shifts.add(old.end().distance(new.end()));
                }
            }
        }
        (effect.rms_shift_px, effect.greatest_shift_px) = (shifts.rms_px(), shifts.greatest_px);
        effect
    }
}

/// Displacements of end points, those that did not move left out.
#[derive(Debug, Default)]
struct Shifts {
    squares: f64,
    count: u32,
    greatest_px: f64,
}

impl Shifts {
    fn add(&mut self, shift_px: f32) {
        let shift_px = f64::from(shift_px);
        if shift_px > 0.0 {
            self.squares += shift_px * shift_px;
            self.count += 1;
            self.greatest_px = self.greatest_px.max(shift_px);
        }
    }

    fn rms_px(&self) -> f64 {
        (self.squares / f64::from(self.count.max(1))).sqrt()
    }
}

/// Whether either image shows anything of a feature.
fn is_seen(feature: &StereoFeature) -> bool {
    !(feature.left.is_empty() && feature.right.is_empty())
}

/// All pieces in both images.
fn pieces(observation: &StereoObservation) -> impl Iterator<Item = &Segment2> {
    observation.features.iter().flat_map(|feature| feature.left.iter().chain(&feature.right))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;
    use crate::uncertainty::{Clutter, PolarityFlips};
    use edgeloc::geometry::{Point2, Polarity, StereoRig};

    fn posts(count: u16) -> StereoObservation {
        let post = |x: f32| {
            let ends = (Point2::new(x, 100.0), Point2::new(x, 300.0));
            vec![Segment2::new(ends.0, ends.1, Polarity::LeftBrighter).expect("a segment")]
        };
        let feature = |index: u16| {
            let x = 20.0 + f32::from(index);
            StereoFeature { left: post(x), right: post(x - 10.0), is_matchable: true }
        };
        StereoObservation { rig: StereoRig::reference(), features: (0..count).map(feature).collect() }
    }

    fn effect(source: &dyn UncertaintySource, before: &StereoObservation) -> SourceEffect {
        let mut after = before.clone();
        source.apply(&mut after, &mut Stream::new(1, "effect", 0, 0));
        SourceEffect::of(source, before, &after)
    }

    #[test]
    fn what_clutter_puts_in_place_of_a_feature_is_added_and_not_the_same_feature_moved() {
        let effect = effect(&Clutter { enabled: true, magnitude: 0.5 }, &posts(200));
        assert!(effect.added_features > 50 && effect.added_features == effect.removed_features, "{effect:?}");
        assert_eq!((effect.changed_features, effect.flipped_pieces, effect.unmatched_features), (0, 0, 0));
        assert!(effect.rms_shift_px.abs() + effect.greatest_shift_px.abs() < 1e-9, "{effect:?}");
    }

    #[test]
    fn a_feature_that_is_flipped_is_changed_and_a_feature_that_vanishes_is_removed() {
        let flipped = effect(&PolarityFlips { enabled: true, magnitude: 1.0 }, &posts(5));
        assert_eq!((flipped.changed_features, flipped.flipped_pieces), (5, 10));
        assert_eq!((flipped.added_features, flipped.removed_features, flipped.features), (0, 0, 5));

        let (before, mut after) = (posts(5), posts(5));
        after.features[3].left.clear();
        after.features[3].right.clear();
        let lost = SourceEffect::of(&PolarityFlips::default(), &before, &after);
        assert_eq!((lost.changed_features, lost.removed_features, lost.features), (0, 1, 4));
    }

    #[test]
    fn wrong_cameras_show_where_the_robot_rectifies_and_the_compass_touches_no_image() {
        let rig = StereoRig::reference();
        let mut parameters = edgeloc::stereo::StereoParameters::ideal(&rig);
        parameters.left.principal_point_px[0] += 3.0;
        let robot = CalibratedRig::believed(rig, &parameters).expect("side by side");
        let mut sources = Sources::none();
        (sources.camera_calibration.enabled, sources.compass.enabled) = (true, true);
        let images = LookImages::perturbed(posts(4), &sources, &NoiseKey::look(1, 0, 0), &robot);
        assert_eq!(images.effects.iter().map(|effect| effect.source).collect::<Vec<_>>(), ["camera_calibration"]);
        assert!(images.effects[0].greatest_shift_px > 1.0 && images.effects[0].changed_features == 4);
    }
}

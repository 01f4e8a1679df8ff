//! What happened to the images of a look on their way to the localiser: for those who want to see a trial whole.

use crate::camera::StereoObservation;
use crate::learning::CalibratedRig;
use crate::uncertainty::{NoiseKey, Sources, UncertaintySource};
use edgeloc::geometry::{Point2, Segment2};
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
    /// Features in the look after it.
    pub features: usize,
    /// Features that it changed or added.
    pub changed_features: usize,
    /// Pieces in both images before and after it.
    pub pieces: [usize; 2],
    /// Length of all pieces in both images before and after it in pixels.
    pub length_px: [f64; 2],
    /// Root mean square displacement of the end points it moved in pixels; pieces that it cut do not count.
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
        Self { clean, perturbed, effects }
    }
}

impl SourceEffect {
    fn of(source: &dyn UncertaintySource, before: &StereoObservation, after: &StereoObservation) -> Self {
        let facts = source.facts();
        let added = after.features.len().saturating_sub(before.features.len());
        let pairs = || before.features.iter().zip(&after.features);
        let mut effect = Self {
            source: facts.key,
            magnitude: source.magnitude(),
            unit: facts.unit,
            features: after.features.len(),
            changed_features: added + pairs().filter(|(before, after)| before != after).count(),
            pieces: [before, after].map(|images| pieces(images).count()),
            length_px: [before, after].map(|images| pieces(images).map(|piece| f64::from(piece.length_px())).sum()),
            rms_shift_px: 0.0,
            greatest_shift_px: 0.0,
            flipped_pieces: 0,
            unmatched_features: pairs().filter(|(before, after)| before.is_matchable && !after.is_matchable).count(),
        };
        let (mut squares, mut moved_ends) = (0.0, 0_u32);
        let images = pairs().flat_map(|(before, after)| [(&before.left, &after.left), (&before.right, &after.right)]);
        let uncut = images.filter(|(before, after)| before.len() == after.len());
        for (before, after) in uncut.flat_map(|(before, after)| before.iter().zip(after)) {
            effect.flipped_pieces += usize::from(before.polarity() != after.polarity());
            for (from, to) in [(before.start(), after.start()), (before.end(), after.end())] {
                let shift_px = f64::from(Point2::distance(from, to));
                if shift_px > 0.0 {
                    squares += shift_px * shift_px;
                    moved_ends += 1;
                    effect.greatest_shift_px = effect.greatest_shift_px.max(shift_px);
                }
            }
        }
        effect.rms_shift_px = (squares / f64::from(moved_ends.max(1))).sqrt();
        effect
    }
}

/// All pieces in both images.
fn pieces(observation: &StereoObservation) -> impl Iterator<Item = &Segment2> {
    observation.features.iter().flat_map(|feature| feature.left.iter().chain(&feature.right))
}

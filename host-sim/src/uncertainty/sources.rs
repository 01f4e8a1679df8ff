//! The configured sources: which act, how strongly, in which order, on which random draws.
//!
//! In a scenario file each source is a table of its own; what is not said stays at its default:
//!
//! ```toml
//! [uncertainty]
//! lateral_edge_shift = { enabled = true, magnitude = 3.0, is_common = true }
//! edge_detection_loss = { magnitude = 0.3125 }
//! stereo_match = { enabled = false }
//! polarity_flips = { enabled = true }
//! ```

use super::{
    ActsIn, CameraCalibration, CameraTilt, Clutter, Compass, CornerDetectionLoss, CornerMatch, EdgeDetectionLoss,
    EpipolarRemoval, GeometricApproximation, ImageNoise, LateralEdgeShift, Occlusion, Odometry, PolarityFlips,
    SourceFacts, SourceNumber, SourceSetting, StereoMatch, UncertaintySource,
};
use crate::camera::StereoObservation;
use crate::random::Stream;
use edgeloc::geometry::{Angle, Heading};
use edgeloc::localize::{HeadingPrior, Motion};
use serde::{Deserialize, Serialize};

macro_rules! list_of_sources {
    ($($key:ident: $source:ident,)*) => {
        /// The uncertainty sources in the order in which they act; by default the paper's at its magnitudes.
        #[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
        #[serde(try_from = "UncheckedSources")]
        pub struct Sources {
            $(
                #[doc = concat!("See [`", stringify!($source), "`].")]
                pub $key: $source,
            )*
        }

        /// The sources as read, before their magnitudes are checked.
        #[derive(Default, Deserialize)]
        #[serde(deny_unknown_fields, default, rename = "Sources")]
        struct UncheckedSources {
            $($key: $source,)*
        }

        impl TryFrom<UncheckedSources> for Sources {
            type Error = SourceError;

            fn try_from(read: UncheckedSources) -> Result<Self, SourceError> {
                Self { $($key: read.$key,)* }.checked()
            }
        }

        impl Sources {
            /// No source acts.
            #[must_use]
            pub fn none() -> Self {
                Self { $($key: $source { enabled: false, ..$source::default() },)* }
            }

            /// Every source, enabled or not, in the order in which they act.
            #[must_use]
            pub fn pipeline(&self) -> Vec<&dyn UncertaintySource> {
                vec![$(&self.$key,)*]
            }
        }
    };
}

list_of_sources! {
    clutter: Clutter,
    occlusion: Occlusion,
    camera_tilt: CameraTilt,
    polarity_flips: PolarityFlips,
    lateral_edge_shift: LateralEdgeShift,
    edge_detection_loss: EdgeDetectionLoss,
    geometric_approximation: GeometricApproximation,
    image_noise: ImageNoise,
    epipolar_removal: EpipolarRemoval,
    stereo_match: StereoMatch,
    corner_detection_loss: CornerDetectionLoss,
    corner_match: CornerMatch,
    camera_calibration: CameraCalibration,
    compass: Compass,
    odometry: Odometry,
}

impl Sources {
    /// Perturbs an observation by every enabled source in turn, each with its own draws.
    pub fn apply(&self, observation: &mut StereoObservation, key: &NoiseKey) {
        self.apply_watched(observation, key, |_, _| {});
    }

    /// Like [`Self::apply`], and tells `watch` after each source that acted what it left.
    pub fn apply_watched(
        &self,
        observation: &mut StereoObservation,
        key: &NoiseKey,
        mut watch: impl FnMut(&dyn UncertaintySource, &StereoObservation),
    ) {
        for source in self.pipeline() {
            if source.is_enabled() && key.is_of(source.facts().acts_in) {
                source.apply(observation, &mut key.stream(source.facts()));
                watch(source, observation);
            }
        }
    }

    /// What the compass tells of a heading in the look of `key`; exact when its error is off, `None` without a compass.
    #[must_use]
    pub fn compass_reading(&self, heading: Heading, key: &NoiseKey) -> Option<HeadingPrior> {
        if !self.compass.available {
            return None;
        }
        if !self.compass.enabled {
            return Some(HeadingPrior::exact(heading));
        }
        let facts = self.compass.facts();
        Some(self.compass.read(heading, &mut key.of_trial().stream(facts), &mut key.stream(facts)))
    }

    /// What odometry tells in the look of `key` of a turn and a way straight ahead after it \[m\]; exact when its error is
    /// off, `None` without odometry.
    #[must_use]
    pub fn odometry_reading(&self, turn: Angle, ahead_m: f32, key: &NoiseKey) -> Option<Motion> {
        if !self.odometry.available {
            return None;
        }
        if !self.odometry.enabled {
            return Some(Motion::exact(turn, ahead_m));
        }
        Some(self.odometry.read(turn, ahead_m, &mut key.stream(self.odometry.facts())))
    }

    /// The sources themselves, if every magnitude and every other number is legal.
    ///
    /// # Errors
    /// When a number, even of a disabled source, is none or outside its legal range.
    pub fn checked(self) -> Result<Self, SourceError> {
        for source in self.pipeline() {
            for number in source.numbers() {
                let (low, high) = number.legal_range;
                if !(low..=high).contains(&number.value) {
                    return Err(SourceError { facts: source.facts(), number });
                }
            }
        }
        Ok(self)
    }
}

/// A number of a source is outside its legal range.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "{key}.{number} = {value} is not legal: {name} takes {low} to {high}{unit} (default {default}); \
     to switch it off write {key}.enabled = false",
    key = facts.key, number = number.key, value = number.value, name = facts.name, default = number.default,
    low = number.legal_range.0, high = number.legal_range.1, unit = self.unit()
)]
pub struct SourceError {
    /// The source.
    pub facts: &'static SourceFacts,
    /// The number asked for.
    pub number: SourceNumber,
}

impl SourceError {
    /// The unit of the number after a space; a magnitude has that of its source, others have it in their name.
    #[must_use]
    pub fn unit(&self) -> String {
        if self.number.key == "magnitude" { format!(" {}", self.facts.unit) } else { String::new() }
    }
}

/// Which draw of the noise: one look of one trial, one view of one map, one view of a calibration, or one robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoiseKey {
    seed: u64,
    purpose: &'static str,
    index: u64,
    part: u64,
}

impl NoiseKey {
    const LOOK: &str = "psi-look";
    const VIEW: &str = "psi-view";
    const TRIAL: &str = "psi-all";
    const CORNERS: &str = "psi-crnr";
    const ROBOT: &str = "psi-robo";

    /// The noise of one look of a trial, looks counted from 0. Trials of one index share it wherever they start, as
    /// common random numbers.
    #[must_use]
    pub const fn look(seed: u64, trial: u64, look: u32) -> Self {
        Self { seed, purpose: Self::LOOK, index: trial, part: look as u64 }
    }

    /// The noise of one learned view, in one of the maps of a run.
    #[must_use]
    pub const fn view(seed: u64, map_index: u64, node_index: u32, view_index: u16) -> Self {
        Self { seed, purpose: Self::VIEW, index: map_index, part: (node_index as u64) << 16 | view_index as u64 }
    }

    /// The key of what is drawn once for all looks of this look's trial.
    const fn of_trial(&self) -> Self {
        Self { seed: self.seed, purpose: Self::TRIAL, index: self.index, part: 0 }
    }

    /// The noise of one view of a calibration.
    pub(super) const fn corners(seed: u64, view_index: u64) -> Self {
        Self { seed, purpose: Self::CORNERS, index: view_index, part: 0 }
    }

    /// The robot that learns and uses one of the maps of a run.
    pub(super) const fn robot(seed: u64, map_index: u64) -> Self {
        Self { seed, purpose: Self::ROBOT, index: map_index, part: 0 }
    }

    fn is_of(&self, acts_in: ActsIn) -> bool {
        match acts_in {
            ActsIn::Learning => self.purpose == Self::VIEW,
            ActsIn::Calibration => self.purpose == Self::CORNERS,
            ActsIn::Looks => self.purpose == Self::LOOK,
            ActsIn::Both => true,
        }
    }

    pub(super) fn stream(&self, facts: &SourceFacts) -> Stream {
        // A part has at most 48 bits, a stream's number 16, so that no two sources, looks or views share a stream.
        Stream::new(self.seed, self.purpose, self.index, self.part << 16 | u64::from(facts.stream_id))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::StereoFeature;
    use crate::uncertainty::test_observation::{corners, observation};
    use edgeloc::geometry::{Polarity, Segment2};

    const KEY: NoiseKey = NoiseKey::view(9, 4, 0, 0);

    fn applied(sources: &Sources) -> StereoObservation {
        let mut observation = observation(300);
        sources.apply(&mut observation, &KEY);
        observation
    }

    #[test]
    fn no_source_changes_nothing() {
        assert_eq!(applied(&Sources::none()), observation(300));
    }

    /// Nothing but the source called `key`, on, with `magnitude` or its default one.
    fn alone(key: &str, magnitude: Option<f64>) -> Sources {
        let mut table = toml::Table::try_from(Sources::none()).expect("sources are a table of tables");
        let source = table[key].as_table_mut().expect("a source is a table");
        source.insert("enabled".to_owned(), true.into());
        if let Some(magnitude) = magnitude {
            source.insert("magnitude".to_owned(), magnitude.into());
        }
        table.try_into().expect("legal sources")
    }

    /// Those of both, first and second alike.
    fn together(first: &Sources, second: &Sources) -> Sources {
        let read = |sources: &Sources| toml::Table::try_from(sources).expect("sources are a table of tables");
        let mut table = read(first);
        let is_on = |source: &toml::Value| source["enabled"].as_bool() == Some(true);
        table.extend(read(second).into_iter().filter(|(_, source)| is_on(source)));
        table.try_into().expect("legal sources")
    }

    /// What the sources leave of a view, of a look, of the corners of a calibration, of a heading, of a motion and of a
    /// robot.
    fn effects(sources: &Sources) -> impl PartialEq + use<> {
        let (look_key, mut look, mut corners) = (NoiseKey::look(9, 4, 0), observation(300), corners(300));
        sources.apply(&mut look, &look_key);
        sources.perturb_corners(&mut corners, 9, 0);
        let reading = sources.compass_reading(Heading::default(), &look_key);
        let motion = sources.odometry_reading(Angle::from_degrees(60.0), 1.0, &look_key).map(|motion| motion.step_m);
        (applied(sources), look, corners, reading, motion, sources.camera_calibration.acts())
    }

    #[test]
    fn every_source_acts_and_at_magnitude_zero_it_is_the_identity() {
        let nothing = effects(&Sources::none());
        for source in Sources::none().pipeline() {
            let SourceFacts { key, legal_range, .. } = source.facts();
            assert!(effects(&alone(key, Some(0.0))) == nothing, "{key} acts at magnitude 0");
            assert!(effects(&alone(key, Some(legal_range.1))) != nothing, "{key} does not act");
        }
    }

    #[test]
    fn switching_any_source_off_leaves_the_draws_of_the_others() {
        // The draws of a flip, a false match, a whole loss and clutter can be seen whatever else was done to a feature.
        let look = NoiseKey::look(9, 4, 0);
        let marks = |sources: &Sources, key: &str| {
            let noise = if key == "stereo_match" { KEY } else { look };
            let mut observation = observation(300);
            sources.apply(&mut observation, &noise);
            let mark = |feature: &StereoFeature| match (key, &feature.left[..]) {
                ("polarity_flips", [piece, ..]) => Some(piece.polarity() == Polarity::RightBrighter),
                ("clutter", _) => Some(!feature.is_matchable),
                ("edge_detection_loss", pieces) => Some(pieces.is_empty()),
                ("stereo_match", [left, ..]) => {
                    // Other sources move end points by far less than most of these matches.
                    feature.right.first().map(|right| (left.start().x - right.start().x - 20.0).abs() > 6.0)
                }
                _ => None,
            };
            observation.features.iter().map(mark).collect::<Vec<_>>()
        };
        for (key, others) in [
            ("polarity_flips", &["lateral_edge_shift", "geometric_approximation", "edge_detection_loss"][..]),
            ("clutter", &["camera_tilt", "polarity_flips", "lateral_edge_shift", "edge_detection_loss", "image_noise"]),
            ("edge_detection_loss", &["clutter", "polarity_flips", "lateral_edge_shift", "geometric_approximation"]),
            ("stereo_match", &["lateral_edge_shift", "geometric_approximation", "epipolar_removal"]),
        ] {
            let only = alone(key, None);
            let expected = marks(&only, key);
            assert!(expected.contains(&Some(true)) && expected.contains(&Some(false)), "{key}");
            for other in others {
                let found = marks(&together(&only, &alone(other, None)), key);
                let differ = expected.iter().zip(&found).filter(|(a, b)| b.is_some() && a != b).count();
                assert_eq!(differ, 0, "{key} with {other}");
            }
        }
    }

    #[test]
    fn a_feature_broken_by_gaps_leaves_the_draws_of_the_next() {
        // With gaps there are more end points to misplace; the first of each feature is misplaced all the same.
        let (misplaced, gaps) = (alone("geometric_approximation", None), alone("edge_detection_loss", None));
        let before = observation(300);
        let (without, with) = (applied(&misplaced), applied(&together(&misplaced, &gaps)));
        let only_gaps = applied(&gaps);
        let mut compared = 0;
        for index in 0..300 {
            let start = |observation: &StereoObservation| observation.features[index].left.first().map(Segment2::start);
            if let (Some(broken), Some(found)) = (start(&only_gaps), start(&with)) {
                let (clean, moved) = (start(&before).expect("seen"), start(&without).expect("seen"));
                let (dx, dy) = (moved.x - clean.x, moved.y - clean.y);
                assert!((found.x - broken.x - dx).abs() < 1e-3 && (found.y - broken.y - dy).abs() < 1e-3);
                compared += 1;
            }
        }
        assert!(compared > 250);
    }

    #[test]
    fn a_source_of_learning_leaves_a_look_alone() {
        let sources = Sources { stereo_match: StereoMatch { enabled: true, magnitude: 0.1 }, ..Sources::none() };
        let mut look = observation(300);
        sources.apply(&mut look, &NoiseKey::look(9, 4, 0));
        assert_eq!(look, observation(300));
        assert_ne!(applied(&sources), look);
    }

    #[test]
    fn every_source_has_its_own_stream_and_key_and_a_legal_default() {
        let sources = Sources::default();
        let facts: Vec<_> = sources.pipeline().iter().map(|source| source.facts()).collect();
        for (index, one) in facts.iter().enumerate() {
            assert!(facts[..index].iter().all(|other| other.stream_id != one.stream_id && other.key != one.key));
        }
        assert_eq!(sources.clone().checked(), Ok(sources));
    }

    #[test]
    fn the_key_of_each_source_is_the_name_of_its_table() {
        let text = toml::to_string(&Sources::default()).expect("sources are a table of tables");
        let table: toml::Table = text.parse().expect("what was just written");
        for source in Sources::none().pipeline() {
            assert!(table.contains_key(source.facts().key), "{}", source.facts().key);
        }
        assert_eq!(table.len(), Sources::none().pipeline().len());
    }

    #[test]
    fn draws_differ_between_looks_trials_views_and_seeds() {
        let first = |key: NoiseKey| key.stream(StereoMatch::default().facts()).unit().to_bits();
        let keys = [
            NoiseKey::look(9, 4, 0),
            NoiseKey::look(9, 4, 1),
            NoiseKey::look(9, 5, 0),
            NoiseKey::look(8, 4, 0),
            KEY,
            NoiseKey::view(9, 4, 0, 1),
            NoiseKey::view(9, 4, 1, 0),
        ];
        for (index, key) in keys.iter().enumerate() {
            assert!(keys[..index].iter().all(|other| first(*other) != first(*key)), "{key:?}");
        }
    }

    #[test]
    fn what_a_file_leaves_out_stays_at_the_papers_default() {
        let read: Sources = toml::from_str(
            "edge_detection_loss = { magnitude = 0.25 }\nstereo_match = { enabled = false }\n\
             lateral_edge_shift = { magnitude = 2, is_common = false }",
        )
        .expect("legal sources");
        let expected = Sources {
            edge_detection_loss: EdgeDetectionLoss { magnitude: 0.25, ..EdgeDetectionLoss::default() },
            stereo_match: StereoMatch { enabled: false, magnitude: 0.01 },
            lateral_edge_shift: LateralEdgeShift { enabled: true, magnitude: 2.0, is_common: false },
            ..Sources::default()
        };
        assert_eq!(read, expected);
        assert_eq!(toml::from_str::<Sources>("").expect("all defaults"), Sources::default());
    }

    #[test]
    fn errors_name_the_key_the_value_and_the_legal_range() {
        let error_of = |text: &str| toml::from_str::<Sources>(text).expect_err("illegal").to_string();
        let message = error_of("edge_detection_loss = { magnitude = 0.5 }");
        for part in ["edge_detection_loss.magnitude", "0.5", "0 to 0.3125", "0.1125"] {
            assert!(message.contains(part), "{part} in {message}");
        }
        assert!(error_of("stereo_match = { magnitude = nan }").contains("stereo_match.magnitude = NaN"));
        assert!(error_of("stereo_match = { magnitude = -0.01 }").contains("stereo_match"));
        assert!(error_of("stereo_mismatch = { enabled = true }").contains("stereo_mismatch"));
        assert!(error_of("stereo_match = { magnitud = 0.01 }").contains("magnitud"));
        assert!(error_of("compass = { bias_share = 1.5 }").contains("compass.bias_share = 1.5 is not legal"));
    }
}

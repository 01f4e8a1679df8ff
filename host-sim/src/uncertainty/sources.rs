//! The configured sources: which act, how strongly, in which order, on which random draws.
//!
//! In a scenario file each source is a table of its own; what is not said stays at the paper's default:
//!
//! ```toml
//! [uncertainty]
//! lateral_edge_shift = { enabled = true, magnitude = 3.0, is_common = true }
//! edge_detection_loss = { magnitude = 0.3125 }
//! stereo_match = { enabled = false }
//! ```

use super::{
    ActsIn, EdgeDetectionLoss, EpipolarRemoval, GeometricApproximation, LateralEdgeShift, SourceFacts, StereoMatch,
    UncertaintySource,
};
use crate::camera::StereoObservation;
use crate::random::Stream;
use serde::{Deserialize, Serialize};

macro_rules! list_of_sources {
    ($($key:ident: $source:ident,)*) => {
        /// The uncertainty sources in the order in which they act; by default all of the paper's at its magnitudes.
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
    lateral_edge_shift: LateralEdgeShift,
    edge_detection_loss: EdgeDetectionLoss,
    geometric_approximation: GeometricApproximation,
    epipolar_removal: EpipolarRemoval,
    stereo_match: StereoMatch,
}

impl Sources {
    /// Perturbs an observation by every enabled source in turn, each with its own draws.
    pub fn apply(&self, observation: &mut StereoObservation, key: &NoiseKey) {
        for source in self.pipeline() {
            if source.is_enabled() && key.is_of(source.facts().acts_in) {
                source.apply(observation, &mut key.stream(source.facts()));
            }
        }
    }

    /// The sources themselves, if every magnitude is legal.
    ///
    /// # Errors
    /// When a magnitude, even of a disabled source, is not a number or outside its source's legal range.
    pub fn checked(self) -> Result<Self, SourceError> {
        for source in self.pipeline() {
            let (low, high) = source.facts().legal_range;
            if !(low..=high).contains(&source.magnitude()) {
                return Err(SourceError { facts: source.facts(), magnitude: source.magnitude() });
            }
        }
        Ok(self)
    }
}

/// A magnitude is outside the legal range of its source.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "{key}.magnitude = {magnitude} is not legal: {name} takes {low} to {high} {unit} (default {default}); \
     to switch it off write {key}.enabled = false",
    key = facts.key, name = facts.name, unit = facts.unit, default = facts.default_magnitude,
    low = facts.legal_range.0, high = facts.legal_range.1
)]
pub struct SourceError {
    /// The source.
    pub facts: &'static SourceFacts,
    /// The magnitude asked for.
    pub magnitude: f64,
}

/// Which draw of the noise: one look of one trial, or one view of one map.
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

    fn is_of(&self, acts_in: ActsIn) -> bool {
        match acts_in {
            ActsIn::Learning => self.purpose == Self::VIEW,
            ActsIn::Looks => self.purpose == Self::LOOK,
            ActsIn::Both => true,
        }
    }

    fn stream(&self, facts: &SourceFacts) -> Stream {
        // A part has at most 48 bits, a stream's number 16, so that no two sources, looks or views share a stream.
        Stream::new(self.seed, self.purpose, self.index, self.part << 16 | u64::from(facts.stream_id))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::SourceSetting;
    use crate::uncertainty::test_observation::observation;

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

    #[test]
    fn switching_one_source_off_leaves_the_draws_of_the_others() {
        // Stereo mismatches alone and after a lateral shift displace the same features by the same disparity.
        let error_px = |sources: &Sources| {
            let observation = applied(sources);
            let disparity = |index: usize| {
                let feature = &observation.features[index];
                feature.left[0].start().x - feature.right[0].start().x - 20.0
            };
            (0..300).map(disparity).collect::<Vec<_>>()
        };
        let alone = Sources { stereo_match: StereoMatch { enabled: true, magnitude: 0.1 }, ..Sources::none() };
        let with_shift = Sources { lateral_edge_shift: LateralEdgeShift::default(), ..alone.clone() };
        let (alone, with_shift) = (error_px(&alone), error_px(&with_shift));
        assert!(alone.iter().any(|error_px| error_px.abs() > 1.0));
        assert!(alone.iter().zip(&with_shift).all(|(a, b)| (a - b).abs() < 1e-3));
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
            edge_detection_loss: EdgeDetectionLoss { enabled: true, magnitude: 0.25 },
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
    }
}

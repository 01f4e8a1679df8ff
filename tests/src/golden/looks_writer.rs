//! Golden looks into bytes: the writing side of [`edgeloc_firmware::looks`].

use edgeloc::geometry::{Angle, Heading, Polarity, Segment2};
use edgeloc::localize::{LocalizerConfig, NextLook, VerificationConfig};
use edgeloc::pgh::DistanceKind;
use edgeloc_firmware::looks::{MAGIC, VERSION};

/// One attempt to be recorded.
#[derive(Debug, Clone)]
pub(super) struct Attempt {
    /// What it is there for.
    pub(super) name: String,
    pub(super) config: LocalizerConfig,
    /// Words of memory that the localizer is given; `None` for as many as it takes.
    pub(super) memory_words: Option<u32>,
    pub(super) looks: Vec<GoldenLook>,
}

/// One look of an attempt.
#[derive(Debug, Clone)]
pub(super) struct GoldenLook {
    pub(super) heading: Option<Heading>,
    /// Standard deviation of the heading \[rad\].
    pub(super) spread_rad: f32,
    /// The turn made since the look before and the way straight ahead after it \[m\], if there is odometry.
    pub(super) motion: Option<(Angle, f32)>,
    pub(super) segments: Vec<Segment2>,
}

/// The bytes of all `attempts`; equal configurations are written once.
pub(super) fn write(attempts: &[Attempt]) -> Vec<u8> {
    let mut configs: Vec<LocalizerConfig> = Vec::new();
    let mut body = Vec::new();
    for attempt in attempts {
        let known = configs.iter().position(|config| *config == attempt.config);
        let config_index = known.unwrap_or_else(|| {
            configs.push(attempt.config);
            configs.len() - 1
        });
        body.push(u8::try_from(attempt.name.len()).expect("names are short"));
        body.extend(attempt.name.as_bytes());
        body.extend(count(config_index).to_le_bytes());
        body.extend(count(attempt.looks.len()).to_le_bytes());
        body.extend(attempt.memory_words.unwrap_or(0).to_le_bytes());
        attempt.looks.iter().for_each(|look| write_look(&mut body, look));
    }
    let mut bytes = MAGIC.to_vec();
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(count(configs.len()).to_le_bytes());
    bytes.extend(u32::from(count(attempts.len())).to_le_bytes());
    configs.iter().for_each(|config| write_config(&mut bytes, config));
    bytes.extend(body);
    bytes
}

fn write_config(bytes: &mut Vec<u8>, config: &LocalizerConfig) {
    let shape = &config.shape;
    bytes.extend(shape.distance_bins.to_le_bytes());
    bytes.extend(shape.angle_bins.to_le_bytes());
    bytes.extend(shape.max_distance_px.to_le_bytes());
    let is_signed = shape.distance == DistanceKind::Signed;
    bytes.extend([is_signed, shape.uses_polarity, shape.interpolates_angle, false].map(u8::from));
    bytes.extend(config.score_margin.to_le_bytes());
    bytes.extend(config.turn.radians().to_le_bytes());
    bytes.extend(config.max_looks.to_le_bytes());
    bytes.extend(config.max_segments.to_le_bytes());
    bytes.extend(config.shortlist.to_le_bytes());
    bytes.extend(config.min_length_px.to_le_bytes());
    bytes.extend(config.horizontal_exclusion.radians().to_le_bytes());
    let verifies = config.verification.is_some();
    let zeros = VerificationConfig {
        cells_per_side: 0,
        reach: 0.0,
        headings: 0,
        confidence: 0.0,
        refined: 0,
        finalists: 0,
        next_look: NextLook::Fixed,
        moves: 0,
        move_m: 0.0,
    };
    let verification = config.verification.unwrap_or(zeros);
    bytes.extend([verifies, verification.next_look == NextLook::Predicted].map(u8::from));
    let VerificationConfig { cells_per_side, headings, refined, finalists, moves, .. } = verification;
    for number in [cells_per_side, headings, refined, finalists, moves] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(verification.reach.to_le_bytes());
    bytes.extend(verification.confidence.to_le_bytes());
    bytes.extend(verification.move_m.to_le_bytes());
}

fn write_look(bytes: &mut Vec<u8>, look: &GoldenLook) {
    bytes.push(u8::from(look.heading.is_some()));
    bytes.extend(look.heading.map_or(0.0, |heading| heading.angle().radians()).to_le_bytes());
    bytes.extend(look.spread_rad.to_le_bytes());
    let (turn, ahead_m) = look.motion.unwrap_or((Angle::from_radians(0.0), 0.0));
    bytes.push(u8::from(look.motion.is_some()));
    bytes.extend(turn.radians().to_le_bytes());
    bytes.extend(ahead_m.to_le_bytes());
    bytes.extend(count(look.segments.len()).to_le_bytes());
    for segment in &look.segments {
        for coordinate in [segment.start().x, segment.start().y, segment.end().x, segment.end().y] {
            bytes.extend(coordinate.to_le_bytes());
        }
        bytes.push(u8::from(segment.polarity() == Polarity::RightBrighter));
    }
}

fn count(value: usize) -> u16 {
    u16::try_from(value).expect("golden counts are small")
}

#[cfg(test)]
mod tests {
    use super::*;
    use edgeloc::geometry::Point2;
    use edgeloc::localize::{HeadingPrior, Motion};
    use edgeloc_firmware::looks::LooksReader;

    #[test]
    fn what_is_written_is_read() {
        let heading = Heading::new(Angle::from_radians(-1.25));
        let segment = |polarity| {
            Segment2::new(Point2::new(1.5, -2.25), Point2::new(640.125, 33.0), polarity).expect("a good segment")
        };
        let segments = vec![segment(Polarity::LeftBrighter), segment(Polarity::RightBrighter)];
        let turn = Angle::from_degrees(50.0);
        let first = GoldenLook { heading, spread_rad: 0.125, motion: None, segments: segments.clone() };
        let second = GoldenLook { heading: None, spread_rad: 0.0, motion: Some((turn, 0.75)), segments: vec![] };
        let looks = vec![first, second];
        let mut config = LocalizerConfig::paper();
        config.shape.distance = DistanceKind::Unsigned;
        config.turn = Angle::from_degrees(-45.0);
        config.shortlist = 4;
        config.verification = LocalizerConfig::edgeloc().verification;
        let plain = Attempt { name: "plain".to_owned(), config: LocalizerConfig::paper(), memory_words: None, looks };
        let tight = Attempt { name: "tight".to_owned(), config, memory_words: Some(7), looks: Vec::new() };

        let bytes = write(&[plain.clone(), tight, plain]);
        let mut reader = LooksReader::new(&bytes).expect("just written");
        assert_eq!(reader.attempt_count(), 3);
        for expected in [LocalizerConfig::paper(), config, LocalizerConfig::paper()] {
            let attempt = reader.attempt().expect("three attempts");
            assert_eq!(attempt.config, expected);
            if attempt.name == "tight" {
                assert_eq!((attempt.look_count, attempt.memory_words), (0, Some(7)));
                continue;
            }
            assert_eq!((attempt.name, attempt.look_count, attempt.memory_words), ("plain", 2, None));
            let look = reader.look().expect("two looks");
            let standard_deviation = Angle::from_radians(0.125);
            assert_eq!(look.heading, heading.map(|mean| HeadingPrior { mean, standard_deviation }));
            assert_eq!(look.motion, None);
            assert_eq!(look.segments().collect::<Result<Vec<_>, _>>().as_ref(), Ok(&segments));
            let look = reader.look().expect("two looks");
            assert_eq!((look.heading, look.motion), (None, Some(Motion::exact(turn, 0.75))));
        }
        assert!(reader.is_at_end());
    }
}

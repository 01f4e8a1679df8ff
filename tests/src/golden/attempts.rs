//! Which attempts are golden: every source on and off, several histograms, each kind of decision, each kind of refusal.

use edgeloc::geometry::{Angle, Point2, Polarity, Segment2};
use edgeloc::localize::{LocalizerConfig, NextLook, VerificationConfig};
use edgeloc::pgh::{DistanceKind, PghShape};
use edgeloc_firmware::SCENE_CAPACITY;
use edgeloc_sim::random::Stream;
use edgeloc_sim::uncertainty::{
    CameraTilt, Clutter, EdgeDetectionLoss, EpipolarRemoval, GeometricApproximation, ImageNoise, LateralEdgeShift,
    PolarityFlips, Sources, StereoMatch,
};

use super::looks_writer::{Attempt, GoldenLook};
use super::site::{Site, Start};

/// All golden attempts; each draws its start and its noise by its place in the list.
pub(super) fn all(site: &Site) -> Vec<Attempt> {
    let mut list = List { site, attempts: Vec::new() };
    list.sources_on_and_off();
    list.shapes();
    list.stop_rules();
    list.poor_scenes();
    list.crowded_scenes();
    list.refusals();
    list.verified();
    list.shortlisted();
    list.attempts
}

struct List<'s> {
    site: &'s Site,
    attempts: Vec<Attempt>,
}

impl List<'_> {
    /// No source, each source alone, all sources; with and without polarity, near a node and anywhere.
    fn sources_on_and_off(&mut self) {
        for (name, sources) in source_settings() {
            for (polarity, config) in [("", LocalizerConfig::paper()), (", polarity", with_polarity())] {
                self.look_around(format!("sources {name}{polarity}, near"), config, Start::Near, 3, &sources);
                self.look_around(format!("sources {name}{polarity}, anywhere"), config, Start::Anywhere, 3, &sources);
            }
        }
    }

    /// Histograms other than the paper's.
    fn shapes(&mut self) {
        let paper = PghShape::paper();
        let shapes = [
            ("unsigned", PghShape { distance: DistanceKind::Unsigned, ..paper }),
            ("unsigned, polarity", PghShape { distance: DistanceKind::Unsigned, uses_polarity: true, ..paper }),
            ("nearest angle bin", PghShape { interpolates_angle: false, ..paper }),
            ("5 x 8, 200 px", PghShape { distance_bins: 5, angle_bins: 8, max_distance_px: 200.0, ..paper }),
            ("30 x 64, 600 px", PghShape { distance_bins: 30, angle_bins: 64, max_distance_px: 600.0, ..paper }),
            ("1 x 1", PghShape { distance_bins: 1, angle_bins: 1, ..paper }),
        ];
        for (name, shape) in shapes {
            let config = LocalizerConfig { shape, ..LocalizerConfig::paper() };
            for _ in 0..3 {
                self.look_around(format!("shape {name}"), config, Start::Near, 2, &Sources::default());
            }
        }
    }

    /// Decided at once, never before the last look, and by other turns; a new attempt begins after a decision.
    fn stop_rules(&mut self) {
        let at_once = LocalizerConfig { score_margin: 0.0, ..LocalizerConfig::paper() };
        let at_last = LocalizerConfig { score_margin: 1000.0, max_looks: 3, ..LocalizerConfig::paper() };
        let first_look_only = LocalizerConfig { score_margin: 1000.0, max_looks: 1, ..LocalizerConfig::paper() };
        let other_turns =
            LocalizerConfig { score_margin: 0.3, turn: Angle::from_degrees(-75.0), ..LocalizerConfig::paper() };
        for (name, config, look_count) in [
            ("margin 0", at_once, 3),
            ("leader after 3 looks", at_last, 4),
            ("leader after 1 look", first_look_only, 2),
            ("margin 0.3, turns of -75 degrees", other_turns, 5),
        ] {
            for _ in 0..3 {
                self.look_around(name.to_owned(), config, Start::Anywhere, look_count, &Sources::default());
            }
        }
    }

    /// Nothing to see, or hardly anything.
    fn poor_scenes(&mut self) {
        let mut looks = self.looks(Start::Near, 13);
        looks.iter_mut().for_each(|look| look.segments.clear());
        self.push("empty scenes".to_owned(), LocalizerConfig::paper(), looks);

        let mut looks = self.looks(Start::Near, 4);
        looks.iter_mut().take(2).for_each(|look| look.segments.clear());
        self.push("empty scenes, then the office".to_owned(), LocalizerConfig::paper(), looks);

        for kept in 1..=3 {
            let mut looks = self.looks(Start::Near, 12);
            for look in &mut looks {
                look.segments.sort_by(|a, b| b.length_px().total_cmp(&a.length_px()));
                look.segments.truncate(kept);
            }
            self.push(format!("bare wall, {kept} segments"), LocalizerConfig::paper(), looks);
        }

        let mut looks = self.looks(Start::Near, 2);
        for look in &mut looks {
            look.segments = vec![segment(10.0, 200.0, 630.0, 201.0), segment(100.0, 50.0, 110.0, 50.0)];
        }
        self.push("only what is dropped: near-horizontal and short".to_owned(), LocalizerConfig::paper(), looks);
    }

    /// More segments than are kept, and segments at the limits of what a segment may be.
    fn crowded_scenes(&mut self) {
        let few = LocalizerConfig { max_segments: 8, ..LocalizerConfig::paper() };
        let everything =
            LocalizerConfig { min_length_px: 0.0, horizontal_exclusion: Angle::from_radians(0.0), ..with_polarity() };
        for (name, config) in [("8 kept", few), ("all kinds kept", everything)] {
            self.look_around(format!("crowded, {name}"), config, Start::Near, 3, &Sources::default());
            let mut looks = self.looks(Start::Near, 2);
            for (index, look) in looks.iter_mut().enumerate() {
                look.segments = random_segments(SCENE_CAPACITY, index as u64, 480.0);
            }
            self.push(format!("as many as fit, {name}"), config, looks);
        }
        let mut looks = self.looks(Start::Near, 2);
        for look in &mut looks {
            look.segments = random_segments(60, 9, f64::from(Segment2::MAX_COORDINATE_PX));
            look.segments.push(segment(-2048.0, -2048.0, 2048.0, 2048.0));
            look.segments.push(segment(2048.0, -2048.0, -2048.0, 2048.0));
            look.segments.push(segment(5.0, 5.0, 5.0, 5.0 + Segment2::MIN_LENGTH_PX));
        }
        self.push("at the limits of a segment".to_owned(), everything, looks);
    }

    /// Errors, which must be the same errors and leave the attempt as it was.
    fn refusals(&mut self) {
        let mut looks = self.looks(Start::Near, 3);
        looks[1].segments = random_segments(SCENE_CAPACITY + 1, 5, 480.0);
        self.push("more segments than the buffer holds".to_owned(), LocalizerConfig::paper(), looks);

        let mut looks = self.looks(Start::Near, 3);
        looks[1].heading = None;
        self.push("no compass at the second look".to_owned(), LocalizerConfig::paper(), looks);

        let looks = self.looks(Start::Near, 1);
        self.push("memory too small".to_owned(), LocalizerConfig::paper(), looks);
        self.last().memory_words = Some(1000);

        let no_bins = PghShape { distance_bins: 0, ..PghShape::paper() };
        for (name, config) in [
            ("no distance bins", LocalizerConfig { shape: no_bins, ..LocalizerConfig::paper() }),
            ("margin not a number", LocalizerConfig { score_margin: f32::NAN, ..LocalizerConfig::paper() }),
            ("no looks", LocalizerConfig { max_looks: 0, ..LocalizerConfig::paper() }),
        ] {
            self.push(format!("illegal configuration: {name}"), config, Vec::new());
            self.last().memory_words = Some(1000);
        }
    }

    /// The verifying localiser: with compass and odometry of all kinds, near and anywhere, moving, and where nothing is.
    fn verified(&mut self) {
        let whole = LocalizerConfig::edgeloc();
        let with = |change: fn(&mut VerificationConfig)| {
            let mut verification = few_poses();
            change(&mut verification);
            LocalizerConfig { verification: Some(verification), ..whole }
        };
        let edgeloc = with(|_| ());
        for (name, config, start, count) in [
            ("all poses", whole, Start::Near, 2),
            ("near", edgeloc, Start::Near, 2),
            ("near", edgeloc, Start::Near, 3),
            ("anywhere", edgeloc, Start::Anywhere, 2),
            ("fixed turns", with(|verification| verification.next_look = NextLook::Fixed), Start::Anywhere, 2),
            ("never sure, moving", with(|verification| verification.confidence = 100.0), Start::Near, 9),
        ] {
            let looks = self.moving_looks(start, count);
            self.push(format!("verified, {name}"), config, looks);
        }
        let mut looks = self.moving_looks(Start::Near, 3);
        for look in &mut looks {
            look.heading = look.heading.and_then(|heading| heading.turned(Angle::from_degrees(2.5)));
            look.spread_rad = 0.0875;
        }
        self.push("verified, a compass that errs".to_owned(), edgeloc, looks);

        let mut looks = self.moving_looks(Start::Near, 3);
        looks.iter_mut().for_each(|look| look.heading = None);
        self.push("verified, no compass".to_owned(), edgeloc, looks.clone());
        looks.iter_mut().for_each(|look| look.motion = None);
        self.push("verified, neither compass nor odometry".to_owned(), edgeloc, looks);

        let mut looks = self.moving_looks(Start::Near, 7);
        looks.iter_mut().for_each(|look| look.motion = None);
        self.push("verified, no odometry".to_owned(), with(|verification| verification.confidence = 100.0), looks);

        let mut looks = self.moving_looks(Start::Near, 7);
        looks.iter_mut().for_each(|look| (look.segments, look.motion) = (Vec::new(), None));
        self.push("verified, empty scenes".to_owned(), edgeloc, looks);
    }

    /// Nodes chosen by their gist before any is scored: by one heading, by several, and by all.
    fn shortlisted(&mut self) {
        let paper = LocalizerConfig { shortlist: 4, ..LocalizerConfig::paper() };
        self.look_around("4 of the nodes, near".to_owned(), paper, Start::Near, 3, &Sources::default());
        self.look_around("4 of the nodes, anywhere".to_owned(), paper, Start::Anywhere, 3, &Sources::default());

        let verified = LocalizerConfig { shortlist: 3, verification: Some(few_poses()), ..LocalizerConfig::edgeloc() };
        let looks = self.moving_looks(Start::Anywhere, 3);
        self.push("verified, 3 of the nodes".to_owned(), verified, looks);
        let mut looks = self.moving_looks(Start::Near, 3);
        looks.iter_mut().for_each(|look| look.spread_rad = 0.0875);
        self.push("verified, 3 of the nodes, a compass that errs".to_owned(), verified, looks.clone());
        looks.iter_mut().for_each(|look| look.heading = None);
        self.push("verified, 3 of the nodes, no compass".to_owned(), verified, looks);
    }

    /// A robot with odometry that drives 0.6 m after a full turn.
    fn moving_looks(&self, start: Start, count: u32) -> Vec<GoldenLook> {
        let way = (LocalizerConfig::edgeloc().turn, count, 0.6);
        self.site.looks_with_odometry(self.attempts.len() as u64, start, way, &Sources::default())
    }

    fn look_around(&mut self, name: String, config: LocalizerConfig, start: Start, look_count: u32, sources: &Sources) {
        let index = self.attempts.len() as u64;
        let looks = self.site.looks(index, start, config.turn, look_count, sources);
        self.push(name, config, looks);
    }

    fn looks(&self, start: Start, count: u32) -> Vec<GoldenLook> {
        let turn = LocalizerConfig::paper().turn;
        self.site.looks(self.attempts.len() as u64, start, turn, count, &Sources::default())
    }

    fn push(&mut self, name: String, config: LocalizerConfig, looks: Vec<GoldenLook>) {
        self.attempts.push(Attempt { name, config, memory_words: None, looks });
    }

    fn last(&mut self) -> &mut Attempt {
        self.attempts.last_mut().expect("an attempt was just added")
    }
}

fn with_polarity() -> LocalizerConfig {
    let shape = PghShape { uses_polarity: true, ..PghShape::paper() };
    LocalizerConfig { shape, ..LocalizerConfig::paper() }
}

/// Fewer poses than the reference has, so that an emulated board is through in time.
fn few_poses() -> VerificationConfig {
    VerificationConfig { cells_per_side: 3, refined: 6, finalists: 3, ..VerificationConfig::reference() }
}

/// No source, each of the paper's alone, all of them, and those that are off by default together.
fn source_settings() -> Vec<(&'static str, Sources)> {
    let none = Sources::none;
    vec![
        ("off", none()),
        ("lateral edge shift", Sources { lateral_edge_shift: LateralEdgeShift::default(), ..none() }),
        ("edge detection loss", Sources { edge_detection_loss: EdgeDetectionLoss::default(), ..none() }),
        ("geometric approximation", Sources { geometric_approximation: GeometricApproximation::default(), ..none() }),
        ("epipolar removal", Sources { epipolar_removal: EpipolarRemoval::default(), ..none() }),
        ("stereo match", Sources { stereo_match: StereoMatch::default(), ..none() }),
        ("on", Sources::default()),
        (
            "of our own",
            Sources {
                image_noise: ImageNoise { magnitude: 10.0, ..ImageNoise::default() },
                polarity_flips: PolarityFlips { enabled: true, ..PolarityFlips::default() },
                clutter: Clutter { enabled: true, ..Clutter::default() },
                camera_tilt: CameraTilt { enabled: true, ..CameraTilt::default() },
                ..none()
            },
        ),
    ]
}

fn random_segments(count: usize, index: u64, extent_px: f64) -> Vec<Segment2> {
    let mut stream = Stream::new(index, "crowd", count as u64, 0);
    let mut coordinate = || stream.uniform(0.0, extent_px) as f32;
    (0..count).map(|_| segment(coordinate(), coordinate(), coordinate(), coordinate())).collect()
}

/// Brighter to the left where it starts to the left, so that both polarities occur.
fn segment(start_x: f32, start_y: f32, end_x: f32, end_y: f32) -> Segment2 {
    let polarity = if start_x < end_x { Polarity::LeftBrighter } else { Polarity::RightBrighter };
    Segment2::new(Point2::new(start_x, start_y), Point2::new(end_x, end_y), polarity).expect("distinct points in range")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_source_of_images_has_its_turn() {
        let settings = source_settings();
        // Compass and odometry tell of poses; golden looks have perfect ones. Occlusion only takes away, as lost edges do.
        let of_images = Sources::none()
            .pipeline()
            .iter()
            .map(|source| !["compass", "occlusion", "odometry"].contains(&source.facts().key))
            .collect::<Vec<_>>();
        for (index, is_of_images) in of_images.into_iter().enumerate() {
            let acts = |sources: &Sources| {
                let source = sources.pipeline()[index];
                source.is_enabled() && source.magnitude() > 0.0
            };
            assert_eq!(settings.iter().any(|(_, sources)| acts(sources)), is_of_images, "source {index}");
        }
    }
}

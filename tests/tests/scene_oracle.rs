//! Which segments enter the matching, against the naive twin.

use edgeloc::database::TopologicalDatabase;
use edgeloc::geometry::{Angle, Heading, Point2, Polarity, Scene, Segment2, StereoRig};
use edgeloc::localize::{HeadingPrior, Localizer, LocalizerConfig, Look};
use edgeloc::pgh::{Line, LongestLines};
use edgeloc_tests::oracle::{NaiveSegment, prepare_scene};
use edgeloc_tests::strategies::{fixed_cases, segment};
use edgeloc_tests::tiny_worlds::{TinyNode, database_bytes};
use proptest::collection::vec;
use proptest::prelude::*;

fn naive(segments: &[Segment2]) -> Vec<NaiveSegment> {
    segments.iter().map(NaiveSegment::from).collect()
}

proptest! {
    #![proptest_config(fixed_cases(300))]

    #[test]
    fn as_many_segments_enter_as_in_the_naive_twin(
        segments in vec(segment(), 0..120),
        min_length_px in 0.0..60.0_f32,
        exclusion_deg in prop_oneof![Just(0.0_f32), Just(5.0), 0.0..89.0_f32],
        max_segments in 1..=100_u16,
    ) {
        let config = LocalizerConfig {
            min_length_px,
            horizontal_exclusion: Angle::from_degrees(exclusion_deg),
            max_segments,
            ..LocalizerConfig::paper()
        };
        let bytes = database_bytes(&StereoRig::reference(), &[TinyNode::default()]);
        let database = TopologicalDatabase::open(&bytes).expect("just written");
        let mut memory = vec![0; Localizer::memory_len(&config, 1)];
        let mut localizer = Localizer::new(database, &config, &mut memory).expect("memory of the length asked for");
        let heading = Heading::new(Angle::from_degrees(0.0)).map(HeadingPrior::exact);
        let look = Look { heading, motion_since_last: None, scene: Scene::new(&segments) };
        localizer.observe(&look).expect("a heading is given");
        prop_assert_eq!(localizer.scene_segment_count(), prepare_scene(&naive(&segments), &config).len());
    }

    #[test]
    fn the_longest_segments_are_the_naive_ones(
        // Whole lengths, so that many are equal.
        lengths in vec(12..30_u8, 0..60),
        max_segments in 1..=40_u16,
    ) {
        let config = LocalizerConfig { max_segments, ..LocalizerConfig::paper() };
        let upright = |&length: &u8| {
            let (top, bottom) = (Point2::new(9.0, 5.0), Point2::new(9.0, 5.0 + f32::from(length)));
            Segment2::new(top, bottom, Polarity::LeftBrighter).expect("valid")
        };
        let segments: Vec<Segment2> = lengths.iter().map(upright).collect();
        let line = |index: usize| Line::new(&segments[index], index as u32, &config.shape);
        let kept: Vec<Line> = prepare_scene(&naive(&segments), &config).into_iter().map(line).collect();
        let unused = Segment2::new(
            Point2::new(0.0, 0.0),
            Point2::new(1.0, 0.0),
            Polarity::LeftBrighter,
        ).expect("valid");
        let mut storage = vec![Line::new(&unused, 0, &config.shape); usize::from(max_segments)];
        let mut longest = LongestLines::new(&mut storage);
        (0..segments.len()).for_each(|index| longest.offer(line(index)));
        let lines = longest.into_lines();
        prop_assert_eq!(lines.len(), kept.len());
        prop_assert!(kept.iter().all(|line| lines.contains(line)));
    }
}

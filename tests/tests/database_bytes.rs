//! The byte format of the database against truncation, damage and hostile hands.

use edgeloc::database::{
    IndexError, IndexShape, NodeId, NodeModel, OpenError, TopologicalDatabase, WriteError, begin_index, encoded_len,
    format, indexed_len, seal, write,
};
use edgeloc::geometry::{Angle, Heading, Point2, Point3, Polarity, Scene, Segment2, Segment3, StereoRig};
use edgeloc::localize::{HeadingPrior, Localizer, LocalizerConfig, Look};
use edgeloc_tests::strategies::fixed_cases;
use edgeloc_tests::tiny_worlds::{
    TinyNode, all_seeing_node, all_seeing_scene, database_bytes, furnished_room, random_positions,
};
use proptest::collection::vec;
use proptest::prelude::*;

const RIG: StereoRig = StereoRig::reference();

fn tiny_nodes(count: usize) -> Vec<TinyNode> {
    let world = furnished_room();
    random_positions(3, count).into_iter().map(|position| all_seeing_node(&world, &RIG, position)).collect()
}

/// Makes the checksum right again, as someone who damages on purpose would.
fn with_checksum(mut bytes: Vec<u8>) -> Vec<u8> {
    let length = u32::from_le_bytes(bytes[16..20].try_into().expect("four bytes")) as usize;
    let crc = format::checksum(&bytes[..length.clamp(format::HEADER_LEN, bytes.len())]);
    bytes[format::CRC_BYTES].copy_from_slice(&crc.to_le_bytes());
    bytes
}

/// Opens, reads everything there is and takes a look around: whatever the answers, it must come to an end.
fn exercise(bytes: &[u8], scene: &[Segment2]) -> Result<(), OpenError> {
    let database = TopologicalDatabase::open(bytes)?;
    let read: usize = database.nodes().map(|node| node.segments().filter(|s| s.start.is_finite()).count()).sum();
    assert_eq!(read, database.segment_count());
    assert!(database.nodes().all(|node| node.position().is_finite()));
    assert!(database.node(NodeId(database.node_count() as u32)).is_none());

    let config = LocalizerConfig::paper();
    let mut memory = vec![0; Localizer::memory_len(&config, database.node_count())];
    let mut localizer = Localizer::new(database, &config, &mut memory).expect("memory of the length asked for");
    let heading = Heading::new(Angle::from_degrees(40.0)).map(HeadingPrior::exact);
    let look = Look { heading, motion_since_last: None, scene: Scene::new(scene) };
    localizer.observe(&look).expect("a heading is given");
    Ok(())
}

#[test]
fn every_truncation_is_refused() {
    let bytes = database_bytes(&RIG, &tiny_nodes(3));
    for length in 0..bytes.len() {
        let error = TopologicalDatabase::open(&bytes[..length]).expect_err("bytes are missing");
        assert!(matches!(error, OpenError::Truncated { length: found, needed } if found == length && needed > length));
    }
}

#[test]
fn every_flipped_bit_is_refused() {
    let bytes = database_bytes(&RIG, &tiny_nodes(2));
    for position in 0..bytes.len() {
        for bit in 0..8 {
            let mut damaged = bytes.clone();
            damaged[position] ^= 1 << bit;
            assert!(TopologicalDatabase::open(&damaged).is_err(), "bit {bit} of byte {position} was flipped unnoticed");
        }
    }
}

#[test]
fn bytes_after_the_end_are_ignored() {
    let bytes = database_bytes(&RIG, &tiny_nodes(2));
    let mut longer = bytes.clone();
    longer.extend([0xff; 32]);
    assert_eq!(
        TopologicalDatabase::open(&longer).map(|database| database.segment_count()).ok(),
        TopologicalDatabase::open(&bytes).map(|database| database.segment_count()).ok()
    );
}

#[test]
fn another_file_and_another_version_are_named_as_such() {
    let bytes = database_bytes(&RIG, &tiny_nodes(2));
    let mut other = bytes.clone();
    other[0] = b'E';
    assert_eq!(TopologicalDatabase::open(&other).expect_err("magic"), OpenError::NotADatabase);
    let mut newer = bytes;
    newer[8..10].copy_from_slice(&4_u16.to_le_bytes());
    assert_eq!(TopologicalDatabase::open(&with_checksum(newer)).expect_err("version"), OpenError::Version { found: 4 });
}

#[test]
fn absurd_counts_are_refused_even_with_a_right_checksum() {
    let bytes = database_bytes(&RIG, &tiny_nodes(2));
    for offset in [16, 20, 24] {
        for value in [0_u32, 1, 3, 1000, 0x0fff_ffff, u32::MAX - 1, u32::MAX] {
            let mut absurd = bytes.clone();
            absurd[offset..offset + 4].copy_from_slice(&value.to_le_bytes());
            let error = TopologicalDatabase::open(&with_checksum(absurd)).expect_err("a count contradicts the others");
            assert!(matches!(error, OpenError::Counts | OpenError::Truncated { .. } | OpenError::Empty), "{error}");
        }
    }
}

#[test]
fn counts_that_agree_with_each_other_but_not_with_the_bytes_are_a_truncation() {
    let mut bytes = database_bytes(&RIG, &tiny_nodes(2));
    let (nodes, segments) = (100_000_000_u32, 100_000_000_u32);
    let length = format::HEADER_LEN as u64
        + u64::from(nodes) * format::NODE_LEN as u64
        + u64::from(segments) * format::SEGMENT_LEN as u64;
    for (offset, value) in [(16, length as u32), (20, nodes), (24, segments)] {
        bytes[offset..offset + 4].copy_from_slice(&value.to_le_bytes());
    }
    let error = TopologicalDatabase::open(&with_checksum(bytes)).expect_err("bytes are missing");
    assert!(matches!(error, OpenError::Truncated { needed, .. } if needed as u64 == length), "{error}");
}

#[test]
fn rigs_that_make_no_sense_are_refused_on_both_sides() {
    let bytes = database_bytes(&RIG, &tiny_nodes(1));
    for offset in (32..64).step_by(4) {
        for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1000.0, 1.0e30] {
            let mut hostile = bytes.clone();
            hostile[offset..offset + 4].copy_from_slice(&value.to_le_bytes());
            let error = TopologicalDatabase::open(&with_checksum(hostile)).expect_err("no such rig");
            assert!(matches!(error, OpenError::Camera(_) | OpenError::Rig(_)), "{value} at {offset}: {error}");
        }
    }
    let nodes = [NodeModel { position: Point2::default(), segments: &[] }];
    let spoil: [fn(&mut StereoRig); 5] = [
        |rig| rig.baseline_m = f32::NAN,
        |rig| rig.camera_height_m = f32::INFINITY,
        |rig| rig.near_limit_m = 0.0,
        |rig| rig.nearest_model_m = f32::NAN,
        |rig| rig.farthest_model_m = f32::NAN,
    ];
    for spoil in spoil {
        let mut rig = RIG;
        spoil(&mut rig);
        assert!(matches!(write(&rig, 12, &nodes, &mut [0; 128]), Err(WriteError::Rig(_))), "{rig:?} was written");
    }
}

#[test]
fn any_flipped_byte_under_a_right_checksum_is_survived() {
    let world = furnished_room();
    let bytes = database_bytes(&RIG, &tiny_nodes(2));
    let heading = Heading::new(Angle::from_degrees(40.0)).expect("finite");
    let scene = all_seeing_scene(&world, &RIG, Point2::new(2.0, 2.0), heading);
    let mut opened = 0;
    for position in 0..bytes.len() {
        for flip in [0x01, 0x80, 0xff] {
            let mut hostile = bytes.clone();
            hostile[position] ^= flip;
            opened += usize::from(exercise(&with_checksum(hostile), &scene).is_ok());
        }
    }
    assert!(opened > bytes.len(), "most flips change a number only: {opened} of {}", 3 * bytes.len());
}

const SHAPE: IndexShape = IndexShape { sectors: 3, poses: 2 };

/// A map with an index whose bytes count up.
fn indexed_bytes(node_count: usize) -> Vec<u8> {
    let plain = database_bytes(&RIG, &tiny_nodes(node_count));
    let length = indexed_len(&TopologicalDatabase::open(&plain).expect("a map"), SHAPE).expect("a small one");
    let mut bytes = plain;
    bytes.resize(length, 0);
    let parts = begin_index(&mut bytes, SHAPE).expect("room enough");
    parts.mean.iter_mut().zip(0..).for_each(|(mean, number)| *mean = i16::into(number));
    parts.axes[5][7] = (-300).into();
    for (code, number) in parts.codes.iter_mut().zip(0..) {
        *code = [number; 64];
    }
    assert_eq!(seal(&mut bytes), Ok(length));
    bytes
}

#[test]
fn an_index_is_read_as_it_was_written_and_the_map_is_the_same() {
    let (plain, bytes) = (database_bytes(&RIG, &tiny_nodes(4)), indexed_bytes(4));
    let (before, map) = (TopologicalDatabase::open(&plain).expect("a map"), TopologicalDatabase::open(&bytes));
    let map = map.expect("sealed");
    assert!(before.index().is_none() && map.without_index().index().is_none());
    assert_eq!((map.byte_len(), before.byte_len()), (bytes.len(), plain.len()));
    assert_eq!(map.segment_bytes(), before.segment_bytes());
    let index = map.index().expect("an index");
    assert_eq!(index.shape(), SHAPE);
    assert_eq!((index.mean()[9].get(), index.axes()[5][7].get()), (9, -300));
    // Four nodes of two poses in a sector.
    assert_eq!(index.sector(1).iter().map(|code| code[0]).collect::<Vec<i8>>(), (8..16).collect::<Vec<i8>>());
    assert!(index.sector(3).is_empty() && index.sector(u16::MAX).is_empty());
}

#[test]
fn an_index_is_replaced_and_refused_where_there_is_no_room() {
    let mut bytes = indexed_bytes(4);
    let larger = IndexShape { sectors: 4, ..SHAPE };
    assert!(matches!(begin_index(&mut bytes, larger), Err(IndexError::OutputTooShort { .. })));
    bytes.resize(bytes.len() + 1000, 7);
    begin_index(&mut bytes, larger).expect("room enough").codes.fill([1; 64]);
    let length = seal(&mut bytes).expect("whole");
    let map = TopologicalDatabase::open(&bytes[..length]).expect("sealed");
    assert_eq!(map.index().map(|index| index.shape()), Some(larger));
    for shape in [IndexShape { sectors: 0, ..SHAPE }, IndexShape { poses: 65, ..SHAPE }] {
        assert_eq!(begin_index(&mut bytes, shape).err(), Some(IndexError::Shape));
    }
    assert!(matches!(begin_index(&mut [0; 50], SHAPE), Err(IndexError::Open(_))));
}

#[test]
fn a_damaged_index_is_refused() {
    let bytes = indexed_bytes(2);
    for length in (0..bytes.len()).step_by(97) {
        assert!(matches!(TopologicalDatabase::open(&bytes[..length]), Err(OpenError::Truncated { .. })));
    }
    for position in (0..bytes.len()).step_by(61).chain(bytes.len() - 64..bytes.len()) {
        let mut damaged = bytes.clone();
        damaged[position] ^= 0x10;
        assert!(TopologicalDatabase::open(&damaged).is_err(), "byte {position}");
    }
    // Sectors and poses that contradict the length, or make no sense, even with a right checksum.
    for (sectors, poses) in [(0_u16, 0_u16), (0, 2), (3, 0), (4, 2), (2, 3), (400, 1), (1, 400), (u16::MAX, u16::MAX)] {
        let mut absurd = bytes.clone();
        absurd[68..70].copy_from_slice(&sectors.to_le_bytes());
        absurd[70..72].copy_from_slice(&poses.to_le_bytes());
        let opened =
            TopologicalDatabase::open(&with_checksum(absurd)).map(|map| map.index().map(|index| index.shape()));
        let is_refused = matches!(opened, Err(OpenError::Counts | OpenError::Index | OpenError::Truncated { .. }));
        // The same number of codes, otherwise told apart, is a legal index.
        assert!(is_refused || sectors * poses == 6, "{sectors} x {poses}: {opened:?}");
    }
    let mut no_codes = database_bytes(&RIG, &tiny_nodes(2));
    no_codes[68..70].copy_from_slice(&5_u16.to_le_bytes());
    assert_eq!(TopologicalDatabase::open(&with_checksum(no_codes)).err(), Some(OpenError::Index));
}

#[test]
fn any_codes_and_axes_are_survived() {
    let mut bytes = indexed_bytes(5);
    let head = format::HEADER_LEN + 5 * format::NODE_LEN;
    let segments = TopologicalDatabase::open(&bytes).expect("a map").segment_count() * format::SEGMENT_LEN;
    for (filling, byte) in bytes[head + segments..].iter_mut().zip([0x80, 0xff, 0x7f, 0x01, 0x00].into_iter().cycle()) {
        *filling = byte;
    }
    let bytes = with_checksum(bytes);
    let world = furnished_room();
    let heading = Heading::new(Angle::from_degrees(40.0)).expect("finite");
    let scene = all_seeing_scene(&world, &RIG, Point2::new(2.0, 2.0), heading);
    for config in [LocalizerConfig::paper(), LocalizerConfig::edgeloc()] {
        let config = LocalizerConfig { shortlist: 2, ..config };
        let map = TopologicalDatabase::open(&bytes).expect("a right checksum");
        let mut memory = vec![0; Localizer::memory_len_in(&config, &map)];
        let mut localizer = Localizer::new(map, &config, &mut memory).expect("memory of the length asked for");
        for _ in 0..4 {
            let look = Look {
                heading: Some(HeadingPrior::exact(heading)),
                motion_since_last: None,
                scene: Scene::new(&scene),
            };
            localizer.observe(&look).expect("a heading is given");
            assert!(localizer.candidates().candidates().count() <= 2);
        }
    }
}

fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![8 => -32.767..32.767_f32, 1 => Just(32.767), 1 => Just(-32.767), 1 => Just(0.0)]
}

fn segment3() -> impl Strategy<Value = Segment3> {
    let point = || (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| Point3::new(x, y, z));
    (point(), point(), edgeloc_tests::strategies::polarity()).prop_map(|(start, end, polarity)| Segment3 {
        start,
        end,
        polarity,
    })
}

fn node() -> impl Strategy<Value = TinyNode> {
    let position = (-1.0e3..1.0e3_f32, -1.0e3..1.0e3_f32).prop_map(|(x, y)| Point2::new(x, y));
    (position, vec(segment3(), 0..20)).prop_map(|(position, segments)| TinyNode { position, segments })
}

proptest! {
    #![proptest_config(fixed_cases(200))]

    #[test]
    fn what_is_written_is_read_to_the_millimetre(nodes in vec(node(), 1..8)) {
        let bytes = database_bytes(&RIG, &nodes);
        let database = TopologicalDatabase::open(&bytes).expect("just written");
        prop_assert_eq!(database.node_count(), nodes.len());
        prop_assert_eq!(database.rig(), &RIG);
        for (written, read) in nodes.iter().zip(database.nodes()) {
            prop_assert!(written.position.distance(read.position()) < 1.0e-3);
            prop_assert_eq!(read.segments().len(), written.segments.len());
            for (written, read) in written.segments.iter().zip(read.segments()) {
                // The format keeps polarity as the order of the end points.
                let (start, end) = if written.polarity == read.polarity {
                    (written.start, written.end)
                } else {
                    (written.end, written.start)
                };
                prop_assert!(start.distance(read.start) < 1.0e-3 && end.distance(read.end) < 1.0e-3);
            }
        }
    }

    #[test]
    fn random_bytes_are_refused(bytes in vec(any::<u8>(), 0..400)) {
        prop_assert!(TopologicalDatabase::open(&bytes).is_err());
    }

    #[test]
    fn random_tables_under_a_right_header_are_survived(tables in vec(any::<u8>(), 16 + 12..400)) {
        let segments: Vec<Segment3> = vec![Segment3 {
            start: Point3::default(),
            end: Point3::new(1.0, 1.0, 1.0),
            polarity: Polarity::LeftBrighter,
        }; (tables.len() - 16) / 12];
        let mut bytes = database_bytes(&RIG, &[TinyNode { position: Point2::default(), segments }]);
        let end = bytes.len();
        // Everything but the node's own counts.
        bytes[72..80].copy_from_slice(&tables[..8]);
        bytes[88..end].copy_from_slice(&tables[16..16 + end - 88]);
        prop_assert!(exercise(&with_checksum(bytes), &[]).is_ok());
    }

    #[test]
    fn the_length_is_known_before_writing(nodes in vec(node(), 1..4)) {
        let models: Vec<NodeModel<'_>> =
            nodes.iter().map(|node| NodeModel { position: node.position, segments: &node.segments }).collect();
        let needed = encoded_len(&models).expect("a few nodes");
        let mut exact = vec![0; needed];
        prop_assert_eq!(write(&RIG, 12, &models, &mut exact), Ok(needed));
        let error = write(&RIG, 12, &models, &mut exact[1..]).expect_err("one byte short");
        prop_assert_eq!(error, WriteError::OutputTooShort { capacity: needed - 1, needed });
    }
}

/// The bytes of the annotated example in the documentation of the format: hexadecimal pairs up to the bar of each line.
fn documented_example() -> Vec<u8> {
    let text = include_str!("../../core/src/database/format.rs");
    let lines = text.lines().filter_map(|line| line.strip_prefix("//! ")?.split_once(" | "));
    let pairs = lines.filter(|(offset, _)| offset.starts_with("0x")).flat_map(|(bytes, _)| bytes.split(' ').skip(1));
    pairs.map(|pair| u8::from_str_radix(pair, 16).expect("two hexadecimal digits")).collect()
}

#[test]
fn the_annotated_example_is_what_is_written_and_reads_as_annotated() {
    let segment = Segment3 {
        start: Point3::new(2.0, 0.5, 0.75),
        end: Point3::new(2.0, 0.5, -0.25),
        polarity: Polarity::LeftBrighter,
    };
    let models = [NodeModel { position: Point2::new(1.5, -2.0), segments: &[segment] }];
    let mut written = vec![0; encoded_len(&models).expect("it fits")];
    write(&RIG, 12, &models, &mut written).expect("a legal map");

    let example = documented_example();
    assert_eq!(written, example, "written: {written:02x?}");
    let database = TopologicalDatabase::open(&example).expect("the example is a database");
    let node = database.node(NodeId(0)).expect("its one node");
    assert_eq!((database.views_per_node(), *database.rig()), (12, RIG));
    assert!(node.position().distance(models[0].position) < 1e-6);
    let read: Vec<Segment3> = node.segments().collect();
    assert_eq!((read.len(), read[0].polarity), (1, segment.polarity));
    assert!(read[0].start.distance(segment.start) < 1e-6 && read[0].end.distance(segment.end) < 1e-6);
}

//! Maps of many buildings: joined file by file, then indexed, by mapped files, so that none has to fit into memory.

use super::view_index::{LearnedProjection, fill_index, index_shape};
use crate::map_file::{MapFile, NewMapFile};
use edgeloc::database::{self, IndexError, OpenError, TopologicalDatabase, format};
use edgeloc::geometry::Point2;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A map that becomes part of a greater one.
#[derive(Debug, Clone)]
pub struct MapPart {
    /// The file.
    pub path: PathBuf,
    /// Where its origin comes to lie \[m\].
    pub origin: Point2,
}

/// Joins maps of one rig to one at `output`, in their order and without an index; tells `on_part` of each.
///
/// # Errors
/// When a file can't be read or is no map, the maps differ in rig or views, or the whole passes 4 GiB.
pub fn join_maps(parts: &[MapPart], output: &Path, on_part: &dyn Fn()) -> Result<(), JoinError> {
    let first = parts.first().ok_or(JoinError::Nothing)?;
    let first_file = mapped(&first.path)?;
    let like = opened(&first.path, &first_file)?;
    let (mut node_count, mut segment_count, mut agreements) = (0, 0, Vec::new());
    for part in parts {
        let file = mapped(&part.path)?;
        let map = opened(&part.path, &file)?;
        if map.rig() != like.rig() || map.views_per_node() != like.views_per_node() {
            return Err(JoinError::Unlike { path: part.path.clone() });
        }
        node_count += map.node_count();
        segment_count += map.segment_count();
        agreements.extend(map.self_agreement());
    }
    agreements.sort_by(f32::total_cmp);
    let agreement = agreements.get(agreements.len() / 2).copied();
    let header = database::joined_header(&like, (node_count, segment_count), agreement).ok_or(JoinError::TooLarge)?;
    let tables = format::HEADER_LEN + node_count * format::NODE_LEN;
    let length = tables + segment_count * format::SEGMENT_LEN;
    finished(output, length, |bytes| {
        bytes[..format::HEADER_LEN].copy_from_slice(&header);
        let (nodes, mut segments) = bytes.split_at_mut(tables);
        let mut slots = nodes[format::HEADER_LEN..].chunks_exact_mut(format::NODE_LEN);
        let mut first_segment = 0;
        for part in parts {
            let file = mapped(&part.path)?;
            let map = opened(&part.path, &file)?;
            for (node, slot) in map.nodes().zip(&mut slots) {
                let entry = database::moved_node(&node, part.origin, first_segment).ok_or(JoinError::TooLarge)?;
                slot.copy_from_slice(&entry);
                first_segment += node.segments().len() as u32;
            }
            let (own, rest) = segments.split_at_mut(map.segment_bytes().len());
            own.copy_from_slice(map.segment_bytes());
            segments = rest;
            on_part();
        }
        Ok(())
    })
}

/// Adds an index to the map in `input`, or replaces the one it has, and writes it to `output`; tells `on_views` of how many
/// nodes the views of a sector are done.
///
/// # Errors
/// When a file can't be read or written, is no map, or passes 4 GiB with the index.
pub fn index_map(input: &Path, output: &Path, on_views: &(dyn Fn(usize) + Sync)) -> Result<(), JoinError> {
    let file = mapped(input)?;
    let map = opened(input, &file)?;
    let old = map.byte_len();
    let length = database::indexed_len(&map, index_shape()).ok_or(JoinError::TooLarge)?;
    let projection = LearnedProjection::learn(&map);
    finished(output, length.max(old), |bytes| {
        bytes[..old].copy_from_slice(&file[..old]);
        fill_index(&map, &projection, &mut database::begin_index(bytes, index_shape())?, on_views);
        Ok(())
    })
}

/// The bytes of a map with an index.
///
/// # Errors
/// When `bytes` are no map, or pass 4 GiB with the index.
pub fn indexed(bytes: &[u8]) -> Result<Vec<u8>, IndexError> {
    let map = TopologicalDatabase::open(bytes).map_err(IndexError::Open)?;
    let old = map.byte_len();
    let length = database::indexed_len(&map, index_shape()).ok_or(IndexError::TooLarge)?;
    let mut out = vec![0; length.max(old)];
    out[..old].copy_from_slice(&bytes[..old]);
    let projection = LearnedProjection::learn(&map);
    fill_index(&map, &projection, &mut database::begin_index(&mut out, index_shape())?, &|_| ());
    let length = database::seal(&mut out)?;
    out.truncate(length);
    Ok(out)
}

/// A file that `fill` fills, sealed, under its name only when it is finished.
fn finished(
    output: &Path,
    length: usize,
    fill: impl FnOnce(&mut [u8]) -> Result<(), JoinError>,
) -> Result<(), JoinError> {
    let mut partial = output.as_os_str().to_owned();
    partial.push(format!(".{}.partial", std::process::id()));
    let partial = PathBuf::from(partial);
    let failed = |error| JoinError::File { path: output.to_owned(), error };
    let written = NewMapFile::open(&partial, length as u64).map_err(failed).and_then(|mut file| {
        fill(&mut file)?;
        database::seal(&mut file)?;
        file.finish().map_err(failed)
    });
    let written = written.and_then(|()| fs::rename(&partial, output).map_err(failed));
    if written.is_err() {
        // The error that is reported is the one that mattered.
        let _ = fs::remove_file(&partial);
    }
    written
}

fn mapped(path: &Path) -> Result<MapFile, JoinError> {
    MapFile::open(path).map_err(|error| JoinError::File { path: path.to_owned(), error })
}

fn opened<'a>(path: &Path, file: &'a MapFile) -> Result<TopologicalDatabase<'a>, JoinError> {
    TopologicalDatabase::open(file).map_err(|error| JoinError::Open { path: path.to_owned(), error })
}

/// Why maps can't be joined or indexed.
#[derive(Debug, thiserror::Error)]
pub enum JoinError {
    /// There is no map to join.
    #[error("there is no map to join")]
    Nothing,
    /// A file can't be read or written.
    #[error("{}: {error}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// A file is no map.
    #[error("{} is not a sound map: {error}", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// Why not.
        error: OpenError,
    },
    /// A map was learned otherwise.
    #[error("{} was learned by another rig than the first map, or with other views", path.display())]
    Unlike {
        /// The map.
        path: PathBuf,
    },
    /// The whole does not fit the format.
    #[error("the whole would pass 4 GiB, or lie beyond 2000 km")]
    TooLarge,
    /// The index can't be added.
    #[error(transparent)]
    Index(#[from] IndexError),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::{CalibratedRig, LearnedNode, write_map};
    use edgeloc::database::NodeId;
    use edgeloc::geometry::{Point3, Polarity, Segment3, StereoRig};

    /// Writes a map of nodes with one to `count` posts around them.
    fn write(folder: &Path, name: &str, count: u16, rig: StereoRig) -> PathBuf {
        let post = |index: u16| {
            let (sin, cos) = edgeloc::math::sin_cos(f32::from(index) * 1.3);
            let point = |height| Point3::new(3.0 * cos, 3.0 * sin, height);
            Segment3 { start: point(-0.7), end: point(0.9), polarity: Polarity::LeftBrighter }
        };
        let node = |index: u16| LearnedNode {
            position: Point2::new(f32::from(index), 0.5),
            segments: (0..=index).map(post).collect(),
        };
        let nodes = (0..count).map(node).collect::<Vec<_>>();
        let path = folder.join(name);
        fs::write(&path, write_map(&CalibratedRig::exact(rig), 12, &nodes).expect("legal")).expect("written");
        path
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("a folder");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn maps_are_joined_moved_and_indexed_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let rig = StereoRig::reference();
        let parts = [("a", 3, 0.0), ("b", 2, 40.0)].map(|(name, count, x)| MapPart {
            path: write(folder.path(), name, count, rig),
            origin: Point2::new(x, -x),
        });
        let (joined, with_index) = (folder.path().join("joined"), folder.path().join("with-index"));
        join_maps(&parts, &joined, &|| ()).expect("two maps of one rig");
        index_map(&joined, &with_index, &|_| ()).expect("a map");
        for path in [&joined, &with_index] {
            let file = MapFile::open(path).expect("a file");
            let map = TopologicalDatabase::open(&file).expect("sealed");
            let counts = map.nodes().map(|node| node.segments().len()).collect::<Vec<_>>();
            assert_eq!(counts, [1, 2, 3, 1, 2]);
            let last = map.node(NodeId(4)).expect("five nodes");
            assert!(last.position().distance(Point2::new(41.0, -39.5)) < 1e-3);
            assert!(last.segments().eq(map.node(NodeId(1)).expect("five nodes").segments()));
            assert_eq!(map.index().map(|index| index.shape()), (path == &with_index).then(index_shape));
        }
        assert_eq!(names(folder.path()), ["a", "b", "joined", "with-index"]);
        let bytes = fs::read(&with_index).expect("a file");
        assert!(indexed(&bytes).expect("a map") == bytes, "an index made anew is the same");
    }

    #[test]
    fn what_is_no_map_or_of_another_rig_is_refused_and_nothing_is_left() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let rig = StereoRig::reference();
        let other = StereoRig { baseline_m: 0.2, ..rig };
        let part = |path: PathBuf| MapPart { path, origin: Point2::default() };
        let (good, unlike) = (write(folder.path(), "a", 2, rig), write(folder.path(), "b", 2, other));
        let output = folder.path().join("out");
        let join = |parts: &[MapPart]| join_maps(parts, &output, &|| ());
        assert!(matches!(join(&[]), Err(JoinError::Nothing)));
        assert!(matches!(join(&[part(good.clone()), part(unlike)]), Err(JoinError::Unlike { .. })));
        assert!(matches!(join(&[part(folder.path().join("none"))]), Err(JoinError::File { .. })));
        fs::write(folder.path().join("c"), b"no map").expect("written");
        assert!(matches!(index_map(&folder.path().join("c"), &output, &|_| ()), Err(JoinError::Open { .. })));
        assert!(index_map(&good, &folder.path().join("none").join("out"), &|_| ()).is_err());
        assert_eq!(names(folder.path()), ["a", "b", "c"]);
    }
}

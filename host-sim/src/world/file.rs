//! The world file, `.edgeworld`: a wire-frame world as little-endian bytes.
//!
//! | offset | bytes | what |
//! |---|---|---|
//! | 0 | 8 | magic, the ASCII text `edgewrld` |
//! | 8 | 4 | version, u32: 1 |
//! | 12 | 4 | CRC-32 (ISO-HDLC, as in zip) of all bytes from offset 16 to the end, u32 |
//! | 16 | 4 | length N of the name in bytes, u32 |
//! | 20 | 4 | length O of the origin in bytes, u32 |
//! | 24 | 4 | count of edges E, u32 |
//! | 28 | 4 | count of vertices V, u32 |
//! | 32 | 4 | count of triangles T, u32 |
//! | 36 | N | name, UTF-8 |
//! | 36 + N | O | origin, UTF-8 |
//! | 36 + N + O | 28 E | edges: start x y z, end x y z in metres, f32 each; then u32: 0 left brighter, 1 right brighter |
//! | .. + 28 E | 12 V | vertices: x y z in metres, f32 each |
//! | .. + 12 V | 12 T | triangles: three indices of vertices, u32 each |
//!
//! The file ends there: its length follows from the counts. A reader of version 1 refuses every other version.
//! [`load`] promises that all coordinates are finite and within 100 km, that no edge's ends coincide, and that every
//! index has its vertex; [`save`] refuses a world that breaks a promise.

use super::{Surfaces, WireframeWorld};
use crate::whole_file;
use edgeloc::geometry::{Point3, Polarity, Segment3};
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

const MAGIC: [u8; 8] = *b"edgewrld";
const VERSION: u32 = 1;
const HEADER_BYTES: usize = 36;
const CRC_FROM: usize = 16;
const EDGE_BYTES: usize = 28;
const VERTEX_BYTES: usize = 12;
const TRIANGLE_BYTES: usize = 12;
const CRC: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

/// Largest world file, in bytes: 2 GiB, some 50 million triangles.
const MAX_FILE_BYTES: u64 = 2 << 30;

/// Largest magnitude of a coordinate, in metres.
const MAX_COORDINATE_M: f32 = 100_000.0;

/// Why a world file can't be written or read.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}", path.display())]
pub struct WorldFileError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub fault: WorldFileFault,
}

/// What is wrong with a world file.
#[derive(Debug, thiserror::Error)]
pub enum WorldFileFault {
    /// The system refused to read or write.
    #[error("{0}")]
    Io(#[from] std::io::Error),
    /// The file does not begin like a world file.
    #[error(
        "not a world file: it does not begin with 'edgewrld'; give a file made by 'world generate' or 'world import'"
    )]
    Magic,
    /// The file was written by another version of the program.
    #[error("version {found}, this program reads {VERSION}: generate or import the world again")]
    Version {
        /// The version the file states.
        found: u32,
    },
    /// The bytes are not those that were written.
    #[error("damaged: its checksum is {computed:08x}, it states {stated:08x}; generate or import the world again")]
    Checksum {
        /// The checksum in the file.
        stated: u32,
        /// The checksum of the bytes in the file.
        computed: u32,
    },
    /// The file's length is not what its counts need.
    #[error(
        "it has {found} bytes, its header needs {needed}: it is cut short or damaged; generate or import the world again"
    )]
    Length {
        /// Bytes in the file.
        found: u64,
        /// Bytes that the header's counts need.
        needed: u64,
    },
    /// The world is larger than the format allows.
    #[error("larger than a world file may be ({MAX_FILE_BYTES} bytes): simplify the world's meshes")]
    TooLarge,
    /// The name or the origin is not UTF-8.
    #[error("its {0} is not UTF-8 text: generate or import the world again")]
    Text(&'static str),
    /// An edge or vertex breaks a promise.
    #[error("{what} {index} {why}: generate or import the world again")]
    Element {
        /// Edge, vertex or triangle.
        what: &'static str,
        /// Which one.
        index: usize,
        /// What is wrong with it.
        why: &'static str,
    },
}

/// Writes `world` to `path`, whole or not at all: to a temporary file beside it, which then takes its name.
///
/// # Errors
/// When the world breaks a promise of the format, or the system refuses.
pub fn save(world: &WireframeWorld, path: &Path) -> Result<(), WorldFileError> {
    let write = || {
        check(world)?;
        let bytes = encode(world)?;
        Ok(whole_file::write(path, &bytes)?)
    };
    write().map_err(|fault| WorldFileError { path: path.to_path_buf(), fault })
}

/// Reads the world in `path`.
///
/// # Errors
/// When the file can't be read, was written by another version, is damaged, or breaks a promise of the format.
pub fn load(path: &Path) -> Result<WireframeWorld, WorldFileError> {
    let read = || {
        // Asked before opening: opening a pipe waits for a writer.
        if !fs::metadata(path)?.is_file() {
            return Err(std::io::Error::other("not a file").into());
        }
        let file = File::open(path)?;
        let mut bytes = Vec::new();
        file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > MAX_FILE_BYTES {
            return Err(WorldFileFault::TooLarge);
        }
        decode(&bytes)
    };
    read().map_err(|fault| WorldFileError { path: path.to_path_buf(), fault })
}

/// The bytes of a world.
fn encode(world: &WireframeWorld) -> Result<Vec<u8>, WorldFileFault> {
    let counts = [
        world.name.len(),
        world.origin.len(),
        world.edges.len(),
        world.surfaces.vertices.len(),
        world.surfaces.triangles.len(),
    ];
    let mut header = [0; 5];
    for (field, count) in header.iter_mut().zip(counts) {
        *field = u32::try_from(count).map_err(|_| WorldFileFault::TooLarge)?;
    }
    let length = file_length(header);
    if length > MAX_FILE_BYTES {
        return Err(WorldFileFault::TooLarge);
    }

    let mut bytes = Vec::with_capacity(length as usize);
    bytes.extend(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend([0; 4]);
    bytes.extend(header.iter().flat_map(|field| field.to_le_bytes()));
    bytes.extend(world.name.as_bytes());
    bytes.extend(world.origin.as_bytes());
    for edge in &world.edges {
        push_point(&mut bytes, edge.start);
        push_point(&mut bytes, edge.end);
        let polarity: u32 = match edge.polarity {
            Polarity::LeftBrighter => 0,
            Polarity::RightBrighter => 1,
        };
        bytes.extend(polarity.to_le_bytes());
    }
    world.surfaces.vertices.iter().for_each(|&vertex| push_point(&mut bytes, vertex));
    bytes.extend(world.surfaces.triangles.iter().flatten().flat_map(|index| index.to_le_bytes()));
    let checksum = CRC.checksum(&bytes[CRC_FROM..]);
    bytes[12..16].copy_from_slice(&checksum.to_le_bytes());
    Ok(bytes)
}

fn push_point(bytes: &mut Vec<u8>, point: Point3) {
    bytes.extend([point.x, point.y, point.z].iter().flat_map(|coordinate| coordinate.to_le_bytes()));
}

/// Length of a file with these header fields, in bytes.
fn file_length([name, origin, edges, vertices, triangles]: [u32; 5]) -> u64 {
    // Five counts below 2^32 of at most 28 bytes each stay far below 2^64.
    HEADER_BYTES as u64
        + u64::from(name)
        + u64::from(origin)
        + u64::from(edges) * EDGE_BYTES as u64
        + u64::from(vertices) * VERTEX_BYTES as u64
        + u64::from(triangles) * TRIANGLE_BYTES as u64
}

/// The world that `bytes` hold; everything the module promises is checked here.
fn decode(bytes: &[u8]) -> Result<WireframeWorld, WorldFileFault> {
    if !bytes.starts_with(&MAGIC) {
        return Err(WorldFileFault::Magic);
    }
    let Some(header) = bytes.first_chunk::<HEADER_BYTES>() else {
        return Err(WorldFileFault::Length { found: bytes.len() as u64, needed: HEADER_BYTES as u64 });
    };
    let version = u32_at(header, 8);
    if version != VERSION {
        return Err(WorldFileFault::Version { found: version });
    }
    let fields = [16, 20, 24, 28, 32].map(|offset| u32_at(header, offset));
    let (found, needed) = (bytes.len() as u64, file_length(fields));
    if found != needed {
        return Err(WorldFileFault::Length { found, needed });
    }
    let (stated, computed) = (u32_at(header, 12), CRC.checksum(&bytes[CRC_FROM..]));
    if stated != computed {
        return Err(WorldFileFault::Checksum { stated, computed });
    }

    // The counts agree with the length, so every split below stays inside.
    let [name_length, origin_length, edge_count, vertex_count, _] = fields.map(|field| field as usize);
    let (name, rest) = bytes[HEADER_BYTES..].split_at(name_length);
    let (origin, rest) = rest.split_at(origin_length);
    let (edges, rest) = rest.split_at(edge_count * EDGE_BYTES);
    let (vertices, triangles) = rest.split_at(vertex_count * VERTEX_BYTES);
    let text =
        |bytes: &[u8], what| std::str::from_utf8(bytes).map(str::to_owned).map_err(|_| WorldFileFault::Text(what));
    let edges = edges.chunks_exact(EDGE_BYTES).enumerate().map(|(index, edge)| {
        let polarity = match u32_at(edge, 24) {
            0 => Polarity::LeftBrighter,
            1 => Polarity::RightBrighter,
            _ => return Err(WorldFileFault::Element { what: "edge", index, why: "has an unknown polarity" }),
        };
        Ok(Segment3 { start: point_at(edge, 0), end: point_at(edge, 12), polarity })
    });
    let world = WireframeWorld {
        name: text(name, "name")?,
        origin: text(origin, "origin")?,
        edges: edges.collect::<Result<_, _>>()?,
        surfaces: Surfaces {
            vertices: vertices.chunks_exact(VERTEX_BYTES).map(|vertex| point_at(vertex, 0)).collect(),
            triangles: triangles
                .chunks_exact(TRIANGLE_BYTES)
                .map(|triangle| [0, 4, 8].map(|offset| u32_at(triangle, offset)))
                .collect(),
        },
        reference_viewpoints: None,
    };
    check(&world)?;
    Ok(world)
}

/// Whether `world` keeps the promises of the format.
fn check(world: &WireframeWorld) -> Result<(), WorldFileFault> {
    let fault = |what, index, why| Err(WorldFileFault::Element { what, index, why });
    let fits =
        |point: Point3| [point.x, point.y, point.z].iter().all(|coordinate| coordinate.abs() <= MAX_COORDINATE_M);
    const FAR: &str = "has a coordinate that is not a number or beyond 100 km";
    for (index, edge) in world.edges.iter().enumerate() {
        if !fits(edge.start) || !fits(edge.end) {
            return fault("edge", index, FAR);
        }
        if edge.start == edge.end {
            return fault("edge", index, "has coinciding ends");
        }
    }
    let vertices = &world.surfaces.vertices;
    if let Some(index) = vertices.iter().position(|&vertex| !fits(vertex)) {
        return fault("vertex", index, FAR);
    }
    let has_vertex = |index: &u32| (*index as usize) < vertices.len();
    if let Some(index) = world.surfaces.triangles.iter().position(|triangle| !triangle.iter().all(has_vertex)) {
        return fault("triangle", index, "names a vertex that is not there");
    }
    Ok(())
}

fn u32_at(bytes: &[u8], offset: usize) -> u32 {
    u32::from_le_bytes([bytes[offset], bytes[offset + 1], bytes[offset + 2], bytes[offset + 3]])
}

fn point_at(bytes: &[u8], offset: usize) -> Point3 {
    let [x, y, z] = [0, 4, 8].map(|next| f32::from_bits(u32_at(bytes, offset + next)));
    Point3::new(x, y, z)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn world() -> WireframeWorld {
        let point = Point3::new;
        WireframeWorld {
            name: "hütte".to_owned(),
            origin: "a test".to_owned(),
            edges: vec![
                Segment3 {
                    start: point(0.0, -1.5, 2.0),
                    end: point(1.0, 0.1, f32::MIN_POSITIVE),
                    polarity: Polarity::LeftBrighter,
                },
                Segment3 { start: point(3.0, 0.0, 0.0), end: point(3.0, 0.0, 2.5), polarity: Polarity::RightBrighter },
            ],
            surfaces: Surfaces {
                vertices: vec![point(0.0, 0.0, 0.0), point(1.0, 0.0, 0.0), point(0.0, 1.0, 0.0)],
                triangles: vec![[0, 1, 2], [2, 1, 0]],
            },
            reference_viewpoints: None,
        }
    }

    #[test]
    fn a_world_comes_back_as_it_was_saved() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.edgeworld");
        for world in [world(), WireframeWorld::default()] {
            save(&world, &path).expect("the world is sound");
            assert_eq!(load(&path).expect("what was saved loads"), world);
        }
        assert_eq!(fs::read_dir(folder.path()).expect("the folder is there").count(), 1, "no temporary file is left");
    }

    #[test]
    fn the_bytes_are_laid_as_documented() {
        let bytes = encode(&world()).expect("the world is small");
        assert_eq!(bytes.len(), 36 + 6 + 6 + 2 * 28 + 3 * 12 + 2 * 12);
        assert_eq!(bytes[..12], *b"edgewrld\x01\0\0\0");
        assert_eq!(bytes[16..36], [6, 0, 0, 0, 6, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 2, 0, 0, 0]);
        assert_eq!(bytes[36..42], *"hütte".as_bytes());
        assert_eq!(bytes[52..56], (-1.5_f32).to_le_bytes());
        assert_eq!(bytes[100..104], [1, 0, 0, 0]);
    }

    #[test]
    fn every_truncation_and_every_flipped_bit_is_refused() {
        let bytes = encode(&world()).expect("the world is small");
        for length in 0..bytes.len() {
            assert!(decode(&bytes[..length]).is_err(), "cut to {length} bytes");
        }
        for bit in 0..bytes.len() * 8 {
            let mut flipped = bytes.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            assert!(decode(&flipped).is_err(), "bit {bit} flipped");
        }
        let mut longer = bytes;
        longer.push(0);
        assert!(decode(&longer).is_err());
    }

    /// `bytes` with the four at `offset` replaced and the checksum put right again.
    fn forged(offset: usize, value: [u8; 4]) -> Vec<u8> {
        let mut bytes = encode(&world()).expect("the world is small");
        bytes[offset..offset + 4].copy_from_slice(&value);
        let checksum = CRC.checksum(&bytes[CRC_FROM..]);
        bytes[12..16].copy_from_slice(&checksum.to_le_bytes());
        bytes
    }

    #[test]
    fn sound_checksums_do_not_excuse_bad_content() {
        let message = |bytes: &[u8]| decode(bytes).expect_err("the content is bad").to_string();
        assert!(message(&forged(8, 3_u32.to_le_bytes())).starts_with("version 3, this program reads 1"));
        assert!(message(&forged(24, u32::MAX.to_le_bytes())).contains("its header needs 120259084"));
        assert!(message(&forged(36, [0xff; 4])).contains("name is not UTF-8"));
        assert!(
            message(&forged(48, f32::NAN.to_le_bytes())).starts_with("edge 0 has a coordinate that is not a number")
        );
        assert!(message(&forged(72, 7_u32.to_le_bytes())).starts_with("edge 0 has an unknown polarity"));
        assert!(message(&forged(104, f32::INFINITY.to_le_bytes())).starts_with("vertex 0 has a coordinate"));
        assert!(message(&forged(140, 3_u32.to_le_bytes())).starts_with("triangle 0 names a vertex"));
    }

    #[test]
    fn an_unsound_world_is_not_saved_and_leaves_the_old_file() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.edgeworld");
        save(&world(), &path).expect("the world is sound");
        let mut unsound = world();
        unsound.edges[1].end = unsound.edges[1].start;
        let error = save(&unsound, &path).expect_err("an edge without length").to_string();
        assert!(error.contains("edge 1 has coinciding ends"), "{error}");
        assert_eq!(load(&path).expect("the old file is whole"), world());
    }

    #[test]
    fn a_missing_file_and_a_folder_are_named() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let missing = folder.path().join("missing.edgeworld");
        assert!(load(&missing).expect_err("nothing there").to_string().contains("missing.edgeworld"));
        assert!(load(folder.path()).is_err());
    }
}

//! Golden vectors: attempts recorded once, with what the localizer answered, for every machine to agree with.
//!
//! Files in `tests/fixtures/golden/`: a map of a few nodes of the generated office, with an index, the looks of some hundred
//! attempts in it ([`edgeloc_firmware::looks`]), and one line of text for each look with the decision and all scores.
//! `joined.map` has the same nodes as the verifying localizer's preset learns them; instructions are counted on it.
//! `kernels.txt` holds what the [kernels](edgeloc_firmware::run_kernels) make of drawn inputs. Boards hold all of these in
//! flash and compare; a test holds them against what is made today. The last, `learned.txt`, pins what robots
//! [learn](learned()) by themselves, on the host alone.

mod attempts;
mod learned;
mod looks_writer;
mod site;

use std::path::PathBuf;
use std::{fs, io};

use edgeloc_firmware::MEMORY_WORDS;

pub use learned::learned;

/// The golden vectors in memory.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Golden {
    /// Bytes of the topological database.
    pub map: Vec<u8>,
    /// Bytes of the database of the same nodes, as the verifying localizer's maps are learned.
    pub joined_map: Vec<u8>,
    /// Bytes of the looks.
    pub looks: Vec<u8>,
    /// A line for each look.
    pub expected: String,
    /// A line for each kind of input that the kernels are tried with.
    pub kernels: String,
    /// A line for each batch of corners and each step of an exploration.
    pub learned: String,
}

impl Golden {
    /// Makes them anew from the office, the rig, the uncertainty sources and the localizer as they are today.
    #[must_use]
    pub fn make() -> Self {
        let site = site::Site::office();
        let map = site.learn();
        let looks = looks_writer::write(&attempts::all(&site));
        let mut expected = String::new();
        let mut memory = vec![0; MEMORY_WORDS];
        edgeloc_firmware::replay(&map, &looks, &mut memory, |line| {
            expected.push_str(line);
            expected.push('\n');
        })
        .expect("looks just written can be replayed");
        let mut kernels = String::new();
        edgeloc_firmware::run_kernels(|line| {
            kernels.push_str(line);
            kernels.push('\n');
        });
        Self { map, joined_map: site.learn_joined(), looks, expected, kernels, learned: learned() }
    }

    /// Reads the committed ones.
    ///
    /// # Errors
    /// When a file is missing or can't be read.
    pub fn load() -> io::Result<Self> {
        let [map, joined_map, looks, expected, kernels, learned] = Self::paths();
        Ok(Self {
            map: fs::read(map)?,
            joined_map: fs::read(joined_map)?,
            looks: fs::read(looks)?,
            expected: fs::read_to_string(expected)?,
            kernels: fs::read_to_string(kernels)?,
            learned: fs::read_to_string(learned)?,
        })
    }

    /// Replaces the committed ones.
    ///
    /// # Errors
    /// When a file can't be written.
    pub fn save(&self) -> io::Result<()> {
        let [map, joined_map, looks, expected, kernels, learned] = Self::paths();
        fs::write(kernels, &self.kernels)?;
        fs::write(learned, &self.learned)?;
        fs::write(map, &self.map)?;
        fs::write(joined_map, &self.joined_map)?;
        fs::write(looks, &self.looks)?;
        fs::write(expected, &self.expected)
    }

    fn paths() -> [PathBuf; 6] {
        let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/fixtures/golden"));
        ["office.map", "joined.map", "looks.bin", "expected.txt", "kernels.txt", "learned.txt"]
            .map(|name| folder.join(name))
    }
}

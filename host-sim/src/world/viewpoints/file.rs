//! The view-dependency file, `.views`: text that a person can read, edit and compare line by line.
//!
//! UTF-8, one statement a line, words parted by blanks. Empty lines and everything after a `#` are left out. First four
//! statements in this order, then the viewpoints:
//!
//! | statement | what |
//! |---|---|
//! | `edgeloc-views 1` | the format and its version; a reader of version 1 refuses every other |
//! | `world CHECKSUM NAME` | the world it is for: CRC-64 of its edges and surfaces, 16 hexadecimal digits, as `edgeloc world info` prints it, then its name, to the end of the line |
//! | `edges COUNT` | how many edges that world has |
//! | `height METRES` | height of the eye above the floor |
//! | `viewpoint ID X Y` | a reference viewpoint: its number, unique in the file, and its place in the world frame in metres |
//! | `sees EDGES...` | edges visible from the viewpoint above it: numbers, counted from 0 as in the world file, and ranges `FIRST-LAST` with both ends |
//!
//! A viewpoint may have any count of `sees` lines, and none when nothing is visible from it. Edges may come in any
//! order; one named twice is visible as if named once. What is not named is hidden. An edge is visible as a whole or
//! hidden as a whole, in whatever direction the camera looks; the image alone cuts it.
//!
//! [`save`] writes viewpoints in their order, edges in theirs, and begins a new `sees` line at each hundred, so that a
//! changed edge changes one line. Comments are not kept. An example:
//!
//! ```text
//! edgeloc-views 1
//! world 00f1e2d3c4b5a697 two rooms   # made by edgeloc world visibility
//! edges 250
//! height 1
//!
//! viewpoint 0 0.75 1.5
//! sees 0-3 7 90-99
//! sees 100-112 120
//!
//! viewpoint 1 4 -2.25   # in the store room: nothing but a dark wall
//! ```
//!
//! Limits: 64 MiB, 10,000 viewpoints, coordinates within 100 km.

use super::{EdgeSet, ReferenceViewpoint, ReferenceViewpoints};
use crate::whole_file;
use edgeloc::geometry::Point2;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::Read;
use std::ops::Range;
use std::path::{Path, PathBuf};

const FORMAT: &str = "edgeloc-views";
const VERSION: &str = "1";

/// Largest file, in bytes.
const MAX_FILE_BYTES: u64 = 64 << 20;

/// The most viewpoints of a file.
pub const MAX_VIEWPOINTS: usize = 10_000;

/// Largest magnitude of a coordinate, in metres.
const MAX_COORDINATE_M: f32 = 100_000.0;

/// Edges whose visibility shares a line.
const EDGES_A_LINE: u32 = 100;

/// Why a view-dependency file can't be written or read.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}", path.display())]
pub struct ViewsFileError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub fault: ViewsFileFault,
}

/// What is wrong with a view-dependency file.
#[derive(Debug, thiserror::Error)]
pub enum ViewsFileFault {
    /// The system refused to read or write.
    #[error("{0}")]
    Io(#[from] std::io::Error),
    /// The file is longer than any of its kind.
    #[error("longer than a view-dependency file may be ({MAX_FILE_BYTES} bytes)")]
    TooLong,
    /// The file is not text.
    #[error("not a view-dependency file: it is not UTF-8 text; `edgeloc world visibility` writes one")]
    NotText,
    /// A line can't be understood.
    #[error("line {line}: {reason}")]
    Line {
        /// The line, from 1; the one after the last when something is missing at the end.
        line: usize,
        /// What is wrong, and what would be right.
        reason: String,
    },
}

/// Reads the viewpoints in `path`.
///
/// # Errors
/// When the file can't be read or a line of it can't be understood.
pub fn load(path: &Path) -> Result<ReferenceViewpoints, ViewsFileError> {
    let read = || {
        // Asked before opening: opening a pipe waits for a writer.
        if !fs::metadata(path)?.is_file() {
            return Err(std::io::Error::other("not a file").into());
        }
        let mut bytes = Vec::new();
        File::open(path)?.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > MAX_FILE_BYTES {
            return Err(ViewsFileFault::TooLong);
        }
        parse(&String::from_utf8(bytes).map_err(|_| ViewsFileFault::NotText)?)
    };
    read().map_err(|fault| ViewsFileError { path: path.to_path_buf(), fault })
}

/// Writes the viewpoints to `path`, whole or not at all.
///
/// # Errors
/// When the system refuses, or they are more than a file may hold.
pub fn save(viewpoints: &ReferenceViewpoints, path: &Path) -> Result<(), ViewsFileError> {
    let write = || {
        let text = to_text(viewpoints);
        if text.len() as u64 > MAX_FILE_BYTES {
            return Err(ViewsFileFault::TooLong);
        }
        Ok(whole_file::write(path, text.as_bytes())?)
    };
    write().map_err(|fault| ViewsFileError { path: path.to_path_buf(), fault })
}

/// The text of the file.
#[must_use]
pub fn to_text(viewpoints: &ReferenceViewpoints) -> String {
    let ReferenceViewpoints { world_name, world_checksum, edge_count, camera_height_m, viewpoints } = viewpoints;
    // A name that the format can't hold as it is, is only told less exactly: the checksum decides.
    let name = world_name.replace(|c: char| c.is_control() || c == '#', " ");
    let name = name.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut text = format!("{FORMAT} {VERSION}\nworld {world_checksum:016x} {name}");
    text.truncate(text.trim_end().len());
    let mut write = |arguments: std::fmt::Arguments<'_>| {
        text.write_fmt(arguments).expect("a string takes all that is written");
    };
    write(format_args!("\nedges {edge_count}\nheight {camera_height_m}\n"));
    for ReferenceViewpoint { id, position, visible } in viewpoints {
        write(format_args!("\nviewpoint {id} {} {}\n", position.x, position.y));
        let mut line_of = None;
        for Range { start, end } in visible.ranges().iter().flat_map(cut_at_hundreds) {
            let line = start / EDGES_A_LINE;
            match line_of {
                Some(same) if same == line => write(format_args!(" {start}")),
                Some(_) => write(format_args!("\nsees {start}")),
                None => write(format_args!("sees {start}")),
            }
            if end - start > 1 {
                write(format_args!("-{}", end - 1));
            }
            line_of = Some(line);
        }
        if line_of.is_some() {
            write(format_args!("\n"));
        }
    }
    text
}

/// The parts of a range between the hundreds.
fn cut_at_hundreds(range: &Range<u32>) -> impl Iterator<Item = Range<u32>> + use<> {
    let Range { mut start, end } = *range;
    std::iter::from_fn(move || {
        let next = end.min((start / EDGES_A_LINE + 1).saturating_mul(EDGES_A_LINE));
        let part = start..next;
        start = next;
        (!part.is_empty()).then_some(part)
    })
}

/// The viewpoints that `text` describes.
///
/// # Errors
/// The first line that can't be understood.
pub fn parse(text: &str) -> Result<ReferenceViewpoints, ViewsFileFault> {
    let mut last_line = 0;
    let mut reader = Reader::default();
    for (line, content) in (1..).zip(text.lines()) {
        last_line = line;
        let statement = content.split('#').next().unwrap_or_default().trim();
        if !statement.is_empty() {
            reader.read(statement).map_err(|reason| ViewsFileFault::Line { line, reason })?;
        }
    }
    reader.finish().map_err(|reason| ViewsFileFault::Line { line: last_line + 1, reason })
}

/// What was read so far.
#[derive(Default)]
struct Reader {
    /// Statements of the head that were read.
    head: usize,
    world_checksum: u64,
    world_name: String,
    edge_count: u32,
    camera_height_m: f32,
    ids: BTreeSet<u32>,
    viewpoints: Vec<ReferenceViewpoint>,
    /// Edges of the last viewpoint.
    seen: Vec<Range<u32>>,
}

impl Reader {
    fn read(&mut self, statement: &str) -> Result<(), String> {
        let (keyword, rest) = statement.split_once(char::is_whitespace).unwrap_or((statement, ""));
        let rest = rest.trim();
        match (self.head, keyword) {
            (0, FORMAT) if rest == VERSION => {}
            (0, FORMAT) => {
                return Err(format!(
                    "version {rest:.20}, this program reads {VERSION}: make the file again with `edgeloc world visibility`"
                ));
            }
            (0, _) => {
                return Err(format!(
                    "not a view-dependency file: it does not begin with `{FORMAT} {VERSION}`; `edgeloc world visibility` \
                     writes one"
                ));
            }
            (1, "world") => {
                let (checksum, name) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
                let is_checksum = checksum.len() == 16 && checksum.bytes().all(|byte| byte.is_ascii_hexdigit());
                let parsed = u64::from_str_radix(checksum, 16).ok().filter(|_| is_checksum);
                self.world_checksum = parsed.ok_or("write `world CHECKSUM NAME` with 16 hexadecimal digits")?;
                self.world_name = name.trim().to_owned();
            }
            (2, "edges") => self.edge_count = rest.parse().map_err(|_| "write `edges COUNT`, below 4294967296")?,
            (3, "height") => self.camera_height_m = metres(rest).ok_or("write `height METRES`, within 100 km")?,
            (4, "viewpoint") => return self.begin_viewpoint(rest),
            (4, "sees") if self.viewpoints.is_empty() => {
                return Err("`sees` before the first `viewpoint`: nobody to see it".to_owned());
            }
            (4, "sees") => return self.add_edges(rest),
            (head, _) => {
                let expected = ["world", "edges", "height"].get(head - 1).map_or_else(
                    || "`viewpoint ID X Y` or `sees EDGES...`".to_owned(),
                    |keyword| format!("`{keyword}`"),
                );
                return Err(format!("{keyword:.20?} where {expected} should be"));
            }
        }
        self.head += 1;
        Ok(())
    }

    fn begin_viewpoint(&mut self, rest: &str) -> Result<(), String> {
        self.end_viewpoint();
        let [id, x, y] = rest.split_whitespace().collect::<Vec<_>>()[..] else {
            return Err("write `viewpoint ID X Y`".to_owned());
        };
        let id = id.parse().map_err(|_| format!("{id:.20?} is no number of a viewpoint: write 0, 1, 2, ..."))?;
        let place = |text: &str| metres(text).ok_or_else(|| format!("{text:.20?} is no coordinate within 100 km"));
        let position = Point2::new(place(x)?, place(y)?);
        if self.viewpoints.len() == MAX_VIEWPOINTS {
            return Err(format!("more than {MAX_VIEWPOINTS} viewpoints"));
        }
        if !self.ids.insert(id) {
            return Err(format!("viewpoint {id} is there already: number each differently"));
        }
        self.viewpoints.push(ReferenceViewpoint { id, position, visible: EdgeSet::default() });
        Ok(())
    }

    fn add_edges(&mut self, rest: &str) -> Result<(), String> {
        for word in rest.split_whitespace() {
            let (first, last) = word.split_once('-').unwrap_or((word, word));
            let edge = |text: &str| {
                let edge = text.parse::<u32>().map_err(|_| format!("{word:.20?} is no edge: write 7, or 7-9"))?;
                if edge < self.edge_count {
                    Ok(edge)
                } else {
                    Err(format!("there is no edge {edge}: the world has {} (counted from 0)", self.edge_count))
                }
            };
            let (first, last) = (edge(first)?, edge(last)?);
            if first > last {
                return Err(format!("{word:.30?} runs backwards: write {last}-{first}"));
            }
            self.seen.push(first..last + 1);
        }
        Ok(())
    }

    fn end_viewpoint(&mut self) {
        if let Some(viewpoint) = self.viewpoints.last_mut() {
            viewpoint.visible = self.seen.drain(..).collect();
        }
    }

    fn finish(mut self) -> Result<ReferenceViewpoints, String> {
        self.end_viewpoint();
        if self.viewpoints.is_empty() {
            return Err("the file ends before its first viewpoint: it is cut short, or no file of this kind".to_owned());
        }
        let Self { world_name, world_checksum, edge_count, camera_height_m, viewpoints, .. } = self;
        Ok(ReferenceViewpoints { world_name, world_checksum, edge_count, camera_height_m, viewpoints })
    }
}

/// A finite number of metres in range.
fn metres(text: &str) -> Option<f32> {
    text.parse::<f32>().ok().filter(|metres| metres.abs() <= MAX_COORDINATE_M)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The example of the documentation above.
    fn example() -> String {
        let source = include_str!("file.rs");
        let (_, rest) = source.split_once("```text\n").expect("the example begins");
        let (example, _) = rest.split_once("//! ```").expect("the example ends");
        example.lines().map(|line| line.trim_start_matches("//!").trim_start().to_owned() + "\n").collect()
    }

    #[test]
    fn the_example_of_the_documentation_reads_as_it_says_and_is_written_back_without_comments() {
        let viewpoints = parse(&example()).expect("the example is right");
        assert_eq!(viewpoints.world_checksum, 0x00f1_e2d3_c4b5_a697);
        assert_eq!((viewpoints.world_name.as_str(), viewpoints.edge_count), ("two rooms", 250));
        let [first, second] = viewpoints.viewpoints() else { panic!("two viewpoints") };
        assert_eq!((first.id, first.position), (0, Point2::new(0.75, 1.5)));
        assert_eq!(first.visible.ranges(), [0..4, 7..8, 90..113, 120..121]);
        assert_eq!((second.id, second.position), (1, Point2::new(4.0, -2.25)));
        assert!(second.visible.is_empty());
        let without_comment = |line: &str| line.split('#').next().unwrap_or_default().trim_end().to_owned() + "\n";
        assert_eq!(to_text(&viewpoints), example().lines().map(without_comment).collect::<String>());
    }

    #[test]
    fn a_file_comes_back_as_it_was_saved() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.views");
        let viewpoints = parse(&example()).expect("the example is right");
        save(&viewpoints, &path).expect("there is room");
        assert_eq!(load(&path).expect("what was saved loads"), viewpoints);
        assert_eq!(fs::read_dir(folder.path()).expect("the folder is there").count(), 1, "no temporary file is left");
        assert!(load(folder.path()).expect_err("a folder").to_string().contains("not a file"));
    }

    #[test]
    fn a_changed_edge_changes_one_line() {
        let text = "edgeloc-views 1\nworld 0000000000000000 w\nedges 1000\nheight 1\n\nviewpoint 0 0 0\nsees 0-999\n";
        let mut viewpoints = parse(text).expect("right");
        let before = to_text(&viewpoints);
        viewpoints.set_visible(0, [250], false);
        let after = to_text(&viewpoints);
        let changed = before.lines().zip(after.lines()).filter(|(before, after)| before != after);
        assert_eq!(changed.collect::<Vec<_>>(), [("sees 200-299", "sees 200-249 251-299")]);
        assert_eq!(before.lines().count(), after.lines().count());
    }

    #[test]
    fn errors_name_the_line_and_what_would_be_right() {
        let head = "edgeloc-views 1\nworld 0123456789abcdef w\nedges 20\nheight 1\n";
        for (text, expected) in [
            (String::new(), "line 1: the file ends before its first viewpoint"),
            ("edgewrld".to_owned(), "line 1: not a view-dependency file"),
            ("\n# so\nedgeloc-views 2\n".to_owned(), "line 3: version 2, this program reads 1"),
            ("edgeloc-views 1\nedges 3\n".to_owned(), "line 2: \"edges\" where `world` should be"),
            ("edgeloc-views 1\nworld 12 w\n".to_owned(), "line 2: write `world CHECKSUM NAME`"),
            ("edgeloc-views 1\nworld +123456789abcdef w\n".to_owned(), "line 2: write `world CHECKSUM NAME`"),
            (head.replace("20", "-1"), "line 3: write `edges COUNT`"),
            (head.replace("height 1", "height nan"), "line 4: write `height METRES`"),
            (head.to_owned(), "line 5: the file ends"),
            (format!("{head}sees 3\n"), "line 5: `sees` before the first `viewpoint`"),
            (format!("{head}viewpoint 0 1\n"), "line 5: write `viewpoint ID X Y`"),
            (format!("{head}viewpoint 0 1 inf\n"), "line 5: \"inf\" is no coordinate"),
            (format!("{head}viewpoint 0 1 2\nsees 3-x\n"), "line 6: \"3-x\" is no edge"),
            (format!("{head}viewpoint 0 1 2\nsees 19\nsees 20\n"), "line 7: there is no edge 20: the world has 20"),
            (format!("{head}viewpoint 0 1 2\nsees 9-3\n"), "line 6: \"9-3\" runs backwards: write 3-9"),
            (format!("{head}viewpoint 0 1 2\nviewpoint 0 1 2\n"), "line 6: viewpoint 0 is there already"),
            (format!("{head}viewpoint 0 1 2\nlooks 3\n"), "line 6: \"looks\" where `viewpoint ID X Y` or"),
        ] {
            let message = parse(&text).expect_err("wrong").to_string();
            assert!(message.starts_with(expected), "{message:?} is not {expected:?}");
        }
    }

    #[test]
    fn a_world_of_an_awkward_name_is_written_so_that_it_reads_back() {
        let mut viewpoints = parse(&example()).expect("right");
        for name in ["", " a\n#b ", "\u{7f}"] {
            name.clone_into(&mut viewpoints.world_name);
            let back = parse(&to_text(&viewpoints)).expect("what is written reads back");
            assert_eq!(back.viewpoints, viewpoints.viewpoints);
        }
    }

    proptest! {
        #[test]
        fn no_text_whatever_makes_the_reader_panic(words in prop::collection::vec(
            prop_oneof![
                Just("edgeloc-views 1\n".to_owned()), Just("world 0123456789abcdef w\n".to_owned()),
                Just("edges 4294967295\n".to_owned()), Just("height 1\n".to_owned()), Just("viewpoint 0 1 2\n".to_owned()),
                Just("sees 0-4294967294\n".to_owned()), Just("sees 4294967295 ".to_owned()), "\\PC{0,12}", "[-0-9 \n#]{0,12}",
            ], 0..12
        )) {
            let text = words.concat();
            let with_head = format!("edgeloc-views 1\nworld 0123456789abcdef w\nedges 4294967295\nheight 1\n{text}");
            for text in [text, with_head] {
                if let Ok(viewpoints) = parse(&text) {
                    prop_assert_eq!(parse(&to_text(&viewpoints)).expect("it reads back"), viewpoints);
                }
            }
        }
    }
}

//! Wavefront OBJ: vertices, faces, lines and the diffuse colours of its material libraries.
//!
//! Read by hand: a face or line that is wrong is named with its line number and the rest is read, and no input can
//! bring the reader down. (The crate `tobj` panics on a colour of fewer than three numbers, takes `l a b c` for a
//! triangle, and names no line.)

use super::library::{FoundFile, Library};
use super::polygon::{MAX_CORNERS, triangulate};
use super::session::{MAX_TRIANGLES, MeshFile};
use super::{ImportProblem, ImportReport, luminance};
use crate::world::mesh::{MID_GREY, Triangle};
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// Statements that say nothing about where surfaces are.
const WITHOUT_GEOMETRY: [&str; 14] =
    ["vt", "vn", "vp", "g", "o", "s", "mg", "lod", "bevel", "c_interp", "d_interp", "usemap", "maplib", "shadow_obj"];

/// Reads an OBJ file in its own unit and axes.
pub(super) fn read(bytes: &[u8], file: &FoundFile, library: &mut Library) -> Result<MeshFile, ImportProblem> {
    // Names may be in any old encoding; numbers and keywords are ASCII.
    let text = String::from_utf8_lossy(bytes);
    let mut reader =
        Reader { file, library, reflectances: BTreeMap::new(), reflectance: MID_GREY, read: MeshFile::default() };
    for (line_number, line) in logical_lines(&text) {
        let mut words = line.split_ascii_whitespace();
        let Some(keyword) = words.next() else { continue };
        let words: Vec<&str> = words.take_while(|word| !word.starts_with('#')).collect();
        reader.statement(line_number, keyword, &words);
        if reader.read.mesh.element_count() > MAX_TRIANGLES {
            let what = format!("more than {MAX_TRIANGLES} triangles or lines");
            return Err(ImportProblem::new(&file.shown, what, "simplify the mesh"));
        }
    }
    Ok(reader.read)
}

/// Lines with their numbers, those that end in a backslash joined with the next.
fn logical_lines(text: &str) -> impl Iterator<Item = (usize, String)> {
    let mut lines = text.lines().enumerate();
    std::iter::from_fn(move || {
        let (index, first) = lines.next()?;
        let mut joined = first.to_owned();
        while joined.ends_with('\\') {
            joined.pop();
            joined.push(' ');
            joined.push_str(lines.next().map_or("", |(_, next)| next));
        }
        Some((index + 1, joined))
    })
}

struct Reader<'r> {
    file: &'r FoundFile,
    library: &'r mut Library,
    /// What the materials met so far return.
    reflectances: BTreeMap<String, f32>,
    /// That of the material in use.
    reflectance: f32,
    read: MeshFile,
}

impl Reader<'_> {
    fn name(&mut self, line_number: usize, what: String, remedy: &str) {
        if self.read.problems.len() <= ImportReport::MAX_PROBLEMS {
            self.read.problems.push(ImportProblem::new(format!("{}:{line_number}", self.file.shown), what, remedy));
        }
    }

    fn statement(&mut self, line_number: usize, keyword: &str, words: &[&str]) {
        match keyword {
            "v" => self.vertex(line_number, words),
            "f" => self.face(line_number, words),
            "l" => self.polyline(line_number, words),
            "usemtl" => {
                self.reflectance = self.reflectances.get(&words.join(" ")).copied().unwrap_or(MID_GREY);
            }
            "mtllib" => words.iter().for_each(|name| self.material_library(line_number, name)),
            comment if comment.starts_with('#') => {}
            other if WITHOUT_GEOMETRY.contains(&other) => {}
            other => {
                let what = format!("the statement '{other}' is not read");
                self.name(line_number, what, "export the mesh as polygons");
            }
        }
    }

    fn vertex(&mut self, line_number: usize, words: &[&str]) {
        let mut point = Vector3::repeat(f64::NAN);
        for (coordinate, word) in point.iter_mut().zip(words) {
            *coordinate = word.parse().unwrap_or(f64::NAN);
        }
        if !point.iter().all(|coordinate: &f64| coordinate.is_finite()) {
            // Kept as NaN, so that later indices still fit; what uses it is left out and counted.
            self.name(line_number, "a vertex is not three finite numbers".to_owned(), "correct the line");
        }
        self.read.mesh.push_vertex(point);
    }

    fn face(&mut self, line_number: usize, words: &[&str]) {
        if words.len() > MAX_CORNERS {
            let what = format!("a face of {} corners, more than {MAX_CORNERS}, is left out", words.len());
            self.name(line_number, what, "split it into triangles on export");
            return;
        }
        let Some(corners) = self.indices(words).filter(|corners| corners.len() >= 3) else {
            self.name(line_number, "a face without three known vertices is left out".to_owned(), "correct the line");
            return;
        };
        let mesh = &mut self.read.mesh;
        let outline: Vec<Vector3<f64>> = corners.iter().map(|&corner| mesh.vertices[corner as usize]).collect();
        let reflectance = self.reflectance;
        let triangles = triangulate(&outline).into_iter().map(|ear| ear.map(|corner| corners[corner]));
        mesh.triangles.extend(triangles.map(|corners| Triangle { corners, reflectance }));
    }

    fn polyline(&mut self, line_number: usize, words: &[&str]) {
        match self.indices(words).filter(|corners| corners.len() >= 2) {
            Some(corners) => self.read.mesh.lines.extend(corners.windows(2).map(|pair| [pair[0], pair[1]])),
            None => self.name(line_number, "a line without two known vertices is left out".to_owned(), "correct it"),
        }
    }

    /// The vertices that words like `7`, `7/1`, `7//3` or `-1` name; `None` if one of them names none.
    fn indices(&self, words: &[&str]) -> Option<Vec<u32>> {
        let count = i64::try_from(self.read.mesh.vertices.len()).ok()?;
        words
            .iter()
            .map(|word| {
                let stated: i64 = word.split('/').next()?.parse().ok()?;
                // Counted from 1, or backwards from the last vertex so far.
                let index = if stated < 0 { count.checked_add(stated)? } else { stated - 1 };
                u32::try_from(index).ok().filter(|&index| i64::from(index) < count)
            })
            .collect()
    }

    fn material_library(&mut self, line_number: usize, name: &str) {
        let mut notes = Vec::new();
        let folder = self.file.path.parent().map(std::path::Path::to_path_buf).unwrap_or_default();
        let bytes = match self.library.find(name, &folder, &mut notes) {
            Ok(found) => self.library.read(&found).map_err(|problem| problem.to_string()),
            Err(what) => Err(what),
        };
        for note in notes {
            self.name(line_number, note, "none needed here; other systems tell letter case");
        }
        match bytes {
            Ok(bytes) => self.materials(&String::from_utf8_lossy(&bytes)),
            Err(what) => {
                let what = format!("no material library: {what}; its surfaces count as mid grey");
                self.name(line_number, what, "put the .mtl file beside the .obj");
            }
        }
    }

    fn materials(&mut self, text: &str) {
        let mut current = String::new();
        for line in text.lines() {
            let words: Vec<&str> = line.split_ascii_whitespace().collect();
            match words.as_slice() {
                ["newmtl", name @ ..] => current = name.join(" "),
                ["Kd", color @ ..] => {
                    let color: Vec<f64> = color.iter().take(3).filter_map(|word| word.parse().ok()).collect();
                    if let Ok(color) = <[f64; 3]>::try_from(color)
                        && color.iter().all(|value| value.is_finite())
                    {
                        self.reflectances.entry(current.clone()).or_insert_with(|| luminance(color));
                    }
                }
                ["map_Kd", ..] => {
                    self.read.textured_material_count += 1;
                    self.reflectances.insert(current.clone(), MID_GREY);
                }
                _ => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn read_text(text: &str) -> MeshFile {
        let file = FoundFile { path: Path::new("a.obj").to_path_buf(), shown: "a.obj".to_owned() };
        let mut library = Library::around(Path::new("a.obj"), &[]).expect("the current folder is there");
        read(text.as_bytes(), &file, &mut library).expect("small files are read")
    }

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    #[test]
    fn faces_and_lines_count_from_one_or_backwards_from_the_last_vertex() {
        let read = read_text(&format!("{SQUARE}f 1/1 2//2 3/3/3 -1\nl 1 \\\n 3 4\n"));
        assert_eq!(read.mesh.triangles.len(), 2);
        assert_eq!(read.mesh.lines, [[0, 2], [2, 3]]);
        assert!(read.problems.is_empty(), "{:?}", read.problems);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line_and_the_rest_is_read() {
        let text =
            format!("{SQUARE}f 1 2 9\nf 1 2\nv one 2 3\nf 1 2 0\nl 1\ncurv 1 2\nf -9223372036854775808 1 2\nf 1 2 3\n");
        let read = read_text(&text);
        assert_eq!(read.mesh.triangles.len(), 1);
        let places: Vec<&str> = read.problems.iter().map(|problem| problem.place.as_str()).collect();
        assert_eq!(places, ["a.obj:5", "a.obj:6", "a.obj:7", "a.obj:8", "a.obj:9", "a.obj:10", "a.obj:11"]);
    }

    #[test]
    fn a_material_counts_by_its_luminance_and_a_picture_as_mid_grey() {
        let file = FoundFile { path: Path::new("a.obj").to_path_buf(), shown: "a.obj".to_owned() };
        let mut library = Library::around(Path::new("a.obj"), &[]).expect("the current folder is there");
        let mut reader = Reader {
            file: &file,
            library: &mut library,
            reflectances: BTreeMap::new(),
            reflectance: MID_GREY,
            read: MeshFile::default(),
        };
        reader.materials("newmtl white\nKd 1 1 1\nnewmtl short\nKd 0.5\nnewmtl wood\nKd 1 1 1\nmap_Kd wood.png\n");
        assert_eq!(reader.reflectances.get("white"), Some(&1.0));
        assert_eq!(reader.reflectances.get("short"), None);
        assert_eq!(reader.reflectances.get("wood"), Some(&MID_GREY));
    }
}

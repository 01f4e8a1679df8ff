//! One `<geometry>` of a Collada file: its positions and the primitives that index them.

use super::ById;
use crate::world::import::polygon::triangulate;
use crate::world::import::session::MAX_TRIANGLES;
use crate::world::import::xml::{Problems, child, children, text};
use nalgebra::Vector3;
use roxmltree::Node;
use std::collections::HashMap;

/// A geometry in the file's own unit and axes.
#[derive(Debug, Default)]
pub(super) struct Geometry {
    pub(super) vertices: Vec<Vector3<f64>>,
    /// Corners and the index of the material symbol.
    pub(super) triangles: Vec<([u32; 3], usize)>,
    pub(super) lines: Vec<[u32; 2]>,
    /// Names of the materials, bound where the geometry is instanced.
    pub(super) symbols: Vec<String>,
}

/// Reads a `<geometry>`; `None` if it is of a kind that is not read, which is then named.
pub(super) fn read<'a>(element: Node<'a, 'a>, by_id: &ById<'a>, problems: &mut Problems<'_>) -> Option<Geometry> {
    let Some(mesh) = child(element, "mesh") else {
        problems.add(
            element,
            "a geometry without <mesh> (a spline or convex hull) is not read",
            "convert it to a mesh",
        );
        return None;
    };
    let mut reader = Reader { by_id, positions: HashMap::new(), geometry: Geometry::default(), bad_count: 0 };
    for part in children(mesh) {
        let name = part.tag_name().name();
        match name {
            "triangles" | "tristrips" | "trifans" | "polylist" | "polygons" | "lines" | "linestrips" => {
                if reader.primitives(part, name).is_none() {
                    problems.add(
                        part,
                        format!("<{name}> names no readable positions and is left out"),
                        "export it again",
                    );
                }
                if reader.geometry.triangles.len() > MAX_TRIANGLES {
                    problems.add(part, format!("cut at {MAX_TRIANGLES} triangles"), "simplify the mesh");
                    break;
                }
                if child(part, "ph").is_some() {
                    problems.add(part, "polygons with holes are read without their holes", "triangulate on export");
                }
            }
            "source" | "vertices" | "extra" => {}
            _ => problems.add(part, format!("<{name}> is not read"), "convert it to triangles"),
        }
    }
    if reader.bad_count > 0 {
        let what =
            format!("{} faces or lines left out: an index is missing, not a number or out of range", reader.bad_count);
        problems.add(element, what, "export the file again; it may be damaged");
    }
    Some(reader.geometry)
}

struct Reader<'r, 'a> {
    by_id: &'r ById<'a>,
    /// First index and count of the vertices read from a source, by its id.
    positions: HashMap<String, (u32, u32)>,
    geometry: Geometry,
    bad_count: usize,
}

/// How the numbers of a `<p>` lead to vertices.
struct Indexing {
    stride: usize,
    offset: usize,
    first: u32,
    count: u32,
}

impl<'a> Reader<'_, 'a> {
    /// Adds the faces or lines of one primitive element; `None` if its positions can't be found.
    fn primitives(&mut self, element: Node<'a, 'a>, kind: &str) -> Option<()> {
        let indexing = self.indexing(element)?;
        let symbol = self.symbol(element.attribute("material").unwrap_or(""));
        let lists = || children(element).filter(|part| part.tag_name().name() == "p");
        match kind {
            "polylist" => {
                let counts: Vec<usize> = child(element, "vcount")
                    .map_or("", text)
                    .split_ascii_whitespace()
                    .map(|word| word.parse().unwrap_or(0))
                    .collect();
                let corners = indices(child(element, "p").map_or("", text), &indexing);
                self.polylist(&counts, &corners, symbol);
            }
            "polygons" => {
                let outlines = lists().chain(children(element).filter_map(|part| child(part, "p")));
                for outline in outlines {
                    let corners = indices(text(outline), &indexing);
                    self.polygon(&corners, symbol);
                }
            }
            _ => {
                for list in lists() {
                    let corners = indices(text(list), &indexing);
                    self.list(kind, &corners, symbol);
                }
            }
        }
        Some(())
    }

    fn polylist(&mut self, counts: &[usize], corners: &[Option<u32>], symbol: usize) {
        let mut rest = corners;
        for &count in counts {
            let Some((face, after)) = rest.split_at_checked(count) else {
                self.bad_count += 1;
                return;
            };
            self.polygon(face, symbol);
            rest = after;
        }
    }

    fn polygon(&mut self, corners: &[Option<u32>], symbol: usize) {
        if let &[a, b, c] = corners {
            return self.triangle([a, b, c], symbol);
        }
        let known: Option<Vec<u32>> = corners.iter().copied().collect();
        let Some(known) = known.filter(|known| known.len() >= 3) else {
            self.bad_count += 1;
            return;
        };
        let outline: Vec<Vector3<f64>> = known.iter().map(|&index| self.geometry.vertices[index as usize]).collect();
        let triangles = triangulate(&outline).into_iter().map(|ear| (ear.map(|corner| known[corner]), symbol));
        self.geometry.triangles.extend(triangles);
    }

    /// Triangles, strips, fans, lines and line strips: all regular walks over the corners.
    fn list(&mut self, kind: &str, corners: &[Option<u32>], symbol: usize) {
        match kind {
            "triangles" => {
                let faces = corners.chunks_exact(3);
                self.bad_count += usize::from(!faces.remainder().is_empty());
                faces.for_each(|face| self.triangle([face[0], face[1], face[2]], symbol));
            }
            "tristrips" => {
                for (index, face) in corners.windows(3).enumerate() {
                    let [a, b] = if index % 2 == 0 { [face[0], face[1]] } else { [face[1], face[0]] };
                    self.triangle([a, b, face[2]], symbol);
                }
            }
            "trifans" => {
                if let Some((&center, rim)) = corners.split_first() {
                    rim.windows(2).for_each(|pair| self.triangle([center, pair[0], pair[1]], symbol));
                }
            }
            "linestrips" => corners.windows(2).for_each(|pair| self.line(pair)),
            _ => corners.chunks_exact(2).for_each(|pair| self.line(pair)),
        }
    }

    fn triangle(&mut self, corners: [Option<u32>; 3], symbol: usize) {
        match corners {
            [Some(a), Some(b), Some(c)] => self.geometry.triangles.push(([a, b, c], symbol)),
            _ => self.bad_count += 1,
        }
    }

    fn line(&mut self, ends: &[Option<u32>]) {
        match *ends {
            [Some(a), Some(b)] => self.geometry.lines.push([a, b]),
            _ => self.bad_count += 1,
        }
    }

    fn symbol(&mut self, name: &str) -> usize {
        let symbols = &mut self.geometry.symbols;
        symbols.iter().position(|known| known == name).unwrap_or_else(|| {
            symbols.push(name.to_owned());
            symbols.len() - 1
        })
    }

    /// Where a primitive's positions are: in the source of its VERTEX input's `<vertices>`.
    fn indexing(&mut self, element: Node<'a, 'a>) -> Option<Indexing> {
        let inputs = || children(element).filter(|part| part.tag_name().name() == "input");
        let offset = |input: Node<'a, 'a>| input.attribute("offset").unwrap_or("0").trim().parse::<usize>().ok();
        let stride = inputs().filter_map(offset).max()?.checked_add(1)?;
        let with = |node: Node<'a, 'a>, semantic: &str| {
            children(node).find(|part| part.attribute("semantic") == Some(semantic))
        };
        let input = with(element, "VERTEX")?;
        let vertices = self.by_id.get("vertices", input.attribute("source")?)?;
        let source = self.by_id.get("source", with(vertices, "POSITION")?.attribute("source")?)?;
        let (first, count) = self.source(source)?;
        Some(Indexing { stride, offset: offset(input)?, first, count })
    }

    /// The vertices of a `<source>`, read once; the first index and the count.
    fn source(&mut self, source: Node<'a, 'a>) -> Option<(u32, u32)> {
        let id = source.attribute("id").unwrap_or("");
        if let Some(&known) = self.positions.get(id) {
            return Some(known);
        }
        let accessor = child(child(source, "technique_common")?, "accessor")?;
        let array =
            child(source, "float_array").or_else(|| self.by_id.get("float_array", accessor.attribute("source")?))?;
        let attribute = |name: &str, default: usize| match accessor.attribute(name) {
            Some(value) => value.trim().parse::<usize>().ok(),
            None => Some(default),
        };
        let (stride, offset) = (attribute("stride", 1)?, attribute("offset", 0)?);
        if stride < 3 {
            return None;
        }
        // What is not a number becomes NaN here and is named when the model is put together.
        let values: Vec<f64> =
            text(array).split_ascii_whitespace().skip(offset).map(|word| word.parse().unwrap_or(f64::NAN)).collect();
        let points = values.chunks(stride).filter_map(|point| point.first_chunk::<3>());
        let first = self.geometry.vertices.len();
        self.geometry.vertices.extend(points.take(attribute("count", usize::MAX)?).map(|&point| Vector3::from(point)));
        let range = (u32::try_from(first).ok()?, u32::try_from(self.geometry.vertices.len() - first).ok()?);
        self.positions.insert(id.to_owned(), range);
        Some(range)
    }
}

/// The vertices that a `<p>` names, one per corner; `None` where an index is bad.
fn indices(list: &str, indexing: &Indexing) -> Vec<Option<u32>> {
    let own = list.split_ascii_whitespace().skip(indexing.offset).step_by(indexing.stride);
    own.map(|word| {
        let index: u32 = word.parse().ok().filter(|&index| index < indexing.count)?;
        indexing.first.checked_add(index)
    })
    .collect()
}

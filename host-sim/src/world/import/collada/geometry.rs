//! One `<geometry>` of a Collada file: its positions and the primitives that index them.

use super::ById;
use crate::world::import::polygon::{MAX_CORNERS, triangulate};
use crate::world::import::session::MAX_TRIANGLES;
use crate::world::import::topology::Topology;
use crate::world::import::xml::{Problems, child, children, text};
use nalgebra::Vector3;
use roxmltree::Node;
use std::collections::HashMap;

/// Most materials of one geometry; they are looked through for every primitive and every instance.
const MAX_SYMBOLS: usize = 1000;

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
pub(super) fn read<'a>(
    element: Node<'a, 'a>,
    by_id: &ById<'a>,
    sources: &mut Sources,
    problems: &mut Problems<'_>,
) -> Option<Geometry> {
    let Some(mesh) = child(element, "mesh") else {
        problems.add(
            element,
            "a geometry without <mesh> (a spline or convex hull) is not read",
            "convert it to a mesh",
        );
        return None;
    };
    let mut reader = Reader {
        by_id,
        sources,
        positions: HashMap::new(),
        geometry: Geometry::default(),
        bad_count: 0,
        huge_count: 0,
    };
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
                let geometry = &reader.geometry;
                if geometry.triangles.len() + geometry.lines.len() > MAX_TRIANGLES
                    || geometry.symbols.len() > MAX_SYMBOLS
                {
                    let what = format!("cut at {MAX_TRIANGLES} triangles and lines, or {MAX_SYMBOLS} materials");
                    problems.add(part, what, "simplify the mesh");
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
    if reader.huge_count > 0 {
        let what = format!("{} faces of more than {MAX_CORNERS} corners are left out", reader.huge_count);
        problems.add(element, what, "split them into triangles on export");
    }
    Some(reader.geometry)
}

struct Reader<'r, 'a> {
    by_id: &'r ById<'a>,
    sources: &'r mut Sources,
    /// First index and count of the vertices read from a source, by its id.
    positions: HashMap<String, (u32, u32)>,
    geometry: Geometry,
    bad_count: usize,
    /// Faces of more than [`MAX_CORNERS`].
    huge_count: usize,
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
                let topology = match kind {
                    "tristrips" => Topology::TriangleStrip,
                    "trifans" => Topology::TriangleFan,
                    "lines" => Topology::Lines,
                    "linestrips" => Topology::LineStrip,
                    _ => Topology::Triangles,
                };
                for list in lists() {
                    let corners = indices(text(list), &indexing);
                    self.list(topology, &corners, symbol);
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
        if corners.len() > MAX_CORNERS {
            self.huge_count += 1;
            return;
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

    /// Triangles or lines by the topology of the list.
    fn list(&mut self, topology: Topology, corners: &[Option<u32>], symbol: usize) {
        self.bad_count += usize::from(topology.left_over(corners.len()) > 0);
        topology.triangles(corners).into_iter().for_each(|face| self.triangle(face, symbol));
        topology.lines(corners).into_iter().for_each(|ends| self.line(ends));
    }

    fn triangle(&mut self, corners: [Option<u32>; 3], symbol: usize) {
        match corners {
            [Some(a), Some(b), Some(c)] => self.geometry.triangles.push(([a, b, c], symbol)),
            _ => self.bad_count += 1,
        }
    }

    fn line(&mut self, ends: [Option<u32>; 2]) {
        match ends {
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

    /// Adds the points of a `<source>`, once; the first index and the count.
    fn source(&mut self, source: Node<'a, 'a>) -> Option<(u32, u32)> {
        let id = source.attribute("id").unwrap_or("");
        if let Some(&known) = self.positions.get(id) {
            return Some(known);
        }
        let points = self.sources.points(source)?;
        let first = u32::try_from(self.geometry.vertices.len()).ok()?;
        self.geometry.vertices.extend(points);
        let range = (first, u32::try_from(points.len()).ok()?);
        self.positions.insert(id.to_owned(), range);
        Some(range)
    }
}

/// The points of sources by id, each read once however many geometries share it.
#[derive(Debug, Default)]
pub(super) struct Sources(HashMap<String, Option<Vec<Vector3<f64>>>>);

impl Sources {
    /// The points of a `<source>`; `None` if it has no array of floats or no triples.
    fn points(&mut self, source: Node<'_, '_>) -> Option<&[Vector3<f64>]> {
        let id = source.attribute("id").unwrap_or("");
        if !self.0.contains_key(id) {
            self.0.insert(id.to_owned(), read_points(source));
        }
        self.0.get(id)?.as_deref()
    }
}

fn read_points(source: Node<'_, '_>) -> Option<Vec<Vector3<f64>>> {
    let accessor = child(child(source, "technique_common")?, "accessor")?;
    let attribute = |name: &str, default: usize| match accessor.attribute(name) {
        Some(value) => value.trim().parse::<usize>().ok(),
        None => Some(default),
    };
    let (stride, offset) = (attribute("stride", 1)?, attribute("offset", 0)?);
    if stride < 3 {
        return None;
    }
    // What is not a number becomes NaN here and is named when the model is put together.
    let number = |word: &str| word.parse().unwrap_or(f64::NAN);
    let length = attribute("count", usize::MAX)?.saturating_mul(stride);
    let array = text(child(source, "float_array")?);
    let mut numbers = array.split_ascii_whitespace().skip(offset).take(length).map(number);
    let mut points = Vec::new();
    while let (Some(x), Some(y), Some(z)) = (numbers.next(), numbers.next(), numbers.next()) {
        points.push(Vector3::new(x, y, z));
        if stride > 3 {
            numbers.nth(stride - 4);
        }
    }
    Some(points)
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

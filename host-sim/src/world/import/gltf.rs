//! glTF 2.0, `.gltf` and `.glb`: the meshes of the default scene at their nodes' places, metres, y up.
//!
//! The `gltf` crate checks the document; buffers are read here, every accessor against the bytes that are there.

mod accessor;

use super::library::{FoundFile, Library};
use super::placement::{Placement, UpAxis};
use super::session::{MAX_NODE_DEPTH, MAX_PLACED_NODES, MAX_TRIANGLES, MeshFile};
use super::topology::Topology;
use super::{ImportProblem, ImportReport};
use crate::world::mesh::{Triangle, TriangleMesh};
use ::gltf::buffer::Source;
use ::gltf::json::validation::Checked;
use ::gltf::mesh::Mode;
use ::gltf::scene::Transform;
use ::gltf::{Document, Gltf, Material, Node, Primitive, Semantic};
use base64::Engine;
use nalgebra::Vector3;
use std::collections::BTreeSet;
use std::fmt::Display;

/// Most vertices and indices read, each as often as it is instanced.
const MAX_ELEMENTS: usize = 4 * MAX_TRIANGLES;

/// Reads a glTF file into metres, z up.
pub(super) fn read(bytes: &[u8], file: &FoundFile, library: &mut Library) -> Result<MeshFile, ImportProblem> {
    let fail = |what: String| ImportProblem::new(&file.shown, what, "export the file again; it may be cut short");
    let unreadable = |why: &dyn Display| fail(format!("is not readable glTF: {why}"));
    // The crate subtracts the header's length from the stated one unchecked.
    let is_binary = bytes.starts_with(b"glTF");
    let stated = bytes.get(8..12).map(|length| u32::from_le_bytes([length[0], length[1], length[2], length[3]]));
    if is_binary && stated.is_none_or(|length| length < 12) {
        return Err(unreadable(&"its header is cut short"));
    }
    let Gltf { document, blob } = Gltf::from_slice_without_validation(bytes).map_err(|error| unreadable(&error))?;
    let root = document.into_json();
    if names_unknown_positions(&root) {
        return Err(unreadable(&"the positions of a mesh are an accessor that is not there"));
    }
    let document = Document::from_json(root).map_err(|error| unreadable(&error))?;
    let mut reader = Reader {
        file,
        library,
        buffers: Vec::new(),
        read: MeshFile::default(),
        textured: BTreeSet::new(),
        node_count: 0,
        element_count: 0,
        overflow: None,
    };
    reader.buffers(&document, blob);
    let Some(scene) = document.default_scene().or_else(|| document.scenes().next()) else {
        return Err(fail("has no scene, so nothing to show".to_owned()));
    };
    let world_from_file = UpAxis::Y.world_from_file();
    for node in scene.nodes() {
        reader.node(&node, &world_from_file, 0);
    }
    if let Some(overflow) = reader.overflow {
        return Err(fail(overflow));
    }
    if document.animations().next().is_some() {
        reader.name(
            "animations",
            "are not applied: parts stand as the scene places them",
            "none needed for a still world",
        );
    }
    reader.read.textured_material_count = reader.textured.len();
    Ok(reader.read)
}

struct Reader<'r> {
    file: &'r FoundFile,
    library: &'r mut Library,
    /// Bytes of each buffer; none where they can't be read.
    buffers: Vec<Option<Vec<u8>>>,
    read: MeshFile,
    /// Indices of the materials met that are pictures.
    textured: BTreeSet<usize>,
    node_count: usize,
    /// Vertices and indices read so far, each as often as it is instanced.
    element_count: usize,
    overflow: Option<String>,
}

impl Reader<'_> {
    fn name(&mut self, place: &str, what: impl Into<String>, remedy: &str) {
        if self.read.problems.len() <= ImportReport::MAX_PROBLEMS {
            self.read.problems.push(ImportProblem::new(format!("{}: {place}", self.file.shown), what, remedy));
        }
    }

    fn buffers(&mut self, document: &Document, blob: Option<Vec<u8>>) {
        let mut blob = blob;
        for buffer in document.buffers() {
            let bytes = match buffer.source() {
                Source::Bin => blob.take().ok_or_else(|| "the file holds no binary chunk".to_owned()),
                Source::Uri(uri) => self.uri(uri),
            };
            let bytes = bytes.and_then(|bytes| {
                let (found, stated) = (bytes.len(), buffer.length());
                if found < stated { Err(format!("it states {stated} bytes and has {found}")) } else { Ok(bytes) }
            });
            let bytes = bytes
                .map_err(|what| {
                    self.name(&format!("buffer {}", buffer.index()), what, "put its file there, or export again");
                })
                .ok();
            self.buffers.push(bytes);
        }
    }

    /// The bytes that a URI names: base64 in place, or a file beside the document.
    fn uri(&mut self, uri: &str) -> Result<Vec<u8>, String> {
        if let Some(data) = uri.strip_prefix("data:") {
            let (_, encoded) = data.split_once(";base64,").ok_or("its data URI is not base64")?;
            let engine = base64::engine::general_purpose::STANDARD;
            return engine.decode(encoded).map_err(|error| format!("its data URI is not base64: {error}"));
        }
        let folder = self.file.path.parent().map(std::path::Path::to_path_buf).unwrap_or_default();
        let mut notes = Vec::new();
        let found = self.library.find(&percent_decoded(uri), &folder, &mut notes)?;
        for note in notes {
            self.name("buffer", note, "none needed here; other systems tell letter case");
        }
        self.library.read(&found).map_err(|problem| problem.to_string())
    }

    /// Places what a node holds.
    fn node(&mut self, node: &Node<'_>, parent: &Placement, depth: usize) {
        self.node_count += 1;
        if depth > MAX_NODE_DEPTH || self.node_count > MAX_PLACED_NODES {
            let what = format!("nodes nest deeper than {MAX_NODE_DEPTH} or number more than {MAX_PLACED_NODES}");
            self.overflow = Some(what);
        }
        if self.overflow.is_some() {
            return;
        }
        let placed = parent.after(&placement(&node.transform()));
        if node.skin().is_some() {
            let place = format!("node {}", node.index());
            self.name(&place, "its skin is not applied: the mesh stands as modelled", "bake the pose on export");
        }
        if let Some(mesh) = node.mesh() {
            for primitive in mesh.primitives() {
                self.node_count += 1;
                if let Err(what) = self.primitive(&primitive, &placed) {
                    let place = format!("mesh {} primitive {}", mesh.index(), primitive.index());
                    self.name(&place, format!("left out: {what}"), "export it again as plain triangles");
                }
            }
        }
        for child in node.children() {
            self.node(&child, &placed, depth + 1);
        }
    }

    /// Adds a primitive, placed; or says why not.
    fn primitive(&mut self, primitive: &Primitive<'_>, placed: &Placement) -> Result<(), String> {
        let topology = match primitive.mode() {
            Mode::Triangles => Topology::Triangles,
            Mode::TriangleStrip => Topology::TriangleStrip,
            Mode::TriangleFan => Topology::TriangleFan,
            Mode::Lines => Topology::Lines,
            Mode::LineStrip => Topology::LineStrip,
            Mode::LineLoop => Topology::LineLoop,
            Mode::Points => return Err("points show no edge".to_owned()),
        };
        let positions = primitive.get(&Semantic::Positions).ok_or("it has no positions")?;
        let index_count = primitive.indices().map_or(0, |indices| indices.count());
        self.element_count = self.element_count.saturating_add(positions.count()).saturating_add(index_count);
        if self.element_count > MAX_ELEMENTS {
            self.overflow = Some(format!("more than {MAX_ELEMENTS} vertices and indices, instances counted"));
            return Ok(());
        }
        let points = accessor::points(&positions, &self.buffers).map_err(|why| format!("its positions {why}"))?;
        let count = u32::try_from(points.len()).map_err(|_| "it has too many vertices")?;
        let corners = match primitive.indices() {
            Some(indices) => accessor::indices(&indices, &self.buffers).map_err(|why| format!("its indices {why}"))?,
            None => (0..count).collect(),
        };
        if corners.iter().any(|&corner| corner >= count) {
            return Err(format!("an index is beyond its {count} vertices"));
        }
        let reflectance = self.reflectance(&primitive.material());
        let triangles = topology.triangles(&corners).into_iter().map(|corners| Triangle { corners, reflectance });
        let mesh = TriangleMesh {
            vertices: points.into_iter().map(|point| Vector3::from(point.map(f64::from))).collect(),
            triangles: triangles.collect(),
            lines: topology.lines(&corners),
        };
        if self.read.mesh.element_count() + mesh.element_count() > MAX_TRIANGLES {
            self.overflow = Some(format!("more than {MAX_TRIANGLES} triangles and lines"));
            return Ok(());
        }
        placed.append(&mesh, &mut self.read.mesh);
        Ok(())
    }

    fn reflectance(&mut self, material: &Material<'_>) -> f32 {
        let surface = material.pbr_metallic_roughness();
        if surface.base_color_texture().is_some() {
            self.textured.extend(material.index());
            return crate::world::mesh::MID_GREY;
        }
        match material.index() {
            Some(_) => {
                let [red, green, blue, _] = surface.base_color_factor();
                super::luminance([red, green, blue].map(f64::from))
            }
            // The default material is white; a file that states none means nothing by it.
            None => crate::world::mesh::MID_GREY,
        }
    }
}

/// Whether a mesh names positions that are not there, on which the crate's own check (1.4.1) panics.
fn names_unknown_positions(root: &::gltf::json::Root) -> bool {
    let position = Checked::Valid(Semantic::Positions);
    let mut primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let index = |primitive: &::gltf::json::mesh::Primitive| Some(primitive.attributes.get(&position)?.value());
    primitives.any(|primitive| index(primitive).is_some_and(|index| index >= root.accessors.len()))
}

fn placement(transform: &Transform) -> Placement {
    match *transform {
        Transform::Matrix { matrix } => {
            let mut rows = [0.0; 16];
            for (column, values) in matrix.iter().enumerate() {
                for (row, &value) in values.iter().enumerate() {
                    rows[row * 4 + column] = f64::from(value);
                }
            }
            Placement::from_row_major(&rows)
        }
        Transform::Decomposed { translation, rotation, scale } => {
            Placement::translation(Vector3::from(translation.map(f64::from)))
                .after(&Placement::quaternion(rotation.map(f64::from)))
                .after(&Placement::scale(Vector3::from(scale.map(f64::from))))
        }
    }
}

/// `uri` with its `%XX` escapes replaced; malformed ones stay.
fn percent_decoded(uri: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = uri.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let escaped = (first == b'%')
            .then(|| after.get(..2).and_then(|digits| std::str::from_utf8(digits).ok()))
            .flatten()
            .and_then(|digits| u8::from_str_radix(digits, 16).ok());
        bytes.push(escaped.unwrap_or(first));
        rest = if escaped.is_some() { &after[2..] } else { after };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percent_escapes_are_replaced_where_they_are_whole() {
        assert_eq!(percent_decoded("my%20house%2.bin%"), "my house%2.bin%");
        assert_eq!(percent_decoded("%e4"), "\u{fffd}");
    }
}

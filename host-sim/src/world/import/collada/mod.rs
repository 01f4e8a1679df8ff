//! Collada 1.4 and 1.5: the geometry that the file's scene shows.
//!
//! Read: `<unit>`, `<up_axis>`, the visual scene's nodes with matrix, translate, rotate and scale, instances of
//! geometry and of nodes; triangles, tristrips, trifans, polylist, polygons, lines and linestrips; the diffuse colour
//! of materials. A file without a scene shows all its visual scenes.

mod geometry;
mod material;

use super::ImportProblem;
use super::placement::{Placement, UpAxis};
use super::session::{MAX_NODE_DEPTH, MAX_PLACED_NODES, MAX_TRIANGLES, MeshFile};
use super::xml::{Problems, child, children, numbers, parse, text};
use crate::world::mesh::{Triangle, TriangleMesh};
use geometry::{Geometry, Sources};
use material::{Materials, Reflectance};
use nalgebra::Vector3;
use roxmltree::Node;
use std::collections::HashMap;
use std::rc::Rc;

/// Most vertices read, each as often as it is instanced.
const MAX_VERTICES: usize = 3 * MAX_TRIANGLES;

/// Reads a Collada file into metres, z up.
pub(super) fn read(bytes: &[u8], shown: &str) -> Result<MeshFile, ImportProblem> {
    let document = parse(bytes, shown)?;
    let root = document.root_element();
    if root.tag_name().name() != "COLLADA" {
        let what = format!("its outermost element is <{}>, not <COLLADA>", root.tag_name().name());
        return Err(ImportProblem::new(shown, what, "export it as Collada again"));
    }
    let by_id = ById::of(root);
    let mut reader = Reader {
        materials: Materials::new(&by_id),
        by_id: &by_id,
        problems: Problems::of(shown),
        sources: Sources::default(),
        geometries: HashMap::new(),
        mesh: TriangleMesh::default(),
        part_count: 0,
        vertex_count: 0,
        overflow: None,
    };
    let placement = reader.asset(root);
    for scene in reader.scenes(root) {
        reader.node(scene, &placement, 0);
    }
    if let Some(overflow) = reader.overflow {
        return Err(ImportProblem::new(shown, overflow, "simplify the mesh, or see whether a node instances itself"));
    }
    for animation in children(root).filter(|library| library.tag_name().name() == "library_animations") {
        let what = "an animation is not applied: parts stand as the scene places them";
        reader.problems.add(animation, what, "none needed for a world that stands still");
    }
    let textured_material_count = reader.materials.textured_count();
    Ok(MeshFile { mesh: reader.mesh, problems: reader.problems.found, textured_material_count })
}

/// The elements that others refer to: by name and id, since some exporters give a scene and its node the same id.
struct ById<'a>(HashMap<(&'a str, &'a str), Node<'a, 'a>>);

impl<'a> ById<'a> {
    fn of(root: Node<'a, 'a>) -> Self {
        let mut by_id = HashMap::new();
        for node in root.descendants() {
            if let Some(id) = node.attribute("id") {
                by_id.entry((node.tag_name().name(), id)).or_insert(node);
            }
        }
        Self(by_id)
    }

    /// The element called `name` that `reference`, an id behind a `#`, points at.
    fn get(&self, name: &str, reference: &str) -> Option<Node<'a, 'a>> {
        self.0.get(&(name, reference.trim().trim_start_matches('#'))).copied()
    }
}

struct Reader<'d, 'a> {
    by_id: &'d ById<'a>,
    materials: Materials<'d, 'a>,
    problems: Problems<'d>,
    sources: Sources,
    geometries: HashMap<String, Option<Rc<Geometry>>>,
    mesh: TriangleMesh,
    /// Parts of nodes placed so far, each as often as it is instanced.
    part_count: usize,
    /// Vertices read so far, each as often as it is instanced.
    vertex_count: usize,
    /// Set once a limit is passed; from then on nothing more is placed.
    overflow: Option<String>,
}

impl<'a> Reader<'_, 'a> {
    /// The map from the file's unit and axes to metres, z up.
    fn asset(&mut self, root: Node<'a, 'a>) -> Placement {
        let Some(asset) = child(root, "asset") else { return UpAxis::Y.world_from_file() };
        let mut unit_m = 1.0;
        if let Some(unit) = child(asset, "unit") {
            let stated = unit.attribute("meter").unwrap_or("1").trim().parse::<f64>().ok();
            match stated.filter(|meters| (1e-6..=1e6).contains(meters)) {
                Some(meters) => unit_m = meters,
                None => self.problems.add(unit, "the unit is not a length; metres are taken", "correct its 'meter'"),
            }
        }
        let up_axis = match child(asset, "up_axis").map_or("Y_UP", text) {
            "X_UP" => UpAxis::X,
            "Z_UP" => UpAxis::Z,
            "Y_UP" => UpAxis::Y,
            other => {
                self.problems.add(asset, format!("the up axis {other} is unknown; z is taken"), "correct <up_axis>");
                UpAxis::Z
            }
        };
        up_axis.world_from_file().after(&Placement::scale(Vector3::repeat(unit_m)))
    }

    /// The visual scenes to show.
    fn scenes(&mut self, root: Node<'a, 'a>) -> Vec<Node<'a, 'a>> {
        let instance = child(root, "scene").and_then(|scene| child(scene, "instance_visual_scene"));
        if let Some(instance) = instance {
            if let Some(scene) = self.target(instance, "visual_scene") {
                return vec![scene];
            }
            self.problems.add(
                instance,
                "the scene it names is not in the file; all scenes are read",
                "correct its url",
            );
        }
        let libraries = children(root).filter(|library| library.tag_name().name() == "library_visual_scenes");
        libraries.flat_map(children).filter(|scene| scene.tag_name().name() == "visual_scene").collect()
    }

    /// The element that the `url` of an instance names, if it has the right name.
    fn target(&self, instance: Node<'a, 'a>, name: &str) -> Option<Node<'a, 'a>> {
        self.by_id.get(name, instance.attribute("url")?)
    }

    /// Places what a node, or a scene, holds.
    fn node(&mut self, node: Node<'a, 'a>, parent: &Placement, depth: usize) {
        let mut placed = *parent;
        for part in children(node) {
            self.part_count += 1;
            if depth > MAX_NODE_DEPTH || self.part_count > MAX_PLACED_NODES {
                let what =
                    format!("nodes nest deeper than {MAX_NODE_DEPTH} or hold more than {MAX_PLACED_NODES} parts");
                self.overflow.get_or_insert(what);
            }
            if self.overflow.is_some() {
                return;
            }
            match part.tag_name().name() {
                "matrix" | "translate" | "rotate" | "scale" => placed = placed.after(&self.transform(part)),
                "node" => self.node(part, &placed, depth + 1),
                "instance_node" => match self.target(part, "node") {
                    Some(target) => self.node(target, &placed, depth + 1),
                    None => self.problems.add(part, "the node it names is not in the file", "correct its url"),
                },
                "instance_geometry" => self.instance_geometry(part, &placed),
                "lookat" | "skew" => {
                    self.problems.add(part, "this kind of transform is not applied", "bake transforms on export");
                }
                "instance_controller" => {
                    self.problems.add(part, "a skinned or morphed mesh is not read", "bake it into a plain mesh");
                }
                // Cameras, lights and asset notes show nothing.
                _ => {}
            }
        }
    }

    fn transform(&mut self, element: Node<'_, '_>) -> Placement {
        let placement = match element.tag_name().name() {
            "matrix" => numbers::<16>(element).map(|rows| Placement::from_row_major(&rows)),
            "translate" => numbers(element).map(|shift| Placement::translation(Vector3::from(shift))),
            "scale" => numbers(element).map(|factors| Placement::scale(Vector3::from(factors))),
            _ => numbers(element)
                .map(|[x, y, z, degrees]: [f64; 4]| Placement::rotation(Vector3::new(x, y, z), degrees.to_radians())),
        };
        placement.unwrap_or_else(|| {
            self.problems.add(
                element,
                "the transform has not its count of finite numbers; none is taken",
                "correct it",
            );
            Placement::identity()
        })
    }

    fn instance_geometry(&mut self, instance: Node<'a, 'a>, placed: &Placement) {
        let Some(element) = self.target(instance, "geometry") else {
            self.problems.add(instance, "the geometry it names is not in the file", "correct its url");
            return;
        };
        let id = element.attribute("id").unwrap_or_default();
        if !self.geometries.contains_key(id) {
            let read = geometry::read(element, self.by_id, &mut self.sources, &mut self.problems).map(Rc::new);
            self.vertex_count += read.as_ref().map_or(0, |geometry| geometry.vertices.len());
            self.geometries.insert(id.to_owned(), read);
        }
        let Some(geometry) = self.geometries.get(id).cloned().flatten() else { return };
        self.vertex_count += geometry.vertices.len();
        let element_count = geometry.triangles.len() + geometry.lines.len();
        if self.mesh.element_count() + element_count > MAX_TRIANGLES || self.vertex_count > MAX_VERTICES {
            self.overflow = Some(format!("more than {MAX_TRIANGLES} triangles and lines or {MAX_VERTICES} vertices"));
            return;
        }
        let bound = material::bindings(instance);
        let reflectances: Vec<f32> = geometry
            .symbols
            .iter()
            .map(|symbol| self.materials.bound(&bound, symbol))
            .map(Reflectance::value)
            .collect();
        let local = TriangleMesh {
            vertices: geometry.vertices.clone(),
            triangles: geometry
                .triangles
                .iter()
                .map(|&(corners, symbol)| Triangle { corners, reflectance: reflectances[symbol] })
                .collect(),
            lines: geometry.lines.clone(),
        };
        placed.append(&local, &mut self.mesh);
    }
}

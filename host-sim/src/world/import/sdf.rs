//! Gazebo SDF: worlds and models, down to the visuals and their meshes.
//!
//! Read: `<world>`, `<model>` (nested too), `<include>` with its pose, `<link>`, `<visual>`, their `<pose>` (also
//! `degrees` and `rotation_format`), the meshes with their `<scale>`, box, cylinder, sphere, plane, and the diffuse
//! colour of a visual's material. An include's pose replaces that of the model it includes; a nested model's pose is
//! relative to its parent. Collision shapes, joints, sensors and plugins are not to be seen and not read.

mod shape;

use super::ImportProblem;
use super::library::FoundFile;
use super::placement::Placement;
use super::session::{MAX_TRIANGLES, PlacedModel, Session};
use super::xml::{Problems, child, children, numbers, parse, text};
use nalgebra::Vector3;
use roxmltree::Node;
use shape::{diffuse, pose_of, primitive};
use std::path::Path;

/// Deepest nesting of models and includes; beyond, a model probably includes itself.
const MAX_DEPTH: usize = 16;

/// Most models, nested ones included, in one world.
const MAX_MODELS: usize = 20_000;

/// Elements of a world or model that nothing to be seen hangs on.
const WITHOUT_SURFACES: [&str; 40] = [
    "allow_auto_disable",
    "atmosphere",
    "audio",
    "author",
    "collision",
    "description",
    "enable_wind",
    "frame",
    "gravity",
    "gripper",
    "gui",
    "inertial",
    "joint",
    "kinematic",
    "light",
    "magnetic_field",
    "must_be_base_link",
    "name",
    "particle_emitter",
    "physics",
    "placement_frame",
    "plugin",
    "pose",
    "projector",
    "scene",
    "self_collide",
    "sensor",
    "spherical_coordinates",
    "static",
    "uri",
    "velocity_decay",
    "visual",
    "wind",
    "link",
    "model",
    "include",
    "battery",
    "enable_gravity",
    "audio_source",
    "audio_sink",
];

/// Reads the session's file, a world or a single model, and places every model in it.
pub(super) fn read_world(session: &mut Session<'_>) -> Result<(), ImportProblem> {
    let file = session.start.clone();
    let bytes = session.library.read(&file)?;
    let document = parse(&bytes, &file.shown)?;
    let root = document.root_element();
    if root.tag_name().name() != "sdf" {
        let what = format!("its outermost element is <{}>, not <sdf>", root.tag_name().name());
        return Err(ImportProblem::new(&file.shown, what, "give a Gazebo world or model file"));
    }
    let mut reader = Reader { session, model_count: 0 };
    let mut source = Source { file: &file, problems: Problems::of(&file.shown) };
    let mut result = Ok(());
    for top in children(root) {
        result = match top.tag_name().name() {
            "world" => children(top).try_for_each(|entity| reader.top_level(&mut source, entity)),
            _ => reader.top_level(&mut source, top),
        };
        if result.is_err() {
            break;
        }
    }
    reader.hand_over(source);
    result
}

/// An SDF file being read.
struct Source<'a> {
    file: &'a FoundFile,
    problems: Problems<'a>,
}

impl Source<'_> {
    fn folder(&self) -> &Path {
        self.file.path.parent().unwrap_or(Path::new("."))
    }
}

struct Reader<'s, 'a> {
    session: &'s mut Session<'a>,
    model_count: usize,
}

impl Reader<'_, '_> {
    fn hand_over(&mut self, source: Source<'_>) {
        source.problems.found.into_iter().for_each(|problem| self.session.report.add(problem));
    }

    /// An entity of the world: models are placed, others ignored or named.
    fn top_level(&mut self, source: &mut Source<'_>, entity: Node<'_, '_>) -> Result<(), ImportProblem> {
        let mut model = PlacedModel { name: name_of(entity).to_owned(), ..PlacedModel::default() };
        let world = Placement::identity();
        match entity.tag_name().name() {
            "model" => self.model(source, entity, &world, None, &mut model, 0)?,
            "include" => self.include(source, entity, &world, &mut model, 0)?,
            other => {
                name_unread(source, entity, other);
                return Ok(());
            }
        }
        if model.mesh.triangles.is_empty() {
            source.problems.add(
                entity,
                format!("model '{}' shows no surface", model.name),
                "see the other problems named",
            );
        }
        self.session.place(model);
        Ok(())
    }

    /// Adds all visuals of a `<model>`; `pose` replaces the model's own.
    fn model(
        &mut self,
        source: &mut Source<'_>,
        element: Node<'_, '_>,
        parent: &Placement,
        pose: Option<Placement>,
        model: &mut PlacedModel,
        depth: usize,
    ) -> Result<(), ImportProblem> {
        self.model_count += 1;
        if depth > MAX_DEPTH || self.model_count > MAX_MODELS {
            let what = format!("models nest deeper than {MAX_DEPTH} or number more than {MAX_MODELS}");
            return Err(ImportProblem::new(
                source.problems.place(element),
                what,
                "see whether a model includes itself",
            ));
        }
        let placed = parent.after(&pose.unwrap_or_else(|| pose_of(source, element)));
        for part in children(element) {
            match part.tag_name().name() {
                "link" => self.link(source, part, &placed, model)?,
                "model" => self.model(source, part, &placed, None, model, depth + 1)?,
                "include" => self.include(source, part, &placed, model, depth + 1)?,
                other => name_unread(source, part, other),
            }
        }
        Ok(())
    }

    /// Adds the model that an `<include>` names.
    fn include(
        &mut self,
        source: &mut Source<'_>,
        element: Node<'_, '_>,
        parent: &Placement,
        model: &mut PlacedModel,
        depth: usize,
    ) -> Result<(), ImportProblem> {
        let uri = child(element, "uri").map_or("", text);
        if model.name.is_empty() {
            let named = child(element, "name").map_or("", text);
            let last = uri.trim_end_matches('/').rsplit('/').next().unwrap_or(uri);
            model.name = if named.is_empty() { last } else { named }.to_owned();
        }
        let Some(file) = self.find_model_file(source, element, uri) else { return Ok(()) };
        let bytes = match self.session.library.read(&file) {
            Ok(bytes) => bytes,
            Err(problem) => {
                self.session.report.add(problem);
                return Ok(());
            }
        };
        let document = match parse(&bytes, &file.shown) {
            Ok(document) => document,
            Err(problem) => {
                self.session.report.add(problem);
                return Ok(());
            }
        };
        let Some(included) = child(document.root_element(), "model") else {
            let what = format!("{} holds no <model>", file.shown);
            source.problems.add(element, what, "include a model");
            return Ok(());
        };
        let pose = child(element, "pose").is_some().then(|| pose_of(source, element));
        let mut inner = Source { file: &file, problems: Problems::of(&file.shown) };
        let result = self.model(&mut inner, included, parent, pose, model, depth);
        self.hand_over(inner);
        result
    }

    /// The SDF file of the model that `uri` names: what its `model.config` names, else `model.sdf`.
    fn find_model_file(&mut self, source: &mut Source<'_>, element: Node<'_, '_>, uri: &str) -> Option<FoundFile> {
        let remedy =
            format!("put it into one of: {}; or name its folder as a model folder", self.session.library.searched());
        let found = self.find(source, element, uri, &remedy)?;
        if found.path.is_file() {
            return Some(found);
        }
        let inside = |name: &str| format!("{}/{name}", uri.trim_end_matches('/'));
        let mut named = None;
        if let Ok(config) = self.session.library.find(&inside("model.config"), source.folder(), &mut Vec::new())
            && let Ok(bytes) = self.session.library.read(&config)
            && let Ok(document) = parse(&bytes, &config.shown)
        {
            // Several versions may be offered; the last listed is the newest by custom.
            let root = document.root_element();
            named =
                children(root).filter(|entry| entry.tag_name().name() == "sdf").last().map(|sdf| text(sdf).to_owned());
        }
        let name = named.filter(|name| !name.is_empty()).unwrap_or_else(|| "model.sdf".to_owned());
        self.find(source, element, &inside(&name), &remedy)
    }

    /// Finds `uri`, naming what is missing or spelt differently.
    fn find(&mut self, source: &mut Source<'_>, element: Node<'_, '_>, uri: &str, remedy: &str) -> Option<FoundFile> {
        if uri.is_empty() {
            source.problems.add(element, "names no file", "give it a <uri>");
            return None;
        }
        let mut notes = Vec::new();
        let found = self.session.library.find(uri, source.folder(), &mut notes);
        match found {
            Ok(found) => {
                for note in notes {
                    source.problems.add(element, note, "none needed here; other systems tell letter case");
                }
                Some(found)
            }
            Err(what) => {
                source.problems.add(element, what, remedy);
                None
            }
        }
    }

    fn link(
        &mut self,
        source: &mut Source<'_>,
        element: Node<'_, '_>,
        parent: &Placement,
        model: &mut PlacedModel,
    ) -> Result<(), ImportProblem> {
        let placed = parent.after(&pose_of(source, element));
        for part in children(element) {
            match part.tag_name().name() {
                "visual" => self.visual(source, part, &placed, model)?,
                other => name_unread(source, part, other),
            }
        }
        Ok(())
    }

    fn visual(
        &mut self,
        source: &mut Source<'_>,
        element: Node<'_, '_>,
        parent: &Placement,
        model: &mut PlacedModel,
    ) -> Result<(), ImportProblem> {
        let placed = parent.after(&pose_of(source, element));
        let Some(shape) = child(element, "geometry").and_then(|geometry| children(geometry).next()) else {
            source.problems.add(element, "a visual without geometry", "remove it, or give it one");
            return Ok(());
        };
        let first = model.mesh.triangles.len();
        if shape.tag_name().name() == "mesh" {
            self.mesh(source, shape, &placed, model);
        } else if let Some(mesh) = primitive(source, shape) {
            placed.append(&mesh, &mut model.mesh);
        }
        if let Some(reflectance) = diffuse(source, element) {
            model.mesh.triangles[first..].iter_mut().for_each(|triangle| triangle.reflectance = reflectance);
        }
        if !self.session.has_room_for(model.mesh.element_count()) {
            let what = format!("more than {MAX_TRIANGLES} triangles in the world");
            return Err(ImportProblem::new(source.problems.place(element), what, "simplify its meshes"));
        }
        Ok(())
    }

    fn mesh(&mut self, source: &mut Source<'_>, shape: Node<'_, '_>, placed: &Placement, model: &mut PlacedModel) {
        let uri = child(shape, "uri").map_or("", text);
        let remedy = "put the file there, or correct the <uri>";
        let Some(file) = self.find(source, shape, uri, remedy) else { return };
        if child(shape, "submesh").is_some() {
            source.problems.add(shape, "<submesh> is not applied: the whole mesh is read", "split the mesh file");
        }
        let scale = match child(shape, "scale") {
            None => Vector3::repeat(1.0),
            Some(scale) => numbers(scale).map_or_else(
                || {
                    source.problems.add(scale, "<scale> is not three numbers; 1 1 1 is taken", "correct it");
                    Vector3::repeat(1.0)
                },
                Vector3::from,
            ),
        };
        match self.session.mesh(&file) {
            Some(read) if self.session.has_room_for(model.mesh.element_count() + read.mesh.element_count()) => {
                placed.after(&Placement::scale(scale)).append(&read.mesh, &mut model.mesh);
                if !model.sources.contains(&file.shown) {
                    model.sources.push(file.shown);
                }
            }
            Some(_) => source.problems.add(shape, "left out: too many triangles", "simplify its meshes"),
            None => source.problems.add(
                shape,
                format!("left out: {} can't be read", file.shown),
                "see the problem of that file",
            ),
        }
    }
}

/// Names an element that may show something but is not read.
fn name_unread(source: &mut Source<'_>, element: Node<'_, '_>, name: &str) {
    if !WITHOUT_SURFACES.contains(&name) {
        let what = match name {
            "state" => "<state> is not applied: models stand where their own poses put them".to_owned(),
            _ => format!("<{name}> is not read"),
        };
        source.problems.add(element, what, "replace it by models with meshes or simple shapes");
    }
}

fn name_of<'a>(element: Node<'a, '_>) -> &'a str {
    element.attribute("name").unwrap_or("")
}

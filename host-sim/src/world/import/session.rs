//! One import under way: the files it may read, the meshes it has read, the world it builds.

use super::super::WireframeWorld;
use super::super::mesh::TriangleMesh;
use super::assemble::Assembly;
use super::library::{FoundFile, Library};
use super::placement::Placement;
use super::{Format, ImportError, ImportOptions, ImportProblem, ImportReport, MeshFormat, collada, gltf, obj};
use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Most triangles and lines in one import, and in one mesh file: thirty times those of a furnished flat.
pub(super) const MAX_TRIANGLES: usize = 5_000_000;

/// Deepest nesting of a mesh file's nodes; beyond, a node probably holds itself.
pub(super) const MAX_NODE_DEPTH: usize = 64;

/// Most nodes placed from one mesh file, each as often as it is instanced.
pub(super) const MAX_PLACED_NODES: usize = 1_000_000;

/// A mesh file as read: metres, z up.
#[derive(Debug, Default)]
pub(super) struct MeshFile {
    pub(super) mesh: TriangleMesh,
    pub(super) problems: Vec<ImportProblem>,
    pub(super) textured_material_count: usize,
}

/// A model being put together, in the world frame.
#[derive(Debug, Default)]
pub(super) struct PlacedModel {
    pub(super) name: String,
    pub(super) sources: Vec<String>,
    pub(super) mesh: TriangleMesh,
}

/// One import under way.
#[derive(Debug)]
pub(super) struct Session<'a> {
    pub(super) options: &'a ImportOptions,
    pub(super) library: Library,
    pub(super) report: ImportReport,
    /// The file the import began with.
    pub(super) start: FoundFile,
    meshes: BTreeMap<PathBuf, Option<Rc<MeshFile>>>,
    assembly: Assembly,
}

impl<'a> Session<'a> {
    pub(super) fn new(path: &Path, options: &'a ImportOptions) -> Result<Self, ImportProblem> {
        let library = Library::around(path, &options.model_folders)?;
        let report = ImportReport { min_edge_m: options.min_edge_m, ..ImportReport::default() };
        let start = library.start(path);
        Ok(Self { options, library, report, start, meshes: BTreeMap::new(), assembly: Assembly::default() })
    }

    /// The mesh in `file`, read once; `None` if it can't be read, which is then named in the report.
    pub(super) fn mesh(&mut self, file: &FoundFile) -> Option<Rc<MeshFile>> {
        if let Some(known) = self.meshes.get(&file.path) {
            return known.clone();
        }
        let read = match self.read_mesh(file) {
            Ok(mut mesh) => {
                mesh.problems.drain(..).for_each(|problem| self.report.add(problem));
                self.report.textured_material_count += mesh.textured_material_count;
                Some(Rc::new(mesh))
            }
            Err(problem) => {
                self.report.add(problem);
                None
            }
        };
        self.meshes.insert(file.path.clone(), read.clone());
        read
    }

    fn read_mesh(&mut self, file: &FoundFile) -> Result<MeshFile, ImportProblem> {
        let Some(Format::Mesh(format)) = Format::of(&file.path) else {
            let what = "is not in a mesh format this program reads";
            return Err(ImportProblem::new(&file.shown, what, "convert it to .dae, .obj, .gltf or .glb"));
        };
        let bytes = self.library.read(file)?;
        let mut read = match format {
            MeshFormat::Collada => collada::read(&bytes, &file.shown),
            MeshFormat::Gltf => gltf::read(&bytes, file, &mut self.library),
            MeshFormat::Obj => obj::read(&bytes, file, &mut self.library),
        }?;
        read.mesh = read.mesh.without_unused_vertices();
        Ok(read)
    }

    /// Adds a finished model to the world.
    pub(super) fn place(&mut self, model: PlacedModel) {
        self.assembly.add(model, self.options, &mut self.report);
    }

    /// Whether `added` more triangles and lines are within the limit.
    pub(super) fn has_room_for(&self, added: usize) -> bool {
        self.assembly.element_count() + added <= MAX_TRIANGLES
    }

    /// The world and the report, unless nothing was found.
    pub(super) fn finish(self) -> Result<(WireframeWorld, ImportReport), ImportError> {
        let path = self.start.path;
        if self.assembly.is_empty() {
            let shown: Vec<String> =
                self.report.problems.iter().take(5).map(|problem| format!("; {problem}")).collect();
            return Err(ImportError::Empty { path, problems: shown.concat() });
        }
        // A model file is called model.sdf wherever it lies; the model's own name says more.
        let name = match self.report.models.as_slice() {
            [only] => only.name.clone(),
            _ => path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned()),
        };
        let fits_file_name = |letter: char| letter.is_ascii_alphanumeric() || "_-.".contains(letter);
        let name = name.chars().map(|letter| if fits_file_name(letter) { letter } else { '_' }).collect();
        let origin = format!(
            "imported from {} (edges from {} m, creases from {} degrees)",
            self.start.shown, self.options.min_edge_m, self.options.crease_deg
        );
        Ok((self.assembly.into_world(name, origin), self.report))
    }
}

/// Reads a mesh file as a world of one model.
pub(super) fn read_single_mesh(session: &mut Session<'_>) -> Result<(), ImportProblem> {
    let file = session.start.clone();
    let mut read = session.read_mesh(&file)?;
    read.problems.drain(..).for_each(|problem| session.report.add(problem));
    session.report.textured_material_count += read.textured_material_count;
    let name = file.path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let mut mesh = TriangleMesh::default();
    let options = session.options;
    let placement = match Format::of(&file.path) {
        Some(Format::Mesh(MeshFormat::Obj)) => {
            let unit = Placement::scale(Vector3::repeat(options.obj_unit_m));
            options.obj_up_axis.world_from_file().after(&unit)
        }
        _ => Placement::identity(),
    };
    placement.append(&read.mesh, &mut mesh);
    session.place(PlacedModel { name, sources: vec![file.shown], mesh });
    Ok(())
}

//! Import of worlds that others made: Gazebo SDF worlds, Collada, OBJ and glTF meshes, into a wire-frame.
//!
//! - `.world`, `.sdf`: every visual of every model, at its pose; meshes and models by `model://`, `file://` and
//!   relative path (see [`ImportOptions::model_folders`]); box, cylinder, sphere and plane. Metres, z up.
//! - `.dae`: with its `<unit>` and `<up_axis>`, node transforms and instances.
//! - `.gltf`, `.glb`: metres, y up, node transforms; buffers embedded, beside the file or in the GLB.
//! - `.obj`: faces and lines; the format states neither unit nor up axis, so the options do.
//!
//! Heights stay as the file has them: the robot drives at z = 0. Materials count by their diffuse luminance; pictures
//! as mid grey, transparent surfaces as opaque. What can't be read is named in the [`ImportReport`], never silently
//! dropped. Files are untrusted: sizes, counts, depths and paths are bounded, and document types are refused.

mod assemble;
mod collada;
mod gltf;
mod library;
mod obj;
mod placement;
mod polygon;
mod primitives;
mod report;
mod sdf;
mod session;
mod topology;
mod xml;

pub use placement::UpAxis;
pub use report::{BoundingBox, ImportProblem, ImportReport, ModelReport};

use super::WireframeWorld;
use serde::{Deserialize, Serialize};
use session::Session;
use std::path::{Path, PathBuf};

/// How to import.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ImportOptions {
    /// Least length of an edge that enters the world, in metres, 0 to 100; default 0.10, which leaves the paper's number of
    /// features in a flat. Shorter ones are counted in the report.
    pub min_edge_m: f64,
    /// Least angle between two faces that shows as an edge, in degrees, 0 to 180 exclusive; default 30.
    pub crease_deg: f64,
    /// Further folders to search for models (each sub-folder a model), after the world's own folder and the `models/`
    /// folder in or beside it; default none.
    pub model_folders: Vec<PathBuf>,
    /// Length of one unit of an imported OBJ file, in metres; default 1.
    pub obj_unit_m: f64,
    /// The axis that points up in an imported OBJ file; default z.
    pub obj_up_axis: UpAxis,
}

impl Default for ImportOptions {
    fn default() -> Self {
        Self { min_edge_m: 0.10, crease_deg: 30.0, model_folders: Vec::new(), obj_unit_m: 1.0, obj_up_axis: UpAxis::Z }
    }
}

/// Why nothing was imported.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// The file's name does not end in a known way.
    #[error("{}: not a format this program imports (it reads .world .sdf .dae .obj .gltf .glb; convert the file to one of these)", path.display())]
    UnknownFormat {
        /// The file asked for.
        path: PathBuf,
    },
    /// An option is out of its range.
    #[error("import option {name} is {value}: {remedy}")]
    Option {
        /// The option's name.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The range it must lie in.
        remedy: &'static str,
    },
    /// The file itself can't be read.
    #[error(transparent)]
    Unreadable(#[from] ImportProblem),
    /// The file was read but holds no surface and no edge.
    #[error("{}: nothing to import: no surface and no edge{problems}", path.display())]
    Empty {
        /// The file asked for.
        path: PathBuf,
        /// The first problems met, ready to print.
        problems: String,
    },
}

/// Imports the world or mesh at `path`.
///
/// # Errors
/// When the format is unknown, an option out of range, the file unreadable, or nothing was found in it. Parts that
/// can't be read are no error: they are named in the report.
pub fn import(path: &Path, options: &ImportOptions) -> Result<(WireframeWorld, ImportReport), ImportError> {
    options.check()?;
    let read = match Format::of(path) {
        Some(Format::Sdf) => sdf::read_world,
        Some(Format::Mesh(_)) => session::read_single_mesh,
        None => return Err(ImportError::UnknownFormat { path: path.to_path_buf() }),
    };
    let mut session = Session::new(path, options)?;
    read(&mut session)?;
    session.finish()
}

impl ImportOptions {
    fn check(&self) -> Result<(), ImportError> {
        let checks = [
            ("min_edge_m", self.min_edge_m, (0.0..=100.0).contains(&self.min_edge_m), "it must lie within 0 to 100 m"),
            (
                "crease_deg",
                self.crease_deg,
                self.crease_deg > 0.0 && self.crease_deg < 180.0,
                "it must lie between 0 and 180 degrees",
            ),
            (
                "obj_unit_m",
                self.obj_unit_m,
                (1e-6..=1e6).contains(&self.obj_unit_m),
                "it must lie within 1e-6 to 1e6 m",
            ),
        ];
        match checks.into_iter().find(|&(_, _, fits, _)| !fits) {
            Some((name, value, _, remedy)) => Err(ImportError::Option { name, value, remedy }),
            None => Ok(()),
        }
    }
}

/// What a file holds, by its extension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Sdf,
    Mesh(MeshFormat),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum MeshFormat {
    Collada,
    Gltf,
    Obj,
}

impl Format {
    fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "world" | "sdf" => Some(Self::Sdf),
            "dae" => Some(Self::Mesh(MeshFormat::Collada)),
            "gltf" | "glb" => Some(Self::Mesh(MeshFormat::Gltf)),
            "obj" => Some(Self::Mesh(MeshFormat::Obj)),
            _ => None,
        }
    }
}

/// Relative luminance of a linear colour (ITU-R BT.709), clamped to 0..=1.
fn luminance([red, green, blue]: [f64; 3]) -> f32 {
    (0.2126 * red + 0.7152 * green + 0.0722 * blue).clamp(0.0, 1.0) as f32
}

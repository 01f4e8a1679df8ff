//! What is known of a world, in words and as JSON.

use crate::cli::console::{self, Format};
use edgeloc_sim::report::WorldFacts;
use edgeloc_sim::scenario::WorldChoice;
use edgeloc_sim::world::{FreeSpace, FreeSpaceOptions, WireframeWorld};
use miette::Result;
use serde::Serialize;
use std::path::Path;

/// The fields of a description as JSON, for the help.
pub(super) const JSON_FIELDS: &str = "name, origin, file, edges, triangles, checksum, edge_length_m, \
                                      min_m and max_m (x, y, z of the corners), \
                                      free_space (area_m2, description), free_space_problem (null when there is none)";

/// What is known of a world, as `--format json` prints it.
#[derive(Debug, Serialize)]
pub(super) struct WorldDescription {
    /// Name, origin, file, counts and checksum.
    #[serde(flatten)]
    facts: WorldFacts,
    /// Total length of the edges [m].
    edge_length_m: f64,
    /// Least x, y and z of the edges [m].
    min_m: [f32; 3],
    /// Greatest x, y and z of the edges [m].
    max_m: [f32; 3],
    /// Where the robot can stand.
    free_space: Option<FreeSpaceDescription>,
    /// Why it can stand nowhere.
    free_space_problem: Option<String>,
}

#[derive(Debug, Serialize)]
struct FreeSpaceDescription {
    /// Area of the region used [m2].
    area_m2: f64,
    /// The region in words.
    description: String,
}

impl WorldDescription {
    /// Describes a world read from or written to the file at `path`.
    pub(super) fn new(world: &WireframeWorld, path: &Path) -> Self {
        let choice = WorldChoice::file(path.to_owned());
        let points =
            world.edges.iter().flat_map(|edge| [edge.start, edge.end]).map(|point| [point.x, point.y, point.z]);
        let joined = |pick: fn(f32, f32) -> f32| points.clone().reduce(|a, b| [0, 1, 2].map(|i| pick(a[i], b[i])));
        let free_space = FreeSpace::of(world, &FreeSpaceOptions::default());
        Self {
            facts: WorldFacts::new(world, &choice),
            edge_length_m: world.edges.iter().map(|edge| f64::from(edge.length_m())).sum(),
            min_m: joined(f32::min).unwrap_or_default(),
            max_m: joined(f32::max).unwrap_or_default(),
            free_space: free_space
                .as_ref()
                .ok()
                .map(|free| FreeSpaceDescription { area_m2: free.area_m2(), description: free.describe() }),
            free_space_problem: free_space.err().map(|error| error.to_string()),
        }
    }

    /// Prints the description.
    pub(super) fn print(&self, format: Format) -> Result<()> {
        if format == Format::Json {
            return console::print_json(self);
        }
        let free = self.free_space.as_ref().map(|free| free.description.clone());
        let lines = [
            ("world", self.facts.name.clone()),
            ("file", self.facts.file.clone().unwrap_or_default()),
            ("origin", self.facts.origin.clone()),
            ("edges", format!("{} straight edges, {:.0} m in all", self.facts.edges, self.edge_length_m)),
            ("surfaces", format!("{} triangles", self.facts.triangles)),
            ("size", format!("{} m", sizes([0, 1, 2].map(|axis| self.max_m[axis] - self.min_m[axis])))),
            ("free space", free.or_else(|| self.free_space_problem.clone()).unwrap_or_default()),
            ("checksum", self.facts.checksum.clone()),
        ];
        console::print(&console::facts(&lines).to_string())
    }
}

/// Three lengths in metres in words.
pub(super) fn sizes(size_m: [f32; 3]) -> String {
    format!("{:.2} x {:.2} x {:.2}", size_m[0], size_m[1], size_m[2])
}

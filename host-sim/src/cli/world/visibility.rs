//! `world visibility`: reference viewpoints from the surfaces, as a file that can be edited.

use super::file_stem;
use crate::cli::console::{self, Format};
use crate::cli::{progress, worlds};
use clap::Args;
use edgeloc::geometry::StereoRig;
use edgeloc_sim::learning;
use edgeloc_sim::world::viewpoints::{PAPER_VIEWPOINT_COUNT, file};
use edgeloc_sim::world::{FreeSpace, FreeSpaceOptions, Occluders, ReferenceViewpoints};
use miette::{IntoDiagnostic, Result};
use serde::Serialize;
use std::path::PathBuf;
use std::time::Instant;

/// The fields that `--format json` prints, for the help.
const JSON_FIELDS: &str = "\
world, file, viewpoints, edges (of the world), visible_edges_min, visible_edges_mean and visible_edges_max of a viewpoint, \
never_visible_edges (from no viewpoint), checksum (of the file), seconds";

/// Write what is visible from reference viewpoints, worked out from the surfaces: the paper's view-dependency file.
///
/// The viewpoints are spread evenly over the free space. From each, an edge is visible when at least half of its length
/// is; a robot then sees, whole, the edges that its nearest viewpoint lists. The file is text (.views) and can be edited
/// by hand, or by sight with `edgeloc world edit`. A run uses it with --set world.visibility=FILE.
#[derive(Debug, Args)]
#[command(after_help = format!(
    "Examples:\n  edgeloc world visibility office-1.edgeworld\n  \
     edgeloc world visibility small_house.edgeworld --viewpoints 500 --out fine.views\n  \
     edgeloc run paper --world office-1.edgeworld --set world.visibility=office-1.views\n\n\
     JSON (--format json): {JSON_FIELDS}."
))]
pub(in crate::cli) struct Visibility {
    /// World file (.edgeworld).
    world: PathBuf,
    /// File to write [default: the name of the world, .views].
    #[arg(short, long, visible_alias = "out", value_name = "FILE")]
    output: Option<PathBuf>,
    /// Reference viewpoints; the paper has 236.
    #[arg(long, value_name = "N", default_value_t = PAPER_VIEWPOINT_COUNT,
          value_parser = clap::value_parser!(u16).range(1..=file::MAX_VIEWPOINTS as i64))]
    viewpoints: u16,
    /// Height of the eye above the floor [m].
    #[arg(long, default_value_t = StereoRig::reference().camera_height_m)]
    camera_height_m: f32,
    /// Overwrite the file.
    #[arg(long)]
    force: bool,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// What `world visibility --format json` prints.
#[derive(Debug, Serialize)]
struct Account {
    world: String,
    file: PathBuf,
    viewpoints: usize,
    edges: usize,
    visible_edges_min: usize,
    visible_edges_mean: f64,
    visible_edges_max: usize,
    never_visible_edges: usize,
    checksum: String,
    seconds: f64,
}

impl Visibility {
    pub(super) fn execute(&self) -> Result<()> {
        let world = worlds::read(&self.world)?;
        let default_output = || PathBuf::from(format!("{}.views", file_stem(&world.name)));
        let path = self.output.clone().unwrap_or_else(default_output);
        console::check_overwrite(&path, self.force)?;
        StereoRig { camera_height_m: self.camera_height_m, ..StereoRig::reference() }.checked().map_err(|error| {
            miette::miette!(help = "1 m is the default", "--camera-height-m {}: {error}", self.camera_height_m)
        })?;

        let start = Instant::now();
        let free = FreeSpace::of(&world, &FreeSpaceOptions::default()).into_diagnostic()?;
        let positions = learning::place_nodes(&free, usize::from(self.viewpoints), 1).into_diagnostic()?;
        let occluders = Occluders::new(&world.surfaces);
        let progress = progress::bar(positions.len(), "viewpoints");
        let viewpoints =
            ReferenceViewpoints::from_surfaces(&world, &occluders, &positions, self.camera_height_m, &|| {
                progress.step();
            });
        drop(progress);
        file::save(&viewpoints, &path).into_diagnostic()?;

        let counts = viewpoints.viewpoints().iter().map(|viewpoint| viewpoint.visible.len());
        let is_never_visible = |edge: &u32| viewpoints.viewpoints().iter().all(|at| !at.visible.contains(*edge));
        let account = Account {
            world: world.name.clone(),
            file: path,
            viewpoints: positions.len(),
            edges: world.edges.len(),
            visible_edges_min: counts.clone().min().unwrap_or_default(),
            visible_edges_mean: counts.clone().sum::<usize>() as f64 / positions.len() as f64,
            visible_edges_max: counts.max().unwrap_or_default(),
            never_visible_edges: (0..world.edges.len() as u32).filter(is_never_visible).count(),
            checksum: format!("{:016x}", viewpoints.checksum()),
            seconds: start.elapsed().as_secs_f64(),
        };
        account.print(self.format)
    }
}

impl Account {
    fn print(&self, format: Format) -> Result<()> {
        if format == Format::Json {
            return console::print_json(self);
        }
        let Self { visible_edges_min, visible_edges_mean, visible_edges_max, .. } = self;
        let lines = [
            ("world", self.world.clone()),
            ("file", self.file.display().to_string()),
            ("viewpoints", format!("{}, in {:.1} s", self.viewpoints, self.seconds)),
            (
                "visible",
                format!(
                    "{visible_edges_min} to {visible_edges_max} edges a viewpoint, mean {visible_edges_mean:.0} of {}",
                    self.edges
                ),
            ),
            ("never visible", format!("{} edges", self.never_visible_edges)),
            ("checksum", self.checksum.clone()),
        ];
        console::print(&console::facts(&lines).to_string())
    }
}

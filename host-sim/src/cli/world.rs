//! `world`: generate, import, describe and draw worlds.

use super::console::{self, Format};
use super::worlds;
use clap::{Args, Subcommand};
use edgeloc::geometry::{Angle, Heading, Point2, Point3, StereoRig};
use edgeloc_sim::camera;
use edgeloc_sim::report::{FloorPlan, WorldFacts, scene_drawing, to_svg_file};
use edgeloc_sim::scenario::WorldChoice;
use edgeloc_sim::world::import::{ImportOptions, ImportReport, UpAxis, import};
use edgeloc_sim::world::{FreeSpace, FreeSpaceOptions, Occluders, ViewpointVisibility, WireframeWorld, file, office};
use miette::{IntoDiagnostic, Result, miette};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Generate, import, describe and draw worlds.
#[derive(Debug, Subcommand)]
#[command(after_help = "Examples:\n  edgeloc world generate --seed 7\n  edgeloc world import small_house.world\n  \
                        edgeloc world info small_house.edgeworld\n  edgeloc world view small_house.edgeworld")]
pub(super) enum World {
    Generate(Generate),
    Import(Import),
    Info(Info),
    View(View),
}

impl World {
    pub(super) fn execute(self) -> Result<()> {
        match self {
            Self::Generate(verb) => verb.execute(),
            Self::Import(verb) => verb.execute(),
            Self::Info(verb) => verb.execute(),
            Self::View(verb) => verb.execute(),
        }
    }
}

/// Generate a furnished office of 20 x 15 x 2.5 m; the same seed gives the same office.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  edgeloc world generate --seed 7\n  edgeloc world generate --edges 6000 -o small.edgeworld"
)]
pub(super) struct Generate {
    /// Seed of the office.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Straight edges asked for; an office holds about 5,500 to 8,000.
    #[arg(long, default_value_t = 7000, value_parser = clap::value_parser!(u32).range(0..=100_000))]
    edges: u32,
    #[command(flatten)]
    output: WorldOutput,
}

impl Generate {
    fn execute(&self) -> Result<()> {
        let options = office::OfficeOptions { seed: self.seed, edge_count: self.edges as usize };
        let world = office::generate(&options);
        let path = self.output.save(&world)?;
        WorldDescription::new(&world, &path).print(self.output.format)
    }
}

/// Import a building that others made: a Gazebo world (.world, .sdf) or a mesh (.dae, .obj, .gltf, .glb).
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  edgeloc world import aws_small_house/worlds/small_house.world\n  \
                        edgeloc world import office.world --models my_models --min-edge-m 0.3\n  \
                        edgeloc world import scan.obj --obj-unit-m 0.001 --obj-up y")]
pub(super) struct Import {
    /// The file to import.
    file: PathBuf,
    /// A further folder to search for models (each sub-folder a model); may be repeated.
    #[arg(long = "models", value_name = "FOLDER")]
    model_folders: Vec<PathBuf>,
    /// Least length of an edge that enters the world [m].
    #[arg(long, default_value_t = ImportOptions::default().min_edge_m)]
    min_edge_m: f64,
    /// Least angle between two faces that shows as an edge [degrees].
    #[arg(long, default_value_t = ImportOptions::default().crease_deg)]
    crease_deg: f64,
    /// Length of one unit of an OBJ file [m].
    #[arg(long, default_value_t = ImportOptions::default().obj_unit_m)]
    obj_unit_m: f64,
    /// The axis that points up in an OBJ file: x, y or z.
    #[arg(long, default_value = "z", value_parser = parse_axis)]
    obj_up: UpAxis,
    #[command(flatten)]
    output: WorldOutput,
}

impl Import {
    fn execute(&self) -> Result<()> {
        let options = ImportOptions {
            min_edge_m: self.min_edge_m,
            crease_deg: self.crease_deg,
            model_folders: self.model_folders.clone(),
            obj_unit_m: self.obj_unit_m,
            obj_up_axis: self.obj_up,
        };
        let (world, report) = import(&self.file, &options).into_diagnostic()?;
        let path = self.output.save(&world)?;
        let description = WorldDescription::new(&world, &path);
        match self.output.format {
            Format::Json => console::print_json(&Imported { world: description, import: report }),
            Format::Text => {
                describe_import(&report)?;
                description.print(Format::Text)
            }
        }
    }
}

/// What `world import --format json` prints.
#[derive(Serialize)]
struct Imported {
    world: WorldDescription,
    import: ImportReport,
}

fn describe_import(report: &ImportReport) -> Result<()> {
    let mut table = console::table(&["model", "triangles", "segments", "10 cm or more", "length [m]", "size [m]"]);
    for model in &report.models {
        let size = model.bounding_box.map_or_else(String::new, |bounds| sizes(bounds.size_m()));
        table.add_row([
            model.name.clone(),
            model.triangle_count.to_string(),
            model.segment_count.to_string(),
            model.segments_10cm.to_string(),
            format!("{:.1}", model.edge_length_m),
            size,
        ]);
    }
    console::print(&table.to_string())?;
    console::print(&format!(
        "{} models, {} segments, {} shorter than {} m left out, {} textured materials taken as mid grey",
        report.models.len(),
        report.segment_count(),
        report.short_segment_count,
        report.min_edge_m,
        report.textured_material_count
    ))?;
    for problem in &report.problems {
        console::remark(&format!("note: {problem}"));
    }
    if report.unlisted_problem_count > 0 {
        console::remark(&format!("note: and {} further problems", report.unlisted_problem_count));
    }
    Ok(())
}

/// Describe a world: edges, surfaces, size, free space.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  edgeloc world info small_house.edgeworld\n  edgeloc world info office-7.edgeworld --format json\n\nJSON (--format json): file, name, origin, edges, triangles, checksum, edge_length_m, min_m and max_m (x, y, z), free_space (area_m2, description) or free_space_problem."
)]
pub(super) struct Info {
    /// World file (.edgeworld).
    file: PathBuf,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

impl Info {
    fn execute(&self) -> Result<()> {
        WorldDescription::new(&worlds::read(&self.file)?, &self.file).print(self.format)
    }
}

/// Draw a world from above, or as the robot's camera sees it from a place.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  edgeloc world view office-1.edgeworld\n  \
                        edgeloc world view office-1.edgeworld --eye 3,4 --heading-deg 90 -o view.svg")]
pub(super) struct View {
    /// World file (.edgeworld).
    file: PathBuf,
    /// Place of the camera [m]; draws what it sees instead of the plan.
    #[arg(long, value_name = "X,Y", value_parser = parse_place, allow_hyphen_values = true)]
    eye: Option<Point2>,
    /// Heading of the camera [degrees], counter-clockwise from +x.
    #[arg(long, default_value_t = 0.0, allow_hyphen_values = true)]
    heading_deg: f32,
    /// Height of the camera above the floor [m].
    #[arg(long, default_value_t = StereoRig::reference().camera_height_m)]
    camera_height_m: f32,
    /// Drawing to write [default: the name of the world, .svg].
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Overwrite the drawing.
    #[arg(long)]
    force: bool,
}

impl View {
    fn execute(&self) -> Result<()> {
        let world = worlds::read(&self.file)?;
        let path = self.output.clone().unwrap_or_else(|| PathBuf::from(format!("{}.svg", file_stem(&world.name))));
        console::check_overwrite(&path, self.force)?;
        let drawing = match self.eye {
            Some(eye) => self.camera_view(&world, eye)?,
            None => plan(&world),
        };
        console::write_file(&path, to_svg_file(drawing).as_bytes())?;
        console::print(&format!("drawing: {}", path.display()))
    }

    fn camera_view(&self, world: &WireframeWorld, place: Point2) -> Result<svg::Document> {
        let rig = StereoRig { camera_height_m: self.camera_height_m, ..StereoRig::reference() };
        let heading = Heading::new(Angle::from_degrees(self.heading_deg)).ok_or_else(|| {
            miette!(help = "give degrees, such as 90", "--heading-deg {} is no heading", self.heading_deg)
        })?;
        let eye = Point3::new(place.x, place.y, rig.camera_height_m);
        let occluders = Occluders::new(&world.surfaces);
        let mut visibility = ViewpointVisibility::new(world, &occluders, eye);
        let scene = camera::left_segments(&camera::observe(&rig, &mut visibility, heading));
        console::remark(&format!("{} segments in view", scene.len()));
        Ok(scene_drawing(&scene, &rig.camera))
    }
}

/// The plan of a world with its free space, if it has any.
fn plan(world: &WireframeWorld) -> svg::Document {
    let free = FreeSpace::of(world, &FreeSpaceOptions::default()).ok().map(|free| worlds::free_cells(&free));
    let plan = FloorPlan::new(Some(world), free.as_ref(), &[]);
    plan.canvas().add(plan.background()).add(plan.scale_bar())
}

/// Where a new world goes.
#[derive(Debug, Args)]
struct WorldOutput {
    /// World file to write [default: the name of the world, .edgeworld].
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Overwrite the world file.
    #[arg(long)]
    force: bool,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

impl WorldOutput {
    fn save(&self, world: &WireframeWorld) -> Result<PathBuf> {
        let path =
            self.output.clone().unwrap_or_else(|| PathBuf::from(format!("{}.edgeworld", file_stem(&world.name))));
        console::check_overwrite(&path, self.force)?;
        file::save(world, &path).into_diagnostic()?;
        Ok(path)
    }
}

/// What is known of a world, as `--format json` prints it.
#[derive(Debug, Serialize)]
struct WorldDescription {
    /// The world file.
    file: PathBuf,
    /// Name, origin, counts and checksum.
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
    fn new(world: &WireframeWorld, path: &Path) -> Self {
        let choice = WorldChoice::File { file: path.to_owned() };
        let points =
            world.edges.iter().flat_map(|edge| [edge.start, edge.end]).map(|point| [point.x, point.y, point.z]);
        let joined = |pick: fn(f32, f32) -> f32| points.clone().reduce(|a, b| [0, 1, 2].map(|i| pick(a[i], b[i])));
        let free_space = FreeSpace::of(world, &FreeSpaceOptions::default());
        Self {
            file: path.to_owned(),
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

    fn print(&self, format: Format) -> Result<()> {
        if format == Format::Json {
            return console::print_json(self);
        }
        let free = self.free_space.as_ref().map(|free| free.description.clone());
        let lines = [
            ("world", self.facts.name.clone()),
            ("file", self.file.display().to_string()),
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

/// A name as part of a file name.
pub(super) fn file_stem(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '-' };
    let stem = name.chars().map(plain).collect::<String>();
    let stem = stem.trim_start_matches('.');
    if stem.is_empty() { "world".to_owned() } else { stem.chars().take(100).collect() }
}

/// A place given as `X,Y` in metres.
pub(super) fn parse_place(text: &str) -> Result<Point2, String> {
    let (x, y) = text.split_once(',').ok_or("write X,Y in metres, such as 3.5,4")?;
    let parse = |number: &str| number.trim().parse::<f32>().map_err(|error| format!("{number:?}: {error}"));
    let place = Point2::new(parse(x)?, parse(y)?);
    if place.is_finite() { Ok(place) } else { Err("the numbers must be finite".to_owned()) }
}

fn parse_axis(text: &str) -> Result<UpAxis, String> {
    match text {
        "x" => Ok(UpAxis::X),
        "y" => Ok(UpAxis::Y),
        "z" => Ok(UpAxis::Z),
        _ => Err("write x, y or z".to_owned()),
    }
}

fn sizes(size_m: [f32; 3]) -> String {
    format!("{:.2} x {:.2} x {:.2}", size_m[0], size_m[1], size_m[2])
}

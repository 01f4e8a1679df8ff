//! `world view`: a world drawn from above or as the camera sees it.

use super::{file_stem, parse_place};
use crate::cli::{console, worlds};
use clap::Args;
use edgeloc::geometry::{Angle, Heading, Point2, Point3, StereoRig};
use edgeloc_sim::camera;
use edgeloc_sim::report::{FloorPlan, scene_drawing, to_svg_file};
use edgeloc_sim::world::{FreeSpace, FreeSpaceOptions, Occluders, ViewpointVisibility, WireframeWorld};
use miette::{Result, miette};
use std::path::PathBuf;

/// Draw a world from above, or as the robot's camera sees it from a place.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  edgeloc world view office-1.edgeworld\n  \
                        edgeloc world view office-1.edgeworld --eye 3,4 --heading-deg 90 -o view.svg")]
pub(in crate::cli) struct View {
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
    pub(super) fn execute(&self) -> Result<()> {
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

//! `world import`: a building that others made becomes a world.

use super::description::{JSON_FIELDS, WorldDescription, sizes};
use super::output::WorldOutput;
use crate::cli::console::{self, Format};
use clap::Args;
use edgeloc_sim::world::import::{ImportOptions, ImportReport, UpAxis, import};
use miette::{IntoDiagnostic, Result};
use serde::Serialize;
use std::path::PathBuf;

/// Import a building that others made: a Gazebo world (.world, .sdf) or a mesh (.dae, .obj, .gltf, .glb).
#[derive(Debug, Args)]
#[command(after_help = format!(
    "Examples:\n  edgeloc world import aws_small_house/worlds/small_house.world\n  \
     edgeloc world import office.world --models my_models --min-edge-m 0.3\n  \
     edgeloc world import scan.obj --obj-unit-m 0.001 --obj-up y\n\n\
     JSON (--format json): world ({JSON_FIELDS}); import (min_edge_m, short_segment_count, textured_material_count, \
     models (name, sources, triangle_count, segment_count, segments_5cm and segments_10cm, those of at least 5 and \
     10 cm, edge_length_m, bounding_box (min_m, max_m)), problems (place, what, remedy), unlisted_problem_count)."
))]
pub(in crate::cli) struct Import {
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
    pub(super) fn execute(&self) -> Result<()> {
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
        "{}, {}, {} shorter than {} m left out, {} taken as mid grey",
        console::count(report.models.len() as u64, "model"),
        console::count(report.segment_count() as u64, "segment"),
        report.short_segment_count,
        report.min_edge_m,
        console::count(report.textured_material_count as u64, "textured material")
    ))?;
    for problem in &report.problems {
        console::remark(&format!("note: {problem}"));
    }
    if report.unlisted_problem_count > 0 {
        let further = console::count(report.unlisted_problem_count as u64, "further problem");
        console::remark(&format!("note: and {further}"));
    }
    Ok(())
}

fn parse_axis(text: &str) -> Result<UpAxis, String> {
    match text {
        "x" => Ok(UpAxis::X),
        "y" => Ok(UpAxis::Y),
        "z" => Ok(UpAxis::Z),
        _ => Err("write x, y or z".to_owned()),
    }
}

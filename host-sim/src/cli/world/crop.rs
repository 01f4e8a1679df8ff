//! `world crop`: one wing of a building as a world of its own.

use super::description::{JSON_FIELDS, WorldDescription};
use super::output::WorldOutput;
use clap::Args;
use edgeloc::geometry::Point2;
use edgeloc_sim::world::{Rectangle, crop, file};
use miette::{IntoDiagnostic, Result, miette};
use std::path::PathBuf;

/// Make a world of one wing of a building: what lies within a rectangle of its floor.
#[derive(Debug, Args)]
#[command(after_help = format!(
    "Examples:\n  edgeloc world crop willowgarage.edgeworld 12,0.5,40,14 -o wing.edgeworld\n  \
     edgeloc world view wing.edgeworld\n\n\
     JSON (--format json): {JSON_FIELDS}."
))]
pub(in crate::cli) struct Crop {
    /// World file (.edgeworld).
    file: PathBuf,
    /// The rectangle: least x and y, greatest x and y [m].
    #[arg(value_name = "X0,Y0,X1,Y1", value_parser = parse_rectangle, allow_hyphen_values = true)]
    rectangle: Rectangle,
    /// Name of the new world [default: that of the whole, -wing].
    #[arg(long)]
    name: Option<String>,
    #[command(flatten)]
    output: WorldOutput,
}

impl Crop {
    pub(super) fn execute(&self) -> Result<()> {
        let whole = file::load(&self.file).into_diagnostic()?;
        let name = self.name.clone().unwrap_or_else(|| format!("{}-wing", whole.name));
        let wing = crop(&whole, &self.rectangle, name);
        if wing.edges.is_empty() {
            return Err(miette!(
                help = "edgeloc world view draws the building with its coordinates",
                "no edge of {} lies within the rectangle",
                self.file.display()
            ));
        }
        let path = self.output.save(&wing)?;
        WorldDescription::new(&wing, &path).print(self.output.format)
    }
}

fn parse_rectangle(text: &str) -> Result<Rectangle, String> {
    let numbers: Vec<f32> = text
        .split(',')
        .map(|number| number.trim().parse::<f32>().map_err(|error| format!("{number:?}: {error}")))
        .collect::<Result<_, _>>()?;
    match numbers[..] {
        [x0, y0, x1, y1] if x0 < x1 && y0 < y1 && numbers.iter().all(|number| number.is_finite()) => {
            Ok(Rectangle { min: Point2::new(x0, y0), max: Point2::new(x1, y1) })
        }
        _ => Err("write X0,Y0,X1,Y1 in metres with X0 < X1 and Y0 < Y1, such as 0,0,20,15".to_owned()),
    }
}

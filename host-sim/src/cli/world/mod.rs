//! `world`: generate, import, crop, describe and draw worlds, and say what is visible in them.

mod crop;
mod description;
mod edit;
mod generate;
mod import;
mod info;
mod output;
mod view;
mod visibility;

use clap::Subcommand;
use edgeloc::geometry::Point2;
use miette::Result;

/// Generate, import, crop, describe and draw worlds, and say what is visible in them.
#[derive(Debug, Subcommand)]
#[command(after_help = "Examples:\n  edgeloc world generate --seed 7\n  edgeloc world import small_house.world\n  \
                        edgeloc world crop willowgarage.edgeworld 12,0.5,40,14\n  \
                        edgeloc world info small_house.edgeworld\n  edgeloc world view small_house.edgeworld\n  \
                        edgeloc world visibility small_house.edgeworld\n  \
                        edgeloc world edit small_house.edgeworld")]
pub(super) enum World {
    Generate(generate::Generate),
    Import(import::Import),
    Crop(crop::Crop),
    Info(info::Info),
    View(view::View),
    Visibility(visibility::Visibility),
    Edit(edit::Edit),
}

impl World {
    pub(super) fn execute(self) -> Result<()> {
        match self {
            Self::Generate(verb) => verb.execute(),
            Self::Import(verb) => verb.execute(),
            Self::Crop(verb) => verb.execute(),
            Self::Info(verb) => verb.execute(),
            Self::View(verb) => verb.execute(),
            Self::Visibility(verb) => verb.execute(),
            Self::Edit(verb) => verb.execute(),
        }
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

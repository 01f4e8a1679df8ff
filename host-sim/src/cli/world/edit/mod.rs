//! `world edit`: shows what is visible from each reference viewpoint in a browser, and lets a person change it.
//!
//! It stands in for the paper's purpose-built graphical interface (section 4.1). The page draws lines; the projection is
//! the library's own, asked for here.

mod editor;
mod http;
mod server;

use super::file_stem;
use crate::cli::{console, worlds};
use clap::Args;
use editor::Editor;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use server::Server;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// Edit by sight what is visible from each reference viewpoint: one page in the browser, served to this machine alone.
///
/// The page shows the wire-frame from any viewpoint, visible edges solid, hidden ones faint; click an edge or draw a
/// rectangle to hide and show, with undo, and save. The address holds a random word without which nothing is answered.
/// Saving replaces the file as a whole, without the # comments that it had, and keeps no copy of the old one: it is
/// text, made for version control.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  edgeloc world edit office-1.edgeworld\n  \
                        edgeloc world edit small_house.edgeworld --views fine.views --no-browser --port 8000")]
pub(in crate::cli) struct Edit {
    /// World file (.edgeworld).
    world: PathBuf,
    /// View-dependency file to edit, which `edgeloc world visibility` writes [default: the name of the world, .views].
    #[arg(long, value_name = "FILE")]
    views: Option<PathBuf>,
    /// Port of this machine to serve at; any free one when not given.
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    port: u16,
    /// Print the address only; open it yourself.
    #[arg(long)]
    no_browser: bool,
}

impl Edit {
    pub(super) fn execute(&self) -> Result<()> {
        let world = worlds::read(&self.world)?;
        let path = self.views.clone().unwrap_or_else(|| PathBuf::from(format!("{}.views", file_stem(&world.name))));
        if !path.exists() {
            return Err(miette!(
                help = format!(
                    "make it from the surfaces first: edgeloc world visibility {} --out {}",
                    self.world.display(),
                    path.display()
                ),
                "there is no view-dependency file {}",
                path.display()
            ));
        }
        let viewpoints = worlds::read_viewpoints(&path, &world)?;
        let server = Server::bind(self.port)
            .into_diagnostic()
            .wrap_err_with(|| format!("port {} of this machine can't be served; --port chooses another", self.port))?;
        let address = server.address();
        console::print(&address)?;
        console::remark("Ctrl-C stops; what was not saved is lost then");
        if !self.no_browser && !open_browser(&address) {
            console::remark("no browser could be started: open the address yourself");
        }
        server.serve(Editor::new(world, path, viewpoints));
        Ok(())
    }
}

/// Asks the system to open an address; whether it took the request.
fn open_browser(address: &str) -> bool {
    let program = if cfg!(target_os = "macos") {
        "open"
    } else if cfg!(windows) {
        "explorer"
    } else {
        "xdg-open"
    };
    let quiet =
        Command::new(program).arg(address).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
    quiet.is_ok()
}

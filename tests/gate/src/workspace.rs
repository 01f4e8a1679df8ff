//! Where the repository is and how its tools are called: every child runs in a folder of the repository, with its
//! output passed straight through, wherever the gate was called from.

use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::summary::Outcome;

/// Environment variables that name a folder, relative to where the gate was called.
const FOLDER_VARIABLES: [&str; 2] = ["CARGO_TARGET_DIR", "EDGELOC_DATA"];

/// The repository and the environment its tools run in.
#[derive(Debug)]
pub(crate) struct Workspace {
    root: PathBuf,
    cargo: OsString,
    /// The folder variables made absolute, since children run elsewhere than the gate was called.
    folders: Vec<(&'static str, PathBuf)>,
    /// Whether what is counted becomes the budget.
    is_blessing: bool,
}

impl Workspace {
    /// The repository this gate belongs to.
    pub(crate) fn find(is_blessing: bool) -> Result<Self, String> {
        // Cargo names the package's folder when it runs us; a gate started by hand remembers where it was built.
        let manifest = env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
        let root = Path::new(&manifest).join("../..");
        let root = root.canonicalize().map_err(|error| format!("no repository at {}: {error}", root.display()))?;
        let here = env::current_dir().map_err(|error| format!("the current folder can't be read: {error}"))?;
        let folders = FOLDER_VARIABLES
            .into_iter()
            .filter_map(|name| {
                env::var_os(name).filter(|value| !value.is_empty()).map(|value| (name, here.join(value)))
            })
            .collect();
        Ok(Self { root, cargo: env::var_os("CARGO").unwrap_or_else(|| "cargo".into()), folders, is_blessing })
    }

    /// Whether what is counted becomes the budget.
    pub(crate) const fn is_blessing(&self) -> bool {
        self.is_blessing
    }

    /// A file of the repository.
    pub(crate) fn file(&self, path: &str) -> PathBuf {
        self.root.join(path)
    }

    /// The folder of the real buildings' data: `EDGELOC_DATA`, else beside the repository.
    pub(crate) fn data_folder(&self) -> PathBuf {
        let named = self.folders.iter().find(|(name, _)| *name == "EDGELOC_DATA");
        named.map_or_else(|| self.root.join("../shared/data"), |(_, folder)| folder.clone())
    }

    /// Cargo in `folder` of the repository with these arguments, split at blanks.
    pub(crate) fn cargo(&self, folder: &str, arguments: &str) -> Command {
        let mut command = self.tool(&self.cargo, folder);
        command.args(arguments.split_whitespace());
        command
    }

    /// A tool to be run in `folder` of the repository.
    pub(crate) fn tool(&self, program: impl AsRef<std::ffi::OsStr>, folder: &str) -> Command {
        let mut command = Command::new(program);
        let folder = if folder.is_empty() { self.root.clone() } else { self.root.join(folder) };
        command.current_dir(folder).stdin(Stdio::null());
        command.envs(self.folders.iter().map(|(name, folder)| (name, folder)));
        command
    }
}

/// Runs every command even after one failed, and names the ones that did.
pub(crate) fn run_all(commands: impl IntoIterator<Item = Command>) -> Outcome {
    let failures: Vec<String> = commands.into_iter().filter_map(|command| run(command).err()).collect();
    if failures.is_empty() { Outcome::Passed } else { Outcome::Failed(failures.join("; ")) }
}

/// Runs all commands at the same time, prints what each said once it has ended, and names the ones that failed; gives
/// what each wrote to its standard output, if none did.
pub(crate) fn run_together<const N: usize>(commands: [Command; N]) -> Result<[String; N], String> {
    let run = |mut command: Command| (announcement(&command), command.output());
    let ended = std::thread::scope(|scope| {
        let running = commands.map(|command| scope.spawn(move || run(command)));
        running.map(|thread| thread.join())
    });
    let mut failures = Vec::new();
    let outputs = ended.map(|ended| {
        let Ok((line, output)) = ended else {
            failures.push("a command could not be awaited".to_owned());
            return String::new();
        };
        println!("    {line}");
        match output {
            Ok(output) => {
                let written = String::from_utf8_lossy(&output.stdout).into_owned();
                print!("{written}{}", String::from_utf8_lossy(&output.stderr));
                if !output.status.success() {
                    failures.push(format!("`{line}`: {}", output.status));
                }
                written
            }
            Err(error) => {
                failures.push(format!("`{line}` can't be started: {error}"));
                String::new()
            }
        }
    });
    if failures.is_empty() { Ok(outputs) } else { Err(failures.join("; ")) }
}

/// Runs one command with its output passed through; the error says which command and how it ended.
pub(crate) fn run(mut command: Command) -> Result<(), String> {
    println!("    {}", announcement(&command));
    let line = command_line(&command);
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("`{line}`: {status}")),
        Err(error) => Err(format!("`{line}` can't be started: {error}")),
    }
}

/// The command as one would type it, and where.
fn announcement(command: &Command) -> String {
    let folder = command.get_current_dir().unwrap_or(Path::new("."));
    format!("{}   (in {})", command_line(command), folder.display())
}

/// The command as one would type it, without the folder of its program.
fn command_line(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let mut line = program.file_name().unwrap_or(program.as_os_str()).to_string_lossy().into_owned();
    for argument in command.get_args() {
        line.push(' ');
        line.push_str(&argument.to_string_lossy());
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str) -> Command {
        let mut command = Command::new("/bin/sh");
        command.args(["-c", script]);
        command
    }

    #[test]
    fn every_command_runs_and_every_failure_is_named() {
        let outcome = run_all([shell("exit 3"), shell("true"), Command::new("/no/such/tool")]);
        let Outcome::Failed(reason) = outcome else { panic!("{outcome:?} hides two failures") };
        assert!(reason.contains("`sh -c exit 3`: exit status: 3"), "{reason}");
        assert!(reason.contains("`tool` can't be started"), "{reason}");
    }

    #[test]
    fn commands_that_succeed_pass() {
        assert_eq!(run_all([shell("true"), shell("exit 0")]), Outcome::Passed);
        assert_eq!(run_together([shell("true"), shell("echo 3")]), Ok([String::new(), "3\n".to_owned()]));
    }

    #[test]
    fn commands_run_together_are_all_awaited_and_every_failure_is_named() {
        let commands = [shell("sleep 0.05; exit 3"), shell("exit 4"), Command::new("/no/such/tool")];
        let reason = run_together(commands).expect_err("all three fail");
        for part in ["sleep 0.05; exit 3   (in .)`: exit status: 3", "exit status: 4", "can't be started"] {
            assert!(reason.contains(part), "{reason}");
        }
    }

    #[test]
    fn children_run_inside_the_repository_with_absolute_folders() {
        let workspace = Workspace {
            root: PathBuf::from("/repository"),
            cargo: "cargo".into(),
            folders: vec![("EDGELOC_DATA", PathBuf::from("/caller/data"))],
            is_blessing: false,
        };
        let command = workspace.cargo("boards", "fmt --check");
        assert_eq!(command.get_current_dir(), Some(Path::new("/repository/boards")));
        assert_eq!(command.get_args().collect::<Vec<_>>(), ["fmt", "--check"]);
        assert!(
            command
                .get_envs()
                .any(|(name, value)| { name == "EDGELOC_DATA" && value == Some(std::ffi::OsStr::new("/caller/data")) })
        );
        assert_eq!(workspace.data_folder(), Path::new("/caller/data"));
    }

    #[test]
    fn the_data_lies_beside_the_repository_unless_named() {
        let workspace = Workspace {
            root: PathBuf::from("/repository"),
            cargo: "cargo".into(),
            folders: Vec::new(),
            is_blessing: false,
        };
        assert_eq!(workspace.data_folder(), Path::new("/repository/../shared/data"));
    }
}

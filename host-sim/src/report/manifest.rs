//! Where a run comes from: program, command, machine, world, time. `manifest.json` is written when the run begins and again,
//! last of all, when it ends: a run is complete when its manifest says when it was finished.

use crate::monte_carlo::Shard;
use crate::scenario::{Building, Scenario, VisibilityChoice, WorldChoice};
use crate::world::WireframeWorld;
use serde::{Deserialize, Serialize};

/// Where a run comes from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of the program.
    pub program_version: String,
    /// Commit the program was built from, with `-dirty` when its sources differ; none outside its repository.
    pub git_commit: Option<String>,
    /// The command line.
    pub command: Vec<String>,
    /// Scenario name.
    pub scenario: String,
    /// Seed of the run.
    pub seed: u64,
    /// The world.
    pub world: WorldFacts,
    /// The machine.
    pub host: HostFacts,
    /// Start, RFC 3339 in UTC.
    pub started_utc: String,
    /// End, RFC 3339 in UTC; none while the run is not complete.
    pub finished_utc: Option<String>,
    /// Which part of the run this is; none when it is the whole.
    #[serde(default)]
    pub shard: Option<Shard>,
    /// Rows of trials.
    pub rows: usize,
    /// Trials of all rows together, in this part.
    pub trials: usize,
}

/// Which world a run took place in.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct WorldFacts {
    /// Its name.
    pub name: String,
    /// Where it came from.
    pub origin: String,
    /// Its file, unless it was generated.
    pub file: Option<String>,
    /// Straight edges.
    pub edges: usize,
    /// Triangles of the surfaces.
    pub triangles: usize,
    /// CRC-64 of edges and surfaces, hexadecimal.
    pub checksum: String,
    /// The view-dependency file, unless the surfaces said what is visible.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub visibility: Option<VisibilityFacts>,
}

/// Which reference viewpoints said what is visible.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct VisibilityFacts {
    /// Their file, when the scenario names one.
    pub file: Option<String>,
    /// How many they are.
    pub viewpoints: usize,
    /// CRC-64 of the file as the program writes it, hexadecimal.
    pub checksum: String,
}

/// The machine a run took place on.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct HostFacts {
    /// Operating system.
    pub os: String,
    /// Processor architecture.
    pub architecture: String,
    /// Processor model, when the system names it.
    pub processor: Option<String>,
    /// Instructions that the localiser used; of a resumed run those it began with.
    #[serde(default)]
    pub instructions: Option<String>,
    /// Threads the machine runs at once.
    pub available_threads: usize,
    /// Threads the run used; of a resumed run those it began with.
    pub used_threads: usize,
}

impl Manifest {
    /// The manifest of a run of `trials` in `world` that begins at `started`, or of a `shard` of it.
    #[must_use]
    pub fn new(
        scenario: &Scenario,
        world: WorldFacts,
        used_threads: usize,
        shard: Option<Shard>,
        trials: usize,
        started: jiff::Timestamp,
    ) -> Self {
        Self {
            program_version: env!("CARGO_PKG_VERSION").to_owned(),
            git_commit: option_env!("EDGELOC_GIT_COMMIT").map(str::to_owned),
            command: Self::command_line(),
            scenario: scenario.name.clone(),
            seed: scenario.seed,
            world,
            host: HostFacts::new(used_threads),
            started_utc: format!("{started:.0}"),
            finished_utc: None,
            shard,
            rows: scenario.rows.len(),
            trials,
        }
    }

    /// The command line of this process.
    #[must_use]
    pub fn command_line() -> Vec<String> {
        std::env::args_os().map(|argument| argument.to_string_lossy().into_owned()).collect()
    }

    /// The same, of a run that is complete now.
    #[must_use]
    pub fn finished(self) -> Self {
        Self { finished_utc: Some(format!("{:.0}", jiff::Timestamp::now())), ..self }
    }

    /// Whether the same program made both runs: version and commit.
    #[must_use]
    pub fn is_of_same_program(&self, other: &Self) -> bool {
        self.program_version == other.program_version && self.git_commit == other.git_commit
    }
}

impl WorldFacts {
    /// The facts of `world`, chosen by `choice`.
    #[must_use]
    pub fn new(world: &WireframeWorld, choice: &WorldChoice) -> Self {
        let file = match &choice.building {
            Building::Office { .. } => None,
            Building::File { file } => Some(file.display().to_string()),
        };
        let views_file = match &choice.visibility {
            VisibilityChoice::Surfaces => None,
            VisibilityChoice::File(file) => Some(file.display().to_string()),
        };
        let visibility = world.reference_viewpoints.as_ref().map(|viewpoints| VisibilityFacts {
            file: views_file,
            viewpoints: viewpoints.viewpoints().len(),
            checksum: format!("{:016x}", viewpoints.checksum()),
        });
        Self {
            name: world.name.clone(),
            origin: world.origin.clone(),
            file,
            edges: world.edges.len(),
            triangles: world.surfaces.triangles.len(),
            checksum: format!("{:016x}", world.checksum()),
            visibility,
        }
    }
}

impl HostFacts {
    fn new(used_threads: usize) -> Self {
        let cpu_info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let model = cpu_info.lines().find(|line| line.starts_with("model name")).and_then(|line| line.split_once(':'));
        Self {
            os: std::env::consts::OS.to_owned(),
            architecture: std::env::consts::ARCH.to_owned(),
            processor: model.map(|(_, model)| model.trim().to_owned()),
            instructions: Some(edgeloc::matching::body_name().to_owned()),
            available_threads: std::thread::available_parallelism().map_or(1, usize::from),
            used_threads,
        }
    }
}

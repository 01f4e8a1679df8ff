//! `explore`: the robot explores a world, and what came of it.

use super::console::{self, Format};
use super::scenario_args::ScenarioArguments;
use super::world::{file_stem, parse_place};
use super::{progress, worlds};
use clap::Args;
use edgeloc::explore::Ending;
use edgeloc::geometry::Point2;
use edgeloc_sim::learning::{self, COVER_REACH_M, Exploration, ExplorationProgress, ExploringRobot};
use edgeloc_sim::report::{FloorPlan, FreeCells, exploration_plan, to_svg_file};
use edgeloc_sim::world::{FreeSpace, FreeSpaceOptions, RangeSensorOptions, WireframeWorld};
use miette::{IntoDiagnostic, Result, miette};
use serde::Serialize;
use std::path::PathBuf;

/// Let the robot explore a world by wall following from a start it does not know, and drop the nodes along its path.
///
/// The robot has a range sensor of 360 rays, 8 m and 1 cm of noise, as high as itself; its odometry is exact. Doors to the
/// outside count as closed. `run`, `learn` and `locate` use such nodes with --set learning.placement=explore; for the same
/// world, seed and number of nodes they are the ones shown here without --start.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  edgeloc explore\n  \
                        edgeloc explore --world small_house.edgeworld --nodes 47\n  \
                        edgeloc explore --world small_house.edgeworld --start 5,-2 --seed 3 --out path.svg\n  \
                        edgeloc run paper --set learning.placement=explore\n\n\
                        JSON (--format json): ending (explored, closed_room or step_limit), reachable_m2 as the robot \
                        found it, free_m2, coverage (share of it within 1.5 m of the path, round walls), length_m, \
                        scans, collisions, least_clearance_m from the robot's center, start and nodes (x_m, y_m), \
                        drawing.")]
pub(super) struct Explore {
    #[command(flatten)]
    scenario: ScenarioArguments,
    /// Where the robot is put down [m]; drawn by seed when not given.
    #[arg(long, value_name = "X,Y", value_parser = parse_place, allow_hyphen_values = true)]
    start: Option<Point2>,
    /// Drawing to write [default: explore-<scenario>.svg].
    #[arg(short, long, visible_alias = "out", value_name = "FILE")]
    output: Option<PathBuf>,
    /// Overwrite the drawing.
    #[arg(long)]
    force: bool,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

impl Explore {
    pub(super) fn execute(self) -> Result<()> {
        let Some(scenario) = self.scenario.load()? else { return Ok(()) };
        let default_output = || PathBuf::from(format!("explore-{}.svg", file_stem(&scenario.name)));
        let path = self.output.clone().unwrap_or_else(default_output);
        if path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("svg")) {
            let help = "a browser shows SVG files: give a name that ends in .svg";
            return Err(miette!(help = help, "{} would not be a drawing", path.display()));
        }
        console::check_overwrite(&path, self.force)?;
        let wheel = progress::wheel("looking for free space");
        let world = worlds::open(&scenario)?;
        let space = self.free_space(&world)?;
        let robot = ExploringRobot::new(&world, &space, &RangeSensorOptions::default());
        let start = self.start.unwrap_or_else(|| learning::random_start(&space, scenario.seed));
        let tell = |so_far: &ExplorationProgress| {
            let ExplorationProgress { scans, length_m, covered_m2 } = so_far;
            wheel.say(format!("exploring: {scans} scans, {length_m:.0} m of path, {covered_m2:.0} m2 covered"));
        };
        let exploration = learning::explore(&space, &robot, start, scenario.seed, tell).into_diagnostic()?;
        let nodes = exploration.drop_nodes(&space, usize::from(scenario.learning.nodes)).into_diagnostic()?;
        drop(wheel);
        let plan = FloorPlan::new(Some(&world), Some(&worlds::free_cells(&space)), &nodes);
        let [covered, missed] = floor(&space, &exploration);
        let drawing = exploration_plan(&plan, &exploration, &covered, &missed);
        console::write_file(&path, to_svg_file(drawing).as_bytes())?;
        Report::new(&space, &exploration, &nodes, path).print(&space, self.format)
    }

    /// What can be reached from the start; the largest region when none is given.
    fn free_space(&self, world: &WireframeWorld) -> Result<FreeSpace> {
        let options = FreeSpaceOptions::default();
        self.start
            .map_or_else(|| FreeSpace::of(world, &options), |start| FreeSpace::around(world, &options, start))
            .into_diagnostic()
    }
}

/// The cells that were covered and those that were not, as the plan draws them.
fn floor(space: &FreeSpace, exploration: &Exploration) -> [FreeCells; 2] {
    let is_covered = exploration.covered_cells(space);
    let free = worlds::free_cells(space);
    [true, false].map(|wanted| {
        let cells = free.centers.iter().zip(&is_covered);
        let centers = cells.filter(|&(_, &is_covered)| is_covered == wanted).map(|(&center, _)| center).collect();
        FreeCells { centers, ..free.clone() }
    })
}

/// What came of it, as `--format json` prints it.
#[derive(Debug, Serialize)]
struct Report {
    ending: &'static str,
    reachable_m2: Option<f32>,
    free_m2: f64,
    coverage: f64,
    length_m: f64,
    scans: usize,
    collisions: usize,
    least_clearance_m: f32,
    start: Place,
    nodes: Vec<Place>,
    drawing: PathBuf,
}

#[derive(Debug, Serialize)]
struct Place {
    x_m: f32,
    y_m: f32,
}

impl From<Point2> for Place {
    fn from(point: Point2) -> Self {
        Self { x_m: point.x, y_m: point.y }
    }
}

impl Report {
    fn new(space: &FreeSpace, exploration: &Exploration, nodes: &[Point2], drawing: PathBuf) -> Self {
        let (ending, reachable_m2) = match exploration.ending {
            Ending::Explored { reachable_m2 } => ("explored", Some(reachable_m2)),
            Ending::ClosedRoom { reachable_m2 } => ("closed_room", Some(reachable_m2)),
            Ending::StepLimit => ("step_limit", None),
        };
        Self {
            ending,
            reachable_m2,
            free_m2: space.area_m2(),
            coverage: exploration.coverage(space),
            length_m: exploration.length_m(),
            scans: exploration.path.len(),
            collisions: exploration.collision_count,
            least_clearance_m: exploration.least_clearance_m,
            start: exploration.path[0].into(),
            nodes: nodes.iter().map(|&node| node.into()).collect(),
            drawing,
        }
    }

    fn print(&self, space: &FreeSpace, format: Format) -> Result<()> {
        if format == Format::Json {
            return console::print_json(self);
        }
        let ending = match (self.ending, self.reachable_m2) {
            ("closed_room", Some(m2)) => format!("a closed room of {m2:.1} m2, explored; no way leads out of it"),
            (_, Some(m2)) => format!("explored: {m2:.1} m2 can be reached, and nothing is left to see"),
            _ => "gave up: as many motions as the robot may make".to_owned(),
        };
        let elsewhere = match space.other_region_count() {
            0 => String::new(),
            count => {
                let regions = console::count(count as u64, "other indoor region");
                format!("; {regions} of {:.1} m2 can't be reached from it", space.other_regions_m2())
            }
        };
        let lines = [
            ("robot says", ending),
            ("start", format!("{:.2}, {:.2} m", self.start.x_m, self.start.y_m)),
            ("free space", format!("{:.1} m2{elsewhere}", self.free_m2)),
            (
                "coverage",
                format!("{:.1} % of it within {COVER_REACH_M} m of the path, round walls", 100.0 * self.coverage),
            ),
            ("path", format!("{:.1} m, {}", self.length_m, console::count(self.scans as u64, "scan"))),
            (
                "collisions",
                format!("{}; least clearance of its center {:.2} m", self.collisions, self.least_clearance_m),
            ),
            ("nodes", format!("{}, evenly where the path leads over new ground", self.nodes.len())),
            ("drawing", self.drawing.display().to_string()),
        ];
        console::print(&console::facts(&lines).to_string())
    }
}

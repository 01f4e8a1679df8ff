//! `calibrate`: the parameters of a stereo rig from matched corners, simulated or of a file.

use super::console::{self, Format};
use super::scenario_args::ScenarioArguments;
use super::worlds;
use clap::Args;
use edgeloc::geometry::{Point2, StereoRig};
use edgeloc::stereo::{Calibration, CalibrationUpdate, CornerPair, PARAMETERS, ParameterVector, StereoParameters};
use edgeloc_sim::learning::{CalibrationBench, bench_prior};
use edgeloc_sim::scenario::Scenario;
use edgeloc_sim::world::{FreeSpace, FreeSpaceOptions, Occluders};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Calibrate a stereo rig from matched corners (the paper's equation 2): parameters, standard errors, correlations.
///
/// Without --corners the robot of the scenario calibrates itself from twelve views of its world, its bench calibration
/// and every corner off as the uncertainty sources say: the covariance found is what psi_c = 1 stands for. With --corners
/// the pairs of a file count, and the scenario's [rig] is what was known before.
///
/// Corner pairs can't tell the length of the baseline, hardly the focal length, and not how far the two optical centres
/// lie apart along the rows: there the standard error stays that of the prior.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  edgeloc calibrate\n  \
                        edgeloc calibrate --set uncertainty.corner_detection_loss.magnitude=0.5\n  \
                        edgeloc calibrate --corners pairs.csv --prior-times 5 --set rig.focal_length_px=520\n\n\
                        File of corners: CSV with a header; columns left_x_px, left_y_px, right_x_px, right_y_px.\n\n\
                        JSON (--format json): used_pairs, rejected_pairs, chi_squared (of the pairs used, one each \
                        expected), parameters (name, symbol, unit, prior, prior_error, estimate, standard_error, truth \
                        if simulated), correlations (row by row).")]
pub(super) struct Calibrate {
    #[command(flatten)]
    scenario: ScenarioArguments,
    /// Corner pairs to calibrate from.
    #[arg(long, value_name = "FILE")]
    corners: Option<PathBuf>,
    /// With --corners: how many times as vague as after a bench calibration the prior is.
    #[arg(long, value_name = "TIMES", default_value_t = 1.0, requires = "corners")]
    prior_times: f64,
    /// With --corners: standard deviation of a corner's position in pixels.
    #[arg(long, value_name = "PX", default_value_t = 0.15, requires = "corners")]
    noise_px: f64,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// One matched corner of a file.
#[derive(Debug, Deserialize)]
struct CornerLine {
    left_x_px: f32,
    left_y_px: f32,
    right_x_px: f32,
    right_y_px: f32,
}

/// What is printed.
#[derive(Debug, Serialize)]
struct Found {
    used_pairs: usize,
    rejected_pairs: usize,
    chi_squared: f64,
    parameters: Vec<Parameter>,
    correlations: Vec<Vec<f64>>,
}

/// One parameter of the rig.
#[derive(Debug, Serialize)]
struct Parameter {
    name: &'static str,
    symbol: &'static str,
    unit: &'static str,
    prior: f64,
    prior_error: f64,
    estimate: f64,
    standard_error: f64,
    truth: Option<f64>,
}

impl Calibrate {
    pub(super) fn execute(self) -> Result<()> {
        let Some(scenario) = self.scenario.load()? else { return Ok(()) };
        let rig = scenario.rig.stereo_rig().map_err(|reason| miette!("[rig] {reason}"))?;
        let found = match &self.corners {
            Some(path) => self.of_corners(path, &rig)?,
            None => simulated(&scenario, &rig)?,
        };
        if self.format == Format::Json { console::print_json(&found) } else { found.print() }
    }

    fn of_corners(&self, path: &Path, rig: &StereoRig) -> Result<Found> {
        let unreadable = || format!("the corners of {} can't be read", path.display());
        let mut reader = csv::Reader::from_path(path).into_diagnostic().wrap_err_with(unreadable)?;
        let mut pairs = Vec::new();
        for line in reader.deserialize() {
            let line: CornerLine = line.into_diagnostic().wrap_err_with(unreadable)?;
            pairs.push(CornerPair {
                left: Point2::new(line.left_x_px, line.left_y_px),
                right: Point2::new(line.right_x_px, line.right_y_px),
            });
        }
        let before = bench_prior(&StereoParameters::ideal(rig), self.prior_times).into_diagnostic()?;
        let mut after = before.clone();
        let update = after.update(&pairs, self.noise_px).into_diagnostic()?;
        if update.used_pairs < PARAMETERS.len() {
            console::remark(&format!(
                "note: {} can't tell {} parameters: most of what follows is the prior",
                console::count(update.used_pairs as u64, "corner pair"),
                PARAMETERS.len()
            ));
        }
        Found::new(&before, &after, &[update], None)
    }
}

/// The scenario's robot calibrates itself.
fn simulated(scenario: &Scenario, rig: &StereoRig) -> Result<Found> {
    let world = worlds::open(scenario)?;
    let occluders = Occluders::new(&world.surfaces);
    let free_space = FreeSpace::of(&world, &FreeSpaceOptions::default()).into_diagnostic()?;
    let bench = CalibrationBench::observe(rig, &world, &occluders, &free_space, scenario.seed);
    let calibration = bench.calibrate(&scenario.uncertainty, scenario.seed);
    Found::new(&calibration.before, &calibration.after, &calibration.updates, Some(&calibration.truth))
}

impl Found {
    fn new(
        before: &Calibration,
        after: &Calibration,
        updates: &[CalibrationUpdate],
        truth: Option<&StereoParameters>,
    ) -> Result<Self> {
        let covariance = after.covariance().into_diagnostic()?;
        let (prior_error, error) =
            (before.standard_errors().into_diagnostic()?, after.standard_errors().into_diagnostic()?);
        let (prior, estimate) = (before.estimate().to_vector(), after.estimate().to_vector());
        let truth: Option<ParameterVector> = truth.map(StereoParameters::to_vector);
        let parameter = |index: usize| Parameter {
            name: PARAMETERS[index].name,
            symbol: PARAMETERS[index].symbol,
            unit: PARAMETERS[index].unit,
            prior: prior[index],
            prior_error: prior_error[index],
            estimate: estimate[index],
            standard_error: error[index],
            truth: truth.map(|truth| truth[index]),
        };
        let indices = 0..PARAMETERS.len();
        let correlations = indices.clone().map(|row| {
            let with = |column: usize| covariance[(row, column)] / (error[row] * error[column]);
            indices.clone().map(with).collect()
        });
        Ok(Self {
            used_pairs: updates.iter().map(|update| update.used_pairs).sum(),
            rejected_pairs: updates.iter().map(|update| update.rejected_pairs).sum(),
            chi_squared: updates.iter().map(|update| update.chi_squared).sum(),
            parameters: indices.clone().map(parameter).collect(),
            correlations: correlations.collect(),
        })
    }

    fn print(&self) -> Result<()> {
        let mut table = console::table(&["parameter", "prior", "estimate", "error in its standard errors"]);
        for parameter in &self.parameters {
            let with_error = |value: f64, error: f64| format!("{value:.5} +- {error:.5} {}", parameter.unit);
            table.add_row([
                format!("{} ({})", parameter.name, parameter.symbol),
                with_error(parameter.prior, parameter.prior_error),
                with_error(parameter.estimate, parameter.standard_error),
                parameter.truth.map_or_else(String::new, |truth| {
                    format!("{:+.1}", (parameter.estimate - truth) / parameter.standard_error)
                }),
            ]);
        }
        console::print(&table.to_string())?;
        console::print(&format!(
            "{} used, {} left out as wrong matches; chi-squared {:.1}",
            console::count(self.used_pairs as u64, "corner pair"),
            self.rejected_pairs,
            self.chi_squared
        ))?;
        console::print(&format!("strongest correlations: {}", self.strongest_correlations(5).join(", ")))
    }

    fn strongest_correlations(&self, count: usize) -> Vec<String> {
        let below = |row: usize| (0..row).map(move |column| (row, column));
        let mut places: Vec<(usize, usize)> = (0..self.parameters.len()).flat_map(below).collect();
        let size = |&(row, column): &(usize, usize)| self.correlations[row][column].abs();
        places.sort_by(|a, b| size(b).total_cmp(&size(a)));
        let describe = |&(row, column): &(usize, usize)| {
            let symbol = |index: usize| self.parameters[index].symbol;
            format!("{} and {} {:+.2}", symbol(column), symbol(row), self.correlations[row][column])
        };
        places.iter().take(count).map(describe).collect()
    }
}

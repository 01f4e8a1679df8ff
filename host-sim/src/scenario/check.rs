//! The legal range of every value of a scenario.

use super::error::IllegalValue;
use super::{Building, LocalizerKind, LocalizerSettings, Scenario, VisibilityChoice};
use edgeloc::geometry::StereoRig;
use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::Path;

impl Scenario {
    /// Longest name of a scenario or row, in bytes.
    pub const MAX_NAME_BYTES: usize = 100;
    /// Most trials of all rows together.
    pub const MAX_TOTAL_TRIALS: u64 = 1_000_000;

    /// Finds the first value outside its legal range.
    ///
    /// # Errors
    /// The key, its value, the legal range and the remedy.
    pub fn check(&self) -> Result<(), IllegalValue> {
        self.check_values()?;
        self.check_rows()
    }

    /// Everything but the rows.
    pub(super) fn check_values(&self) -> Result<(), IllegalValue> {
        self.check_name()?;
        within("seed", self.seed, 0..=i64::MAX as u64, "TOML integers have 63 bits; choose a smaller seed")?;
        within("trials", self.trials, 1..=1_000_000, "500 trials give rates to about 3 points")?;
        within("trials_per_map", self.trials_per_map, 1..=1_000_000, "50 is the default")?;
        within("near_radius_m", self.near_radius_m, 0.0..=10.0, "a near start lies within 0.3 m of a node by default")?;
        within("learning.nodes", self.learning.nodes, 1..=4096, "the paper's office has 72")?;
        within("learning.withheld", self.learning.withheld, 0.0..=0.9, "0.25 leaves places that no map knows")?;
        within("learning.views", self.learning.views, 1..=360, "12 views, 30 degrees apart, cover the circle")?;
        within("learning.max_segments", self.learning.max_segments, 1..=u16::MAX, "700 are 8.4 kB a node")?;
        self.check_world()?;
        self.check_rig()?;
        check_localizer(&self.localizer)?;
        self.check_uncertainty()?;
        self.check_sensors()
    }

    /// Whether the robot has what its localiser can't do without.
    fn check_sensors(&self) -> Result<(), IllegalValue> {
        let (compass, odometry) = (&self.uncertainty.compass, &self.uncertainty.odometry);
        let (legal, does) = match self.localizer.kind {
            LocalizerKind::Paper => ("true: the paper's localiser asks for a heading", compass.available),
            LocalizerKind::Edgeloc => {
                let looks_once = self.localizer.max_looks == 1;
                ("true, of a robot without odometry", compass.available || odometry.available || looks_once)
            }
        };
        require(does, "uncertainty.compass.available", &compass.available, legal, || {
            "every trial would fail; give the robot a compass, or the localiser of kind edgeloc and odometry".to_owned()
        })
    }

    fn check_name(&self) -> Result<(), IllegalValue> {
        let fits_a_file_name = !self.name.is_empty()
            && self.name.len() <= Self::MAX_NAME_BYTES
            && !self.name.starts_with('.')
            && self.name.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"-_.".contains(&byte));
        require(
            fits_a_file_name,
            "name",
            &self.name,
            "1 to 100 letters, digits, '-', '_' or '.', not '.' first",
            || "it names the folder of the run; choose another name".to_owned(),
        )
    }

    fn check_world(&self) -> Result<(), IllegalValue> {
        let is_text = |key, file: &Path| {
            require(file.to_str().is_some(), key, &file.display(), "a path in UTF-8", || {
                "the scenario of a run is written as text; rename the file or its folder".to_owned()
            })
        };
        if let Building::File { file } = &self.world.building {
            is_text("world.file", file)?;
        }
        match &self.world.visibility {
            VisibilityChoice::File(file) => is_text("world.visibility", file),
            VisibilityChoice::Surfaces => Ok(()),
        }
    }

    fn check_rig(&self) -> Result<StereoRig, IllegalValue> {
        self.rig.stereo_rig().map_err(|reason| IllegalValue {
            row: None,
            key: "rig".to_owned(),
            value: format!("{:?}", self.rig),
            legal: reason,
            remedy: "the bundled scenario paper states each range: `edgeloc run paper --print-config`".to_owned(),
        })
    }

    fn check_uncertainty(&self) -> Result<(), IllegalValue> {
        let Err(error) = self.uncertainty.clone().checked() else { return Ok(()) };
        let (number, (low, high)) = (error.number, error.number.legal_range);
        let key = format!("uncertainty.{}.{}", error.facts.key, number.key);
        require(false, &key, &number.value, &format!("{low} to {high}{}", error.unit()), || {
            format!("the default is {}; to switch the source off set its enabled = false", number.default)
        })
    }

    fn check_rows(&self) -> Result<(), IllegalValue> {
        let count = self.rows.len();
        require((1..=100).contains(&count), "rows", &format!("{count} rows"), "1 to 100 rows", || {
            "add a [[rows]] table with name, start and polarity".to_owned()
        })?;
        let total = self.total_trials();
        let legal = format!("at most {} trials of all rows together", Self::MAX_TOTAL_TRIALS);
        let value = format!("{} in each of {count} rows, or as they state", self.trials);
        require(total <= Self::MAX_TOTAL_TRIALS, "trials", &value, &legal, || {
            "the results of a larger run could not be read back; lower trials, or run the rows apart".to_owned()
        })?;
        for (index, row) in self.rows.iter().enumerate() {
            let key = format!("rows.{index}.name");
            let readable = !row.name.is_empty()
                && row.name.len() <= Self::MAX_NAME_BYTES
                && !row.name.chars().any(char::is_control);
            require(readable, &key, &row.name, "1 to 100 bytes without control characters", || {
                "choose a short, readable name".to_owned()
            })?;
            let is_new = self.rows[..index].iter().all(|other| other.name != row.name);
            require(is_new, &key, &row.name, "a name that no other row has", || {
                "rows are told apart by name in trials.csv; rename one of the two".to_owned()
            })?;
        }
        self.settings().map(|_| ())
    }
}

fn check_localizer(localizer: &LocalizerSettings) -> Result<(), IllegalValue> {
    let LocalizerSettings { pgh, verification, .. } = localizer;
    within("localizer.score_margin", localizer.score_margin, 0.0..=1000.0, "the paper's B_th is 0.1")?;
    within("localizer.turn_deg", localizer.turn_deg, -360.0..=360.0, "the paper turns by 30 degrees")?;
    within("localizer.max_looks", localizer.max_looks, 1..=1000, "12 looks of 30 degrees close the circle")?;
    within("localizer.min_length_px", localizer.min_length_px, 0.0..=2048.0, "12 px is the default")?;
    within("localizer.horizontal_exclusion_deg", localizer.horizontal_exclusion_deg, 0.0..=89.0, "5 is the default")?;
    within("localizer.max_segments", localizer.max_segments, 1..=1024, "150 is the default")?;
    within("localizer.shortlist", localizer.shortlist, 1..=4096, "300 is the default")?;
    within("localizer.pgh.distance_bins", pgh.distance_bins, 1..=256, "the paper's best is 15")?;
    within("localizer.pgh.angle_bins", pgh.angle_bins, 1..=256, "the paper's best is 32")?;
    within("localizer.pgh.max_distance_px", pgh.max_distance_px, 1.0..=2048.0, "200 to 600 hardly matter")?;
    within("localizer.verification.cells_per_side", verification.cells_per_side, 3..=31, "7 is the default")?;
    within("localizer.verification.reach", verification.reach, 0.1..=2.0, "0.8 is the default")?;
    within("localizer.verification.headings", verification.headings, 1..=9, "4 without a compass")?;
    let cells = verification.cells_per_side;
    require(cells % 2 == 1, "localizer.verification.cells_per_side", &cells, "an odd number", || {
        "the node lies in the middle; add one".to_owned()
    })?;
    within("localizer.verification.confidence", verification.confidence, 0.0..=100.0, "0.4 is the default")?;
    within("localizer.verification.refined", verification.refined, 1..=256, "56 is the default")?;
    let finalists = verification.finalists;
    within("localizer.verification.finalists", finalists, 1..=verification.refined, "at most as many as are refined")?;
    within("localizer.verification.moves", verification.moves, 0..=15, "2 is the default; 0 asks for none")?;
    within(
        "localizer.verification.move_m",
        verification.move_m,
        0.25..=10.0,
        "1 m is the default; moves = 0 asks for none",
    )?;
    let covered_px = pgh.max_distance_px * if pgh.signed { 2.0 } else { 1.0 };
    let bin_px = covered_px / f64::from(pgh.distance_bins);
    require(
        (0.25..=1024.0).contains(&bin_px),
        "localizer.pgh.distance_bins",
        &format!("{} (bins of {bin_px} px)", pgh.distance_bins),
        "bins of 0.25 to 1024 px",
        || "change distance_bins or max_distance_px".to_owned(),
    )
}

/// Refuses `value` outside `legal`; NaN is always outside.
fn within<T: PartialOrd + Display + Copy>(
    key: &str,
    value: T,
    legal: RangeInclusive<T>,
    remedy: &str,
) -> Result<(), IllegalValue> {
    let range = format!("{} to {}", legal.start(), legal.end());
    require(legal.contains(&value), key, &value, &range, || format!("choose a value in the range; {remedy}"))
}

fn require(
    is_legal: bool,
    key: &str,
    value: &dyn Display,
    legal: &str,
    remedy: impl FnOnce() -> String,
) -> Result<(), IllegalValue> {
    if is_legal {
        return Ok(());
    }
    Err(IllegalValue {
        row: None,
        key: key.to_owned(),
        value: value.to_string(),
        legal: legal.to_owned(),
        remedy: remedy(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::WorldChoice;

    fn refused(change: impl FnOnce(&mut Scenario)) -> String {
        let mut scenario = Scenario::default();
        change(&mut scenario);
        scenario.check().expect_err("an illegal value").key
    }

    #[test]
    fn the_default_is_legal() {
        assert_eq!(Scenario::default().check(), Ok(()));
    }

    #[test]
    fn an_illegal_value_is_named() {
        assert_eq!(refused(|s| s.trials = 0), "trials");
        assert_eq!(refused(|s| s.seed = u64::MAX), "seed");
        assert_eq!(refused(|s| s.near_radius_m = f64::NAN), "near_radius_m");
        assert_eq!(refused(|s| s.name = "../up".to_owned()), "name");
        assert_eq!(refused(|s| s.learning.max_segments = 0), "learning.max_segments");
        assert_eq!(refused(|s| s.rig.baseline_m = 0.0), "rig");
        assert_eq!(refused(|s| s.localizer.turn_deg = 361.0), "localizer.turn_deg");
        assert_eq!(refused(|s| s.localizer.pgh.angle_bins = 257), "localizer.pgh.angle_bins");
        assert_eq!(refused(|s| s.localizer.pgh.max_distance_px = 1.0), "localizer.pgh.distance_bins");
        let key = refused(|s| s.uncertainty.stereo_match.magnitude = 0.2);
        assert_eq!(key, "uncertainty.stereo_match.magnitude");
        assert_eq!(refused(|s| s.rows.clear()), "rows");
        assert_eq!(refused(|s| s.trials = 250_001), "trials");
        assert_eq!(refused(|s| s.learning.withheld = 1.0), "learning.withheld");
        assert_eq!(refused(|s| s.rows[1].start = crate::scenario::Start::Unlearned), "rows.1.set.learning.withheld");
        assert_eq!(refused(|s| s.rows[1].name = s.rows[0].name.clone()), "rows.1.name");
    }

    #[test]
    fn a_robot_without_what_its_localiser_needs_is_refused() {
        let sensors = |kind, has_compass, has_odometry| {
            let mut scenario = Scenario::default();
            scenario.localizer.kind = kind;
            scenario.uncertainty.compass.available = has_compass;
            scenario.uncertainty.odometry.available = has_odometry;
            scenario.check().map_err(|error| error.key)
        };
        let refused = Err("uncertainty.compass.available".to_owned());
        assert_eq!(sensors(LocalizerKind::Paper, false, true), refused);
        assert_eq!(sensors(LocalizerKind::Edgeloc, false, false), refused);
        assert_eq!(sensors(LocalizerKind::Edgeloc, false, true), Ok(()));
        assert_eq!(sensors(LocalizerKind::Edgeloc, true, false), Ok(()));
    }

    #[cfg(unix)]
    #[test]
    fn a_world_path_that_no_text_can_hold_is_refused() {
        use std::os::unix::ffi::OsStrExt;
        let file = std::path::PathBuf::from(std::ffi::OsStr::from_bytes(b"a\xff.edgeworld"));
        assert_eq!(refused(|s| s.world = WorldChoice::file(file.clone())), "world.file");
        assert_eq!(refused(|s| s.world.visibility = VisibilityChoice::File(file.clone())), "world.visibility");
    }
}

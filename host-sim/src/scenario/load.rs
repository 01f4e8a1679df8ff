//! Reading a scenario: bundled values < file < `--set`, and writing it back whole.

use super::{Preset, Scenario, ScenarioError, preset::PRESETS};
use miette::{NamedSource, SourceSpan};
use std::io::Read;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;
use toml::de::{DeTable, DeValue};

/// Longest scenario file in bytes.
const MAX_FILE_BYTES: u64 = 1 << 20;

impl Scenario {
    /// The scenario called `name` (a bundled one, else a file) with `settings` (`key=value`) on top, checked. A file called
    /// like a bundled scenario is meant by `./edgeloc`: what else lies in the current folder changes no run.
    ///
    /// Relative paths of a world and its view-dependency file count from the scenario file's folder, those of a setting
    /// from the current one; they are made absolute.
    ///
    /// # Errors
    /// When there is no such scenario, its text or a setting can't be understood, or a value is not legal.
    pub fn load(name: &str, settings: &[String]) -> Result<Self, ScenarioError> {
        let path = Path::new(name);
        let (origin, text, mut scenario) = match Preset::find(name) {
            Some(preset) => (preset.name, preset.text.to_owned(), Self::parse(preset.text, preset.name)?),
            None => {
                let text = read_limited(name)?;
                let mut scenario = Self::parse(&text, name)?;
                scenario.complete_from_path(path, &text);
                (name, text, scenario)
            }
        };
        for setting in settings {
            scenario = scenario.with_setting(setting)?;
        }
        scenario.world.complete_paths(Path::new(""));
        scenario.check().map_err(|illegal| {
            // The caret helps only when the file, not a setting, gave the value.
            let is_set = settings.iter().any(|setting| setting.split('=').next() == Some(&illegal.key));
            let place = if is_set { None } else { place_of(&text, &illegal.key) };
            let text = place.is_some().then(|| Arc::new(NamedSource::new(origin, text.clone())));
            ScenarioError::Illegal { illegal: Box::new(illegal), text, place }
        })?;
        Ok(scenario)
    }

    /// The scenario that `text` describes, over the default values; not checked. `origin` names it in errors.
    ///
    /// # Errors
    /// When the text is not TOML, or a key is unknown or of the wrong kind.
    pub fn parse(text: &str, origin: &str) -> Result<Self, ScenarioError> {
        toml::from_str(text).map_err(|error| ScenarioError::Text {
            origin: origin.to_owned(),
            reason: error.message().to_owned(),
            text: Arc::new(NamedSource::new(origin, text.to_owned())),
            place: error.span().map(SourceSpan::from),
        })
    }

    /// The scenario with one `key=value` changed; not checked.
    ///
    /// The value is TOML; what is not TOML is taken as text, so that names need no quotes.
    ///
    /// # Errors
    /// When the key is unknown or the value of the wrong kind.
    pub fn with_setting(&self, setting: &str) -> Result<Self, ScenarioError> {
        let refused = |reason: String| ScenarioError::Setting { setting: setting.to_owned(), reason };
        let (key, value) = setting.split_once('=').ok_or_else(|| refused("there is no '=' in it".to_owned()))?;
        let (key, value) = (key.trim(), parse_value(value.trim()));
        let mut root = toml::Value::try_from(self).map_err(|error| refused(error.to_string()))?;
        make_room(&mut root, key);
        insert(&mut root, key, value).map_err(refused)?;
        root.try_into().map_err(|error: toml::de::Error| refused(error.message().to_owned()))
    }

    /// The whole scenario as TOML that reads back as the same scenario.
    #[must_use]
    pub fn to_toml(&self) -> String {
        toml::to_string(self).expect("every field of a checked scenario has a TOML form")
    }

    /// Fills in what a file leaves to its path: the name, and the folder that a world's path counts from.
    fn complete_from_path(&mut self, path: &Path, text: &str) {
        if place_of(text, "name").is_none()
            && let Some(stem) = path.file_stem()
        {
            self.name = stem.to_string_lossy().into_owned();
        }
        self.world.complete_paths(path.parent().unwrap_or(Path::new("")));
    }
}

fn read_limited(name: &str) -> Result<String, ScenarioError> {
    let path = Path::new(name);
    if !path.is_file() {
        let bundled = PRESETS.iter().map(|preset| preset.name).collect::<Vec<_>>().join(", ");
        return Err(ScenarioError::Unknown { name: name.to_owned(), bundled });
    }
    let mut text = String::new();
    std::fs::File::open(path)
        .and_then(|file| file.take(MAX_FILE_BYTES + 1).read_to_string(&mut text))
        .and_then(|length| match length as u64 {
            0..=MAX_FILE_BYTES => Ok(()),
            _ => Err(std::io::Error::other("it is longer than 1 MB")),
        })
        .map_err(|source| ScenarioError::Unreadable { path: path.to_owned(), source })?;
    Ok(text)
}

/// The value as TOML, or as text when it is not TOML.
fn parse_value(value: &str) -> toml::Value {
    toml::from_str::<toml::Table>(&format!("value = {value}"))
        .ok()
        .and_then(|mut table| if table.len() == 1 { table.remove("value") } else { None })
        .unwrap_or_else(|| toml::Value::String(value.to_owned()))
}

/// A world is a kind or a file: setting one of the two takes the other away.
fn make_room(root: &mut toml::Value, key: &str) {
    let Some(world) = root.get_mut("world").and_then(toml::Value::as_table_mut) else { return };
    match key {
        "world.file" => world.retain(|key, _| key == "file" || key == "visibility"),
        "world.kind" => world.retain(|key, _| key != "file"),
        _ => {}
    }
}

/// Puts `value` at the dotted `key`; a number in the key is an index into a list.
pub(super) fn insert(root: &mut toml::Value, key: &str, value: toml::Value) -> Result<(), String> {
    if let Some((row, change)) = key.split_once(".set.") {
        let table = row.split('.').try_fold(root, child).and_then(toml::Value::as_table_mut);
        let row = table.ok_or_else(|| format!("there is no {row:?} to set {change:?} in"))?;
        let changes = row.entry("set").or_insert_with(|| toml::Value::Table(toml::Table::new()));
        changes.as_table_mut().ok_or("set is a table of keys")?.insert(change.to_owned(), value);
        return Ok(());
    }
    let (parent, last) = key.rsplit_once('.').map_or((None, key), |(parent, last)| (Some(parent), last));
    let mut place = root;
    for part in parent.into_iter().flat_map(|parent| parent.split('.')) {
        place = child(place, part).ok_or_else(|| format!("there is no {part:?} to set {key:?} in"))?;
    }
    // An unknown last key of a table is added: reading the scenario back refuses it and lists the known ones.
    if let toml::Value::Table(table) = place {
        table.insert(last.to_owned(), value);
    } else {
        *child(place, last).ok_or_else(|| format!("there is no {last:?} to set in {key:?}"))? = value;
    }
    Ok(())
}

fn child<'a>(parent: &'a mut toml::Value, part: &str) -> Option<&'a mut toml::Value> {
    match parent {
        toml::Value::Table(table) => table.get_mut(part),
        toml::Value::Array(list) => list.get_mut(part.parse::<usize>().ok()?),
        _ => None,
    }
}

/// Where the value of the dotted `key` stands in `text`.
fn place_of(text: &str, key: &str) -> Option<SourceSpan> {
    let document = DeTable::parse(text).ok()?;
    let span: Range<usize> = span_in(document.get_ref(), &key.split('.').collect::<Vec<_>>())?;
    Some(span.into())
}

/// Where the value at a path of keys stands; a key may itself be dotted, in quotes, and so take several parts.
fn span_in(table: &DeTable<'_>, path: &[&str]) -> Option<Range<usize>> {
    (1..=path.len()).find_map(|taken| {
        let (key, mut rest) = (path[..taken].join("."), &path[taken..]);
        let mut value = table.get(key.as_str())?;
        while let (DeValue::Array(list), Some((index, after))) = (value.get_ref(), rest.split_first()) {
            (value, rest) = (list.get(index.parse::<usize>().ok()?)?, after);
        }
        match value.get_ref() {
            _ if rest.is_empty() => Some(value.span()),
            DeValue::Table(inner) => span_in(inner, rest),
            _ => None,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::NodePlacement;
    use crate::scenario::{Building, LocalizerKind, Start, VisibilityChoice, WorldChoice};
    use crate::uncertainty::PolarityFlips;
    use std::path::PathBuf;

    fn load_text(text: &str, settings: &[&str]) -> Result<Scenario, ScenarioError> {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("mine.toml");
        std::fs::write(&path, text).expect("a written file");
        let settings = settings.iter().map(|&setting| setting.to_owned()).collect::<Vec<_>>();
        Scenario::load(path.to_str().expect("UTF-8"), &settings)
    }

    #[test]
    fn the_bundled_paper_setting_states_exactly_the_default() {
        assert_eq!(Scenario::load("paper", &[]).expect("bundled"), Scenario::default());
    }

    #[test]
    fn the_bundled_edgeloc_has_the_default_localiser_and_one_edge_in_twenty_flipped() {
        let edgeloc = Scenario::load("edgeloc", &[]).expect("bundled");
        let mut expected = Scenario { name: "edgeloc".to_owned(), rows: edgeloc.rows.clone(), ..Scenario::default() };
        expected.learning.placement = NodePlacement::Coverage;
        expected.learning.max_segments = 700;
        expected.uncertainty.polarity_flips = PolarityFlips { enabled: true, magnitude: 0.05 };
        expected.uncertainty.odometry.enabled = true;
        expected.learning.join = true;
        expected.localizer.kind = LocalizerKind::Edgeloc;
        (expected.localizer.turn_deg, expected.localizer.max_looks) = (60.0, 6);
        assert_eq!(edgeloc, expected);
        let starts = edgeloc.rows.iter().map(|row| row.start);
        assert_eq!(starts.collect::<Vec<_>>(), [Start::Anywhere, Start::Near, Start::Unlearned]);
    }

    #[test]
    fn studies_of_the_default_localiser_begin_with_it_and_the_demo_has_it_beside_the_papers() {
        let row_of = |preset: &str, row: usize| {
            let scenario = Scenario::load(preset, &[]).expect("bundled");
            let setting = scenario.settings().expect("legal").swap_remove(row).scenario;
            (setting.localizer, setting.learning, setting.uncertainty)
        };
        let default = row_of("edgeloc", 0);
        assert_eq!((row_of("stress", 0), row_of("ablation", 0)), (default.clone(), default.clone()));
        assert_eq!(row_of("demo", 1), default);
        let paper = Scenario::default();
        assert_eq!(row_of("demo", 0), (paper.localizer, paper.learning, default.2));
    }

    #[test]
    fn the_bundled_paper_has_its_own_sources_on_and_ours_off() {
        let paper = Scenario::load("paper", &[]).expect("bundled").uncertainty;
        for source in paper.pipeline() {
            let is_ours = source.facts().citation == "ours";
            assert_eq!(source.is_enabled(), !is_ours, "{}", source.facts().key);
        }
    }

    #[test]
    fn every_bundled_scenario_is_legal_and_named_as_listed() {
        for preset in PRESETS {
            assert_eq!(Scenario::load(preset.name, &[]).expect("legal").name, preset.name);
        }
    }

    #[test]
    fn a_scenario_written_out_reads_back_the_same() {
        for preset in PRESETS {
            let scenario = Scenario::load(preset.name, &[]).expect("bundled");
            assert_eq!(Scenario::parse(&scenario.to_toml(), "written").expect("readable"), scenario);
        }
    }

    #[test]
    fn settings_lie_over_the_file_and_the_file_over_the_bundled_values() {
        let scenario = load_text("trials = 7\n[learning]\nnodes = 9\n", &["learning.nodes=5", "rows.0.start=anywhere"])
            .expect("legal");
        assert_eq!((scenario.trials, scenario.learning.nodes, scenario.learning.views), (7, 5, 12));
        assert_eq!((scenario.name.as_str(), scenario.rows[0].start), ("mine", Start::Anywhere));
    }

    #[test]
    fn the_british_localiser_is_understood_and_written_american() {
        let scenario = load_text("[localiser]\nturn_deg = 60.0\n", &["localizer.max_looks=5"]).expect("legal");
        assert_eq!((scenario.localizer.turn_deg, scenario.localizer.max_looks), (60.0, 5));
        assert!(!scenario.to_toml().contains("localiser"));
    }

    #[test]
    fn a_world_is_a_seed_or_a_file_whichever_is_set_last() {
        let file = load_text("", &["world.file=/a/b.edgeworld"]).expect("legal");
        assert_eq!(file.world, WorldChoice::file(PathBuf::from("/a/b.edgeworld")));
        let office = load_text("[world]\nfile = \"b.edgeworld\"", &["world.kind=office", "world.seed=4"]);
        assert_eq!(office.expect("legal").world, WorldChoice::office(4));
    }

    #[test]
    fn a_relative_world_counts_from_the_scenario_file() {
        let text = "[world]\nfile = \"b.edgeworld\"\nvisibility = \"b.views\"";
        let world = load_text(text, &[]).expect("legal").world;
        let WorldChoice { building: Building::File { file }, visibility: VisibilityChoice::File(views) } = world else {
            panic!("files were given");
        };
        assert!(file.is_absolute() && file.ends_with("b.edgeworld"));
        assert_eq!(file.with_file_name("b.views"), views);
    }

    #[test]
    fn what_is_visible_say_the_surfaces_or_a_file_whatever_the_building() {
        let settings = ["world.visibility=a.views", "world.kind=office", "world.seed=3"];
        let scenario = load_text("[world]\nfile = \"b.edgeworld\"", &settings).expect("legal");
        assert_eq!(scenario.world.building, Building::Office { seed: 3 });
        let here = std::path::absolute("a.views").expect("a current folder");
        assert_eq!(scenario.world.visibility, VisibilityChoice::File(here));
        let back = scenario.with_setting("world.visibility=surfaces").expect("understood");
        assert_eq!(back.world, WorldChoice::office(3));
    }

    #[test]
    fn errors_point_at_the_key() {
        for (text, settings, expected) in [
            ("[localizer]\nturn = 30\n", &[][..], "unknown field `turn`"),
            ("trials = \"many\"\n", &[], "invalid type"),
            ("trials = \n", &[], "can't be understood"),
            ("", &["localizer.turn=30"], "unknown field `turn`"),
            ("", &["nowhere.turn=30"], "nowhere"),
            ("", &["trials"], "no '='"),
            ("", &["rows.9.polarity=true"], "no \"9\""),
            ("", &["rows.9.set.localizer.turn_deg=3"], "no \"rows.9\""),
            ("", &["rows.1.set.localizer.turn_deg=400"], "in row \"near, no polarity\""),
            ("[learning]\nnodes = 0\n", &[], "learning.nodes = 0 is not legal; legal: 1 to 4096"),
            ("[uncertainty.stereo_match]\nmagnitude = 2\n", &[], "stereo_match.magnitude = 2 is not legal"),
            ("", &["uncertainty.edge_detection_loss.magnitude=1"], "takes 0 to 0.3125"),
            ("[world]\nkind = \"office\"\nfile = \"x\"\n", &[], "keep one of the two"),
            ("[world]\nvisibility = \"\"\n", &[], "write \"surfaces\", or the path"),
        ] {
            let message = load_text(text, settings).expect_err("illegal").to_string();
            assert!(message.contains(expected), "{message:?} lacks {expected:?}");
        }
    }

    #[test]
    fn an_illegal_value_is_underlined_where_it_stands() {
        let row = "[[rows]]\nname = \"odd\"\nstart = \"near\"\npolarity = true\n";
        for text in [
            "trials = 3\n[learning]\nnodes = 0\n".to_owned(),
            format!("{row}set = {{ near_radius_m = 1, \"learning.nodes\" = 0 }}"),
            format!("{row}set.learning.nodes = 0"),
        ] {
            let Err(ScenarioError::Illegal { place: Some(place), .. }) = load_text(&text, &[]) else {
                panic!("an illegal value with its place: {text}");
            };
            assert_eq!(&text[place.offset()..place.offset() + place.len()], "0");
        }
    }

    #[test]
    fn a_row_is_given_values_from_the_command_line() {
        let settings = ["rows.0.set.localizer.turn_deg=60", "rows.0.trials=3"];
        let scenario = load_text("", &settings).expect("legal");
        let setting = scenario.setting(None).expect("a first row").expect("legal");
        assert_eq!((setting.scenario.localizer.turn_deg, setting.scenario.trials), (60.0, 3));
    }
}

//! `sources`: every uncertainty source, what it is and how a scenario sets it.

use super::console::{self, Format};
use super::scenario_args::ScenarioArguments;
use clap::Args;
use edgeloc_sim::scenario::Scenario;
use edgeloc_sim::uncertainty::UncertaintySource;
use miette::{IntoDiagnostic, Result};
use serde::Serialize;

/// List the uncertainty sources: what goes wrong, how strongly, when, and where that is known from.
///
/// Each source is a table [uncertainty.<source>] of a scenario with enabled and magnitude; set them in a file or by
/// --set, for instance --set uncertainty.compass.enabled=true. Magnitude 0 changes nothing. Each has random draws of its
/// own: switching one on or off leaves those of the others as they are.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  edgeloc sources\n  edgeloc sources edgeloc\n  edgeloc sources my.toml --format json\n\n\
                        JSON (--format json): a list, in the order in which they act: key = table in a scenario, name, \
                        symbol, unit, default (enabled, magnitude), legal_low and legal_high of the magnitude, acts_in, \
                        cause, citation, and set, the source's table in this scenario, a key and a value each."
)]
pub(super) struct Sources {
    #[command(flatten)]
    scenario: ScenarioArguments,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// One source, as `--format json` prints it.
#[derive(Debug, Serialize)]
struct SourcePrinted {
    /// Table in a scenario.
    key: &'static str,
    /// Name for people.
    name: &'static str,
    /// The paper's symbol, or nothing.
    symbol: &'static str,
    /// Unit of the magnitude.
    unit: &'static str,
    /// How it is set unless configured.
    default: DefaultPrinted,
    /// Least magnitude allowed.
    legal_low: f64,
    /// Greatest magnitude allowed.
    legal_high: f64,
    /// When it acts.
    acts_in: String,
    /// What causes the error.
    cause: &'static str,
    /// Where that is known from.
    citation: &'static str,
    /// How the scenario sets it.
    set: Vec<KeyPrinted>,
}

/// One key of a source's table.
#[derive(Debug, Serialize)]
struct KeyPrinted {
    /// Its name.
    key: String,
    /// What it is set to.
    value: toml::Value,
}

/// The default of a source.
#[derive(Debug, Serialize)]
struct DefaultPrinted {
    /// Whether it acts.
    enabled: bool,
    /// How strongly.
    magnitude: f64,
}

impl SourcePrinted {
    fn new(source: &dyn UncertaintySource, settings: &toml::Table) -> Self {
        let facts = source.facts();
        let table = settings.get(facts.key).and_then(toml::Value::as_table).into_iter().flatten();
        Self {
            key: facts.key,
            name: facts.name,
            symbol: facts.symbol,
            unit: facts.unit,
            default: DefaultPrinted { enabled: facts.is_enabled_by_default, magnitude: facts.default_magnitude },
            legal_low: facts.legal_range.0,
            legal_high: facts.legal_range.1,
            acts_in: facts.acts_in.to_string(),
            cause: facts.cause,
            citation: facts.citation,
            set: table.map(|(key, value)| KeyPrinted { key: key.clone(), value: value.clone() }).collect(),
        }
    }

    /// How the scenario sets it, in a few words.
    fn set_in_words(&self) -> String {
        let (mut state, mut magnitude, mut more) = ("", String::new(), String::new());
        for KeyPrinted { key, value } in &self.set {
            match (key.as_str(), value.as_bool()) {
                ("enabled", Some(true)) => {}
                ("enabled", _) => state = "off; ",
                ("magnitude", _) => magnitude = value.to_string(),
                _ => more.push_str(&format!("\n{key} = {value}")),
            }
        }
        format!("{state}{magnitude}{more}")
    }
}

impl Sources {
    pub(super) fn execute(self) -> Result<()> {
        let Some(scenario) = self.scenario.load()? else { return Ok(()) };
        let sources = printed(&scenario)?;
        if self.format == Format::Json {
            return console::print_json(&sources);
        }
        let header = ["source", "symbol", "unit", "default", "legal", "acts in", &format!("in {}", scenario.name)];
        let mut table = console::table(&header);
        for source in &sources {
            let off = if source.default.enabled { "" } else { "off; " };
            table.add_row([
                source.key.to_owned(),
                source.symbol.to_owned(),
                source.unit.to_owned(),
                format!("{off}{}", source.default.magnitude),
                format!("{} to {}", source.legal_low, source.legal_high),
                source.acts_in.clone(),
                source.set_in_words(),
            ]);
        }
        console::print(&table.to_string())?;
        let causes = sources.iter().map(|source| format!("{}: {} ({})", source.key, source.cause, source.citation));
        console::print(&causes.collect::<Vec<_>>().join("\n"))
    }
}

fn printed(scenario: &Scenario) -> Result<Vec<SourcePrinted>> {
    let settings = toml::Table::try_from(&scenario.uncertainty).into_diagnostic()?;
    Ok(scenario.uncertainty.pipeline().into_iter().map(|source| SourcePrinted::new(source, &settings)).collect())
}

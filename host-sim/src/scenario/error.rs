//! Why a scenario is refused: the place, the reason and the remedy.

use miette::{Diagnostic, NamedSource, SourceSpan};
use std::path::PathBuf;
use std::sync::Arc;
use thiserror::Error;

/// Why a scenario is refused.
#[derive(Debug, Error, Diagnostic)]
pub enum ScenarioError {
    /// Neither a bundled scenario nor a file.
    #[error("no scenario {name:?}: there is no such file, and no bundled scenario of that name")]
    #[diagnostic(help("bundled scenarios: {bundled}; or give the path of a scenario file (.toml)"))]
    Unknown {
        /// What was asked for.
        name: String,
        /// Names of the bundled scenarios.
        bundled: String,
    },
    /// The file can't be read.
    #[error("scenario file {} can't be read: {source}", path.display())]
    #[diagnostic(help("a scenario is a UTF-8 text file of at most 1 MB; see `edgeloc run paper --print-config`"))]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The text is not a scenario: broken TOML, an unknown key or a value of the wrong kind.
    #[error("scenario {origin} can't be understood: {reason}")]
    #[diagnostic(help("all keys with their ranges: `edgeloc run paper --print-config`"))]
    Text {
        /// The file or bundled scenario.
        origin: String,
        /// What is wrong.
        reason: String,
        /// The text, for the caret.
        #[source_code]
        text: Arc<NamedSource<String>>,
        /// Where in the text.
        #[label("here")]
        place: Option<SourceSpan>,
    },
    /// A `--set` can't be applied.
    #[error("setting {setting:?} can't be applied: {reason}")]
    #[diagnostic(help(
        "write --set KEY=VALUE with a dotted key, such as --set localizer.turn_deg=60 or --set rows.0.polarity=false; \
         all keys: `edgeloc run paper --print-config`"
    ))]
    Setting {
        /// The setting as given.
        setting: String,
        /// What is wrong.
        reason: String,
    },
    /// A value is outside its legal range.
    #[error("{illegal}")]
    #[diagnostic(help("{}", illegal.remedy))]
    Illegal {
        /// The key, its value and its range.
        illegal: Box<IllegalValue>,
        /// The scenario file's text, when the value stands in it.
        #[source_code]
        text: Option<Arc<NamedSource<String>>>,
        /// Where in the text.
        #[label("legal: {}", illegal.legal)]
        place: Option<SourceSpan>,
    },
}

/// A value outside its legal range.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{}{key} = {value} is not legal; legal: {legal}", row.as_ref().map(|row| format!("in row {row:?}: ")).unwrap_or_default())]
pub struct IllegalValue {
    /// The row that sets it; none when the scenario itself does.
    pub row: Option<String>,
    /// The dotted key, such as `localizer.turn_deg`.
    pub key: String,
    /// The value found.
    pub value: String,
    /// What would be legal.
    pub legal: String,
    /// What to do.
    pub remedy: String,
}

impl IllegalValue {
    /// The same, of a value that the row at `index` called `name` sets.
    pub(super) fn in_row(self, index: usize, name: &str) -> Self {
        let key = if self.key == "trials" { "trials".to_owned() } else { format!("set.{}", self.key) };
        Self { row: Some(name.to_owned()), key: format!("rows.{index}.{key}"), ..self }
    }
}

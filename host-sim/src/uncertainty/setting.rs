//! What is the same in every source: the value that a scenario sets, and what is known of it however it is set.

/// How a source is set; written by the `source!` of its file.
pub trait SourceSetting {
    /// What is known of the source however it is set.
    fn facts(&self) -> &'static SourceFacts;

    /// Whether the source acts.
    fn is_enabled(&self) -> bool;

    /// How strongly it acts, in the unit of its facts; 0 changes nothing.
    fn magnitude(&self) -> f64;

    /// Its magnitude and the other numbers of its setting.
    fn numbers(&self) -> Vec<SourceNumber>;
}

/// One number of a source's setting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SourceNumber {
    /// Name of its key in the source's table.
    pub key: &'static str,
    /// What it is set to.
    pub value: f64,
    /// What it is unless configured.
    pub default: f64,
    /// Least and greatest value allowed.
    pub legal_range: (f64, f64),
}

/// The unchanging part of a source: its row in tables and its place among the random streams.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SourceFacts {
    /// Name of its table in a scenario file.
    pub key: &'static str,
    /// Name for people.
    pub name: &'static str,
    /// Symbol of its magnitude in the paper; empty where the paper has none.
    pub symbol: &'static str,
    /// Unit of its magnitude.
    pub unit: &'static str,
    /// Number of its random stream, never reused: it keeps draws apart and old runs replayable.
    pub stream_id: u16,
    /// Whether it acts unless configured: the paper's sources do, ours do not.
    pub is_enabled_by_default: bool,
    /// Magnitude unless configured.
    pub default_magnitude: f64,
    /// Least and greatest magnitude allowed.
    pub legal_range: (f64, f64),
    /// When it acts.
    pub acts_in: ActsIn,
    /// What causes the error and how it is simulated.
    pub cause: &'static str,
    /// Where cause and magnitude come from.
    pub citation: &'static str,
}

/// When a source acts.
///
/// Whatever happens to an image happens while learning too. What acts in looks alone is what differs from the day of
/// learning, or what a careful learner keeps out: its map is made standing level, along headings that many readings and
/// odometry agree on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ActsIn {
    /// While the world is learned.
    Learning,
    /// While the robot calibrates its cameras, before it learns.
    Calibration,
    /// In the looks of a trial.
    Looks,
    /// In learning and in looks alike.
    Both,
}

impl std::fmt::Display for ActsIn {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Learning => "learning",
            Self::Calibration => "calibration",
            Self::Looks => "looks",
            Self::Both => "learning and looks",
        })
    }
}

/// Declares the value of a source: its switch and magnitude with the defaults of its facts, fields of its own with
/// theirs (numbers with their legal range: `pub share: f64 in 0.0 to 1.0 = 0.5,`), and the [`SourceSetting`] that reads
/// them.
macro_rules! source {
    (
        $(#[doc = $doc:literal])*
        pub struct $source:ident: $facts:ident {
            $(
                $(#[doc = $field_doc:literal])*
                pub $field:ident: $kind:ident $(in $low:literal to $high:literal)? = $default:expr,
            )*
        }
    ) => {
        $(#[doc = $doc])*
        #[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
        #[serde(deny_unknown_fields, default)]
        pub struct $source {
            /// Whether the source acts.
            pub enabled: bool,
            /// How strongly it acts, in the unit of its facts.
            pub magnitude: f64,
            $($(#[doc = $field_doc])* pub $field: $kind,)*
        }

        impl Default for $source {
            fn default() -> Self {
                Self {
                    enabled: $facts.is_enabled_by_default,
                    magnitude: $facts.default_magnitude,
                    $($field: $default,)*
                }
            }
        }

        impl $crate::uncertainty::SourceSetting for $source {
            fn facts(&self) -> &'static $crate::uncertainty::SourceFacts {
                &$facts
            }

            fn is_enabled(&self) -> bool {
                self.enabled
            }

            fn magnitude(&self) -> f64 {
                self.magnitude
            }

            fn numbers(&self) -> Vec<$crate::uncertainty::SourceNumber> {
                vec![
                    $crate::uncertainty::SourceNumber {
                        key: "magnitude",
                        value: self.magnitude,
                        default: $facts.default_magnitude,
                        legal_range: $facts.legal_range,
                    },
                    $($($crate::uncertainty::SourceNumber {
                        key: stringify!($field),
                        value: self.$field,
                        default: $default,
                        legal_range: ($low, $high),
                    },)?)*
                ]
            }
        }
    };
}

pub(super) use source;

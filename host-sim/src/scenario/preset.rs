//! The bundled scenarios: `paper`, the paper's setting in the bundled office and the base of every other scenario;
//! `edgeloc`, our localiser with what a robot of ours has to expect; and a quick one.

/// A bundled scenario.
#[derive(Debug, Clone, Copy)]
pub struct Preset {
    /// Name, as given on the command line.
    pub name: &'static str,
    /// What it is for.
    pub summary: &'static str,
    /// Its TOML text.
    pub text: &'static str,
}

/// The bundled scenarios.
pub const PRESETS: &[Preset] = &[
    Preset {
        name: "paper",
        summary: "the paper's setting in the generated office, 500 trials each of four rows",
        text: include_str!("../../scenarios/paper.toml"),
    },
    Preset {
        name: "edgeloc",
        summary: "our localiser there, with 5 % of the edges of each look bright on the other side than learned",
        text: include_str!("../../scenarios/edgeloc.toml"),
    },
    Preset {
        name: "smoke",
        summary: "the paper's on a small scale, a few seconds: does everything work?",
        text: include_str!("../../scenarios/smoke.toml"),
    },
    Preset {
        name: "figures",
        summary: "the settings of the paper's figures 4 and 5, 900 trials each",
        text: include_str!("../../scenarios/figures.toml"),
    },
    Preset {
        name: "paper-scale",
        summary: "77 settings and 74,110 trials, as many as the paper counts",
        text: include_str!("../../scenarios/paper-scale.toml"),
    },
];

impl Preset {
    /// The preset called `name`.
    #[must_use]
    pub fn find(name: &str) -> Option<&'static Self> {
        PRESETS.iter().find(|preset| preset.name == name)
    }
}

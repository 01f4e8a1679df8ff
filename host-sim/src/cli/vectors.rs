//! Which vector instructions the localiser may use.

use clap::ValueEnum;
use miette::{Result, ensure};

/// Sets of vector instructions, narrow to wide.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum Vectors {
    /// What every x86-64 has.
    Sse2,
    /// Twice as wide.
    Avx2,
    /// Four times as wide, with VNNI.
    #[value(name = "avx-512")]
    Avx512,
}

impl Vectors {
    /// Does without wider ones from now on.
    pub(super) fn set(self) -> Result<()> {
        let (name, best) = (self.name(), edgeloc::matching::body_name());
        ensure!(
            limit(name) == name,
            "this machine has no {name} for the localiser: leave --vectors out, and it uses {best}"
        );
        Ok(())
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Sse2 => "SSE2",
            Self::Avx2 => "AVX2",
            Self::Avx512 => "AVX-512 VNNI",
        }
    }
}

#[cfg(target_arch = "x86_64")]
fn limit(name: &str) -> &'static str {
    edgeloc::matching::limit_body(name)
}

#[cfg(not(target_arch = "x86_64"))]
fn limit(_: &str) -> &'static str {
    edgeloc::matching::body_name()
}

//! A histogram as characters, so that a failing test shows what was built.
//!
//! One row for each angle bin, one column for each distance bin; the darkest character is the fullest bin.

use super::Histogram;
use std::fmt;

/// From empty to fullest. Only an empty bin is blank: anything at all shows at least as a dot.
const SHADES: &[u8] = b" .:-=+*#%@";

/// Shows a [`Histogram`] as a character map.
#[derive(Debug, Clone, Copy)]
pub struct CharacterMap<'a>(pub &'a Histogram);

impl fmt::Display for CharacterMap<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let fullest = self.0.masses.iter().copied().fold(0.0, f64::max);
        for angle_bin in 0..self.0.angle_bins {
            write!(f, "{angle_bin:3} |")?;
            for distance_bin in 0..self.0.distance_bins {
                write!(f, "{}", shade(self.0.mass(distance_bin, angle_bin), fullest))?;
            }
            writeln!(f, "|")?;
        }
        Ok(())
    }
}

fn shade(mass: f64, fullest: f64) -> char {
    if mass <= 0.0 {
        return ' ';
    }
    let darkest = SHADES.len() - 1;
    char::from(SHADES[((mass / fullest * darkest as f64).ceil() as usize).clamp(1, darkest)])
}

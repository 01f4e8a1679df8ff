//! The sites of a run: one for each way of learning among its rows, all in one building.

use super::{Site, SiteError};
use crate::scenario::{IllegalValue, Scenario, Setting, Start, first_alike};
use crate::world::WireframeWorld;

/// The rows of a scenario, each with the site it takes place in.
#[derive(Debug)]
pub struct Sites {
    settings: Vec<Setting>,
    sites: Vec<Site>,
    site_of_row: Vec<usize>,
    first_alike: Vec<usize>,
    trials_per_map: u32,
}

impl Sites {
    /// Makes the building ready for every row; rows that learn alike share a site.
    ///
    /// # Errors
    /// When a row is not legal, or its nodes can't be placed.
    pub fn prepare(world: WireframeWorld, scenario: &Scenario) -> Result<Self, PrepareError> {
        let settings = scenario.settings().map_err(|illegal| PrepareError::Row { illegal: Box::new(illegal) })?;
        let firsts: Vec<usize> = (0..settings.len()).filter(|&row| row == learns_like(&settings, row)).collect();
        let mut sites = vec![Site::prepare(world, settings.first().map_or(scenario, |first| &first.scenario))?];
        for &row in firsts.iter().skip(1) {
            sites.push(sites[0].learned_anew(&settings[row].scenario)?);
        }
        let site_of = |row| firsts.iter().position(|&first| first == learns_like(&settings, row)).unwrap_or(0);
        let site_of_row: Vec<usize> = (0..settings.len()).map(site_of).collect();
        for (setting, &site) in settings.iter().zip(&site_of_row) {
            sites[site].check_start(setting.row.start)?;
        }
        let first_alike = first_alike(&settings);
        Ok(Self { settings, sites, site_of_row, first_alike, trials_per_map: scenario.trials_per_map })
    }

    /// The rows, in the scenario's order.
    #[must_use]
    pub fn settings(&self) -> &[Setting] {
        &self.settings
    }

    /// Every site, in order of the first row that takes place there.
    #[must_use]
    pub fn all(&self) -> &[Site] {
        &self.sites
    }

    /// The site of a row, by the row's index.
    ///
    /// # Panics
    /// When there is no such row.
    #[must_use]
    pub fn of_row(&self, row: usize) -> &Site {
        &self.sites[self.site_of_row[row]]
    }

    /// Trials of the row that has most of them.
    #[must_use]
    pub fn trials(&self) -> u32 {
        self.settings.iter().map(|setting| setting.scenario.trials).max().unwrap_or(0)
    }

    pub(super) const fn trials_per_map(&self) -> u32 {
        self.trials_per_map
    }

    /// Whether two rows differ in name alone, or in how many trials they have.
    pub(super) fn are_alike(&self, a: usize, b: usize) -> bool {
        self.first_alike[a] == self.first_alike[b]
    }

    /// Whether two rows learn the same map with each draw of noise.
    pub(super) fn share_map(&self, a: usize, b: usize) -> bool {
        let sources = |row: usize| &self.settings[row].scenario.uncertainty;
        // Maps state what the verifying localiser goes by, which takes time to measure, for those who need it.
        let kind = |row: usize| self.settings[row].scenario.localizer.kind;
        self.site_of_row[a] == self.site_of_row[b] && sources(a) == sources(b) && kind(a) == kind(b)
    }

    /// Whether two rows put the robot down at the same poses. Free space is that of the building without what is
    /// withheld; what is near, or far, depends on the nodes.
    pub(super) fn share_pose(&self, a: usize, b: usize) -> bool {
        let radius = |row: usize| self.settings[row].scenario.near_radius_m.to_bits();
        let withheld = |row: usize| self.settings[row].scenario.learning.withheld.to_bits();
        match (self.settings[a].row.start, self.settings[b].row.start) {
            (Start::Anywhere, Start::Anywhere) => withheld(a) == withheld(b),
            (Start::Unlearned, Start::Unlearned) => self.site_of_row[a] == self.site_of_row[b],
            (Start::Near, Start::Near) => self.site_of_row[a] == self.site_of_row[b] && radius(a) == radius(b),
            _ => false,
        }
    }
}

/// The first row that learns like `row`.
fn learns_like(settings: &[Setting], row: usize) -> usize {
    let learning = |setting: &Setting| setting.scenario.learning;
    settings.iter().position(|other| learning(other) == learning(&settings[row])).unwrap_or(row)
}

/// Why the sites of a run can't be made ready.
#[derive(Debug, thiserror::Error)]
pub enum PrepareError {
    /// A row is not legal.
    #[error("{illegal}; {}", illegal.remedy)]
    Row {
        /// The row, its value and the remedy.
        illegal: Box<IllegalValue>,
    },
    /// The building does not do.
    #[error(transparent)]
    Site(#[from] SiteError),
}

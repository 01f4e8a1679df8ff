//! The nodes that a first stage chooses, look after look.

use super::headings::Headings;
use super::hypothesis::Hypothesis;
use super::kept_looks::KeptLooks;
use super::slots::Slots;
use crate::geometry::Segment2;
use crate::gist::Code;
use crate::localize::first_stage::FirstStage;

/// The first stage with the gists of all looks so far.
#[derive(Debug)]
pub(super) struct Shortlist<'m> {
    stage: FirstStage<'m>,
    /// A gist for each look.
    codes: &'m mut [Code],
    /// Scratch: as many nodes as there are slots.
    chosen: &'m mut [u32],
}

impl<'m> Shortlist<'m> {
    pub(super) fn new(stage: FirstStage<'m>, codes: &'m mut [Code], chosen: &'m mut [u32]) -> Self {
        Self { stage, codes, chosen }
    }

    /// Forgets all looks.
    pub(super) fn clear(&mut self) {
        self.stage.clear();
    }

    /// Keeps the gist of a look.
    pub(super) fn keep(&mut self, look: usize, segments: &[Segment2]) {
        if let Some(place) = self.codes.get_mut(look) {
            *place = self.stage.code(segments);
        }
    }

    /// Takes the last of `looks` into account, all of them if the headings changed, and gives the most similar nodes grids;
    /// nodes of `kept` hypotheses keep theirs.
    pub(super) fn choose(
        &mut self,
        slots: &mut Slots<'_>,
        (looks, headings, changed): (&KeptLooks<'_>, &Headings, bool),
        kept: &[Hypothesis],
        renew: impl FnMut(usize),
    ) {
        if changed {
            self.stage.clear();
        }
        let first = if changed { 0 } else { looks.count() - 1 };
        for (look, code) in self.codes.iter().enumerate().take(looks.count()).skip(first) {
            let pose = looks.pose(look);
            // The index tells of the places at the first look; a look from elsewhere says nothing of them.
            if pose.is_elsewhere() {
                continue;
            }
            let heading_rad = pose.heading_rad;
            self.stage.add(code, headings.errors_rad().iter().map(|error| heading_rad + error));
        }
        let room = self.chosen.len() - kept.len().min(self.chosen.len() / 2);
        let mut count = 0;
        for (place, node) in self.chosen.iter_mut().zip(self.stage.best(room)) {
            *place = node.0;
            count += 1;
        }
        slots.choose(&self.chosen[..count], kept, renew);
    }
}

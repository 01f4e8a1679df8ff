//! From coarse to close: the grid about every node, then ever closer poses about the best of it.

use super::cameras::BATCH;
use super::check::{Checker, Closeness};
use super::dominant::DominantDirection;
use super::evidence::CellEvidence;
use super::headings::Headings;
use super::hypothesis::{Hypothesis, keep_best};
use super::judgement::seen_weight;
use super::kept_looks::KeptLooks;
use super::models::Model;
use super::shortlist::Shortlist;
use super::slots::Slots;
use super::spacing::reach_m;
use super::{Evidence, VerificationConfig};
use crate::database::TopologicalDatabase;
use crate::math;

/// Positions tried along either side of the square about a hypothesis.
const SIDE: usize = 4;
/// Poses tried about a hypothesis at a heading.
const POSITIONS: usize = SIDE * SIDE;
/// Headings tried about a hypothesis, where the compass errs.
const HEADINGS: usize = 3;
/// Poses tried about a hypothesis.
pub(super) const CHILDREN: usize = HEADINGS * POSITIONS;
/// Confidence of the best of the grid over a hypothesis that is not worth a closer look.
const HOPELESS_LEAD: f32 = 0.7;
/// Hypotheses nearer to each other than this are at the same place \[m\].
const PLACE_APART_M: f32 = 0.5;

/// How a hypothesis is posed more closely.
#[derive(Debug, Clone, Copy)]
struct Stage {
    /// Step of the position in cells of the grid: stage by stage the poses fill the cell.
    step: f32,
    /// Step of the heading, in what the grid leaves it to be off.
    heading_step: f32,
    /// What the position may still be off, in cells of the grid.
    position_left: f32,
    /// What the heading may still be off, in what the grid leaves it to be.
    heading_left: f32,
    /// Distance between points that are looked up \[px\].
    spacing_px: f32,
}

const STAGES: [Stage; 2] = [
    Stage { step: 1.0 / 4.0, heading_step: 2.0 / 3.0, position_left: 0.11, heading_left: 1.0 / 3.0, spacing_px: 18.0 },
    Stage { step: 1.0 / 16.0, heading_step: 2.0 / 9.0, position_left: 0.03, heading_left: 1.0 / 9.0, spacing_px: 9.0 },
];

/// All hypotheses.
#[derive(Debug)]
pub(super) struct Search<'m> {
    config: VerificationConfig,
    /// Distance between neighbouring cells \[m\].
    cell_m: f32,
    /// The headings that the evidence of the cells was gathered at.
    headings: Headings,
    /// Where most level edges of the map run, once somebody asked.
    dominant_rad: Option<f32>,
    /// Which node each part of the cells belongs to.
    slots: Slots<'m>,
    cells: &'m mut [CellEvidence],
    ranked: &'m mut [Hypothesis],
    ranked_count: usize,
    refined: &'m mut [Hypothesis],
    refined_count: usize,
    children: &'m mut [Evidence],
}

impl<'m> Search<'m> {
    /// A search in a map whose nodes lie `spacing_m` apart.
    pub(super) fn new(
        config: &VerificationConfig,
        spacing_m: f32,
        slots: Slots<'m>,
        (cells, ranked, refined, children): SearchMemory<'m>,
    ) -> Self {
        let mut search = Self {
            config: *config,
            cell_m: reach_m(spacing_m, config.reach) / f32::from(config.cells_per_side / 2),
            headings: Headings::about_compass(0.0, 1),
            dominant_rad: None,
            slots,
            cells,
            ranked,
            ranked_count: 0,
            refined,
            refined_count: 0,
            children,
        };
        search.clear();
        search
    }

    /// Forgets all evidence.
    pub(super) fn clear(&mut self) {
        self.slots.clear();
        self.cells.fill(CellEvidence::default());
        (self.ranked_count, self.refined_count) = (0, 0);
    }

    /// The best hypothesis of each place, closely posed, the best first.
    pub(super) fn places(&self) -> &[Hypothesis] {
        &self.refined[..self.refined_count]
    }

    /// The best hypotheses of the grid about each node, the best first.
    pub(super) fn ranked(&self) -> &[Hypothesis] {
        &self.ranked[..self.ranked_count]
    }

    /// The nodes that have a grid, where a first stage chooses them.
    pub(super) const fn slots(&self) -> &Slots<'m> {
        &self.slots
    }

    /// Takes the last of `looks` into account; of maps that have one, the shortlist tells about which nodes.
    pub(super) fn look(
        &mut self,
        database: &TopologicalDatabase<'_>,
        checker: &mut Checker<'_>,
        looks: &KeptLooks<'_>,
        shortlist: Option<&mut Shortlist<'_>>,
    ) {
        let Some(last) = looks.count().checked_sub(1) else { return };
        let headings = self.headings_for(database, looks);
        let changed = last == 0 || !headings.is_like(&self.headings);
        if changed {
            // The first look; or more looks tell better how the building lies, and all is to be checked anew.
            self.headings = headings;
            self.cells.fill(CellEvidence::default());
            self.slots.uncover();
        }
        if let Some(shortlist) = shortlist {
            let poses = usize::from(self.config.headings) * self.config.cells_per_node();
            let (kept, cells) = (&self.refined[..self.refined_count], &mut *self.cells);
            shortlist.choose(&mut self.slots, (looks, &self.headings, changed), kept, |slot| {
                cells[slot * poses..][..poses].fill(CellEvidence::default());
            });
        }
        // Nodes that were just chosen catch up with the looks before.
        let first = if changed || self.slots.are_chosen() { 0 } else { last };
        for look in first..=last {
            if changed || look == last {
                self.check_grid(look, database, checker, looks);
                self.refute(looks);
            } else if self.slots.lack(look) {
                self.check_grid(look, database, checker, looks);
            }
        }
        self.slots.cover(last);
        self.refined_count = self.worth_refining(looks);
        self.refined[..self.refined_count].copy_from_slice(&self.ranked[..self.refined_count]);
        let [coarse, close] = &STAGES;
        self.refine(coarse, database, checker, looks);
        self.keep_places(database);
        self.refine(close, database, checker, looks);
    }

    /// How many of the ranked to pose more closely: as many as there is room for, but none so far behind the best that a
    /// closer pose won't bring it forward.
    fn worth_refining(&self, looks: &KeptLooks<'_>) -> usize {
        let most = self.ranked_count.min(self.refined.len());
        let Some(best) = self.ranked().first() else { return 0 };
        let margin = HOPELESS_LEAD / seen_weight(looks.segment_count());
        let floor_q20 = best.score_q20.saturating_sub((margin * (1 << 20) as f32) as i32);
        self.ranked[..most].iter().take_while(|hypothesis| hypothesis.score_q20 >= floor_q20).count()
    }

    /// Keeps the best hypothesis of each place: what lies close beside a better one would be refined to the same pose.
    fn keep_places(&mut self, database: &TopologicalDatabase<'_>) {
        let mut kept = 0;
        for index in 0..self.refined_count {
            let hypothesis = self.refined[index];
            let here = hypothesis.world_position(database);
            let is_apart = |other: &Hypothesis| other.world_position(database).distance(here) > PLACE_APART_M;
            if kept < usize::from(self.config.finalists) && self.refined[..kept].iter().all(is_apart) {
                self.refined[kept] = hypothesis;
                kept += 1;
            }
        }
        self.refined_count = kept;
    }

    fn headings_for(&mut self, database: &TopologicalDatabase<'_>, looks: &KeptLooks<'_>) -> Headings {
        let most = usize::from(self.config.headings);
        if let Some(spread_rad) = looks.compass_spread_rad() {
            return Headings::about_compass(spread_rad, most);
        }
        let of_map = *self
            .dominant_rad
            .get_or_insert_with(|| DominantDirection::of_map(database).peak_rad().unwrap_or_default());
        Headings::quarter_turns(of_map - looks.dominant_rad().unwrap_or_default(), most)
    }

    fn check_grid(
        &mut self,
        look: usize,
        database: &TopologicalDatabase<'_>,
        checker: &mut Checker<'_>,
        looks: &KeptLooks<'_>,
    ) {
        checker.draw(looks, look);
        let pose = looks.pose(look);
        let side = i32::from(self.config.cells_per_side);
        let half = side / 2;
        let headings = self.headings;
        let closeness =
            Closeness { position_m: 0.4 * self.cell_m, heading_rad: 0.67 * headings.left_rad, spacing_px: 40.0 };
        let closeness = closeness.loosely_at(&pose);
        let per_heading = self.config.cells_per_node();
        let cell_m = self.cell_m;
        let offset_of = |index: i32| [(index % side - half) as f32 * cell_m, (index / side - half) as f32 * cell_m];
        self.ranked_count = 0;
        let per_node = usize::from(self.config.headings) * per_heading;
        for (slot, cells) in self.cells.chunks_exact_mut(per_node).enumerate() {
            let lacking = self.slots.node_lacking(slot, look);
            let Some(node) = lacking.and_then(|id| database.node(id)) else { continue };
            let none = Hypothesis::new(node.id(), [0.0; 2], 0.0);
            let (mut best, mut count) = ([none; VerificationConfig::PER_NODE], 0);
            for (&heading_error_rad, cells) in headings.errors_rad().iter().zip(cells.chunks_exact_mut(per_heading)) {
                let reach_m = (half + 1) as f32 * self.cell_m;
                let way_m = pose.way_m_if(heading_error_rad);
                let elsewhere = Model::elsewhere(&pose, &node, way_m, database);
                let model = elsewhere.unwrap_or(Model::own(node));
                checker.turn(&model.node, pose.heading_rad + heading_error_rad, (model.offset(way_m), reach_m));
                let mut live = (0..).zip(cells).filter(|(index, cell)| {
                    let (column, row) = (index % side - half, index / side - half);
                    // The corners of the square are beyond the node's reach.
                    column * column + row * row <= half * (half + 1) && !cell.is_refuted()
                });
                loop {
                    let mut batch: [Option<(i32, &mut CellEvidence)>; BATCH] = [const { None }; BATCH];
                    let mut offsets_m = [[0.0; 2]; BATCH];
                    let mut found = [Evidence::default(); BATCH];
                    let mut taken = 0;
                    for (place, (index, cell)) in batch.iter_mut().zip(&mut live) {
                        offsets_m[taken] = model.offset(moved(offset_of(index), way_m));
                        *place = Some((index, cell));
                        taken += 1;
                    }
                    if taken == 0 {
                        break;
                    }
                    checker.evidence_of_all(&offsets_m[..taken], &closeness, &mut found[..taken]);
                    for ((index, cell), look) in batch.into_iter().flatten().zip(found) {
                        cell.add(look);
                        let evidence = cell.evidence();
                        let (offset_m, score_q20) = (offset_of(index), evidence.score_q20(looks.seen_q4()));
                        let new = Hypothesis { offset_m, heading_error_rad, evidence, score_q20, ..none };
                        keep_best(&mut best, &mut count, new);
                    }
                }
            }
            self.ranked[self.ranked_count..][..count].copy_from_slice(&best[..count]);
            self.ranked_count += count;
        }
        self.ranked[..self.ranked_count].sort_unstable_by(Hypothesis::rank);
    }

    /// Gives cells up that are far behind the best.
    fn refute(&mut self, looks: &KeptLooks<'_>) {
        if let Some(best) = self.ranked[..self.ranked_count].first() {
            let floor_q20 = refutation_floor_q20(best.score_q20, looks.seen_q4());
            for cell in self.cells.iter_mut() {
                cell.refute_below(floor_q20, looks.seen_q4());
            }
        }
    }

    /// Poses the hypotheses more closely, by all looks, and ranks them anew.
    fn refine(
        &mut self,
        stage: &Stage,
        database: &TopologicalDatabase<'_>,
        checker: &mut Checker<'_>,
        looks: &KeptLooks<'_>,
    ) {
        let heading_left_rad = self.headings.left_rad;
        let headings: usize = if heading_left_rad > 0.0 { HEADINGS } else { 1 };
        let poses = headings * POSITIONS;
        let step_m = stage.step * self.cell_m;
        let closeness = Closeness {
            position_m: stage.position_left * self.cell_m,
            heading_rad: stage.heading_left * heading_left_rad,
            spacing_px: stage.spacing_px,
        };
        let child_of = |parent: &Hypothesis, index: usize| {
            let middle = 0.5 * (SIDE - 1) as f32;
            let (column, row) = ((index % SIDE) as f32 - middle, (index / SIDE % SIDE) as f32 - middle);
            let turn = (index / POSITIONS) as f32 - (headings / 2) as f32;
            let [x, y] = parent.offset_m;
            Hypothesis::new(
                parent.node(),
                [x + column * step_m, y + row * step_m],
                parent.heading_error_rad + turn * stage.heading_step * heading_left_rad,
            )
        };
        let parents = &mut self.refined[..self.refined_count];
        let children = &mut self.children[..parents.len() * poses];
        children.fill(Evidence::default());
        // The look that is drawn comes first, to spare a drawing.
        let count = looks.count();
        let is_last_drawn = count > 0 && checker.drawn_look() == Some(count - 1);
        for order in 0..count {
            let look = if is_last_drawn { count - 1 - order } else { order };
            checker.draw(looks, look);
            let pose = looks.pose(look);
            let closeness = closeness.at(&pose);
            for (parent, children) in parents.iter().zip(children.chunks_exact_mut(poses)) {
                let Some(node) = database.node(parent.node()) else { continue };
                for (turn, group) in children.chunks_exact_mut(POSITIONS).enumerate() {
                    let first = turn * POSITIONS;
                    let heading_error_rad = child_of(parent, first).heading_error_rad;
                    let way_m = pose.way_m_if(heading_error_rad);
                    let heading_rad = pose.heading_rad + heading_error_rad;
                    let center_m = moved(parent.offset_m, way_m);
                    let elsewhere = Model::elsewhere(&pose, &node, center_m, database);
                    let mut evidence: Option<[Evidence; POSITIONS]> = None;
                    for model in [Some(Model::own(node)), elsewhere].into_iter().flatten() {
                        let mut offsets_m = [[0.0; 2]; POSITIONS];
                        for (index, offset_m) in offsets_m.iter_mut().enumerate() {
                            *offset_m = model.offset(moved(child_of(parent, first + index).offset_m, way_m));
                        }
                        for error_rad in pose.heading_errors_rad() {
                            checker.turn(&model.node, heading_rad + error_rad, (model.offset(center_m), 2.0 * step_m));
                            let mut found = [Evidence::default(); POSITIONS];
                            checker.evidence_of_all(&offsets_m, &closeness, &mut found);
                            evidence = Some(evidence.map_or(found, |best| {
                                core::array::from_fn(|child| best[child].better(found[child], pose.seen_q4))
                            }));
                        }
                    }
                    let Some(evidence) = evidence else { continue };
                    for (child, look) in group.iter_mut().zip(evidence) {
                        *child = child.plus(look);
                    }
                }
            }
        }
        for (parent, children) in parents.iter_mut().zip(children.chunks_exact(poses)) {
            let scored = children.iter().enumerate().map(|(index, evidence)| Hypothesis {
                evidence: *evidence,
                score_q20: evidence.score_q20(looks.seen_q4()),
                ..child_of(parent, index)
            });
            if let Some(best) = scored.reduce(|best, other| if other.score_q20 > best.score_q20 { other } else { best })
            {
                *parent = best;
            }
        }
        parents.sort_unstable_by(Hypothesis::rank);
    }
}

/// How well one look agrees with a pose, in Q20.
pub(super) fn agreement_of_look(
    pose: &Hypothesis,
    look: usize,
    database: &TopologicalDatabase<'_>,
    checker: &mut Checker<'_>,
    looks: &KeptLooks<'_>,
) -> i32 {
    let Some(node) = database.node(pose.node()) else { return 0 };
    let (at, seen_q4) = (looks.pose(look), looks.seen_q4_in(look));
    let offset_m = pose.offset_at(&at);
    let closeness = Closeness { position_m: 0.03, heading_rad: 0.0, spacing_px: 9.0 }.at(&at);
    checker.draw(looks, look);
    let elsewhere = Model::elsewhere(&at, &node, offset_m, database);
    let mut best_q20 = i32::MIN;
    for model in [Some(Model::own(node)), elsewhere].into_iter().flatten() {
        for error_rad in at.heading_errors_rad() {
            let heading_rad = at.heading_rad + pose.heading_error_rad + error_rad;
            checker.turn(&model.node, heading_rad, (model.offset(offset_m), 0.05));
            best_q20 = best_q20.max(checker.evidence(model.offset(offset_m), &closeness).score_q20(seen_q4));
        }
    }
    best_q20
}

/// What the caller lends for a search: cells, the ranked, the refined and their children.
pub(super) type SearchMemory<'m> =
    (&'m mut [CellEvidence], &'m mut [Hypothesis], &'m mut [Hypothesis], &'m mut [Evidence]);

/// Cells scoring less than this are given up: so far behind the best, for what was seen, that no look brings them back.
fn refutation_floor_q20(best_q20: i32, seen_q4: i32) -> i32 {
    /// Confidence of the best over the cell.
    const LEAD: f32 = 1.5;
    let margin = LEAD / math::sqrt(math::max(seen_q4 as f32, 16.0) / 16_000.0);
    best_q20.saturating_sub((margin * (1 << 20) as f32) as i32)
}

fn moved(offset_m: [f32; 2], way_m: [f32; 2]) -> [f32; 2] {
    [offset_m[0] + way_m[0], offset_m[1] + way_m[1]]
}

//! The nearest place worth going to, over floor that is known: Dijkstra (1959) with the queue of Dial (1969).
//!
//! A step costs more the nearer it comes to what is occupied, so ways keep to the middle of passages. A cell keeps the
//! cost at which it is found first, at most a step more than the least; so each cell is in one list at a time and the
//! lists need no memory but a link a cell.

use super::config::ExploreConfig;
use super::grid::{At, Grid, MAX_CLEARANCE, NONE};
use crate::math;

/// A step to the side and one across a corner, before its price.
const STEPS: [(i32, i32, u16); 8] =
    [(1, 0, 5), (0, 1, 5), (-1, 0, 5), (0, -1, 5), (1, 1, 7), (-1, 1, 7), (-1, -1, 7), (1, -1, 7)];

/// Highest price of a step.
const MAX_PRICE: f32 = 8.0;

/// Costs that wait at the same time lie within the dearest step, so a ring of more lists holds them.
const RING: usize = 64;

/// What clearances mean to the robot.
#[derive(Debug, Clone)]
pub(super) struct Clearances {
    /// Least squared clearance of a place where the robot can be, in cells.
    least: u8,
    /// What a step costs, by the squared clearance.
    prices: [u8; (MAX_CLEARANCE * MAX_CLEARANCE) as usize + 1],
}

impl Clearances {
    pub(super) fn new(config: &ExploreConfig) -> Self {
        let least_m = config.robot_radius_m + config.margin_m;
        let ample_m = config.robot_radius_m + 2.0 * config.wall_gap_m;
        let least_cells = math::min(least_m / config.cell_m, MAX_CLEARANCE as f32);
        let mut prices = [0; (MAX_CLEARANCE * MAX_CLEARANCE) as usize + 1];
        for (squared, price) in prices.iter_mut().enumerate() {
            let clearance_m = math::sqrt(squared as f32) * config.cell_m;
            let missing = (ample_m - clearance_m) / (ample_m - least_m);
            *price = (1.0 + (MAX_PRICE - 1.0) * math::min(math::max(missing, 0.0), 1.0)) as u8;
        }
        Self { least: (least_cells * least_cells) as u8, prices }
    }

    fn price(&self, clearance: u8) -> u16 {
        u16::from(self.prices[usize::from(clearance).min(self.prices.len() - 1)])
    }
}

impl Grid<'_> {
    /// Whether a free place is worth going to: not seen from near, or beside what has not been seen at all. What lies
    /// beyond the grid is never seen, so being beside it is no reason.
    pub(super) fn is_worth_going(&self, at: At) -> bool {
        let cell = self.cell(at);
        let beside = [(1, 0), (-1, 0), (0, 1), (0, -1)];
        let is_unknown = |(dx, dy): (i32, i32)| {
            let at = At { x: at.x + dx, y: at.y + dy };
            self.cell(at).is_unknown() && self.has_room_for(at)
        };
        cell.is_free() && (!cell.is_covered() || beside.into_iter().any(is_unknown))
    }

    /// The nearest place worth going to, and from `from` a list of cells that leads there; without one, every place
    /// that can be reached has a cost below `u16::MAX`.
    pub(super) fn find_nearest(&mut self, from: At, clearances: &Clearances) -> Option<At> {
        self.update_clearances();
        self.forget_costs();
        let mut lists = [NONE; RING];
        let start = self.number(from);
        self.set_cost(from, 0);
        self.numbered(start).next = NONE;
        lists[0] = start;
        let (mut cost, mut empty_in_row) = (0_usize, 0);
        while empty_in_row < RING {
            let mut number = core::mem::replace(&mut lists[cost % RING], NONE);
            empty_in_row = if number == NONE { empty_in_row + 1 } else { 0 };
            while number != NONE {
                let at = self.place(number);
                let next = self.numbered(number).next;
                if cost > 0 && self.is_worth_going(at) {
                    self.link_way(at);
                    return Some(at);
                }
                self.spread(at, clearances, &mut lists);
                number = next;
            }
            cost += 1;
        }
        None
    }

    /// Puts the neighbours of a cell that were not found yet into the lists of their costs.
    fn spread(&mut self, at: At, clearances: &Clearances, lists: &mut [u32; RING]) {
        let here = self.cell(at);
        for (dx, dy, length) in STEPS {
            let beside = At { x: at.x + dx, y: at.y + dy };
            let cell = self.cell(beside);
            // Out of a place that is too narrow the robot may go towards more room.
            let has_room = cell.clearance >= clearances.least
                || (here.clearance < clearances.least && cell.clearance >= here.clearance);
            if cell.cost != u16::MAX || !cell.is_free() || !has_room {
                continue;
            }
            let cost = here.cost.saturating_add(length * clearances.price(cell.clearance));
            if cost == u16::MAX {
                continue;
            }
            let number = self.number(beside);
            let list = &mut lists[usize::from(cost) % RING];
            self.set_cost(beside, cost);
            self.numbered(number).next = core::mem::replace(list, number);
        }
    }

    /// Links the cells on the way from where the costs began to `to`.
    fn link_way(&mut self, to: At) {
        let mut at = to;
        let mut number = self.number(to);
        self.numbered(number).next = NONE;
        while self.cell(at).cost > 0 {
            let before = STEPS.into_iter().map(|(dx, dy, _)| At { x: at.x + dx, y: at.y + dy });
            let Some(before) = before.min_by_key(|&before| self.cell(before).cost) else { return };
            let number_before = self.number(before);
            self.numbered(number_before).next = number;
            (at, number) = (before, number_before);
        }
    }
}

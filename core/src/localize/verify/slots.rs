//! Which nodes have a grid, where there is none for every node of the map.

use super::hypothesis::Hypothesis;
use crate::database::NodeId;
use zerocopy::{FromBytes, Immutable, IntoBytes};

/// A place for a node's grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, FromBytes, IntoBytes, Immutable)]
#[repr(C)]
pub(super) struct Slot {
    node: u32,
    /// Looks that its evidence is of.
    looks: u32,
}

impl Slot {
    const EMPTY: Self = Self { node: u32::MAX, looks: 0 };

    const fn is_empty(self) -> bool {
        self.node == Self::EMPTY.node
    }
}

/// The slots; none stands for one for every node, in their order.
#[derive(Debug)]
pub(super) struct Slots<'m> {
    slots: &'m mut [Slot],
}

impl<'m> Slots<'m> {
    /// All empty.
    pub(super) fn new(slots: &'m mut [Slot]) -> Self {
        let mut slots = Self { slots };
        slots.clear();
        slots
    }

    pub(super) fn clear(&mut self) {
        self.slots.fill(Slot::EMPTY);
    }

    /// Whether nodes are chosen, not all there.
    pub(super) const fn are_chosen(&self) -> bool {
        !self.slots.is_empty()
    }

    /// The node of the grid at `index`, if its evidence lacks the look.
    pub(super) fn node_lacking(&self, index: usize, look: usize) -> Option<NodeId> {
        match self.slots.get(index) {
            None => Some(NodeId(index as u32)),
            Some(slot) => (slot.looks as usize <= look).then_some(NodeId(slot.node)),
        }
    }

    /// Whether the evidence of any lacks the look.
    pub(super) fn lack(&self, look: usize) -> bool {
        self.slots.iter().any(|slot| !slot.is_empty() && slot.looks as usize <= look)
    }

    /// Takes down that the evidence of all is of all looks up to this one.
    pub(super) fn cover(&mut self, look: usize) {
        self.slots.iter_mut().for_each(|slot| slot.looks = look as u32 + 1);
    }

    /// Takes down that there is no evidence.
    pub(super) fn uncover(&mut self) {
        self.slots.iter_mut().for_each(|slot| slot.looks = 0);
    }

    /// The nodes that have a grid.
    pub(super) fn nodes(&self) -> impl Iterator<Item = NodeId> {
        self.slots.iter().filter(|slot| !slot.is_empty()).map(|slot| NodeId(slot.node))
    }

    /// Gives grids to the `chosen` nodes; those of them and of the `kept` hypotheses that have one keep it. Tells `renew` of
    /// each slot that changes hands. Of more nodes than slots the last have none.
    pub(super) fn choose(&mut self, chosen: &[u32], kept: &[Hypothesis], mut renew: impl FnMut(usize)) {
        for slot in self.slots.iter_mut() {
            if !chosen.contains(&slot.node) && !kept.iter().any(|hypothesis| hypothesis.node == slot.node) {
                *slot = Slot::EMPTY;
            }
        }
        let mut from = 0;
        for &node in chosen {
            if self.slots.iter().any(|slot| slot.node == node) {
                continue;
            }
            let empty = self.slots.iter().skip(from).position(|slot| slot.is_empty());
            let Some(index) = empty.map(|place| from + place) else { return };
            self.slots[index] = Slot { node, looks: 0 };
            renew(index);
            from = index + 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    fn nodes(slots: &Slots<'_>) -> Vec<u32> {
        slots.nodes().map(|node| node.0).collect()
    }

    #[test]
    fn who_is_chosen_again_or_kept_stays_and_newcomers_lack_all_looks() {
        let mut memory = [Slot::EMPTY; 4];
        let mut slots = Slots::new(&mut memory);
        let mut renewed = Vec::new();
        slots.choose(&[3, 5, 8], &[], |slot| renewed.push(slot));
        assert_eq!((nodes(&slots), &*renewed), ([3, 5, 8].to_vec(), &[0, 1, 2][..]));
        slots.cover(0);
        assert!(!slots.lack(0) && slots.lack(1));
        assert_eq!(nodes(&slots), [3, 5, 8]);
        renewed.clear();
        let kept = [Hypothesis::new(NodeId(8), [0.0; 2], 0.0)];
        slots.choose(&[1, 5, 9], &kept, |slot| renewed.push(slot));
        assert_eq!((nodes(&slots), &*renewed), ([1, 5, 8, 9].to_vec(), &[0, 3][..]));
        let lacking = |look: usize| -> Vec<u32> {
            (0..4).filter_map(|slot| slots.node_lacking(slot, look)).map(|node| node.0).collect()
        };
        assert_eq!(lacking(0), [1, 9]);
        assert_eq!(lacking(1), [1, 5, 8, 9]);
    }

    #[test]
    fn without_slots_every_node_has_its_place_and_lacks_every_look() {
        let slots = Slots::new(&mut []);
        assert!(!slots.are_chosen() && !slots.lack(0));
        assert_eq!(slots.node_lacking(7, 3), Some(NodeId(7)));
    }

    #[test]
    fn of_more_nodes_than_slots_the_last_have_none() {
        let mut memory = [Slot::EMPTY; 2];
        let mut slots = Slots::new(&mut memory);
        slots.choose(&[4, 6, 7], &[], |_| ());
        assert_eq!(nodes(&slots), [4, 6]);
    }
}

//! Where to put nodes so that nearly every place has one near it in sight.
//!
//! Spread evenly, nodes leave corners and niches whose nearest node stands behind a wall or a wardrobe, where a robot
//! errs ten times as often. So nodes are taken out one by one and put where they serve best (the interchange of Teitz and
//! Bart 1968), starting from even nodes: a place counts by its squared distance to the nearest node in sight, and one
//! farther than [`NEAR_M`] much more. The sums are of integers, so that every machine finds the same nodes.

use super::places::{Places, Surroundings};
use super::{PlaceNodesError, place_nodes};
use edgeloc::geometry::Point2;
use rayon::prelude::*;

/// A node should be in sight within this distance \[m\].
pub const NEAR_M: f32 = 1.0;

/// What a place without a node so near counts on top of its squared distance \[m2\], and for every metre beyond \[m\].
const FAR_M2: f32 = 2.0;
const FARTHER_M: f32 = 4.0;
/// Places that are looked at for each node.
const PLACES_PER_NODE: f64 = 64.0;
/// How far a node can serve, in distances between places: two and a half times its share of an open floor.
const REACH: f32 = 11.0;
/// Most times that every node is tried, near by and everywhere; mostly nothing moves any more after fewer.
const NEAR_ROUNDS: usize = 20;
const FAR_ROUNDS: usize = 6;

/// Places `count` nodes on centers of free cells, all different, in the world frame.
///
/// Where nodes are nearly as many as free cells they are spread evenly.
///
/// # Errors
/// When `count` is zero or above the number of free cells.
pub fn place_in_sight(
    surroundings: &Surroundings<'_>,
    count: usize,
    seed: u64,
) -> Result<Vec<Point2>, PlaceNodesError> {
    let space = surroundings.space;
    let spread = place_nodes(space, count, seed)?;
    let places = Places::new(space, (space.area_m2() / (count as f64 * PLACES_PER_NODE)).sqrt() as f32);
    if places.len() < 4 * count {
        return Ok(spread);
    }
    let sights = Sights::between(&places, surroundings);
    let mut service = Service::new(&places, &sights);
    for &position in &spread {
        service.add_near(position);
    }
    service.settle();
    Ok(service.nodes.iter().map(|&node| places.centers()[node as usize]).collect())
}

/// A place in sight, and how far it is.
#[derive(Debug, Clone, Copy)]
struct Sight {
    place: u32,
    /// What the place counts when it is served from so far.
    burden: u32,
}

/// Which places see which.
#[derive(Debug)]
struct Sights {
    of_place: Vec<Vec<Sight>>,
    /// What a place counts that nothing serves.
    none: u32,
}

impl Sights {
    fn between(places: &Places, surroundings: &Surroundings<'_>) -> Self {
        let reach_m = REACH * places.side_m();
        let seen_later = |place: usize| {
            let here = places.centers()[place];
            let others = places.around(place, REACH as usize + 1).filter(|&other| other > place);
            let sights = others.filter_map(|other| {
                let there = places.centers()[other];
                let distance_m = here.distance(there);
                let is_seen = distance_m <= reach_m && surroundings.is_in_sight(here, there);
                is_seen.then(|| Sight { place: other as u32, burden: burden(distance_m) })
            });
            sights.collect::<Vec<_>>()
        };
        let later: Vec<Vec<Sight>> = (0..places.len()).into_par_iter().map(seen_later).collect();
        let mut of_place: Vec<Vec<Sight>> =
            (0..places.len() as u32).map(|place| vec![Sight { place, burden: 0 }]).collect();
        for (place, sights) in later.iter().enumerate() {
            for sight in sights {
                of_place[place].push(*sight);
                of_place[sight.place as usize].push(Sight { place: place as u32, ..*sight });
            }
        }
        Self { of_place, none: burden(reach_m) }
    }
}

/// What a place counts whose nearest node in sight is so far away \[cm2\].
fn burden(distance_m: f32) -> u32 {
    let beyond_m = distance_m - NEAR_M;
    let far_m2 = if beyond_m > 0.0 { FAR_M2 + FARTHER_M * beyond_m } else { 0.0 };
    libm::roundf(10_000.0 * (distance_m * distance_m + far_m2)) as u32
}

/// Who serves whom.
#[derive(Debug)]
struct Service<'p> {
    places: &'p Places,
    sights: &'p Sights,
    nodes: Vec<u32>,
    is_node: Vec<bool>,
    /// What each place counts now.
    burdens: Vec<u32>,
}

impl<'p> Service<'p> {
    fn new(places: &'p Places, sights: &'p Sights) -> Self {
        let count = places.len();
        Self { places, sights, nodes: Vec::new(), is_node: vec![false; count], burdens: vec![sights.none; count] }
    }

    /// Adds a node at the place nearest to `position` that has none.
    fn add_near(&mut self, position: Point2) {
        let distance = |&place: &usize| self.places.centers()[place].distance(position);
        let vacant = (0..self.places.len()).filter(|&place| !self.is_node[place]);
        if let Some(place) = vacant.min_by(|a, b| distance(a).total_cmp(&distance(b))) {
            self.nodes.push(place as u32);
            self.occupy(place);
        }
    }

    /// Moves nodes until none can be moved to serve better.
    fn settle(&mut self) {
        for _ in 0..FAR_ROUNDS {
            for _ in 0..NEAR_ROUNDS {
                if !self.try_all(Self::best_in_sight) {
                    break;
                }
            }
            if !self.try_all(Self::best_anywhere) {
                break;
            }
        }
    }

    /// Takes each node out and puts it to where `best` tells; whether any has moved.
    fn try_all(&mut self, best: impl Fn(&Self, usize) -> usize) -> bool {
        let mut has_moved = false;
        for index in 0..self.nodes.len() {
            let old = self.nodes[index] as usize;
            self.vacate(old);
            let new = best(self, old);
            self.occupy(new);
            self.nodes[index] = new as u32;
            has_moved |= new != old;
        }
        has_moved
    }

    /// Of the places in sight of `old`, and itself, the one where a node serves best.
    fn best_in_sight(&self, old: usize) -> usize {
        self.best_of(old, self.sights.of_place[old].iter().map(|sight| sight.place as usize))
    }

    fn best_anywhere(&self, old: usize) -> usize {
        self.best_of(old, 0..self.places.len())
    }

    /// The place where a node serves best; `old` when none is better.
    fn best_of(&self, old: usize, places: impl Iterator<Item = usize>) -> usize {
        let vacant = places.filter(|&place| !self.is_node[place]);
        vacant
            .fold((old, self.relief(old)), |best, place| {
                let relief = self.relief(place);
                if relief > best.1 { (place, relief) } else { best }
            })
            .0
    }

    /// How much less all places would count with a node at `place`.
    fn relief(&self, place: usize) -> u64 {
        let relieved = |sight: &Sight| {
            let served = sight.place as usize;
            let relief = self.burdens[served].saturating_sub(sight.burden);
            u64::from(relief) * u64::from(self.places.cell_count(served))
        };
        self.sights.of_place[place].iter().map(relieved).sum()
    }

    fn occupy(&mut self, place: usize) {
        self.is_node[place] = true;
        for sight in &self.sights.of_place[place] {
            let burden = &mut self.burdens[sight.place as usize];
            *burden = sight.burden.min(*burden);
        }
    }

    fn vacate(&mut self, place: usize) {
        self.is_node[place] = false;
        for sight in &self.sights.of_place[place] {
            let served = sight.place as usize;
            if self.burdens[served] == sight.burden {
                let nodes = self.sights.of_place[served].iter().filter(|seen| self.is_node[seen.place as usize]);
                self.burdens[served] = nodes.map(|seen| seen.burden).min().unwrap_or(self.sights.none);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::SightCoverage;
    use crate::world::office::{self, OfficeOptions};
    use crate::world::{FreeSpace, FreeSpaceOptions, Occluders};

    #[test]
    fn nodes_in_sight_serve_more_of_an_office_than_nodes_spread_evenly() {
        let world = office::generate(&OfficeOptions::default());
        let space = FreeSpace::of(&world, &FreeSpaceOptions::default()).expect("an office");
        let occluders = Occluders::new(&world.surfaces);
        let surroundings = Surroundings { world: &world, occluders: &occluders, space: &space, eye_height_m: 1.0 };
        let spread = place_nodes(&space, 72, 1).expect("room for 72");
        let placed = place_in_sight(&surroundings, 72, 1).expect("room for 72");
        assert_eq!(placed.len(), 72);
        assert!(placed.iter().all(|&node| space.contains(node)));
        assert!((0..72).all(|node| !placed[..node].contains(&placed[node])), "all different");
        assert_eq!(placed, place_in_sight(&surroundings, 72, 1).expect("the same again"));
        let [before, after] = [&spread, &placed].map(|nodes| SightCoverage::of(&surroundings, nodes));
        assert!(after.within_1_m > before.within_1_m + 0.015, "{} and {}", before.describe(), after.describe());
        assert!(after.within_1_5_m > 0.999 && after.second_nearest_hidden < before.second_nearest_hidden);
    }

    #[test]
    fn what_is_nearly_full_is_spread_and_too_many_are_refused() {
        let world = office::generate(&OfficeOptions::default());
        let options = FreeSpaceOptions { cell_m: 0.5, ..FreeSpaceOptions::default() };
        let space = FreeSpace::of(&world, &options).expect("an office");
        let occluders = Occluders::new(&world.surfaces);
        let surroundings = Surroundings { world: &world, occluders: &occluders, space: &space, eye_height_m: 1.0 };
        let cell_count = space.cell_centers().len();
        assert_eq!(place_in_sight(&surroundings, cell_count, 1), place_nodes(&space, cell_count, 1));
        assert!(place_in_sight(&surroundings, cell_count + 1, 1).is_err());
        assert!(place_in_sight(&surroundings, 0, 1).is_err());
    }
}

//! How well nodes cover a building: how near the next node in sight is from wherever a robot may stand.
//!
//! A robot is localised to a few centimetres where a node is in sight within a metre, and errs ten times as often farther
//! off, so the figures tell before any trial where a map needs more nodes.

use super::places::{Places, Surroundings};
use edgeloc::geometry::Point2;
use rayon::prelude::*;
use serde::Serialize;

/// A place without a node in sight within this distance is a poor one \[m\].
pub const POOR_M: f32 = 1.5;

/// Places are looked at this far apart \[m\], in large buildings farther.
const SPACING_M: f64 = 0.1;
/// The most places that are looked at, about.
const MOST_PLACES: f64 = 40_000.0;

/// How well nodes cover free space.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct SightCoverage {
    /// Share of free space with a node in sight within 1 m.
    pub within_1_m: f64,
    /// Share of free space with a node in sight within [`POOR_M`].
    pub within_1_5_m: f64,
    /// Share of free space whose second nearest node is hidden: it counts as right when it is answered.
    pub second_nearest_hidden: f64,
    /// Where the nearest node in sight is farthest away, the whole free space about it.
    pub worst: PoorPlace,
    /// The connected poor places, the largest first.
    pub poor: Vec<PoorPlace>,
    /// The squares without a node in sight within [`POOR_M`].
    #[serde(skip)]
    pub poor_squares: Squares,
}

/// Squares of a grid over the floor.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Squares {
    /// A point in each, world frame.
    pub points: Vec<Point2>,
    /// A corner of the grid, world frame.
    pub origin: Point2,
    /// Side of a square \[m\].
    pub side_m: f32,
}

/// A place that nodes cover poorly.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct PoorPlace {
    /// Where it is worst, world frame \[m\].
    pub x_m: f32,
    /// Where it is worst, world frame \[m\].
    pub y_m: f32,
    /// Distance from there to the nearest node in sight \[m\]; none when no node is in sight.
    pub distance_m: Option<f32>,
    /// Its extent \[m2\].
    pub area_m2: f64,
}

impl SightCoverage {
    /// How well `nodes` cover the free space of a building.
    #[must_use]
    pub fn of(surroundings: &Surroundings<'_>, nodes: &[Point2]) -> Self {
        let space = surroundings.space;
        let spacing_m = SPACING_M.max((space.area_m2() / MOST_PLACES).sqrt());
        let places = Places::new(space, spacing_m as f32);
        let served: Vec<Served> =
            places.centers().par_iter().map(|&place| Served::at(surroundings, nodes, place)).collect();
        let cell_m2 = f64::from(space.cell_m()) * f64::from(space.cell_m());
        let area_m2 = |place: usize| f64::from(places.cell_count(place)) * cell_m2;
        let share = |holds: &dyn Fn(&Served) -> bool| {
            let held = served.iter().enumerate().filter(|(_, served)| holds(served));
            held.map(|(place, _)| area_m2(place)).sum::<f64>() / space.area_m2()
        };
        let describe = |members: &[usize]| {
            let worst = members.iter().copied().max_by(|&a, &b| served[a].distance_m.total_cmp(&served[b].distance_m));
            let worst = worst.unwrap_or(0);
            let Point2 { x: x_m, y: y_m } = places.centers()[worst];
            let distance_m = Some(served[worst].distance_m).filter(|distance_m| distance_m.is_finite());
            PoorPlace { x_m, y_m, distance_m, area_m2: members.iter().map(|&place| area_m2(place)).sum() }
        };
        let is_poor: Vec<bool> = served.iter().map(|served| served.distance_m > POOR_M).collect();
        let mut poor: Vec<PoorPlace> = groups(&places, &is_poor).iter().map(|members| describe(members)).collect();
        poor.sort_by(|a, b| b.area_m2.total_cmp(&a.area_m2));
        let all: Vec<usize> = (0..places.len()).collect();
        Self {
            within_1_m: share(&|served| served.distance_m <= 1.0),
            within_1_5_m: share(&|served| served.distance_m <= POOR_M),
            second_nearest_hidden: share(&|served| served.is_second_hidden),
            worst: describe(&all),
            poor,
            poor_squares: Squares {
                points: all.iter().filter(|&&place| is_poor[place]).map(|&place| places.centers()[place]).collect(),
                origin: space.origin(),
                side_m: places.side_m(),
            },
        }
    }

    /// The figures in a line.
    #[must_use]
    pub fn describe(&self) -> String {
        let worst = self.worst.distance_m.map_or("no node is in sight from".to_owned(), |distance_m| {
            format!("the nearest node in sight is {distance_m:.2} m away at")
        });
        format!(
            "{:.1} % of free space has a node in sight within 1 m, {:.1} % within {POOR_M} m; {worst} {:.2}, {:.2} m",
            100.0 * self.within_1_m,
            100.0 * self.within_1_5_m,
            self.worst.x_m,
            self.worst.y_m
        )
    }
}

impl PoorPlace {
    /// The place in a line.
    #[must_use]
    pub fn describe(&self) -> String {
        let far =
            self.distance_m.map_or("no node in sight".to_owned(), |far| format!("a node in sight {far:.2} m away"));
        format!("{:.2} m2 about {:.2}, {:.2} m with {far}", self.area_m2, self.x_m, self.y_m)
    }
}

/// How a place is served.
#[derive(Debug)]
struct Served {
    /// To the nearest node in sight \[m\]; infinite when there is none.
    distance_m: f32,
    is_second_hidden: bool,
}

impl Served {
    fn at(surroundings: &Surroundings<'_>, nodes: &[Point2], place: Point2) -> Self {
        let mut by_distance: Vec<(f32, Point2)> = nodes.iter().map(|&node| (node.distance(place), node)).collect();
        by_distance.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let is_seen = |&&(_, node): &&(f32, Point2)| surroundings.is_in_sight(place, node);
        let nearest = by_distance.iter().find(is_seen);
        Self {
            distance_m: nearest.map_or(f32::INFINITY, |&(distance_m, _)| distance_m),
            is_second_hidden: by_distance.get(1).is_some_and(|second| !is_seen(&second)),
        }
    }
}

/// The places that are members, in groups of those beside each other.
fn groups(places: &Places, is_member: &[bool]) -> Vec<Vec<usize>> {
    let mut is_new = is_member.to_vec();
    let mut groups = Vec::new();
    for first in 0..places.len() {
        if !is_new[first] {
            continue;
        }
        is_new[first] = false;
        let mut group = vec![first];
        let mut reached = 0;
        while let Some(&place) = group.get(reached) {
            reached += 1;
            for beside in places.around(place, 1) {
                if is_new[beside] {
                    is_new[beside] = false;
                    group.push(beside);
                }
            }
        }
        groups.push(group);
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::office::{self, OfficeOptions};
    use crate::world::{FreeSpace, FreeSpaceOptions, Occluders, WireframeWorld};

    struct Office {
        world: WireframeWorld,
        occluders: Occluders,
        space: FreeSpace,
    }

    impl Office {
        fn new() -> Self {
            let world = office::generate(&OfficeOptions::default());
            let space = FreeSpace::of(&world, &FreeSpaceOptions::default()).expect("an office");
            Self { occluders: Occluders::new(&world.surfaces), world, space }
        }

        fn coverage(&self, nodes: &[Point2]) -> SightCoverage {
            let Self { world, occluders, space } = self;
            SightCoverage::of(&Surroundings { world, occluders, space, eye_height_m: 1.0 }, nodes)
        }
    }

    #[test]
    fn a_node_on_every_place_leaves_none_poor() {
        let office = Office::new();
        let nodes: Vec<Point2> = office.space.cell_centers().step_by(40).collect();
        let coverage = office.coverage(&nodes);
        assert!(coverage.within_1_5_m > 0.99 && coverage.within_1_m <= coverage.within_1_5_m, "{coverage:?}");
    }

    #[test]
    fn what_a_single_node_leaves_out_is_listed_and_adds_up() {
        let office = Office::new();
        let node = office.space.cell_centers().nth(1000).expect("free cells");
        let coverage = office.coverage(&[node]);
        let poor_m2: f64 = coverage.poor.iter().map(|place| place.area_m2).sum();
        assert!((poor_m2 / office.space.area_m2() - (1.0 - coverage.within_1_5_m)).abs() < 1e-9);
        assert!(coverage.within_1_5_m < 0.05 && coverage.worst.distance_m.is_none(), "{}", coverage.describe());
        assert!(coverage.poor.is_sorted_by(|a, b| a.area_m2 >= b.area_m2));
        assert!(coverage.poor.iter().all(|place| office.space.contains(Point2::new(place.x_m, place.y_m))));
        assert!((coverage.second_nearest_hidden, coverage.poor_squares.points.is_empty()) == (0.0, false));
    }
}

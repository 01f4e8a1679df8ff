//! Free space in coarse places: a free cell for each square of cells, with how many cells it stands for.

use crate::world::{FreeSpace, Occluders, WireframeWorld};
use edgeloc::geometry::{Point2, Point3};

/// Stands for no place.
const NO_PLACE: u32 = u32::MAX;

/// A building that is learned: what the robot sees there, and where it can stand.
#[derive(Debug, Clone, Copy)]
pub struct Surroundings<'w> {
    /// The building.
    pub world: &'w WireframeWorld,
    /// Its surfaces, ready for visibility rays.
    pub occluders: &'w Occluders,
    /// Where the robot can stand.
    pub space: &'w FreeSpace,
    /// Height of the cameras above the floor \[m\].
    pub eye_height_m: f32,
}

impl Surroundings<'_> {
    /// Whether a camera at one point of the floor sees one at another.
    #[must_use]
    pub fn is_in_sight(&self, from: Point2, to: Point2) -> bool {
        let eye = |point: Point2| Point3::new(point.x, point.y, self.eye_height_m);
        self.occluders.is_visible(eye(from), eye(to))
    }
}

/// The squares of free space, each by the free cell nearest to the middle of its cells.
#[derive(Debug)]
pub(super) struct Places {
    centers: Vec<Point2>,
    cell_counts: Vec<u32>,
    /// The square of each place.
    squares: Vec<usize>,
    /// The place in each square, or [`NO_PLACE`].
    in_square: Vec<u32>,
    width: usize,
    side_m: f32,
}

impl Places {
    /// Places about `side_m` apart, a whole number of cells.
    pub(super) fn new(space: &FreeSpace, side_m: f32) -> Self {
        let side_m = space.cell_m() * libm::roundf(side_m / space.cell_m()).max(1.0);
        let origin = space.origin();
        let index = |at: f32, from: f32| libm::floor(f64::from(at - from) / f64::from(side_m)).max(0.0) as usize;
        let square = |center: Point2| [index(center.x, origin.x), index(center.y, origin.y)];
        let [width, height] =
            space.cell_centers().map(square).fold([0, 0], |[w, h], [x, y]| [w.max(x + 1), h.max(y + 1)]);
        let mut members: Vec<Vec<Point2>> = vec![Vec::new(); width * height];
        for center in space.cell_centers() {
            let [x, y] = square(center);
            members[y * width + x].push(center);
        }
        let mut places = Self {
            centers: Vec::new(),
            cell_counts: Vec::new(),
            squares: Vec::new(),
            in_square: vec![NO_PLACE; members.len()],
            width,
            side_m,
        };
        for (square, cells) in members.iter().enumerate().filter(|(_, cells)| !cells.is_empty()) {
            places.in_square[square] = places.centers.len() as u32;
            places.squares.push(square);
            places.centers.push(middle(cells));
            places.cell_counts.push(cells.len() as u32);
        }
        places
    }

    pub(super) const fn len(&self) -> usize {
        self.centers.len()
    }

    pub(super) fn centers(&self) -> &[Point2] {
        &self.centers
    }

    /// How many free cells a place stands for.
    pub(super) fn cell_count(&self, place: usize) -> u32 {
        self.cell_counts[place]
    }

    /// Distance between neighbouring places, about \[m\].
    pub(super) const fn side_m(&self) -> f32 {
        self.side_m
    }

    /// The places in the squares up to so many columns and rows away, the place itself among them.
    pub(super) fn around(&self, place: usize, squares: usize) -> impl Iterator<Item = usize> + '_ {
        let [x, y] = [self.squares[place] % self.width, self.squares[place] / self.width];
        let height = self.in_square.len() / self.width;
        let rows = y.saturating_sub(squares)..(y + squares + 1).min(height);
        let columns = x.saturating_sub(squares)..(x + squares + 1).min(self.width);
        rows.flat_map(move |row| columns.clone().map(move |column| self.in_square[row * self.width + column]))
            .filter(|&place| place != NO_PLACE)
            .map(|place| place as usize)
    }
}

/// The point nearest to the mean of all.
fn middle(points: &[Point2]) -> Point2 {
    let sum = points.iter().fold([0.0_f64; 2], |[x, y], point| [x + f64::from(point.x), y + f64::from(point.y)]);
    let mean = sum.map(|sum| (sum / points.len() as f64) as f32);
    let mean = Point2::new(mean[0], mean[1]);
    let nearest = points.iter().min_by(|a, b| a.distance(mean).total_cmp(&b.distance(mean)));
    nearest.copied().unwrap_or(mean)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::FreeSpaceOptions;
    use crate::world::office::{self, OfficeOptions};

    #[test]
    fn places_are_free_stand_for_every_cell_and_lie_around_each_other() {
        let world = office::generate(&OfficeOptions::default());
        let space = FreeSpace::of(&world, &FreeSpaceOptions::default()).expect("an office");
        let places = Places::new(&space, 0.21);
        assert!((places.side_m() - 0.2).abs() < 1e-6);
        assert!(places.centers().iter().all(|&center| space.contains(center)));
        let cells: u32 = (0..places.len()).map(|place| places.cell_count(place)).sum();
        assert_eq!(cells as usize, space.cell_centers().len());
        for place in (0..places.len()).step_by(97) {
            let here = places.centers()[place];
            let near: Vec<usize> = (0..places.len()).filter(|&at| places.centers()[at].distance(here) < 0.6).collect();
            let around: Vec<usize> = places.around(place, 4).collect();
            assert!(near.iter().all(|near| around.contains(near)), "place {place}");
        }
    }
}

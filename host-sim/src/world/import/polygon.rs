//! Cutting a flat polygon into triangles by its ears (Meisters 1975), in the order of its corners.

use nalgebra::Vector3;

/// Points looked at per corner, on average, before cutting goes on blindly: the search for ears takes the cube of the
/// corner count at worst, its square as a rule.
const BUDGET_PER_CORNER: usize = 2000;

/// Most corners of a polygon that the readers take; a hundred times those of a finely round table top.
pub(super) const MAX_CORNERS: usize = 10_000;

/// Triangles of the polygon with the given corners, as indices into `corners`, wound like the polygon.
///
/// Exact for simple polygons, convex or not. A polygon that crosses itself gives triangles with the same corners.
pub(super) fn triangulate(corners: &[Vector3<f64>]) -> Vec<[usize; 3]> {
    let count = corners.len();
    if count < 3 {
        return Vec::new();
    }
    let normal = area_normal(corners);
    let mut left: Vec<usize> = (0..count).collect();
    let mut triangles = Vec::with_capacity(count - 2);
    let mut budget = BUDGET_PER_CORNER * count;
    while left.len() > 3 {
        let ear = (0..left.len()).find(|&at| {
            budget = budget.saturating_sub(left.len());
            budget == 0 || is_ear(corners, &left, at, &normal)
        });
        // Without an ear the polygon crosses itself: cut anywhere.
        let at = ear.unwrap_or(1);
        triangles.push(around(&left, at));
        left.remove(at);
        if budget == 0 {
            break;
        }
    }
    // The last triangle; or, once the budget is spent, all that is left as a fan from its last corner.
    let (&hub, rest) = left.split_last().expect("three corners are never cut off");
    triangles.extend(rest.windows(2).map(|side| [hub, side[0], side[1]]));
    let last = triangles.last_mut().expect("there is at least one triangle");
    last.rotate_left(1);
    triangles
}

/// Newell's normal, twice the area long.
fn area_normal(corners: &[Vector3<f64>]) -> Vector3<f64> {
    let origin = corners[0];
    corners.windows(2).map(|pair| (pair[0] - origin).cross(&(pair[1] - origin))).sum()
}

fn around(left: &[usize], at: usize) -> [usize; 3] {
    let count = left.len();
    [left[(at + count - 1) % count], left[at], left[(at + 1) % count]]
}

/// Whether the corner at `at` is convex and its triangle holds no other corner.
fn is_ear(corners: &[Vector3<f64>], left: &[usize], at: usize, normal: &Vector3<f64>) -> bool {
    let ear = around(left, at);
    let [a, b, c] = ear.map(|index| corners[index]);
    let turn = |p: Vector3<f64>, q: Vector3<f64>, r: Vector3<f64>| (q - p).cross(&(r - p)).dot(normal);
    if turn(a, b, c) <= 0.0 {
        return false;
    }
    left.iter().filter(|index| !ear.contains(index)).all(|&index| {
        let point = corners[index];
        let is_corner = point == a || point == b || point == c;
        is_corner || turn(a, b, point) < 0.0 || turn(b, c, point) < 0.0 || turn(c, a, point) < 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(points: &[(f64, f64)]) -> Vec<Vector3<f64>> {
        points.iter().map(|&(x, y)| Vector3::new(x, y, 0.5)).collect()
    }

    /// Signed areas of the triangles.
    fn areas(corners: &[Vector3<f64>]) -> Vec<f64> {
        let area = |[a, b, c]: [usize; 3]| (corners[b] - corners[a]).cross(&(corners[c] - corners[a])).z / 2.0;
        triangulate(corners).into_iter().map(area).collect()
    }

    #[test]
    fn a_concave_polygon_is_covered_once_without_folds() {
        let arrow = flat(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (3.0, 1.0), (1.0, 1.0), (0.0, 3.0)]);
        let areas = areas(&arrow);
        assert_eq!(areas.len(), 4);
        assert!(areas.iter().all(|&area| area > 0.0), "{areas:?}");
        assert!((areas.iter().sum::<f64>() - 6.5).abs() < 1e-12, "{areas:?}");
    }

    #[test]
    fn a_comb_of_a_thousand_corners_is_covered_once() {
        let teeth = (0..500).flat_map(|tooth| [(f64::from(tooth), 1.0), (f64::from(tooth) + 0.5, 0.0)]);
        let mut outline: Vec<(f64, f64)> = teeth.collect();
        outline.push((500.0, 2.0));
        outline.push((0.0, 2.0));
        outline.reverse();
        let outline = flat(&outline);
        let signs: Vec<f64> = areas(&outline).iter().map(|area| area.signum()).collect();
        assert_eq!(signs.len(), 1000);
        assert!(signs.iter().all(|sign| sign * signs[0] > 0.0));
    }

    #[test]
    fn a_polygon_too_large_to_search_is_cut_all_the_same() {
        let round = |corner: u32| 1e-3 * f64::from(corner * corner);
        let outline: Vec<(f64, f64)> = (0..8000).map(|corner| (f64::from(corner), round(corner))).collect();
        let areas = areas(&flat(&outline));
        assert_eq!(areas.len(), 7998);
        assert!(areas.iter().all(|&area| area > 0.0));
    }

    #[test]
    fn degenerate_polygons_give_few_triangles_and_no_panic() {
        assert!(areas(&flat(&[(0.0, 0.0), (1.0, 0.0)])).is_empty());
        assert_eq!(areas(&flat(&[(1.0, 1.0); 7])).len(), 5);
        assert_eq!(areas(&flat(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)])).len(), 2);
    }
}

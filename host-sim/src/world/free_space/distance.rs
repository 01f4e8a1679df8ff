//! Distance over a grid to the nearest marked cell, exact (Meijster, Roerdink and Hesselink 2000).

use super::coverage::Grid;

/// For each cell the squared distance between its center and that of the nearest marked cell, in cells; more than the
/// grid is long when none is marked.
pub(super) fn squared_distances(grid: &Grid, is_marked: &[bool]) -> Vec<i64> {
    let columns = distances_in_columns(grid, is_marked);
    let mut squared = Vec::with_capacity(grid.cell_count());
    // The lower envelope of one parabola a cell, as (cell of its vertex, first cell where it is the lowest).
    let mut envelope: Vec<(usize, i64)> = Vec::with_capacity(grid.width);
    for row in columns.chunks_exact(grid.width) {
        let height_at = |vertex: usize, x: i64| {
            let along = x - vertex as i64;
            along * along + row[vertex] * row[vertex]
        };
        envelope.clear();
        for x in 0..grid.width {
            while envelope.last().is_some_and(|&(vertex, from)| height_at(vertex, from) > height_at(x, from)) {
                envelope.pop();
            }
            let Some(&(vertex, _)) = envelope.last() else {
                envelope.push((x, 0));
                continue;
            };
            let (near, far) = (vertex as i64, x as i64);
            let rise = far * far - near * near + row[x] * row[x] - row[vertex] * row[vertex];
            let from = 1 + rise.div_euclid(2 * (far - near));
            if from < grid.width as i64 {
                envelope.push((x, from));
            }
        }
        let mut ends = envelope.iter().skip(1).map(|&(_, from)| from).chain([grid.width as i64]);
        let mut from = 0;
        for &(vertex, _) in &envelope {
            let end = ends.next().unwrap_or(from);
            squared.extend((from..end).map(|x| height_at(vertex, x)));
            from = end;
        }
    }
    squared
}

/// For each cell the distance to the nearest marked cell of its column, in cells.
fn distances_in_columns(grid: &Grid, is_marked: &[bool]) -> Vec<i64> {
    let width = grid.width;
    let none = (grid.width + grid.height) as i64;
    let mut distances: Vec<i64> = is_marked.iter().map(|&is_marked| if is_marked { 0 } else { none }).collect();
    for cell in width..distances.len() {
        distances[cell] = distances[cell].min(distances[cell - width] + 1);
    }
    for cell in (width..distances.len()).rev() {
        distances[cell - width] = distances[cell - width].min(distances[cell] + 1);
    }
    distances
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;

    #[test]
    fn distances_are_those_to_the_nearest_of_all_marked_cells() {
        let mut stream = Stream::new(1, "grids", 0, 0);
        for _ in 0..50 {
            let (width, height) = (1 + stream.index(30), 1 + stream.index(30));
            let grid = Grid { west: 0.0, south: 0.0, cell_m: 1.0, width, height };
            let mut is_marked: Vec<bool> = (0..grid.cell_count()).map(|_| stream.chance(0.03)).collect();
            is_marked[0] = true;
            let found = squared_distances(&grid, &is_marked);
            for (cell, &found) in found.iter().enumerate() {
                let squared = |other: usize| {
                    let (dx, dy) = ((cell % width).abs_diff(other % width), (cell / width).abs_diff(other / width));
                    (dx * dx + dy * dy) as i64
                };
                let nearest = (0..is_marked.len()).filter(|&other| is_marked[other]).map(squared).min();
                assert_eq!(Some(found), nearest, "cell {cell} of {width} x {height}");
            }
        }
    }
}

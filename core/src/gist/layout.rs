//! Lengths of edges by place in the image and by direction.

use crate::geometry::{BinaryAngle, PinholeCamera, Polarity, Segment2};
use crate::math;

/// Cells of the grid along either side of the image.
const CELLS: usize = 8;
/// Directions in a full turn.
const DIRECTIONS: usize = 8;
/// Numbers of a layout: `[row][column][direction]`.
pub const FEATURES: usize = CELLS * CELLS * DIRECTIONS;

/// The square roots of the lengths in pixels of the normal image, 640 px wide, in Q6; see [`edge_layout`].
pub type EdgeLayout = [i16; FEATURES];

/// Width of the normal image in pixels.
const WIDTH_PX: f32 = 640.0;
/// Segments shorter than this say little \[px\].
const LEAST_PX: f32 = 12.0;
/// Slope of 5 degrees: what is closer to the horizontal is lost in stereo matching, so that models lack it.
const LEAST_SLOPE: f32 = 0.087_488_66;
/// A segment is spread over the cells in points no further apart than this \[px\].
const POINT_PX: f32 = 12.0;

/// Pools the segments of an image, or of a view that is predicted.
///
/// Each segment long enough and not near-horizontal is spread over the grid point by point, each point shared by the four
/// cells and the segment by the two directions nearest to it; directions are of the edge with its brighter side to the
/// left. Roots, because an edge more where there are none tells more than where there are many.
#[must_use]
pub fn edge_layout(camera: &PinholeCamera, segments: impl Iterator<Item = Segment2>) -> EdgeLayout {
    let scale = WIDTH_PX / f32::from(camera.width_px());
    // From normal pixels to cells, in Q8.
    let to_cells = [WIDTH_PX, scale * f32::from(camera.height_px())].map(|side| (CELLS * 256) as f32 / side);
    let mut lengths_q16 = [0_u32; FEATURES];
    for segment in segments {
        add(&segment, scale, to_cells, &mut lengths_q16);
    }
    lengths_q16.map(|length| (length >> 4).isqrt().min(i16::MAX as u32) as i16)
}

fn add(segment: &Segment2, scale: f32, to_cells: [f32; 2], lengths_q16: &mut [u32; FEATURES]) {
    let (from, to) = match segment.polarity() {
        Polarity::LeftBrighter => (segment.start(), segment.end()),
        Polarity::RightBrighter => (segment.end(), segment.start()),
    };
    let (from, way) = ([from.x * scale, from.y * scale], [(to.x - from.x) * scale, (to.y - from.y) * scale]);
    let length = math::length(way[0], way[1]);
    if length < LEAST_PX || math::abs(way[1]) < LEAST_SLOPE * math::abs(way[0]) {
        return;
    }
    let turn = u32::from(BinaryAngle::from_radians(math::atan2(way[1], way[0]), core::f32::consts::TAU).0);
    let (direction, later) = ((turn >> 13) as usize, (turn & 0x1fff) >> 5);
    let directions = [(direction % DIRECTIONS, 256 - later), ((direction + 1) % DIRECTIONS, later)];
    let count = (length / POINT_PX) as u32 + 1;
    let share = 1.0 / count as f32;
    let mass_q4 = (length * 16.0 * share) as u32;
    for index in 0..count {
        let at = (index as f32 + 0.5) * share;
        let [columns, rows] = [0, 1].map(|axis| neighbors((from[axis] + way[axis] * at) * to_cells[axis]));
        for (row, row_share) in rows {
            for (column, column_share) in columns {
                let mass_q8 = (mass_q4 * row_share * column_share) >> 12;
                let cell = (row * CELLS + column) * DIRECTIONS;
                for (direction, share) in directions {
                    // A scene would need 65,536 px of edges in one cell to pass the border.
                    let length_q16 = &mut lengths_q16[cell + direction];
                    *length_q16 = length_q16.saturating_add(mass_q8 * share);
                }
            }
        }
    }
}

/// The two cells that share a point, with their shares in Q8, for its coordinate in Q8 cells; the outermost cells reach
/// beyond the border.
#[inline(always)]
fn neighbors(coordinate_q8: f32) -> [(usize, u32); 2] {
    let from_middle = ((coordinate_q8 as i32) - 128).clamp(0, (CELLS as i32 - 1) * 256) as u32;
    let (cell, later) = ((from_middle >> 8) as usize, from_middle & 0xff);
    [(cell, 256 - later), ((cell + 1).min(CELLS - 1), later)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point2;

    fn post(x: f32, polarity: Polarity) -> Segment2 {
        Segment2::new(Point2::new(x, 90.0), Point2::new(x, 390.0), polarity).expect("in range")
    }

    fn of(segments: &[Segment2]) -> EdgeLayout {
        edge_layout(&PinholeCamera::reference(), segments.iter().copied())
    }

    #[test]
    fn all_length_is_found_in_its_direction() {
        let layout = of(&[post(120.0, Polarity::LeftBrighter)]);
        let length = |direction: usize| -> f64 {
            let roots = layout.iter().skip(direction).step_by(DIRECTIONS);
            roots.map(|root| (f64::from(*root) / 64.0).powi(2)).sum()
        };
        // Downwards in the image: a quarter turn.
        assert!((length(2) - 300.0).abs() < 5.0, "{}", length(2));
        assert!((0..DIRECTIONS).filter(|d| *d != 2).all(|d| length(d) < 1.0));
    }

    #[test]
    fn the_brighter_side_and_the_place_tell_edges_apart() {
        let one = of(&[post(120.0, Polarity::LeftBrighter)]);
        assert_eq!(one, of(&[post(120.0, Polarity::LeftBrighter).reversed()]));
        assert_ne!(one, of(&[post(120.0, Polarity::RightBrighter)]));
        assert_ne!(one, of(&[post(360.0, Polarity::LeftBrighter)]));
    }

    #[test]
    fn short_and_near_horizontal_segments_say_nothing() {
        let segment = |x, y| Segment2::new(Point2::new(100.0, 100.0), Point2::new(x, y), Polarity::LeftBrighter);
        assert_eq!(of(&[segment(400.0, 110.0).expect("long"), segment(105.0, 108.0).expect("short")]), [0; FEATURES]);
    }

    #[test]
    fn fragments_say_what_the_whole_says() {
        let whole = of(&[post(200.0, Polarity::LeftBrighter)]);
        let parts: std::vec::Vec<Segment2> = (0..10_u8)
            .map(|index| {
                let y = 90.0 + 30.0 * f32::from(index);
                Segment2::new(Point2::new(200.0, y), Point2::new(200.0, y + 30.0), Polarity::LeftBrighter)
                    .expect("in range")
            })
            .collect();
        assert!(whole.iter().zip(of(&parts)).all(|(a, b)| (a - b).abs() <= 24));
    }
}

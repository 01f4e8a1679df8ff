//! How far each quarter-resolution pixel lies from the nearest seen segment of an orientation.

use super::SeenSegment;
use super::chamfer::spread;
use super::channel::{CHANNELS, channel_of, neighbor_of};

/// Side of a plane's pixel in the normal image \[px\].
pub(super) const PIXEL_PX: f32 = 4.0;
/// Pixels of a plane in a row.
pub(super) const COLUMNS: usize = 160;
/// Rows of a plane.
pub(super) const ROWS: usize = 120;
/// Pixels of a plane.
pub(super) const PLANE: usize = COLUMNS * ROWS;
/// The distances of all channels at one pixel.
pub(super) type Pixel = [u8; CHANNELS];
/// Units of distance from a pixel to the next; 255 units and beyond are far.
pub(super) const UNITS_PER_PIXEL: i32 = 5;

/// One plane of distances for each orientation channel, pixel by pixel.
#[derive(Debug)]
pub(super) struct DistancePlanes<'m> {
    distances: &'m mut [u8; CHANNELS * PLANE],
}

impl<'m> DistancePlanes<'m> {
    /// Bytes of all planes.
    pub(super) const BYTES: usize = CHANNELS * PLANE;

    /// Planes in `distances`, still without meaning.
    pub(super) fn new(distances: &'m mut [u8; CHANNELS * PLANE]) -> Self {
        Self { distances }
    }

    /// The distances of all channels at the first pixel, at the next, and so on.
    pub(super) const fn all(&self) -> &[u8; CHANNELS * PLANE] {
        self.distances
    }

    /// All pixels.
    pub(super) const fn pixels(&self) -> &[Pixel] {
        self.distances.as_chunks().0
    }

    /// Measures all distances anew, from `segments`: each in its own channel and the next nearest.
    pub(super) fn redraw(&mut self, segments: &[SeenSegment]) {
        self.distances.fill(u8::MAX);
        let (pixels, _) = self.distances.as_chunks_mut();
        for segment in segments {
            let (dx, dy) = segment.direction_q4();
            let (dx, dy) = (dx as f32, dy as f32);
            for channel in [channel_of(dx, dy), neighbor_of(dx, dy)] {
                draw(pixels, channel, segment);
            }
        }
        spread(pixels);
    }
}

/// Sets the pixels along a segment in a channel to their distance from it, measured along the shorter axis.
fn draw(pixels: &mut [Pixel], channel: usize, segment: &SeenSegment) {
    let (dx, dy) = segment.direction_q4();
    let is_steep = dy.abs() > dx.abs();
    let along_across = |point: [i16; 2]| {
        let (x, y) = (i32::from(point[0]), i32::from(point[1]));
        if is_steep { (y, x) } else { (x, y) }
    };
    let (mut from, mut to) = (along_across(segment.start_q4), along_across(segment.end_q4));
    if from.0 > to.0 {
        (from, to) = (to, from);
    }
    // A pixel is 4 px = 64 units of Q4 wide.
    let run = to.0 - from.0;
    let slope_q16 = if run == 0 { 0 } else { (i64::from(to.1 - from.1) << 16) / i64::from(run) };
    let (first, last) = (from.0 >> 6, to.0 >> 6);
    for along in first..=last {
        let center = (along * 64 + 32).clamp(from.0, to.0);
        let across = from.1 + ((slope_q16 * i64::from(center - from.0)) >> 16) as i32;
        for pixel in [((across - 32) >> 6), ((across - 32) >> 6) + 1] {
            let distance = ((across - (pixel * 64 + 32)).abs() * UNITS_PER_PIXEL + 32) >> 6;
            let (column, row) = if is_steep { (pixel, along) } else { (along, pixel) };
            if (0..COLUMNS as i32).contains(&column) && (0..ROWS as i32).contains(&row) {
                let nearest = &mut pixels[row as usize * COLUMNS + column as usize][channel];
                *nearest = (*nearest).min(distance as u8);
            }
        }
    }
}

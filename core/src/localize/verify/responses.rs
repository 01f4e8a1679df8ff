//! How well a distance agrees with a prediction, given how exact the prediction can be.

use super::channel::CHANNELS;
use super::distance_planes::{DistancePlanes, PLANE, UNITS_PER_PIXEL};
use crate::math;

/// Widths of the response, standard deviations in px of the normal image.
pub(super) const WIDTHS_PX: [f32; 4] = [7.0, 14.0, 28.0, 56.0];

/// `exp(-d^2 / 2 s^2)` in 1/255, for each width and each distance of a plane.
#[derive(Debug)]
pub(super) struct Responses {
    table: [[u8; 256]; WIDTHS_PX.len()],
    /// The mean response of each channel and width over the image: what chance explains.
    background: [[u8; WIDTHS_PX.len()]; CHANNELS],
}

impl Responses {
    pub(super) fn new() -> Self {
        let mut table = [[0; 256]; WIDTHS_PX.len()];
        for (row, width_px) in table.iter_mut().zip(WIDTHS_PX) {
            for (units, response) in row.iter_mut().enumerate() {
                let distances = units as f32 * 4.0 / UNITS_PER_PIXEL as f32 / width_px;
                *response = math::round(255.0 * math::exp(-0.5 * distances * distances)) as u8;
            }
            // The greatest distance means: none, or out of reach.
            row[255] = 0;
        }
        Self { table, background: [[0; WIDTHS_PX.len()]; CHANNELS] }
    }

    /// Measures the background of newly drawn planes.
    pub(super) fn measure_background(&mut self, planes: &DistancePlanes<'_>) {
        let mut counts = [[0_u16; 256]; CHANNELS];
        for pixel in planes.pixels() {
            for (counts, distance) in counts.iter_mut().zip(pixel) {
                counts[usize::from(*distance)] += 1;
            }
        }
        for (background, counts) in self.background.iter_mut().zip(&counts) {
            for (mean, table) in background.iter_mut().zip(&self.table) {
                let both = counts.iter().zip(table);
                let sum: u32 = both.map(|(count, response)| u32::from(*count) * u32::from(*response)).sum();
                *mean = (sum / PLANE as u32) as u8;
            }
        }
    }

    /// The responses of each width to each distance.
    pub(super) const fn tables(&self) -> &[[u8; 256]; WIDTHS_PX.len()] {
        &self.table
    }

    /// The background of each channel and width.
    pub(super) const fn backgrounds(&self) -> &[[u8; WIDTHS_PX.len()]; CHANNELS] {
        &self.background
    }
}

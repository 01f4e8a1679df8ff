//! How well a distance agrees with a prediction, given how exact the prediction can be.

use super::channel::CHANNELS;
use super::distance_planes::{COLUMNS, DistancePlanes, PIXEL_PX, PLANE, UNITS_PER_PIXEL};
use crate::math;

/// Number of widths of the response, standard deviations of 7, 14, 28 and 56 px of the normal image.
pub(super) const WIDTHS: usize = 4;
/// The least of them \[px\].
const LEAST_WIDTH_PX: f32 = 7.0;
/// Steps of the table to a unit of distance, at the least width.
const STEPS_PER_UNIT: u32 = 4;
/// The step that nothing responds to: the table's last.
const OUT_OF_REACH: u32 = 127;

/// A byte for each step, in fours.
pub(super) type ResponseTable = [[u8; 4]; 32];

/// `exp(-d^2 / 2 s^2)` in 1/255. As every width `s` is twice the one before, one table of `d / s` serves them all.
#[derive(Debug)]
pub(super) struct Responses {
    table: ResponseTable,
    /// The mean response of each channel and width over the image: what chance explains.
    background: [[u8; WIDTHS]; CHANNELS],
}

/// The step of the table for a distance of a plane, at one of the [`WIDTHS`]; rounded down, by less than 0.8 px and only at
/// the widest. The greatest distance, which means none or out of reach, is [`OUT_OF_REACH`] at every width.
#[inline(always)]
pub(super) fn step_of(distance: u32, width: u32) -> u32 {
    const { assert!((u8::MAX as u32 * STEPS_PER_UNIT) >> (WIDTHS - 1) >= OUT_OF_REACH) }
    ((distance * STEPS_PER_UNIT) >> width).min(OUT_OF_REACH)
}

impl Responses {
    pub(super) fn new() -> Self {
        let mut table = ResponseTable::default();
        for (step, response) in table.as_flattened_mut().iter_mut().enumerate().take(OUT_OF_REACH as usize) {
            let px_per_step = PIXEL_PX / (UNITS_PER_PIXEL as f32 * STEPS_PER_UNIT as f32);
            let distances = step as f32 * px_per_step / LEAST_WIDTH_PX;
            *response = math::round(255.0 * math::exp(-0.5 * distances * distances)) as u8;
        }
        Self { table, background: [[0; WIDTHS]; CHANNELS] }
    }

    /// Measures the background of newly drawn planes: distances change so little from row to row that every other will do.
    pub(super) fn measure_background(&mut self, planes: &DistancePlanes<'_>) {
        let mut counts = [[0_u16; 256]; CHANNELS];
        for pixel in planes.pixels().chunks_exact(COLUMNS).step_by(2).flatten() {
            for (counts, distance) in counts.iter_mut().zip(pixel) {
                counts[usize::from(*distance)] += 1;
            }
        }
        for (background, counts) in self.background.iter_mut().zip(&counts) {
            for (mean, width) in background.iter_mut().zip(0..) {
                let response = |distance: u32| u32::from(self.table.as_flattened()[step_of(distance, width) as usize]);
                let sum: u32 =
                    counts.iter().zip(0..).map(|(count, distance)| u32::from(*count) * response(distance)).sum();
                *mean = (sum / (PLANE / 2) as u32) as u8;
            }
        }
    }

    /// The responses, by the step of their distance.
    pub(super) const fn table(&self) -> &ResponseTable {
        &self.table
    }

    /// The background of each channel and width.
    pub(super) const fn backgrounds(&self) -> &[[u8; WIDTHS]; CHANNELS] {
        &self.background
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_distance_has_the_response_of_its_width() {
        let responses = Responses::new();
        for (width, width_px) in [7.0, 14.0, 28.0, 56.0].into_iter().enumerate() {
            for distance in 0..=u32::from(u8::MAX) {
                let found = responses.table().as_flattened()[step_of(distance, width as u32) as usize];
                let distance_px = f64::from(distance) * 0.8;
                let exact =
                    if distance == 255 { 0.0 } else { 255.0 * libm::exp(-0.5 * (distance_px / width_px).powi(2)) };
                assert!((f64::from(found) - exact).abs() <= 3.0, "{distance} at {width_px} px: {found} for {exact}");
            }
        }
    }
}

//! Orientation channels: eight sectors of pi, the first centred on the horizontal.

/// Number of channels.
pub(super) const CHANNELS: usize = 8;

/// Tangents of 11.25, 33.75, 56.25 and 78.75 degrees: the borders between channels.
const BORDERS: [f32; 4] = [0.198_912_37, 0.668_178_6, 1.496_605_8, 5.027_339_5];
/// Tangents of 22.5, 45 and 67.5 degrees: the centres between the horizontal and the vertical.
const CENTERS: [f32; 3] = [0.414_213_56, 1.0, 2.414_213_6];

/// The channel of a direction.
pub(super) fn channel_of(dx: f32, dy: f32) -> usize {
    channel_in_lane(dx, dy) as usize
}

/// The channel of a direction, without a branch, as a vector of them wants it.
#[inline(always)]
pub(super) fn channel_in_lane(dx: f32, dy: f32) -> u32 {
    let x = if dx < 0.0 { -dx } else { dx };
    let y = if dy < 0.0 { -dy } else { dy };
    let sector = u32::from(y > BORDERS[0] * x)
        + u32::from(y > BORDERS[1] * x)
        + u32::from(y > BORDERS[2] * x)
        + u32::from(y > BORDERS[3] * x);
    let is_falling = (dx < 0.0) != (dy < 0.0);
    (if is_falling { CHANNELS as u32 - sector } else { sector }) & (CHANNELS as u32 - 1)
}

/// The channel next nearest to a direction.
pub(super) fn neighbor_of(dx: f32, dy: f32) -> usize {
    let (x, y, is_falling) = folded(dx, dy);
    let sector = BORDERS.iter().filter(|border| y > **border * x).count();
    // Beyond the centre of its sector the next one is nearer, before it the one before.
    let is_beyond = match sector {
        0 => true,
        4 => false,
        _ => y > CENTERS[sector - 1] * x,
    };
    unfolded(if is_beyond { sector + 1 } else { sector - 1 }, is_falling)
}

/// The direction in the first quadrant, and whether that mirrored it.
fn folded(dx: f32, dy: f32) -> (f32, f32, bool) {
    let is_falling = (dx < 0.0) != (dy < 0.0);
    (if dx < 0.0 { -dx } else { dx }, if dy < 0.0 { -dy } else { dy }, is_falling)
}

fn unfolded(sector: usize, is_falling: bool) -> usize {
    if is_falling { (CHANNELS - sector) % CHANNELS } else { sector }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_are_the_nearest_multiples_of_22_5_degrees() {
        for step in 0..720_u16 {
            let degrees = f32::from(step) * 0.5 + 0.1;
            let (dy, dx) = (libm::sinf(degrees.to_radians()), libm::cosf(degrees.to_radians()));
            let position = degrees / 22.5;
            let nearest = libm::roundf(position) as usize;
            let next = if position > nearest as f32 { nearest + 1 } else { nearest + 7 };
            assert_eq!(channel_of(dx, dy), nearest % CHANNELS, "{degrees}");
            assert_eq!(channel_in_lane(dx, dy) as usize, nearest % CHANNELS, "{degrees}");
            assert_eq!(neighbor_of(dx, dy), next % CHANNELS, "{degrees}");
        }
    }
}

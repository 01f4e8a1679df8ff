//! One real camera: focal length, aspect ratio, optical centre and one coefficient of radial distortion.
//!
//! A point in direction (x, y, 1) of the camera frame is seen at the pixel (o_x + f x s, o_y + f a y s),
//! s = 1 + k (x^2 + y^2). The paper's pair (a_x, a_y) is only seen as a product with f, so a_x is 1 and a is a_y.

use crate::math::double;

/// The intrinsic parameters of one camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraParameters {
    /// f: focal length \[px\], along the rows.
    pub focal_length_px: f64,
    /// a_y / a_x: focal length along the columns over that along the rows.
    pub aspect_ratio: f64,
    /// o_x, o_y: where the optical axis meets the image \[px\].
    pub principal_point_px: [f64; 2],
    /// k: radial distortion, positive for a pincushion.
    pub k1: f64,
}

/// The direction of a pixel, and how it answers to a change of the distorted one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sight {
    /// Distorted direction: the pixel in units of the focal length, from the optical centre.
    pub(super) distorted: [f64; 2],
    /// True direction: the line of sight is (x, y, 1).
    pub(super) direction: [f64; 2],
    /// Derivative of the true direction with respect to the distorted one; symmetric.
    pub(super) slope: [[f64; 2]; 2],
}

/// Steps of Newton's method; each doubles the digits, from a start within the lens's own distortion.
const NEWTON_STEPS: usize = 8;

/// Part of the way to the fold of a barrel distortion that is still inverted.
const BEFORE_FOLD: f64 = 0.98;

impl CameraParameters {
    /// Parameters of each camera.
    pub(super) const COUNT: usize = 5;

    /// The pixel at which a point in direction (x, y, 1) is seen.
    #[must_use]
    pub fn pixel(&self, direction: [f64; 2]) -> [f64; 2] {
        let [x, y] = direction;
        let stretch = 1.0 + self.k1 * (x * x + y * y);
        let [center_x, center_y] = self.principal_point_px;
        let f = self.focal_length_px;
        [center_x + f * x * stretch, center_y + f * self.aspect_ratio * y * stretch]
    }

    /// The direction (x, y, 1) of what is seen at a pixel.
    ///
    /// A barrel distortion folds back on itself far out, where no lens does: beyond that fold the direction is the fold's.
    #[must_use]
    pub fn direction(&self, pixel: [f64; 2]) -> [f64; 2] {
        self.sight(pixel).direction
    }

    pub(super) fn sight(&self, pixel: [f64; 2]) -> Sight {
        let f = self.focal_length_px;
        let distorted = [
            (pixel[0] - self.principal_point_px[0]) / f,
            (pixel[1] - self.principal_point_px[1]) / (f * self.aspect_ratio),
        ];
        let scale = self.inverse_stretch(distorted);
        let direction = distorted.map(|coordinate| coordinate * scale);
        let [x, y] = direction;
        // The distorted direction answers by s + 2 k (x, y) (x, y)^T, which is inverted here.
        let stretch = 1.0 + self.k1 * (x * x + y * y);
        let [xx, xy, yy] = [stretch + 2.0 * self.k1 * x * x, 2.0 * self.k1 * x * y, stretch + 2.0 * self.k1 * y * y];
        let determinant = xx * yy - xy * xy;
        let slope = [[yy / determinant, -xy / determinant], [-xy / determinant, xx / determinant]];
        Sight { distorted, direction, slope }
    }

    /// By how much a distorted direction is to be multiplied: r / r_d with r + k r^3 = r_d.
    fn inverse_stretch(&self, distorted: [f64; 2]) -> f64 {
        let distorted_radius = double::sqrt(distorted[0] * distorted[0] + distorted[1] * distorted[1]);
        if distorted_radius < 1e-12 {
            return 1.0;
        }
        // With k < 0, r + k r^3 grows up to r = 1 / sqrt(-3 k) and falls beyond.
        let limit = if self.k1 < 0.0 { BEFORE_FOLD / double::sqrt(-3.0 * self.k1) } else { f64::INFINITY };
        let mut radius = if distorted_radius < limit { distorted_radius } else { limit };
        for _ in 0..NEWTON_STEPS {
            let square = radius * radius;
            let miss = radius * (1.0 + self.k1 * square) - distorted_radius;
            radius -= miss / (1.0 + 3.0 * self.k1 * square);
            if radius > limit {
                radius = limit;
            }
        }
        radius / distorted_radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BARREL: CameraParameters =
        CameraParameters { focal_length_px: 536.5, aspect_ratio: 1.01, principal_point_px: [342.4, 234.3], k1: -0.281 };

    #[test]
    fn a_pixel_and_its_direction_are_inverse() {
        for k1 in [-0.281, -0.05, 0.0, 0.1, 0.4] {
            let camera = CameraParameters { k1, ..BARREL };
            for direction in [[0.0, 0.0], [0.1, -0.2], [-0.55, 0.4], [0.5, 0.1]] {
                let back = camera.direction(camera.pixel(direction));
                let error = (back[0] - direction[0]).abs() + (back[1] - direction[1]).abs();
                assert!(error < 1e-9, "k1 {k1}: {direction:?} became {back:?}");
            }
        }
    }

    #[test]
    fn the_slope_is_how_the_direction_answers() {
        let distorted = |pixel: [f64; 2]| BARREL.sight(pixel).distorted;
        for pixel in [[100.0, 80.0], [342.4, 234.3], [520.0, 401.0]] {
            let sight = BARREL.sight(pixel);
            for axis in 0..2 {
                let mut beside = pixel;
                beside[axis] += 1e-3;
                let step = distorted(beside)[axis] - sight.distorted[axis];
                let moved = BARREL.direction(beside);
                let answer = [0, 1].map(|row| (moved[row] - sight.direction[row]) / step);
                let slope = [0, 1].map(|row| sight.slope[row][axis]);
                let difference = (answer[0] - slope[0]).abs() + (answer[1] - slope[1]).abs();
                assert!(difference < 1e-4, "{pixel:?} axis {axis}: {answer:?} is not {slope:?}");
            }
        }
    }

    #[test]
    fn beyond_the_fold_of_a_barrel_directions_stay_finite() {
        let far = BARREL.direction([0.0, 480.0]);
        assert!(far.iter().all(|coordinate| coordinate.is_finite() && coordinate.abs() < 1.1), "{far:?}");
    }
}

//! Corners of a chessboard in a grey image: saddles of its brightness, to a fraction of a pixel.

/// Half the side of the window in which a corner is refined \[px\].
const HALF_WINDOW: i32 = 5;

/// A grey image.
pub(crate) struct GrayImage {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) pixels: Vec<f64>,
}

impl GrayImage {
    fn at(&self, x: i32, y: i32) -> f64 {
        let x = x.clamp(0, self.width as i32 - 1) as usize;
        let y = y.clamp(0, self.height as i32 - 1) as usize;
        self.pixels[y * self.width + x]
    }

    /// Between the pixels' centres, which lie at whole coordinates.
    fn between(&self, x: f64, y: f64) -> f64 {
        let (column, row) = (x.floor(), y.floor());
        let (a, b) = (x - column, y - row);
        let (column, row) = (column as i32, row as i32);
        let line = |row| self.at(column, row) * (1.0 - a) + self.at(column + 1, row) * a;
        line(row) * (1.0 - b) + line(row + 1) * b
    }

    /// Each pixel the weighted mean of itself and its neighbours within two: a Gaussian of about one pixel.
    fn smoothed(&self) -> Self {
        const WEIGHTS: [f64; 5] = [0.0625, 0.25, 0.375, 0.25, 0.0625];
        let pass = |image: &Self, dx: i32, dy: i32| {
            let mean = |x: i32, y: i32| {
                let terms = WEIGHTS.iter().zip(-2..);
                terms.map(|(weight, step)| weight * image.at(x + dx * step, y + dy * step)).sum::<f64>()
            };
            let rows = 0..self.height as i32;
            let pixels = rows.flat_map(|y| (0..self.width as i32).map(move |x| (x, y))).map(|(x, y)| mean(x, y));
            Self { width: self.width, height: self.height, pixels: pixels.collect() }
        };
        pass(&pass(self, 1, 0), 0, 1)
    }

    /// How much the brightness is a saddle: positive where it rises along one diagonal and falls along the other.
    fn saddle(&self, x: i32, y: i32) -> f64 {
        const STEP: i32 = 2;
        let center = self.at(x, y);
        let xx = self.at(x + STEP, y) - 2.0 * center + self.at(x - STEP, y);
        let yy = self.at(x, y + STEP) - 2.0 * center + self.at(x, y - STEP);
        let xy = (self.at(x + STEP, y + STEP) + self.at(x - STEP, y - STEP)
            - self.at(x + STEP, y - STEP)
            - self.at(x - STEP, y + STEP))
            / 4.0;
        xy * xy - xx * yy
    }
}

/// Corners, the clearest first, at most `most`.
pub(crate) fn find(image: &GrayImage, most: usize) -> Vec<[f64; 2]> {
    const RADIUS: i32 = 4;
    let smooth = image.smoothed().smoothed();
    let (width, height) = (image.width as i32, image.height as i32);
    let strength: Vec<f64> =
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| smooth.saddle(x, y)).collect();
    let strength_at = |x: i32, y: i32| strength[(y * width + x) as usize];
    let mut found = Vec::new();
    for y in 8..height - 8 {
        for x in 8..width - 8 {
            let own = strength_at(x, y);
            let is_greatest = own > 1.0
                && (-RADIUS..=RADIUS).all(|dy| (-RADIUS..=RADIUS).all(|dx| strength_at(x + dx, y + dy) <= own));
            if is_greatest {
                found.push((own, x, y));
            }
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.truncate(most);
    let light = image.smoothed();
    let places = found.iter().filter_map(|(_, x, y)| refined(&light, [f64::from(*x), f64::from(*y)]));
    places.filter(|place| is_crossing(&light, *place)).collect()
}

/// Whether two edges cross here, as between four squares: round it, opposite sides are alike and neighbouring ones are
/// not. At the rim of the board, one dark square among three light fields, they aren't.
fn is_crossing(image: &GrayImage, [x, y]: [f64; 2]) -> bool {
    const RADIUS_PX: f64 = 4.0;
    let round = |step: u8| {
        let (sin, cos) = (f64::from(step) * std::f64::consts::TAU / 32.0).sin_cos();
        image.between(x + RADIUS_PX * cos, y + RADIUS_PX * sin)
    };
    let difference = |by: u8| (0..32).map(|step| (round(step) - round(step + by)).abs()).sum::<f64>();
    difference(16) < 0.3 * difference(8)
}

/// The point whose direction to every pixel round it is at right angles to the gradient there (Förstner).
fn refined(image: &GrayImage, start: [f64; 2]) -> Option<[f64; 2]> {
    let [mut x, mut y] = start;
    for _ in 0..20 {
        let (mut xx, mut xy, mut yy, mut bx, mut by) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for dy in -HALF_WINDOW..=HALF_WINDOW {
            for dx in -HALF_WINDOW..=HALF_WINDOW {
                let (dx, dy) = (f64::from(dx), f64::from(dy));
                let weight = (-(dx * dx + dy * dy) / 12.0).exp();
                let gx = image.between(x + dx + 1.0, y + dy) - image.between(x + dx - 1.0, y + dy);
                let gy = image.between(x + dx, y + dy + 1.0) - image.between(x + dx, y + dy - 1.0);
                xx += weight * gx * gx;
                xy += weight * gx * gy;
                yy += weight * gy * gy;
                bx += weight * gx * (gx * dx + gy * dy);
                by += weight * gy * (gx * dx + gy * dy);
            }
        }
        let determinant = xx * yy - xy * xy;
        if determinant < 1e-3 * (xx + yy) * (xx + yy) {
            return None;
        }
        let (move_x, move_y) = ((yy * bx - xy * by) / determinant, (xx * by - xy * bx) / determinant);
        (x, y) = (x + move_x, y + move_y);
        if (x - start[0]).abs() > 3.0 || (y - start[1]).abs() > 3.0 {
            return None;
        }
        if move_x.abs() + move_y.abs() < 1e-4 {
            break;
        }
    }
    Some([x, y])
}

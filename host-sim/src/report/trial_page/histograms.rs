//! Pairwise geometric histograms as pictures: of the scene's longest lines, beside their best partners in a prediction.

use super::super::drawing::{drawing, line, text, tidy, tooltip};
use crate::report::LookExplanation;
use edgeloc::database::Node as MapNode;
use edgeloc::geometry::{Segment2, StereoRig};
use edgeloc::localize::{LocalizerConfig, lines_to_match, predict_view};
use edgeloc::pgh::{DistanceKind, HistogramBuilder, Line, LineBlock, PghShape};
use svg::Node;
use svg::node::element::{Group, Rectangle, SVG};

/// Reference lines shown a look.
const SHOWN_LINES: usize = 3;

/// Width and height in pixels of one histogram.
const SIZE_PX: (f64, f64) = (260.0, 180.0);

/// One of a root in Q15.
const ONE_Q15: f64 = 32_768.0;

/// A histogram of the scene and its best partner.
pub(super) struct HistogramPair {
    pub(super) caption: String,
    pub(super) drawing: SVG,
}

/// A histogram in root form, bin by bin, and the length of its reference line in pixels.
struct Histogram {
    length_px: f64,
    roots: Vec<f64>,
}

impl Histogram {
    /// The Bhattacharyya coefficient with another.
    fn coefficient(&self, other: &Self) -> f64 {
        self.roots.iter().zip(&other.roots).map(|(a, b)| a * b).sum()
    }
}

/// The scene's longest reference lines with their best partners in the prediction of `node`.
pub(super) fn histograms(
    look: &LookExplanation,
    node: &MapNode<'_>,
    rig: &StereoRig,
    config: &LocalizerConfig,
) -> Vec<HistogramPair> {
    let scene = all_histograms(look.scene.iter().copied(), config);
    let prediction = all_histograms(predict_view(node, rig, look.compass), config);
    let pair = |(rank, own): (usize, &Histogram)| {
        let best = prediction.iter().max_by(|a, b| own.coefficient(a).total_cmp(&own.coefficient(b)))?;
        let coefficient = own.coefficient(best);
        let caption = format!(
            "line {}, {:.0} px; its partner {:.0} px; coefficient {coefficient:.3}",
            rank + 1,
            own.length_px,
            best.length_px
        );
        let (width, height) = SIZE_PX;
        let drawing = drawing(2.0 * width + 120.0, height + 48.0)
            .add(heat_map(own, &config.shape, (56.0, 20.0), "scene"))
            .add(heat_map(best, &config.shape, (width + 112.0, 20.0), "prediction"));
        Some(HistogramPair { caption, drawing })
    };
    scene.iter().enumerate().take(SHOWN_LINES).filter_map(pair).collect()
}

/// The histograms about all lines that take part in the matching, the longest line first.
fn all_histograms(segments: impl Iterator<Item = Segment2>, config: &LocalizerConfig) -> Vec<Histogram> {
    let shape = &config.shape;
    let segments: Vec<Segment2> = segments.collect();
    let places = segments.iter().take(usize::from(config.max_segments));
    let mut storage: Vec<Line> = places.map(|segment| Line::new(segment, 0, shape)).collect();
    let lines = lines_to_match(segments.into_iter(), config, &mut storage);
    let mut memory = vec![0; HistogramBuilder::memory_len(shape)];
    let mut blocks = vec![LineBlock::EMPTY; LineBlock::count_for(lines.len())];
    let Ok(mut builder) = HistogramBuilder::new(shape, &mut memory, &mut blocks) else { return Vec::new() };
    if builder.load(lines).is_err() {
        return Vec::new();
    }
    let mut about = |(index, line): (usize, &Line)| {
        let mut roots = vec![0.0; shape.bin_count() + 1];
        builder.build(line, index, |pair, values| {
            for (bin, value) in roots[2 * usize::from(pair)..].iter_mut().zip(values) {
                *bin = f64::from(value) / ONE_Q15;
            }
        });
        Histogram { length_px: f64::from(line.length_q4()) / 16.0, roots }
    };
    let mut histograms: Vec<Histogram> = lines.iter().enumerate().map(&mut about).collect();
    histograms.sort_by(|a, b| b.length_px.total_cmp(&a.length_px));
    histograms
}

/// A histogram with its axes; `at` is its top left corner.
fn heat_map(histogram: &Histogram, shape: &PghShape, at: (f64, f64), name: &str) -> Group {
    let (left, top) = at;
    let (width, height) = SIZE_PX;
    let (distance_bins, angle_bins) = (usize::from(shape.distance_bins), usize::from(shape.angle_bins));
    let (cell_width, cell_height) = (width / angle_bins as f64, height / distance_bins as f64);
    let period_deg = f64::from(shape.period_radians().to_degrees());
    let bin_deg = period_deg / angle_bins as f64;
    let frame = Rectangle::new().set("class", "frame").set("x", left).set("y", top);
    let mut map = Group::new().add(frame.set("width", width).set("height", height));
    let most = histogram.roots.iter().copied().fold(1e-9, f64::max);
    for (bin, root) in histogram.roots.iter().enumerate().filter(|(_, root)| **root > 0.0) {
        let (row, column) = (bin / angle_bins, bin % angle_bins);
        map.append(
            Rectangle::new()
                .set("class", "heat")
                .set("x", tidy(left + column as f64 * cell_width))
                .set("y", tidy(top + height - (row + 1) as f64 * cell_height))
                .set("width", tidy(cell_width))
                .set("height", tidy(cell_height))
                .set("fill-opacity", tidy(root / most))
                .add(tooltip(format!(
                    "{}, {:.0}° ± {:.0}°: {:.2} % of the mass",
                    distance_range(shape, row),
                    column as f64 * bin_deg,
                    bin_deg / 2.0,
                    100.0 * root * root
                ))),
        );
    }
    let nearest = if shape.distance == DistanceKind::Signed { -shape.max_distance_px } else { 0.0 };
    map.append(text("middle", (left + width / 2.0, top - 6.0), name));
    for angle_deg in (0_u16..360).step_by(90).map(f64::from).filter(|angle_deg| *angle_deg < period_deg) {
        // A bin's centre, not its border, lies at a whole multiple of its width.
        let x = left + (angle_deg / bin_deg + 0.5) * cell_width;
        map.append(line("axis", (x, top + height), (x, top + height + 4.0)));
        map.append(text("middle", (x, top + height + 17.0), format!("{angle_deg:.0}°")));
    }
    map.append(text("end", (left - 4.0, top + 10.0), format!("{:.0}", shape.max_distance_px)));
    map.append(text("end", (left - 4.0, top + height), format!("{nearest:.0} px")));
    map
}

/// The perpendicular distances that a bin covers, in words.
fn distance_range(shape: &PghShape, row: usize) -> String {
    let nearest = if shape.distance == DistanceKind::Signed { -f64::from(shape.max_distance_px) } else { 0.0 };
    let width = f64::from(shape.distance_bin_width_px());
    let from = nearest + row as f64 * width;
    format!("{from:.0} to {:.0} px", from + width)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The number of an attribute of an element.
    fn number(element: &str, attribute: &str) -> f64 {
        let value = element.split_once(&format!(" {attribute}=\"")).expect("the attribute").1;
        value.split('"').next().and_then(|value| value.parse().ok()).expect("a number")
    }

    #[test]
    fn the_mark_of_an_angle_stands_at_the_centre_of_its_bin() {
        for (uses_polarity, angle_deg, column) in [(true, 0, 0), (true, 90, 8), (true, 270, 24), (false, 90, 16)] {
            let shape = PghShape { uses_polarity, ..PghShape::paper() };
            let mut roots = vec![0.0; shape.bin_count()];
            roots[column] = 1.0;
            let svg = heat_map(&Histogram { length_px: 50.0, roots }, &shape, (56.0, 20.0), "scene").to_string();
            let svg = svg.replace('\n', "");
            let element = |is_it: &dyn Fn(&str) -> bool| svg.split('<').find(|part| is_it(part)).expect("an element");
            let heat = element(&|part| part.contains("class=\"heat\""));
            let label = element(&|part| part.starts_with("text") && part.ends_with(&format!(">{angle_deg}°")));
            let center = number(heat, "x") + number(heat, "width") / 2.0;
            assert!((number(label, "x") - center).abs() < 0.02, "{angle_deg} degrees: {label} for {heat}");
        }
    }
}

//! Pairwise geometric histograms as pictures: of the scene's longest lines, beside their best partners in a prediction.

use super::super::drawing::{drawing, text, tidy, tooltip};
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
        let drawing = drawing(2.0 * width + 120.0, height + 46.0)
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
                    "distance bin {row}, angle bin {column}: {:.2} % of the mass",
                    100.0 * root * root
                ))),
        );
    }
    let nearest = if shape.distance == DistanceKind::Signed { -shape.max_distance_px } else { 0.0 };
    let turn_deg = shape.period_radians().to_degrees();
    map.append(text("middle", (left + width / 2.0, top - 6.0), name));
    map.append(text("start", (left, top + height + 15.0), "0°"));
    map.append(text("end", (left + width, top + height + 15.0), format!("{turn_deg:.0}°")));
    map.append(text("end", (left - 4.0, top + 10.0), format!("{:.0}", shape.max_distance_px)));
    map.append(text("end", (left - 4.0, top + height), format!("{nearest:.0} px")));
    map
}

//! One look over the map of an office, as histograms: what every library matches.

use edgeloc::geometry::{Angle, Heading, Segment2};
use edgeloc::localize::{LocalizerConfig, lines_to_match, predict_view};
use edgeloc::matching::{BinPair, Panel, RootRows, best_coefficients};
use edgeloc::pgh::{HistogramBuilder, Line, LineBlock, PghShape};
use edgeloc_benches::stored_view::{BINS, PanelMemory, panels, roots, stored_view};
use edgeloc_sim::monte_carlo::{LookEvent, Replay, Site};
use edgeloc_sim::scenario::Scenario;
use edgeloc_sim::world::office::{self, OfficeOptions};
use edgeloc_tests::oracle::{NaiveSegment, scene_histograms};
use std::hint::black_box;

/// The trial whose first look it is: a scene of the mean size.
const TRIAL: u32 = 5;

/// A scene and the views that it meets: of each of 72 nodes the two learned ones whose headings are nearest, as the paper
/// has it.
#[derive(Debug)]
pub struct OfficeLook {
    scene: Vec<Line>,
    segments: Vec<NaiveSegment>,
    rows: RootRows<'static>,
    scratch: Scratch,
    views: Vec<View>,
}

/// What building the scene's histograms works on.
#[derive(Debug)]
struct Scratch {
    masses: Vec<i32>,
    blocks: Vec<LineBlock>,
}

/// A view's histograms.
#[derive(Debug)]
struct View {
    lines: usize,
    panels: Vec<Panel<'static>>,
    memory: &'static [PanelMemory],
}

impl OfficeLook {
    /// Learns the first office of the preset `paper` and looks at it once.
    ///
    /// # Panics
    /// When the preset does not work.
    #[must_use]
    pub fn prepare() -> Self {
        let scenario = Scenario::default();
        let world = office::generate(&OfficeOptions { seed: 1, ..OfficeOptions::default() });
        let site = Site::prepare(world, &scenario).expect("the office has room for the nodes");
        let setting = scenario.setting(None).expect("a row").expect("the preset is legal");
        let replay = Replay::new(&site, &setting, TRIAL, None).expect("the map can be learned");
        let mut first_look: Option<(Vec<Segment2>, Heading)> = None;
        let watch = |event: &LookEvent<'_>| {
            first_look.get_or_insert_with(|| (event.scene.to_vec(), event.pose.heading));
        };
        replay.run(watch).expect("the map opens");
        let (segments, heading) = first_look.expect("a trial has a look");

        let config = LocalizerConfig::paper();
        let scene = matched(segments.iter().copied(), &config);
        let map = replay.map().expect("the map opens");
        let mut views = Vec::new();
        for node in map.nodes() {
            for view_angle in nearest_view_angles(heading) {
                let lines = matched(predict_view(&node, map.rig(), view_angle), &config);
                if !lines.is_empty() {
                    views.push(View::build(&lines));
                }
            }
        }
        let used = scene.iter().map(|line| NaiveSegment::from(&segments[line.order() as usize])).collect();
        let mut look = Self {
            segments: used,
            rows: RootRows::new(
                vec![BinPair { index: 0, roots: [0; 2] }; RootRows::pairs_len(scene.len(), BINS)].leak(),
                vec![0; scene.len()].leak(),
            ),
            scratch: Scratch::new(&config.shape, scene.len()),
            scene,
            views,
        };
        look.describe();
        look
    }

    /// Lines of the scene.
    #[must_use]
    pub const fn scene_lines(&self) -> usize {
        self.scene.len()
    }

    /// Lines of each view.
    pub fn view_lines(&self) -> impl ExactSizeIterator<Item = usize> {
        self.views.iter().map(|view| view.lines)
    }

    /// Pairs of bins that the scene's histograms hold, of which no two zeros.
    #[must_use]
    pub fn scene_pairs(&self) -> usize {
        self.rows.rows().map(<[BinPair]>::len).sum()
    }

    /// The scene's histograms one after another, bin by bin, in Q15.
    pub fn scene_roots(&self) -> impl Iterator<Item = i16> {
        self.rows.rows().flat_map(|row| {
            let mut histogram = [0; BINS];
            for pair in row {
                let place = 2 * usize::from(pair.index);
                histogram[place..place + 2].copy_from_slice(&pair.roots);
            }
            histogram
        })
    }

    /// The views' histograms likewise.
    pub fn view_roots(&self) -> impl Iterator<Item = i16> {
        let of_view = |view: &View, line: usize| roots(view.memory, line);
        self.views.iter().flat_map(move |view| (0..view.lines).flat_map(move |line| of_view(view, line)))
    }

    /// Builds the scene's histograms as the localiser does, packed for matching.
    pub fn describe(&mut self) {
        let Scratch { masses, blocks } = &mut self.scratch;
        let mut builder = HistogramBuilder::new(&PghShape::paper(), masses, blocks).expect("memory asked for");
        self.rows.rebuild(&mut builder, &self.scene).expect("memory asked for");
    }

    /// Builds the same histograms as the naive twin does.
    pub fn describe_naively(&self) {
        black_box(scene_histograms(&PghShape::paper(), black_box(&self.segments)));
    }

    /// The best coefficient in Q30 of every scene line with every view, view by view.
    pub fn best_coefficients(&self, best: &mut [i32]) {
        best.fill(0);
        for (view, best) in self.views.iter().zip(best.chunks_exact_mut(self.scene.len())) {
            best_coefficients(&self.rows, &view.panels, best);
        }
    }
}

impl Scratch {
    fn new(shape: &PghShape, lines: usize) -> Self {
        Self {
            masses: vec![0; HistogramBuilder::memory_len(shape)],
            blocks: vec![LineBlock::EMPTY; LineBlock::count_for(lines)],
        }
    }
}

impl View {
    fn build(lines: &[Line]) -> Self {
        let stored = stored_view(lines);
        // One copy to export from, one that the panels keep.
        let memory = stored.clone().leak();
        Self { lines: lines.len(), panels: panels(stored.leak()), memory }
    }
}

fn matched(segments: impl Iterator<Item = Segment2>, config: &LocalizerConfig) -> Vec<Line> {
    let segments: Vec<Segment2> = segments.collect();
    let mut storage: Vec<Line> = segments.iter().map(|segment| Line::new(segment, 0, &config.shape)).collect();
    storage.truncate(usize::from(config.max_segments));
    lines_to_match(segments.into_iter(), config, &mut storage).to_vec()
}

/// The learned headings on either side, 30 degrees apart.
fn nearest_view_angles(heading: Heading) -> [Heading; 2] {
    let below = (heading.angle().degrees() / 30.0).floor();
    [below, below + 1.0].map(|step| Heading::new(Angle::from_degrees(30.0 * step)).expect("finite"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_kernel_finds_the_best_dot_product_of_the_roots() {
        let look = OfficeLook::prepare();
        let mut best = vec![0; look.scene_lines() * look.view_lines().len()];
        look.best_coefficients(&mut best);
        let (scene, views): (Vec<i16>, Vec<i16>) = (look.scene_roots().collect(), look.view_roots().collect());
        let mut views = views.chunks_exact(BINS);
        for (lines, best) in look.view_lines().zip(best.chunks_exact(look.scene_lines())) {
            let view: Vec<&[i16]> = views.by_ref().take(lines).collect();
            for (row, best) in scene.chunks_exact(BINS).zip(best) {
                let dot =
                    |line: &&[i16]| -> i32 { row.iter().zip(*line).map(|(a, b)| i32::from(*a) * i32::from(*b)).sum() };
                assert_eq!(view.iter().map(dot).max(), Some(*best));
            }
        }
        assert_eq!(views.len(), 0);
    }
}

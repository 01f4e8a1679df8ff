//! The best coefficient of each scene line with a view whose histograms are stored: every vector body beside the naive twin.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use edgeloc::geometry::Segment2;
use edgeloc::matching::{BinPair, RootRows, best_coefficients};
use edgeloc::pgh::{HistogramBuilder, Line, LineBlock, PghShape};
use edgeloc_benches::stored_view::{panels, stored_view};
use edgeloc_benches::workloads;
use edgeloc_tests::matcher::lines;
use edgeloc_tests::oracle::{NaiveSegment, scene_histograms, view_score};
use std::hint::black_box;

fn scene_against_stored_view(criterion: &mut Criterion) {
    let shape = PghShape::paper();
    let naive = |segments: &[Segment2]| segments.iter().map(NaiveSegment::from).collect::<Vec<_>>();
    let mut group = criterion.benchmark_group("coefficients");
    for workload in workloads::scenes() {
        let (scene, view) = (lines(&shape, &workload.scene), lines(&shape, &workload.view));
        let mut stored = stored_view(&view);
        let panels = panels(&mut stored);
        let mut masses = vec![0; HistogramBuilder::memory_len(&shape)];
        let mut blocks = vec![LineBlock::EMPTY; LineBlock::count_for(scene.len())];
        let mut builder = HistogramBuilder::new(&shape, &mut masses, &mut blocks).expect("memory as asked for");
        let mut pairs = vec![BinPair { index: 0, roots: [0; 2] }; RootRows::pairs_len(scene.len(), shape.bin_count())];
        let mut ends = vec![0; scene.len()];
        let mut rows = RootRows::new(&mut pairs, &mut ends);
        rows.rebuild(&mut builder, &scene).expect("memory as asked for");
        let mut best = vec![0; scene.len()];
        group.throughput(Throughput::Elements((scene.len() * view.len()).max(1) as u64));
        for body in bodies() {
            best.fill(0);
            best_coefficients(&rows, &panels, &mut best);
            assert_eq!(mean(&scene, &best), workload.expected_score_q30, "{} with {body}", workload.name);
            group.bench_function(BenchmarkId::new(body, workload.name), |bencher| {
                bencher.iter(|| {
                    best.fill(0);
                    best_coefficients(black_box(&rows), black_box(&panels), &mut best);
                });
            });
        }

        let (scene, view) = (naive(&workload.scene), naive(&workload.view));
        let (of_scene, of_view) = (scene_histograms(&shape, &scene), scene_histograms(&shape, &view));
        group.sample_size(10);
        group.bench_function(BenchmarkId::new("naive", workload.name), |bencher| {
            bencher.iter(|| view_score(black_box(&scene), black_box(&of_scene), black_box(&of_view)));
        });
        group.sample_size(100);
    }
    group.finish();
}

/// The mean of the best coefficients, each line weighted by its length.
fn mean(scene: &[Line], best: &[i32]) -> i32 {
    let weight: i64 = scene.iter().map(|line| i64::from(line.length_q4())).sum();
    let weighted: i64 = scene.iter().zip(best).map(|(line, best)| i64::from(line.length_q4()) * i64::from(*best)).sum();
    weighted.checked_div(weight).unwrap_or(0) as i32
}

/// Each body of the machine in turn, narrow to wide, ready when its name is given out.
#[cfg(target_arch = "x86_64")]
fn bodies() -> impl Iterator<Item = &'static str> {
    ["SSE2", "AVX2", "AVX-512 VNNI"].into_iter().filter(|name| edgeloc::matching::limit_body(name) == *name)
}

/// The one body of the machine.
#[cfg(not(target_arch = "x86_64"))]
fn bodies() -> impl Iterator<Item = &'static str> {
    std::iter::once(edgeloc::matching::body_name())
}

criterion_group!(benches, scene_against_stored_view);
criterion_main!(benches);

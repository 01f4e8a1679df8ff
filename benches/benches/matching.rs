//! Scoring a scene against one view, the view's histograms included: the fixed-point kernel beside its naive twin.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use edgeloc::geometry::Segment2;
use edgeloc::pgh::PghShape;
use edgeloc_benches::workloads;
use edgeloc_tests::matcher::{MatcherMemory, lines};
use edgeloc_tests::oracle::{NaiveSegment, scene_histograms, view_score};
use std::hint::black_box;

fn scene_against_view(criterion: &mut Criterion) {
    let shape = PghShape::paper();
    let naive = |segments: &[Segment2]| segments.iter().map(NaiveSegment::from).collect::<Vec<_>>();
    let mut group = criterion.benchmark_group("matching");
    for workload in workloads::scenes() {
        let (scene, view) = (lines(&shape, &workload.scene), lines(&shape, &workload.view));
        let mut memory = MatcherMemory::new(&shape, scene.len().max(view.len()));
        let mut matcher = memory.matcher();
        matcher.describe(&scene);
        let score = matcher.score(&scene, &view);
        assert_eq!(score.q30, workload.expected_score_q30, "{}", workload.name);
        // One element is one coefficient of a scene line with a view line.
        group.throughput(Throughput::Elements((scene.len() * view.len()).max(1) as u64));
        group.bench_function(BenchmarkId::new("fast", workload.name), |bencher| {
            bencher.iter(|| matcher.score(black_box(&scene), black_box(&view)));
        });

        let (scene, view) = (naive(&workload.scene), naive(&workload.view));
        let of_scene = scene_histograms(&shape, &scene);
        let naive_score = || view_score(black_box(&scene), &of_scene, &scene_histograms(&shape, black_box(&view)));
        assert!((naive_score() - score.as_f64()).abs() < 2.0e-3, "{}: {} and {score:?}", workload.name, naive_score());
        group.sample_size(10);
        group.bench_function(BenchmarkId::new("naive", workload.name), |bencher| bencher.iter(naive_score));
        group.sample_size(100);
    }
    group.finish();
}

criterion_group!(benches, scene_against_view);
criterion_main!(benches);

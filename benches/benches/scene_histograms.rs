//! Building the root histograms of a scene: the fixed-point builder beside its naive twin.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use edgeloc::pgh::PghShape;
use edgeloc_benches::workloads;
use edgeloc_tests::matcher::{MatcherMemory, lines};
use edgeloc_tests::oracle::{NaiveSegment, scene_histograms};
use std::hint::black_box;

fn histograms_of_a_scene(criterion: &mut Criterion) {
    let shape = PghShape::paper();
    let mut group = criterion.benchmark_group("scene_histograms");
    for workload in workloads::scenes() {
        let scene = lines(&shape, &workload.scene);
        let mut memory = MatcherMemory::new(&shape, scene.len());
        let mut matcher = memory.matcher();
        assert_eq!(matcher.describe(&scene), workload.expected_bin_pairs, "{}", workload.name);
        // An entry is one segment in the histogram of another.
        group.throughput(Throughput::Elements((scene.len() * scene.len().saturating_sub(1)).max(1) as u64));
        group.bench_with_input(BenchmarkId::new("fast", workload.name), &scene, |bencher, scene| {
            bencher.iter(|| matcher.describe(black_box(scene)));
        });
        let naive: Vec<NaiveSegment> = workload.scene.iter().map(NaiveSegment::from).collect();
        group.sample_size(10);
        group.bench_with_input(BenchmarkId::new("naive", workload.name), &naive, |bencher, naive| {
            bencher.iter(|| scene_histograms(&shape, black_box(naive)));
        });
        group.sample_size(100);
    }
    group.finish();
}

criterion_group!(benches, histograms_of_a_scene);
criterion_main!(benches);

//! One look of the whole localiser, all nodes in play: prediction, histograms and matching of every node, or the search
//! for the pose that explains the look best, which has a naive twin only for single poses: `verification`.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use edgeloc::database::TopologicalDatabase;
use edgeloc::geometry::{Scene, Segment3};
use edgeloc::localize::{HeadingPrior, Localizer, Look};
use edgeloc_benches::workloads::{self, LookWorkload, RIG};
use edgeloc_tests::oracle::Attempt;
use std::hint::black_box;
use std::time::Duration;

fn first_look(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("one_look");
    for workload in workloads::looks() {
        let config = workload.config;
        let database = TopologicalDatabase::open(&workload.database).expect("just written");
        let mut memory = vec![0; Localizer::memory_len(&config, workload.nodes)];
        let mut localizer = Localizer::new(database, &config, &mut memory).expect("memory of the length asked for");
        let look = Look {
            heading: Some(HeadingPrior::exact(workload.heading)),
            motion_since_last: None,
            scene: Scene::new(&workload.scene),
        };
        localizer.observe(&look).expect("a heading is given");
        check(&localizer, &workload);
        let mut observe = || {
            localizer.reset();
            localizer.observe(black_box(&look)).expect("a heading is given")
        };
        group.throughput(Throughput::Elements(workload.nodes as u64)).sample_size(30);
        group.bench_function(BenchmarkId::new("fast", workload.name), |bencher| bencher.iter(&mut observe));
        // The naive twin of the paper's localiser takes about a second for eight nodes.
        if workload.nodes <= 8 && config.verification.is_none() {
            let nodes: Vec<Vec<Segment3>> = database.nodes().map(|node| node.segments().collect()).collect();
            group.sample_size(10).measurement_time(Duration::from_secs(10));
            group.bench_function(BenchmarkId::new("naive", workload.name), |bencher| {
                bencher
                    .iter(|| Attempt::new(&RIG, &config, &nodes).observe(workload.heading, black_box(&workload.scene)));
            });
            group.measurement_time(Duration::from_secs(5));
        }
    }
    group.finish();
}

fn check(localizer: &Localizer<'_>, workload: &LookWorkload) {
    let (leader, score) = localizer.candidates().leading_node().expect("there are nodes");
    let found = (leader.0, score.sum_q30, localizer.candidates().candidates().count());
    let expected = (workload.expected_leader, workload.expected_score_q30, workload.expected_candidates);
    assert_eq!(found, expected, "leader, score and candidates of {}", workload.name);
}

criterion_group!(benches, first_look);
criterion_main!(benches);

//! Evidence of one look for poses beside a node: distance planes, tables and lanes beside their naive twin.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use edgeloc::database::{NodeId, TopologicalDatabase};
use edgeloc::geometry::Segment3;
use edgeloc::localize::{Evidence, LocalizerConfig, PoseCheck};
use edgeloc_benches::workloads::{self, PoseWorkload, RIG};
use edgeloc_tests::oracle::{NaiveCloseness, NaiveSegment, verification_evidence};
use std::hint::black_box;

const CONFIG: LocalizerConfig = LocalizerConfig::edgeloc();
/// How far a pose may be off \[m\], and how far apart points are looked up \[px\].
const POSITION_M: f32 = 0.12;
const SPACING_PX: f32 = 9.0;

fn evidence_for_poses(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("verification");
    for workload in workloads::poses() {
        let database = TopologicalDatabase::open(&workload.database).expect("just written");
        let node = database.node(NodeId(0)).expect("the one node");
        let mut memory = vec![0; PoseCheck::memory_len()];
        let mut fast = |workload: &PoseWorkload| -> Evidence {
            let mut check = PoseCheck::new(&RIG, &CONFIG, &workload.scene, &mut memory).expect("memory as asked for");
            let evidence =
                |offset: &[f32; 2]| check.evidence(&node, (*offset, workload.heading), [POSITION_M, 0.0, SPACING_PX]);
            workload.offsets.iter().map(evidence).fold(Evidence::default(), Evidence::plus)
        };
        let found = fast(&workload);
        assert_eq!((found.explained_q4, found.total_q4), workload.expected_evidence_q4, "{}", workload.name);
        group.throughput(Throughput::Elements(workload.offsets.len() as u64));
        group.bench_with_input(BenchmarkId::new("fast", workload.name), &workload, |bencher, workload| {
            bencher.iter(|| fast(black_box(workload)));
        });
        // The naive twin takes seconds for more.
        if workload.scene.len() > 150 {
            continue;
        }
        let scene: Vec<NaiveSegment> = workload.scene.iter().map(NaiveSegment::from).collect();
        let model: Vec<Segment3> = node.segments().collect();
        let closeness =
            NaiveCloseness { position_m: f64::from(POSITION_M), heading_rad: 0.0, spacing_px: f64::from(SPACING_PX) };
        let limits = (f64::from(CONFIG.min_length_px), f64::from(CONFIG.horizontal_exclusion.radians()));
        let radians = f64::from(workload.heading.angle().radians());
        group.sample_size(10);
        group.bench_with_input(BenchmarkId::new("naive", workload.name), &scene, |bencher, scene| {
            bencher.iter(|| {
                let evidence = |offset: &[f32; 2]| {
                    verification_evidence(&RIG, black_box(scene), &model, (*offset, radians), &closeness, limits)
                };
                workload.offsets.iter().map(evidence).fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1))
            });
        });
        group.sample_size(100);
    }
    group.finish();
}

criterion_group!(benches, evidence_for_poses);
criterion_main!(benches);

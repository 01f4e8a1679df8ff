//! Maps of more nodes than the shortlist: what the first stage keeps, and what stays as it was.

use edgeloc::database::TopologicalDatabase;
use edgeloc::localize::{Localizer, LocalizerConfig};
use edgeloc_sim::learning::indexed;
use edgeloc_sim::map_file::MapFile;
use edgeloc_sim::monte_carlo::{Campus, CampusRecord, CampusStart};
use std::sync::LazyLock;

/// Two small buildings in one map with an index, and robots in them.
struct Site {
    map: MapFile,
    starts: Vec<CampusStart>,
}

static SITE: LazyLock<Site> = LazyLock::new(|| {
    let campus = Campus::new(1000, &["learning.nodes=40".to_owned()]).expect("a legal scenario");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("campus.edgemap");
    campus.learn(folder.path(), 2, &|| ()).expect("two offices can be learned");
    campus.map(folder.path(), 2, &path, &|_| ()).expect("two maps can be joined");
    Site { map: MapFile::open(&path).expect("a file"), starts: campus.starts(2, 24, &|| ()).expect("nodes are placed") }
});

fn map() -> TopologicalDatabase<'static> {
    TopologicalDatabase::open(&SITE.map).expect("a mapped file opens like any bytes")
}

fn run(map: TopologicalDatabase<'_>, config: &LocalizerConfig) -> Vec<CampusRecord> {
    let mut memory = vec![0; Localizer::memory_len_in(config, &map)];
    let run = |start: &CampusStart| start.run(map, config, &mut memory).expect("memory of the length asked for");
    SITE.starts.iter().map(run).collect()
}

fn without_times(records: Vec<CampusRecord>) -> Vec<CampusRecord> {
    records.into_iter().map(|record| CampusRecord { look_times: Vec::new(), ..record }).collect()
}

#[test]
fn the_first_stage_keeps_the_place_and_the_answer_is_right() {
    let config = LocalizerConfig { shortlist: 16, ..LocalizerConfig::edgeloc() };
    let records = run(map(), &config);
    let count = |of: fn(&CampusRecord) -> bool| records.iter().filter(|record| of(record)).count();
    // A fifth of the nodes is scored. At the time of writing 22 and 24 of 24, and 23 right.
    assert!(count(|record| record.is_shortlisted[0]) >= 19, "{records:?}");
    assert!(count(|record| record.is_shortlisted[1]) >= 22, "{records:?}");
    assert!(count(|record| record.is_success) >= 21, "{records:?}");
}

#[test]
fn the_paper_s_localiser_scores_the_shortlist_alone() {
    let config = LocalizerConfig { shortlist: 16, ..LocalizerConfig::paper() };
    let records = run(map(), &config);
    let kept = records.iter().filter(|record| record.is_shortlisted[0]).count();
    assert!(kept >= 17, "{kept}: {records:?}");
}

#[test]
fn an_index_changes_nothing_in_a_map_no_larger_than_the_shortlist() {
    for config in [LocalizerConfig::paper(), LocalizerConfig::edgeloc()] {
        let config = LocalizerConfig { shortlist: map().node_count() as u16, ..config };
        assert_eq!(
            Localizer::memory_len_in(&config, &map()),
            Localizer::memory_len(&config, map().node_count()),
            "no memory for a first stage"
        );
        let plain = without_times(run(map().without_index(), &config));
        assert_eq!(without_times(run(map(), &config)), plain);
    }
}

#[test]
fn memory_follows_the_shortlist() {
    let config = LocalizerConfig { shortlist: 16, ..LocalizerConfig::edgeloc() };
    let map = map();
    let poses = map.index().map_or(0, |index| usize::from(index.shape().poses));
    let needed = Localizer::memory_len_in(&config, &map);
    assert_eq!(needed, Localizer::indexed_memory_len(&config, map.node_count(), poses));
    let more = Localizer::indexed_memory_len(&config, map.node_count() + 1000, poses);
    assert_eq!(8 * (more - needed), 1000 * (16 + 2 * poses), "16 bytes a node and 2 a pose");
}

#[test]
fn an_index_is_worked_out_of_the_map_alone() {
    let map = map();
    let again = indexed(&SITE.map).expect("the same map");
    assert!(again == SITE.map[..map.byte_len()], "the same bytes in memory as in a file");
}

//! Kidnapped-robot trials end to end: the same rows by every way, the certain case, and a table of a small sweep.

use edgeloc::geometry::{Angle, Heading, Point2};
use edgeloc_sim::monte_carlo::{
    LookEvent, Outcome, Part, RunOutcome, Shard, Site, Sites, TimedTrial, TrialRecord, TruePose, UnknownKind, replay,
    run, run_part,
};
use edgeloc_sim::scenario::{LocalizerKind, Row, Scenario, Setting, Start};
use edgeloc_sim::uncertainty::Sources;
use edgeloc_sim::world::WireframeWorld;
use edgeloc_sim::world::office::{self, OfficeOptions};
use std::fmt::Write as _;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// A small scenario in the generated office: 16 nodes, 12 trials of four rows over 3 maps.
fn small_scenario() -> Scenario {
    let mut scenario = Scenario { trials: 12, trials_per_map: 4, ..Scenario::default() };
    scenario.learning.nodes = 16;
    scenario
}

fn office() -> WireframeWorld {
    office::generate(&OfficeOptions { seed: 3, ..OfficeOptions::default() })
}

fn office_sites(scenario: &Scenario) -> Sites {
    Sites::prepare(office(), scenario).expect("the office has room for the nodes")
}

fn run_on(threads: usize, sites: &Sites) -> RunOutcome {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a small pool");
    pool.install(|| run(sites, &|_| ())).expect("the office can be learned")
}

#[test]
fn one_thread_and_many_and_a_replay_give_the_same_records() {
    let scenario = small_scenario();
    let sites = office_sites(&scenario);
    let alone = run_on(1, &sites).records;
    assert_eq!(alone.len(), 48);
    assert_eq!(alone, run_on(5, &sites).records);
    for record in &alone {
        let setting = sites.settings().iter().find(|setting| setting.row.name == record.row).expect("a row");
        let again = replay(&sites.all()[0], setting, record.trial, None, |_| ()).expect("the map can be learned");
        assert_eq!(again, *record);
    }
}

/// The trials of a part, on three threads.
fn run_some(sites: &Sites, part: &Part<'_>) -> Vec<TimedTrial> {
    let ended = Mutex::new(Vec::new());
    let keep = |trial| ended.lock().expect("no panic").push(trial);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("a small pool");
    pool.install(|| run_part(sites, part, &keep)).expect("the office can be learned");
    ended.into_inner().expect("no panic")
}

#[test]
fn shards_and_a_run_resumed_after_each_interruption_give_the_same_records() {
    let mut scenario = Scenario { trials: 7, ..small_scenario() };
    scenario.rows[1] = Row::new("other nodes", Start::Near, false).with("learning.nodes", 9);
    scenario.rows[2].trials = Some(9);
    let sites = office_sites(&scenario);
    let whole = run_on(2, &sites).records;
    assert_eq!(whole.len(), 30);

    for count in [2, 3, 5] {
        let part = |index| {
            let trials = Shard { index, count }.trials(&scenario).expect("not too many");
            run_some(&sites, &Part { trials, is_done: &|_, _| false, should_stop: &|| false })
        };
        assert_eq!(RunOutcome::of((1..=count).flat_map(part).collect()).records, whole, "{count} shards");
    }

    let mut ended: Vec<TimedTrial> = Vec::new();
    let mut interruptions = 0;
    while ended.len() < whole.len() {
        let asked = AtomicUsize::new(0);
        let is_done = |row, trial| ended.iter().any(|ended| (ended.row, ended.record.trial) == (row, trial));
        // Two maps may be learned and some trials begin before it stops.
        let should_stop = || asked.fetch_add(1, Ordering::Relaxed) > 7;
        let more = run_some(&sites, &Part { trials: 0..9, is_done: &is_done, should_stop: &should_stop });
        interruptions += usize::from(!more.is_empty());
        ended.extend(more);
    }
    assert!(interruptions > 2, "{interruptions}");
    assert_eq!(RunOutcome::of(ended).records, whole);
}

#[test]
fn a_trial_that_breaks_down_is_a_failed_trial_with_its_reason() {
    let scenario = small_scenario();
    let sites = office_sites(&scenario);
    let mut looks = 0;
    let watch = |_: &LookEvent<'_>| {
        looks += 1;
        assert!(looks < 2, "broken at look {looks}");
    };
    let setting = &sites.settings()[2];
    let trial = (0..12).find(|&trial| {
        let whole = replay(&sites.all()[0], setting, trial, None, |_| ()).expect("the map can be learned");
        whole.looks > 1
    });
    let trial = trial.expect("a trial of two looks");
    let record = replay(&sites.all()[0], setting, trial, None, watch).expect("the map can be learned");
    assert_eq!((record.outcome, record.is_success, record.looks), (Outcome::Error, false, 2));
    assert_eq!(record.message.as_deref(), Some("panicked: broken at look 2"));
}

#[test]
fn more_trials_leave_the_first_ones_unchanged() {
    let scenario = small_scenario();
    let few = run_on(2, &office_sites(&Scenario { trials: 5, ..scenario.clone() })).records;
    let many = run_on(2, &office_sites(&scenario)).records;
    assert!(few.iter().all(|record| many.contains(record)));
}

#[test]
fn rows_that_share_their_work_give_what_each_gives_alone() {
    let row = |name: &str| Row::new(name, Start::Near, true);
    let mut scenario = Scenario { trials: 6, trials_per_map: 4, ..small_scenario() };
    scenario.rows = vec![
        row("plain"),
        row("margin").with("localizer.score_margin", 0.02),
        row("turn").with("localizer.turn_deg", 60.0),
        row("bins").with("localizer.pgh.angle_bins", 64),
        row("no gaps").with("uncertainty.edge_detection_loss.enabled", false),
        row("nodes").with("learning.nodes", 9),
        row("wider").with("near_radius_m", 1.0),
        Row { trials: Some(9), ..Row::new("anywhere", Start::Anywhere, false) },
        Row::new("anywhere, nodes", Start::Anywhere, true).with("learning.nodes", 9),
        row("plain again").with("localizer.turn_deg", 30.0),
    ];
    let sites = office_sites(&scenario);
    assert_eq!(sites.all().len(), 2);
    let RunOutcome { records: together, look_times } = run_on(3, &sites);
    // Rows with the same parameters are one run of the localiser, times and all.
    let times = |row: &str| -> Vec<&Vec<Duration>> {
        together.iter().zip(&look_times).filter(|(record, _)| record.row == row).map(|(_, times)| times).collect()
    };
    assert_eq!(times("plain again"), times("plain"));
    assert_ne!(times("margin"), times("plain"));
    for setting in sites.settings() {
        let alone = run_on(1, &office_sites(&setting.scenario)).records;
        let of_row = together.iter().filter(|record| record.row == setting.row.name).cloned().collect::<Vec<_>>();
        assert_eq!(alone.len() as u32, setting.scenario.trials);
        assert_eq!(alone, of_row, "{}", setting.row.name);
    }
    // Common random numbers: the same trial starts at the same pose whatever the row changes.
    let start = |row: &str, trial: u32| {
        let record = together.iter().find(|record| record.row == row && record.trial == trial).expect("a trial");
        [record.true_x_m, record.true_y_m, record.true_heading_deg].map(f32::to_bits)
    };
    for trial in 0..6 {
        assert_eq!(start("plain", trial), start("no gaps", trial));
        assert_eq!(start("plain", trial), start("turn", trial));
        assert_eq!(start("anywhere", trial), start("anywhere, nodes", trial));
        assert_ne!(start("plain", trial), start("wider", trial));
    }
}

#[test]
fn where_nothing_was_learned_only_i_cannot_tell_is_right() {
    let mut scenario = small_scenario();
    scenario.localizer.kind = LocalizerKind::Edgeloc;
    scenario.localizer.max_looks = 1;
    scenario.rows = vec![
        Row::new("unlearned", Start::Unlearned, true).with("learning.withheld", 0.3),
        Row::new("learned", Start::Anywhere, true).with("learning.withheld", 0.3),
        Row::new("all learned", Start::Anywhere, true),
    ];
    let sites = office_sites(&scenario);
    let (part, whole) = (sites.of_row(0), sites.of_row(2));
    assert!(part.nodes.len() < 16 && part.nodes.iter().all(|node| whole.nodes.contains(node)), "{:?}", part.nodes);
    let records = run_on(2, &sites).records;
    let mut outcomes = [0; 2];
    for record in &records {
        let start = Point2::new(record.true_x_m, record.true_y_m);
        match record.row.as_str() {
            "unlearned" => {
                assert!(part.withheld.contains(&part.free_space, start), "{record:?}");
                assert_eq!(record.is_success, record.outcome == Outcome::Unknown);
                assert_eq!(record.is_success, record.answered_node.is_none());
                outcomes[usize::from(record.is_success)] += 1;
            }
            "learned" => {
                assert!(!part.withheld.contains(&part.free_space, start), "{record:?}");
                assert!(!record.is_success || record.answered_node.is_some());
            }
            _ => {}
        }
    }
    assert!(outcomes[1] > 0, "{outcomes:?}");
}

#[test]
fn without_an_answer_the_rivals_are_named_and_the_record_says_whether_the_truth_is_among_them() {
    let mut scenario = small_scenario();
    scenario.localizer.kind = LocalizerKind::Edgeloc;
    scenario.localizer.max_looks = 1;
    // Never sure, so that every scene that shows enough ends with rivals.
    scenario.localizer.verification.confidence = 100.0;
    scenario.rows = vec![Row::new("anywhere", Start::Anywhere, true)];
    let records = run_on(2, &office_sites(&scenario)).records;
    let mut named = [0; 2];
    for record in &records {
        assert_eq!((record.outcome, record.is_success, record.is_near_tie), (Outcome::Unknown, false, false));
        let is_rivalry = record.unknown_kind == Some(UnknownKind::Indistinguishable);
        assert_eq!(record.rivals.is_some(), is_rivalry, "{record:?}");
        let Some(rivals) = &record.rivals else { continue };
        let (mut is_here, mut sum) = (false, 0.0);
        for rival in rivals.split(' ') {
            let (node, rest) = rival.split_once('@').expect("a node at a place");
            let (place, probability) = rest.split_once(':').expect("a place with its probability");
            let (x, y) = place.split_once(',').expect("x and y");
            let number = |text: &str| text.parse::<f32>().expect("a number");
            let distance = Point2::new(number(x), number(y)).distance(Point2::new(record.true_x_m, record.true_y_m));
            is_here |= node == record.nearest_node.to_string() || distance < 1.0;
            sum += number(probability);
        }
        assert_eq!(is_here, record.is_truth_named, "{record:?}");
        assert!(sum <= 1.01, "{rivals}");
        named[usize::from(is_here)] += 1;
    }
    assert!(named[1] > 0, "{named:?}");
}

#[test]
fn a_robot_without_a_compass_tells_its_localiser_no_heading() {
    let mut scenario = small_scenario();
    scenario.uncertainty.compass.available = false;
    let sites = office_sites(&scenario);
    let watch = |look: &LookEvent<'_>| assert_eq!(look.compass, None);
    let record = replay(&sites.all()[0], &sites.settings()[0], 0, None, watch).expect("the map can be learned");
    assert_eq!((record.outcome, record.is_success), (Outcome::Error, false));
    assert!(record.message.is_some_and(|message| message.contains("without a compass")));
}

#[test]
fn unlearned_starts_need_a_part_wide_enough_to_be_far_from_every_node() {
    let mut scenario = small_scenario();
    scenario.rows = vec![Row::new("unlearned", Start::Unlearned, true).with("learning.withheld", 0.001)];
    let error = Sites::prepare(office(), &scenario).expect_err("a part of a few cells").to_string();
    assert!(error.contains("learning.withheld"), "{error}");
}

#[test]
fn a_noise_free_robot_on_a_node_is_right_at_the_first_look_that_shows_five_segments() {
    let mut scenario = small_scenario();
    scenario.uncertainty = Sources::none();
    // Without a margin the first look that shows anything decides.
    scenario.localizer.score_margin = 0.0;
    let site = Site::prepare(office(), &scenario).expect("the office has room for the nodes");
    let mut tried = 0;
    for polarity in [false, true] {
        let row = Row::new("on a node", Start::Near, polarity);
        let scenario = Scenario { rows: vec![row.clone()], ..scenario.clone() };
        let setting = Setting { row, scenario };
        for (node, position) in site.nodes.iter().enumerate() {
            for heading_deg in [0.0_f32, 75.0, 190.0, 300.0] {
                let heading = Heading::new(Angle::from_degrees(heading_deg)).expect("finite");
                let start = Some(TruePose { position: *position, heading });
                let mut shown = Vec::new();
                let watch = |look: &LookEvent<'_>| shown.push(look.localizer.scene_segment_count());
                let record = replay(&site, &setting, 0, start, watch).expect("the map can be learned");
                if shown[0] < 5 {
                    continue; // A bare wall says nothing of the place.
                }
                assert_eq!((record.looks, record.answered_node), (1, Some(node as u32)), "{heading_deg} degrees");
                tried += 1;
            }
        }
    }
    assert!(tried > 100, "only {tried} of 128 looks showed anything");
}

#[test]
fn the_table_of_a_small_sweep_is_the_committed_one() {
    let mut scenario = Scenario { trials: 40, trials_per_map: 20, ..small_scenario() };
    let mut table = String::from("sources  B_th   row                     right  of  looks  segments\n");
    for (sources_name, sources) in [("none", Sources::none()), ("paper", Sources::default())] {
        scenario.uncertainty = sources;
        for score_margin in [0.0, 0.1] {
            scenario.localizer.score_margin = score_margin;
            let records = run_on(2, &office_sites(&scenario)).records;
            for row in &scenario.rows {
                let of_row: Vec<&TrialRecord> = records.iter().filter(|record| record.row == row.name).collect();
                let right = of_row.iter().filter(|record| record.is_success).count();
                let looks: u32 = of_row.iter().map(|record| record.looks).sum();
                let segments: u32 = of_row.iter().map(|record| record.scene_segments).sum();
                writeln!(
                    table,
                    "{sources_name:8} {score_margin:<6} {:23} {right:5} {:3}  {looks:5}  {segments:8}",
                    row.name,
                    of_row.len(),
                )
                .expect("a string takes everything");
            }
        }
    }
    insta::with_settings!({ snapshot_path => "../snapshots", prepend_module_to_snapshot => false }, {
        insta::assert_snapshot!("small_sweep", table);
    });
}

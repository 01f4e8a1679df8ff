//! Real buildings that others modelled, imported whole and pinned: what an importer loses shows here first.
//!
//! The reference figures are those of the data's own README files, from another, first extraction. It rounds vertices
//! to a 1 mm grid, which keeps more of the smallest triangles, and does not join edges that overlap in part.

use edgeloc_sim::world::import::{ImportOptions, ImportReport, import};
use edgeloc_tests::data_folder;
use std::fmt::Write;

fn assert_within(percent: f64, found: usize, expected: usize) {
    let difference = (found as f64 / expected as f64 - 1.0) * 100.0;
    assert!(difference.abs() <= percent, "{found} differs from {expected} by {difference:.1} %");
}

fn assert_size(report: &ImportReport, expected_m: [f32; 3]) {
    let size_m = report.bounding_box().expect("something was read").size_m();
    for (found, expected) in size_m.iter().zip(expected_m) {
        assert!((found - expected).abs() < 0.05, "{size_m:?} is not {expected_m:?}");
    }
}

/// A line per model: triangles, segments of any length, of 5 and of 10 cm, and the box in the world.
fn table(report: &ImportReport) -> String {
    let mut table = format!(
        "{:<24}{:>10}{:>10}{:>7}{:>7}  {:<24}  {}\n",
        "model", "triangles", "segments", ">5cm", ">10cm", "least x y z [m]", "greatest x y z [m]"
    );
    for model in &report.models {
        let point = |point: [f32; 3]| format!("{:8.3}{:8.3}{:8.3}", point[0] + 0.0, point[1] + 0.0, point[2] + 0.0);
        let bounds = model.bounding_box.expect("every model shows something");
        let (least, greatest) = (point(bounds.min_m), point(bounds.max_m));
        writeln!(
            table,
            "{:<24}{:>10}{:>10}{:>7}{:>7}  {least}  {greatest}",
            model.name, model.triangle_count, model.segment_count, model.segments_5cm, model.segments_10cm
        )
        .expect("a string takes all");
    }
    table
}

#[test]
fn the_small_house_is_imported_completely() {
    let Some(folder) = data_folder("aws_small_house") else { return };
    let path = folder.join("worlds/small_house.world");
    let (world, report) = import(&path, &ImportOptions::default()).expect("the house can be imported");

    assert_eq!(report.models.len(), 87);
    assert_within(1.0, report.segments_10cm(), 6_940);
    assert_within(1.0, report.models.iter().map(|model| model.segments_5cm).sum(), 9_441);
    assert_size(&report, [19.0, 11.4, 3.0]);
    assert_eq!(world.edges.len(), report.segments_10cm());
    assert_eq!(world.edges.len() + report.short_segment_count, report.segment_count());

    // A door and a handle come with an animation; nothing else is unread.
    let animated = report.problems.iter().filter(|problem| problem.what.contains("animation")).count();
    assert_eq!((report.problems.len(), animated), (2, 2), "{:#?}", report.problems);

    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../snapshots");
    settings.set_prepend_module_to_snapshot(false);
    settings.bind(|| insta::assert_snapshot!("small_house", table(&report)));
}

#[test]
fn willow_garage_is_imported_completely() {
    let Some(folder) = data_folder("willowgarage") else { return };
    let (world, report) =
        import(&folder.join("model.sdf"), &ImportOptions::default()).expect("the office floor can be imported");
    assert_eq!(world.name, "willowgarage");
    assert!(report.problems.is_empty(), "{:#?}", report.problems);
    // Faces back to back count once among the surfaces.
    assert_within(0.1, world.surfaces.triangles.len(), 6_862);
    // 3 % fewer: where walls meet without sharing vertices, 0.7 km of edges lay doubled.
    assert_within(3.1, report.segments_10cm(), 4_253);
    assert_size(&report, [58.6, 48.6, 2.84]);
    assert_eq!((report.triangle_count(), report.segment_count(), report.segments_10cm()), (13_839, 4_565, 4_125));
}

//! Small hand-written worlds in each format, imported whole: places, units, axes, and what is named as not read.

use edgeloc::geometry::Polarity;
use edgeloc_sim::world::WireframeWorld;
use edgeloc_sim::world::import::{BoundingBox, ImportError, ImportOptions, ImportReport, UpAxis, import};
use std::path::{Path, PathBuf};

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/worlds").join(name)
}

fn imported(name: &str, options: &ImportOptions) -> (WireframeWorld, ImportReport) {
    import(&fixture(name), options).expect("the fixture can be imported")
}

fn assert_box(found: Option<BoundingBox>, min_m: [f32; 3], max_m: [f32; 3]) {
    let found = found.expect("something was read");
    let is_near = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-4);
    assert!(is_near(found.min_m, min_m) && is_near(found.max_m, max_m), "{found:?} is not {min_m:?} to {max_m:?}");
}

#[test]
fn a_gazebo_world_stands_where_its_poses_and_units_put_it() {
    let (world, report) = imported("cabin/worlds/cabin.world", &ImportOptions::default());
    let names: Vec<&str> = report.models.iter().map(|model| model.name.as_str()).collect();
    assert_eq!(names, ["table_1", "table_2", "crate", "floor", "nobody_has_this"]);
    assert_box(report.models[0].bounding_box, [1.7, 0.4, 0.0], [2.3, 1.6, 0.75]);
    assert_box(report.models[1].bounding_box, [-2.6, 0.7, 0.0], [-1.4, 1.3, 0.75]);
    assert_box(report.models[2].bounding_box, [-0.25, -1.25, 0.0], [0.25, -0.75, 1.7]);
    assert_box(report.models[3].bounding_box, [-4.0, -3.0, 0.0], [4.0, 3.0, 0.0]);
    assert_eq!(report.models[0].segment_count, report.models[1].segment_count);
    assert_eq!(report.models[2].segment_count, 12 + 64, "a box, the rims of the post, and no edge of the globe");
    assert_eq!(report.short_segment_count, 64 + 2 * 12, "the rims' pieces of 2 cm, and the boards' edges of 5 cm");
    assert_eq!(world.edges.len(), report.segment_count() - report.short_segment_count);
    assert_eq!(report.models[0].sources, ["table/meshes/table.dae"]);
    assert_eq!(world.name, "cabin");
}

#[test]
fn what_a_gazebo_world_has_beyond_is_named() {
    let (_, report) = imported("cabin/worlds/cabin.world", &ImportOptions::default());
    let problems: Vec<String> = report.problems.iter().map(ToString::to_string).collect();
    for expected in [
        "table/table.sdf:10: Table.DAE is spelt table.dae on disk",
        "cabin.world:14: TABLE is spelt table on disk",
        "cabin.world:36: the shape <capsule> is not read",
        "cabin.world:47: nobody_has_this not found",
        "cabin.world:47: model 'nobody_has_this' shows no surface",
        "cabin.world:48: <actor> is not read",
        "cabin.world:49: <state> is not applied",
    ] {
        assert!(problems.iter().any(|problem| problem.starts_with(expected)), "{expected} is not among {problems:#?}");
    }
    assert_eq!(problems.len(), 7, "{problems:#?}");
}

#[test]
fn a_model_file_and_a_mesh_file_are_worlds_of_one_model() {
    let (model, _) = imported("cabin/models/table/table.sdf", &ImportOptions::default());
    let (mesh, report) = imported("cabin/models/table/meshes/table.dae", &ImportOptions::default());
    assert_eq!(model.edges, mesh.edges);
    assert_eq!(report.models.len(), 1);
    assert_box(report.bounding_box(), [-0.6, -0.3, 0.0], [0.6, 0.3, 0.75]);
}

#[test]
fn an_obj_file_is_read_in_the_unit_and_axes_the_options_state() {
    let options = ImportOptions { obj_unit_m: 0.001, obj_up_axis: UpAxis::Y, ..ImportOptions::default() };
    let (world, report) = imported("step.obj", &options);
    assert!(report.problems.is_empty(), "{:?}", report.problems);
    assert_box(report.bounding_box(), [0.0, 0.0, 0.0], [1.0, 0.6, 1.4]);
    // Two steps of two outlines with five corners and one step's, a bottom that is open, and the handrail.
    assert_eq!(world.edges.len(), 6 + 6 + 6 + 1);
    let handrail = world.edges.iter().filter(|edge| edge.end.z > 1.0 || edge.start.z > 1.0);
    assert_eq!(handrail.count(), 1);
}

#[test]
fn gltf_and_its_binary_form_give_the_same_world() {
    let (text, report) = imported("roof.gltf", &ImportOptions::default());
    assert!(report.problems.is_empty(), "{:?}", report.problems);
    assert_box(report.bounding_box(), [-3.0, -1.0, 2.0], [0.0, 1.0, 3.0]);
    assert_eq!(text.edges.len(), 7, "a ridge, two eaves and four gable edges");

    let (binary, _) = imported("roof.glb", &ImportOptions::default());
    assert_eq!(binary.edges, text.edges);
    assert_eq!(binary.surfaces, text.surfaces);
}

#[test]
fn the_order_of_end_points_carries_no_truth() {
    for name in ["cabin/worlds/cabin.world", "roof.gltf", "step.obj"] {
        let (world, _) = imported(name, &ImportOptions { min_edge_m: 0.0, ..ImportOptions::default() });
        for edge in &world.edges {
            let (start, end) = (edge.start, edge.end);
            assert!((start.x, start.y, start.z) < (end.x, end.y, end.z), "{edge:?} is not in order");
        }
    }
    let (world, _) = imported("cabin/worlds/cabin.world", &ImportOptions::default());
    let left = world.edges.iter().filter(|edge| edge.polarity == Polarity::LeftBrighter).count();
    assert!((world.edges.len() / 4..world.edges.len() * 3 / 4).contains(&left), "{left} of {}", world.edges.len());
}

#[test]
fn shorter_edges_are_left_out_and_counted() {
    let all = ImportOptions { min_edge_m: 0.0, ..ImportOptions::default() };
    let (world, report) = imported("cabin/worlds/cabin.world", &all);
    assert_eq!((world.edges.len(), report.short_segment_count), (report.segment_count(), 0));
    let none = ImportOptions { min_edge_m: 50.0, ..ImportOptions::default() };
    let (world, report) = imported("cabin/worlds/cabin.world", &none);
    assert_eq!((world.edges.len(), report.short_segment_count), (0, report.segment_count()));
}

#[test]
fn unknown_formats_and_options_out_of_range_are_refused() {
    let refusal = |name: &str, options: &ImportOptions| {
        import(&fixture(name), options).expect_err("this can't be imported").to_string()
    };
    let message = refusal("step.mtl", &ImportOptions::default());
    assert!(message.contains(".world .sdf .dae .obj .gltf .glb"), "{message}");
    for options in [
        ImportOptions { min_edge_m: f64::NAN, ..ImportOptions::default() },
        ImportOptions { crease_deg: 0.0, ..ImportOptions::default() },
        ImportOptions { obj_unit_m: 0.0, ..ImportOptions::default() },
    ] {
        assert!(refusal("step.obj", &options).starts_with("import option"));
    }
    assert!(matches!(import(&fixture("gone.dae"), &ImportOptions::default()), Err(ImportError::Unreadable(_))));
}

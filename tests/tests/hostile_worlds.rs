//! Worlds from strangers: damaged, absurd and malicious files give a clear error or a named problem, and nothing
//! panics, hangs or reads where it must not.

use edgeloc_sim::world::WireframeWorld;
use edgeloc_sim::world::import::{ImportError, ImportOptions, ImportReport, import};
use proptest::prelude::*;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A folder laid out like a Gazebo world's, removed at the end.
struct Site {
    folder: tempfile::TempDir,
}

impl Site {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::create_dir_all(folder.path().join("site/worlds")).expect("the folder can be written");
        fs::create_dir_all(folder.path().join("site/models")).expect("the folder can be written");
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("a name below the folder")).expect("the folder can be written");
        fs::write(&path, content).expect("the folder can be written");
        path
    }

    /// Imports a world of the given content.
    fn import_world(&self, content: &str) -> Result<(WireframeWorld, ImportReport), ImportError> {
        let text = format!("<sdf version='1.6'><world name='w'>{content}</world></sdf>");
        import(&self.write("site/worlds/a.world", text), &ImportOptions::default())
    }
}

const BOX: &str =
    "<model name='box'><link><visual><geometry><box><size>1 1 1</size></box></geometry></visual></link></model>";

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/worlds").join(name)
}

fn refusal(path: &Path) -> String {
    import(path, &ImportOptions::default()).expect_err("this file can't be imported").to_string()
}

/// The problems of a world that can be imported all the same, one a line.
fn problems(result: Result<(WireframeWorld, ImportReport), ImportError>) -> String {
    let (_, report) = result.expect("the rest of the world can be imported");
    report.problems.iter().map(|problem| format!("{problem}\n")).collect()
}

/// The fixtures to damage, each with its place in a site.
const FIXTURES: [(&str, &str); 8] = [
    ("cabin/worlds/cabin.world", "site/worlds/cabin.world"),
    ("cabin/models/table/model.config", "site/models/table/model.config"),
    ("cabin/models/table/table.sdf", "site/models/table/table.sdf"),
    ("cabin/models/table/meshes/table.dae", "site/models/table/meshes/table.dae"),
    ("step.obj", "site/worlds/step.obj"),
    ("step.mtl", "site/worlds/step.mtl"),
    ("roof.gltf", "site/worlds/roof.gltf"),
    ("roof.glb", "site/worlds/roof.glb"),
];

/// Imports everything in a site in which the fixture at `index` has become `bytes`.
fn import_damaged(index: usize, bytes: &[u8]) {
    let site = Site::new();
    for (position, (fixture_name, place)) in FIXTURES.into_iter().enumerate() {
        let content = if position == index { bytes.to_vec() } else { read(fixture_name) };
        site.write(place, content);
    }
    let begun = Instant::now();
    let tops = ["site/worlds/cabin.world", "site/models/table/meshes/table.dae", "site/worlds/step.obj"];
    for top in tops.into_iter().chain(["site/worlds/roof.gltf", "site/worlds/roof.glb"]) {
        if let Ok((world, _)) = import(&site.path(top), &ImportOptions { min_edge_m: 0.0, ..ImportOptions::default() })
        {
            let points = world.edges.iter().flat_map(|edge| [edge.start, edge.end]);
            assert!(points.chain(world.surfaces.vertices.iter().copied()).all(|point| point.is_finite()));
            let vertex_count = world.surfaces.vertices.len();
            assert!(world.surfaces.triangles.iter().flatten().all(|&index| (index as usize) < vertex_count));
        }
    }
    assert!(begun.elapsed() < Duration::from_secs(20), "a damaged file of a few kB took {:?}", begun.elapsed());
}

fn read(name: &str) -> Vec<u8> {
    fs::read(fixture(name)).expect("the fixture is there")
}

/// What to put in place of a number.
const ABSURD: [&str; 10] =
    ["NaN", "-inf", "1e309", "-1", "0", "4294967295", "18446744073709551615", "99999999999999999999", "1e30", ""];

/// `text` with its number at `at`, modulo their count, replaced.
fn with_number_replaced(text: &str, at: usize, by: &str) -> String {
    let is_number = |letter: char| letter.is_ascii_digit() || letter == '.';
    let mut starts = Vec::new();
    let mut previous = ' ';
    for (index, letter) in text.char_indices() {
        if is_number(letter) && !is_number(previous) {
            starts.push(index);
        }
        previous = letter;
    }
    let Some(&start) = starts.get(at % starts.len().max(1)) else { return text.to_owned() };
    let length = text[start..].find(|letter| !is_number(letter)).unwrap_or(text.len() - start);
    format!("{}{by}{}", &text[..start], &text[start + length..])
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn flipped_bytes_break_nothing(
        index in 0..FIXTURES.len(),
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let mut bytes = read(FIXTURES[index].0);
        for (at, value) in edits {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        import_damaged(index, &bytes);
    }

    #[test]
    fn truncation_breaks_nothing(index in 0..FIXTURES.len(), at in any::<prop::sample::Index>()) {
        let bytes = read(FIXTURES[index].0);
        import_damaged(index, &bytes[..at.index(bytes.len())]);
    }

    #[test]
    fn absurd_numbers_break_nothing(
        index in 0..FIXTURES.len() - 1,
        edits in prop::collection::vec((any::<usize>(), prop::sample::select(&ABSURD[..])), 1..4),
    ) {
        let mut text = String::from_utf8(read(FIXTURES[index].0)).expect("this fixture is text");
        for (at, by) in edits {
            text = with_number_replaced(&text, at, by);
        }
        import_damaged(index, text.as_bytes());
    }
}

#[test]
fn entity_bombs_are_refused_by_their_document_type() {
    let bomb =
        "<?xml version='1.0'?><!DOCTYPE b [<!ENTITY a 'aaaaaaaaaa'><!ENTITY b '&a;&a;&a;&a;&a;&a;'>]><sdf>&b;</sdf>";
    let site = Site::new();
    for name in ["a.world", "a.dae"] {
        let message = refusal(&site.write(name, bomb));
        assert!(message.contains("DTD") && message.contains("remove the document type"), "{message}");
    }
}

#[test]
fn a_million_nested_elements_do_not_exhaust_the_stack() {
    let site = Site::new();
    let nested = format!("<sdf>{}{}</sdf>", "<model>".repeat(1_000_000), "</model>".repeat(1_000_000));
    let message = refusal(&site.write("a.world", nested));
    assert!(message.contains("models nest deeper than"), "{message}");
    let nested = format!("{{\"asset\":{}", "[".repeat(1_000_000));
    assert!(refusal(&site.write("a.gltf", nested)).contains("is not readable glTF"));
}

#[test]
fn a_model_that_includes_itself_is_named() {
    let site = Site::new();
    site.write(
        "site/models/ring/model.sdf",
        "<sdf><model name='ring'><include><uri>model://ring</uri></include></model></sdf>",
    );
    let message =
        site.import_world("<include><uri>model://ring</uri></include>").expect_err("it never ends").to_string();
    assert!(message.contains("see whether a model includes itself"), "{message}");
}

#[test]
fn models_that_double_at_each_include_are_bounded() {
    let site = Site::new();
    for level in 0..15 {
        let include = format!("<include><uri>model://level{}</uri></include>", level + 1);
        let text = format!("<sdf><model name='m'>{include}{include}{include}</model></sdf>");
        site.write(&format!("site/models/level{level}/model.sdf"), text);
    }
    site.write("site/models/level15/model.sdf", format!("<sdf>{BOX}</sdf>"));
    let message = site.import_world("<include><uri>model://level0</uri></include>").expect_err("14 million boxes");
    assert!(message.to_string().contains("number more than"), "{message}");
}

#[test]
fn collada_nodes_that_instance_themselves_are_refused() {
    let site = Site::new();
    let collada = |nodes: &str| {
        format!(
            "<COLLADA><library_nodes>{nodes}</library_nodes><library_visual_scenes><visual_scene id='s'>\
             <instance_node url='#n0'/></visual_scene></library_visual_scenes>\
             <scene><instance_visual_scene url='#s'/></scene></COLLADA>"
        )
    };
    let cycle = "<node id='n0'><instance_node url='#n0'/></node>";
    assert!(refusal(&site.write("a.dae", collada(cycle))).contains("whether a node instances itself"));
    let doubling: String = (0..40)
        .map(|level| {
            let next = format!("<instance_node url='#n{}'/>", level + 1);
            format!("<node id='n{level}'>{next}{next}</node>")
        })
        .collect();
    assert!(refusal(&site.write("a.dae", collada(&doubling))).contains("whether a node instances itself"));
}

#[test]
fn a_gltf_node_that_holds_itself_is_refused() {
    let site = Site::new();
    let text = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"children":[0,0]}]}"#;
    let message = refusal(&site.write("a.gltf", text));
    assert!(message.contains("nodes nest deeper than"), "{message}");
}

#[test]
fn gltf_buffers_out_of_range_are_named() {
    let text = String::from_utf8(read("roof.gltf")).expect("glTF is text");
    for (from, to, expected) in [
        ("\"byteLength\": 72", "\"byteLength\": 71", "reach beyond"),
        ("\"byteOffset\": 72", "\"byteOffset\": 18446744073709551615", "reach beyond"),
        ("\"count\": 12", "\"count\": 1152921504606846976", "more than"),
        ("\"POSITION\": 0", "\"POSITION\": 2", "an accessor that is not there"),
        ("\"count\": 6", "\"count\": 5", "an index is beyond its 5 vertices"),
        ("\"byteLength\": 96", "\"byteLength\": 97", "it states 97 bytes and has 96"),
        ("base64,", "base64,!", "data URI is not base64"),
        ("data:application/octet-stream;base64,", "data:,", "data URI is not base64"),
        ("data:application/octet-stream;base64,", "../../../../etc/passwd?", "not found"),
    ] {
        assert!(text.contains(from), "the fixture has no {from}");
        let site = Site::new();
        let message = refusal(&site.write("a.gltf", text.replace(from, to)));
        assert!(message.contains(expected), "{to}: {message}");
    }
}

#[test]
fn nothing_outside_the_worlds_folders_is_read() {
    let site = Site::new();
    let secret = site.write("secret/model.sdf", format!("<sdf>{BOX}</sdf>"));
    let beyond = secret.parent().expect("it lies in a folder").display();
    for uri in
        ["model://../../secret".to_owned(), "../../secret".to_owned(), format!("file://{beyond}"), format!("{beyond}")]
    {
        let found = problems(site.import_world(&format!("{BOX}<include><uri>{uri}</uri></include>")));
        assert!(found.contains("outside the world's folders"), "{uri}: {found}");
    }
    let found = problems(site.import_world(&format!("{BOX}<include><uri>http://a.b/c</uri></include>")));
    assert!(found.contains("only model://, file:// and relative paths are read"), "{found}");
}

#[cfg(unix)]
#[test]
fn a_symbolic_link_does_not_lead_outside() {
    let site = Site::new();
    site.write("secret/model.sdf", format!("<sdf>{BOX}</sdf>"));
    std::os::unix::fs::symlink(site.path("secret"), site.path("site/models/link")).expect("links can be made here");
    let world = format!("{BOX}<include><uri>model://link</uri></include>");
    let found = problems(site.import_world(&world));
    assert!(found.contains("outside the world's folders"), "{found}");

    let options = ImportOptions { model_folders: vec![site.path("secret")], ..ImportOptions::default() };
    let (_, report) = import(&site.path("site/worlds/a.world"), &options).expect("the user allowed the folder");
    assert!(report.problems.is_empty(), "{:?}", report.problems);
}

#[test]
fn coordinates_no_world_has_are_left_out_and_named() {
    let site = Site::new();
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
    for bad in ["nan", "inf", "-1e38", "1e400"] {
        let path = site.write("a.obj", format!("{square}v {bad} 0 0\nf 1 2 4\n"));
        let (world, report) = import(&path, &ImportOptions::default()).expect("one triangle is sound");
        assert_eq!(world.surfaces.triangles.len(), 1);
        let named = report.problems.iter().any(|problem| problem.what.starts_with("1 triangles or lines left out"));
        assert!(named, "{bad}: {:?}", report.problems);
    }
}

#[test]
fn files_without_anything_to_see_are_refused() {
    let site = Site::new();
    for (name, content) in [("a.world", "<sdf/>"), ("a.dae", "<COLLADA/>"), ("a.obj", "# nothing\n")] {
        let message = refusal(&site.write(name, content));
        assert!(message.contains("nothing to import"), "{name}: {message}");
    }
    for (name, content) in [("b.world", ""), ("b.dae", "<html></html>"), ("b.glb", "glTF"), ("b.gltf", "{}")] {
        let message = refusal(&site.write(name, content));
        assert!(message.contains(name), "{name}: {message}");
    }
    fs::create_dir(site.path("folder.dae")).expect("the folder can be written");
    assert!(refusal(&site.path("folder.dae")).contains("is not a file"));
}

#[test]
fn a_file_with_a_million_faults_names_a_hundred_and_counts_the_rest() {
    let site = Site::new();
    let faults: String = (0..20_000).map(|index| format!("<wall{index}/>\n")).collect();
    let (_, report) = site.import_world(&format!("{BOX}{faults}")).expect("the box is sound");
    assert_eq!(report.problems.len(), ImportReport::MAX_PROBLEMS);
    assert!(report.unlisted_problem_count > 0);
}

#[test]
fn a_face_of_countless_corners_is_left_out_and_named() {
    let site = Site::new();
    let corners = |zero: &str| format!(" {zero}").repeat(400_000);
    let obj = format!("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nf{}\n", corners("1"));
    let collada = |primitive: &str| {
        format!(
            "<COLLADA><library_geometries><geometry id='g'><mesh><source id='s'>\
             <float_array>0 0 0 1 0 0 1 1 0</float_array>\
             <technique_common><accessor stride='3'/></technique_common></source>\
             <vertices id='v'><input semantic='POSITION' source='#s'/></vertices>\
             <triangles><input semantic='VERTEX' source='#v' offset='0'/><p>0 1 2</p></triangles>{primitive}\
             </mesh></geometry></library_geometries><library_visual_scenes><visual_scene id='e'>\
             <node><instance_geometry url='#g'/></node></visual_scene></library_visual_scenes></COLLADA>"
        )
    };
    let input = "<input semantic='VERTEX' source='#v' offset='0'/>";
    let indices = corners("0");
    let polylist = collada(&format!("<polylist>{input}<vcount>400000</vcount><p>{indices}</p></polylist>"));
    let polygons = collada(&format!("<polygons>{input}<p>{indices}</p></polygons>"));
    for (name, content) in [("a.obj", obj), ("a.dae", polylist), ("b.dae", polygons)] {
        let path = site.write(name, content);
        let begun = Instant::now();
        let (world, report) = import(&path, &ImportOptions::default()).expect("one triangle is sound");
        assert!(begun.elapsed() < Duration::from_secs(2), "{name} took {:?}", begun.elapsed());
        assert_eq!(world.surfaces.triangles.len(), 1, "{name}");
        let [problem] = &report.problems[..] else { panic!("{name}: {:?}", report.problems) };
        let said = problem.to_string();
        let is_named = said.contains("10000") && said.contains(name) && said.contains("split");
        assert!(is_named, "{said}");
    }
}

//! The command line as a user meets it: the binary itself, in a folder of its own.

use std::path::Path;
use std::process::{Command, Output};

/// Small enough for a debug build.
const QUICK: [&str; 5] = ["smoke", "--nodes", "4", "--trials", "3"];

fn edgeloc(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_edgeloc"))
        .current_dir(folder)
        .args(arguments)
        .env("NO_COLOR", "1")
        .env_remove("RUST_LOG")
        .output()
        .expect("the binary starts")
}

/// Standard output of a command that must succeed.
fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = edgeloc(folder, arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?} failed: {stderr}");
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// Standard error of a command that must fail with `code`.
fn failed(folder: &Path, arguments: &[&str], code: i32) -> String {
    let output = edgeloc(folder, arguments);
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {stderr}");
    assert!(output.stdout.is_empty(), "an error is no result: {arguments:?}");
    stderr
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).expect("JSON alone on standard output")
}

#[test]
fn learning_tells_and_draws_where_nodes_cover_a_building_poorly() {
    let folder = folder();
    let learn = ["learn", "smoke", "--nodes", "4", "--set", "learning.placement=coverage", "--plan", "plan.svg"];
    let learned = edgeloc(folder.path(), &learn);
    assert!(learned.status.success(), "{learned:?}");
    let told = String::from_utf8_lossy(&learned.stderr);
    for part in ["4 nodes: ", "of free space has a node in sight within 1 m", "poorly covered: "] {
        assert!(told.contains(part), "{told:?} lacks {part:?}");
    }
    let plan = std::fs::read_to_string(folder.path().join("plan.svg")).expect("a drawing");
    assert!(plan.contains("class=\"poor\"") && plan.matches("class=\"node\"").count() == 4);
    let refusal = failed(folder.path(), &[&learn[..], &["-o", "other.edgemap"]].concat(), 1);
    assert!(refusal.contains("plan.svg exists") && !folder.path().join("other.edgemap").exists(), "{refusal}");
}

#[test]
fn the_help_of_every_verb_has_an_example() {
    let folder = folder();
    for verb in [
        &[][..],
        &["demo"],
        &["world"],
        &["world", "generate"],
        &["world", "import"],
        &["world", "info"],
        &["world", "view"],
        &["world", "visibility"],
        &["world", "edit"],
        &["explore"],
        &["learn"],
        &["calibrate"],
        &["map"],
        &["map", "info"],
        &["map", "index"],
        &["map", "campus"],
        &["scale"],
        &["locate"],
        &["run"],
        &["replay"],
        &["report"],
        &["compare"],
        &["merge"],
        &["power"],
        &["sources"],
        &["figures"],
        &["optimise"],
        &["validate"],
    ] {
        let help = done(folder.path(), &[verb, &["--help"]].concat());
        let example = format!("  edgeloc {}", verb.join(" "));
        assert!(help.contains("Examples:") && help.contains(example.trim_end()), "{verb:?}: {help}");
    }
}

/// Checks that the help of `verb` tells every field of the JSON it printed.
fn assert_documented(folder: &Path, verb: &[&str], printed: &serde_json::Value) {
    let help = done(folder, &[verb, &["--help"]].concat());
    let fields = help.split_once("JSON (--format json): ").expect("a list of fields").1;
    let words = fields.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').collect::<Vec<_>>();
    let mut values = vec![printed];
    while let Some(value) = values.pop() {
        values.extend(value.as_array().into_iter().flatten());
        for (key, inner) in value.as_object().into_iter().flatten() {
            assert!(words.contains(&key.as_str()), "{verb:?} does not tell of {key}: {fields}");
            // Parameters are told of by the scenario.
            if key != "parameters" {
                values.push(inner);
            }
        }
    }
}

#[test]
fn errors_name_the_place_the_reason_and_the_remedy() {
    let folder = folder();
    std::fs::write(folder.path().join("mine.toml"), "trials = 3\n[localizer]\nturn = 60\n").expect("written");
    std::fs::write(folder.path().join("zero.toml"), "trials = 0\n").expect("written");
    std::fs::write(folder.path().join("broken.edgeworld"), "edgewrld but no more").expect("written");
    for (arguments, code, expected) in [
        (&["run", "mine.toml"][..], 1, &["turn", "turn_deg", "mine.toml:3:1"][..]),
        (&["run", "zero.toml"], 1, &["trials = 0", "1 to 1000000", "zero.toml:1:10"]),
        (&["run", "nowhere.toml"], 1, &["nowhere.toml", "paper"]),
        (&["run", "smoke", "--set", "learning.nodse=3"], 1, &["nodse", "nodes"]),
        (&["run", "smoke", "--world", "broken.edgeworld"], 1, &["broken.edgeworld"]),
        (&["run", "smoke", "--world", "house.dae"], 1, &["world import", "house.dae"]),
        (&["world", "info", "absent.edgeworld"], 1, &["absent.edgeworld"]),
        (&["map", "info", "mine.toml"], 1, &["mine.toml", "edgeloc learn"]),
        (&["report", "."], 1, &["manifest.json"]),
        (&["locate", "smoke", "--row", "none"], 1, &["none", "near, polarity"]),
        (&["fly"], 2, &["fly"]),
        (&["run", "smoke", "--trials", "many"], 2, &["many"]),
    ] {
        let stderr = failed(folder.path(), arguments, code);
        for part in expected {
            assert!(stderr.contains(part), "{arguments:?} does not mention {part:?}: {stderr}");
        }
    }
}

#[cfg(unix)]
#[test]
fn a_world_path_that_is_not_text_is_refused_before_anything_runs() {
    use std::os::unix::ffi::OsStrExt;
    let world = std::ffi::OsStr::from_bytes(b"a\xff.edgeworld");
    for last in [&["--print-config"][..], &[]] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_edgeloc"));
        let output = command.args(["run", "smoke", "--world"]).arg(world).args(last).output().expect("it starts");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{stderr}");
        assert!(stderr.contains("world.file") && stderr.contains("UTF-8"), "{stderr}");
    }
}

#[test]
fn a_file_called_like_a_bundled_scenario_is_not_taken_for_it() {
    let folder = folder();
    std::fs::write(folder.path().join("smoke"), b"\x7fELF\xff").expect("written");
    assert!(done(folder.path(), &["run", "smoke", "--print-config"]).contains("name = \"smoke\""));
    assert!(failed(folder.path(), &["run", "./smoke"], 1).contains("UTF-8"));
}

#[test]
fn a_long_world_name_still_gives_a_configuration_that_runs() {
    let folder = folder();
    let world = format!("{}.edgeworld", "w".repeat(99));
    let text = done(folder.path(), &["run", "smoke", "--world", &world, "--print-config"]);
    std::fs::write(folder.path().join("again.toml"), &text).expect("written");
    assert_eq!(done(folder.path(), &["run", "again.toml", "--print-config"]), text);
}

#[test]
fn the_printed_configuration_runs_as_it_is() {
    let folder = folder();
    let text = done(folder.path(), &["run", "smoke", "--set", "localizer.turn_deg=60", "--print-config"]);
    std::fs::write(folder.path().join("again.toml"), &text).expect("written");
    assert!(text.contains("turn_deg = 60.0") && text.contains("[uncertainty.edge_detection_loss]"), "{text}");
    assert_eq!(done(folder.path(), &["run", "again.toml", "--print-config"]), text);
}

#[test]
fn a_world_is_generated_described_drawn_learned_and_localised_in() {
    let folder = folder();
    let path = folder.path();
    let made = json(&done(path, &["world", "generate", "--seed", "3", "--format", "json"]));
    let info = json(&done(path, &["world", "info", "office-3.edgeworld", "--format", "json"]));
    assert_eq!(made, info);
    assert_documented(path, &["world", "generate"], &made);
    assert_documented(path, &["world", "info"], &info);
    assert!(info["edges"].as_u64().is_some_and(|edges| edges > 5000), "{info}");
    assert!(info["free_space"]["area_m2"].as_f64().is_some_and(|area| area > 50.0), "{info}");

    let refusal = failed(path, &["world", "generate", "--seed", "3"], 1);
    assert!(refusal.contains("office-3.edgeworld exists") && refusal.contains("--force"), "{refusal}");

    let world = ["--world", "office-3.edgeworld"];
    let map = json(&done(path, &[&["learn", "smoke", "--nodes", "4", "--format", "json"][..], &world].concat()));
    let again = json(&done(path, &["map", "info", "office-3.edgemap", "--format", "json"]));
    assert_eq!(map, again);
    assert_documented(path, &["learn"], &map);
    assert_documented(path, &["map", "info"], &map);
    assert_eq!(map["nodes"], 4);

    let place = format!("{},{}", map["positions"][2]["x_m"], map["positions"][2]["y_m"]);
    let at = ["--at", &place, "--heading-deg", "30", "--format", "json", "--out", "drawings"];
    let attempt = json(&done(path, &[&["locate", "smoke", "--nodes", "4"][..], &world, &at].concat()));
    assert_eq!(attempt["record"]["nearest_node"], 2);
    assert_documented(path, &["locate"], &attempt);
    assert_documented(path, &["replay"], &attempt);
    assert_eq!(attempt["looks"].as_array().map(Vec::len), attempt["drawings"].as_array().map(Vec::len));
    assert!(path.join("drawings/look-01.svg").is_file());

    let at = ["--at", &place, "--format", "json", "--out", "verified", "--set", "localizer.kind=edgeloc"];
    let verified = json(&done(path, &[&["locate", "smoke", "--nodes", "4"][..], &world, &at].concat()));
    assert_documented(path, &["locate"], &verified);
    let page = std::fs::read_to_string(path.join("verified/trial.html")).expect("a page");
    assert!(page.contains("Places that agree best") && !page.contains("B_th") && !page.contains("fill-opacity=\"-"));

    let at_node = ["--eye", &place, "--heading-deg", "30"];
    done(path, &["world", "view", "office-3.edgeworld", "-o", "plan.svg"]);
    done(path, &[&["world", "view", "office-3.edgeworld", "-o", "eye.svg"][..], &at_node].concat());
    for drawing in ["plan.svg", "eye.svg"] {
        let text = std::fs::read_to_string(path.join(drawing)).expect("a drawing");
        assert!(text.starts_with("<svg") && !text.contains("NaN"), "{drawing}");
    }
}

#[test]
fn every_uncertainty_source_is_listed_as_the_scenario_sets_it() {
    let folder = folder();
    let changed = ["sources", "edgeloc", "--set", "uncertainty.edge_detection_loss.magnitude=0.25"];
    let text = done(folder.path(), &changed);
    let sources = json(&done(folder.path(), &[&changed[..], &["--format", "json"]].concat()));
    assert_documented(folder.path(), &["sources"], &sources);
    for source in sources.as_array().expect("a list") {
        let key = source["key"].as_str().expect("a name");
        // Long words are broken in narrow columns, so look for what they begin with.
        assert!(text.contains(key.split('_').next().expect("a word")), "{key} is not in {text}");
        let set = |name: &str| {
            let mut keys = source["set"].as_array().expect("a list").iter();
            keys.find(|entry| entry["key"] == name).map(|entry| entry["value"].clone())
        };
        let magnitude = if key == "edge_detection_loss" { 0.25.into() } else { source["default"]["magnitude"].clone() };
        assert_eq!(set("magnitude"), Some(magnitude), "{key}");
        assert_eq!(source["acts_in"] == "calibration", key.starts_with("corner_"), "{key}");
        let is_on = ["polarity_flips", "odometry"].contains(&key) || source["default"]["enabled"] == true;
        assert_eq!(set("enabled"), Some(is_on.into()), "{key}");
    }
}

#[test]
fn a_mesh_is_imported_and_every_field_of_the_account_is_told() {
    let folder = folder();
    let tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    std::fs::write(folder.path().join("tent.obj"), tetrahedron).expect("written");
    let imported = json(&done(folder.path(), &["world", "import", "tent.obj", "--format", "json"]));
    assert_eq!(imported["world"]["edges"], 6);
    assert_documented(folder.path(), &["world", "import"], &imported);
}

/// Makes `room.edgeworld`, 4 m x 3 m: a world small enough for a debug build.
fn import_room(path: &Path) {
    let corners: String =
        (0..8).map(|c| format!("v {} {} {}\n", c % 2 * 4, c / 2 % 2 * 3, 2.5 * f64::from(c / 4))).collect();
    let faces = "f 1 2 4 3\nf 5 6 8 7\nf 1 2 6 5\nf 3 4 8 7\nf 1 3 7 5\nf 2 4 8 6\n";
    std::fs::write(path.join("room.obj"), corners + faces).expect("written");
    done(path, &["world", "import", "room.obj"]);
}

#[test]
fn a_room_is_explored_from_where_the_robot_is_put_down() {
    let folder = folder();
    let path = folder.path();
    import_room(path);
    let ask = ["explore", "smoke", "--world", "room.edgeworld", "--nodes", "3", "--start", "1.1,0.9"];
    let explored = json(&done(path, &[&ask[..], &["--format", "json"]].concat()));
    assert_documented(path, &["explore"], &explored);
    assert_eq!((&explored["ending"], &explored["collisions"]), (&"closed_room".into(), &0.into()), "{explored}");
    let start = [("x_m", 1.1), ("y_m", 0.9)].map(|(axis, asked)| explored["start"][axis].as_f64().map(|m| m - asked));
    assert!(start.iter().all(|off_m| off_m.is_some_and(|off_m| off_m.abs() < 0.1)), "{explored}");
    assert_eq!(explored["nodes"].as_array().map(Vec::len), Some(3));
    let drawing = std::fs::read_to_string(path.join(explored["drawing"].as_str().expect("a path"))).expect("a drawing");
    assert!(drawing.starts_with("<svg") && !drawing.contains("NaN"));
    assert!(done(path, &[&ask[..], &["--force"]].concat()).contains("a closed room"));
    let in_the_wall = ["explore", "smoke", "--world", "room.edgeworld", "--start", "-9,0", "--out", "other.svg"];
    failed(path, &in_the_wall, 1);
}

#[test]
fn what_is_visible_is_told_and_serves_an_eye_of_its_own_height_alone() {
    let folder = folder();
    let path = folder.path();
    import_room(path);
    let ask = ["world", "visibility", "room.edgeworld", "--viewpoints", "3", "--camera-height-m", "1.25"];
    let told = json(&done(path, &[&ask[..], &["--format", "json"]].concat()));
    assert_documented(path, &["world", "visibility"], &told);
    assert_eq!((&told["viewpoints"], &told["edges"]), (&3.into(), &12.into()));
    let run = [&["run"][..], &QUICK, &["--world", "room.edgeworld", "--set", "world.visibility=room.views"]].concat();
    let refusal = failed(path, &run, 1);
    for part in ["room.views", "taken 1.25 m", "stands 1 m", "--camera-height-m 1"] {
        assert!(refusal.contains(part), "{part:?} is not in {refusal}");
    }
    done(path, &[&run[..], &["--set", "rig.camera_height_m=1.25"]].concat());
}

#[test]
fn a_run_repeats_byte_for_byte_and_each_trial_replays() {
    let folder = folder();
    let path = folder.path();
    let run = |how: &[&str]| json(&done(path, &[&["run", "--format", "json"][..], &QUICK, how].concat()));
    let narrow: &[&str] = if cfg!(target_arch = "x86_64") { &["--vectors", "sse2"] } else { &[] };
    let (first, second) = (run(&["--threads", "1"]), run(&[&["--threads", "2"], narrow].concat()));
    assert_ne!(first["folder"], second["folder"]);
    for verb in ["demo", "run", "report"] {
        assert_documented(path, &[verb], &first);
    }
    assert_eq!(first["summary"], second["summary"]);
    let trials = |run: &serde_json::Value| {
        let folder = path.join(run["folder"].as_str().expect("a path"));
        std::fs::read(folder.join("trials.csv")).expect("trials")
    };
    assert_eq!(trials(&first), trials(&second));
    if !narrow.is_empty() {
        let folder = path.join(second["folder"].as_str().expect("a path"));
        let manifest = json(&std::fs::read_to_string(folder.join("manifest.json")).expect("a manifest"));
        assert_eq!(manifest["host"]["instructions"], "SSE2");
    }
    assert_eq!(trials(&first).iter().filter(|&&byte| byte == b'\n').count(), 1 + 2 * 3);

    let replay = ["replay", "runs/latest", "--row", "anywhere, no polarity", "--trial", "2", "--out", "drawings"];
    let words = done(path, &replay);
    assert!(words.contains("look  1") && words.contains("answer after"), "{words}");
    assert!(failed(path, &["replay", "runs/latest", "--trial", "3"], 1).contains("from 0 to 2"));
    let page = || std::fs::read_to_string(path.join("drawings/trial.html")).expect("a page");
    let first_page = page();
    for part in [
        "Parameters as they were applied",
        "localizer.score_margin",
        "What the sources drew",
        "edge_detection_loss",
        "Both images",
        "class=\"clean\"",
        "class=\"predicted\"",
        "coefficient 0.",
        "Accumulated score of each node",
        "Look 1: ",
    ] {
        assert!(first_page.contains(part), "the page of a trial lacks {part}");
    }
    let addresses = first_page.matches("http").count();
    assert_eq!(addresses, first_page.matches("http://www.w3.org/2000/svg").count(), "a page refers to nothing outside");
    done(path, &replay);
    assert_eq!(page(), first_page);

    let report = done(path, &["report", "runs/latest"]);
    assert!(report.contains("near, polarity") && report.contains("report written"), "{report}");
    let page = std::fs::read_to_string(path.join("runs/latest/report.html")).expect("a page");
    assert!(page.contains("edgeloc replay runs/20") || page.contains("every trial succeeded"));
}

#[test]
fn a_rig_is_calibrated_from_its_own_corners_and_from_a_file_of_corners() {
    let folder = folder();
    let path = folder.path();
    let simulated = json(&done(path, &["calibrate", "smoke", "--format", "json"]));
    assert_documented(path, &["calibrate"], &simulated);
    for parameter in simulated["parameters"].as_array().expect("a list") {
        let field = |name: &str| parameter[name].as_f64().expect("a number");
        let errors = (field("estimate") - field("truth")).abs() / field("standard_error");
        assert!(errors < 5.0, "{parameter}");
    }

    let header = "left_x_px,left_y_px,right_x_px,right_y_px\n";
    std::fs::write(path.join("pairs.csv"), format!("{header}100,100,80,100\n300,200,290,200.1\n")).expect("a file");
    let output = edgeloc(path, &["calibrate", "smoke", "--corners", "pairs.csv"]);
    let (words, remarks) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(remarks.contains("2 corner pairs can't tell") && remarks.contains("the prior"), "{remarks}");
    assert!(words.contains("2 corner pairs used") && words.contains("translation along x"), "{words}");
    std::fs::write(path.join("other.csv"), "a,b\n1,2\n").expect("a file");
    let error = failed(path, &["calibrate", "smoke", "--corners", "other.csv"], 1);
    assert!(error.contains("other.csv") && error.contains("left_x_px"), "{error}");
}

#[test]
fn the_power_of_a_comparison_is_told_before_a_run() {
    let folder = folder();
    let path = folder.path();
    let ask = ["power", "0.93", "0.90", "--discordance", "0.08", "--trials", "900", "--format", "json"];
    let told = json(&done(path, &ask));
    assert_documented(path, &["power"], &told);
    let trials = |key: &str| told[key].as_u64().expect("a number of trials");
    assert!(trials("trials_paired_at_best") < trials("trials_paired"), "{told}");
    assert!(trials("trials_paired") < trials("trials_unpaired"), "{told}");
    assert!(done(path, &["power", "0.93", "0.90", "--trials", "900"]).contains("900 trials of each setting detect"));
    assert!(
        done(path, &["power", "0.93", "0.90", "--trials", "2"]).contains("can't detect even a fall from 93.0 % to 0")
    );
    for (arguments, expected) in [
        (&["power", "0.9", "0.9"][..], "equal rates"),
        (&["power", "93", "90"], "0.93"),
        (&["power", "0.93", "0.90", "--discordance", "0.01"], "can't be"),
    ] {
        let stderr = failed(path, arguments, 1);
        assert!(stderr.contains(expected), "{arguments:?}: {stderr}");
    }
}

/// A study of four settings, small enough for a debug build.
const STUDY: &str = r#"
trials = 4
learning = { nodes = 4, views = 12 }
rows = [
    { name = "4(a): B_th 0", start = "near", polarity = true, set = { "localizer.score_margin" = 0.0 } },
    { name = "4(a): B_th 0.1", start = "near", polarity = true },
    { name = "4(b): none", start = "near", polarity = true, set = { "uncertainty.edge_detection_loss.enabled" = false } },
    { name = "nodes: 3", start = "near", polarity = true, set = { "learning.nodes" = 3 } },
]
"#;

#[test]
fn a_study_gives_its_figures_and_gives_them_again() {
    let folder = folder();
    let path = folder.path();
    std::fs::write(path.join("study.toml"), STUDY).expect("written");
    let study = json(&done(path, &["figures", "study.toml", "--anywhere", "--format", "json"]));
    assert_documented(path, &["figures"], &study);
    let lines = study["lines"].as_array().expect("lines");
    let tests = lines.iter().map(|line| line["test"].as_str().expect("a word")).collect::<Vec<_>>();
    assert_eq!(tests[..4], ["mcnemar", "default", "mcnemar", "two_rates"]);
    assert_eq!(tests[4..], ["mcnemar", "default", "mcnemar", "mcnemar"], "anywhere the poses do not depend on nodes");
    assert_eq!(lines[1]["paper_success_rate"], 0.9557);

    let run = path.join(study["folder"].as_str().expect("a path"));
    for drawing in ["figure-4a.svg", "figure-4b.svg", "figure-nodes.svg"] {
        let text = std::fs::read_to_string(run.join(drawing)).expect("a drawing");
        assert!(text.starts_with("<svg") && !text.contains("NaN"), "{drawing}");
    }
    let csv = std::fs::read_to_string(run.join("figures.csv")).expect("a table");
    std::fs::remove_file(run.join("figures.html")).expect("a page");
    let again = done(path, &["figures", "--from", "runs/latest"]);
    assert!(again.contains("4(b): none, anywhere") && again.contains("95.57 %"), "{again}");
    assert_eq!(std::fs::read_to_string(run.join("figures.csv")).expect("a table"), csv);
    let page = std::fs::read_to_string(run.join("figures.html")).expect("a page");
    assert!(!page.contains("<script") && !page.contains("src="));
    for ignored in [["--trials", "9"], ["--set", "seed=2"], ["--threads", "1"]] {
        failed(path, &[&["figures", "--from", "runs/latest"][..], &ignored].concat(), 2);
    }
}

#[test]
fn a_search_repeats_resumes_and_gives_a_preset_that_runs() {
    let folder = folder();
    let path = folder.path();
    let ask = ["optimise", "--trials-total", "60", "--settings", "4", "--finalists", "2", "--set", "learning.nodes=4"];
    let axes = ["--axis", "localizer.score_margin=0.0,0.1", "--axis", "learning.nodes=3,4", "--format", "json"];
    let search = |more: &[&str]| json(&done(path, &[&ask[..], &axes, more].concat()));
    let (first, second) = (search(&["--threads", "1"]), search(&["--threads", "2"]));
    let mut told = first.clone();
    // The keys of the axes are the user's own.
    told["settings"].as_array_mut().expect("settings").iter_mut().for_each(|line| line["values"] = 0.into());
    assert_documented(path, &["optimise"], &told);
    let decided = |search: &serde_json::Value| {
        let mut lines = search["settings"].clone();
        let lines_of = lines.as_array_mut().expect("settings");
        lines_of.iter_mut().for_each(|line| line["mean_localizer_s"] = 0.into());
        lines
    };
    assert_eq!(decided(&first), decided(&second));
    let chosen = decided(&first);
    let chosen = chosen.as_array().expect("settings").iter().filter(|line| line["is_chosen"] == true).count();
    assert_eq!(chosen, 1);

    let interrupted = first["folder"].as_str().expect("a path");
    std::fs::remove_file(path.join(interrupted).join("confirmation.json")).expect("a stage");
    assert_eq!(decided(&search(&["--resume", interrupted])), decided(&first));
    let other = failed(path, &[&ask[..], &axes, &["--seed", "5", "--resume", interrupted]].concat(), 1);
    assert!(other.contains("another search"), "{other}");
    let rung = path.join(interrupted).join("rung-1.json");
    let kept = std::fs::read_to_string(&rung).expect("a stage");
    for (fact, refusal) in
        [("program_version", "was begun by edgeloc 0"), ("world/checksum", "has changed since the run")]
    {
        let mut changed = json(&kept);
        *changed.pointer_mut(&format!("/manifest/{fact}")).expect("a fact") = "0".into();
        std::fs::write(&rung, changed.to_string()).expect("written");
        let told = failed(path, &[&ask[..], &axes, &["--resume", interrupted]].concat(), 1);
        // The place where a long line breaks is the terminal's.
        let words = told.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
        assert!(words.contains(refusal), "{told}");
    }

    let preset = first["preset"].as_str().expect("a path");
    let whole = done(path, &["run", preset, "--print-config"]);
    assert!(whole.contains("name = \"optimised\"") && whole.contains("distance_bins"), "{whole}");
    assert_eq!(whole.matches("[[rows]]").count(), 1, "the row that was searched: {whole}");
    for file in ["settings.csv", "front-time.svg", "front-map.svg", "optimise.html"] {
        assert!(path.join(interrupted).join(file).is_file(), "{file}");
    }
}

#[test]
fn a_search_that_is_refused_leaves_nothing_and_one_that_runs_is_the_latest() {
    let folder = folder();
    let path = folder.path();
    let few = failed(path, &["optimise", "--trials-total", "5"], 1);
    assert!(few.contains("too small for 31 settings") && few.contains("at least 517"), "{few}");
    let nodes = ["optimise", "smoke", "--trials-total", "60", "--settings", "2", "--axis", "learning.nodes=5000,6000"];
    let crowded = failed(path, &nodes, 1);
    assert!(crowded.contains("5000") || crowded.contains("6000"), "{crowded}");
    let folders = |path: &Path| std::fs::read_dir(path).map_or(0, Iterator::count);
    assert_eq!(folders(&path.join("runs")), 0, "{crowded}");

    let axis = ["--axis", "localizer.score_margin=0.0,0.1", "--set", "learning.nodes=4", "--format", "json"];
    let ask = ["optimise", "smoke", "--trials-total", "30", "--settings", "2", "--finalists", "1"];
    let search = json(&done(path, &[&ask[..], &axis].concat()));
    let latest = path.join("runs/latest").canonicalize().expect("a link");
    assert_eq!(latest, path.join(search["folder"].as_str().expect("a path")).canonicalize().expect("a folder"));
}

#[test]
fn chance_is_named_where_no_answer_can_be_wrong() {
    let folder = folder();
    let words = |nodes| done(folder.path(), &["run", "smoke", "--nodes", nodes, "--trials", "1", "--threads", "1"]);
    for (nodes, chance, map) in
        [("1", "chance, the only node", "map: 1 node, "), ("2", "chance, both nodes", "map: 2 nodes, ")]
    {
        let words = words(nodes);
        for part in [chance, map, "100.0 %", "chance is 100 %", "(1 thread)"] {
            assert!(words.contains(part), "{part}: {words}");
        }
    }
    assert!(!words("4").contains("chance is 100 %"));
}

/// What of a run's folder does not depend on wall times, machine or command.
const REPEATABLE: [&str; 4] = ["trials.csv", "nodes.csv", "summary.json", "scenario.toml"];

fn assert_same_results(path: &Path, one: &serde_json::Value, other: &serde_json::Value) {
    let read = |run: &serde_json::Value, file: &str| {
        std::fs::read(path.join(run["folder"].as_str().expect("a path")).join(file)).expect("a file of the run")
    };
    for file in REPEATABLE {
        assert!(read(one, file) == read(other, file), "{file} differs between {one} and {other}");
    }
}

#[test]
fn shards_merge_into_the_whole_run_and_wrong_folders_are_named() {
    let folder = folder();
    let path = folder.path();
    let run = |more: &[&str]| json(&done(path, &[&["run"][..], &QUICK, &["--format", "json"], more].concat()));
    let whole = run(&[]);
    for shard in ["1/3", "2/3", "3/3"] {
        run(&["--shard", shard, "--out", "parts"]);
    }
    let parts: Vec<String> = std::fs::read_dir(path.join("parts"))
        .expect("a folder")
        .map(|entry| format!("parts/{}", entry.expect("an entry").file_name().to_string_lossy()))
        .filter(|name| name.contains("-shard-"))
        .collect();
    let mut parts: Vec<&str> = parts.iter().map(String::as_str).collect();
    parts.sort_unstable();
    assert_eq!(parts.len(), 3);
    let merged = json(&done(path, &[&["merge", "--format", "json"], &parts[..]].concat()));
    assert_same_results(path, &whole, &merged);
    assert_documented(path, &["merge"], &merged);
    done(path, &["replay", "runs/latest", "--trial", "2"]);

    let missing = failed(path, &["merge", parts[0], parts[2]], 1);
    assert!(missing.contains("missing: 2/3"), "{missing}");
    let doubled = failed(path, &[&["merge", parts[0]], &parts[..]].concat(), 1);
    assert!(doubled.contains("1/3 is there twice"), "{doubled}");
    let foreign = failed(path, &["merge", parts[0], whole["folder"].as_str().expect("a path")], 1);
    assert!(foreign.contains("a whole run, not a shard"), "{foreign}");
    let part = failed(path, &["figures", "--from", parts[0]], 1);
    assert!(part.contains("holds shard 1/3 of a study") && part.contains("edgeloc merge"), "{part}");
    let too_many = failed(path, &[&["run"][..], &QUICK, &["--shard", "1/9"]].concat(), 1);
    assert!(too_many.contains("too few for 9 shards"), "{too_many}");
}

#[test]
fn shards_made_in_different_folders_merge() {
    let folder = folder();
    let path = folder.path();
    import_room(path);
    for (machine, shard) in [("one", "1/2"), ("two", "2/2")] {
        let here = path.join(machine);
        std::fs::create_dir(&here).expect("a folder");
        std::fs::copy(path.join("room.edgeworld"), here.join("room.edgeworld")).expect("a copy");
        done(&here, &[&["run"][..], &QUICK, &["--world", "room.edgeworld", "--shard", shard]].concat());
    }
    let merged = json(&done(path, &["merge", "one/runs/latest", "two/runs/latest", "--format", "json"]));
    assert_eq!(merged["summary"]["rows"][0]["trials"], 3);
}

/// Interrupts a run that writes to `runs` once some of its trials ended; what it says then.
#[cfg(unix)]
fn interrupted(path: &Path, arguments: &[&str]) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_edgeloc"));
    command.current_dir(path).args(arguments).stdout(std::process::Stdio::null()).stderr(std::process::Stdio::piped());
    let child = command.spawn().expect("the binary starts");
    let journal = path.join("runs/latest/journal.ndjson");
    let lines = || std::fs::read(&journal).map_or(0, |bytes| bytes.iter().filter(|&&byte| byte == b'\n').count());
    let patience = std::time::Instant::now();
    while lines() < 3 && patience.elapsed().as_secs() < 120 {
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    let id = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &id]).status().is_ok_and(|status| status.success()));
    let output = child.wait_with_output().expect("it ends");
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{words}");
    words
}

#[cfg(unix)]
#[test]
fn an_interrupted_study_goes_on_as_a_study() {
    let folder = folder();
    let path = folder.path();
    std::fs::write(path.join("study.toml"), STUDY).expect("written");
    let words = interrupted(path, &["figures", "study.toml", "--trials", "80"]);
    assert!(words.contains("edgeloc figures --resume runs/20"), "{words}");
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_says_how_to_go_on_and_ends_with_the_same_bytes() {
    let folder = folder();
    let path = folder.path();
    let arguments = ["run", "smoke", "--nodes", "4", "--trials", "80", "--format", "json"];
    let whole = json(&done(path, &[&arguments[..], &["--out", "whole"]].concat()));

    let words = interrupted(path, &arguments);
    let journal = path.join("runs/latest/journal.ndjson");
    assert!(words.contains("edgeloc run --resume runs/20") && words.contains("of 160 trials are kept"), "{words}");

    for verb in [&["report", "runs/latest"][..], &["replay", "runs/latest", "--trial", "0"], &["merge", "runs/latest"]]
    {
        let refusal = failed(path, verb, 1);
        assert!(refusal.contains("not finished") && refusal.contains("edgeloc run --resume runs/20"), "{refusal}");
    }
    // A power cut may leave half a line.
    let mut torn = std::fs::OpenOptions::new().append(true).open(&journal).expect("a journal");
    std::io::Write::write_all(&mut torn, b"{\"row\":0,\"rec").expect("written");

    let resumed = json(&done(path, &["run", "--resume", "runs/latest", "--format", "json"]));
    assert_same_results(path, &whole, &resumed);
    assert!(!journal.exists());
    assert!(failed(path, &["run", "--resume", "runs/latest"], 1).contains("is finished"));
    failed(path, &["run", "smoke", "--resume", "runs/latest"], 2);
}

#[test]
fn a_validation_tells_of_each_world_and_of_all_and_goes_on_where_it_was_interrupted() {
    let folder = folder();
    let path = folder.path();
    done(path, &["world", "generate", "--seed", "3"]);
    let few = ["--offices", "2", "--trials", "3", "--nodes", "6", "--set", "localizer.max_looks=1"];
    let arguments = [&["validate", "office-3.edgeworld", "--strata", "anywhere,near"][..], &few].concat();
    let printed = json(&done(path, &[&arguments[..], &["--format", "json"]].concat()));
    assert_documented(path, &["validate"], &printed);
    let rows = printed["rows"].as_array().expect("rows");
    assert_eq!(rows.iter().map(|row| row["row"].as_str()).collect::<Vec<_>>(), [Some("anywhere"), Some("near")]);
    for row in rows {
        let worlds: Vec<_> = row["worlds"].as_array().expect("worlds").iter().map(|world| &world["world"]).collect();
        assert_eq!(worlds, ["office-2", "office-3"]);
        assert_eq!(row["total"]["success"]["of"], 6);
    }
    let at = |file: &str| path.join("runs/latest").join(file);
    let table = std::fs::read_to_string(at("validation.csv")).expect("a table");
    assert_eq!(table.lines().count(), 1 + 2 * 3);
    assert!(std::fs::read_to_string(at("validation.html")).is_ok_and(|page| page.contains("All worlds together")));
    done(path, &["replay", "runs/latest/office-3", "--trial", "1"]);

    // One world had not ended and nothing of all of them was written.
    std::fs::remove_dir_all(at("office-3")).expect("a folder");
    std::fs::remove_file(at("validation.csv")).expect("a file");
    let words = done(path, &["validate", "--resume", "runs/latest"]);
    assert!(words.contains("office-2, near: ") && words.contains("mean success"), "{words}");
    assert_eq!(std::fs::read_to_string(at("validation.csv")).expect("a table"), table);

    let twice = failed(path, &["validate", "office-3.edgeworld", "./office-3.edgeworld"], 1);
    assert!(twice.contains("office-3") && twice.contains("once"), "{twice}");
    assert!(failed(path, &["validate", "--resume", "."], 1).contains("holds no validation"));
}

#[test]
fn runs_are_compared_in_pairs_and_refused_when_they_are_not() {
    let folder = folder();
    let path = folder.path();
    for more in [&[][..], &["--set", "localizer.score_margin=0"], &["--seed", "5"]] {
        done(path, &[&["run"][..], &QUICK, more].concat());
    }
    let mut runs: Vec<String> = std::fs::read_dir(path.join("runs"))
        .expect("a folder")
        .map(|entry| format!("runs/{}", entry.expect("an entry").file_name().to_string_lossy()))
        .filter(|name| !name.ends_with("latest"))
        .collect();
    runs.sort_unstable();
    let compared = json(&done(path, &["compare", &runs[0], &runs[1], "--format", "json"]));
    assert_eq!((compared.as_array().map(Vec::len), &compared[0]["a"]["trials"]), (Some(2), &serde_json::json!(3)));
    assert_documented(path, &["compare"], &compared);
    let table = done(path, &["compare", &runs[0], &runs[1], "--row", "near, polarity"]);
    assert!(table.contains("McNemar") && table.contains("points"), "{table}");

    let refusal = failed(path, &["compare", &runs[0], &runs[2]], 1);
    assert!(refusal.contains("different seeds, 1 and 5") && refusal.contains("--unpaired"), "{refusal}");
    assert!(done(path, &["compare", &runs[0], &runs[2], "--unpaired"]).contains("unpaired"));
    let other_start = ["compare", &runs[0], &runs[0], "--row", "near, polarity", "--row-b", "anywhere, no polarity"];
    assert!(failed(path, &other_start, 1).contains("different poses"));
}

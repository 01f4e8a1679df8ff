//! Arrows between the modules of a crate.

use crate::rust_files_below;
use crate::source::root_references;

/// A module at the root of a crate and the modules there that it may know besides itself.
type Arrow = (&'static str, &'static [&'static str]);

/// `math < geometry < pgh < matching < gist`, `geometry < stereo`, `geometry < explore`, `geometry < database`; `localize` alone knows database and matching both.
const CORE: &[Arrow] = &[
    ("math", &[]),
    ("geometry", &["math"]),
    ("stereo", &["math", "geometry"]),
    ("pgh", &["math", "geometry"]),
    ("matching", &["math", "geometry", "pgh"]),
    ("gist", &["math", "geometry", "matching"]),
    ("database", &["math", "geometry"]),
    ("explore", &["math", "geometry"]),
    ("localize", &["math", "geometry", "pgh", "matching", "gist", "database"]),
];

/// `random, whole_file, map_file < world < camera < uncertainty < learning < scenario < monte_carlo < sweep < report < cli`; an uncertainty
/// source never sees the world.
const HOST_SIM: &[Arrow] = &[
    ("random", &[]),
    ("whole_file", &[]),
    ("map_file", &[]),
    ("world", &["random", "whole_file"]),
    ("camera", &["random", "world"]),
    ("uncertainty", &["random", "camera"]),
    ("learning", &["random", "map_file", "world", "camera", "uncertainty"]),
    ("scenario", &["random", "world", "camera", "uncertainty", "learning"]),
    ("monte_carlo", &["random", "whole_file", "map_file", "world", "camera", "uncertainty", "learning", "scenario"]),
    ("sweep", &["random", "scenario", "monte_carlo"]),
    (
        "report",
        &["random", "whole_file", "world", "camera", "uncertainty", "learning", "scenario", "monte_carlo", "sweep"],
    ),
    (
        "cli",
        &[
            "random",
            "whole_file",
            "map_file",
            "world",
            "camera",
            "uncertainty",
            "learning",
            "scenario",
            "monte_carlo",
            "sweep",
            "report",
        ],
    ),
];

/// The modules that the file at `path`, relative to its crate's `src`, stands for: `a/b.rs` and `a/b/mod.rs` are
/// both `[a, b]`, the crate's root is empty.
fn module_path(path: &str) -> Vec<&str> {
    let stem = path.strip_suffix(".rs").unwrap_or(path);
    let mut names: Vec<&str> = stem.split('/').collect();
    if matches!(names.last(), Some(&"mod")) || matches!(names[..], ["lib" | "main"]) {
        names.pop();
    }
    names
}

/// What the arrows forbid in one source; the crate's root may know every module.
fn violations(arrows: &[Arrow], path: &str, source: &str) -> Vec<String> {
    let module = module_path(path);
    let Some(&name) = module.first() else { return Vec::new() };
    let Some((_, may_know)) = arrows.iter().find(|(from, _)| *from == name) else {
        return vec![format!("{path}: the table of arrows has no module `{name}`")];
    };
    root_references(source, &module)
        .into_iter()
        .filter(|reference| reference.target != name && !may_know.contains(&reference.target.as_str()))
        .map(|reference| format!("{path}:{}: `{name}` may not know `{}`", reference.line, reference.target))
        .collect()
}

fn assert_arrows(folder: &str, arrows: &[Arrow]) {
    let mut found = Vec::new();
    for (path, source) in rust_files_below(folder) {
        let inside = path.strip_prefix(folder).map_or(path.as_str(), |rest| rest.trim_start_matches('/'));
        found.extend(violations(arrows, inside, &source));
    }
    assert!(found.is_empty(), "{folder} points where no arrow does:\n{}", found.join("\n"));
}

#[test]
fn modules_of_the_library_know_only_what_lies_below_them() {
    assert_arrows("core/src", CORE);
}

#[test]
fn modules_of_the_simulator_know_only_what_lies_below_them() {
    assert_arrows("host-sim/src", HOST_SIM);
}

#[test]
fn the_tables_point_one_way() {
    for arrows in [CORE, HOST_SIM] {
        for (index, (module, may_know)) in arrows.iter().enumerate() {
            let is_below = |name: &str| arrows[..index].iter().any(|(below, _)| *below == name);
            assert!(may_know.iter().all(|name| is_below(name)), "`{module}` points upwards");
        }
    }
}

#[test]
fn an_arrow_upwards_is_found() {
    let upwards = "use crate::geometry::Point2;\nfn f() { crate::matching::score(); }";
    assert_eq!(
        violations(CORE, "database/reader.rs", upwards),
        ["database/reader.rs:2: `database` may not know `matching`"]
    );
    assert_eq!(violations(HOST_SIM, "uncertainty/mod.rs", "use super::world::WireframeWorld;").len(), 1);
    assert!(violations(CORE, "localize/localizer.rs", upwards).is_empty());
    assert!(violations(CORE, "lib.rs", upwards).is_empty());
}

#[test]
fn a_detour_by_the_root_or_an_unlisted_module_is_found() {
    assert_eq!(violations(CORE, "math.rs", "use crate::*;").len(), 1);
    assert_eq!(violations(CORE, "math.rs", "use crate::Localizer;").len(), 1);
    assert_eq!(violations(CORE, "helpers.rs", "").len(), 1);
}

#[test]
fn files_stand_for_modules() {
    assert_eq!(module_path("a/b.rs"), ["a", "b"]);
    assert_eq!(module_path("a/b/mod.rs"), ["a", "b"]);
    assert!(module_path("lib.rs").is_empty());
}

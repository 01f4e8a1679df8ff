//! Arrows between packages, and the few third-party crates the on-robot library may use.

use std::path::Path;

use toml::{Table, Value};

use crate::files_below;

/// All that the on-robot library may depend on.
const CORE_MAY_USE: &[&str] = &["libm", "micromath", "nalgebra", "heapless", "rand_core", "zerocopy", "crc", "defmt"];

/// One dependency of a package.
#[derive(Debug)]
struct Dependency {
    name: String,
    /// Only its tests need it.
    is_for_tests: bool,
    features: Vec<String>,
}

impl Dependency {
    fn is_ours(&self) -> bool {
        self.name == "edgeloc" || self.name.starts_with("edgeloc-")
    }
}

/// What is wrong with the manifest of the package in `folder`, a path from the repository's root.
fn violations(folder: &str, manifest: &str) -> Vec<String> {
    let table: Table = manifest.parse().unwrap_or_else(|error| panic!("{folder}/Cargo.toml: {error}"));
    let complain = |dependency: &Dependency| {
        let name = dependency.name.as_str();
        let ours = |allowed: &[&str]| (dependency.is_ours() && !allowed.contains(&name)).then_some("an upward arrow");
        match folder {
            "core" if dependency.is_for_tests => ours(&[]),
            "core" if !CORE_MAY_USE.contains(&name) => Some("not among the library's few crates"),
            "core" if name == "nalgebra" && !dependency.features.contains(&"libm-force".to_owned()) => {
                Some("without `libm-force` its float functions differ between machines")
            }
            "core" => None,
            "host-sim" => ours(&["edgeloc", "edgeloc-protocol"]),
            "tests/gate" => Some("the gate must report even when nothing else builds"),
            "tests" | "benches" | "benches/peers" => None,
            "boards/firmware" | "boards/protocol" => ours(&["edgeloc", "edgeloc-protocol"]),
            _ if folder.starts_with("boards/qemu-") => ours(&["edgeloc-firmware", "edgeloc-protocol", "edgeloc-qemu"])
                .map(|_| "a board holds pins and memory: it goes through the firmware"),
            _ if folder.starts_with("boards/") => ours(&["edgeloc-firmware", "edgeloc-protocol"])
                .map(|_| "a board holds pins and memory: it goes through the firmware"),
            _ => Some("its folder is not in the table of packages"),
        }
    };
    let describe = |dependency: Dependency| {
        complain(&dependency).map(|reason| format!("{folder} uses {}: {reason}", dependency.name))
    };
    dependencies(&table).into_iter().filter_map(describe).collect()
}

/// Every dependency of a manifest: of the code, of its tests, of its build script, for any target.
fn dependencies(table: &Table) -> Vec<Dependency> {
    let targets = table.get("target").and_then(Value::as_table).into_iter().flat_map(Table::values);
    let tables = std::iter::once(table).chain(targets.filter_map(Value::as_table));
    let mut found = Vec::new();
    for table in tables {
        for (kind, is_for_tests) in [("dependencies", false), ("dev-dependencies", true), ("build-dependencies", false)]
        {
            for (key, value) in table.get(kind).and_then(Value::as_table).into_iter().flatten() {
                let renamed = value.get("package").and_then(Value::as_str);
                let features = value.get("features").and_then(Value::as_array).into_iter().flatten();
                found.push(Dependency {
                    name: renamed.unwrap_or(key).to_owned(),
                    is_for_tests,
                    features: features.filter_map(|feature| feature.as_str().map(str::to_owned)).collect(),
                });
            }
        }
    }
    found
}

#[test]
fn packages_depend_only_downwards() {
    let mut found = Vec::new();
    for folder in ["core", "host-sim", "tests", "benches", "boards"] {
        for (path, manifest) in files_below(folder, |path| path.ends_with("Cargo.toml")) {
            let package = Path::new(&path).parent().and_then(Path::to_str).expect("a manifest lies in a folder");
            found.extend(violations(package, &manifest));
        }
    }
    assert!(found.is_empty(), "packages point where no arrow does:\n{}", found.join("\n"));
}

#[test]
fn a_dependency_upwards_is_found() {
    for (folder, manifest) in [
        ("core", "[dependencies]\nserde = \"1\""),
        ("core", "[dependencies]\nnalgebra = { version = \"0.35\", features = [\"libm\"] }"),
        ("core", "[dev-dependencies]\nedgeloc-sim = { path = \"../host-sim\" }"),
        ("host-sim", "[dependencies]\nedgeloc-tests.workspace = true"),
        ("host-sim", "[target.'cfg(unix)'.dependencies]\nboard = { package = \"edgeloc-firmware\", version = \"1\" }"),
        ("tests/gate", "[build-dependencies]\ncc = \"1\""),
        ("boards/firmware", "[dependencies]\nedgeloc-sim = { path = \"../../host-sim\" }"),
        ("boards/qemu-mps2-an500", "[dependencies]\nedgeloc = { path = \"../../core\" }"),
        ("boards/stm32h743", "[dependencies]\nedgeloc-qemu = { path = \"../qemu\" }"),
        ("attic", "[dependencies]\nlibm = \"1\""),
    ] {
        assert_eq!(violations(folder, manifest).len(), 1, "{folder}: {manifest}");
    }
}

#[test]
fn a_dependency_downwards_is_left_alone() {
    for (folder, manifest) in [
        ("core", "[dependencies]\nnalgebra = { version = \"0.35\", features = [\"libm-force\"] }"),
        ("core", "[dev-dependencies]\nproptest = \"1\""),
        ("host-sim", "[dependencies]\nedgeloc.workspace = true\nclap = \"4\""),
        ("boards/firmware", "[dependencies]\nedgeloc = { path = \"../../core\" }"),
        ("boards/qemu-mps2-an500", "[dependencies]\nedgeloc-firmware = { path = \"../firmware\" }"),
        ("boards/qemu-mps2-an500", "[dependencies]\nedgeloc-qemu = { path = \"../qemu\" }"),
    ] {
        assert!(violations(folder, manifest).is_empty(), "{folder}: {manifest}");
    }
}

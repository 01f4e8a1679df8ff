//! `unsafe` has addresses, and says at each why it is sound.

use crate::rust_files_below;
use crate::source::tokens;

/// Where `unsafe` may stand, as beginnings of paths: the matching kernels, the square root, what a board must do with its
/// registers and link sections, the C interface through which other languages measure us, and mapped map files.
const ADDRESSES: &[&str] =
    &["core/src/matching/kernels/", "core/src/math.rs", "boards/", "benches/peers/src/", "host-sim/src/map_file.rs"];

/// Below [`ADDRESSES`], but shared by boards, so it holds no registers.
const EXCEPTIONS: &[&str] = &["boards/firmware/", "boards/protocol/"];

/// What is wrong with the `unsafe` of one source.
fn violations(path: &str, source: &str) -> Vec<String> {
    let begins = |beginnings: &[&str]| beginnings.iter().any(|beginning| path.starts_with(beginning));
    let is_allowed = begins(ADDRESSES) && !begins(EXCEPTIONS);
    let lines: Vec<&str> = source.lines().collect();
    let mut found = Vec::new();
    for token in tokens(source).into_iter().filter(|token| token.text == "unsafe") {
        let line = token.line;
        if !is_allowed {
            found.push(format!("{path}:{line}: `unsafe` has no address here"));
        } else if !is_explained(&lines[..line - 1]) {
            found.push(format!("{path}:{line}: no `SAFETY:` comment above says why it is sound"));
        }
    }
    found
}

/// Whether the comment that ends `lines_above`, attributes skipped, says why.
fn is_explained(lines_above: &[&str]) -> bool {
    let above = lines_above.iter().rev().map(|line| line.trim_start());
    above.take_while(|line| line.starts_with("//") || line.starts_with("#[")).any(|line| line.contains("SAFETY:"))
}

#[test]
fn unsafe_stands_only_at_its_addresses() {
    let folders = ["core", "host-sim", "tests", "benches", "boards"];
    let found: Vec<String> =
        folders.into_iter().flat_map(rust_files_below).flat_map(|(path, source)| violations(&path, &source)).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn unsafe_elsewhere_or_unexplained_is_found() {
    let explained = "// SAFETY: the length was checked.\n#[inline]\nunsafe fn f() {}";
    assert!(violations("core/src/matching/kernels/simd.rs", explained).is_empty());
    assert_eq!(violations("core/src/matching/mod.rs", explained).len(), 1);
    assert_eq!(violations("boards/firmware/src/lib.rs", explained).len(), 1);
    assert_eq!(violations("boards/qemu/src/main.rs", "fn f() { unsafe { g() } }").len(), 1);
    assert!(violations("host-sim/src/lib.rs", "// unsafe\nconst S: &str = \"unsafe\";").is_empty());
}

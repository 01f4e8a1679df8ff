//! Float functions come from one backend, so that every machine gets the same bits: `libm`, in the library through its
//! `math` module. The standard library's go to the platform's own, whose last bits differ.

use crate::rust_files_below;
use crate::source::tokens;

/// Functions of the standard floats that are not exactly rounded everywhere.
const NOT_PORTABLE: &[&str] = &[
    "sin", "cos", "tan", "sin_cos", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp", "exp2", "exp_m1",
    "ln", "ln_1p", "log", "log2", "log10", "powf", "cbrt", "hypot", "mul_add",
];

/// Where results end on paper and reach no map, scene or decision.
const EXCEPTIONS: &[&str] = &["host-sim/src/report/", "host-sim/src/cli/"];

/// The calls in one source that go past the backend.
fn violations(path: &str, source: &str) -> Vec<String> {
    if EXCEPTIONS.iter().any(|beginning| path.starts_with(beginning)) {
        return Vec::new();
    }
    let tokens = tokens(source);
    let mut found = Vec::new();
    for window in tokens.windows(4) {
        let [owner, mark, function, open] = [window[0].text, window[1].text, window[2].text, window[3].text];
        let is_float_path = mark == "::" && matches!(owner, "f32" | "f64");
        if (mark == "." || is_float_path) && open == "(" && NOT_PORTABLE.contains(&function) {
            found.push(format!("{path}:{}: `{function}` of the standard library", window[2].line));
        }
    }
    found
}

#[test]
fn library_and_simulator_use_the_one_backend() {
    let files = ["core/src", "host-sim/src"].into_iter().flat_map(rust_files_below);
    let found: Vec<String> = files.flat_map(|(path, source)| violations(&path, &source)).collect();
    assert!(found.is_empty(), "use `libm` or `edgeloc::math`:\n{}", found.join("\n"));
}

#[test]
fn a_call_past_the_backend_is_found() {
    let path = "host-sim/src/world/office/room.rs";
    assert_eq!(violations(path, "let y = x.sin();").len(), 1);
    assert_eq!(violations(path, "xs.iter().map(|x| f64::hypot(*x, 1.0))").len(), 1);
    assert!(violations(path, "let y = libm::sin(x) + math::atan2(y, x) + x.sqrt(); // x.sin()").is_empty());
    assert!(violations("host-sim/src/report/plan.rs", "let y = x.sin();").is_empty());
}

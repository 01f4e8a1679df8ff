//! Chooses the body of the matching kernels where it is known before the program runs, as `cfg(edgeloc_body)`.
//!
//! Mostly that is a question of target features. Those of Cortex-M, however, compilers of the stable channel keep to
//! themselves.

use std::env;

const BODIES: [&str; 5] = ["x86_64", "neon", "simd128", "smlad", "portable"];

/// Processors of the Armv8-M Mainline that have the DSP extension where nothing else is said.
const ARMV8M_WITH_DSP: [&str; 5] = ["cortex-m33", "cortex-m35p", "cortex-m55", "cortex-m85", "star-mc1"];

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rustc-check-cfg=cfg(edgeloc_body, values(\"{}\"))", BODIES.join("\", \""));
    let variable = |name: &str| env::var(name).unwrap_or_default();
    let features = variable("CARGO_CFG_TARGET_FEATURE");
    let has = |feature| features.split(',').any(|found| found == feature);
    let body = match variable("CARGO_CFG_TARGET_ARCH").as_str() {
        "x86_64" => "x86_64",
        "aarch64" if has("neon") && variable("CARGO_CFG_TARGET_ENDIAN") == "little" => "neon",
        "wasm32" if has("simd128") => "simd128",
        "arm" if has_dsp(&variable("TARGET"), &variable("CARGO_ENCODED_RUSTFLAGS")) => "smlad",
        _ => "portable",
    };
    println!("cargo:rustc-cfg=edgeloc_body=\"{body}\"");
}

/// Every Armv7E-M has it; an Armv8-M Mainline if its processor or a feature says so. A feature has the last word.
fn has_dsp(target: &str, rustflags: &str) -> bool {
    let flags = || rustflags.split('\x1f').map(|flag| flag.trim_start_matches("-C").trim_start());
    let cpu = flags().filter_map(|flag| flag.strip_prefix("target-cpu=")).next_back();
    let by_processor = target.starts_with("thumbv7em")
        || (target.starts_with("thumbv8m.main") && cpu.is_some_and(|cpu| ARMV8M_WITH_DSP.contains(&cpu)));
    let features = flags().filter_map(|flag| flag.strip_prefix("target-feature=")).flat_map(|list| list.split(','));
    features.fold(by_processor, |has, feature| match feature {
        "+dsp" => true,
        "-dsp" => false,
        _ => has,
    })
}

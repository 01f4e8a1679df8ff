//! Tells the matching kernels whether the processor multiplies pairs of halfwords: compilers of the stable channel keep
//! the DSP extension of Cortex-M to themselves.

use std::env;

/// Processors of the Armv8-M Mainline that have the DSP extension where nothing else is said.
const ARMV8M_WITH_DSP: [&str; 5] = ["cortex-m33", "cortex-m35p", "cortex-m55", "cortex-m85", "star-mc1"];

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rustc-check-cfg=cfg(edgeloc_dsp)");
    let variable = |name: &str| env::var(name).unwrap_or_default();
    if has_dsp(&variable("TARGET"), &variable("CARGO_ENCODED_RUSTFLAGS")) {
        println!("cargo:rustc-cfg=edgeloc_dsp");
    }
}

/// Every Armv7E-M has it; an Armv8-M Mainline if its processor or a feature says so. A feature has the last word.
fn has_dsp(target: &str, rustflags: &str) -> bool {
    let options =
        |name| rustflags.split('\x1f').filter_map(move |flag| flag.trim_start_matches("-C").trim().strip_prefix(name));
    let by_processor = target.starts_with("thumbv7em")
        || (target.starts_with("thumbv8m.main")
            && options("target-cpu=").next_back().is_some_and(|cpu| ARMV8M_WITH_DSP.contains(&cpu)));
    let features = options("target-feature=").flat_map(|list| list.split(','));
    features.fold(by_processor, |has, feature| match feature {
        "+dsp" => target.starts_with("thumb"),
        "-dsp" => false,
        _ => has,
    })
}

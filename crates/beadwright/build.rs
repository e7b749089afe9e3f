//! Lets tests know whether the shared models and cases lie where they look for them: without them those tests are ignored, but not
//! under `CI=true`, where they fail.

use std::env;
use std::path::Path;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=CI");
    for (variable, folder, missing) in
        [("BEADWRIGHT_MODELS", "models", "no_models"), ("BEADWRIGHT_CASES", "cases", "no_cases")]
    {
        println!("cargo::rustc-check-cfg=cfg({missing})");
        println!("cargo::rerun-if-env-changed={variable}");
        let folder = env::var(variable).unwrap_or_else(|_| format!("../../../shared/{folder}"));
        if !Path::new(&folder).is_dir() && env::var("CI").as_deref() != Ok("true") {
            println!("cargo::rustc-cfg={missing}");
        }
    }
}

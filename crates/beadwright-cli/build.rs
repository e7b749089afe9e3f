//! Lets tests know whether the shared models lie where they look for them: without them those tests are ignored, but not under
//! `CI=true`, where they fail.

use std::env;
use std::path::Path;

fn main() {
    println!("cargo::rustc-check-cfg=cfg(no_models)");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=BEADWRIGHT_MODELS");
    println!("cargo::rerun-if-env-changed=CI");
    let folder = env::var("BEADWRIGHT_MODELS").unwrap_or_else(|_| "../../../shared/models".to_owned());
    if !Path::new(&folder).is_dir() && env::var("CI").as_deref() != Ok("true") {
        println!("cargo::rustc-cfg=no_models");
    }
}

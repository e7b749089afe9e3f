//! The way up that is found for a preform beside the best of many directions, all scored by their steps: what
//! docs/book/preform.md says of it.
//!
//! `cargo bench --bench preform [-- --directions 10000] [--parts propeller,vase]`; models are read from `BEADWRIGHT_MODELS`
//! (default ../shared/models), and left out with a word where there are none.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

use beadwright::example;
use beadwright::model::{self, Mesh};
use beadwright::preform::orient::{self, Oriented};
use beadwright::profile::Profile;
use beadwright::task::Task;
use glam::{DQuat, DVec3};
use rayon::prelude::*;
use std::f64::consts::PI;
use std::path::Path;
use std::time::Instant;

/// Parts, and how they lie: about x, then y, degrees.
const PARTS: [(&str, [f64; 2]); 10] = [
    ("propeller", [0.0, 0.0]),
    ("plate", [30.0, 20.0]),
    ("gourd", [90.0, 0.0]),
    ("gear", [0.0, 70.0]),
    ("tian", [45.0, 45.0]),
    ("openthruster_prop_cw.stl", [0.0, 0.0]),
    ("supportless_sample.stl", [0.0, 0.0]),
    ("branches16.stl", [0.0, 0.0]),
    ("pulley_t30.stl", [20.0, 0.0]),
    ("rear_case.stl", [0.0, 0.0]),
];

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let given = |name: &str| words.iter().position(|word| word == name).and_then(|at| words.get(at + 1)).cloned();
    let many: usize = given("--directions").map_or(10_000, |number| number.parse().unwrap());
    let chosen = given("--parts");
    let profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    let (settings, rates, task) = (profile.preform_settings(), profile.preform_rates(), Task::new());
    println!("part: score found, best of {many}, ratio; seconds for each, ratio");
    let is_chosen = |name: &str| chosen.as_ref().is_none_or(|list| list.split(',').any(|one| one == name));
    for (name, [x, y]) in PARTS.into_iter().filter(|part| is_chosen(part.0)) {
        let Some(mut mesh) = mesh(name) else { continue };
        mesh.place(1.0, DVec3::new(x, y, 0.0));
        let start = Instant::now();
        let found = orient::best(&mesh, &settings, &rates, &task).unwrap()[0].figures.score();
        let quick = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let score = |k| Oriented::of(&mesh, direction(k, many), &settings, &rates, &task).unwrap().figures.score();
        let best = (0..many).into_par_iter().map(score).reduce(|| f64::INFINITY, f64::min);
        let slow = start.elapsed().as_secs_f64();
        println!("{name}: {found:.4}, {best:.4}, {:.4}; {quick:.1}, {slow:.1}, {:.3}", found / best, quick / slow);
    }
}

/// Directions spread evenly over the sphere, by the golden angle from another pole than the search has.
fn direction(k: usize, of: usize) -> DVec3 {
    let z = 1.0 - (2.0 * k as f64 + 1.0) / of as f64;
    let (sin, cos) = (PI * (3.0 - 5_f64.sqrt()) * k as f64).sin_cos();
    let radius = (1.0 - z * z).sqrt();
    DQuat::from_rotation_x(1.0) * DVec3::new(radius * cos, radius * sin, z)
}

fn mesh(name: &str) -> Option<Mesh> {
    if let Some(example) = example::find(name) {
        return Some(example.mesh());
    }
    let default = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models");
    let folder = std::env::var_os("BEADWRIGHT_MODELS").map_or_else(default, Into::into);
    let Ok(bytes) = std::fs::read(folder.join(name)) else {
        println!("{name}: no such file in {}", folder.display());
        return None;
    };
    Some(model::import(&bytes, &Task::new()).unwrap().mesh)
}

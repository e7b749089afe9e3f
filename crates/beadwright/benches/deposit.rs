//! `cargo bench --bench deposit [-- NAME…]`: big plans judged as they always are, and by the reference, every point in
//! double precision. One line a plan: CPU seconds of both, points × strokes a CPU second, and how far void, overfill and
//! outside lie from each other, in points. Linux only; models from `BEADWRIGHT_MODELS` (default `../shared/models`).
#![allow(clippy::unwrap_used)]

use beadwright::deposit::{Figures, Judge};
use beadwright::layer::Layer;
use beadwright::model;
use beadwright::plan;
use beadwright::planar::Bounds;
use beadwright::profile::Profile;
use beadwright::task::Task;
use glam::DVec3;
use std::path::PathBuf;

/// A printer's bead and a welding one.
const FINE: &str = include_str!("fdm-0.45x0.2.toml");
const WELD: &str = "cmt-al2319-kuka";

/// Model, scale, profile, strategy, turn in degrees.
const PLANS: [(&str, f64, &str, &str, f64); 20] = [
    ("plate_holes", 1.0, FINE, "compound", 0.0),
    ("plate_holes", 1.0, FINE, "raster", 20.0),
    ("plate_holes", 1.0, WELD, "zigzag", 0.0),
    ("openthruster_prop_cw", 1.0, FINE, "compound", 0.0),
    ("openthruster_prop_cw", 1.0, FINE, "contour", 37.0),
    ("openthruster_prop_cw", 3.66, WELD, "compound", 0.0),
    ("rear_case", 1.0, FINE, "compound", 0.0),
    ("rear_case", 1.0, FINE, "zigzag", 11.0),
    ("bunny_closed", 1.0, FINE, "compound", 0.0),
    ("bunny_closed", 0.5, FINE, "zigzag", 37.0),
    ("bunny_closed", 0.5, FINE, "contour", 0.0),
    ("bunny_closed", 1.0, WELD, "compound", 0.0),
    ("bunny_closed", 1.0, WELD, "hybrid", 37.0),
    ("bladex_propeller_zup", 1.0, WELD, "compound", 0.0),
    ("bladex_propeller_zup", 1.0, WELD, "contour", 20.0),
    ("body_structure_top", 1.0, FINE, "compound", 0.0),
    ("body_structure_top", 1.0, WELD, "zigzag", 45.0),
    ("branches16", 1.0, FINE, "zigzag", 0.0),
    ("body_structure_top", 1.0, WELD, "contour", 0.0),
    ("pulley_t30", 1.0, FINE, "compound", 0.0),
];
/// That many layers of each plan, spread over its height.
const LAYERS: usize = 12;

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    println!("{:<44}{:>10}{:>11}{:>13}{:>26}", "plan", "quick s", "every s", "p × s / s", "void, over, outside");
    let mut worst = 0.0_f64;
    for (name, scale, profile, strategy, turn) in PLANS {
        if wanted.is_empty() || wanted.iter().any(|word| name.contains(word.as_str())) {
            match compare(name, scale, profile, strategy, turn) {
                Some(apart) => worst = worst.max(apart),
                None => println!("{name} ×{scale} {strategy}: no model or no plan"),
            }
        }
    }
    println!("farthest apart: {worst:.4} points");
    assert!(worst <= 0.02, "the promise is 0.02 points");
}

/// How far the figures lie apart; `None` without the model or a plan of it.
fn compare(name: &str, scale: f64, profile: &str, strategy: &str, turn: f64) -> Option<f64> {
    let mut profile = Profile::built_in(profile).unwrap_or_else(|_| Profile::parse(profile).unwrap());
    profile.fill.strategy = strategy.parse().unwrap();
    let folder = std::env::var("BEADWRIGHT_MODELS")
        .unwrap_or_else(|_| concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/models").to_owned());
    let bytes = std::fs::read(PathBuf::from(folder).join(format!("{name}.stl"))).ok()?;
    let mut mesh = model::import(&bytes, &Task::new()).ok()?.mesh;
    mesh.place(scale, DVec3::new(0.0, 0.0, turn));
    let (low, high) = mesh.bounds();
    let bounds = Bounds { min: low.truncate(), max: high.truncate() };
    // Layers far thicker than the bead are cut, so that planning a thousand of them does not take the time.
    let count = (mesh.size().z / profile.layers.height) as usize;
    let settings = plan::deposit_settings(&profile).fitted_to(&bounds, count);
    profile.layers.height = profile.layers.height.max(mesh.size().z / LAYERS as f64 * 0.999);
    let layers = plan::plan(name, &mesh, &profile, &Task::new()).ok()?.layers;
    let (quick, work, quick_s) = judged(Judge::new(settings).with_pictures(320), &layers);
    let (every, all, every_s) = judged(Judge::new(settings).with_pictures(320).with_every_point(), &layers);
    let get = [Figures::void_percent, Figures::overfill_percent, Figures::outside_percent];
    let apart = get.map(|get: fn(&Figures) -> f64| (get(&quick) - get(&every)).abs());
    println!(
        "{:<44}{quick_s:>10.2}{every_s:>11.2}{:>13.2e}{:>10.4}{:>8.4}{:>8.4}   {:.0} % computed, void {:.2} % overfill {:.2} % outside {:.2} %",
        format!("{name} ×{scale} {} {strategy} {turn}°", profile.name),
        all as f64 / quick_s,
        apart[0],
        apart[1],
        apart[2],
        100.0 * work as f64 / all as f64,
        every.void_percent(),
        every.overfill_percent(),
        every.outside_percent(),
    );
    Some(apart.into_iter().fold(0.0, f64::max))
}

fn judged(mut judge: Judge, layers: &[Layer]) -> (Figures, usize, f64) {
    let begun = cpu_seconds();
    let work = layers.iter().map(|layer| judge.layer(layer).work).sum();
    (*judge.total(), work, cpu_seconds() - begun)
}

/// User and system time of all threads so far, s: fields 14 and 15 of /proc/self/stat, in hundredths.
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap();
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap().split_whitespace().collect();
    (fields[11].parse::<f64>().unwrap() + fields[12].parse::<f64>().unwrap()) / 100.0
}

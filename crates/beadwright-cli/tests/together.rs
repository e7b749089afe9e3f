//! Several parts in one build.
#![allow(clippy::unwrap_used, clippy::indexing_slicing)]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

const PARTS: [&str; 4] = ["cross", "gear", "star", "vase"];

fn beadwright(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_beadwright")).current_dir(folder).args(arguments).output().unwrap()
}

fn json(path: &Path) -> serde_json::Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// Areas of the islands of a layer.
fn areas(layer: &serde_json::Value) -> Vec<f64> {
    let ring = |points: &serde_json::Value| {
        let p: Vec<[f64; 2]> = serde_json::from_value(points.clone()).unwrap();
        let twice: f64 =
            (0..p.len()).map(|i| (p[i], p[(i + 1) % p.len()])).map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum();
        (twice / 2.0).abs()
    };
    let island = |island: &serde_json::Value| {
        let holes: f64 = island["holes"].as_array().unwrap().iter().map(ring).sum();
        ring(&island["outline"]) - holes
    };
    layer["islands"].as_array().unwrap().iter().map(island).collect()
}

#[test]
fn four_parts_grow_together() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for name in PARTS {
        assert!(beadwright(at, &["example", name, "-o", &format!("{name}.stl")]).status.success());
        let plan = ["plan", &format!("{name}.stl"), "--no-deposit", "-o", name, "-s", "contour"];
        assert!(beadwright(at, &plan).status.success());
    }
    let with: Vec<String> = PARTS[1..].iter().map(|name| format!("--with={name}.stl")).collect();
    let mut plan = vec!["plan", "cross.stl", "--no-deposit", "-s", "contour", "-o", "all", "--gap", "25"];
    plan.extend(with.iter().map(String::as_str));
    let said = beadwright(at, &plan);
    let text = String::from_utf8_lossy(&said.stdout).into_owned();
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    assert!(PARTS.iter().all(|name| text.contains(&format!("  {name} "))), "{text}");
    // Each layer has the islands that the parts have alone.
    let all = json(&at.join("all/plan.json"));
    let alone = PARTS.map(|name| json(&at.join(name).join("plan.json")));
    for (index, layer) in all["layers"].as_array().unwrap().iter().enumerate() {
        let mut own = areas(layer);
        let mut parts: Vec<f64> = alone.iter().filter_map(|plan| plan["layers"].get(index)).flat_map(areas).collect();
        own.sort_by(f64::total_cmp);
        parts.sort_by(f64::total_cmp);
        assert_eq!(own.len(), parts.len(), "layer {}", index + 1);
        assert!(own.iter().zip(&parts).all(|(a, b)| (a - b).abs() < 0.01), "layer {}: {own:?} {parts:?}", index + 1);
        // Travels run above everything that stands, since no pass lies higher than the present layer.
        let top = layer["z"].as_f64().unwrap();
        let points = layer["passes"].as_array().unwrap().iter().flat_map(|pass| pass["points"].as_array().unwrap());
        assert!(points.into_iter().all(|p| p[2].as_f64().unwrap() == top));
    }
    // The program says the same, read back.
    let programs = fs::read_dir(at.join("all")).unwrap().map(|entry| entry.unwrap().path());
    let main = programs.into_iter().find(|path| path.extension().is_some_and(|e| e == "src")).unwrap();
    let read = beadwright(at, &["inspect", main.to_str().unwrap()]);
    assert!(read.status.success(), "{}", String::from_utf8_lossy(&read.stderr));
    assert!(beadwright(at, &["check", "all/plan.json"]).status.code().is_some());
}

#[test]
fn parts_in_each_others_way_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for name in ["cross", "gear"] {
        assert!(beadwright(at, &["example", name, "-o", &format!("{name}.stl")]).status.success());
    }
    let said = beadwright(at, &["plan", "cross.stl", "--with", "gear.stl", "--as-placed", "-o", "all"]);
    let text = String::from_utf8_lossy(&said.stderr).into_owned();
    assert!(said.status.code() == Some(1) && text.contains("overlap") && !at.join("all").exists(), "{text}");
}

//! Several parts in one build.

use crate::common::beadwright;
use std::fs;
use std::path::Path;

const PARTS: [&str; 4] = ["cross", "gear", "star", "vase"];

fn json(path: &Path) -> serde_json::Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// The program that calls the others: that with the shortest name.
fn main_program(folder: &Path) -> String {
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let programs = files.filter(|path| path.extension().is_some_and(|end| end == "src"));
    programs.map(|path| path.display().to_string()).min_by_key(String::len).unwrap()
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
        // Level layers lie as high as the metal of all parts makes them.
        let (file, flat) = (format!("{name}.stl"), "layers.level=false");
        let plan = ["plan", &file, "--no-deposit", "-o", name, "-s", "contour", "--set", flat];
        assert!(beadwright(at, &plan).status.success());
    }
    let with: Vec<String> = PARTS[1..].iter().map(|name| format!("--with={name}.stl")).collect();
    let mut plan = vec![
        "plan",
        "cross.stl",
        "--no-deposit",
        "-s",
        "contour",
        "-o",
        "all",
        "--gap",
        "25",
        "--set",
        "layers.level=false",
    ];
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
        // Travels run above everything built so far, since no pass lies higher than the present layer.
        let top = layer["z"].as_f64().unwrap();
        let points = layer["passes"].as_array().unwrap().iter().flat_map(|pass| pass["points"].as_array().unwrap());
        assert!(points.into_iter().all(|p| p[2].as_f64().unwrap() == top));
    }
    // The program says the same, read back.
    let read = beadwright(at, &["inspect", &main_program(&at.join("all"))]);
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

/// The four parts in a folder.
fn parts(at: &Path) {
    for name in PARTS {
        assert!(beadwright(at, &["example", name, "-o", &format!("{name}.stl")]).status.success());
    }
}

const PLAN: [&str; 8] =
    ["plan", "cross.stl", "--with=gear.stl", "--with=star.stl", "--with=vase.stl", "--no-deposit", "-s", "contour"];

/// Each of them from its first layer to its last.
#[test]
fn four_parts_are_welded_one_after_another() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    parts(at);
    let apart = ["--order", "parts", "--gap", "120"];
    let said = beadwright(at, &[&PLAN[..], &apart, &["-o", "all"]].concat());
    let text = String::from_utf8_lossy(&said.stdout).into_owned();
    assert!(said.status.success(), "{text}{}", String::from_utf8_lossy(&said.stderr));
    let report = fs::read_to_string(at.join("all/report.html")).unwrap();
    assert!(PARTS.iter().all(|name| text.contains(&format!("{name} (layers ")) && report.contains(name)), "{text}");
    let all = json(&at.join("all/plan.json"));
    let z: Vec<f64> = all["layers"].as_array().unwrap().iter().map(|layer| layer["z"].as_f64().unwrap()).collect();
    assert_eq!(z.windows(2).filter(|pair| pair[1] <= pair[0]).count(), 3, "{z:?}");
    // What follows a plan understands this one.
    for command in ["check", "inspect", "simulate", "heat", "build"] {
        let said = beadwright(at, &[command, "all/plan.json"]);
        let text = String::from_utf8_lossy(&said.stderr).into_owned();
        assert!(said.status.code().is_some() && !text.contains("panicked"), "{command}: {text}");
    }
    let read = beadwright(at, &["inspect", &main_program(&at.join("all"))]);
    assert!(read.status.success(), "{}", String::from_utf8_lossy(&read.stderr));
    // Built one after another this close, the torch would hit them; built together they may be this close.
    let near = ["-o", "near", "--gap", "5"];
    let refused = beadwright(at, &[&PLAN[..], &near, &["--order", "parts"]].concat());
    let text = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(3), "{text}");
    let left: Vec<_> = fs::read_dir(at.join("near")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["refused.html"], "no program is written");
    assert!(text.contains("The torch would hit") && text.contains("mm farther apart"), "{text}");
    assert!(beadwright(at, &[&PLAN[..], &near].concat()).status.success());
}

/// Programs and plans by part, one of them with another profile.
#[test]
fn each_part_has_programs_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    parts(at);
    let plan = ["plan", "cross.stl", "--with=gear.stl:profile=cmt-steel-abb", "--with=star.stl", "--no-deposit"];
    let each = ["--order", "parts", "--programs", "parts", "--gap", "150", "-o", "out"];
    let said = beadwright(at, &[&plan[..], &each].concat());
    let text = String::from_utf8_lossy(&said.stdout).into_owned();
    assert!(said.status.success(), "{text}{}", String::from_utf8_lossy(&said.stderr));
    let mut folders: Vec<String> =
        fs::read_dir(at.join("out")).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    folders.sort();
    let of = |name: &str| folders.iter().find(|folder| folder.ends_with(name)).unwrap().clone();
    assert_eq!(folders.len(), 3);
    let mut heights = Vec::new();
    for name in ["cross", "gear", "star"] {
        let plan = json(&at.join("out").join(of(name)).join("plan.json"));
        let steel = if name == "gear" { "cmt-steel-abb" } else { "cmt-al2319-kuka" };
        assert_eq!((plan["part"].as_str(), plan["profile"]["name"].as_str()), (Some(name), Some(steel)));
        heights.push((of(name), plan["layers"].as_array().unwrap().last().unwrap()["z"].as_f64().unwrap()));
    }
    // The lowest comes first.
    heights.sort_by(|a, b| a.0.cmp(&b.0));
    assert!(heights.windows(2).all(|pair| pair[0].1 <= pair[1].1 + 2.0), "{heights:?}");
    assert!(at.join("out").join(of("gear")).join("gear.mod").exists() || text.contains(".mod"), "{text}");
    // One that cannot be welded keeps the others from being written.
    let near = ["--order", "parts", "--programs", "parts", "--gap", "1", "-o", "near"];
    assert_eq!(beadwright(at, &[&plan[..], &near].concat()).status.code(), Some(3));
    assert!(!at.join("near").exists());
    let refused = |arguments: &[&str], words: &str| {
        let said = beadwright(at, &[&plan[..], arguments].concat());
        let text = String::from_utf8_lossy(&said.stderr).into_owned();
        assert!(said.status.code() == Some(1) && text.contains(words), "{text}");
    };
    refused(&["--programs", "parts"], "--order parts");
    refused(&["--order", "parts"], "--programs parts");
}

//! `adapt` and `build` as people run them: the programs that follow a scan, and builds that can be repeated.

use crate::common::{ok, refused};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A folder with the plan of the wall, and a scan after layer 20 that is 0.4 mm too low on the left and 0.4 mm too high on
/// the right.
fn wall() -> TempDir {
    let folder = TempDir::new().unwrap();
    ok(folder.path(), &["example", "wall"]);
    ok(folder.path(), &["plan", "wall.stl", "-p", "cmt-steel-abb", "--no-deposit", "-o", "plan"]);
    let z = layers(&folder.path().join("plan"))[19]["z"].as_f64().unwrap();
    let point = |i: i32| {
        let x = f64::from(i / 9) - 59.0;
        format!("{x},{},{}\n", f64::from(i % 9) * 0.5 - 2.0, z + 0.4 * x / 60.0)
    };
    fs::write(folder.path().join("scan.csv"), "x,y,z\n".to_owned() + &(0..119 * 9).map(point).collect::<String>())
        .unwrap();
    folder
}

fn layers(folder: &Path) -> Vec<serde_json::Value> {
    let plan: serde_json::Value = serde_json::from_slice(&fs::read(folder.join("plan.json")).unwrap()).unwrap();
    plan["layers"].as_array().unwrap().clone()
}

#[test]
fn a_scan_becomes_the_programs_that_follow() {
    let folder = wall();
    let said =
        ok(folder.path(), &["adapt", "plan/plan.json", "--scan", "scan.csv", "--after-layer", "20", "-o", "next"]);
    assert!(
        said.contains("Scan: table of points of 1071 points") && said.contains("30 layers follow (30 were planned)"),
        "{said}"
    );
    let out = folder.path().join("next");
    let (planned, adapted) = (layers(&folder.path().join("plan")), layers(&out));
    assert_eq!(planned[..20], adapted[..20]);
    assert_eq!((planned.len(), adapted.len()), (50, 50));
    // Programs begin after the scan.
    assert!(
        !out.join("wall_L020.mod").exists() && out.join("wall_L021.mod").exists() && out.join("wall_L050.mod").exists()
    );
    assert!(fs::read_to_string(out.join("adapt.html")).unwrap().contains("measured minus predicted"));
    // More metal on the left, where it is low; the torch follows the metal below.
    let pass = &adapted[20]["passes"][0];
    let points: Vec<[f64; 3]> = serde_json::from_value(pass["points"].clone()).unwrap();
    let paces: Vec<f64> = serde_json::from_value(pass["pace"].clone()).unwrap();
    let at = |x: f64| {
        (0..points.len() - 1).min_by(|a, b| (points[*a][0] - x).abs().total_cmp(&(points[*b][0] - x).abs())).unwrap()
    };
    let (left, right) = (at(-45.0), at(45.0));
    assert!(paces[right] / paces[left] > 1.3 && points[right][2] - points[left][2] > 0.5, "{paces:?} {points:?}");
    // The program of that layer is read back with the same length.
    let simulated = ok(folder.path(), &["simulate", "next/wall_L021.mod", "--profile", "cmt-steel-abb", "--json"]);
    let value: serde_json::Value = serde_json::from_str(&simulated).unwrap();
    assert!((value["totals"]["deposited_length_mm"].as_f64().unwrap() - 115.5).abs() < 5.0, "{simulated}");
    // A later scan goes on from the adapted plan.
    let again = ok(
        folder.path(),
        &["adapt", "next/plan.json", "--scan", "scan.csv", "--after-layer", "20", "-o", "again", "--json"],
    );
    let value: serde_json::Value = serde_json::from_str(&again).unwrap();
    assert!(value["layers"].as_u64() == Some(30) && value["clipped"].as_u64() < Some(5), "{again}");
}

/// The same scan in the coordinates of the scanner, which the cell places, leads to the same programs.
#[test]
fn a_scan_in_the_scanners_coordinates_is_moved_to_the_part() {
    let folder = wall();
    let at = folder.path();
    let adapt = |more: &[&str]| {
        let arguments =
            [&["adapt", "plan/plan.json", "--after-layer", "20", "-o", "next", "--json"][..], more].concat();
        ok(at, &arguments)
    };
    let as_is = adapt(&["--scan", "scan.csv"]);
    ok(at, &["reach", "--show", "kuka-kr20-r1810"]);
    let mut cell = ok(at, &["reach", "--show", "kuka-kr20-r1810"]);
    let said = {
        fs::write(at.join("cell.toml"), &cell).unwrap();
        refused(
            at,
            &["adapt", "plan/plan.json", "--scan", "scan.csv", "--after-layer", "20", "--scanner", "cell.toml"],
            1,
        )
    };
    assert!(said.contains("the cell has no [scanner]"), "{said}");
    let part = beadwright::robot::Cell::parse(&cell).unwrap().part;
    let [x, y, z] = part.position;
    // Above the part, looking down: its y and z point the other way.
    cell += &format!("\n[scanner]\nposition = [{x}, {y}, {}]\nrotation = [{}, 0, 180]\n", z + 400.0, part.rotation);
    fs::write(at.join("cell.toml"), cell).unwrap();
    let scan = fs::read_to_string(at.join("scan.csv")).unwrap();
    let row = |line: &str| match line.split(',').map(str::parse::<f64>).collect::<Result<Vec<_>, _>>() {
        Ok(p) => format!("{},{},{}\n", p[0], -p[1], 400.0 - p[2]),
        Err(_) => format!("{line}\n"),
    };
    fs::write(at.join("seen.csv"), scan.lines().map(row).collect::<String>()).unwrap();
    let moved = adapt(&["--scan", "seen.csv", "--scanner", "cell.toml"]);
    let value = |said: &str| -> serde_json::Value { serde_json::from_str(said).unwrap() };
    let (a, b) = (value(&as_is), value(&moved));
    assert_eq!(a["layers"], b["layers"]);
    let mean = |of: &serde_json::Value| of["error"]["mean"].as_f64().unwrap_or_else(|| panic!("{of}"));
    assert!((mean(&a) - mean(&b)).abs() < 1e-6, "{a} {b}");
}

#[test]
fn scans_and_plans_that_do_not_fit_are_reported() {
    let folder = wall();
    let adapt = |scan: &str, layer: &str| {
        refused(folder.path(), &["adapt", "plan/plan.json", "--scan", scan, "--after-layer", layer], 1)
    };
    let said = adapt("scan.csv", "40");
    assert!(said.contains("The plan is that high after layer 20.") && said.contains("--align plate"), "{said}");
    assert!(adapt("scan.csv", "99").contains("the plan has the layers 1 to 50; layer 99 is not one of them."));
    assert!(adapt("wall.stl", "20").contains("wall.stl"));
    assert!(adapt("nothing.csv", "20").contains("nothing.csv"));
    fs::write(folder.path().join("far.csv"), "500,0,29\n510,0,29\n520,0,29\n").unwrap();
    assert!(adapt("far.csv", "20").contains("--align fit aligns the scan with the part."));
    assert!(!folder.path().join("beadwright-adapted").exists());
    let said = refused(folder.path(), &["adapt", "wall.stl", "--scan", "scan.csv", "--after-layer", "2"], 1);
    assert!(said.contains("give the plan.json of the build"), "{said}");
}

#[test]
fn builds_are_repeated_byte_for_byte() {
    let folder = wall();
    let run = |page: &str, more: &[&str]| {
        let arguments = [&["build", "plan/plan.json", "--lost-pass", "25", "-o", page, "--json"], more].concat();
        (ok(folder.path(), &arguments), fs::read(folder.path().join(page)).unwrap())
    };
    let first = run("a.html", &["--seeds", "2"]);
    assert_eq!(first, run("b.html", &["--seeds", "2"]));
    let value: serde_json::Value = serde_json::from_str(&first.0).unwrap();
    let rms: Vec<f64> = (0..3).map(|k| value["rows"][k]["rms_layers"].as_f64().unwrap()).collect();
    assert!(rms[0] > rms[1] && rms[1] > rms[2], "{rms:?}");
    assert_ne!(first.0, run("c.html", &["--seed", "2", "--seeds", "2"]).0);
    // A model is planned first; with one kind of feedback there is one row.
    ok(folder.path(), &["example", "cross"]);
    let said = ok(folder.path(), &["build", "cross.stl", "--feedback", "place", "--scan-noise", "0.2"]);
    assert!(said.contains("by place") && !said.contains("open loop"), "{said}");
}

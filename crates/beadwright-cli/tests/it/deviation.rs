//! `deviation` as people run it: a scan beside its part, placed like the plan, in whatever unit.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

fn deviation(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_beadwright"));
    command.current_dir(folder).arg("deviation").args(arguments).output().unwrap()
}

fn said(folder: &Path, arguments: &[&str]) -> String {
    let output = deviation(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// A folder with the cross, and points 0.5 mm above its upper face at z = 20, moved in x and scaled.
fn folder(shift: f64, factor: f64) -> TempDir {
    let folder = TempDir::new().unwrap();
    let mut example = Command::new(env!("CARGO_BIN_EXE_beadwright"));
    assert!(example.current_dir(folder.path()).args(["example", "cross"]).status().unwrap().success());
    let point = |i: i32| [f64::from(i / 35 - 49) + shift, f64::from(i % 35 - 17), 20.5].map(|v| v * factor);
    let line = |[x, y, z]: [f64; 3]| format!("{x:.6},{y:.6},{z:.6}\n");
    fs::write(folder.path().join("scan.csv"), (0..99 * 35).map(|i| line(point(i))).collect::<String>()).unwrap();
    folder
}

fn figures(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    serde_json::from_str(&said(folder, &[arguments, &["--json"]].concat())).unwrap()
}

#[test]
fn a_scan_is_compared_with_the_part_as_it_is_planned() {
    let folder = folder(250.0, 1.0);
    let placed = ["cross.stl", "scan.csv", "--shift", "250,0", "--set", "fill.machining_allowance=1"];
    let text = said(folder.path(), &placed);
    for line in ["scan.csv against cross.stl: table of points of 3465 points", "+0.500 mm", "100.0 %"] {
        assert!(text.contains(line), "{text}");
    }
    assert!(!text.contains("warning"), "{text}");
    let reported = figures(folder.path(), &placed);
    assert!((reported["figures"]["mean"].as_f64().unwrap() - 0.5).abs() < 1e-6, "{reported}");
    assert_eq!(reported["doubts"].as_array().unwrap().len(), 0);
    // Beside the part, the first line says so.
    let text = said(folder.path(), &["cross.stl", "scan.csv"]);
    assert!(text.starts_with("warning: half of the scan lies more than") && text.contains("--shift"), "{text}");
}

#[test]
fn a_wrong_unit_is_reported_with_its_remedy() {
    let folder = folder(0.0, 1.0 / 25.4);
    let text = said(folder.path(), &["cross.stl", "scan.csv"]);
    assert!(text.starts_with("warning: the scan has about 1/25.4 the size"), "{text}");
    let text = said(folder.path(), &["cross.stl", "scan.csv", "--scan-units", "in"]);
    assert!(!text.contains("warning") && text.contains("+0.500 mm"), "{text}");
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let folder = folder(0.0, 1.0);
    fs::write(folder.path().join("empty.csv"), "x,y,z\n").unwrap();
    fs::write(folder.path().join("odd.csv"), "1,2,3\n1,two,3\n").unwrap();
    for (scan, reason) in
        [("empty.csv", "holds no points"), ("odd.csv", "line 2 of the scan"), ("none.csv", "none.csv")]
    {
        let output = deviation(folder.path(), &["cross.stl", scan]);
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(1) && error.contains(reason), "{error}");
    }
}

#[test]
fn a_plan_is_compared_with_its_part() {
    let folder = folder(0.0, 1.0);
    let mut plan = Command::new(env!("CARGO_BIN_EXE_beadwright"));
    let status = plan.current_dir(folder.path()).args(["plan", "cross.stl", "-o", "out", "--quiet"]).status().unwrap();
    assert!(status.success());
    let text = said(folder.path(), &["cross.stl", "out/plan.json"]);
    assert!(text.starts_with("out/plan.json against cross.stl: ") && text.contains("is shared"), "{text}");
    let built = &figures(folder.path(), &["cross.stl", "out/plan.json"])["built"];
    let figure = |name: &str| built[name].as_f64().unwrap();
    assert!(figure("agreement") > 0.95 && figure("common") <= figure("part").min(figure("metal")), "{built}");
    // Placed elsewhere, they have nothing in common, and the first line says what to do.
    let text = said(folder.path(), &["cross.stl", "out/plan.json", "--shift", "400,0"]);
    assert!(text.starts_with("warning: plan and part have only 0.0 % in common: place the part"), "{text}");
}

//! `guide` as people run it: what it prints is what `plan --chart` takes.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_beadwright")).current_dir(folder).args(arguments).output().unwrap()
}

fn guide(folder: &Path, file: &str) -> String {
    let output = run(folder, &["guide", file]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap().trim().to_owned()
}

#[test]
fn the_guide_of_an_elbow_plans_it() {
    let folder = TempDir::new().unwrap();
    let chart = guide(folder.path(), "elbow");
    let planned = run(folder.path(), &["plan", "elbow", "--chart", &chart, "--no-deposit", "--json", "-o", "out"]);
    assert!(planned.status.success(), "{}", String::from_utf8_lossy(&planned.stderr));
    let json: serde_json::Value = serde_json::from_slice(&planned.stdout).unwrap();
    // Pappus: 25 mm straight, a quarter turn of 120 mm, 25 mm straight, between radii of 25 and 45 mm.
    let volume = std::f64::consts::PI * (45.0 * 45.0 - 25.0 * 25.0) * (50.0 + 60.0 * std::f64::consts::PI);
    let laid = json["deposited_volume_mm3"].as_f64().unwrap();
    assert!((laid / volume - 1.0).abs() < 0.02, "{laid} of {volume}");
    assert_eq!(json["arc_starts"], json["layers"]);
}

#[test]
fn a_guide_is_read_from_a_table() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("curve.csv"), "x,y,z\n0,0,0\n0,0,100\n\n100,0,100.0004\n").unwrap();
    assert_eq!(guide(folder.path(), "curve.csv"), "guide:points=0/0/0:0/0/100:100/0/100");
    fs::write(folder.path().join("bad.csv"), "0,0,0\n0,0\n").unwrap();
    let bad = run(folder.path(), &["guide", "bad.csv"]);
    let why = String::from_utf8(bad.stderr).unwrap();
    assert!(
        !bad.status.success() && why.contains("bad.csv, line 2: x, y and z in mm are expected, not \"0,0\""),
        "{why}"
    );
}

#[test]
fn a_part_that_is_no_tube_has_no_guide() {
    let folder = TempDir::new().unwrap();
    let refused = run(folder.path(), &["guide", "cross"]);
    let why = String::from_utf8(refused.stderr).unwrap();
    assert!(!refused.status.success() && why.contains("the part is no tube or bar"), "{why}");
}

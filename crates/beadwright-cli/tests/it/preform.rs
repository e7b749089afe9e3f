//! `preform` as people run it, and plans of preforms.

use beadwright::model::import;
use beadwright::task::Task;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_beadwright")).current_dir(folder).args(arguments).output().unwrap()
}

fn said(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// A table on one leg, 80 × 80 mm, as ASCII STL.
fn table(folder: &Path) {
    let mut text = "solid table\n".to_owned();
    for ([x0, y0, z0], [x1, y1, z1]) in [([30, 30, 0], [50, 50, 30]), ([0, 0, 30], [80, 80, 40])] {
        let c = |i: usize| [[x0, x1][i & 1], [y0, y1][i >> 1 & 1], [z0, z1][i >> 2]];
        for [a, b, d, e] in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]] {
            for corners in [[a, b, d], [a, d, e]] {
                text += "facet normal 0 0 0\nouter loop\n";
                corners.map(c).iter().for_each(|[x, y, z]| text += &format!("vertex {x} {y} {z}\n"));
                text += "endloop\nendfacet\n";
            }
        }
    }
    fs::write(folder.join("table.stl"), text + "endsolid table\n").unwrap();
}

#[test]
fn a_part_that_hangs_over_is_planned_as_its_preform() {
    let folder = TempDir::new().unwrap();
    table(folder.path());
    let refused = run(folder.path(), &["plan", "table.stl", "-o", "out"]);
    let why = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(3), "{why}");
    assert!(why.contains("--preform plans the part plus the stock") && why.contains("kg more to weld"), "{why}");
    assert!(folder.path().join("out/refused.html").exists());
    let planned = run(folder.path(), &["plan", "table.stl", "--preform", "-o", "out"]);
    let reported = String::from_utf8(planned.stderr).unwrap();
    assert!(planned.status.success() && reported.contains("kg are milled off"), "{reported}");
    assert!(folder.path().join("out/TABLE.src").exists() && !folder.path().join("out/refused.html").exists());
}

#[test]
fn a_preform_is_written_with_the_part_in_it() {
    let folder = TempDir::new().unwrap();
    table(folder.path());
    // Scanned as it should be, the preform has metal wherever the part is.
    said(folder.path(), &["preform", "table.stl"]);
    let scanned = said(folder.path(), &["deviation", "table.stl", "table_preform.stl", "--preform"]);
    assert!(scanned.contains("inside, where metal is missing           0.0 %"), "{scanned}");
    let text = said(folder.path(), &["preform", "table.stl", "-o", "stock.3mf", "--faces", "faces.csv", "--json"]);
    let faces = fs::read_to_string(folder.path().join("faces.csv")).unwrap();
    let faces: Vec<Vec<&str>> = faces.lines().map(|line| line.split(',').collect()).collect();
    // Six of the leg and six of the top, each the largest first.
    assert_eq!((faces.len(), faces[0].len(), faces[1][1]), (13, 11, "6400.000"));
    let reported: serde_json::Value = serde_json::from_str(&text).unwrap();
    let stock = import(&fs::read(folder.path().join("stock.3mf")).unwrap(), &Task::new()).unwrap();
    let names: Vec<&str> = stock.objects.iter().map(|object| object.name.as_str()).collect();
    assert_eq!(names, ["preform", "part"]);
    assert_eq!(stock.mesh.bounds().0.z, 0.0);
    // Both together, as the file has both.
    let kg = reported["figures"]["part_kg"].as_f64().unwrap() + reported["figures"]["preform_kg"].as_f64().unwrap();
    let density = 2.82e-6;
    assert!((stock.mesh.volume() * density / kg - 1.0).abs() < 1e-3, "{reported} {}", stock.mesh.volume());

    let text = said(folder.path(), &["preform", "table.stl"]);
    for row in ["table_preform.stl", "preform", "block", "milled off", "sawn off 4.0 mm above it"] {
        assert!(text.contains(row), "{text}");
    }
    // On an edge, less hangs over.
    assert!(text.contains("--orient turns the part."), "{text}");
    let turned = said(folder.path(), &["preform", "table.stl", "--orient", "--json"]);
    let turned: serde_json::Value = serde_json::from_str(&turned).unwrap();
    assert!(turned["figures"]["preform_kg"].as_f64() < reported["figures"]["preform_kg"].as_f64());
}

#[test]
fn curves_and_open_surfaces_have_no_preform() {
    let folder = TempDir::new().unwrap();
    assert!(run(folder.path(), &["example", "gourd", "-o", "gourd.igs"]).status.success());
    let refused = run(folder.path(), &["plan", "gourd.igs", "--height", "20", "--preform"]);
    let why = String::from_utf8(refused.stderr).unwrap();
    let once = |why: &str| why.matches("only solids have a preform").count() == 1;
    assert!(refused.status.code() == Some(1) && once(&why), "{why}");
    table(folder.path());
    let whole = fs::read_to_string(folder.path().join("table.stl")).unwrap();
    // Without the upper face of its top.
    let facets: Vec<&str> = whole.split_inclusive("endfacet\n").collect();
    fs::write(folder.path().join("open.stl"), [&facets[..14], &facets[16..]].concat().concat()).unwrap();
    for command in [["preform", "open.stl"].as_slice(), &["plan", "open.stl", "--preform"]] {
        let refused = run(folder.path(), command);
        let why = String::from_utf8(refused.stderr).unwrap();
        assert!(refused.status.code() == Some(1) && once(&why) && why.contains("--surface solid"), "{why}");
    }
    assert!(!folder.path().join("open_preform.stl").exists());
    // A leg that is open on two opposite sides has no closed contour as it stands.
    let side = [&facets[..4], &facets[6..8], &facets[10..12], &facets[24..]].concat().concat();
    fs::write(folder.path().join("side.stl"), side).unwrap();
    let refused = run(folder.path(), &["plan", "side.stl", "--preform", "--surface", "solid", "--scale", "3"]);
    let why = String::from_utf8(refused.stderr).unwrap();
    assert!(refused.status.code() == Some(1) && why.contains("no slice of the part has a closed contour"), "{why}");
}

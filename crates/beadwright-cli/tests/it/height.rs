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

/// Where the scanner of [`leaning_cell`] sees a point of the part, mm: written out, by matrices.
pub(crate) fn seen_by_scanner(p: [f64; 3]) -> [f64; 3] {
    let [turn, z, y, x] = [30.0_f64, 20.0, -15.0, 160.0].map(f64::to_radians);
    // The part is turned about the vertical by 30° and lies at x 1200, y 0, z 500 mm.
    let base = [1200.0 + turn.cos() * p[0] - turn.sin() * p[1], turn.sin() * p[0] + turn.cos() * p[1], 500.0 + p[2]];
    let from = [base[0] - 1260.0, base[1] + 75.0, base[2] - 910.0];
    // The axes of the scanner in the robot's base: the columns of Rz(20°) Ry(-15°) Rx(160°).
    let axes = [
        [z.cos() * y.cos(), z.sin() * y.cos(), -y.sin()],
        [
            z.cos() * y.sin() * x.sin() - z.sin() * x.cos(),
            z.sin() * y.sin() * x.sin() + z.cos() * x.cos(),
            y.cos() * x.sin(),
        ],
        [
            z.cos() * y.sin() * x.cos() + z.sin() * x.sin(),
            z.sin() * y.sin() * x.cos() - z.cos() * x.sin(),
            y.cos() * x.cos(),
        ],
    ];
    axes.map(|axis| axis[0] * from[0] + axis[1] * from[1] + axis[2] * from[2])
}

/// A cell with a part that is turned, and a scanner that looks at it askew.
pub(crate) fn leaning_cell(at: &Path) -> String {
    let cell = ok(at, &["reach", "--show", "kuka-kr20-r1810"]);
    let turned = cell.replace("rotation = 0.0  ", "rotation = 30.0 ");
    assert_ne!(cell, turned);
    turned + "\n[scanner]\nposition = [1260, -75, 910]\nrotation = [20, -15, 160]\n"
}

/// The same scan in the coordinates of the scanner, which the cell places, leads to the same layers. Neither scan nor place is the same
/// when mirrored or turned back.
#[test]
fn a_scan_in_the_scanners_coordinates_is_moved_to_the_part() {
    let folder = wall();
    let at = folder.path();
    let z = layers(&at.join("plan"))[19]["z"].as_f64().unwrap();
    // No point lies half way between two points of a grid.
    let point = |k: i32| {
        let (x, y) = (f64::from(k / 8) - 58.9871, f64::from(k % 8) * 0.4937 - 1.6213);
        [x, y, z + 0.1 + 0.4 * x / 60.0 + 0.06 * y]
    };
    let points: Vec<[f64; 3]> = (0..112 * 8).map(point).collect();
    let table = |points: &[[f64; 3]]| points.iter().map(|[x, y, z]| format!("{x},{y},{z}\n")).collect::<String>();
    fs::write(at.join("scan.csv"), table(&points)).unwrap();
    fs::write(at.join("seen.csv"), table(&points.iter().copied().map(seen_by_scanner).collect::<Vec<_>>())).unwrap();
    fs::write(at.join("cell.toml"), leaning_cell(at)).unwrap();
    let adapt = |more: &[&str]| {
        let arguments =
            [&["adapt", "plan/plan.json", "--after-layer", "20", "-o", "next", "--json"][..], more].concat();
        let said: serde_json::Value = serde_json::from_str(&ok(at, &arguments)).unwrap();
        (said, layers(&at.join("next")))
    };
    let (as_is, own) = adapt(&["--scan", "scan.csv"]);
    let (moved, others) = adapt(&["--scan", "seen.csv", "--scanner", "cell.toml"]);
    for key in ["mean", "rms", "low", "high"] {
        let [a, b] = [&as_is, &moved].map(|said| said["error"][key].as_f64().unwrap());
        assert!((a - b).abs() < 1e-6, "{key}: {as_is} {moved}");
    }
    let heights = |layers: &[serde_json::Value]| -> Vec<f64> {
        let passes = layers.iter().flat_map(|layer| layer["passes"].as_array().unwrap());
        passes
            .flat_map(|pass| serde_json::from_value::<Vec<[f64; 3]>>(pass["points"].clone()).unwrap())
            .map(|p| p[2])
            .collect()
    };
    let (own, others) = (heights(&own), heights(&others));
    assert_eq!(own.len(), others.len());
    let apart = own.iter().zip(&others).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-3, "the torch is {apart} mm higher or lower");
}

#[test]
fn a_cell_without_a_scanner_is_refused_with_what_to_do() {
    let folder = wall();
    let at = folder.path();
    fs::write(at.join("cell.toml"), ok(at, &["reach", "--show", "kuka-kr20-r1810"])).unwrap();
    let adapt = |scan: &str, cell: &str| {
        refused(at, &["adapt", "plan/plan.json", "--scan", scan, "--after-layer", "20", "--scanner", cell], 1)
    };
    let said = adapt("scan.csv", "cell.toml");
    assert!(said.contains("cell.toml: the cell has no [scanner]") && said.contains("--write cell.toml"), "{said}");
    let said = adapt("scan.csv", "kuka-kr20-r1810");
    assert!(said.contains("`beadwright reach --show kuka-kr20-r1810 > cell.toml`"), "{said}");
    assert!(said.contains("--write cell.toml") && said.contains("give --scanner cell.toml"), "{said}");
    // The cell is read before the scan.
    assert!(adapt("nothing.csv", "cell.toml").contains("no [scanner]"));
    // A plan is in the coordinates of the part.
    let said = refused(at, &["deviation", "wall.stl", "plan/plan.json", "--scanner", "cell.toml"], 1);
    assert!(said.contains("plan.json: a plan is in the coordinates of the part. Leave out --scanner"), "{said}");
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

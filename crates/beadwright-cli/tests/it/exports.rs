//! What goes to other programs and comes from them, as people run it: exports, drawings, cuts, joints, completions.

use crate::common::{beadwright, ok};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = beadwright(folder, arguments);
    assert!(matches!(output.status.code(), Some(1 | 2)), "{arguments:?}");
    String::from_utf8(output.stderr).unwrap()
}

fn json(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    serde_json::from_str(&ok(folder, arguments)).unwrap()
}

/// A folder with the plan of the example cross.
fn planned() -> TempDir {
    let folder = TempDir::new().unwrap();
    ok(folder.path(), &["example", "cross"]);
    ok(folder.path(), &["plan", "cross.stl", "-o", "out", "--no-deposit"]);
    folder
}

#[test]
fn a_plan_goes_out_in_every_format() {
    let folder = planned();
    let at = folder.path();
    for name in ["a.csv", "a.parquet", "a.vtp", "a.3mf", "a.stl", "a.glb"] {
        let said = ok(at, &["export", "out/plan.json", "-o", name]);
        assert!(said.contains(name) && fs::metadata(at.join(name)).unwrap().len() > 1000, "{said}");
    }
    // Toolpaths are a plan again, and are exported like one.
    let [plan, toolpaths] = ["out/plan.json", "a.3mf"].map(|file| json(at, &["inspect", file, "--json"]));
    assert_eq!(
        (&plan["totals"]["arc_starts"], &plan["points"]),
        (&toolpaths["totals"]["arc_starts"], &toolpaths["points"])
    );
    ok(at, &["export", "a.3mf", "-o", "b.3mf"]);
    assert_eq!(fs::read(at.join("a.csv")).unwrap().len(), {
        ok(at, &["export", "b.3mf", "-o", "b.csv"]);
        fs::read(at.join("b.csv")).unwrap().len()
    });
    let metal = plan["totals"]["metal_volume_mm3"].as_f64().unwrap();
    let built = json(at, &["inspect", "a.stl", "--json"]);
    assert!((built["volume"].as_f64().unwrap() / metal - 1.0).abs() < 0.01, "{} for {metal}", built["volume"]);
    assert!(refused(at, &["plan", "a.3mf"]).contains("toolpaths"));
    for name in ["a.docx", "a"] {
        let said = refused(at, &["export", "out/plan.json", "-o", name]);
        assert!(said.contains(".3mf") && said.contains(".dxf"), "{said}");
    }
}

#[test]
fn layers_go_out_one_by_one_or_alone() {
    let folder = planned();
    let at = folder.path();
    ok(at, &["export", "out/plan.json", "-o", "layers.dxf"]);
    assert!(["layers-001.dxf", "layers-010.dxf"].iter().all(|name| at.join(name).exists()));
    ok(at, &["export", "out/plan.json", "-o", "one.svg", "--layer", "3"]);
    assert!(fs::read_to_string(at.join("one.svg")).unwrap().contains("Layer 3"));
    for number in ["0", "11"] {
        assert!(refused(at, &["export", "out/plan.json", "-o", "x.svg", "--layer", number]).contains("1 to 10"));
    }
    assert!(refused(at, &["export", "out/plan.json", "-o", "x.csv", "--layer", "1"]).contains("--layer"));
}

const PLATE: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"90mm\" height=\"60mm\" viewBox=\"0 0 90 60\">\
    <rect width=\"90\" height=\"60\"/></svg>";

#[test]
fn drawings_are_planned_with_a_height() {
    let folder = TempDir::new().unwrap();
    let at = folder.path();
    fs::write(at.join("plate.svg"), PLATE).unwrap();
    let said = ok(at, &["plan", "plate.svg", "--height", "10", "--no-deposit", "-o", "out"]);
    assert!(said.contains("90.0 × 60.0 × 10.0 mm"), "{said}");
    assert!(refused(at, &["plan", "plate.svg", "-o", "none"]).contains("--height"));
    assert!(refused(at, &["compare", "plate.svg"]).contains("SVG"));
    assert!(ok(at, &["inspect", "plate.svg"]).contains("90.000 × 60.000 (mm)"));
    assert_eq!(json(at, &["inspect", "plate.svg", "--json"])["islands"], 1);
}

#[test]
fn parts_are_cut_and_mended() {
    let folder = planned();
    let at = folder.path();
    let said = ok(at, &["plan", "cross.stl", "--from-z", "12", "--no-deposit", "-o", "upper"]);
    assert!(said.contains("100.0 × 100.0 × 8.0 mm"), "{said}");
    assert!(refused(at, &["plan", "cross.stl", "--from-z", "21", "-o", "none"]).contains("20.00 mm high"));
    let said = ok(at, &["inspect", "cross.stl", "--repair", "-o", "fixed.stl"]);
    assert!(said.contains("fixed.stl"), "{said}");
    let [before, after] = ["cross.stl", "fixed.stl"].map(|file| json(at, &["inspect", file, "--json"]));
    assert_eq!((&before["volume"], &before["repair"]), (&after["volume"], &after["repair"]));
    assert!(refused(at, &["inspect", "cross.stl", "--repair", "-o", "fixed.obj"]).contains(".stl"));
}

/// The example without its last facet.
#[test]
fn holes_are_filled_and_overhangs_drawn() {
    let folder = planned();
    let at = folder.path();
    let mut bytes = fs::read(at.join("cross.stl")).unwrap();
    let count = u32::from_le_bytes(bytes[80..84].try_into().unwrap());
    bytes[80..84].copy_from_slice(&(count - 1).to_le_bytes());
    bytes.truncate(bytes.len() - 50);
    fs::write(at.join("open.stl"), bytes).unwrap();
    let said = ok(at, &["inspect", "open.stl", "--repair", "--fill-holes", "500", "-o", "filled.stl"]);
    assert!(said.contains("1 hole closed with 1 triangle;"), "{said}");
    let [whole, filled] = ["cross.stl", "filled.stl"].map(|file| json(at, &["inspect", file, "--json"]));
    assert_eq!(whole["volume"], filled["volume"]);
    let said = ok(at, &["inspect", "open.stl", "--repair", "--fill-holes", "0.5", "-o", "open2.stl"]);
    assert!(said.contains("1 hole left open") && said.contains("open edges"), "{said}");
    assert!(refused(at, &["inspect", "open.stl", "--fill-holes", "5"]).contains("--repair"));
    ok(at, &["inspect", "cross.stl", "--overhang", "below.svg"]);
    assert!(fs::read_to_string(at.join("below.svg")).unwrap().contains("on the plate: "));
}

#[test]
fn programs_of_some_layers_only() {
    let folder = planned();
    let at = folder.path();
    ok(at, &["plan", "cross.stl", "--layers", "4-6", "--no-deposit", "-o", "some"]);
    let written = |layer: usize| at.join(format!("some/CROSS_L{layer:03}.src")).exists();
    assert_eq!((1..=10).filter(|layer| written(*layer)).collect::<Vec<_>>(), [4, 5, 6]);
    let main = fs::read_to_string(at.join("some/CROSS.src")).unwrap();
    assert!(main.contains("CROSS_L006") && !main.contains("CROSS_L007"), "{main}");
    assert_eq!(fs::read(at.join("some/plan.json")).unwrap(), fs::read(at.join("out/plan.json")).unwrap());
    for wrong in ["6-4", "0-3", "3,,5", "a-b"] {
        assert!(refused(at, &["plan", "cross.stl", "--layers", wrong]).contains("10-20"));
    }
    assert!(refused(at, &["plan", "cross.stl", "--layers", "11-12", "-o", "none"]).contains("10 layers"));
}

#[test]
fn joints_go_out_as_a_table_and_for_ros() {
    let folder = planned();
    let at = folder.path();
    let reach = ["reach", "out/plan.json", "--cell", "kuka-kr20-r1810", "--trajectory"];
    ok(at, &[&reach[..], &["joints.csv"]].concat());
    ok(at, &[&reach[..], &["joints.json"]].concat());
    let table = fs::read_to_string(at.join("joints.csv")).unwrap();
    let message: serde_json::Value = serde_json::from_slice(&fs::read(at.join("joints.json")).unwrap()).unwrap();
    assert_eq!(message["points"].as_array().unwrap().len(), table.lines().count() - 1);
    assert!(refused(at, &[&reach[..], &["joints.txt"]].concat()).contains(".csv or .json"));
}

#[test]
fn shells_and_the_manual_know_the_command() {
    let folder = TempDir::new().unwrap();
    let at = folder.path();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let text = ok(at, &["completions", shell]);
        assert!(text.contains("beadwright") && text.contains("export") && text.contains("from-z"), "{shell}");
    }
    let page = ok(at, &["man"]);
    assert!(page.contains(".TH beadwright 1") && page.contains("export"), "{page}");
    ok(at, &["man", "-o", "man"]);
    let page = fs::read_to_string(at.join("man/beadwright-profile-check.1")).unwrap();
    assert!(page.contains("beadwright profile check"), "{page}");
    assert!(at.join("man/beadwright-plan.1").exists());
}

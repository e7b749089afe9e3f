//! Parts of several bodies, on surfaces and on existing parts, as people plan them.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_beadwright")).current_dir(folder).args(arguments).output().unwrap()
}

fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn fails(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert!(!output.status.success());
    String::from_utf8(output.stderr).unwrap()
}

/// A block as an ASCII STL file, from its lowest to its highest corner.
fn block(path: &Path, low: [f64; 3], high: [f64; 3]) {
    let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { high[axis] } else { low[axis] });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let mut text = "solid block\n".to_owned();
    for triangle in faces.iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]) {
        text.push_str("facet normal 0 0 0\nouter loop\n");
        for [x, y, z] in triangle.map(|k| corner(*k)) {
            text.push_str(&format!("vertex {x} {y} {z}\n"));
        }
        text.push_str("endloop\nendfacet\n");
    }
    fs::write(path, text + "endsolid block\n").unwrap();
}

#[test]
fn an_example_comes_with_its_bodies() {
    let folder = TempDir::new().unwrap();
    for name in ["y-tube", "dome", "shaft"] {
        done(folder.path(), &["example", name, "-o", &format!("{name}.stl")]);
        let (model, bodies) = (format!("{name}.stl"), format!("{name}.bodies.toml"));
        let json = done(folder.path(), &["plan", &model, "--bodies", &bodies, "--no-deposit", "--json", "-o", "out"]);
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        let [laid, part] = ["deposited_volume_mm3", "mesh_volume_mm3"].map(|key| json[key].as_f64().unwrap());
        assert!((laid / part - 1.0).abs() < 0.02, "{name}: {laid} of {part}");
        assert!(folder.path().join("out/report.html").exists());
        let checked = run(folder.path(), &["check", "out/plan.json"]);
        let said = String::from_utf8_lossy(&checked.stdout);
        assert!(
            !["overhang", "layers", "air", "crossing"].iter().any(|kind| said.contains(&format!("{kind} ("))),
            "{said}"
        );
    }
}

#[test]
fn a_part_rests_on_an_existing_one_wherever_both_lie() {
    let folder = TempDir::new().unwrap();
    block(&folder.path().join("base.stl"), [100.0, 40.0, -12.0], [260.0, 150.0, 0.0]);
    block(&folder.path().join("boss.stl"), [150.0, 80.0, 0.0], [210.0, 120.0, 15.0]);
    block(&folder.path().join("beside.stl"), [250.0, 80.0, 0.0], [310.0, 120.0, 15.0]);
    done(folder.path(), &["plan", "boss.stl", "--onto", "base.stl", "--turn", "0,0,30", "-o", "out"]);
    let text = fs::read_to_string(folder.path().join("out/plan.json")).unwrap();
    let plan: serde_json::Value = serde_json::from_str(&text).unwrap();
    let first = &plan["layers"][0]["passes"][0]["points"][0];
    assert!((12.0..15.0).contains(&first[2].as_f64().unwrap()), "{first}");
    let why = fails(folder.path(), &["plan", "beside.stl", "--onto", "base.stl", "-o", "out2"]);
    assert_eq!(why.matches("hangs over nothing").count(), 1, "{why}");
    assert!(why.contains("Layer 1:") && !why.contains("--preform plans"), "{why}");
}

#[test]
fn a_surface_is_clad() {
    let folder = TempDir::new().unwrap();
    done(folder.path(), &["example", "clad", "-o", "clad.stl"]);
    // The top of the cladding is as its foot is.
    let output = run(folder.path(), &["surface", "clad.stl", "-o", "top.bodies.toml"]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && said.contains("slopes by up to 1"), "{said}");
    let bodies = fs::read_to_string(folder.path().join("top.bodies.toml")).unwrap();
    assert!(bodies.starts_with("[[body]]\nname = \"clad\"\nchart = \"surface:up="), "{bodies}");
    let why = fails(folder.path(), &["plan", "clad.stl", "--bodies", "top.bodies.toml", "-o", "out"]);
    assert!(why.contains("body clad (layers.bodies)"), "{why}");
}

/// What the command prints is what plans the cladding: on an area of a dome, and around a flange.
#[test]
fn cladding_is_planned_by_the_command_that_comes_with_it() {
    let folder = TempDir::new().unwrap();
    done(folder.path(), &["example", "dome", "-o", "dome.stl"]);
    done(folder.path(), &["example", "shaft", "-o", "shaft.stl"]);
    let square = "<svg xmlns='http://www.w3.org/2000/svg' width='50mm' height='40mm' viewBox='0 0 50 40'>\
                  <rect x='5' y='5' width='40' height='30'/></svg>";
    fs::write(folder.path().join("area.svg"), square).unwrap();
    let planned = |clad: &[&str], layers: u64| {
        let said = done(folder.path(), clad);
        let command = said.lines().nth(1).unwrap().trim().replace('\'', "");
        let words: Vec<&str> = command.split(' ').skip(1).chain(["--json", "-o", "out"]).collect();
        let output = run(folder.path(), &words);
        let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!((json["layers"].as_u64(), json["arc_starts"].as_u64()), (Some(layers), Some(layers)), "{command}");
        let [laid, part] = ["deposited_volume_mm3", "mesh_volume_mm3"].map(|key| json[key].as_f64().unwrap());
        // Nothing overlaps the beads at the rim of so small a patch.
        assert!((0.9..1.02).contains(&(laid / part)), "{command}: {laid} of {part}");
    };
    planned(&["clad", "dome.stl", "--layers", "2", "--area", "area.svg", "-o", "patch.stl"], 2);
    let around = ["--around", "axis=z,radius=61", "-o", "rim.stl"];
    planned(&[&["clad", "shaft.stl", "--layers", "3"][..], &around].concat(), 3);
    let why = fails(folder.path(), &["clad", "shaft.stl", "--around", "axis=z,radius=25"]);
    assert!(why.contains("from 60.0 to 105.0 mm") && why.contains("--from and --to"), "{why}");
    assert!(!folder.path().join("cladding.stl").exists());
    assert!(fails(folder.path(), &["clad", "dome.stl", "-o", "dome.stl"]).contains("that is the base"));
}

/// A block that has lost 3 mm of its top is welded as high as it was, and no higher than the allowance.
#[test]
fn a_repair_is_planned_by_the_command_that_comes_with_it() {
    let folder = TempDir::new().unwrap();
    let write = |name: &str, high: [f64; 3]| block(&folder.path().join(name), [0.0; 3], high);
    write("part.stl", [80.0, 60.0, 20.0]);
    write("scan.stl", [80.0, 60.0, 17.0]);
    let said = done(folder.path(), &["repair", "part.stl", "scan.stl", "-o", "top.stl"]);
    assert!(said.starts_with("1. near") && said.contains("3.0 mm deep, 14.4 cm³ missing"), "{said}");
    let command = said.lines().last().unwrap().trim();
    let words: Vec<&str> = command.split(' ').skip(1).chain(["--json", "-o", "out"]).collect();
    let json: serde_json::Value = serde_json::from_str(&done(folder.path(), &words)).unwrap();
    // Two layers of 2 mm: 3 mm and at most 2 of allowance.
    assert_eq!((json["layers"].as_u64(), json["arc_starts"].as_u64()), (Some(2), Some(2)), "{command}");
    let deviation = ["deviation", "top.stl", "out/plan.json", "--onto", "top.base.stl", "--json"];
    let json: serde_json::Value = serde_json::from_str(&done(folder.path(), &deviation)).unwrap();
    assert!(
        json["built"]["agreement"].as_f64().unwrap() > 0.95 && json["figures"]["mean"].as_f64().unwrap().abs() < 0.3
    );

    // Below, where it ends under what is left of the part.
    block(&folder.path().join("below.stl"), [0.0, 0.0, 3.0], [80.0, 60.0, 20.0]);
    let said = done(folder.path(), &["repair", "part.stl", "below.stl", "-o", "under.stl"]);
    assert!(said.contains("1.0 mm higher than the part") && said.contains("along 0/0/-1"), "{said}");
    let words: Vec<&str> =
        said.lines().last().unwrap().trim().split(' ').skip(1).chain(["--json", "-o", "out"]).collect();
    let json: serde_json::Value = serde_json::from_slice(&run(folder.path(), &words).stdout).unwrap();
    assert_eq!((json["layers"].as_u64(), json["arc_starts"].as_u64()), (Some(2), Some(2)), "{said}");

    // Nothing is missing, and nothing is written; a scan of the top alone lies above the plate.
    let said = done(folder.path(), &["repair", "part.stl", "part.stl", "-o", "none.stl"]);
    assert!(said.starts_with("no metal is missing") && !folder.path().join("none.stl").exists(), "{said}");
    let above = "v 0 0 17\nv 80 0 17\nv 80 60 17\nv 0 60 17\nf 1 2 3\nf 1 3 4\n";
    fs::write(folder.path().join("above.obj"), above).unwrap();
    let said = done(folder.path(), &["repair", "part.stl", "above.obj"]);
    assert!(
        said.starts_with("warning: `plan`")
            && said.contains("17.0 mm lower than the part")
            && said.contains("z 20.0 mm")
            // It shows the top alone, and that it lies lower may be its own fault.
            && said.contains("shifted by 3.0 mm")
            && said.contains("the scan does not show"),
        "{said}"
    );

    // What is given is kept.
    fs::write(folder.path().join("cloud.xyz"), "0 0 17\n10 0 17\n0 10 17\n").unwrap();
    assert!(fails(folder.path(), &["repair", "part.stl", "cloud.xyz"]).contains("cloud of points"));
    assert!(
        fails(folder.path(), &["repair", "part.stl", "scan.stl", "-o", "scan.stl"]).contains("would be overwritten")
    );
    // The model is STL, whatever it is called.
    for wrong in ["metal.obj", "metal"] {
        for command in [&["repair", "part.stl", "scan.stl"][..], &["clad", "part.stl"]] {
            let why = fails(folder.path(), &[command, &["-o", wrong]].concat());
            assert!(why.contains("name it metal.stl") && !folder.path().join(wrong).exists(), "{why}");
        }
    }
    let low = fails(folder.path(), &["repair", "part.stl", "scan.stl", "--allowance", "0.5"]);
    assert!(low.contains("height of a layer"), "{low}");
    let apart = fails(folder.path(), &["repair", "part.stl", "scan.stl", "--scan-units", "m"]);
    assert!(apart.contains("--scan-units"), "{apart}");
}

#[test]
fn faults_of_a_file_of_bodies_are_named() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("b.toml"), "[[body]]\nname = \"a\"\nchart = \"disc:radius=3\"\n").unwrap();
    let why = fails(folder.path(), &["plan", "cross", "--bodies", "b.toml"]);
    assert!(why.contains("b.toml") && why.contains("line 3") && why.contains("no kind of layers"), "{why}");
    let why = fails(folder.path(), &["plan", "cross", "--bodies", "missing.toml"]);
    assert!(why.contains("missing.toml"), "{why}");
}

/// The same bodies as `directions` writes, in one command; a part that needs none is planned in level layers.
#[test]
fn a_part_is_divided_while_it_is_planned() {
    let folder = TempDir::new().unwrap();
    done(folder.path(), &["example", "hub", "-o", "hub.stl"]);
    let output = run(folder.path(), &["directions", "hub.stl", "-o", "found.toml", "--page", "found.html"]);
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && said.contains("It can be welded: ") && said.contains("found.html"), "{said}");
    let page = std::fs::read_to_string(folder.path().join("found.html")).unwrap();
    assert!(page.contains("class=\"card coloured\"") && page.contains("It can be welded: "));
    let plan = |part: &str, how: &[&str]| {
        let all = [&["plan", part, "--no-deposit", "--json", "-o", "out"], how].concat();
        let json: serde_json::Value = serde_json::from_str(&done(folder.path(), &all)).unwrap();
        (json["arc_starts"].as_u64(), json["layers"].as_u64(), json["deposited_volume_mm3"].as_f64())
    };
    let auto = plan("hub.stl", &["--directions", "auto"]);
    assert!(auto.0.is_some() && auto == plan("hub.stl", &["--bodies", "found.toml"]), "{auto:?}");
    assert_eq!(plan("cross", &["--directions", "auto"]), plan("cross", &[]));
    let why = fails(folder.path(), &["plan", "hub.stl", "--directions", "auto", "--bodies", "found.toml"]);
    assert!(why.contains("cannot be used with"), "{why}");
}

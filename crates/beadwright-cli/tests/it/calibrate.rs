//! A cell calibrated from tables of measured points.

use beadwright::robot::Cell;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_beadwright")).current_dir(folder).args(arguments).output().unwrap()
}

fn json(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    let output = run(folder, &[&["calibrate"], arguments, &["--json"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn near(value: &serde_json::Value, expected: &[f64], tolerance: f64) {
    let found: Vec<f64> = value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
    let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off <= tolerance && found.len() == expected.len(), "{found:?} is not {expected:?}");
}

/// The flange of a KUKA above a tip, straight down and leaning by 90° to four sides; the tip of the wire lies 300 mm along the flange's z
/// and 50 mm along its x.
#[test]
fn the_tip_of_the_wire_is_found_from_touches() {
    let folder = TempDir::new().unwrap();
    let table = "x;y;z;a;b;c\n950;0;500;0;0;180\n1000;-50;500;90;0;180\n700;0;150;0;-90;180\n\
                 # leaning about x\n950;-300;200;0;0;-90\n950;300;200;0;0;90\n";
    fs::write(folder.path().join("touches.csv"), table).unwrap();
    let found = json(folder.path(), &["tool", "touches.csv"]);
    near(&found["tip"], &[50.0, 0.0, 300.0], 1e-6);
    near(&found["touched"], &[1000.0, 0.0, 200.0], 1e-6);
    let words = run(folder.path(), &["calibrate", "tool", "touches.csv"]);
    let words = String::from_utf8(words.stdout).unwrap();
    assert!(words.contains("50.000, 0.000, 300.000 mm") && words.contains("residuals"), "{words}");
}

#[test]
fn base_axis_and_scanner_are_found_from_points() {
    let folder = TempDir::new().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("base.csv", "touch,x,y,z\norigin,900,100,400\nx,900,300,400\ntop,850,150,400\n");
    let found = json(folder.path(), &["base", "base.csv"]);
    near(&found["origin"], &[900.0, 100.0, 400.0], 1e-6);
    near(&found["axes"][0], &[0.0, 1.0, 0.0], 1e-9);
    assert!(found["origin_within"].is_null(), "three points say nothing of the errors");
    let words = run(folder.path(), &["calibrate", "base", "base.csv", "--robot", "fanuc"]);
    let words = String::from_utf8(words.stdout).unwrap();
    assert!(words.contains("R 90.0000°") && words.contains("Measure more"), "{words}");
    // About y, 200 mm below the part: a point 150 mm beside the axis.
    write("axis.csv", "angle,x,y,z\n0,150,30,-200\n90,0,30,-350\n-90,0,30,-50\n45,106.066017,30,-306.066017\n");
    let found = json(folder.path(), &["axis", "axis.csv"]);
    near(&found["direction"], &[0.0, 1.0, 0.0], 1e-6);
    near(&found["through"], &[0.0, 30.0, -200.0], 1e-5);
    write("targets.csv", "sx,sy,sz,x,y,z\n0,0,0,10,20,30\n100,0,0,10,120,30\n0,100,0,-90,20,30\n0,0,100,10,20,130\n");
    let found = json(folder.path(), &["scanner", "targets.csv"]);
    near(&found["origin"], &[10.0, 20.0, 30.0], 1e-6);
    near(&found["axes"][0], &[0.0, 1.0, 0.0], 1e-9);
}

#[test]
fn faults_of_a_table_are_named_with_line_and_column() {
    let folder = TempDir::new().unwrap();
    let fails = |name: &str, text: &str, what: &str| {
        fs::write(folder.path().join(name), text).unwrap();
        let output = run(folder.path(), &["calibrate", what, name]);
        assert!(!output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let error = fails("a.csv", "angle,x,y\n0,1,2\n", "axis");
    assert!(error.contains("no column \"z\"") && error.contains("angle, x, y"), "{error}");
    let error = fails("b.csv", "angle,x,y,z\n0,1,2,3\n10,1,two,3\n", "axis");
    assert!(error.contains("line 3") && error.contains("column y"), "{error}");
    let error = fails("c.csv", "touch,x,y,z\ncorner,1,2,3\n", "base");
    assert!(error.contains("\"corner\" is no touch"), "{error}");
    let error = fails("d.csv", "angle,x,y,z\n0,1,2,3\n", "axis");
    assert!(error.contains("1 angles are too few"), "{error}");
}

#[test]
fn a_cell_takes_what_was_measured_and_keeps_its_comments() {
    let folder = TempDir::new().unwrap();
    let at = folder.path();
    let cell = concat!(env!("CARGO_MANIFEST_DIR"), "/../robot/cells/kuka-kr20-r1810.toml");
    let before = fs::read_to_string(cell).unwrap();
    fs::write(at.join("mine.toml"), &before).unwrap();
    let touches = "x,y,z,a,b,c\n950,0,500,0,0,180\n1000,-50,500,90,0,180\n700,0,150,0,-90,180\n950,-300,200,0,0,-90\n";
    fs::write(at.join("touches.csv"), touches).unwrap();
    fs::write(at.join("base.csv"), "touch,x,y,z\norigin,900,100,400\nx,900,300,400\ntop,850,150,400\n").unwrap();
    json(at, &["tool", "touches.csv", "--write", "mine.toml"]);
    json(at, &["base", "base.csv", "--write", "mine.toml"]);
    let after = fs::read_to_string(at.join("mine.toml")).unwrap();
    let cell = Cell::parse(&after).unwrap();
    near(&serde_json::json!(cell.torch.position), &[50.0, 0.0, 300.0], 1e-3);
    near(&serde_json::json!(cell.part.position), &[900.0, 100.0, 400.0], 1e-3);
    assert!((cell.part.rotation - 90.0).abs() < 1e-3, "{}", cell.part.rotation);
    assert_eq!(after.matches('#').count(), before.matches('#').count(), "comments are kept");
    // A table that leans is no place for a part.
    fs::write(at.join("base.csv"), "touch,x,y,z\norigin,900,100,400\nx,900,300,420\ntop,850,150,400\n").unwrap();
    let refused = run(at, &["calibrate", "base", "base.csv", "--write", "mine.toml"]);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(!refused.status.success() && said.contains("the frame is tilted by 8.0°"), "{said}");
    assert_eq!(fs::read_to_string(at.join("mine.toml")).unwrap(), after);
}

/// A table that turns about x 1000, y 50 mm, clockwise as its angle grows; a tilting axis of a positioner; a scanner that looks down.
#[test]
fn axes_and_scanner_are_written_where_they_belong() {
    let folder = TempDir::new().unwrap();
    let at = folder.path();
    let points = |centre: [f64; 3], of: fn(f64) -> [f64; 3]| -> String {
        let row = |angle: f64| {
            let [x, y, z] = of(angle.to_radians());
            format!("{angle},{},{},{}\n", centre[0] + x, centre[1] + y, centre[2] + z)
        };
        "angle,x,y,z\n".to_owned() + &[0.0, 40.0, 90.0, 150.0].map(row).concat()
    };
    let cell = concat!(env!("CARGO_MANIFEST_DIR"), "/../robot/cells/kuka-kr20-r1810.toml");
    let before = fs::read_to_string(cell).unwrap();
    fs::write(at.join("table.csv"), points([1000.0, 50.0, 300.0], |a| [120.0 * a.cos(), -120.0 * a.sin(), 0.0]))
        .unwrap();
    fs::write(at.join("none.toml"), &before).unwrap();
    let fails = |arguments: &[&str]| {
        let output = run(at, &[&["calibrate"], arguments].concat());
        assert!(!output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let said = fails(&["axis", "table.csv", "--write", "none.toml"]);
    assert!(said.contains("none.toml: the cell has no turn table"), "{said}");
    // What the message asks for is enough.
    let asked = before.clone() + "\n[table]\naxis = [0, 0]\ndirection = 1\nlimits = [-180, 180]\n";
    assert!(said.contains("[table] with axis = [0, 0], direction = 1 and its limits, such as [-180, 180]"), "{said}");
    fs::write(at.join("none.toml"), &asked).unwrap();
    json(at, &["axis", "table.csv", "--write", "none.toml"]);
    // A cell with a fault is not taken for a profile.
    fs::write(at.join("faulty.toml"), asked.replace("direction = 1", "direction = 2")).unwrap();
    let said = fails(&["axis", "table.csv", "--write", "faulty.toml"]);
    assert!(said.contains("faulty.toml: line") && said.contains("of the cell: table.direction = 2"), "{said}");
    fs::write(at.join("broken.toml"), asked.replace("[0, 0]", "[0, 0")).unwrap();
    let said = fails(&["axis", "table.csv", "--write", "broken.toml"]);
    assert!(said.contains("broken.toml: line") && said.contains("of the cell"), "{said}");
    let said = fails(&["axis", "table.csv", "--write", "none.toml", "--axis", "2"]);
    assert!(said.contains("none.toml: a cell has only one turn table. Leave out --axis"), "{said}");
    let with_table = before.clone() + "\n[table]\naxis = [0, 0]   # measured\ndirection = 1\nlimits = [-180, 180]\n";
    fs::write(at.join("mine.toml"), &with_table).unwrap();
    json(at, &["axis", "table.csv", "--write", "mine.toml"]);
    let text = fs::read_to_string(at.join("mine.toml")).unwrap();
    let table = Cell::parse(&text).unwrap().table.unwrap();
    near(&serde_json::json!(table.axis), &[1000.0, 50.0], 1e-3);
    assert!(table.direction == -1 && text.contains("# measured"), "{text}");

    fs::write(at.join("tilt.csv"), points([10.0, 0.0, -150.0], |a| [0.0, 80.0 * a.cos(), 80.0 * a.sin()])).unwrap();
    let axes = "axes = [\n  { direction = [1, 0, 0], limits = [-90, 90], speed = 60 },\n  { direction = [0, 0, 1], limits = [-720, 720], speed = 120 },\n]\n";
    let positioner = format!("inherits = \"cmt-steel-robots\"\n[program.positioner]\nturning = \"index\"\n{axes}");
    fs::write(at.join("profile.toml"), &positioner).unwrap();
    let said = fails(&["axis", "tilt.csv", "--write", "mine.toml"]);
    assert!(said.contains("mine.toml: the axis leans by 90.0°"), "{said}");
    // The faults of a profile are named with the file, and nothing else is blamed.
    let faults = [
        ("inherits = \"cmt-steel-robot\"\n", "cmt-steel-robot"),
        ("inherits = \"cmt-steel-robots\"\n[bead]\nwidth = -1\n", "bead.width"),
    ];
    for (head, named) in faults {
        fs::write(at.join("faulty.toml"), positioner.replace("inherits = \"cmt-steel-robots\"\n", head)).unwrap();
        let said = fails(&["axis", "tilt.csv", "--write", "faulty.toml"]);
        assert!(said.contains("faulty.toml: ") && said.contains(named) && !said.contains("has no axis"), "{said}");
    }
    fs::write(at.join("faulty.toml"), positioner.replace("[1, 0, 0]", "[1, 0, 0")).unwrap();
    let said = fails(&["axis", "tilt.csv", "--write", "faulty.toml"]);
    assert!(said.contains("faulty.toml: line 5 of the profile") && !said.contains("has no axis"), "{said}");
    json(at, &["axis", "tilt.csv", "--write", "profile.toml"]);
    json(at, &["axis", "table.csv", "--axis", "2", "--write", "profile.toml"]);
    let text = fs::read_to_string(at.join("profile.toml")).unwrap();
    for wanted in [
        "direction = [1.000000, 0.000000, 0.000000]",
        "through = [10.000, 0.000, -150.000]",
        "direction = [0.000000, 0.000000, -1.000000]",
        "through = [1000.000, 50.000, 300.000]",
        "limits = [-720, 720], speed = 120",
    ] {
        assert!(text.contains(wanted), "{wanted}: {text}");
    }
    fs::write(
        at.join("machine.toml"),
        "inherits = \"cmt-steel-robots\"\n[program.positioner]\nmachine = \"kuka-dkp-400\"\n",
    )
    .unwrap();
    let said = fails(&["axis", "tilt.csv", "--write", "machine.toml"]);
    assert!(
        said.contains("machine.toml: program.positioner.axes has no axis 1")
            && said.contains("profile positioner NAME"),
        "{said}"
    );

    let targets =
        "sx,sy,sz,x,y,z\n0,0,390,900,100,410\n100,0,390,1000,100,410\n0,100,390,900,0,410\n0,0,290,900,100,510\n";
    fs::write(at.join("targets.csv"), targets).unwrap();
    json(at, &["scanner", "targets.csv", "--write", "mine.toml"]);
    let cell = Cell::parse(&fs::read_to_string(at.join("mine.toml")).unwrap()).unwrap();
    near(&serde_json::json!(cell.scanner.unwrap().position), &[900.0, 100.0, 800.0], 1e-3);
    near(&serde_json::json!(cell.scanner.unwrap().rotation.map(f64::abs)), &[0.0, 0.0, 180.0], 1e-3);
}

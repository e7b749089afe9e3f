//! The command as people run it: files, messages, exit status, and nothing half-written.

use crate::common::{beadwright, ok, refused};
use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use tempfile::TempDir;

fn folder_with(example: &str) -> TempDir {
    let folder = TempDir::new().unwrap();
    ok(folder.path(), &["example", example]);
    folder
}

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let name = |p: &PathBuf| p.file_name().unwrap().to_str().unwrap().to_owned();
    entries.filter(|p| p.is_file()).map(|p| (name(&p), fs::read(&p).unwrap())).collect()
}

#[test]
fn plan_writes_program_plan_metrics_and_report() {
    let folder = folder_with("cross");
    let said = ok(folder.path(), &["plan", "cross.stl", "-o", "out/deep", "--post", "krl", "--picture", "2"]);
    assert!(said.contains("passes (arc starts)") && said.contains("covered / slice area"), "{said}");
    let written = files(&folder.path().join("out/deep"));
    let expected =
        ["CROSS.dat", "CROSS.src", "CROSS_L001.src", "layer-002.svg", "metrics.json", "plan.json", "report.html"];
    for name in expected {
        assert!(written.get(name).is_some_and(|bytes| !bytes.is_empty()), "{name} is missing or empty");
    }
    let plan: serde_json::Value = serde_json::from_slice(&written["plan.json"]).unwrap();
    let metrics: serde_json::Value = serde_json::from_slice(&written["metrics.json"]).unwrap();
    assert_eq!(plan["layers"].as_array().unwrap().len(), 10);
    let passes: usize = plan["layers"].as_array().unwrap().iter().map(|l| l["passes"].as_array().unwrap().len()).sum();
    assert_eq!(metrics["arc_starts"].as_u64(), Some(passes as u64));
    assert!(fs::read_dir(folder.path()).unwrap().all(|e| !e.unwrap().file_name().to_str().unwrap().starts_with('.')));
}

#[test]
fn a_rapid_program_is_written_and_simulated() {
    let folder = folder_with("cross");
    for (variant, setting) in
        [("arc", "rapid.modules=load"), ("plain", "rapid.arc=plain"), ("call", "rapid.modules=call")]
    {
        let plan = ["plan", "cross.stl", "-p", "cmt-steel-abb", "--post", "rapid", "-o", variant, "--set", setting];
        ok(folder.path(), &[&plan[..], &["--no-deposit"]].concat());
        let written = files(&folder.path().join(variant));
        assert!(["cross.mod", "cross.pgf", "cross_L011.mod"].iter().all(|name| written.contains_key(*name)));
        let metrics: serde_json::Value = serde_json::from_slice(&written["metrics.json"]).unwrap();
        let program = format!("{variant}/cross.mod");
        let json = ok(folder.path(), &["simulate", &program, "-p", "cmt-steel-abb", "--grid", "1", "--json"]);
        let totals = &serde_json::from_str::<serde_json::Value>(&json).unwrap()["totals"];
        assert_eq!(totals["arc_starts"], metrics["arc_starts"], "{variant}");
        let length = |value: &serde_json::Value| value["deposited_length_mm"].as_f64().unwrap();
        assert!((length(totals) / length(&metrics) - 1.0).abs() < 1e-5, "{variant}");
    }
}

#[test]
fn one_and_two_threads_write_the_same_bytes() {
    let folder = folder_with("propeller");
    for threads in ["1", "2"] {
        let posts = ["--post", "krl", "--post", "gcode"];
        let plan = [
            "plan",
            "propeller.stl",
            "-p",
            "both.toml",
            "--threads",
            threads,
            "-o",
            threads,
            "--set",
            "layers.height=0.4",
        ];
        let krl = ok(folder.path(), &["profile", "show", "cmt-al2319-kuka"]);
        let cnc = ok(folder.path(), &["profile", "show", "plasma-304-cnc"]);
        let gcode = &cnc[cnc.find("[gcode]").unwrap()..];
        fs::write(folder.path().join("both.toml"), format!("{krl}\n{gcode}")).unwrap();
        ok(folder.path(), &[&plan[..], &posts[..]].concat());
    }
    let (one, two) = (files(&folder.path().join("1")), files(&folder.path().join("2")));
    assert!(one.len() > 50 && one.contains_key("propeller.nc") && one.contains_key("PROPELLER_L040.src"));
    assert!(one == two, "the files differ");
}

#[test]
fn a_refused_model_leaves_nothing_behind() {
    let folder = TempDir::new().unwrap();
    for (name, bytes, part) in [
        ("empty.stl", &b""[..], "empty"),
        ("text.stl", b"hello, this is a letter and not a model", "not an STL"),
        ("part.3mf", b"PK\x03\x04....", "the 3MF file cannot be read"),
        ("cut.stl", b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "line 5"),
    ] {
        fs::write(folder.path().join(name), bytes).unwrap();
        let said = refused(folder.path(), &["plan", name, "-o", "out"], 1);
        assert!(said.starts_with("error: ") && said.contains(name) && said.contains(part), "{said}");
        assert!(said.lines().count() == 1, "{said}");
        assert!(!folder.path().join("out").exists());
    }
    assert!(refused(folder.path(), &["plan", "missing.stl"], 1).contains("missing.stl"));
    assert!(refused(folder.path(), &["plan", "."], 1).contains("folder"));
}

#[test]
fn what_cannot_be_written_is_refused_before_anything_is() {
    let folder = folder_with("cross");
    let out = folder.path().join("out");
    let said = refused(folder.path(), &["plan", "cross.stl", "-o", "out", "--post", "krl", "--post", "krl"], 1);
    assert!(said.contains("both write CROSS"), "{said}");
    let said = refused(folder.path(), &["plan", "cross.stl", "-o", "out", "--no-deposit", "--picture", "99"], 1);
    assert!(said.contains("the part has the layers 1 to 10"), "{said}");
    assert!(!out.exists());
}

#[test]
fn small_parts_are_asked_about_their_unit() {
    let folder = folder_with("cross");
    let said = refused(folder.path(), &["plan", "cross.stl", "--scale", "0.05"], 1);
    assert!(said.contains("--units in") && said.contains("5.00 × 5.00 × 1.00"), "{said}");
    let json = ok(folder.path(), &["plan", "cross.stl", "--scale", "0.05", "--units", "in", "--json"]);
    let metrics: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert!(metrics["part_volume_mm3"].as_f64().unwrap() > 1e5);
}

#[test]
fn wrong_usage_and_wrong_values_are_told_apart() {
    let folder = folder_with("cross");
    refused(folder.path(), &["plan"], 2);
    refused(folder.path(), &["weld", "cross.stl"], 2);
    refused(folder.path(), &["plan", "cross.stl", "--units", "ell"], 2);
    let said = refused(folder.path(), &["plan", "cross.stl", "--strategy", "zigzg"], 2);
    assert!(said.contains("Did you mean \"zigzag\"? The strategies are loop, raster, zigzag, contour"), "{said}");
    for (arguments, part) in [
        (&["-p", "cmt-al2319-kuke"][..], "Did you mean \"cmt-al2319-kuka\"?"),
        (&["--post", "kawasaki"], "The posts are krl, gcode, marlin, rapid, fanuc, inform, urscript."),
        (&["--post", "fanuc"], "cmt-steel-robots"),
        (&["--post", "rapid"], "cmt-steel-abb"),
        (&["--post", "gcode"], "plasma-304-cnc"),
        (&["--set", "fill.raster_angel=4"], "Did you mean \"raster_angle\"?"),
        (&["--set", "bead.width=-1"], "bead.width = -1"),
        (&["--set", "layers.height=0.0000001"], "layers.height"),
        (&["-p", "no-such-file.toml"], "no-such-file.toml"),
    ] {
        let said = refused(folder.path(), &[&["plan", "cross.stl"], arguments].concat(), 1);
        assert!(said.contains(part), "{arguments:?}: {said}");
    }
    assert!(refused(folder.path(), &["example", "cube"], 1).contains("propeller"));
}

#[test]
fn settings_reach_the_plan() {
    let folder = folder_with("cross");
    let passes = |set: &str| {
        let json = ok(folder.path(), &["plan", "cross.stl", "--json", "-s", "contour", "--set", set]);
        serde_json::from_str::<serde_json::Value>(&json).unwrap()["layers"].as_u64().unwrap()
    };
    assert_eq!((passes("layers.height=2"), passes("layers.height=4")), (10, 5));
}

#[test]
fn interrupting_leaves_nothing_behind() {
    let folder = folder_with("vase");
    let fine =
        ["--set", "layers.height=0.02", "--set", "bead.width=0.5", "--set", "fill.min_pass_length=0", "-o", "out"];
    let mut child = Command::new(env!("CARGO_BIN_EXE_beadwright"))
        .current_dir(folder.path())
        .args([&["plan", "vase.stl"][..], &fine].concat())
        .stderr(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    // Wait until it has begun to write.
    let writing = || {
        fs::read_dir(folder.path())
            .unwrap()
            .any(|e| e.unwrap().file_name().to_str().unwrap().starts_with(".beadwright-"))
    };
    while !writing() {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it could be interrupted");
        std::thread::yield_now();
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("cancelled"));
    let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(left, ["vase.stl"]);
}

#[test]
fn profiles_are_listed_shown_checked_and_described() {
    let folder = TempDir::new().unwrap();
    assert!(ok(folder.path(), &["profile", "list"]).contains("plasma-304-cnc"));
    let text = ok(folder.path(), &["profile", "show", "cmt-al2319-kuka"]);
    let broken = text.replace("deposition_speed = 10.5", "deposition_sped = 10.5");
    let line = broken.lines().position(|l| l.starts_with("deposition_sped")).unwrap() + 1;
    fs::write(folder.path().join("own.toml"), &text).unwrap();
    fs::write(folder.path().join("broken.toml"), broken).unwrap();
    assert!(ok(folder.path(), &["profile", "check", "own.toml"]).contains("every value is valid"));
    let said = refused(folder.path(), &["profile", "check", "broken.toml"], 1);
    assert!(said.contains(&format!("line {line} ")) && said.contains("\"deposition_speed\""), "{said}");
    let schema: serde_json::Value = serde_json::from_str(&ok(folder.path(), &["profile", "schema"])).unwrap();
    assert!(schema["properties"]["wire"].is_object());
}

#[test]
fn inspect_says_what_a_mesh_holds() {
    let folder = folder_with("gear");
    let json: serde_json::Value = serde_json::from_str(&ok(folder.path(), &["inspect", "gear.stl", "--json"])).unwrap();
    assert_eq!((json["format"].as_str(), json["repair"]["shells"].as_u64()), (Some("binary STL"), Some(1)));
    assert!(ok(folder.path(), &["inspect", "gear.stl"]).contains("closed and clean"));
}

/// Every model of the shared folder plans or is refused with one clear error. Without judging, which takes longer than planning and
/// refuses nothing.
#[test]
#[cfg_attr(no_models, ignore = "no shared models")]
fn every_shared_model_plans_or_is_refused() {
    let workspace = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    let folder = std::env::var("BEADWRIGHT_MODELS").unwrap_or_else(|_| format!("{workspace}/../shared/models"));
    let entries = fs::read_dir(&folder).expect("BEADWRIGHT_MODELS names the folder of shared models");
    let out = TempDir::new().unwrap();
    for path in entries.map(|e| fs::canonicalize(e.unwrap().path()).unwrap()) {
        let output =
            beadwright(out.path(), &["plan", path.to_str().unwrap(), "-p", "plasma-304-cnc", "--no-deposit", "--json"]);
        let said = String::from_utf8_lossy(&output.stderr);
        match output.status.code() {
            Some(0) => {}
            Some(1) => assert!(said.starts_with("error: ") && said.lines().count() == 1, "{}: {said}", path.display()),
            Some(3) => {
                let reason = said.contains("no bead lies below")
                    || said.contains("above the plate")
                    || said.contains("over nothing");
                assert!(reason && said.contains(" z "), "{}: {said}", path.display());
            }
            code => panic!("{}: {code:?} {said}", path.display()),
        }
    }
}

/// `plan` says all that `check` finds in the plan just written, and the report shows it.
#[test]
fn check_adds_nothing_to_a_plan_just_written() {
    let out = TempDir::new().unwrap();
    for (part, strategy, set) in [
        ("cross", "loop", "check.max_void=0.01"),
        ("gear", "contour", "check.max_void=0.5"),
        ("propeller", "raster", "check.max_overfill=0.1"),
        ("star", "zigzag", "check.max_heat_input=1"),
    ] {
        let name = format!("{part}.stl");
        ok(out.path(), &["example", part, "-o", &name]);
        let settings = ["-p", "cmt-al2319-kuka", "-s", strategy, "--set", set];
        let planned = beadwright(out.path(), &[&["plan", &name, "-o", "out"], &settings[..]].concat());
        let said = String::from_utf8_lossy(&planned.stderr) + String::from_utf8_lossy(&planned.stdout);
        let metrics = fs::read_to_string(out.path().join("out/metrics.json")).unwrap();
        let metrics: serde_json::Value = serde_json::from_str(&metrics).unwrap();
        let checked = beadwright(out.path(), &["check", "out/plan.json", "--json"]);
        let found: Vec<serde_json::Value> = serde_json::from_slice(&checked.stdout).unwrap();
        let report = fs::read_to_string(out.path().join("out/report.html")).unwrap();
        let listed = metrics["findings"].as_array().unwrap();
        // The same list everywhere, the worst first; each check once, with as many as `check` finds.
        let order = ["serious", "doubt", "note"].map(|word| listed.iter().rposition(|f| f["severity"] == word));
        let firsts = ["serious", "doubt", "note"].map(|word| listed.iter().position(|f| f["severity"] == word));
        assert!(
            order[0] < firsts[1].or(Some(usize::MAX)) && order[1] < firsts[2].or(Some(usize::MAX)),
            "{part}: {listed:?}"
        );
        for finding in listed {
            let text = finding["text"].as_str().unwrap();
            assert!(said.contains(text), "{part}: {text}\n{said}");
        }
        // The report lists them one by one.
        let warned =
            |f: &&serde_json::Value| ["overhang", "layers", "short-arc"].contains(&f["kind"].as_str().unwrap());
        for finding in listed.iter().filter(|f| f["count"] == 1).chain(found.iter().filter(|f| !warned(f))) {
            let text = finding["text"].as_str().unwrap();
            let escaped = text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
            assert!(report.contains(&escaped), "{part}: {text}");
        }
        for kind in found.iter().map(|f| f["kind"].as_str().unwrap()) {
            // Warnings of the plan say these.
            if !["overhang", "layers", "short-arc"].contains(&kind) {
                let check = listed.iter().find(|f| f["kind"] == kind).unwrap();
                let own = found.iter().filter(|f| f["kind"] == kind).count();
                assert_eq!(check["count"].as_u64().unwrap() as usize, own, "{part}: {kind}");
                assert!(said.contains(&format!(": {kind}: ")), "{part}: {said}");
            }
        }
    }
}

#[test]
fn plans_and_programs_are_simulated_alike() {
    let folder = folder_with("cross");
    let planned = ok(
        folder.path(),
        &["plan", "cross.stl", "-p", "plasma-304-cnc", "-o", "out", "--json", "--set", "fill.raster_turn=\"fixed\""],
    );
    let planned: serde_json::Value = serde_json::from_str(&planned).unwrap();
    let simulate = |file: &str| -> serde_json::Value {
        let more = ["--model", "cross.stl", "-p", "plasma-304-cnc", "--json", "-o", "sim.html"];
        serde_json::from_str(&ok(folder.path(), &[&["simulate", file], &more[..]].concat())).unwrap()
    };
    let (plan, program) = (simulate("out/plan.json"), simulate("out/cross.nc"));
    for name in ["void_percent", "low_percent", "overfill_percent", "outside_percent", "mean_height_mm"] {
        let value = |json: &serde_json::Value| json["deposit"][name].as_f64().unwrap();
        // The file keeps a tenth of a micrometre.
        assert!((value(&plan) - value(&planned)).abs() < 1e-3, "{name}");
        assert!((value(&program) - value(&planned)).abs() < 0.02, "{name}");
    }
    assert_eq!(plan["totals"]["arc_starts"], planned["arc_starts"]);
    assert_eq!(program["totals"]["arc_starts"], planned["arc_starts"]);
    assert!(fs::read_to_string(folder.path().join("sim.html")).unwrap().contains("</html>"));
    fs::write(folder.path().join("bad.nc"), "G1 X1 Y2\nG1 X10 Yten\n").unwrap();
    assert!(refused(folder.path(), &["simulate", "bad.nc"], 1).contains("line 2"));
    fs::write(folder.path().join("dry.nc"), "G0 X1 Y2\nG1 X10\n").unwrap();
    assert!(refused(folder.path(), &["simulate", "dry.nc"], 1).contains("--arc-on"));
}

#[test]
fn strategies_are_compared() {
    let folder = folder_with("star");
    let arguments = ["compare", "star.stl", "--layers", "2,4-5", "-s", "contour", "-s", "compound", "-o", "c.html"];
    let table = ok(folder.path(), &arguments);
    assert!(table.contains("contour") && table.contains("compound") && table.contains("void %") && table.contains('*'));
    let page = fs::read_to_string(folder.path().join("c.html")).unwrap();
    assert!(page.contains("layer 4, z ") && !page.contains("layer 3,"));
    assert!(refused(folder.path(), &["compare", "star.stl", "--layers", "0"], 2).contains("counted from 1"));
}

#[test]
fn the_paper_on_compound_paths_is_reproduced() {
    let folder = TempDir::new().unwrap();
    let said = ok(folder.path(), &["reproduce", "c-compound", "-o", "papers"]);
    assert!(said.contains("void at 0.738 w over void at 0.591 w, at least 5: 30.4"));
    assert!(folder.path().join("papers/reproduce-c-compound.html").is_file());
    assert!(refused(folder.path(), &["reproduce", "x"], 1).contains("c-compound"));
}

#[test]
fn the_paper_on_skeletons_is_reproduced() {
    let folder = TempDir::new().unwrap();
    let said = ok(folder.path(), &["reproduce", "a-skeleton-hybrid", "-o", "papers"]);
    assert!(said.contains("10.5 mm/s fits"), "{said}");
    let written = files(&folder.path().join("papers"));
    assert!(written.contains_key("PROPELLER.src") && written.contains_key("PROPELLER_L010.src"));
}

#[test]
fn beads_are_fitted_predicted_and_found() {
    let folder = TempDir::new().unwrap();
    let path = folder.path();
    assert!(ok(path, &["bead", "example"]).contains("SYNTHETIC"));
    let said = ok(path, &["bead", "fit", "bead-example.csv", "-o", "lib.toml", "--plot", "window.svg"]);
    assert!(said.starts_with("SYNTHETIC") && said.contains("leave-one-out") && said.contains("60 to 250 A"), "{said}");
    assert!(fs::read_to_string(path.join("window.svg")).unwrap().contains("SYNTHETIC"));
    let json = |arguments: &[&str]| -> serde_json::Value { serde_json::from_str(&ok(path, arguments)).unwrap() };
    let recipe = json(&["bead", "solve", "lib.toml", "--width", "4.5", "--layer-height", "1.4", "--json"]);
    assert!((recipe["layer_height_mm"].as_f64().unwrap() - 1.4).abs() < 1e-6 && recipe["synthetic"] == true);
    let value = |name: &str| format!("{name}={}", recipe["parameters"][name]["value"]);
    let again = json(&["bead", "predict", "lib.toml", &value("current"), &value("deposition_speed"), "--json"]);
    assert!((again["width_mm"]["value"].as_f64().unwrap() - 4.5).abs() < 1e-6);
    for (arguments, part) in [
        (&["predict", "lib.toml", "current=300", "deposition_speed=8"][..], "above the measured range of 60 to 250 A"),
        (&["predict", "lib.toml", "current=100"], "a value for deposition_speed is missing"),
        (&["predict", "bead-example.csv", "current=100"], "bead-example.csv: this is not a bead library"),
        (
            &["solve", "lib.toml", "--width", "30", "--layer-height", "5"],
            "out of reach: current would have to be above",
        ),
        (&["solve", "lib.toml", "--width", "5", "--layer-height", "1", "--overlap", "much"], "tangent"),
        (&["fit", "missing.csv"], "missing.csv: "),
    ] {
        let said = refused(path, &[&["bead"], arguments].concat(), 1);
        assert!(said.starts_with("error: ") && said.contains(part) && said.lines().count() == 1, "{said}");
    }
    fs::write(path.join("bad.csv"), "current_a,width_mm,height_mm\n100,5,2\n1o0,5,2\n").unwrap();
    assert!(refused(path, &["bead", "fit", "bad.csv", "-o", "bad.toml"], 1).contains("bad.csv: line 3, column"));
    assert!(!path.join("bad.toml").exists());
    refused(path, &["bead", "predict", "lib.toml", "current"], 2);
}

#[test]
fn curves_are_inspected_and_welded_as_walls() {
    let folder = TempDir::new().unwrap();
    ok(folder.path(), &["example", "tian", "-o", "tian.igs"]);
    assert!(ok(folder.path(), &["inspect", "tian.igs"]).contains("6 curves, 6 of them independent"));
    let said = refused(folder.path(), &["plan", "tian.igs"], 1);
    assert!(said.contains("say how high the part is") && said.contains("--height"), "{said}");
    let said = ok(folder.path(), &["plan", "tian.igs", "-p", "cmt-steel-abb", "--height", "26", "-o", "out"]);
    assert!(said.contains("6 centre-lines") && said.contains("strategy wall"), "{said}");
    assert!(files(&folder.path().join("out")).contains_key("tian.mod"));
    assert!(refused(folder.path(), &["compare", "tian.igs"], 1).contains("here a solid is needed"));
    assert!(refused(folder.path(), &["example", "cross", "-o", "cross.igs"], 1).contains("not a thin wall"));
}

#[test]
fn reach_gives_margins_and_refuses_what_is_too_far() {
    let folder = folder_with("cross");
    ok(folder.path(), &["plan", "cross.stl", "-o", "out", "--no-deposit"]);
    let reach = ["reach", "out/plan.json", "--cell", "kuka-kr20-r1810"];
    let said = ok(folder.path(), &[&reach[..], &["-o", "reach.html", "--suggest"]].concat());
    assert!(said.contains("least margin") && said.contains("The part is well placed"), "{said}");
    assert!(files(folder.path())["reach.html"].len() > 10_000);
    let json = ok(folder.path(), &[&reach[..], &["--json"]].concat());
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert!(json["reachable"] == true && json["least_margin"].as_f64().unwrap() > 30.0, "{json}");
    assert!(json["misfits"].as_array().unwrap().is_empty() && !said.contains("note: The profile"), "{said}");
    // A robot of another make would not read the program.
    let said = ok(folder.path(), &["reach", "out/plan.json", "--cell", "ur10e"]);
    assert!(said.contains("note: The profile writes krl, but the robot of this cell reads urscript"), "{said}");
    let error = refused(folder.path(), &[&reach[..], &["--at", "3000,0,500"]].concat(), 1);
    assert!(error.contains("Layer 1, pass 1, point 1") && error.contains("out of reach"), "{error}");
    let error = refused(folder.path(), &["reach", "out/plan.json", "--cell", "kuka"], 1);
    assert!(error.contains("kuka-kr20-r1810"), "{error}");
    refused(folder.path(), &["reach", "out/plan.json"], 2);
    refused(folder.path(), &[&reach[..], &["--at", "3000"]].concat(), 2);
    assert!(ok(folder.path(), &["reach", "--list"]).contains("abb-irb1410"));
    let cell = ok(folder.path(), &["reach", "--show", "abb-irb1410"]);
    fs::write(folder.path().join("mine.toml"), cell.replace("c2 = 600.0", "c2 = -1.0")).unwrap();
    let error = refused(folder.path(), &["reach", "out/plan.json", "--cell", "mine.toml"], 1);
    assert!(error.contains("line 13") && error.contains("arm.c2"), "{error}");
    assert!(ok(folder.path(), &["reach", "--list"]).contains("ur10e"));
    fs::write(folder.path().join("arm.urdf"), "<robot name=\"none\"/>").unwrap();
    let error = refused(folder.path(), &[&reach[..], &["--urdf", "arm.urdf"]].concat(), 1);
    assert!(error.contains("arm.urdf") && error.contains("no joints"), "{error}");
    // A cell names the file beside it, wherever the command is called.
    fs::create_dir(folder.path().join("cells")).unwrap();
    let start = cell.find("[arm]").unwrap();
    let end = cell.find("[torch]").unwrap();
    let named = format!("{}[arm]\nurdf = \"arm.urdf\"\n\n{}", &cell[..start], &cell[end..]);
    fs::write(folder.path().join("cells/mine.toml"), &named).unwrap();
    let mine = ["reach", "out/plan.json", "--cell", "cells/mine.toml"];
    assert!(refused(folder.path(), &mine, 1).contains("cells/arm.urdf"));
    fs::copy(folder.path().join("arm.urdf"), folder.path().join("cells/arm.urdf")).unwrap();
    assert!(refused(folder.path(), &mine, 1).contains("no joints"));
}

/// Runs only where LinuxCNC's stand-alone interpreter is installed (Debian: linuxcnc-uspace), and says so.
#[test]
fn linuxcnc_interprets_the_gcode() {
    if Command::new("rs274").arg("-h").output().is_err() {
        eprintln!("skipped: rs274 is not installed (apt-get install linuxcnc-uspace)");
        return;
    }
    let folder = folder_with("cross");
    for more in [&[][..], &["--set", "program.chord_tolerance=0.05", "--set", "program.arcs=true"]] {
        let plan = ["plan", "cross.stl", "-p", "plasma-304-cnc", "--no-deposit", "-o", "out"];
        ok(folder.path(), &[&plan[..], more].concat());
        let metrics: serde_json::Value =
            serde_json::from_slice(&fs::read(folder.path().join("out/metrics.json")).unwrap()).unwrap();
        let run = Command::new("rs274").arg("-g").arg(folder.path().join("out/cross.nc")).output().unwrap();
        let canon = String::from_utf8_lossy(&run.stdout);
        assert!(run.status.success(), "{canon}");

        let starts = canon.matches("START_SPINDLE_CLOCKWISE").count();
        assert_eq!(starts as u64, metrics["arc_starts"].as_u64().unwrap());
    }
}

#[test]
fn plans_are_checked() {
    let folder = folder_with("cross");
    ok(folder.path(), &["plan", "cross.stl", "-s", "hybrid", "--no-deposit", "-o", "out"]);
    let cell = ok(folder.path(), &["reach", "--show", "kuka-kr20-r1810"]);
    fs::write(folder.path().join("cell.toml"), cell.replace("by = \"joint\"", "by = \"line\"")).unwrap();
    let check = ["check", "out/plan.json", "--cell", "kuka-kr20-r1810"];
    assert!(ok(folder.path(), &check).contains("nothing found"));
    // A straight move from home, where the wrist is singular.
    let output = beadwright(folder.path(), &["check", "out/plan.json", "--cell", "cell.toml"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.code() == Some(3) && said.contains("reach (2): "), "{said}");
    assert!(said.contains("from home to the first point") && said.contains("on a straight move"), "{said}");
    assert!(ok(folder.path(), &["check"]).contains("stacked-starts: "));
    // Half the wire does not fill the beads.
    let output = beadwright(folder.path(), &[&check[..], &["--set", "process.wire_feed_speed=3"]].concat());
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        output.status.code() == Some(3)
            && said.contains("wire-balance (1)")
            && said.contains("Use the deposition speed"),
        "{said}"
    );
    // A cell with the part far away.
    fs::write(folder.path().join("far.toml"), cell.replace("[1200.0, 0.0, 500.0]", "[4200.0, 0.0, 500.0]")).unwrap();
    let output = beadwright(folder.path(), &["check", "out/plan.json", "--cell", "far.toml"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.code() == Some(3) && said.contains("out of reach"), "{said}");
    assert!(refused(folder.path(), &["check", "cross.stl"], 1).contains("cross.stl"));
}

#[test]
fn a_build_is_resumed_at_a_layer() {
    let folder = folder_with("cross");
    let plan = ["plan", "cross.stl", "--post", "krl", "--no-deposit", "-s", "contour"];
    ok(folder.path(), &[&plan[..], &["-o", "all"]].concat());
    ok(folder.path(), &[&plan[..], &["-o", "rest", "--from-layer", "4"]].concat());
    let (all, rest) = (files(&folder.path().join("all")), files(&folder.path().join("rest")));
    assert_eq!(all["plan.json"], rest["plan.json"]);
    let modules = |files: &BTreeMap<String, Vec<u8>>| files.keys().filter(|name| name.contains("_L0")).count();
    assert_eq!(modules(&rest) + 3, modules(&all));
    let main = String::from_utf8(rest["CROSS.src"].clone()).unwrap();
    assert!(!main.contains("CROSS_L003( )") && main.contains("CROSS_L004( )"), "{main}");
    // All but the way to the first pass is the same.
    let tail = |files: &BTreeMap<String, Vec<u8>>| String::from_utf8(files["CROSS_L005.src"].clone()).unwrap();
    assert_eq!(tail(&all), tail(&rest));
    // Totals are of what remains, and of the whole.
    let metrics = |name: &str| -> serde_json::Value {
        serde_json::from_slice(&files(&folder.path().join(name))["metrics.json"]).unwrap()
    };
    let (whole, part) = (metrics("all"), metrics("rest")["programs"].clone());
    assert!(
        whole.get("programs").is_none() && part["layers"].as_u64() == whole["layers"].as_u64().map(|all| all - 3),
        "{part}"
    );
    ok(folder.path(), &[&plan[..], &["-o", "some", "--layers", "2,4-5"]].concat());
    let (some, chosen) = (files(&folder.path().join("some")), metrics("some")["programs"].clone());
    let layers: Vec<&String> = some.keys().filter(|name| name.contains("_L0")).collect();
    assert_eq!(layers, ["CROSS_L002.src", "CROSS_L004.src", "CROSS_L005.src"]);
    let wire = |totals: &serde_json::Value| totals["wire_length_m"].as_f64().unwrap();
    assert!((wire(&part) / wire(&whole) - 0.7).abs() < 0.01 && (wire(&chosen) / wire(&whole) - 0.3).abs() < 0.01);
    let said = ok(folder.path(), &[&plan[..], &["-o", "rest", "--from-layer", "4"]].concat());
    assert!(said.contains("the programs weld 7 of 10 layers") && said.contains("the whole plan:"), "{said}");
    assert!(
        refused(folder.path(), &[&plan[..], &["-o", "x", "--layers", "3,11"]].concat(), 1)
            .contains("layer 11 lies above")
    );
    let last = ["-o", "last", "--from-layer", "4", "--from-pass", "3"];
    ok(folder.path(), &[&plan[..], &last].concat());
    let resumed = String::from_utf8(files(&folder.path().join("last"))["CROSS_L004.src"].clone()).unwrap();
    assert!(!resumed.contains("; pass 2 ") && resumed.contains("; pass 3 "), "{resumed}");
    let beyond = ["-o", "none", "--from-layer", "4", "--from-pass", "77"];
    assert!(
        refused(folder.path(), &[&plan[..], &beyond].concat(), 1).contains("the passes of layer 4 are numbered 1 to")
    );
    let said = refused(folder.path(), &[&plan[..], &["-o", "none", "--from-layer", "99"]].concat(), 1);
    assert!(said.contains("lies above the part") && !folder.path().join("none").join("plan.json").exists(), "{said}");
}

/// An example part is planned by its name, files go into folders that are not there yet, and open surfaces are asked about.
#[test]
fn what_people_type_first_works() {
    let folder = TempDir::new().unwrap();
    let said = ok(folder.path(), &["plan", "star", "--no-deposit"]);
    assert!(said.starts_with("star ") && folder.path().join("beadwright-out/plan.json").exists(), "{said}");
    ok(folder.path(), &["export", "beadwright-out/plan.json", "-o", "new/folder/beads.csv"]);
    assert!(folder.path().join("new/folder/beads.csv").exists());
    // A file of that name comes first.
    fs::write(folder.path().join("gear"), "no model").unwrap();
    assert!(refused(folder.path(), &["plan", "gear"], 1).contains("gear"));
    assert!(refused(folder.path(), &["plan", "no_such_part"], 1).contains("no_such_part"));
    // A roof without walls: two triangles.
    let roof = "v 0 0 0\nv 90 0 0\nv 90 0 60\nv 0 0 60\nf 1 2 3\nf 1 3 4\n";
    fs::write(folder.path().join("sheet.obj"), roof).unwrap();
    assert!(refused(folder.path(), &["plan", "sheet.obj"], 1).contains("--surface wall"));
    let said = ok(folder.path(), &["plan", "sheet.obj", "--surface", "wall", "--no-deposit"]);
    assert!(said.contains("strategy wall"), "{said}");
}

/// With words of one's own the arc is theirs alone, and a rapid lays nothing.
#[test]
fn words_that_are_given_replace_those_of_the_language() {
    let folder = TempDir::new().unwrap();
    let program = "G21\nM3 S1000\nG0 X0 Y0 Z2\nM64 P1\nG1 X50 F600\nG0 X60\nG1 X90 F600\nM65 P1\nG1 X95\nM5\nM2\n";
    fs::write(folder.path().join("a.nc"), program).unwrap();
    let length = |more: &[&str]| {
        let said = ok(folder.path(), &[&["simulate", "a.nc", "--json", "-o", "a.html"], more].concat());
        let said: serde_json::Value = serde_json::from_str(&said).unwrap();
        said["totals"]["deposited_length_mm"].as_f64().unwrap()
    };
    assert!((length(&["--arc-on", "M64 P1", "--arc-off", "M65 P1"]) - 80.0).abs() < 1e-6);
    // M3 to M5, the rapids apart.
    assert!((length(&[]) - 85.0).abs() < 1e-6);
}

#[test]
fn a_dry_run_has_names_of_its_own_and_no_arc() {
    let folder = folder_with("cross");
    let ends = ["--set", "start_stop.end_overlap=5", "--set", "start_stop.min_layer_time=900"];
    let plan = [&["plan", "cross.stl", "--post", "krl", "--no-deposit"][..], &ends[..]].concat();
    let said = ok(folder.path(), &[&plan[..], &["-o", "hot"]].concat());
    assert!(said.contains("waits "), "{said}");
    ok(folder.path(), &[&plan[..], &["-o", "dry", "--dry-run"]].concat());
    let (hot, dry) = (files(&folder.path().join("hot")), files(&folder.path().join("dry")));
    assert_eq!(hot["plan.json"], dry["plan.json"]);
    // But for the names of its files.
    let metrics = |files: &BTreeMap<String, Vec<u8>>| {
        let mut value: serde_json::Value = serde_json::from_slice(&files["metrics.json"]).unwrap();
        value.as_object_mut().unwrap().remove("files").unwrap();
        value
    };
    assert_eq!(metrics(&hot), metrics(&dry));
    let text = |files: &BTreeMap<String, Vec<u8>>, name: &str| String::from_utf8(files[name].clone()).unwrap();
    let (hot, dry) = (text(&hot, "CROSS_L002.src"), text(&dry, "DRY_CROSS_L002.src"));
    let moves = |text: &str| text.lines().filter(|l| l.starts_with("LIN ")).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(moves(&hot), moves(&dry));
    assert!(hot.contains("$OUT[2] = TRUE") && hot.contains("WAIT SEC ") && !hot.contains("DRY RUN"));
    assert!(!dry.contains("$OUT") && !dry.contains("WAIT SEC ") && dry.contains("DRY RUN"), "{dry}");
}

#[test]
fn programs_of_every_robot_are_simulated_and_inspected() {
    let folder = folder_with("cross");
    let posts = ["--post", "fanuc", "--post", "inform", "--post", "urscript"];
    let one_volume = ["--set", "urscript.max_megabytes=8"];
    let plan = ["plan", "cross.stl", "-p", "cmt-steel-robots", "-o", "out", "--no-deposit"];
    ok(folder.path(), &[&plan[..], &posts, &one_volume].concat());
    let json = |command: &str, file: &str| -> serde_json::Value {
        let more: &[&str] = if command == "simulate" { &["--grid", "2"] } else { &[] };
        let words = [&[command, file, "-p", "cmt-steel-robots", "--json"], more].concat();
        serde_json::from_str(&ok(folder.path(), &words)).unwrap()
    };
    let metrics: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.path().join("out/metrics.json")).unwrap()).unwrap();
    for (file, language) in [("CROSS.ls", "FANUC TP"), ("CROSS.jbi", "INFORM"), ("cross.script", "URScript")] {
        let file = format!("out/{file}");
        let (simulated, inspected) = (json("simulate", &file), json("inspect", &file));
        assert_eq!((&inspected["format"], &inspected["layers"]), (&language.into(), &metrics["layers"]));
        for value in [&simulated, &inspected] {
            assert_eq!(value["totals"]["arc_starts"], metrics["arc_starts"], "{file}");
            let length = value["totals"]["deposited_length_mm"].as_f64().unwrap();
            assert!((length / metrics["deposited_length_mm"].as_f64().unwrap() - 1.0).abs() < 1e-4, "{file}: {length}");
        }
    }
    assert!(ok(folder.path(), &["inspect", "out/CROSS.ls", "-p", "cmt-steel-robots"]).contains("arc starts"));
    assert!(ok(folder.path(), &["inspect", "out/plan.json"]).contains("deposited length"));
}

/// Layers have one name in KRL and FANUC TP: each program reads its own.
#[test]
fn programs_of_several_robots_in_one_folder_do_not_mix() {
    let folder = folder_with("cross");
    let all = folder.path().join("all");
    fs::create_dir(&all).unwrap();
    let mut alone = Vec::new();
    for (profile, post, main) in [("cmt-al2319-kuka", "krl", "CROSS.src"), ("cmt-steel-robots", "fanuc", "CROSS.ls")] {
        ok(folder.path(), &["plan", "cross.stl", "-p", profile, "--post", post, "-o", post, "--no-deposit"]);
        let own = files(&folder.path().join(post));
        let programs = own.iter().filter(|(name, _)| [".src", ".dat", ".ls"].iter().any(|end| name.ends_with(end)));
        programs.for_each(|(name, bytes)| fs::write(all.join(name), bytes).unwrap());
        let inspect = |file: &str| -> serde_json::Value {
            serde_json::from_str(&ok(folder.path(), &["inspect", file, "-p", profile, "--json"])).unwrap()
        };
        alone.push((format!("all/{main}"), inspect(&format!("{post}/{main}")), profile));
    }
    // Names of files may be in any case.
    fs::write(all.join("cross_l002.ls.bak"), "not a program").unwrap();
    for (file, alone, profile) in alone {
        let together = ok(folder.path(), &["inspect", &file, "-p", profile, "--json"]);
        assert_eq!(serde_json::from_str::<serde_json::Value>(&together).unwrap(), alone, "{file}");
    }
}

#[test]
fn rapids_count_in_the_time() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("a.nc"), "G1 X0 Y0 Z0 F600\nM3\nG1 X60\nM5\nG0 X6060\nM3\nG1 X6120\nM5\n").unwrap();
    let said = ok(folder.path(), &["inspect", "a.nc", "-p", "plasma-304-cnc", "--set", "travel.speed=50", "--json"]);
    let said: serde_json::Value = serde_json::from_str(&said).unwrap();
    let time = said["totals"]["total_time_s"].as_f64().unwrap();
    // Twice 60 mm at 10 mm/s, 6 m at 50 mm/s.
    assert!((time - 12.0 - 120.0).abs() < 1.0, "{said}");
    assert!(said["notes"].to_string().contains("1 of them, 6.00 m, were timed at"), "{said}");
}

/// The command alone in a folder, on the file system of the build, so that nothing is copied: a program that was just
/// written may be refused as busy.
fn alone() -> (TempDir, PathBuf) {
    let folder = TempDir::new_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
    let program = folder.path().join(format!("beadwright{}", std::env::consts::EXE_SUFFIX));
    fs::hard_link(env!("CARGO_BIN_EXE_beadwright"), &program).unwrap();
    (folder, program)
}

#[test]
fn a_missing_studio_is_reported() {
    let (folder, program) = alone();
    let output = Command::new(program).args(["studio", "propeller"]).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains(&folder.path().join("beadwright-studio").display().to_string()), "{said}");
    assert!(said.contains("cargo build --release -p beadwright-studio"), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
}

#[cfg(unix)]
#[test]
fn a_studio_beside_the_command_is_started() {
    let (folder, program) = alone();
    std::os::unix::fs::symlink("/bin/sh", folder.path().join("beadwright-studio")).unwrap();
    let run = |script: &str| {
        let arguments = ["studio", "-c", script, "studio", "part.stl", "--view", "layer", "--help"];
        Command::new(&program).args(arguments).output().unwrap()
    };
    let output = run("echo $*; exit 7");
    assert_eq!(String::from_utf8(output.stdout).unwrap(), "part.stl --view layer --help\n");
    assert_eq!(output.status.code(), Some(7));
    assert!(output.stderr.is_empty());
    assert_eq!(run("exit 0").status.code(), Some(0));
    assert!(run("kill -9 $$").status.code().is_none());
}

#[test]
fn a_large_plan_is_announced_before_it_is_made() {
    let folder = folder_with("cross");
    // What is printed before any layer is planned: the command is then stopped, since the plan takes minutes.
    let announced = |more: &[&str]| {
        let arguments = [&["plan", "cross.stl", "-s", "zigzag", "--no-deposit"], more].concat();
        let mut command = Command::new(env!("CARGO_BIN_EXE_beadwright"));
        command.current_dir(folder.path()).args(arguments).stderr(Stdio::piped()).stdout(Stdio::null());
        let mut run = command.spawn().unwrap();
        let lines = BufReader::new(run.stderr.take().unwrap()).lines();
        let (sender, receiver) = std::sync::mpsc::channel();
        std::thread::spawn(move || lines.map_while(Result::ok).try_for_each(|line| sender.send(line)));
        let deadline = std::time::Instant::now() + std::time::Duration::from_secs(20);
        let left = || deadline.saturating_duration_since(std::time::Instant::now());
        let mut text = String::new();
        while let Ok(line) = receiver.recv_timeout(left()) {
            text.push_str(&line);
            if text.contains("Ctrl-C") {
                break;
            }
        }
        run.kill().unwrap();
        run.wait().unwrap();
        text
    };
    let large = announced(&["--set", "bead.width=0.2"]);
    for word in ["about 10 layers with 41 m of bead each, 0.4 km in all", "bead.width (0.2 mm)", "Ctrl-C"] {
        assert!(large.contains(word), "{large}");
    }
    assert!(!announced(&[]).contains("are to be planned"), "a usual plan needs no words");
    assert!(!announced(&["--set", "bead.width=0.2", "--quiet"]).contains("are to be planned"));
}

/// `check` reads a program as a welding programmer would; `plan` and `profile check` say what its templates would do.
#[test]
fn dangerous_lines_are_found_in_programs_and_profiles() {
    let folder = folder_with("cross");
    let at = folder.path();
    ok(at, &["plan", "cross.stl", "--no-deposit", "-o", "out"]);
    assert!(ok(at, &["check", "out/CROSS.src"]).contains("nothing found"));
    let module = at.join("out/CROSS_L003.src");
    let text = fs::read_to_string(&module).unwrap();
    fs::write(&module, text.replacen("WAIT SEC 0\r\n", "", 1)).unwrap();
    let found = beadwright(at, &["check", "out/CROSS.src"]);
    let said = String::from_utf8(found.stdout).unwrap();
    assert_eq!(found.status.code(), Some(3), "{said}");
    assert!(
        said.contains("unwatched-end (1)") && said.contains("CROSS_L003") && said.contains("Remedy: wait until"),
        "{said}"
    );
    let json = beadwright(at, &["check", "out/CROSS.src", "--json"]);
    let found: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!((&found[0]["check"], &found[0]["count"]), (&"unwatched-end".into(), &1.into()), "{found}");
    assert!(found[0]["line"].as_u64().unwrap() > 1, "{found}");
    // The same in a template.
    ok(at, &["profile", "show", "cmt-al2319-kuka", "-o", "mine.toml"]);
    ok(at, &["profile", "check", "mine.toml"]);
    let profile = fs::read_to_string(at.join("mine.toml")).unwrap();
    fs::write(at.join("mine.toml"), profile.replace("\"WAIT SEC 0\", ", "")).unwrap();
    let found = beadwright(at, &["profile", "check", "mine.toml"]);
    let said = String::from_utf8(found.stdout).unwrap();
    assert!(found.status.code() == Some(3) && said.contains("unwatched-end"), "{said}");
    let planned = ok(at, &["plan", "cross.stl", "-p", "mine.toml", "--no-deposit", "-o", "mine"]);
    assert!(planned.contains("warning: krl, unwatched-end"), "{planned}");
}

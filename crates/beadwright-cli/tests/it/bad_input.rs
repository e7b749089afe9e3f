//! Files and arguments that once broke the program, led to wrong plans or took all memory: each is refused with one sentence
//! or planned with its doubts reported first. The files lie in the shared folder (`BEADWRIGHT_CASES`).

use crate::common::beadwright;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};
use tempfile::TempDir;

fn case(name: &str) -> String {
    let default = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/cases");
    let folder = std::env::var_os("BEADWRIGHT_CASES").map_or_else(default, PathBuf::from);
    let path = folder.join(name);
    assert!(path.exists(), "{}: BEADWRIGHT_CASES names the folder.", path.display());
    path.to_str().unwrap().to_owned()
}

/// Runs a command on a case (the word `CASE`); it ends with a status, says some words, and writes nothing unless it is 0, or
/// the report alone where the plan should not be started.
fn check(name: &str, arguments: &[&str], status: i32, words: &[&str]) -> String {
    let folder = TempDir::new().unwrap();
    let case = case(name);
    let arguments: Vec<&str> = arguments.iter().map(|a| if *a == "CASE" { &case } else { *a }).collect();
    let begin = Instant::now();
    let output = beadwright(folder.path(), &arguments);
    let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert_eq!(output.status.code(), Some(status), "{arguments:?}: {said}");
    assert!(words.iter().all(|word| said.contains(word)), "{arguments:?}: {said}");
    assert!(begin.elapsed() < Duration::from_secs(120), "{arguments:?} takes {:?}", begin.elapsed());
    // A plan that should not be started leaves its report, and no program.
    let out = folder.path().join("beadwright-out");
    if status == 3 && out.join("refused.html").is_file() {
        assert_eq!(fs::read_dir(&out).unwrap().count(), 1, "{arguments:?} leaves more than its report behind");
        fs::remove_dir_all(out).unwrap();
    }
    if status != 0 {
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "{arguments:?} leaves something behind");
    }
    said
}

#[test]
#[cfg_attr(no_models, ignore = "no shared cases")]
fn files_that_lie_are_refused_and_taken_on_demand() {
    // Case 1620.
    for (name, words) in [
        ("ascii_cut_after_12_of_24.stl", "without \"endsolid\""),
        ("header_count_12_of_24.stl", "announce 12 triangles, but 12 more follow"),
    ] {
        check(name, &["plan", "CASE"], 1, &[words, "--accept-damaged"]);
        check(name, &["plan", "CASE", "--accept-damaged", "--no-deposit"], 0, &["The file is damaged", words]);
        check(name, &["inspect", "CASE"], 0, &[words]);
    }
}

#[test]
#[cfg_attr(no_models, ignore = "no shared cases")]
fn coordinates_out_of_all_bounds_are_refused() {
    // Case 1621.
    check("coord_1e9.igs", &["plan", "CASE", "--height", "20"], 1, &["m from the origin"]);
    check("coord_1e300.igs", &["plan", "CASE", "--height", "20"], 1, &["m from the origin"]);
    for command in ["inspect", "simulate"] {
        check("g_big.nc", &[command, "CASE"], 1, &["line 3: a coordinate lies farther out than 20 m"]);
        check("krl_1e6.src", &[command, "CASE"], 1, &["line 5: a coordinate lies farther out than 20 m"]);
    }
}

#[test]
#[cfg_attr(no_models, ignore = "no shared cases")]
fn bombs_are_stopped() {
    // Case 1622.
    check("krl_callbomb.src", &["inspect", "CASE"], 1, &["million moves"]);
    // Its circles run through points of one line; those of a true circle are counted in `tests/it/readback.rs`.
    check("krl_arcbomb.src", &["inspect", "CASE"], 1, &["line 5: no circle runs through"]);
    check("box40x60.stl", &["plan", "CASE", "--grid", "0.001"], 1, &["--grid 0.001", "points"]);
    check("box40x60.stl", &["plan", "CASE", "--threads", "100000"], 2, &["1024"]);
    check("box40x60.stl", &["compare", "CASE", "--layers", "1-4000000000"], 2, &["at most 100000"]);
    check("box40x60.stl", &["compare", "CASE", "--layers", "5-1"], 2, &["the lower first"]);
    check("box40x60.stl", &["compare", "CASE", "--layers", "50"], 1, &["none of these layers"]);
    check("box40x60.stl", &["plan", "CASE", "--picture", "99"], 1, &["the part has the layers 1 to"]);
    check("krl_callbomb.src", &["inspect", "CASE", "--max-memory", "0.1"], 1, &["0.1 GB of memory", "--max-memory"]);
    #[cfg(unix)]
    for kilobytes in [60_000, 150_000] {
        let folder = TempDir::new().unwrap();
        let (program, case) = (env!("CARGO_BIN_EXE_beadwright"), case("krl_callbomb.src"));
        let line = format!("ulimit -v {kilobytes}; exec '{program}' inspect '{case}'");
        let output = Command::new("sh").current_dir(folder.path()).args(["-c", &line]).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(
            said.contains("GB of memory would be needed, and nothing was written") && said.contains("ulimit -v"),
            "{said}"
        );
    }
    #[cfg(unix)]
    for device in ["/dev/zero", "/dev/null"] {
        check("box40x60.stl", &["plan", device], 1, &["a device or a pipe"]);
        check("box40x60.stl", &["inspect", device], 1, &["a device or a pipe"]);
    }
}

#[test]
#[cfg_attr(no_models, ignore = "no shared cases")]
fn plans_that_cannot_be_are_refused() {
    // Case 1623.
    for (name, words) in [
        ("units_in.json", "is in \"in\""),
        ("no_layers.json", "holds no layers"),
        ("pt_1e9.json", "layer 1, pass 1: a coordinate"),
        ("pw1e5.json", "layer 1, pass 1: widths"),
    ] {
        check(name, &["inspect", "CASE"], 1, &[words]);
        check(name, &["simulate", "CASE"], 1, &[words]);
        check(name, &["check", "CASE"], 1, &[words]);
        check(name, &["reach", "CASE", "--cell", "kuka-kr20-r1810"], 1, &[words]);
    }
}

#[test]
#[cfg_attr(no_models, ignore = "no shared cases")]
fn reasons_are_the_true_ones() {
    // Case 1624.
    check("open_side.stl", &["plan", "CASE"], 1, &["the surface of the part is open", "--surface wall"]);
    let said = check("prof_no_krl.toml", &["profile", "check", "CASE"], 1, &["has no [krl] section"]);
    let plan = check("box40x60.stl", &["plan", "CASE", "-p", &case("prof_no_krl.toml")], 1, &["has no [krl] section"]);
    assert_eq!(said, plan, "a profile is refused with the same words");
    check(
        "box60x60x2.99.stl",
        &["plan", "CASE", "--set", "layers.level=false"],
        0,
        &["the upper 0.99 mm (33.1 %) are not built"],
    );
}

#[test]
#[cfg_attr(no_models, ignore = "no shared cases")]
fn programs_that_nobody_should_start_are_not_written() {
    // Case 1625.
    let clearance = ["--set", "travel.clearance=0"];
    let plan = ["plan", "CASE", "--no-deposit"];
    check("box40x60.stl", &[&plan[..], &clearance].concat(), 3, &["should not be started", "travel.clearance = 0"]);
    check(
        "box40x60.stl",
        &[&plan[..], &clearance, &["--allow-findings"]].concat(),
        0,
        &["serious: travel.clearance = 0"],
    );
    // The first words are of what is doubtful.
    let said = check("wall_island_lost.stl", &["plan", "CASE", "-s", "wall"], 0, &["filled by another strategy"]);
    let third = said.lines().nth(2).unwrap();
    assert!(["serious: ", "warning: "].iter().any(|word| third.starts_with(word)), "{said}");
}

#[test]
fn plans_are_checked_with_the_profile_that_they_carry() {
    // Case 1626.
    let folder = TempDir::new().unwrap();
    let ok = |arguments: &[&str]| {
        let output = beadwright(folder.path(), arguments);
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(output.status.success(), "{arguments:?}: {said}{}", String::from_utf8_lossy(&output.stderr));
        said
    };
    ok(&["example", "plate"]);
    ok(&["plan", "plate.stl", "-p", "cmt-steel-abb", "--no-deposit", "--set", "bead.width=6.1", "-o", "out"]);
    let wrong = beadwright(folder.path(), &["check", "out/plan.json", "-p", "fdm-abs-0.4"]);
    assert_eq!(wrong.status.code(), Some(3), "with another profile, there are findings");
    let own = beadwright(folder.path(), &["check", "out/plan.json", "--json"]);
    let found: serde_json::Value = serde_json::from_slice(&own.stdout).unwrap();
    let speeds = found.as_array().unwrap().iter().filter(|f| f["kind"] == "speed-window" || f["kind"] == "bead-width");
    assert_eq!(speeds.count(), 0, "{found}");
    let plan: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.path().join("out/plan.json")).unwrap()).unwrap();
    assert_eq!((plan["version"].as_u64(), plan["profile"]["bead"]["width"].as_f64()), (Some(2), Some(6.1)));
    // Version 1 asks for it.
    let one = r#"{"version":1,"profile":"mine","layers":[{"index":0,"z":2.0,"height":2.0,"islands":[],"passes":
        [{"kind":"infill","closed":false,"points":[[0,0,2],[50,0,2]],"width":7.5,"speed":10.5}]}]}"#;
    fs::write(folder.path().join("one.json"), one).unwrap();
    let asked = beadwright(folder.path(), &["check", "one.json"]);
    let said = String::from_utf8_lossy(&asked.stderr).into_owned();
    assert!(
        asked.status.code() == Some(1) && said.contains("plan.json version 1") && said.contains("--profile"),
        "{said}"
    );
    ok(&["inspect", "one.json", "-p", "cmt-al2319-kuka"]);
    // Printers' programs of ours name their profile; others are asked about.
    ok(&[
        "plan",
        "plate.stl",
        "-p",
        "fdm-abs-0.4",
        "-s",
        "zigzag",
        "--no-deposit",
        "--scale",
        "0.2",
        "--units",
        "mm",
        "-o",
        "fdm",
    ]);
    let printed = ok(&["inspect", "fdm/plate.gcode"]);
    assert!(printed.contains("Read with the profile fdm-abs-0.4 (the program names it)"), "{printed}");
    fs::write(folder.path().join("other.gcode"), "G21\nG90\nM83\nG1 X0 Y0 Z0.2 F600\nG1 X20 E1\n").unwrap();
    let asked = beadwright(folder.path(), &["simulate", "other.gcode"]);
    let said = String::from_utf8_lossy(&asked.stderr).into_owned();
    assert!(
        asked.status.code() == Some(1) && said.contains("printer's program") && said.contains("--profile"),
        "{said}"
    );
}

#[test]
fn text_of_any_system_is_read() {
    // Case 1627.
    let folder = TempDir::new().unwrap();
    let facet = "facet normal 0 0 0\nouter loop\nvertex {a}\nvertex {b}\nvertex {c}\nendloop\nendfacet\n";
    let (o, x, y, z) = ("0 0 0", "90 0 0", "0 90 0", "0 0 90");
    let sides = [(o, y, x), (o, x, z), (o, z, y), (x, y, z)];
    let facets: String =
        sides.iter().map(|(a, b, c)| facet.replace("{a}", a).replace("{b}", b).replace("{c}", c)).collect();
    let text = format!("solid a\n{facets}endsolid a\n");
    let wide = |bytes: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(bytes).collect::<Vec<u8>>();
    let big = [&[0xfe, 0xff][..], &wide(u16::to_be_bytes)].concat();
    let little = [&[0xff, 0xfe][..], &wide(u16::to_le_bytes)].concat();
    let marked = [&[0xef, 0xbb, 0xbf][..], text.as_bytes()].concat();
    let mac = text.replace('\n', "\r").into_bytes();
    for (name, bytes) in [("big", big), ("little", little), ("marked", marked), ("mac", mac)] {
        let file = format!("{name}.stl");
        fs::write(folder.path().join(&file), bytes).unwrap();
        let said = beadwright(folder.path(), &["inspect", &file]);
        assert!(String::from_utf8_lossy(&said.stdout).contains("volume     121500.000"), "{name}: {said:?}");
    }
    fs::write(folder.path().join("bare.stl"), wide(u16::to_le_bytes)).unwrap();
    let said = String::from_utf8(beadwright(folder.path(), &["inspect", "bare.stl"]).stderr).unwrap();
    assert!(said.contains("UTF-16 without a byte order mark"), "{said}");
    let profile = beadwright(folder.path(), &["profile", "show", "cmt-steel-abb"]).stdout;
    let windows = String::from_utf8(profile).unwrap().replace('\n', "\r\n");
    fs::write(folder.path().join("p.toml"), [&[0xef, 0xbb, 0xbf][..], windows.as_bytes()].concat()).unwrap();
    assert!(beadwright(folder.path(), &["profile", "check", "p.toml"]).status.success());
}

//! `beadwright distort`: a wall bends its plate.

use crate::common::beadwright;
use std::process::Output;

fn said(output: &Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn the_plate_of_a_plan_bends() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    said(&beadwright(at, &["example", "cross", "-o", "cross.stl"]));
    said(&beadwright(at, &["plan", "cross.stl", "--no-deposit", "-o", "plan", "--scale", "0.5"]));
    let rough = ["distort", "plan/plan.json", "--voxel", "8", "--voxel-height", "4", "--steps", "6"];
    let text = said(&beadwright(at, &rough));
    assert!(text.contains("lift of the plate, released") && text.contains("deviation of the part"), "{text}");
    assert!(text.contains("thermal eccentricity"), "{text}");
    said(&beadwright(at, &[&rough[..], &["--page", "bent.html"]].concat()));
    let page = std::fs::read_to_string(at.join("bent.html")).unwrap();
    assert!(page.contains("class=\"card bent\"") && page.contains("\"released\""), "no bent body on the page");
    // What the page calls the lift is what the command prints as such.
    let cell = page.split_once("released</td>").and_then(|(_, row)| row.split_once("</td>")).unwrap().0;
    let shown: f64 = cell.rsplit('>').next().unwrap().parse().unwrap();
    let printed = text.lines().find_map(|line| line.trim().strip_prefix("lift of the plate, released")).unwrap();
    let printed: f64 = printed.split_whitespace().next().unwrap().parse().unwrap();
    assert!((shown - printed).abs() < 0.0051, "{shown} on the page, {printed} printed");
    let lift = |more: &[&str]| {
        let text = said(&beadwright(at, &[&rough[..], &["--json"], more].concat()));
        let all: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert!(all["balance"]["released"]["residual"].as_f64().unwrap() < 1e-8);
        assert!(!all["released"]["nodes"].as_array().unwrap().is_empty());
        ["clamped", "released"].map(|shape| all[shape]["lift"]["range"].as_f64().unwrap())
    };
    let ([clamped, released], [free, same]) = (lift(&[]), lift(&["--clamps", "none"]));
    assert!(
        0.0 < clamped && clamped < released && (free / same - 1.0).abs() < 1e-6,
        "{clamped} {released} {free} {same}"
    );
    let [_, twice] = lift(&["--calibration", "2"]);
    assert!((twice / released - 2.0).abs() < 1e-4, "{twice} {released}");
    let refused = beadwright(at, &["distort", "plan/plan.json", "--calibration", "-1"]);
    assert_eq!(refused.status.code(), Some(2), "{refused:?}");
    let refused = beadwright(at, &["distort", "plan/plan.json", "--calibration", "1000"]);
    assert!(String::from_utf8_lossy(&refused.stderr).contains("calibration = 1000"), "{refused:?}");
}

#[test]
fn a_part_is_bent_beforehand() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    said(&beadwright(at, &["example", "wall", "-o", "wall.stl"]));
    let turn = ["--turn", "0,0,30"];
    said(&beadwright(
        at,
        &[&["plan", "wall.stl", "-p", "cmt-steel-abb", "--no-deposit", "-o", "plan"][..], &turn].concat(),
    ));
    let rough = ["distort", "plan/plan.json", "--voxel", "4", "--voxel-height", "4", "--steps", "8"];
    let bend = |more: &[&str]| beadwright(at, &[&rough[..], &["--compensate", "wall.stl"], &turn, more].concat());
    let all: serde_json::Value = serde_json::from_str(&said(&bend(&["--json", "--rounds", "1"]))).unwrap();
    let left = |round: usize| all["compensation"][round]["left"]["rms"].as_f64().unwrap();
    assert!(left(1) < 0.5 * left(0), "{all:#}");
    assert!(all["eccentricity"]["course"].as_array().unwrap().len() > 50);
    let text = said(&bend(&["--rounds", "1", "-o", "bent.3mf"]));
    assert!(text.contains("off with bend 1") && text.contains("raised by"), "{text}");
    for file in ["wall_bent.stl", "bent.3mf"] {
        let text = said(&beadwright(at, &["inspect", file]));
        assert!(text.contains("closed and clean"), "{text}");
    }
    let refused = String::from_utf8_lossy(&bend(&["--shift", "0,200"]).stderr).into_owned();
    assert!(refused.contains("lays no metal"), "{refused}");
    let refused = beadwright(at, &["distort", "plan/plan.json", "--scale", "2"]);
    assert!(String::from_utf8_lossy(&refused.stderr).contains("--compensate"), "{refused:?}");
}

//! `beadwright heat`, and programs that wait for metal to cool.

use crate::common::beadwright;
use std::fs;
use std::process::Output;

fn said(output: &Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn the_heat_of_a_plan_is_printed_and_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    said(&beadwright(at, &["example", "cross", "-o", "cross.stl"]));
    said(&beadwright(at, &["plan", "cross.stl", "--no-deposit", "-o", "plan"]));
    let text = said(&beadwright(at, &["heat", "plan/plan.json"]));
    assert!(text.contains("hottest start") && text.contains("taken by air and table"), "{text}");
    let page = fs::read_to_string(at.join("heat.html")).unwrap();
    assert!(page.matches("<svg").count() > 3, "a plot, a scale and pictures");
    let all = json(&said(&beadwright(at, &["heat", "plan/plan.json", "--json"])));
    let metrics = json(&fs::read_to_string(at.join("plan/metrics.json")).unwrap());
    let passes: usize = all["layers"].as_array().unwrap().iter().map(|l| l["passes"].as_array().unwrap().len()).sum();
    assert_eq!(passes as u64, metrics["passes"].as_u64().unwrap());
    let seconds = |value: &serde_json::Value| value.as_f64().unwrap();
    assert!((seconds(&all["seconds"]) / seconds(&metrics["total_time_s"]) - 1.0).abs() < 1e-3, "the same time");
    let balance = seconds(&all["supplied"]) - seconds(&all["lost"]) - seconds(&all["held"]);
    assert!(balance.abs() < 1e-6 * seconds(&all["supplied"]));
}

#[test]
fn programs_wait_for_the_limit() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    said(&beadwright(at, &["example", "cross", "-o", "cross.stl"]));
    let plan = ["plan", "cross.stl", "--no-deposit", "--profile", "cmt-steel-robots", "--post", "urscript"];
    let metrics = |out: &str| json(&fs::read_to_string(at.join(out).join("metrics.json")).unwrap());
    said(&beadwright(at, &[&plan[..], &["-o", "without"]].concat()));
    said(&beadwright(at, &[&plan[..], &["-o", "with", "--set", "interpass.max_temperature=150"]].concat()));
    let (without, with) = (metrics("without"), metrics("with"));
    let waits = with["dwell_time_s"].as_f64().unwrap();
    assert!(without["dwell_time_s"].as_f64() == Some(0.0) && waits > 100.0, "{waits} s");
    // The model finds the waits of the plan long enough, and no longer than needed.
    let text = said(&beadwright(at, &["heat", "with/plan.json"]));
    assert!(!text.contains("warning"), "{text}");
    let heat = json(&said(&beadwright(at, &["heat", "with/plan.json", "--json"])));
    let starts = heat["layers"].as_array().unwrap().iter().flat_map(|l| l["passes"].as_array().unwrap());
    let hottest = starts.map(|pass| pass["start"].as_f64().unwrap()).fold(0.0, f64::max);
    assert!((140.0..151.0).contains(&hottest), "{hottest} °C");
    // What a pass meets ahead of it is hotter than where it begins, and said with its place.
    let ahead_of_it = with["warnings"].as_array().unwrap().iter().find(|w| w["kind"] == "hot-ahead").unwrap().clone();
    let ahead = heat["layers"].as_array().unwrap().iter().flat_map(|l| l["passes"].as_array().unwrap().clone());
    let ahead = ahead.flat_map(|pass| pass["along"].as_array().unwrap().clone());
    let peak = ahead.map(|t| t.as_f64().unwrap()).fold(0.0, f64::max);
    let reported = ahead_of_it["largest"]["size"].as_f64().unwrap();
    assert!(peak > hottest + 5.0 && (reported - peak).abs() < 2.0, "{reported} {peak}");
    // The report knows how warm it is where each pass begins, and how long each layer waits.
    let report = |plan: &str| fs::read_to_string(at.join(plan).join("report.html")).unwrap();
    let warmth = |report: &str| -> Vec<serde_json::Value> {
        let data = report.split("id=\"data\">").nth(1).unwrap().split("</script>").next().unwrap();
        json(data)["warmth"].as_array().unwrap().clone()
    };
    let layers = warmth(&report("with"));
    let starts = layers.iter().flat_map(|layer| layer["starts"].as_array().unwrap()).map(|t| t.as_f64().unwrap());
    assert!(starts.clone().all(|celsius| celsius <= 151.0) && starts.fold(0.0, f64::max) > 140.0);
    let reported: f64 = layers.iter().map(|layer| layer["wait"].as_f64().unwrap()).sum();
    assert!((reported - waits).abs() < 0.01 * waits, "{reported} s of {waits} s");
    assert!(warmth(&report("without")).is_empty());
    // The waits are in the program.
    let programs = fs::read_dir(at.join("with")).unwrap().map(|entry| entry.unwrap().path());
    let text: String = programs
        .filter(|path| path.extension().is_some_and(|e| e == "script"))
        .map(|p| fs::read_to_string(p).unwrap())
        .collect();
    let sleeps =
        text.lines().filter_map(|line| line.trim().strip_prefix("sleep(")?.strip_suffix(')')?.parse::<f64>().ok());
    let slept: f64 = sleeps.filter(|seconds| *seconds > 5.0).sum();
    assert!((slept - waits).abs() < 0.1 * waits, "{slept} s of {waits} s");
    // Before a plan with limits, the plain one says what it lacks.
    let text = said(&beadwright(at, &["heat", "without/plan.json", "--limit", "150"]));
    assert!(text.contains("waits for cooling"), "{text}");
}

#[test]
fn what_a_profile_lacks_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    said(&beadwright(at, &["example", "cross", "-o", "cross.stl"]));
    let wide = ["--set", "bead.width=4", "--set", "fill.stepover=3"];
    let plan = ["plan", "cross.stl", "--no-deposit", "--profile", "fdm-abs-0.4", "-o", "plan"];
    said(&beadwright(at, &[&plan[..], &wide].concat()));
    let refused = beadwright(at, &["heat", "plan/plan.json"]);
    let text = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(refused.status.code() == Some(1) && text.contains("[heat]") && !at.join("heat.html").exists(), "{text}");
    let refused =
        beadwright(at, &["plan", "cross.stl", "--profile", "fdm-abs-0.4", "--set", "interpass.max_temperature=90"]);
    assert!(!refused.status.success());
}

#[test]
fn walls_are_fitted_from_a_table() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let table =
        "dwell_s,length_mm,layers,height_mm,width_mm\n0,120,32,39.8,6.80\n60,120,32,49.0,5.15\n240,120,32,50.7,4.79\n";
    fs::write(at.join("walls.csv"), table).unwrap();
    let walls = ["bead", "walls", "walls.csv", "-p", "cmt-steel-abb", "--fit", "0,240", "--set", "process.current=132"];
    let text = said(&beadwright(at, &walls));
    assert_eq!(text.matches("fitted").count(), 2, "{text}");
    let all = json(&said(&beadwright(at, &[&walls[..], &["--json"]].concat())));
    let height = all["walls"][1]["height"].as_f64().unwrap();
    assert!((height / 49.0 - 1.0).abs() < 0.03, "{height}");
    let one = beadwright(at, &["bead", "walls", "walls.csv", "-p", "cmt-steel-abb", "--fit", "60"]);
    assert!(String::from_utf8_lossy(&one.stderr).contains("two walls"), "one wall is not enough");
}

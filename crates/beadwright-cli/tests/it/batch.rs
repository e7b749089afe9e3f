//! Many plans in one table: as `beadwright plan` makes them, whatever the number of threads, and failures beside the rest.

use crate::common::{beadwright, ok};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use tempfile::TempDir;

fn folder_with(examples: &[&str]) -> TempDir {
    let folder = TempDir::new().unwrap();
    examples.iter().for_each(|example| drop(ok(folder.path(), &["example", example])));
    folder
}

/// The totals without what `plan` alone has: the programs that it writes, notes on them, and what checks find.
fn totals(metrics: &Value) -> Value {
    let mut metrics = metrics.clone();
    ["notes", "files", "findings", "built"]
        .into_iter()
        .for_each(|name| drop(metrics.as_object_mut().unwrap().remove(name)));
    assert!(metrics["arc_starts"].is_u64() && metrics["deposit"]["void_percent"].is_f64());
    metrics
}

/// The cells of a CSV file, read as RFC 4180 says.
fn cells(text: &str) -> Vec<Vec<String>> {
    let (mut rows, mut row, mut cell, mut quoted) = (Vec::new(), Vec::new(), String::new(), false);
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if quoted && letters.peek() == Some(&'"') => cell.push(letters.next().unwrap()),
            '"' => quoted = !quoted,
            ',' if !quoted => row.push(std::mem::take(&mut cell)),
            '\n' if !quoted => {
                row.push(std::mem::take(&mut cell));
                rows.push(std::mem::take(&mut row));
            }
            other => cell.push(other),
        }
    }
    assert!(!quoted && row.is_empty() && cell.is_empty(), "the last line does not end");
    rows
}

/// A box as ASCII STL.
fn block(low: [f64; 3], high: [f64; 3]) -> String {
    let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let vertex = |k: &usize| format!("vertex {} {} {}\n", corner(*k)[0], corner(*k)[1], corner(*k)[2]);
    let facet =
        |t: [&usize; 3]| format!("facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n", t.map(vertex).concat());
    triangles.map(facet).collect()
}

/// Every row holds what metrics.json of the same plan holds, in the order of files, profiles, strategies, values.
#[test]
fn rows_are_the_plans_of_the_command() {
    let folder = folder_with(&["cross", "star"]);
    let at = folder.path();
    let profiles = ["cmt-al2319-kuka", "cmt-steel-abb"];
    let batch =
        ["batch", "cross.stl", "star.stl", "-p", profiles[0], "-p", profiles[1], "-s", "zigzag", "-s", "contour"];
    let rest =
        ["--sweep", "layers.height=1.8:2.2:2", "--grid", "1", "--turn", "0,0,30", "-o", "rows.json", "--threads", "3"];
    let printed = ok(at, &[&batch[..], &rest].concat());
    let rows: Vec<Value> = serde_json::from_str(&fs::read_to_string(at.join("rows.json")).unwrap()).unwrap();
    assert_eq!(rows.len(), 16);
    assert!(
        printed.contains("layers.height mm")
            && printed.contains("time min")
            && printed.contains("16 rows in rows.json"),
        "{printed}"
    );
    let mut rows = rows.iter();
    for file in ["cross.stl", "star.stl"] {
        for profile in profiles {
            for strategy in ["zigzag", "contour"] {
                for height in ["1.8", "2.2"] {
                    let row = rows.next().unwrap();
                    let names = [&row["file"], &row["profile"], &row["strategy"], &row["set"]["layers.height"]];
                    assert_eq!(names, [file, profile, strategy, height]);
                    let set = format!("layers.height={height}");
                    let plan =
                        ["plan", file, "-p", profile, "-s", strategy, "--set", &set, "--grid", "1", "--turn", "0,0,30"];
                    ok(at, &plan);
                    let metrics = fs::read_to_string(at.join("beadwright-out/metrics.json")).unwrap();
                    assert_eq!(totals(&row["metrics"]), totals(&serde_json::from_str(&metrics).unwrap()), "{plan:?}");
                    assert!(row["error"].is_null());
                }
            }
        }
    }
}

/// A part that is all thin wall is planned with `wall`, as `plan` does; the row names it.
#[test]
fn the_strategy_is_the_one_that_is_welded() {
    let folder = folder_with(&["wall"]);
    let rows = ok(folder.path(), &["batch", "wall.stl", "-p", "cmt-al2319-kuka", "--no-deposit", "--json"]);
    let rows: Value = serde_json::from_str(&rows).unwrap();
    assert_eq!(rows[0]["strategy"], "wall");
    assert!(rows[0]["metrics"]["deposit"].is_null());
}

#[test]
fn all_formats_are_the_same_with_any_number_of_threads() {
    let folder = folder_with(&["cross", "gear"]);
    let made = |threads: &str| {
        let write = |format: &str| {
            let file = format!("{threads}.{format}");
            let batch =
                ["batch", "cross.stl", "gear.stl", "-s", "zigzag", "--grid", "1", "-o", &file, "--threads", threads];
            let printed = ok(folder.path(), &[&batch[..], &["--sweep", "fill.raster_angle=0:45:2"]].concat());
            (printed.replace(&file, "the file"), fs::read_to_string(folder.path().join(file)).unwrap())
        };
        ["csv", "json", "html"].map(write)
    };
    let (one, many) = (made("1"), made("7"));
    assert!(one == many);
    let [csv, json, html] = one.map(|(_, text)| text);
    // The table for spreadsheets has the numbers of the JSON.
    let (rows, json): (_, Vec<Value>) = (cells(&csv), serde_json::from_str(&json).unwrap());
    assert_eq!((rows.len(), json.len()), (5, 4));
    assert!(rows[0].iter().any(|head| head == "fill.raster_angle °"), "{:?}", rows[0]);
    for (row, json) in rows[1..].iter().zip(&json) {
        let row: BTreeMap<&str, &str> =
            rows[0].iter().map(String::as_str).zip(row.iter().map(String::as_str)).collect();
        assert_eq!(row["file"], json["file"].as_str().unwrap());
        for (name, value) in [
            ("total_time_s", &json["metrics"]["total_time_s"]),
            ("arc_starts", &json["metrics"]["arc_starts"]),
            ("deposit.void_percent", &json["metrics"]["deposit"]["void_percent"]),
        ] {
            // Readers of JSON round the last digit in their own way.
            assert!((row[name].parse::<f64>().unwrap() / value.as_f64().unwrap() - 1.0).abs() < 1e-14, "{name}");
        }
    }
    // The page: a head, a row and a picture for each plan.
    assert_eq!(
        (html.matches("<tr>").count(), html.matches("<svg ").count(), html.matches("<figcaption>").count()),
        (5, 4, 4)
    );
    assert!(html.contains(">time min</th>") && html.contains("sortBy"));
}

/// A file that cannot be read and a value that is impossible end with a sentence in their rows; the others are planned.
#[test]
fn what_fails_is_in_its_row() {
    let folder = folder_with(&["cross"]);
    let at = folder.path();
    fs::write(at.join("letter, not a \"part\".stl"), "hello").unwrap();
    let files = ["batch", "letter, not a \"part\".stl", "cross.stl", "missing.stl", "--no-deposit", "-s", "zigzag"];
    let output = beadwright(at, &[&files[..], &["--sweep", "layers.height=2,90", "-o", "rows.csv"]].concat());
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(String::from_utf8_lossy(&output.stderr), "error: 5 of 6 plans could not be made; their rows say why.\n");
    let rows = cells(&fs::read_to_string(at.join("rows.csv")).unwrap());
    assert!(rows.iter().all(|row| row.len() == rows[0].len()));
    let problems: Vec<&String> = rows[1..].iter().filter_map(|row| row.last()).collect();
    assert!(problems[0].contains("letter, not a \"part\".stl") && problems[0].contains("not an STL"), "{problems:?}");
    assert!(problems[2].is_empty() && rows[3][0] == "cross.stl", "{problems:?}");
    assert!(problems[3].contains("layers.height = 90 is impossible") && problems[3].contains("mm"), "{problems:?}");
    assert!(problems[4].contains("missing.stl"), "{problems:?}");
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(printed.matches("  error: ").count(), 5, "{printed}");
}

/// A block that floats is planned, but should not be welded: its figures and the reason are printed, the status is 3.
#[test]
fn what_should_not_be_welded_is_reported() {
    let folder = TempDir::new().unwrap();
    let (foot, lid) = (block([0.0; 3], [60.0, 40.0, 4.0]), block([0.0, 0.0, 14.0], [60.0, 40.0, 18.0]));
    fs::write(folder.path().join("floating.stl"), format!("solid a\n{foot}{lid}endsolid a\n")).unwrap();
    let output =
        beadwright(folder.path(), &["batch", "floating.stl", "-s", "zigzag", "--no-deposit", "-o", "rows.json"]);
    assert_eq!(output.status.code(), Some(3), "{output:?}");
    let rows: Value = serde_json::from_str(&fs::read_to_string(folder.path().join("rows.json")).unwrap()).unwrap();
    assert!(rows[0]["error"].is_null() && rows[0]["metrics"]["arc_starts"].as_u64() > Some(0));
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(printed.contains("should not be welded: ") && printed.contains("no bead lies below"), "{printed}");
    assert!(String::from_utf8_lossy(&output.stderr).contains("1 of 1 plans should not be welded as they are"));
}

#[test]
fn wrong_usage_is_refused_before_anything_is_planned() {
    let folder = folder_with(&["cross"]);
    for (arguments, status, part) in [
        (&["-o", "rows.txt"][..], 2, ".csv, .json or .html"),
        (&["--sweep", "layers.height"], 2, "layers.height=1.8:2.2:3"),
        (&["--sweep", "a.b=1:2:9999", "--sweep", "c.d=1:2:9999"], 1, "at most 100000"),
    ] {
        let output = beadwright(folder.path(), &[&["batch", "cross.stl"], arguments].concat());
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(status), "{said}");
        assert!(said.contains(part), "{said}");
    }
}

/// Runs a batch with a model from standard input; gives it when it has read more than a pipe holds.
fn fed(folder: &Path, arguments: &[&str], model: &[u8]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_beadwright"));
    command.current_dir(folder).args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    child.stdin.take().unwrap().write_all(model).unwrap();
    child
}

#[test]
fn a_model_from_standard_input_is_read_once_for_all() {
    let folder = folder_with(&["propeller"]);
    let model = fs::read(folder.path().join("propeller.stl")).unwrap();
    let rest =
        ["-s", "zigzag", "-s", "raster", "--sweep", "layers.height=4:5:4", "--no-deposit", "--json", "--threads", "8"];
    let piped = fed(folder.path(), &[&["batch", "-"], &rest[..]].concat(), &model).wait_with_output().unwrap();
    assert!(piped.status.success(), "{piped:?}");
    let named = ok(folder.path(), &[&["batch", "propeller.stl"], &rest[..]].concat());
    assert_eq!(String::from_utf8(piped.stdout).unwrap(), named.replace("\"propeller.stl\"", "\"-\""));
}

#[cfg(unix)]
#[test]
fn a_batch_that_is_stopped_writes_nothing() {
    let folder = folder_with(&["propeller"]);
    let model = fs::read(folder.path().join("propeller.stl")).unwrap();
    assert!(model.len() > 300_000, "it must not fit into a pipe");
    // It reads after it has begun to listen to Ctrl-C, and 500 plans take long.
    let child = fed(folder.path(), &["batch", "-", "--sweep", "layers.height=1.5:2:500", "-o", "rows.csv"], &model);
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(String::from_utf8_lossy(&output.stderr), "error: cancelled; nothing was written\n");
    assert!(!folder.path().join("rows.csv").exists());
}

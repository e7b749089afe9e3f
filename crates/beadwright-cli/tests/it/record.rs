//! `beadwright record`: a plan and logs become a record; a change of it shows; pyarrow opens its table.

use crate::common::{ok, refused};
use crate::opened_elsewhere::python;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// When the arc burns in each pass of a plan, s: while the torch moves, as its exported table says, and so long before and after.
pub(crate) fn times(at: &Path, [before, after]: [f64; 2]) -> Vec<[f64; 2]> {
    ok(at, &["export", "out/plan.json", "-o", "beads.csv"]);
    let table = fs::read_to_string(at.join("beads.csv")).unwrap();
    let mut lines = table.lines();
    let head: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| head.iter().position(|own| *own == name).unwrap();
    let [layer, pass, start, time] = ["layer", "pass", "start (s)", "time (s)"].map(column);
    let mut passes: BTreeMap<(usize, usize), [f64; 2]> = BTreeMap::new();
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |at: usize| cells[at].parse::<f64>().unwrap();
        let (begin, end) = (number(start), number(start) + number(time));
        passes.entry((number(layer) as usize, number(pass) as usize)).or_insert([begin, end])[1] = end;
    }
    passes.into_values().map(|[begin, end]| [begin - before, end + after]).collect()
}

/// The power source's log: 20 rows a second, its clock 500 s ahead; in one pass the feed falls to `low` of what was planned.
fn power(passes: &[[f64; 2]], feed: f64, low: usize) -> String {
    let mut text = "time_s;current_a;voltage_v;wire_feed_speed_m_min\n".to_owned();
    for row in 0..((passes[passes.len() - 1][1] + 10.0) * 20.0) as usize {
        let time = f64::from(row as u32) / 20.0;
        let next = passes.partition_point(|[_, end]| *end <= time);
        let burns = passes.get(next).is_some_and(|[start, _]| time >= *start);
        let part = if next == low && burns {
            ((time - passes[low][0]) / (passes[low][1] - passes[low][0]) * 10.0) as usize
        } else {
            0
        };
        let fed = if !burns {
            0.0
        } else if (4..6).contains(&part) {
            0.6 * feed
        } else {
            feed
        };
        let current = if burns { 150 } else { 0 };
        writeln!(text, "{:.2};{current};18,5;{fed:.3}", time + 500.0).unwrap();
    }
    text.replace('.', ",")
}

#[test]
fn a_record_is_written_verified_and_opened_elsewhere() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    ok(at, &["example", "cross", "-o", "cross.stl"]);
    ok(
        at,
        &[
            "plan",
            "cross.stl",
            "-s",
            "contour",
            "--no-deposit",
            "-o",
            "out",
            "--set",
            "cost.hour=60",
            "--set",
            "cost.co2_wire_kg=5",
            "--set",
            "cost.co2_kwh=0.4",
            "--set",
            "process.current=150",
            "--set",
            "process.voltage=18.5",
        ],
    );
    let plan: serde_json::Value = serde_json::from_slice(&fs::read(at.join("out/plan.json")).unwrap()).unwrap();
    let value = |section: &str, key: &str| plan["profile"][section][key].as_f64().unwrap();
    let feed = value("process", "wire_feed_speed");
    let passes = times(at, [value("process", "arc_start_delay"), value("start_stop", "crater_fill_time")]);
    fs::write(at.join("power.csv"), power(&passes, feed, 20)).unwrap();
    fs::write(at.join("trace.toml"), "operator = \"A. Weld\"\n[wire]\nbatch = 4711\n").unwrap();
    let arguments =
        ["record", "out/plan.json", "--source", "power.csv", "--trace-file", "trace.toml", "--trace", "wps=12-3"];
    let said = ok(at, &arguments);
    let count = passes.len();
    assert!(said.contains(&format!("{count} of {count} planned passes were welded")), "{said}");
    assert!(said.contains("the wire feed reached") && said.contains("(-40 %)"), "{said}");
    let seal = said.lines().last().unwrap();
    let record: serde_json::Value = serde_json::from_slice(&fs::read(at.join("record/record.json")).unwrap()).unwrap();
    assert_eq!(record["seal"], seal);
    assert_eq!(record["findings"].as_array().unwrap().len(), 1, "{}", record["findings"]);
    assert_eq!(record["findings"][0]["pass"], 20);
    let names: Vec<&str> = record["trace"].as_array().unwrap().iter().map(|t| t["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["operator", "wire.batch", "wps"]);
    let near = |a: &serde_json::Value, b: &serde_json::Value, part: f64| {
        let [a, b] = [a, b].map(|value| value.as_f64().unwrap());
        assert!((a / b - 1.0).abs() < part, "{a} {b}");
    };
    near(&record["recorded"]["arc_hours"], &record["planned"]["arc_hours"], 0.02);
    near(&record["recorded"]["cost"], &record["planned"]["cost"], 0.1);
    // 150 A × 18.5 V for the time of the arc, by what the log measured.
    let kwh = 2.775 * record["recorded"]["arc_hours"].as_f64().unwrap();
    near(&record["recorded"]["energy_kwh"], &kwh.into(), 1e-3);
    let co2 = 5.0 * record["recorded"]["wire_kg"].as_f64().unwrap() + 0.4 * kwh;
    near(&record["recorded"]["co2_kg"], &co2.into(), 1e-3);
    near(&record["recorded"]["co2_kg"], &record["planned"]["co2_kg"], 0.1);

    let whole = ok(at, &["record", "--verify", "record", "--seal", seal, "--source", "power.csv"]);
    assert!(whole.contains("the record is whole"), "{whole}");
    assert!(ok(at, &arguments).ends_with(&format!("{seal}\n")), "the same input gives the same bytes");
    opened(at, &record);
    tampered(at, &record);
}

/// Whoever changes a value, a file or a log is found.
fn tampered(at: &Path, record: &serde_json::Value) {
    let path = at.join("record/record.json");
    let text = fs::read_to_string(&path).unwrap();
    let row = record["passes"][20].clone();
    let (layer, pass) = (&row["pass"]["layer"], &row["pass"]["pass"]);
    let burned = format!("\"burned\":{}", row["pass"]["burned"]);
    let line = text.lines().nth(21).unwrap();
    fs::write(&path, text.replace(line, &line.replace(&burned, "\"burned\":1.5"))).unwrap();
    let verify = ["record", "--verify", "record"];
    let said = String::from_utf8(crate::common::beadwright(at, &verify).stdout).unwrap();
    assert!(said.contains(&format!("(layer {layer}, pass {pass})")), "{said}");
    refused(at, &verify, 3);
    fs::write(&path, &text).unwrap();
    ok(at, &verify);
    let page = at.join("record/record.html");
    fs::write(&page, fs::read_to_string(&page).unwrap() + " ").unwrap();
    let said = String::from_utf8(crate::common::beadwright(at, &verify).stdout).unwrap();
    assert!(said.contains("record.html was changed"), "{said}");
    fs::write(at.join("power.csv"), "time,current\n0,1\n").unwrap();
    let said =
        crate::common::beadwright(at, &["record", "--verify", "record", "--source", "power.csv", "--json"]).stdout;
    let said: serde_json::Value = serde_json::from_slice(&said).unwrap();
    assert_eq!(said["changed"], serde_json::json!(["record.html was changed", "power.csv was changed"]));
}

/// The table, read by pyarrow.
fn opened(at: &Path, record: &serde_json::Value) {
    let script = "import json, pyarrow.parquet as p\nt = p.read_table('record/record.parquet').to_pydict()\n\
                  print(json.dumps([t['layer'], t['pass'], t['findings'], t['burned (s)'], t['wire feed mean (m/min)']]))";
    let asked = python(at, &["-c", "import pyarrow.parquet"]);
    if !asked.is_ok_and(|asked| asked.status.success()) {
        eprintln!("not opened: pyarrow is not installed (BEADWRIGHT_PYTHON_PACKAGES names a folder with it)");
        return;
    }
    let said = python(at, &["-c", script]).unwrap();
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    let seen: serde_json::Value = serde_json::from_slice(&said.stdout).unwrap();
    let rows = record["passes"].as_array().unwrap();
    for (k, row) in rows.iter().enumerate() {
        let row = &row["pass"];
        assert_eq!([&seen[0][k], &seen[1][k], &seen[2][k]], [&row["layer"], &row["pass"], &row["findings"]]);
        let mean = &row["quantities"][0][2]["mean"];
        let near =
            |a: &serde_json::Value, b: &serde_json::Value| (a.as_f64().unwrap() - b.as_f64().unwrap()).abs() < 1e-9;
        assert!(near(&seen[3][k], &row["burned"]) && near(&seen[4][k], mean), "{k}: {row}");
    }
}

/// A wall with a bump between x 10 and 30 mm on its layer 20: the record has it at its place, and in its hashes.
#[test]
fn a_scan_of_a_layer_belongs_to_the_record() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    ok(at, &["example", "wall"]);
    ok(
        at,
        &[
            "plan",
            "wall.stl",
            "-p",
            "cmt-steel-abb",
            "--no-deposit",
            "-o",
            "out",
            "--set",
            "process.current=150",
            "--set",
            "process.voltage=18.5",
        ],
    );
    let plan: serde_json::Value = serde_json::from_slice(&fs::read(at.join("out/plan.json")).unwrap()).unwrap();
    let delay = plan["profile"]["process"]["arc_start_delay"].as_f64().unwrap();
    let passes = times(at, [delay, 0.0]);
    let feed = plan["profile"]["process"]["wire_feed_speed"].as_f64().unwrap();
    fs::write(at.join("power.csv"), power(&passes, feed, usize::MAX)).unwrap();
    let z = plan["layers"][19]["z"].as_f64().unwrap();
    let point = |i: i32| {
        let (x, y) = (f64::from(i / 9) * 0.5 - 59.0, f64::from(i % 9) * 0.5 - 2.0);
        // Of the left end, the scanner saw nothing.
        let seen = x > -40.0;
        let bump = if (10.0..=30.0).contains(&x) { 1.5 } else { 0.1 };
        if seen { format!("{x},{y},{}\n", z + bump) } else { String::new() }
    };
    fs::write(at.join("scan.csv"), "x,y,z\n".to_owned() + &(0..237 * 9).map(point).collect::<String>()).unwrap();
    let record = ["record", "out/plan.json", "--source", "power.csv", "--scan", "scan.csv"];
    let with_layer = [&record[..], &["--after-layer", "20", "--height", "0.7"]].concat();
    let said = ok(at, &with_layer);
    assert!(said.contains("1 pass was scanned") && said.contains("mm higher than planned"), "{said}");
    let json: serde_json::Value = serde_json::from_slice(&fs::read(at.join("record/record.json")).unwrap()).unwrap();
    let found: Vec<&serde_json::Value> =
        json["findings"].as_array().unwrap().iter().filter(|finding| finding["kind"] == "height").collect();
    assert_eq!(found.len(), 1, "{}", json["findings"]);
    let mut ends = [0, 1].map(|k| found[0]["place"][k]["at"][0].as_f64().unwrap());
    ends.sort_by(f64::total_cmp);
    assert!((ends[0] - 10.0).abs() < 4.0 && (ends[1] - 30.0).abs() < 4.0, "{ends:?}");
    let rows = json["passes"].as_array().unwrap();
    let scanned: Vec<&serde_json::Value> =
        rows.iter().map(|row| &row["pass"]).filter(|row| !row["off"].is_null()).collect();
    assert!(scanned.len() == 1 && scanned[0]["layer"] == 20 && scanned[0]["findings"] == 1, "{scanned:?}");
    let number = |of: &serde_json::Value| of.as_f64().unwrap();
    assert!(
        (number(&scanned[0]["off"]["max"]) - number(&scanned[0]["off"]["min"]) - 1.4).abs() < 0.3,
        "{}",
        scanned[0]
    );
    assert!((number(&scanned[0]["height"][0]) - z).abs() < 0.3, "{}", scanned[0]);
    let page = fs::read_to_string(at.join("record/record.html")).unwrap();
    assert!(page.contains("Height of each pass where it was scanned") && page.contains("higher than planned"));
    ok(at, &["record", "--verify", "record", "--scan", "scan.csv"]);
    fs::write(at.join("scan.csv"), "x,y,z\n0,0,1\n").unwrap();
    let said = crate::common::beadwright(at, &["record", "--verify", "record", "--scan", "scan.csv", "--json"]).stdout;
    let said: serde_json::Value = serde_json::from_slice(&said).unwrap();
    assert_eq!(said["changed"], serde_json::json!(["scan.csv was changed"]));
    assert!(refused(at, &record, 1).contains("give --after-layer with each --scan"));
    assert!(refused(at, &with_layer, 1).contains("scan.csv"));
}

#[test]
fn what_cannot_be_joined_is_refused_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    ok(at, &["example", "star", "-o", "star.stl"]);
    ok(at, &["plan", "star.stl", "--no-deposit", "-o", "out"]);
    let fails = |text: &str, more: &[&str]| {
        fs::write(at.join("log.csv"), text).unwrap();
        let said = refused(at, &[&["record", "out/plan.json", "--source", "log.csv"], more].concat(), 1);
        assert!(!at.join("record").exists(), "nothing is written");
        said
    };
    assert!(
        fails("when,current\n1,2\n", &[])
            .contains("log.csv: line 1: no column is named time. The header names when, current.")
    );
    assert!(fails("time,current\n1,2\n2,3\n", &[]).contains("no log says when the arc burned"));
    assert!(fails("time,current\n1,2\n", &["--column", "voltage=U"]).contains("no log has such a column"));
    assert!(fails("time,current\n1,2\n", &["--least", "0"]).contains("the least stretch = 0 s"));
    refused(at, &["record", "out/plan.json"], 2);
    refused(at, &["record", "out/plan.json", "--source", "log.csv", "--window", "colour=3"], 2);
    assert!(refused(at, &["record", "--verify", "nowhere"], 1).contains("nowhere"));
}

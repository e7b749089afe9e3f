//! `beadwright record`: a plan and logs become a record; a change of it shows; pyarrow opens its table.

use crate::common::{ok, refused};
use crate::height::{leaning_cell, seen_by_scanner};
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

/// The wall, planned and logged: the tops of its layers, mm.
fn wall(at: &Path) -> Vec<f64> {
    ok(at, &["example", "wall"]);
    let process = ["--set", "process.current=150", "--set", "process.voltage=18.5"];
    ok(at, &[&["plan", "wall.stl", "-p", "cmt-steel-abb", "--no-deposit", "-o", "out"][..], &process].concat());
    let plan: serde_json::Value = serde_json::from_slice(&fs::read(at.join("out/plan.json")).unwrap()).unwrap();
    let delay = plan["profile"]["process"]["arc_start_delay"].as_f64().unwrap();
    let feed = plan["profile"]["process"]["wire_feed_speed"].as_f64().unwrap();
    fs::write(at.join("power.csv"), power(&times(at, [delay, 0.0]), feed, usize::MAX)).unwrap();
    plan["layers"].as_array().unwrap().iter().map(|layer| layer["z"].as_f64().unwrap()).collect()
}

/// Points over the wall, so high at each x (mm); none where that is not known.
fn scan(height: impl Fn(f64) -> Option<f64>) -> Vec<[f64; 3]> {
    let place = |i: i32| [f64::from(i / 9) * 0.5 - 59.0, f64::from(i % 9) * 0.5 - 2.0];
    (0..237 * 9).map(place).filter_map(|[x, y]| Some([x, y, height(x)?])).collect()
}

fn write_scan(path: &Path, points: &[[f64; 3]]) {
    let rows: String = points.iter().map(|[x, y, z]| format!("{x},{y},{z}\n")).collect();
    fs::write(path, "x,y,z\n".to_owned() + &rows).unwrap();
}

fn json(path: &Path) -> serde_json::Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

fn number(of: &serde_json::Value) -> f64 {
    of.as_f64().unwrap_or_else(|| panic!("{of} is not a number"))
}

/// A bump between x 10 and 30 mm on layer 20, of whose left end the scanner saw nothing, and a dent between -20 and 0 mm on layer 30: the
/// record has each at its layer and place, whichever scan is named first, and all of it in its hashes.
#[test]
fn scans_of_layers_belong_to_the_record() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let tops = wall(at);
    let bump = |x: f64| (x > -40.0).then(|| tops[19] + if (10.0..=30.0).contains(&x) { 1.5 } else { 0.1 });
    let dent = |x: f64| Some(tops[29] - if (-20.0..=0.0).contains(&x) { 1.2 } else { 0.0 });
    write_scan(&at.join("20.csv"), &scan(bump));
    write_scan(&at.join("30.csv"), &scan(dent));
    let scans = ["--scan", "30.csv", "--after-layer", "30", "--scan", "20.csv", "--after-layer", "20"];
    let record = [&["record", "out/plan.json", "--source", "power.csv", "--height", "0.7"][..], &scans].concat();
    let said = ok(at, &record);
    for layer in ["20.csv                   1 of 1 passes of layer 20, ", "1 of 1 passes of layer 30, "] {
        assert!(said.contains(layer), "{said}");
    }
    let json = json(&at.join("record/record.json"));
    let found: Vec<&serde_json::Value> =
        json["findings"].as_array().unwrap().iter().filter(|finding| finding["kind"] == "height").collect();
    assert_eq!(found.len(), 2, "{}", json["findings"]);
    for (finding, way, ends) in [(found[0], "higher", [10.0, 30.0]), (found[1], "lower", [-20.0, 0.0])] {
        assert!(finding["sentence"].as_str().unwrap().contains(way), "{finding}");
        let mut seen = [0, 1].map(|k| number(&finding["place"][k]["at"][0]));
        seen.sort_by(f64::total_cmp);
        assert!((0..2).all(|k| (seen[k] - ends[k]).abs() < 4.0), "{seen:?} {ends:?}");
    }
    let rows: Vec<&serde_json::Value> = json["passes"].as_array().unwrap().iter().map(|row| &row["pass"]).collect();
    let scanned: Vec<&serde_json::Value> = rows.iter().copied().filter(|row| !row["off"].is_null()).collect();
    assert_eq!(scanned.iter().map(|row| &row["layer"]).collect::<Vec<_>>(), [20, 30]);
    // Of the 99 mm that were seen of layer 20, 20 mm were 1.5 mm too high, and the rest 0.1 mm.
    let means = [(19, (20.0 * 1.5 + 79.0 * 0.1) / 99.0), (29, -1.2 * 20.0 / 118.0)];
    for (row, (layer, mean)) in scanned.iter().zip(means) {
        let (height, off) = ([0, 1].map(|k| number(&row["height"][k])), &row["off"]);
        assert!((height[0] - tops[layer]).abs() < 0.3 && (height[1] - tops[layer] - mean).abs() < 0.1, "{row}");
        assert!((number(&off["mean"]) - height[1] + height[0]).abs() < 1e-9, "{row}");
        assert!(row["findings"] == 1, "{row}");
    }
    let ends = |row: &serde_json::Value| ["min", "max"].map(|end| number(&row["off"][end]));
    let ([low, high], [lowest, _]) = (ends(scanned[0]), ends(scanned[1]));
    assert!((low - 0.1).abs() < 0.1 && (high - 1.5).abs() < 0.1 && (lowest + 1.2).abs() < 0.1, "{scanned:?}");
    // Nothing is filled in where the scanner saw nothing: 19 of the 118 mm.
    let [part, whole] = [0, 1].map(|k| number(&scanned[k]["scanned"]));
    assert!((part / whole - 99.0 / 118.0).abs() < 0.06 && whole > 0.85, "{part} of {whole}");
    let heads = json["scans"].as_array().unwrap();
    let known = |head: &serde_json::Value| (head["file"].clone(), head["after_layer"].clone(), head["passes"].clone());
    assert_eq!(known(&heads[0]), ("30.csv".into(), 30.into(), serde_json::json!([1, 1])));
    assert_eq!(known(&heads[1]), ("20.csv".into(), 20.into(), serde_json::json!([1, 1])));
    assert!((number(&heads[1]["covered"]) - part).abs() < 1e-9 && number(&heads[1]["points"]) > 500.0, "{heads:?}");
    assert!(heads[0]["part_from_scanner"].is_null(), "{heads:?}");
    let page = fs::read_to_string(at.join("record/record.html")).unwrap();
    for text in ["Height of each pass where it was scanned", "lower than planned", "height off, least mm", "Scans"] {
        assert!(page.contains(text), "{text}");
    }
    heights_opened(at, &rows);

    let files = ["--scan", "20.csv", "--scan", "30.csv"];
    let verify = [&["record", "--verify", "record"][..], &files].concat();
    ok(at, &verify);
    write_scan(&at.join("20.csv"), &[[0.0, 0.0, 1.0]]);
    let said = crate::common::beadwright(at, &[&verify[..], &["--json"]].concat()).stdout;
    let said: serde_json::Value = serde_json::from_slice(&said).unwrap();
    assert_eq!(said["changed"], serde_json::json!(["20.csv was changed"]));
    assert!(refused(at, &record, 1).contains("20.csv"));
}

/// The columns of heights, read by pyarrow.
fn heights_opened(at: &Path, rows: &[&serde_json::Value]) {
    let names = [
        "height planned (mm)",
        "height (mm)",
        "height off, mean (mm)",
        "height off, least (mm)",
        "height off, greatest (mm)",
        "height off, deviation (mm)",
        "length scanned (%)",
    ];
    let script = format!(
        "import json, math, pyarrow.parquet as p\nt = p.read_table('record/record.parquet').to_pydict()\n\
         print(json.dumps([[None if math.isnan(v) else v for v in t[name]] for name in {names:?}]))"
    );
    let asked = python(at, &["-c", "import pyarrow.parquet"]);
    if !asked.is_ok_and(|asked| asked.status.success()) {
        eprintln!("not opened: pyarrow is not installed (BEADWRIGHT_PYTHON_PACKAGES names a folder with it)");
        return;
    }
    let said = python(at, &["-c", &script]).unwrap();
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    let seen: Vec<Vec<Option<f64>>> = serde_json::from_slice(&said.stdout).unwrap();
    for (k, row) in rows.iter().enumerate() {
        let (height, off) = (&row["height"], &row["off"]);
        let percent = row["scanned"].as_f64().map(|share| 100.0 * share);
        let own = [&height[0], &height[1], &off["mean"], &off["min"], &off["max"], &off["deviation"]];
        for (column, own) in seen.iter().zip(own.map(serde_json::Value::as_f64).into_iter().chain([percent])) {
            let same = match (column[k], own) {
                (Some(a), Some(b)) => (a - b).abs() < 1e-9,
                (a, b) => a.is_none() && b.is_none(),
            };
            assert!(same, "{k}: {row}");
        }
    }
}

/// The frame of the scanner is in the record, and its cell among what is hashed; files of one name are told apart by their hashes.
#[test]
fn what_heights_depend_on_is_in_the_record() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let tops = wall(at);
    let lean = |x: f64| Some(tops[19] + 0.2 + 0.004 * x);
    let points = scan(lean);
    write_scan(&at.join("part.csv"), &points);
    write_scan(&at.join("seen.csv"), &points.into_iter().map(seen_by_scanner).collect::<Vec<_>>());
    fs::write(at.join("cell.toml"), leaning_cell(at)).unwrap();
    for (folder, text) in [("a", "first"), ("b", "second")] {
        fs::create_dir(at.join(folder)).unwrap();
        fs::write(at.join(folder).join("wall.src"), text).unwrap();
    }
    let files = ["--file", "a/wall.src", "--file", "b/wall.src"];
    let record = |scan: &[&str]| {
        let own = ["record", "out/plan.json", "--source", "power.csv", "--after-layer", "20"];
        ok(at, &[&own[..], scan, &files].concat());
        json(&at.join("record/record.json"))
    };
    let row = |record: &serde_json::Value| record["passes"][19]["pass"].clone();
    let own = row(&record(&["--scan", "part.csv"]));
    let moved = record(&["--scan", "seen.csv", "--scanner", "cell.toml"]);
    for k in 0..2 {
        assert!((number(&own["height"][k]) - number(&row(&moved)["height"][k])).abs() < 1e-3, "{own} {moved}");
    }
    let place = &moved["scans"][0]["part_from_scanner"];
    let origin = [0, 1, 2].map(|k| number(&place["position"][k]));
    assert!(seen_by_scanner(origin).iter().all(|v| v.abs() < 1e-6), "where the scanner stands: {place}");
    assert!(moved["inputs"].as_array().unwrap().iter().any(|input| input["name"] == "cell.toml"));

    let verify = ["record", "--verify", "record", "--scan", "seen.csv", "--scanner", "cell.toml"];
    let verify = [&verify[..], &files].concat();
    ok(at, &verify);
    ok(at, &["record", "--verify", "record", "--file", "b/wall.src"]);
    let changed = || {
        let said = crate::common::beadwright(at, &[&verify[..], &["--json"]].concat()).stdout;
        serde_json::from_slice::<serde_json::Value>(&said).unwrap()["changed"].clone()
    };
    fs::write(at.join("cell.toml"), leaning_cell(at).replace("1260", "1261")).unwrap();
    assert_eq!(changed(), serde_json::json!(["cell.toml was changed"]));
    fs::write(at.join("b/wall.src"), "third").unwrap();
    assert_eq!(changed(), serde_json::json!(["cell.toml was changed", "wall.src was changed"]));
}

/// Faults of the command show before anything long is read or computed: here, before a log that is not there.
#[test]
fn scans_that_cannot_be_compared_are_refused_before_logs_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    wall(at);
    fs::write(at.join("cell.toml"), ok(at, &["reach", "--show", "kuka-kr20-r1810"])).unwrap();
    let fails = |plan: &str, more: &[&str]| {
        refused(at, &[&["record", plan, "--temperatures", "--source", "nothing.csv"], more].concat(), 1)
    };
    let own = |more: &[&str]| fails("out/plan.json", more);
    assert!(own(&[]).contains("nothing.csv"));
    let said = own(&["--scan", "a.csv"]);
    assert!(said.contains("Each --scan needs its --after-layer (1 scan, 0 layers given)."), "{said}");
    assert!(own(&["--after-layer", "3"]).contains("(0 scans, 1 layer given)"));
    let twice = own(&["--scan", "a.csv", "--after-layer", "3", "--scan", "b.csv", "--after-layer", "3"]);
    assert!(twice.contains("--after-layer 3 is given twice"), "{twice}");
    let scanned = ["--scan", "a.csv", "--after-layer"];
    let said = own(&[&scanned[..], &["51"]].concat());
    assert!(said.contains("plan.json: the plan has the layers 1 to 50; layer 51 is not one of them"), "{said}");
    let said = own(&[&scanned[..], &["20", "--scanner", "cell.toml"]].concat());
    assert!(said.contains("cell.toml: the cell has no [scanner]"), "{said}");
    assert!(own(&[&scanned[..], &["20", "--scanner", "none.toml"]].concat()).contains("none.toml"));
    let said = own(&["--scanner", "cell.toml"]);
    assert!(said.contains("--scanner says where scans lie: give them with --scan"), "{said}");
    refused(at, &["record", "out/plan.json", "--source", "power.csv", "--height", "0.5"], 2);

    ok(at, &["example", "pot", "-o", "pot.igs"]);
    let helix = ["plan", "pot.igs", "-p", "cmt-steel-abb", "--set", "wall.helix=true", "--no-deposit", "-o", "helix"];
    ok(at, &helix);
    let said = fails("helix/plan.json", &[&scanned[..], &["5"]].concat());
    assert!(said.contains("plan.json: layer 5 is a turn of a helix"), "{said}");
    ok(at, &["example", "shaft", "-o", "shaft.stl"]);
    ok(at, &["plan", "shaft.stl", "--chart", "cylinder:axis=z,radius=25", "--no-deposit", "-o", "around"]);
    let said = fails("around/plan.json", &[&scanned[..], &["1"]].concat());
    assert!(said.contains("plan.json: scans are compared with level layers only"), "{said}");
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

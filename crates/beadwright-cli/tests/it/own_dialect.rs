//! A dialect without a line of Rust: the gantry of `examples/dialects`, planned by the command and read by a small reader
//! that knows its language only.

use crate::common::{beadwright, ok, refused};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

type Point = [f64; 3];

fn gantry() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/dialects/gantry")
}

/// A folder with a part, and with a copy of the gantry's templates to break.
fn shop() -> TempDir {
    let folder = TempDir::new().unwrap();
    ok(folder.path(), &["example", "cross"]);
    fs::create_dir(folder.path().join("gantry")).unwrap();
    for entry in fs::read_dir(gantry()).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, folder.path().join("gantry").join(path.file_name().unwrap())).unwrap();
    }
    folder
}

fn json(path: &Path) -> serde_json::Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

/// What a program of the gantry does.
#[derive(Default)]
struct Run {
    at: Option<Point>,
    /// Points of each pass, its start first.
    passes: Vec<Vec<Point>>,
    burns: bool,
    gas: bool,
    deposited: f64,
    travel: f64,
    curves: usize,
    /// Time with the arc on and moving, and all time, s.
    arc: f64,
    time: f64,
}

fn distance(a: Point, b: Point) -> f64 {
    (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum::<f64>().sqrt()
}

impl Run {
    /// Runs a file: `B00010 WORD …` in each line, numbers going up in tens, and comments after `!`.
    fn file(&mut self, folder: &Path, name: &str) {
        let text = fs::read_to_string(folder.join(name)).unwrap();
        assert!(
            text.is_ascii() && text.ends_with("\r\n") && text.matches('\n').count() == text.matches("\r\n").count()
        );
        let mut last = 0;
        let mut ended = false;
        for line in text.split_terminator("\r\n").filter(|line| !line.starts_with("! ")) {
            assert!(!ended, "{name}: after its end: {line}");
            let words: Vec<&str> = line.split(' ').collect();
            let number: u32 = words[0].strip_prefix('B').filter(|n| n.len() == 5).unwrap().parse().unwrap();
            assert_eq!(number, last + 10, "{name}: {line}");
            last = number;
            match &words[1..] {
                ["UNITS", "MM", "SECONDS"] => assert!(self.at.is_none()),
                ["CALL", file] => self.file(folder, file),
                ["RETURN" | "STOP"] => ended = true,
                ["PAUSE", seconds] => self.time += seconds.parse::<f64>().unwrap(),
                ["GAS", "ON"] => self.gas = true,
                ["GAS", "OFF"] => self.gas = self.burns,
                ["ARC", "ON"] => {
                    assert!(self.gas && !std::mem::replace(&mut self.burns, true), "{line}");
                    self.passes.push(vec![self.at.unwrap()]);
                }
                ["ARC", "OFF"] => assert!(std::mem::replace(&mut self.burns, false), "{line}"),
                [word @ ("RAPID" | "LINE" | "CURVE"), rest @ ..] => self.go(word, rest, line),
                _ => panic!("{name}: {line}"),
            }
        }
        assert!(ended && !self.burns && !self.gas, "{name} has no end");
    }

    fn go(&mut self, word: &str, words: &[&str], line: &str) {
        let values: BTreeMap<&str, f64> =
            words.iter().map(|w| w.split_once('=').unwrap()).map(|(k, v)| (k, v.parse().unwrap())).collect();
        let to = ["X", "Y", "Z"].map(|axis| values[axis]);
        assert_eq!(word == "RAPID", !self.burns, "{line}");
        assert_eq!(values.len(), if word == "CURVE" { 7 } else { 4 }, "{line}");
        let from = self.at.replace(to);
        let Some(from) = from else { return };
        let length = if word == "CURVE" {
            self.curves += 1;
            let (centre, sweep) = ([values["CX"], values["CY"], to[2]], values["A"].to_radians());
            let (radius, x, y) = (distance(from, centre), from[0] - centre[0], from[1] - centre[1]);
            // Turned about the centre, the start comes to the end.
            let (sin, cos) = sweep.sin_cos();
            let end = [centre[0] + cos * x - sin * y, centre[1] + sin * x + cos * y, to[2]];
            assert!(distance(end, to) < 2e-3, "{line}: {end:?}");
            radius * sweep.abs()
        } else {
            distance(from, to)
        };
        let seconds = length / values["V"];
        self.time += seconds;
        if self.burns {
            (self.deposited, self.arc) = (self.deposited + length, self.arc + seconds);
            self.passes.last_mut().unwrap().push(to);
        } else {
            self.travel += length;
        }
    }
}

fn close(a: f64, b: f64, what: &str) {
    println!("{what}: {a:.3} for {b:.3}");
    assert!((a / b - 1.0).abs() < 1e-3, "{what}: {a} for {b}");
}

/// Starts, lengths and times of a run against the plan's totals.
fn as_planned(run: &Run, metrics: &serde_json::Value, crater: f64) {
    let of = |key: &str| metrics[key].as_f64().unwrap();
    assert_eq!(run.passes.len() as f64, of("arc_starts"));
    close(run.deposited, of("deposited_length_mm"), "deposited length");
    close(run.arc, of("arc_time_s") - crater * of("arc_starts"), "arc time");
    // The program also comes down to the first point, 20 mm at 100 mm/s.
    close(run.travel, of("travel_length_mm") + 20.0, "travel");
    close(run.time, of("total_time_s") + 0.2, "total time");
}

#[test]
fn a_gantry_runs_what_was_planned() {
    let folder = shop();
    ok(folder.path(), &["plan", "cross.stl", "--post", "./gantry", "-s", "contour", "-o", "out", "--no-deposit"]);
    let out = folder.path().join("out");
    let mut run = Run::default();
    run.file(&out, "CROSS.GTY");
    as_planned(&run, &json(&out.join("metrics.json")), 0.0);
    let plan = json(&out.join("plan.json"));
    let passes = plan["layers"].as_array().unwrap().iter().flat_map(|layer| layer["passes"].as_array().unwrap());
    let mut count = 0;
    for (pass, run) in passes.zip(&run.passes) {
        let points: Vec<Point> = serde_json::from_value(pass["points"].clone()).unwrap();
        let near = |p: &Point, others: &[Point]| others.iter().any(|q| distance(*p, *q) < 0.011);
        assert!(distance(points[0], run[0]) < 1e-3, "{points:?}");
        assert!(points.iter().all(|p| near(p, run)) && run.iter().all(|p| near(p, &points)), "pass {count}");
        count += 1;
    }
    assert_eq!(count, run.passes.len());
    assert!(
        out.join("CROSS_0010.GTY").is_file()
            && json(&out.join("metrics.json"))["files"].to_string().contains("CROSS_0010.GTY")
    );
}

/// Arcs, craters and waits, from a profile that names the folder beside it.
#[test]
fn a_profile_names_the_folder_of_its_dialect() {
    let folder = shop();
    let profile = beadwright(folder.path(), &["profile", "show", "cmt-al2319-kuka"]).stdout;
    let profile = String::from_utf8(profile).unwrap().replace("posts = [\"krl\"]", "posts = [\"./gantry\"]");
    fs::create_dir(folder.path().join("shop")).unwrap();
    fs::rename(folder.path().join("gantry"), folder.path().join("shop/gantry")).unwrap();
    fs::write(folder.path().join("shop/ours.toml"), profile).unwrap();
    ok(folder.path(), &["profile", "check", "shop/ours.toml"]);
    let mut arguments = vec!["plan", "cross.stl", "-p", "shop/ours.toml", "-s", "contour", "-o", "out", "--no-deposit"];
    for set in [
        "program.chord_tolerance=0.05",
        "program.arcs=true",
        "start_stop.crater_fill_time=0.5",
        "start_stop.crater_power=0.6",
        "start_stop.interpass_time=30",
    ] {
        arguments.extend(["--set", set]);
    }
    ok(folder.path(), &arguments);
    let out = folder.path().join("out");
    let mut run = Run::default();
    // The wire feed is a word more.
    let files: Vec<PathBuf> = fs::read_dir(&out).unwrap().map(|e| e.unwrap().path()).collect();
    let feeds = files.iter().filter(|p| p.extension().is_some_and(|e| e == "GTY")).map(|path| {
        let text = fs::read_to_string(path).unwrap();
        let (mut number, mut kept) = (0, String::new());
        for line in text.split_terminator("\r\n") {
            let feed = line.split_once(" WIRE ").filter(|_| line.starts_with('B'));
            if let Some((_, percent)) = feed {
                assert!(["100.0", "60.0"].contains(&percent), "{line}");
            } else if line.starts_with('B') {
                number += 10;
                kept.push_str(&format!("B{number:05}{}\r\n", &line[6..]));
            } else {
                kept.push_str(&format!("{line}\r\n"));
            }
        }
        fs::write(path, kept).unwrap();
        text.matches(" WIRE 60.0").count()
    });
    let feeds: usize = feeds.sum();
    run.file(&out, "CROSS.GTY");
    let metrics = json(&out.join("metrics.json"));
    assert_eq!(feeds as u64, metrics["arc_starts"].as_u64().unwrap(), "craters");
    assert!(run.curves > 50, "{}", run.curves);
    as_planned(&run, &metrics, 0.5);
}

#[test]
fn a_broken_template_is_reported_with_its_line_and_nothing_is_written() {
    let folder = shop();
    let all = ["plan", "cross.stl", "--post", "./gantry", "-o", "out", "--no-deposit"];
    let layer = folder.path().join("gantry/layer.txt");
    let whole = fs::read_to_string(&layer).unwrap();
    fs::write(&layer, whole.replace("step.speed | fixed(3)", "step.sped | fixed(3)")).unwrap();
    let said = refused(folder.path(), &all, 1);
    assert!(said.contains("./gantry, layer.txt, line 12") && said.contains("\"sped\"; it has"), "{said}");
    assert!(!folder.path().join("out").exists());
    // What the rehearsal cannot foresee ends the plan, and still nothing is written.
    fs::write(&layer, whole.replace("{% for step", "{% if layer == 7 %}{{ layer / 0 }}{% endif %}{% for step"))
        .unwrap();
    let said = refused(folder.path(), &all, 1);
    assert!(said.contains("./gantry, layer.txt, line 3"), "{said}");
    assert!(!folder.path().join("out").exists());
    fs::write(&layer, whole).unwrap();
    let said = refused(folder.path(), &["plan", "cross.stl", "--post", "./gantries"], 1);
    assert!(said.contains("./gantries") && said.contains("cannot be read"), "{said}");
    let said = refused(folder.path(), &["plan", "cross.stl", "--post", "gantry"], 1);
    assert!(said.contains("./gantry"), "{said}");
    let twice = [&all[..], &["--post", "./gantry"]].concat();
    assert!(refused(folder.path(), &twice, 1).contains("would both write CROSS.GTY"));
    ok(folder.path(), &all);
}

/// A link in the folder is refused, not left out: the author meant it to be read.
#[cfg(unix)]
#[test]
fn templates_see_their_folder_only() {
    let folder = shop();
    fs::write(folder.path().join("secret.txt"), "secret").unwrap();
    let (link, end) = (folder.path().join("gantry/secret.txt"), folder.path().join("gantry/end.txt"));
    let whole = fs::read_to_string(&end).unwrap();
    let plan = ["plan", "cross.stl", "--post", "./gantry", "-o", "out"];
    std::os::unix::fs::symlink(folder.path().join("secret.txt"), &link).unwrap();
    let said = refused(folder.path(), &plan, 1);
    assert!(said.contains("secret.txt: it is a link") && said.contains("Copy the file there"), "{said}");
    fs::remove_file(link).unwrap();
    for name in ["secret.txt", "../secret.txt", "/etc/passwd"] {
        fs::write(&end, format!("{{% include \"{name}\" %}}\n{whole}")).unwrap();
        let said = refused(folder.path(), &plan, 1);
        assert!(said.contains("only files of this folder") && said.contains("end.txt, line 1"), "{said}");
    }
}

//! `beadwright bead fit --from`: records of a cell that differs from its profile in known ways bring the profile to the truth.

use crate::common::{ok, refused};
use crate::record::times;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// The cell feeds 4 % less wire than is set, with 158 A instead of 150 A; its voltage is that of the profile.
const FED: f64 = 0.96;
const CURRENT: f64 = 158.0;

/// A number from −1 to 1 that looks random.
fn noise(row: usize) -> f64 {
    (row as f64 * 12.9898).sin()
}

/// The log of such a cell, 10 rows a second; before each pass the metal has the temperature that is given.
fn log(passes: &[[f64; 2]], feed: f64, temperatures: &[f64]) -> String {
    let mut text = "time_s,wire_feed_speed_m_min,current_a,voltage_v,temperature_c\n".to_owned();
    for row in 0..((passes[passes.len() - 1][1] + 10.0) * 10.0) as usize {
        let time = row as f64 / 10.0;
        let next = passes.partition_point(|[_, end]| *end <= time);
        let burns = passes.get(next).is_some_and(|[start, _]| time >= *start);
        let on = f64::from(u8::from(burns));
        let warm = temperatures.get(next).copied().unwrap_or(25.0);
        let (fed, current) = (on * feed * FED * (1.0 + 0.01 * noise(row)), on * (CURRENT + 3.0 * noise(row + 7)));
        writeln!(text, "{time:.1},{fed:.4},{current:.2},{:.2},{warm:.2}", on * 18.5).unwrap();
    }
    text
}

fn json(path: &Path) -> serde_json::Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

#[test]
fn a_profile_learns_what_its_cell_does() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    ok(at, &["example", "star", "-o", "star.stl"]);
    let told = ["--set", "process.current=150", "--set", "process.voltage=18.5"];
    ok(
        at,
        &[&["plan", "star.stl", "-p", "cmt-al2319-kuka", "-s", "contour", "--no-deposit", "-o", "out"], &told[..]]
            .concat(),
    );
    let profile = json(&at.join("out/plan.json"))["profile"].clone();
    let value = |section: &str, key: &str| profile[section][key].as_f64().unwrap();
    let feed = value("process", "wire_feed_speed");
    let passes = times(at, [value("process", "arc_start_delay"), value("start_stop", "crater_fill_time")]);
    let record = ["record", "out/plan.json", "--source", "power.csv", "--temperatures"];
    fs::write(at.join("power.csv"), log(&passes, feed, &[])).unwrap();
    ok(at, &record);
    // The metal warms by four fifths of what the model says: so much less of the arc's heat reaches it.
    let ambient = value("heat", "ambient");
    let planned = |row: &serde_json::Value| row["pass"]["before"][0].as_f64().unwrap();
    let rows = json(&at.join("record/record.json"));
    let warm = rows["passes"].as_array().unwrap().iter().map(|row| ambient + 0.8 * (planned(row) - ambient));
    fs::write(at.join("power.csv"), log(&passes, feed, &warm.collect::<Vec<_>>())).unwrap();
    ok(at, &record);

    let fit = ["bead", "fit", "--from", "record", "-p", "cmt-al2319-kuka", "--to", "mine.toml", "--json"];
    let learnt: serde_json::Value = serde_json::from_str(&ok(at, &fit)).unwrap();
    let lesson = |key: &str| {
        let lessons = learnt["lessons"].as_array().unwrap();
        let lesson = lessons.iter().find(|lesson| lesson["key"] == key).unwrap_or_else(|| panic!("{key}: {learnt}"));
        let number = |of: &str| lesson["after"][of].as_f64().unwrap();
        (number("value"), number("plus_minus"), lesson["changes"].as_bool().unwrap())
    };
    let efficiency = 0.8 * value("heat", "arc_efficiency");
    for (key, truth, within) in [
        ("process.wire_feed_speed", FED * feed, 2e-3),
        ("process.current", CURRENT, 2e-3),
        ("process.voltage", 18.5, 1e-4),
        ("heat.arc_efficiency", efficiency, 0.02),
    ] {
        let (found, plus_minus, changes) = lesson(key);
        assert!((found / truth - 1.0).abs() < within, "{key}: {found} instead of {truth}");
        assert!(plus_minus < 0.02 * truth && changes, "{key} ± {plus_minus}");
    }
    ok(at, &["profile", "check", "mine.toml"]);
    let mine = fs::read_to_string(at.join("mine.toml")).unwrap();
    assert!(mine.contains(&format!("wire_feed_speed = {:.3}", lesson("process.wire_feed_speed").0)), "{mine}");
    let page = fs::read_to_string(at.join("learnt.html")).unwrap();
    assert!(page.contains("process.wire_feed_speed") && page.contains("What could not be learnt"), "{page}");
    // What was learnt is not learnt again: the same records change nothing in the profile that they corrected.
    let again = ok(at, &["bead", "fit", "--from", "record", "-p", "mine.toml", "--json"]);
    let again: serde_json::Value = serde_json::from_str(&again).unwrap();
    let lessons = again["lessons"].as_array().unwrap();
    assert!(lessons.len() == 4 && lessons.iter().all(|lesson| lesson["changes"] == false), "{again}");

    assert!(refused(at, &["bead", "fit", "--from", "record"], 1).contains("name the profile"));
    let path = at.join("record/record.json");
    fs::write(&path, fs::read_to_string(&path).unwrap().replacen("\"mean\":15", "\"mean\":16", 1)).unwrap();
    let said = refused(at, &fit[..6], 1);
    assert!(said.contains("nothing is learnt from it") && said.contains("was changed"), "{said}");
}

#[test]
fn a_trial_is_fitted_by_what_was_measured_instead_of_what_was_set() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let trial = ["bead", "trial", "-p", "cmt-steel-robots", "--vary", "deposition_speed=5..9", "--repeats", "2"];
    ok(at, &[&trial[..], &["--plate", "500x400", "-o", "trial"]].concat());
    let sheet = fs::read_to_string(at.join("trial/sheet.csv")).unwrap();
    let plates: usize =
        sheet.lines().skip(3).map(|line| line.split(',').nth(1).unwrap().parse().unwrap()).max().unwrap();
    // The robot runs at 95 % of the speeds that were set.
    let mut records = Vec::new();
    for plate in 1..=plates {
        let plan = format!("trial/trial_{plate}/plan.json");
        let plan = if at.join(&plan).exists() { plan } else { "trial/trial/plan.json".to_owned() };
        ok(at, &["export", &plan, "-o", "beads.csv"]);
        let table = fs::read_to_string(at.join("beads.csv")).unwrap();
        let mut log = "time_s,current_a,speed_mm_s\n-5,0,0\n".to_owned();
        let head: Vec<&str> = table.lines().next().unwrap().split(',').collect();
        let column =
            |name: &str| head.iter().position(|own| *own == name).unwrap_or_else(|| panic!("{name}: {head:?}"));
        let [start, time, speed] = ["start (s)", "time (s)", "speed (mm/s)"].map(column);
        for line in table.lines().skip(1) {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
            let (begin, end, speed) = (cells[start], cells[start] + cells[time], 0.95 * cells[speed]);
            for step in 0..((end - begin) * 10.0) as usize {
                writeln!(log, "{:.2},140,{speed:.4}", begin + step as f64 / 10.0).unwrap();
            }
            writeln!(log, "{end:.2},0,0").unwrap();
        }
        fs::write(at.join("log.csv"), log).unwrap();
        let record = format!("record_{plate}");
        ok(at, &["record", &plan, "--source", "log.csv", "-o", &record]);
        records.push(record);
    }
    // Beads of 30 mm³/s: their area, and so their size, depends on the true speed.
    let filled = sheet.lines().map(|line| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if let (Ok(_), Some(Ok(set))) = (cells[0].parse::<usize>(), cells.get(3).map(|cell| cell.parse::<f64>())) {
            let height = (30.0 / (0.95 * set) / 3.0).sqrt();
            (cells[4], cells[5]) = (format!("{:.3}", 3.0 * height), format!("{height:.3}"));
        }
        cells.join(",") + "\n"
    });
    fs::write(at.join("sheet.csv"), filled.collect::<String>()).unwrap();
    assert!(plates > 1, "records may be too few");
    let said = refused(at, &["bead", "fit", "sheet.csv", "--from", &records[0]], 1);
    assert!(said.contains(&format!("1 records for {plates} plates: give one for each plate, in order.")), "{said}");
    let from: Vec<&str> =
        ["bead", "fit", "sheet.csv", "--from"].into_iter().chain(records.iter().map(String::as_str)).collect();
    let said = ok(at, &from);
    assert!(said.contains("4.75 to 8.55 mm/s"), "{said}");
    let said = ok(at, &["bead", "predict", "bead-library.toml", "deposition_speed=6", "--json"]);
    let said: serde_json::Value = serde_json::from_str(&said).unwrap();
    let truth = 3.0 * (30.0_f64 / 6.0 / 3.0).sqrt();
    assert!((said["width_mm"]["value"].as_f64().unwrap() / truth - 1.0).abs() < 0.01, "{said} {truth}");
}

/// A line of a sheet with what was measured in place of its empty cells.
fn filled(sheet: &str, measured: impl Fn(&[f64]) -> Vec<String>) -> String {
    let fill = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let set: Vec<f64> = cells.iter().map_while(|cell| cell.parse().ok()).collect();
        let own = if cells[0].parse::<usize>().is_ok() { measured(&set[3..]) } else { Vec::new() };
        let cell = |(k, cell): (usize, &&str)| {
            k.checked_sub(set.len()).and_then(|k| own.get(k)).cloned().unwrap_or((*cell).to_owned())
        };
        cells.iter().enumerate().map(cell).collect::<Vec<_>>().join(",") + "\n"
    };
    sheet.lines().map(fill).collect()
}

/// A cell whose hump vanishes with 1.5 times the power at the start, and whose crater becomes shallower the longer it is filled: both
/// settings are found, and what is left of the crater.
#[test]
fn starts_and_ends_are_learnt_from_their_trials() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let trial = ["bead", "trial", "-p", "cmt-steel-robots", "--shape", "ends", "--set", "start_stop.lead_in_length=8"];
    let vary =
        ["--vary", "lead_in_power=1..2", "--vary", "crater_fill_time=0.2..1", "--repeats", "2", "--plate", "600x500"];
    let said = ok(at, &[&trial[..], &vary].concat());
    assert!(
        said.contains("18 trials") && said.contains("bead fit trial/sheet.csv -p PROFILE --to FILE.toml"),
        "{said}"
    );
    let sheet = fs::read_to_string(at.join("trial/sheet.csv")).unwrap();
    let measured = |set: &[f64]| {
        let off = 0.03 * noise((100.0 * (set[0] + set[1])) as usize);
        let (hump, crater) = (1.2 * (1.5 - set[0]) + off, 1.3 - 0.9 * set[1] - off);
        [5.6, 2.2, hump, 9.0 + off, crater, 14.0].iter().map(|own| format!("{own:.3}")).collect()
    };
    fs::write(at.join("sheet.csv"), filled(&sheet, measured)).unwrap();
    let fit = ["bead", "fit", "sheet.csv", "-p", "cmt-steel-robots", "--to", "mine.toml"];
    let learnt: serde_json::Value = serde_json::from_str(&ok(at, &[&fit[..], &["--json"]].concat())).unwrap();
    let lesson = |key: &str| {
        let lessons = learnt["lessons"].as_array().unwrap();
        let lesson = lessons.iter().find(|lesson| lesson["key"] == key).unwrap_or_else(|| panic!("{key}: {learnt}"));
        lesson["after"].as_f64().unwrap()
    };
    // What the trials had in common goes with what was found, and a hot start of 1.5 times the power lays more than was measured.
    for (key, truth, within) in [
        ("start_stop.lead_in_length", 8.0, 1e-6),
        ("start_stop.lead_in_power", 1.5, 0.05),
        ("start_stop.crater_fill_time", 1.0, 1e-6),
        ("start_stop.hump_height", 0.0, 0.05),
        ("start_stop.hump_length", 9.0, 0.05),
        ("start_stop.crater_depth", 0.4, 0.05),
        ("start_stop.crater_length", 14.0, 1e-6),
    ] {
        assert!((lesson(key) - truth).abs() <= within, "{key}: {} for {truth}", lesson(key));
    }
    let mine = fs::read_to_string(at.join("mine.toml")).unwrap();
    assert!(mine.contains(&format!("crater_depth = {:.3}", lesson("start_stop.crater_depth"))), "{mine}");
    let hot = beadwright::Profile::parse(&mine).unwrap().start_stop;
    assert!(hot.lead_in_length == 8.0 && (hot.lead_in_power - 1.5).abs() < 0.05, "{mine}");
    ok(at, &["profile", "check", "mine.toml"]);
    // As a spreadsheet saves it, with a byte order mark.
    let marked = "\u{feff}".to_owned() + &fs::read_to_string(at.join("sheet.csv")).unwrap();
    fs::write(at.join("marked.csv"), marked).unwrap();
    assert_eq!(ok(at, &["bead", "fit", "marked.csv", "-p", "cmt-steel-robots"]), ok(at, &fit[..5]));
    let said = ok(at, &fit[..5]);
    assert!(said.contains("least hump and crater") && said.contains("start_stop.lead_in_power"), "{said}");
    assert!(refused(at, &["bead", "fit", "sheet.csv", "--to", "mine.toml"], 1).contains("(-p)"));
    let said = refused(at, &["bead", "fit", "trial/sheet.csv"], 1);
    assert!(said.contains("no trial has both hump height and crater depth yet"), "{said}");
}

#[test]
fn corners_and_weaves_are_fitted_as_their_sheets_come() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    ok(
        at,
        &["bead", "trial", "-p", "cmt-steel-robots", "--shape", "corner", "--vary", "angle=30..150", "--repeats", "2"],
    );
    let sheet = fs::read_to_string(at.join("trial/sheet.csv")).unwrap();
    let excess = |set: &[f64]| [2.0 + 0.9 - set[0] / 200.0, 2.0, 3.0].iter().map(|own| format!("{own:.2}")).collect();
    fs::write(at.join("corners.csv"), filled(&sheet, excess)).unwrap();
    let said = ok(at, &["bead", "fit", "corners.csv"]);
    assert!(said.contains("0.75 ± 0.00 mm") && said.contains("0.15 ± 0.00 mm"), "{said}");
    assert!(said.contains("No key of a profile changes the metal of corners"), "{said}");
    assert!(refused(at, &["bead", "fit", "corners.csv", "--to", "mine.toml"], 1).contains("leave out --to"));

    let weave = ["--set", "weave.length=4", "--set", "weave.amplitude=2"];
    let vary = [
        "--vary",
        "weave_amplitude=1.5..3.5",
        "--vary",
        "deposition_speed=5..8",
        "--post",
        "fanuc",
        "-o",
        "woven",
        "--plate",
        "600x500",
    ];
    ok(at, &[&["bead", "trial", "-p", "cmt-steel-robots"][..], &weave, &vary].concat());
    let sheet = fs::read_to_string(at.join("woven/sheet.csv")).unwrap();
    // 60 mm³/s of metal in a bead that is wider by the swing.
    let size = |set: &[f64]| {
        let width = 4.0 + set[0];
        [width, 1.5 * 60.0 / set[1] / width].iter().map(|own| format!("{own:.4}")).collect()
    };
    fs::write(at.join("woven.csv"), filled(&sheet, size)).unwrap();
    fs::write(at.join("base.toml"), "inherits = \"cmt-steel-robots\"\n[weave]\nlength = 4.0\namplitude = 2.0\n")
        .unwrap();
    let want =
        ["bead", "fit", "woven.csv", "--want", "6.5x1.45", "--tolerance", "2", "-p", "base.toml", "--to", "wide.toml"];
    // Without a profile there is only the recipe; a profile that does not weave cannot hold it.
    assert!(ok(at, &want[..7]).contains("weave_amplitude"));
    let said = refused(at, &[&want[..7], &["--to", "wide.toml"]].concat(), 1);
    assert!(said.contains("does not weave") && said.contains("(-p)"), "{said}");
    ok(at, &want);
    let wide = fs::read_to_string(at.join("wide.toml")).unwrap();
    let amplitude: f64 = wide.lines().find_map(|line| line.strip_prefix("amplitude = ")).unwrap().parse().unwrap();
    assert!((4.0 + amplitude - 6.5).abs() < 0.2, "{wide}");
    ok(at, &["profile", "check", "wide.toml"]);
}

/// From the plate to the profile without callipers: a scan of beads side by side, whose valleys deepen with their distance, fills in the
/// sheet, and the widest stepover with valleys of a tenth of the height goes into the profile.
#[test]
fn a_stepover_is_learnt_from_a_scan_of_beads_side_by_side() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let trial = ["bead", "trial", "-p", "cmt-steel-robots", "--shape", "overlap", "--vary", "stepover=0.6..0.85"];
    let said = ok(at, &[&trial[..], &["--levels", "4", "--length", "60", "--plate", "300x160"]].concat());
    assert!(said.contains("4 trials") && said.contains("on 1 plate") && said.contains("-p PROFILE --to"), "{said}");
    let profile = beadwright::Profile::built_in("cmt-steel-robots").unwrap();
    let (width, height) = (profile.bead.width, profile.bead.height);
    let plan = json(&at.join("trial/trial_1/plan.json"));
    let lines = |layer: &serde_json::Value| -> Vec<[[f64; 2]; 2]> {
        let place = |point: &serde_json::Value| [0, 1].map(|k| point[k].as_f64().unwrap());
        let line = |pass: &serde_json::Value| [0, 1].map(|k| place(&pass["points"][k]));
        layer["passes"].as_array().unwrap().iter().map(line).collect()
    };
    let trials: Vec<_> = plan["layers"].as_array().unwrap().iter().take(4).map(lines).collect();
    // A valley is as deep, in heights of a bead, as the stepover exceeds 0.55 widths.
    let surface = |x: f64, y: f64| -> f64 {
        let own = |lines: &Vec<[[f64; 2]; 2]>| {
            let stepover = lines[1][0][1] - lines[0][0][1];
            let between = (lines[0][0][1]..lines[2][0][1]).contains(&y);
            let floor = if between { height * (1.0 - (stepover / width - 0.55)) } else { 0.0 };
            let crown = |line: &[[f64; 2]; 2]| height * (1.0 - (2.0 * (y - line[0][1]) / width).powi(2));
            let inside = (lines[0][0][0]..=lines[0][1][0]).contains(&x);
            if inside { lines.iter().map(crown).fold(floor, f64::max) } else { 0.0 }
        };
        trials.iter().map(own).fold(0.0, f64::max)
    };
    let points = (0..750).flat_map(|i| (0..400).map(move |j| (0.4 * f64::from(i), 0.4 * f64::from(j))));
    let scan: String = points.map(|(x, y)| format!("{x:.2} {y:.2} {:.3}\n", surface(x, y))).collect();
    fs::write(at.join("scan.xyz"), scan).unwrap();
    let said = ok(at, &["bead", "measure", "trial/sheet.csv", "scan.xyz"]);
    assert_eq!(said.matches("deepest valley").count(), 4, "{said}");
    let fit = ["bead", "fit", "trial/sheet.csv", "-p", "cmt-steel-robots"];
    let said = ok(at, &[&fit[..], &["--to", "mine.toml"]].concat());
    assert!(said.contains("fill.stepover") && said.contains("layers.height"), "{said}");
    let mine = beadwright::Profile::parse(&fs::read_to_string(at.join("mine.toml")).unwrap()).unwrap();
    assert!((mine.stepover() / width - 0.65).abs() < 0.01, "{said}");
    ok(at, &["profile", "check", "mine.toml"]);
    // Shallower valleys need closer beads.
    let said = ok(at, &[&fit[..], &["--valley", &format!("{}", 0.08 * height), "--json"]].concat());
    let closer: serde_json::Value = serde_json::from_str(&said).unwrap();
    assert!((closer["lessons"][0]["after"].as_f64().unwrap() / width - 0.63).abs() < 0.01, "{said}");
    assert!(refused(at, &["bead", "fit", "trial/sheet.csv", "--valley", "0.2"], 1).contains("(-p)"));
    let said = refused(at, &["bead", "fit", "trial/sheet.csv", "--want", "6x2"], 1);
    assert!(said.contains("sheet of single beads"), "{said}");
    let said = refused(at, &[&fit[..], &["--valley", "0"]].concat(), 1);
    assert!(said.contains("weld beads closer together"), "{said}");
    // A trial whose line was deleted must not shift the others.
    let sheet = fs::read_to_string(at.join("trial/sheet.csv")).unwrap();
    let fewer: Vec<&str> = sheet.lines().filter(|line| !line.starts_with("2,")).collect();
    fs::write(at.join("trial/fewer.csv"), fewer.join("\n")).unwrap();
    let said = refused(at, &["bead", "measure", "trial/fewer.csv", "scan.xyz"], 1);
    assert!(said.contains("do not belong together"), "{said}");
    // Walls grow: their heights are not those of beads on a plate.
    ok(at, &["bead", "trial", "-p", "cmt-steel-robots", "--shape", "wall", "--vary", "dwell=0..60", "-o", "walls"]);
    let said = refused(at, &["bead", "measure", "walls/sheet.csv", "scan.xyz"], 1);
    assert!(said.contains("by hand"), "{said}");
}

//! 3MF toolpaths: a plan comes back from its file, the file follows the extension's schemas, and its sums are the plan's as
//! another reader counts them.

use crate::common;

use beadwright::export::{self, Beads, toolpath};
use beadwright::layer::Layer;
use beadwright::pass::PassKind;
use beadwright::plan::Plan;
use beadwright::profile::Profile;
use beadwright::{Model, Placement, Task, example, plan};
use common::{planned, profile, profile_by};
use std::collections::BTreeMap;
use std::io::{Cursor, Read, Write};
use std::path::{Path, PathBuf};
use std::process::Command;

fn written(plan: &Plan, profile: &Profile) -> Vec<u8> {
    let beads = Beads { header: &plan.header, layers: &plan.layers, profile, heat: None };
    (export::format("3mf").unwrap().write)(&beads).unwrap()
}

/// An example, turned about z by an angle (°), planned.
fn turned(part: &str, angle: f64, profile: &Profile) -> Plan {
    let model = Model::read(&example::find(part).unwrap().stl(), &Task::new()).unwrap();
    let placement = Placement { turn: glam::DVec3::Z * angle, ..Placement::default() };
    let part_placed = model.place(&placement, None, profile.bead.width).unwrap();
    plan(part, &part_placed, profile, &Task::new()).unwrap()
}

/// The files of an archive.
fn unpacked(bytes: &[u8]) -> BTreeMap<String, String> {
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    let names: Vec<String> = archive.file_names().map(|name| name.unwrap().into_owned()).collect();
    let text = |name: String| {
        let mut text = String::new();
        archive.by_name(&name).unwrap().read_to_string(&mut text).unwrap();
        (name, text)
    };
    names.into_iter().map(text).collect()
}

fn packed(files: &BTreeMap<String, String>) -> Vec<u8> {
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in files {
        archive.start_file(name, zip::write::SimpleFileOptions::default()).unwrap();
        archive.write_all(text.as_bytes()).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

fn assert_same(read: &[Layer], planned: &[Layer], what: &str) {
    assert_eq!(read.len(), planned.len(), "{what}");
    for (a, b) in read.iter().zip(planned) {
        assert!((a.z - b.z).abs() < 1e-3 && (a.height - b.height).abs() < 1e-3, "{what}");
        let area = |layer: &Layer| layer.islands.iter().map(|island| island.area()).sum::<f64>();
        assert!((area(a) - area(b)).abs() < 1e-2 && a.islands.len() == b.islands.len(), "{what}");
        assert_eq!(a.passes.len(), b.passes.len(), "{what}");
        for (p, q) in a.passes.iter().zip(&b.passes) {
            let place = format!("{what}, layer {}", b.index + 1);
            assert_eq!((p.kind, p.closed, p.points.len()), (q.kind, q.closed, q.points.len()), "{place}");
            assert!((p.wait - q.wait).abs() < 1e-6, "{place}: waits {} s for {}", p.wait, q.wait);
            assert!(p.points.iter().zip(&q.points).all(|(p, q)| p.distance(*q) < 1e-3), "{place}");
            for (s, t) in p.segments().zip(q.segments()) {
                assert!((s.width - t.width).abs() < 1e-3, "{place}: {} mm wide for {}", s.width, t.width);
                assert!((s.pace - t.pace).abs() < 1e-3, "{place}: {} mm/s for {}", s.pace, t.pace);
            }
        }
    }
}

/// A profile with everything that changes how passes begin and end, and with waits.
fn with_ends(mut profile: Profile) -> Profile {
    let ends = &mut profile.start_stop;
    (ends.end_overlap, ends.lead_in_length, ends.lead_in_power) = (6.0, 8.0, 1.3);
    (ends.lead_out_length, ends.lead_out_power) = (7.0, 0.7);
    (ends.crater_fill_time, ends.min_layer_time) = (0.5, 120.0);
    profile
}

#[test]
fn plans_come_back_from_3mf() {
    for (part, angle, profile) in [
        ("cross", 0.0, profile_by("cmt-al2319-kuka", "hybrid")),
        ("cross", 33.0, with_ends(profile_by("cmt-al2319-kuka", "contour"))),
        ("propeller", 17.0, profile_by("cmt-al2319-kuka", "loop")),
        ("gear", 71.0, with_ends(profile_by("plasma-304-cnc", "zigzag"))),
        ("star", 45.0, profile_by("fdm-abs-0.4", "compound")),
        ("blade", 10.0, profile("cmt-steel-robots")),
    ] {
        let mut plan = turned(part, angle, &profile);
        plan.layers[1].passes[0].wait = 12.5;
        let bytes = written(&plan, &profile);
        assert_eq!(bytes, written(&plan, &profile), "the same plan gives the same bytes");
        assert!(toolpath::is_toolpath(&bytes));
        let read = toolpath::read(&bytes).unwrap();
        assert_eq!(read.header, plan.header);
        assert_eq!(read.profile.as_ref(), Some(&profile));
        assert_same(&read.layers, &plan.layers, &format!("{part} at {angle}°"));
        // Written again, it is the same file but for what rounding moved.
        let again = Plan { layers: read.layers, ..plan };
        assert_same(&toolpath::read(&written(&again, &profile)).unwrap().layers, &again.layers, part);
    }
}

/// Length, time and waits as they are in the files, counted from the text alone.
#[test]
fn lengths_times_and_waits_are_the_plans() {
    for profile in [with_ends(profile_by("cmt-al2319-kuka", "hybrid")), profile_by("plasma-304-cnc", "zigzag")] {
        let plan = planned("cross", &profile);
        let (metrics, files) = (&plan.summary.metrics, unpacked(&written(&plan, &profile)));
        let model = &files["3D/3dmodel.model"];
        let value = |text: &str, key: &str| -> Option<f64> {
            text.split(&format!(" {key}=\"")).nth(1).map(|rest| rest.split('"').next().unwrap().parse().unwrap())
        };
        let waits: Vec<f64> = model
            .split("<tp:toolpathprofile ")
            .skip(1)
            .map(|profile| {
                let head = profile.split('>').next().unwrap();
                value(head, "prewaittime").unwrap_or(0.0) + value(head, "postwaittime").unwrap_or(0.0)
            })
            .collect();
        let (mut length, mut seconds, mut segments, mut pieces) = (0.0, 0.0, 0, 0);
        for text in files.iter().filter(|(name, _)| name.starts_with("Toolpath/")).map(|(_, text)| text) {
            for segment in text.split("<segment ").skip(1) {
                let number = |key: &str| value(&format!(" {segment}"), key).unwrap();
                segments += 1;
                let wait = waits[number("profileid") as usize - 1];
                seconds += (number("timeprediction") + number("jumpprediction") + wait) / 1e6;
                let point = |text: &str| ["x", "y", "z"].map(|axis| value(&format!(" {text}"), axis).unwrap() * 1e-4);
                let points: Vec<[f64; 3]> = segment.split("<point3d ").skip(1).map(point).collect();
                let distance = |w: &[[f64; 3]]| (0..3).map(|i| (w[1][i] - w[0][i]).powi(2)).sum::<f64>().sqrt();
                length += points.windows(2).map(distance).sum::<f64>();
                pieces += points.len();
            }
        }
        assert_eq!(segments, metrics.passes);
        // Points are rounded to 1e-4 mm.
        let rounding = 1e-4 * pieces as f64;
        assert!((length - metrics.deposited_length_mm).abs() < rounding.min(1e-4 * length), "{length} mm");
        // The way up after the last pass is not a way to any other.
        assert!((seconds - metrics.total_time_s).abs() < 5.0 + 1e-6 * seconds, "{seconds} of {}", metrics.total_time_s);
    }
}

/// On a cone the torch leans with the wall: the quaternion turns the vertical into the lean, and the plan comes back.
#[test]
fn a_leaning_torch_is_written_with_its_orientation() {
    let mut profile = profile_by("cmt-al2319-kuka", "contour");
    (profile.program.follow_wall, profile.program.max_work_angle) = (1.0, 40.0);
    let plan = planned("vase", &profile);
    let bytes = written(&plan, &profile);
    assert_same(&toolpath::read(&bytes).unwrap().layers, &plan.layers, "vase");
    let files = unpacked(&bytes);
    assert!(files["3D/3dmodel.model"].contains("toolpathtype=\"6axis\""));
    let mut leaning = 0;
    for text in files.iter().filter(|(name, _)| name.starts_with("Toolpath/")).map(|(_, text)| text) {
        assert!(!text.contains("point3d") && !text.contains("polyline3d"));
        for point in text.split("<point6d ").skip(1) {
            let value = |key: &str| -> f64 {
                let rest = format!(" {point}");
                let rest = rest.split(&format!(" {key}=\"")).nth(1).unwrap();
                rest.split('"').next().unwrap().parse().unwrap()
            };
            let [i, j, k, w] = ["i", "j", "k", "w"].map(value);
            assert!((i * i + j * j + k * k + w * w - 1.0).abs() < 1e-7);
            // The third column of the rotation, as the specification has it: the torch's own axis.
            let axis = [2.0 * (i * k + j * w), 2.0 * (j * k - i * w), 1.0 - 2.0 * (i * i + j * j)];
            assert!(axis[2] > 40.5_f64.to_radians().cos(), "{axis:?}");
            leaning += usize::from(axis[2] < 0.999);
        }
    }
    assert!(leaning > 100, "{leaning} points lean");
}

fn schemas() -> PathBuf {
    let default = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/3mf");
    std::env::var_os("BEADWRIGHT_SCHEMAS").map_or_else(default, PathBuf::from)
}

/// The schemas judge the files, where Python has lxml and the schemas are there.
#[test]
fn files_follow_the_schemas() {
    let python = std::env::var("BEADWRIGHT_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let has_lxml = Command::new(&python).args(["-c", "import lxml.etree"]).output().is_ok_and(|o| o.status.success());
    if !has_lxml || !schemas().is_dir() {
        eprintln!("not validated: python3 with lxml, or the schemas (BEADWRIGHT_SCHEMAS), are missing");
        return;
    }
    // libxml2 counts occurrences in fewer bits than the schemas name.
    const SCRIPT: &str = "import sys, zipfile\nfrom lxml import etree\n\
        text = lambda name: open(f'{sys.argv[1]}/{name}.xsd', 'rb').read().replace(b'2147483647\"', b'unbounded\"')\n\
        load = lambda name: etree.XMLSchema(etree.fromstring(text(name)))\n\
        model, layer = load('toolpath_2026_03'), load('toolpath_layer_2026_03')\n\
        file = zipfile.ZipFile(sys.argv[2])\n\
        root = etree.fromstring(file.read('3D/3dmodel.model'))\n\
        space = '{http://schemas.3mf.io/3dmanufacturing/toolpath/2026/03}'\n\
        resource = root.find('.//' + space + 'toolpathresource')\n\
        model.assertValid(resource)\n\
        paths = [e.get('path') for e in resource.iter(space + 'toolpathlayer')]\n\
        bound = etree.fromstring(file.read('3D/_rels/3dmodel.model.rels'))\n\
        assert paths and paths == [e.get('Target') for e in bound]\n\
        [layer.assertValid(etree.fromstring(file.read(path[1:]))) for path in paths]\n\
        print(len(paths))\n";
    let mut leaning = profile_by("cmt-al2319-kuka", "contour");
    (leaning.name, leaning.program.travel_angle) = ("leaning".to_owned(), 10.0);
    let ends = with_ends(profile_by("cmt-al2319-kuka", "hybrid"));
    for profile in [ends, profile_by("fdm-abs-0.4", "contour"), leaning] {
        let plan = planned("cross", &profile);
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{}.3mf", profile.name));
        std::fs::write(&path, written(&plan, &profile)).unwrap();
        let output = Command::new(&python).args(["-c", SCRIPT]).arg(schemas()).arg(&path).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), plan.layers.len().to_string());
    }
}

/// A file of somebody else: flat segments, inches, factors on some lines only.
fn foreign(profile: &str, segments: &str) -> Vec<u8> {
    let model = format!(
        "<model unit=\"inch\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" \
         xmlns:t=\"http://schemas.3mf.io/3dmanufacturing/toolpath/2026/03\" requiredextensions=\"t\"><resources>\
         <t:toolpathresource id=\"7\" uuid=\"x\" unitfactor=\"0.01\"><t:toolpathprofiles>{profile}</t:toolpathprofiles>\
         <t:toolpathlayers zbottom=\"10\"><t:toolpathlayer ztop=\"30\" path=\"/a/b.xml\"/></t:toolpathlayers>\
         </t:toolpathresource></resources><build t:toolpathid=\"7\"/></model>"
    );
    let layer = format!(
        "<layer xmlns=\"http://schemas.3mf.io/3dmanufacturing/toolpath/2026/03\"><parts><part id=\"4\" uuid=\"y\"/></parts>\
         <profiles><profile id=\"9\" uuid=\"P\"/></profiles><segments>{segments}</segments></layer>"
    );
    let files = [("3D/3dmodel.model", model), ("a/b.xml", layer)];
    packed(&files.map(|(name, text)| (name.to_owned(), text)).into())
}

const STYLE: &str = "<t:toolpathprofile uuid=\"p\" name=\"n\" depositionspeed=\"8\" beadwidth=\"5\">\
    <t:modifier attribute=\"beadwidth\" type=\"constant\" minvalue=\"4\" maxvalue=\"6\" factor=\"e\"/></t:toolpathprofile>";
const LOOP: &str = "<segment type=\"loop\" profileid=\"9\" partid=\"4\"><point x=\"0\" y=\"0\" e=\"1\"/>\
    <point x=\"100\" y=\"0\" e=\"0.25\"/><point x=\"0\" y=\"200\"/></segment>";
const HATCH: &str = "<segment type=\"hatch\" profileid=\"9\" partid=\"4\"><hatch x1=\"0\" y1=\"0\" x2=\"50\" y2=\"0\"/>\
    <hatch x1=\"0\" y1=\"9\" x2=\"50\" y2=\"9\" e=\"0\"/></segment>";

#[test]
fn toolpaths_of_others_are_read() {
    let plan = toolpath::read(&foreign(STYLE, &format!("{LOOP}{HATCH}"))).unwrap();
    assert!(plan.profile.is_none() && plan.settings.is_none() && plan.layers.len() == 1);
    let layer = &plan.layers[0];
    assert!((layer.z - 7.62).abs() < 1e-9 && (layer.height - 5.08).abs() < 1e-9, "{} {}", layer.z, layer.height);
    let [triangle, first, second] = &layer.passes[..] else { unreachable!("three passes") };
    assert!(triangle.closed && triangle.kind == PassKind::Contour);
    let widths: Vec<f64> = triangle.segments().map(|s| s.width).collect();
    assert_eq!(widths, [4.5, 5.0, 6.0], "the first point has the width of the closing line");
    assert!((triangle.length() - 25.4 * (1.0 + 2.0 + 5.0_f64.sqrt())).abs() < 1e-9);
    assert!(
        [first, second].iter().all(|p| p.kind == PassKind::Infill && !p.closed && (p.length() - 12.7).abs() < 1e-9)
    );
    assert_eq!((first.width.max(), second.width.max(), second.pace.max()), (5.0, 4.0, 8.0));
}

#[test]
fn broken_toolpaths_are_refused_with_the_place() {
    let refused = |bytes: &[u8], word: &str| {
        let error = toolpath::read(bytes).unwrap_err().to_string();
        assert!(error.contains(word), "\"{error}\" does not say \"{word}\"");
    };
    let style = |from: &str, to: &str| foreign(&STYLE.replace(from, to), LOOP);
    refused(&style("type=\"constant\"", "type=\"linear\""), "within lines");
    refused(&style("attribute=\"beadwidth\"", "attribute=\"laserpower\""), "laserpower");
    refused(&style(" beadwidth=\"5\"", ""), "beadwidth");
    refused(&style(" depositionspeed=\"8\"", ""), "depositionspeed");
    let segment = |from: &str, to: &str| foreign(STYLE, &format!("{LOOP}{}", LOOP.replace(from, to)));
    refused(&segment("type=\"loop\"", "type=\"arc\""), "layer 1, segment 2: segments of the type \"arc\"");
    refused(&segment("profileid=\"9\"", "profileid=\"8\""), "segment 2: its profile 8");
    refused(&segment("partid=\"4\"", "partid=\"8\""), "segment 2: its part 8");
    refused(&segment("x=\"100\"", "x=\"far\""), "far");
    refused(&segment("x=\"100\"", "x=\"1e9\""), "20 m");
    refused(
        &foreign(STYLE, "<segment type=\"polyline\" profileid=\"9\" partid=\"4\"><point x=\"0\" y=\"0\"/></segment>"),
        "two points",
    );
    let mut files = unpacked(&foreign(STYLE, LOOP));
    files.remove("a/b.xml");
    refused(&packed(&files), "a/b.xml");
    refused(b"PK\x03\x04 and nothing more", "3MF");
    let whole = written(&planned("cross", &profile("cmt-al2319-kuka")), &profile("cmt-al2319-kuka"));
    refused(&whole[..whole.len() / 2], "3MF");
    // As a part it is refused in words that help.
    let error = beadwright::model::import(&whole, &Task::new()).unwrap_err().to_string();
    assert!(error.contains("toolpaths"), "{error}");
}

/// Files with bytes changed are read or refused, and nothing worse.
#[test]
fn broken_files_do_no_harm() {
    let files = unpacked(&foreign(STYLE, &format!("{LOOP}{HATCH}")));
    let kinds = ["0", "-", "1e300", "<", "NaN", "99999999999", "", "\"", "/"];
    for (name, text) in &files {
        for at in 0..text.len() {
            let mut changed = text.clone();
            changed.replace_range(at..=at, kinds[at % kinds.len()]);
            let mut files = files.clone();
            files.insert(name.clone(), changed);
            if let Ok(plan) = toolpath::read(&packed(&files)) {
                assert!(plan.layers.iter().flat_map(|l| &l.passes).all(|p| p.points.len() > 1));
            }
        }
    }
}

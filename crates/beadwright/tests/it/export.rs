//! Exported beads are those of the plan: lengths, metal and time, read back by readers that know nothing of the writers.

use crate::common;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use beadwright::export::{self, Beads};
use beadwright::heat;
use beadwright::task::Task;
use bytes::Bytes;
use common::{planned, profile_by};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;

/// The values of a column by its name.
fn column(csv: &str, name: &str) -> Vec<f64> {
    let mut lines = csv.lines();
    let at = lines.next().unwrap().split(',').position(|head| head == name).unwrap();
    lines.map(|line| line.split(',').nth(at).unwrap().parse().unwrap()).collect()
}

/// The array of a name in a VTP file, as bytes.
fn array(vtp: &str, name: &str) -> Vec<u8> {
    let rest = vtp.split(&format!("Name=\"{name}\"")).nth(1).unwrap();
    // VTK's reader takes no array without a type in small letters.
    assert!(
        vtp.lines().filter(|line| line.starts_with("<DataArray")).all(|line| line.starts_with("<DataArray type=\""))
    );
    let text = rest.split('>').nth(1).unwrap().split('<').next().unwrap().trim();
    let bytes = STANDARD.decode(text).unwrap();
    assert_eq!(u64::from_le_bytes(bytes[..8].try_into().unwrap()), bytes.len() as u64 - 8);
    bytes[8..].to_vec()
}

fn numbers(bytes: &[u8]) -> Vec<f64> {
    bytes.chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect()
}

#[test]
fn exported_beads_are_those_of_the_plan() {
    for (part, name, strategy) in [
        ("cross", "cmt-al2319-kuka", "hybrid"),
        ("propeller", "cmt-al2319-kuka", "loop"),
        ("star", "fdm-abs-0.4", "compound"),
        ("cross", "plasma-304-cnc", "zigzag"),
    ] {
        let profile = profile_by(name, strategy);
        let plan = planned(part, &profile);
        let metrics = &plan.summary.metrics;
        let beads = Beads { header: &plan.header, layers: &plan.layers, profile: &profile, heat: None };
        let pieces = beads.pieces();
        let csv = String::from_utf8((export::format("csv").unwrap().write)(&beads).unwrap()).unwrap();
        let vtp = String::from_utf8((export::format("VTP").unwrap().write)(&beads).unwrap()).unwrap();
        assert_eq!(csv.lines().count(), pieces.len() + 1);
        // Length, from both files.
        let points = numbers(&array(&vtp, "Points"));
        let at = |k: usize| [points[3 * k], points[3 * k + 1], points[3 * k + 2]];
        let distance = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
        let length: f64 = (0..pieces.len()).map(|k| distance(at(2 * k), at(2 * k + 1))).sum();
        let off = (length / metrics.deposited_length_mm - 1.0).abs();
        assert!(off < 1e-9, "{part} {strategy}: {length} for {}", metrics.deposited_length_mm);
        let ends = |n: usize| ["x", "y", "z"].map(|axis| column(&csv, &format!("{axis}{n} (mm)")));
        let ([x0, y0, z0], [x1, y1, z1]) = (ends(0), ends(1));
        let reported: f64 = (0..pieces.len()).map(|i| distance([x0[i], y0[i], z0[i]], [x1[i], y1[i], z1[i]])).sum();
        assert!((reported / length - 1.0).abs() < 1e-4, "{part} {strategy}: {reported} for {length}");
        // Metal: the nominal feed lays the metal of each piece at its pace; craters are not pieces.
        let (area, nominal) = (profile.bead().area(), profile.process.deposition_speed);
        let metal: f64 = pieces.iter().map(|p| p.from.distance(p.to) / p.pace * area * nominal).sum();
        let craters = metrics.passes as f64 * profile.start_stop.crater_fill_time * profile.start_stop.crater_power;
        let expected = metrics.deposited_volume_mm3 - craters * area * nominal;
        assert!((metal / expected - 1.0).abs() < 1e-6, "{part} {strategy}: {metal} for {expected}");
        // Time runs on, and ends with the build but for what comes after the last bead.
        let (starts, times) = (column(&csv, "start (s)"), numbers(&array(&vtp, "time")));
        assert!(starts.windows(2).zip(&times).all(|(w, time)| w[1] >= w[0] + time - 1e-5), "{part} {strategy}");
        let end = starts.last().unwrap() + times.last().unwrap();
        assert!(
            end <= metrics.total_time_s + 1e-3 && end > metrics.total_time_s - 60.0,
            "{end} of {}",
            metrics.total_time_s
        );
        let layers: Vec<i32> =
            array(&vtp, "layer").chunks(4).map(|b| i32::from_le_bytes(b.try_into().unwrap())).collect();
        assert_eq!((layers[0], layers.len()), (plan.layers[0].index as i32 + 1, pieces.len()));
        assert!(pieces.iter().all(|p| p.width > 0.0 && p.speed > 0.0 && p.feed > 0.0));
    }
    assert!(export::format("docx").is_none());
}

/// A Parquet table, as the crate's own reader has it, is the CSV table.
#[test]
fn parquet_holds_the_table() {
    let profile = profile_by("cmt-al2319-kuka", "compound");
    let plan = planned("cross", &profile);
    let settings = profile.heat_settings().unwrap();
    let heat = heat::history(&mut plan.layers.clone(), &settings, &profile.weld_settings(), &Task::new()).unwrap();
    let beads = Beads { header: &plan.header, layers: &plan.layers, profile: &profile, heat: heat.as_ref() };
    let written = |extension: &str| (export::format(extension).unwrap().write)(&beads).unwrap();
    let (csv, parquet) = (String::from_utf8(written("csv")).unwrap(), written("parquet"));
    assert_eq!(parquet, written("parquet"), "the same plan gives the same bytes");
    let reader = SerializedFileReader::new(Bytes::from(parquet)).unwrap();
    let fields = reader.metadata().file_metadata().schema().get_fields().to_vec();
    let names: Vec<&str> = fields.iter().map(|field| field.name()).collect();
    assert_eq!(names.join(","), csv.lines().next().unwrap());
    assert_eq!(names.last(), Some(&"temperature (°C)"));
    let hottest = beads.pieces().iter().map(|piece| piece.temperature).fold(0.0, f64::max);
    assert!((30.0..3000.0).contains(&hottest), "{hottest} °C");
    let rows: Vec<_> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
    assert_eq!(rows.len(), csv.lines().count() - 1);
    for (row, line) in rows.iter().zip(csv.lines().skip(1)) {
        for ((_, field), text) in row.get_column_iter().zip(line.split(',')) {
            match field {
                Field::Double(value) => assert!((value - text.parse::<f64>().unwrap()).abs() < 1e-4),
                Field::Int(value) => assert_eq!(value.to_string(), text),
                Field::Str(value) => assert_eq!(value, text),
                other => unreachable!("{other}"),
            }
        }
    }
}

#[test]
fn a_drawing_shows_each_pass_as_one_bead_and_its_middle() {
    let profile = profile_by("cmt-al2319-kuka", "loop");
    let plan = planned("propeller", &profile);
    let layer = &plan.layers[4];
    let drawing = String::from_utf8((export::layer_format("svg").unwrap().write)(layer).unwrap()).unwrap();
    let drawing = roxmltree::Document::parse(&drawing).unwrap();
    let group = |id| drawing.descendants().find(|node| node.attribute("id") == Some(id)).unwrap();
    let beads: Vec<_> = group("passes").children().filter(roxmltree::Node::is_element).collect();
    assert_eq!(beads.len(), layer.passes.len());
    // Pieces that were translucent by themselves would darken each other where they meet.
    for bead in beads {
        assert!(bead.attribute("opacity").is_some());
        let pieces: Vec<_> = bead.children().filter(roxmltree::Node::is_element).collect();
        assert!(pieces.len() > 10, "level layers have beads of many widths");
        assert!(pieces.iter().all(|piece| !piece.attributes().any(|a| a.name().contains("opacity"))));
    }
    let middles = group("middles").children().filter(roxmltree::Node::is_element);
    let points = |node: roxmltree::Node<'_, '_>| node.attribute("d").unwrap().matches(['M', 'L']).count();
    let drawn: Vec<usize> = middles.map(points).collect();
    let expected: Vec<usize> = layer.passes.iter().map(|pass| pass.line().len()).collect();
    assert_eq!(drawn, expected);
}

//! Drawings: areas known in closed form, however they are drawn, turned and chained, and sentences for what is not read.

use crate::common;

use beadwright::export::{self};
use beadwright::glam::{DVec2, DVec3};
use beadwright::model::{ImportError, Outlines, PartError, Units, outline};
use beadwright::{Model, Part, Placement, Task};
use common::{planned, profile};
use std::f64::consts::PI;

/// A DXF drawing of these entities in millimetres.
fn dxf(entities: &str) -> String {
    format!(
        "999\nmade by a test\n0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n"
    )
}

fn line(a: DVec2, b: DVec2) -> String {
    format!("0\nLINE\n8\n0\n10\n{}\n20\n{}\n11\n{}\n21\n{}\n", a.x, a.y, b.x, b.y)
}

fn circle(at: DVec2, radius: f64) -> String {
    format!("0\nCIRCLE\n8\n0\n10\n{}\n20\n{}\n40\n{radius}\n", at.x, at.y)
}

/// A polyline of points with bulges.
fn light(points: &[(DVec2, f64)], closed: bool) -> String {
    let mut text = format!("0\nLWPOLYLINE\n90\n{}\n70\n{}\n", points.len(), u8::from(closed));
    for (p, bulge) in points {
        text.push_str(&format!("10\n{}\n20\n{}\n42\n{bulge}\n", p.x, p.y));
    }
    text
}

/// The same polyline in the words of release 12.
fn heavy(points: &[(DVec2, f64)]) -> String {
    let vertex = |(p, bulge): &(DVec2, f64)| format!("0\nVERTEX\n10\n{}\n20\n{}\n30\n0\n42\n{bulge}\n", p.x, p.y);
    let vertices: String = points.iter().map(vertex).collect();
    format!("0\nPOLYLINE\n66\n1\n70\n1\n{vertices}0\nSEQEND\n")
}

fn read(text: &str) -> Outlines {
    outline::read(text.as_bytes()).unwrap()
}

#[track_caller]
fn assert_area(outlines: &Outlines, expected: f64, islands: usize) {
    let region = outlines.region(1.0);
    assert!((region.area() / expected - 1.0).abs() < 2e-4, "{} for {expected}", region.area());
    assert_eq!(region.polygons().len(), islands);
}

#[test]
fn dxf_areas_are_those_of_the_shapes() {
    for turn in [0.0_f64, 30.0, 77.0] {
        let at =
            |x: f64, y: f64| DVec2::new(120.0, -40.0) + DVec2::from_angle(turn.to_radians()).rotate(DVec2::new(x, y));
        // A stadium, 60 mm between the centres, 20 mm radius: two lines and two arcs in any order and direction.
        let (a, b, c, d) = (at(0.0, -20.0), at(60.0, -20.0), at(60.0, 20.0), at(0.0, 20.0));
        let arc = |centre: DVec2, from: f64| {
            let (from, to) = ((from + turn).rem_euclid(360.0), (from + turn + 180.0).rem_euclid(360.0));
            format!("0\nARC\n10\n{}\n20\n{}\n40\n20\n50\n{from}\n51\n{to}\n", centre.x, centre.y)
        };
        let loose = [line(c, d), arc(at(60.0, 0.0), -90.0), line(a, b), arc(at(0.0, 0.0), 90.0)].concat();
        let area = 60.0 * 40.0 + PI * 400.0;
        let drawn = read(&dxf(&loose));
        assert_area(&drawn, area, 1);
        assert_eq!((drawn.format, drawn.units), ("DXF", Some(Units::Millimetre)));
        let points = [(a, 0.0), (b, 1.0), (c, 0.0), (d, 1.0)];
        assert_area(&read(&dxf(&light(&points, true))), area, 1);
        assert_area(&read(&dxf(&heavy(&points))), area, 1);
        let backwards = [(a, -1.0), (d, 0.0), (c, -1.0), (b, 0.0)];
        assert_area(&read(&dxf(&light(&backwards, true))), area, 1);
        // A hole with a disc in it; bulges of a quarter circle.
        let quarter = (PI / 8.0).tan();
        let ring: Vec<(DVec2, f64)> =
            [(15.0, 0.0), (0.0, 15.0), (-15.0, 0.0), (0.0, -15.0)].map(|(x, y)| (at(x, y), quarter)).to_vec();
        let nested = [circle(at(0.0, 0.0), 30.0), light(&ring, true), circle(at(0.0, 0.0), 5.0)].concat();
        assert_area(&read(&dxf(&nested)), PI * (900.0 - 225.0 + 25.0), 2);
    }
}

#[test]
fn dxf_says_what_it_does_not_read() {
    let [a, b, c] = [(0.0, 0.0), (50.0, 0.0), (0.0, 50.0)].map(|(x, y)| DVec2::new(x, y));
    let triangle = [line(a, b), line(b, c), line(c, a)].concat();
    let notes = read(&dxf(&format!("{triangle}0\nTEXT\n1\nM8\n10\n0\n20\n0\n0\nTEXT\n10\n3\n20\n0\n"))).notes;
    assert_eq!(notes, ["2 × TEXT in the drawing passed over."]);
    let refused = |text: &str, word: &str| {
        let error = outline::read(text.as_bytes()).unwrap_err().to_string();
        assert!(error.contains(word), "\"{error}\" does not say \"{word}\"");
    };
    refused(&dxf(&format!("{triangle}0\nSPLINE\n71\n3\n")), "SPLINE: it is not read; convert it");
    refused(&dxf("0\nINSERT\n2\nbolt\n"), "explode");
    refused(&dxf("0\nFLANGE\n"), "FLANGE");
    refused(&dxf(&[line(a, b), line(b, c), line(c, DVec2::new(0.0, 0.1))].concat()), "(0.000, 0.000)");
    refused(&dxf(""), "no closed outline");
    refused(&dxf("0\nCIRCLE\n10\nhere\n20\n0\n40\n5\n"), "\"here\"");
    refused(&dxf("0\nCIRCLE\n10\n0\n20\n0\n40\n5\n230\n-1\n"), "seen from above");
    refused(&dxf(&triangle).replace("$INSUNITS\n70\n4", "$INSUNITS\n70\n2"), "$INSUNITS 2");
    refused("0\nSECTION\nnot a code\nENTITIES\n", "line 3");
    refused("AutoCAD Binary DXF\r\n", "ASCII");
    // Where a solid is needed, and where the height is missing.
    let error = beadwright::model::import(dxf(&triangle).as_bytes(), &Task::new()).unwrap_err();
    assert!(matches!(error, ImportError::Outline { .. }));
    let model = Model::read(dxf(&triangle).as_bytes(), &Task::new()).unwrap();
    assert_eq!(model.place(&Placement::default(), None, 5.0).unwrap_err(), PartError::NoHeight);
}

#[test]
fn svg_areas_are_those_of_the_shapes() {
    // A plate with a round hole and a slot, shapes in groups with transforms; the same by one path.
    let shapes = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100mm\" height=\"80mm\" viewBox=\"0 0 200 160\">\
        <g transform=\"translate(20 20) rotate(90 80 60)\"><rect x=\"20\" width=\"120\" height=\"120\"/>\
        <g fill=\"none\" stroke=\"red\"><circle cx=\"60\" cy=\"60\" r=\"20\"/>\
        <path d=\"M100 20 h20 v40 h-20 z\"/></g></g></svg>";
    let drawn = read(shapes);
    assert_eq!((drawn.format, drawn.units), ("SVG", Some(Units::Millimetre)));
    assert_area(&drawn, 3600.0 - PI * 100.0 - 200.0, 1);
    assert!(drawn.size().distance(DVec2::new(60.0, 60.0)) < 1e-3, "{}", drawn.size());
    // y runs upwards: the corner of a triangle at the picture's top is the highest.
    let triangle =
        read("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 50 40\"><path d=\"M0 40 L50 40 L0 0\"/></svg>");
    assert_eq!(triangle.units, None);
    assert_area(&triangle, 1000.0, 1);
    let high = triangle.rings[0].points().iter().copied().max_by(|a, b| a.y.total_cmp(&b.y)).unwrap();
    assert!(high.distance(DVec2::new(0.0, 40.0)) < 1e-4, "{high}");
    let notes = read(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 50 40\"><rect width=\"9\" height=\"9\"/><text>M8</text>\
         <image href=\"/etc/hostname\"/></svg>",
    )
    .notes;
    assert!(notes.len() == 2 && notes[0].starts_with("1 × text"), "{notes:?}");
    let open = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 50 40\"><path id=\"rim\" fill=\"none\" stroke=\"red\" \
                d=\"M0 40 L50 40 L0 0\"/></svg>";
    let error = outline::read(open.as_bytes()).unwrap_err().to_string();
    assert!(error.contains("rim") && error.contains("not closed"), "{error}");
    assert!(outline::read(b"<svg xmlns=\"http://www.w3.org/2000/svg\"><path d=").is_err());
}

#[test]
fn outlines_grow_into_closed_solids() {
    let at = DVec2::new(30.0, 20.0);
    let plate = dxf(&[circle(at, 30.0), circle(at + DVec2::X * 12.0, 8.0), circle(at - DVec2::X * 12.0, 8.0)].concat());
    for (turn, scale, units) in [(0.0, 1.0, None), (25.0, 2.0, None), (0.0, 1.0, Some(Units::Inch))] {
        let placement = Placement { turn: DVec3::Z * turn, scale, units, ..Placement::default() };
        let model = Model::read(plate.as_bytes(), &Task::new()).unwrap();
        let Part::Mesh(import) = model.place(&placement, Some(12.0), 5.0).unwrap() else { unreachable!("a solid") };
        let factor: f64 = scale * units.map_or(1.0, Units::in_mm);
        let expected = PI * (900.0 - 128.0) * factor * factor * 12.0;
        assert!((import.mesh.volume() / expected - 1.0).abs() < 2e-4, "{} mm³", import.mesh.volume());
        assert!((import.mesh.size().z - 12.0).abs() < 1e-9 && import.repair.open_edges == 0, "{:?}", import.repair);
    }
}

/// The outlines of exported layers, read back by the readers above and by one of the test.
#[test]
fn exported_layers_have_their_outlines_and_lengths() {
    let profile = profile("cmt-al2319-kuka");
    for part in ["cross", "gear"] {
        let plan = planned(part, &profile);
        let layer = &plan.layers[1];
        let area: f64 = layer.islands.iter().map(|island| island.area()).sum();
        let dxf = String::from_utf8((export::layer_format("dxf").unwrap().write)(layer).unwrap()).unwrap();
        let only = |wanted: &str| -> String {
            let mut entities = dxf.split("  0\n").collect::<Vec<_>>();
            entities.retain(|e| !e.contains("\n  8\n") || e.contains(&format!("  8\n{wanted}\n")));
            entities.join("  0\n")
        };
        let outline = read(&only("OUTLINE"));
        assert!((outline.region(1.0).area() / area - 1.0).abs() < 1e-6, "{part}");
        // Lengths and widths of passes, counted from the vertices.
        let values = |entity: &str, code: &str| -> f64 {
            let mut lines = entity.lines();
            while let (Some(key), Some(value)) = (lines.next(), lines.next()) {
                if key.trim() == code {
                    return value.trim().parse().unwrap();
                }
            }
            panic!("{code} is missing")
        };
        let (mut length, mut passes) = (0.0, 0);
        for polyline in dxf.split("  0\nPOLYLINE\n").skip(1).filter(|p| !p.starts_with("  8\nOUTLINE")) {
            passes += 1;
            let closed = values(polyline.split("  0\n").next().unwrap(), "70") as u32 & 1 == 1;
            let vertices: Vec<DVec2> =
                polyline.split("  0\nVERTEX\n").skip(1).map(|v| DVec2::new(values(v, "10"), values(v, "20"))).collect();
            let close = if closed { vertices[0].distance(*vertices.last().unwrap()) } else { 0.0 };
            length += vertices.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>() + close;
        }
        let expected: f64 = layer.passes.iter().map(|pass| pass.length()).sum();
        assert_eq!(passes, layer.passes.len());
        assert!((length / expected - 1.0).abs() < 1e-5, "{part}: {length} mm for {expected}");
        let svg = String::from_utf8((export::layer_format("SVG").unwrap().write)(layer).unwrap()).unwrap();
        let from = svg.find("<g id=\"passes\"").unwrap();
        let to = svg.find("<g id=\"outlines\"").unwrap();
        let drawn = read(&format!("{}{}", &svg[..from], &svg[to..]));
        assert!((drawn.region(1.0).area() / area - 1.0).abs() < 1e-4, "{part}: {} mm²", drawn.region(1.0).area());
        // The picture shows the beads: what is not white covers the part, as its scale has it.
        let picture = (export::layer_format("png").unwrap().write)(layer).unwrap();
        let picture = resvg::tiny_skia::Pixmap::decode_png(&picture).unwrap();
        assert_eq!(picture.width().max(picture.height()), 1600);
        let millimetres = svg.split("width=\"").nth(1).and_then(|rest| rest.split("mm").next()).unwrap();
        let pixel = millimetres.parse::<f64>().unwrap() / f64::from(picture.width());
        let covered = picture.pixels().iter().filter(|p| p.red() < 255 || p.green() < 255 || p.blue() < 255).count();
        let covered = covered as f64 * pixel * pixel;
        assert!((covered / area - 1.0).abs() < 0.08, "{part}: {covered} mm² of {area}");
    }
}

/// A drawing with bytes changed is read or refused, and nothing worse.
fn survives_changes(text: &str) {
    let kinds = [&b"0"[..], b"-", b"1e30", b"\n", b"<", b"NaN", b"9999999", b""];
    for at in 0..text.len() {
        let mut bytes = text.as_bytes().to_vec();
        bytes.splice(at..=at, kinds[at % kinds.len()].iter().copied());
        if let Ok(outlines) = outline::read(&bytes) {
            // Far out of all bounds the grid of the plane ends.
            if outlines.size().max_element() < 1e4 {
                outlines.extruded(1.0, 5.0).ok();
            }
        }
    }
}

#[test]
fn broken_drawings_do_no_harm() {
    let at = DVec2::new(3.0, 4.0);
    let points = [(at, 0.5), (at + DVec2::X, 0.0), (at + DVec2::Y, -0.2)];
    survives_changes(&dxf(&[light(&points, true), heavy(&points), circle(at, 2.0), line(at, at)].concat()));
    survives_changes(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9mm\" viewBox=\"0 0 9 9\"><g transform=\"rotate(9)\">\
         <path d=\"M1 1 C2 2 3 5 4 1 A3 2 9 0 1 8 8 Q1 5 2 2 z\" fill-rule=\"evenodd\"/><circle r=\"2\"/></g></svg>",
    );
}

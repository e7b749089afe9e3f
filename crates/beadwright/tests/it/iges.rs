//! IGES files: real ones, hand-made ones for every entity, and broken ones.

use crate::common;

use crate::definition;
use crate::drafts;
use common::{model, models};

use beadwright::curve::Nurbs;
use beadwright::model::iges::{Dependence, IgesCurve, WriteOptions, read, write};
use definition::{cubic, from_definition};
use drafts::Draft;
use glam::{DVec3, dvec3};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::fs;

/// A real file: its name, its unit in mm, and the number of entities of each type.
type Real = (&'static str, f64, &'static [(u32, usize)]);

/// Entities of the real files, as `models/README.md` counts them, with the kinds it leaves out.
const REAL: [Real; 4] = [
    (
        "bladex_propeller.iges",
        1.0,
        &[(100, 4), (102, 52), (110, 36), (120, 4), (124, 4), (126, 160), (128, 18), (142, 26), (144, 22), (402, 1)],
    ),
    ("curve_rhino.igs", 1.0, &[(126, 6), (314, 1), (406, 1)]),
    (
        "rounded_cube.iges",
        1.0,
        &[(100, 4), (102, 14), (110, 28), (120, 1), (124, 4), (126, 30), (128, 6), (142, 7), (144, 7), (314, 1)],
    ),
    ("tubes_siemens.iges", 1000.0, &[(100, 1), (102, 2), (110, 7), (124, 1), (126, 1)]),
];

/// The only curve of a file with one entity, without warnings.
fn only(entity: u32, form: i32, parameters: &str) -> Nurbs {
    let file = Draft::new(&[(entity, form, parameters)]).read();
    assert_eq!(file.warnings, [""; 0]);
    assert_eq!(file.curves.len(), 1);
    file.curves[0].parts[0].clone()
}

/// The warnings of a file with one entity that is not read.
fn refusal(entity: u32, form: i32, parameters: &str) -> String {
    let file = Draft::new(&[(entity, form, parameters)]).read();
    assert!(file.curves.is_empty() && file.entities[0].unread == 1 && file.warnings.len() == 1, "{file:?}");
    file.warnings[0].clone()
}

fn ends(curve: &Nurbs) -> (DVec3, DVec3) {
    (curve.point(curve.domain().0), curve.point(curve.domain().1))
}

#[track_caller]
fn assert_near(found: DVec3, expect: DVec3) {
    assert!(found.distance(expect) <= 1e-9 * (1.0 + expect.length()), "{found} is not {expect}");
}

fn spread(curve: &Nurbs) -> Vec<f64> {
    let (start, end) = curve.domain();
    (0..=64).map(|i| start + (end - start) * f64::from(i) / 64.0).collect()
}

#[test]
#[cfg_attr(no_models, ignore = "no shared models")]
fn real_files_give_every_entity_and_curve() {
    for (name, unit, expect) in REAL {
        let bytes = model(name);
        let file = read(&bytes).unwrap();
        let counts: Vec<(u32, usize)> = file.entities.iter().map(|e| (e.entity, e.read + e.unread)).collect();
        assert_eq!(counts, expect, "{name}");
        assert_eq!(file.unit_mm, unit, "{name}");
        for count in &file.entities {
            let is_curve = matches!(count.entity, 100 | 102 | 110 | 124 | 126);
            assert_eq!((count.read == 0, count.unread == 0), (!is_curve, is_curve), "{name}: {count:?}");
        }
        let curves: usize = expect.iter().filter(|(e, _)| matches!(e, 100 | 102 | 110 | 126)).map(|(_, n)| n).sum();
        assert_eq!(file.curves.len(), curves, "{name}");
        eprintln!("{name}: {} curves, {} independent", curves, file.independent_curves().count());
        file.warnings.iter().for_each(|w| eprintln!("    {w}"));
    }
}

#[test]
#[cfg_attr(no_models, ignore = "no shared models")]
fn every_shared_iges_file_is_in_the_table() {
    let folder = models();
    let names = fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    let mut iges: Vec<String> = names.filter(|n| n.ends_with(".igs") || n.ends_with(".iges")).collect();
    iges.sort();
    assert_eq!(iges, REAL.map(|(name, ..)| name));
}

#[test]
#[cfg_attr(no_models, ignore = "no shared models")]
fn real_curves_are_those_of_the_definition() {
    let (mut points, mut worst) = (0, 0.0_f64);
    for (name, ..) in REAL {
        let bytes = model(name);
        for part in read(&bytes).unwrap().curves.iter().flat_map(|c| &c.parts) {
            // The recursion takes 2^degree steps for each control point.
            let few = if part.control_points().len() > 60 { 8 } else { 1 };
            for u in spread(part).into_iter().step_by(few) {
                let error = part.point(u).distance(from_definition(part, u)) / (1.0 + part.extent());
                worst = worst.max(error);
                points += 1;
            }
        }
    }
    eprintln!("{points} points, the worst {worst:.1e} of the extent off");
    assert!(worst < 1e-12, "{worst}");
}

#[test]
#[cfg_attr(no_models, ignore = "no shared models")]
fn real_curves_survive_writing() {
    for (name, ..) in REAL {
        let bytes = model(name);
        let parts: Vec<Nurbs> = read(&bytes).unwrap().curves.into_iter().flat_map(|c| c.parts).collect();
        let named: Vec<(&str, &Nurbs)> = parts.iter().map(|c| ("wall", c)).collect();
        let again = read(write(&named, &WriteOptions::default()).as_bytes()).unwrap();
        assert_eq!(again.warnings, [""; 0], "{name}");
        let again: Vec<Nurbs> = again.curves.into_iter().flat_map(|c| c.parts).collect();
        assert!(again == parts, "{name}");
    }
}

#[test]
#[cfg_attr(no_models, ignore = "no shared models")]
fn the_siemens_file_is_in_metres_and_its_arc_in_place() {
    let bytes = model("tubes_siemens.iges");
    let file = read(&bytes).unwrap();
    let curve = |entry| file.curves.iter().find(|c: &&IgesCurve| c.entry == entry).unwrap();
    assert!(file.system.contains("Siemens"));
    // The rectangle's sides stand in the wrong order in the file.
    assert!(file.warnings.len() == 1 && file.warnings[0].contains("D13 are listed out of sequence"), "{file:?}");
    for side in curve(13).parts.windows(2) {
        assert_near(ends(&side[0]).1, ends(&side[1]).0);
    }
    assert_near(ends(&curve(1).parts[0]).0, dvec3(152.4, 0.0, 0.0));
    assert_eq!((curve(13).name.as_str(), curve(13).parts.len()), ("Curve 2", 4));
    assert_eq!((curve(5).dependence, curve(13).dependence), (Dependence::Physical, Dependence::Independent));
    // The arc joins the lines before and behind it only when its matrix is applied.
    let parts = &curve(23).parts;
    assert_near(ends(&parts[0]).1, ends(&parts[1]).0);
    assert_near(ends(&parts[1]).1, ends(&parts[2]).0);
    let independent: Vec<u32> = file.independent_curves().map(|c| c.entry).collect();
    assert_eq!(independent, [1, 3, 13, 23]);
}

#[test]
#[cfg_attr(no_models, ignore = "no shared models")]
fn curves_of_a_parameter_plane_are_marked_and_keep_their_numbers() {
    let bytes = model("rounded_cube.iges");
    let file = read(&bytes).unwrap();
    let parametric = file.curves.iter().filter(|c| c.is_parametric);
    for curve in parametric.clone() {
        assert!(curve.parts.iter().all(|p| p.bounds().0.z == 0.0 && p.bounds().1.z == 0.0), "D{}", curve.entry);
    }
    // Seven boundaries, each a composite of its members in the plane and one in space.
    assert_eq!(parametric.filter(|c| c.entity == 102).count(), 7);
    assert!(file.independent_curves().all(|c| !c.is_parametric));
}

#[test]
fn a_line_has_its_ends_in_every_unit() {
    for (unit, mm) in [("2,2HMM", 1.0), ("1,4HINCH", 25.4), ("6,1HM", 1000.0), ("10,2HCM", 10.0), ("3,2HFT", 304.8)] {
        let file = Draft::new(&[(110, 0, "110,1.,2.,3.,-4.,5.5,6.D0;")]).global("2,2HMM", unit).read();
        assert_eq!((file.unit_mm, file.warnings.len()), (mm, 0));
        let (a, b) = ends(&file.curves[0].parts[0]);
        assert_near(a, dvec3(1.0, 2.0, 3.0) * mm);
        assert_near(b, dvec3(-4.0, 5.5, 6.0) * mm);
    }
    let file = Draft::new(&[(110, 0, "110,1.,2.,3.,-4.,5.5,6.;")]);
    let file = file.global("4Hpart,1.0,2,2HMM", "4Hpart,0.5,2,2HIN").read();
    assert_near(ends(&file.curves[0].parts[0]).0, dvec3(2.0, 4.0, 6.0));
    assert!(file.warnings[0].contains("drawn at scale 0.5") && file.warnings[1].contains("called IN"));
}

#[test]
fn numbers_are_read_in_every_spelling() {
    for (text, value) in [
        ("1.5D-3", 0.0015),
        ("15.E-4", 0.0015),
        ("+.0015", 0.0015),
        ("1.5d-03", 0.0015),
        ("2", 2.0),
        ("", 0.0),
        (" -7. ", -7.0),
    ] {
        let line = only(110, 0, &format!("110,{text},0.,0.,9.,9.,9.;"));
        assert_eq!(ends(&line).0.x, value, "{text}");
    }
    for text in ["1.5X", "nan", "inf", "1e999", "3HABC", "1..2"] {
        let warning = refusal(110, 0, &format!("110,0.,{text},0.,9.,9.,9.;"));
        assert!(warning.contains("line at directory entry D1 was not read: parameter 2 on line 6"), "{warning}");
    }
}

#[test]
fn strings_run_over_cards_and_hide_delimiters() {
    let name = "a wall, drawn; with 3Hodd and very long words that need more than one card of 64 columns";
    let line = "110,0.,0.,0.,1.,0.,0.,0,1,3;";
    let file = Draft::new(&[(110, 0, line), (406, 15, &format!("406,1,{}H{name};", name.len()))]).read();
    assert_eq!(file.curves[0].name, name);
    assert_eq!(file.entities[1].read, 1);
    let long = format!("{}H{name}", name.len());
    let file = Draft::new(&[(110, 0, line)]).global("4Htest", &long).read();
    assert_eq!((file.system.as_str(), file.curves[0].name.as_str()), (name, "E0"));
}

#[test]
fn other_delimiters_are_used() {
    for (head, a, b) in [("1H/,1H#,", '/', '#'), (",,", ',', ';'), ("1H,,,", ',', ';'), (",1H!,", ',', '!')] {
        let change = |text: &str| text.replace(',', &a.to_string()).replace(';', &b.to_string());
        let mut draft = Draft::new(&[(110, 0, &change("110,1.,2.,3.,4.,5.,6.;"))]);
        draft.global = change(head) + &change(&draft.global["1H,,1H;,".len()..]);
        assert_near(ends(&draft.read().curves[0].parts[0]).1, dvec3(4.0, 5.0, 6.0));
    }
}

#[test]
fn line_ends_and_blank_lines_do_not_matter() {
    let draft = Draft::new(&[(110, 0, "110,1.,2.,3.,4.,5.,6.;"), (100, 0, "100,0.,0.,0.,1.,0.,0.,1.;")]);
    let (cards, expect) = (draft.cards(), draft.read());
    let short: Vec<&str> = cards.iter().map(|c| c.trim_end()).collect();
    for text in [cards.join("\r\n"), cards.join("\r"), cards.concat(), cards.join("\n\n"), short.join("\n") + "\n\x1a"]
    {
        assert_eq!(read(text.as_bytes()).unwrap(), expect);
    }
}

#[test]
fn arcs_run_counter_clockwise() {
    let quarter = only(100, 0, "100,5.,1.,1.,4.,1.,1.,4.;");
    assert!((quarter.length() - 3.0 * FRAC_PI_2).abs() < 1e-9);
    assert_near(quarter.arc_length().point(1.5 * FRAC_PI_2), dvec3(1.0 + 4.5_f64.sqrt(), 1.0 + 4.5_f64.sqrt(), 5.0));
    let rest = only(100, 0, "100,5.,1.,1.,1.,4.,4.,1.;");
    assert!((rest.length() - 9.0 * FRAC_PI_2).abs() < 1e-9);
    let circle = only(100, 0, "100,0.,0.,0.,0.,-2.,0.,-2.;");
    assert!((circle.length() - 2.0 * TAU).abs() < 1e-9 && circle.is_closed());
    assert!(refusal(100, 0, "100,0.,0.,0.,1.,0.,0.,2.;").contains("the radius is 1 at its start and 2 at its end"));
}

#[test]
fn conics_keep_their_equations() {
    let check = |parameters: &str, form: i32, value: &dyn Fn(DVec3) -> f64, expect: [DVec3; 2]| {
        let curve = only(104, form, parameters);
        assert!(spread(&curve).into_iter().all(|u| value(curve.point(u)).abs() < 1e-12), "{parameters}");
        let (a, b) = ends(&curve);
        assert_near(a, expect[0]);
        assert_near(b, expect[1]);
        curve
    };
    // x²/9 + y²/4 = 1: the quarter, and the whole.
    let ellipse = |p: DVec3| p.x * p.x / 9.0 + p.y * p.y / 4.0 - 1.0;
    let quarter = "104,4.,0.,9.,0.,0.,-36.,2.,3.,0.,0.,2.;";
    check(quarter, 1, &ellipse, [dvec3(3.0, 0.0, 2.0), dvec3(0.0, 2.0, 2.0)]);
    let whole = check("104,-4.,0.,-9.,0.,0.,36.,0.,0.,2.,0.,2.;", 1, &ellipse, [dvec3(0.0, 2.0, 0.0); 2]);
    // 12 E(√5/3).
    assert!((whole.length() - 15.865_439_589_290_59).abs() < 1e-9, "{}", whole.length());
    // The same turned by 45° about (1, 1): 13 x² − 10 x y + 13 y² … with half axes 3 and 2.
    let turned = |p: DVec3| {
        let (x, y) = (p.x - 1.0, p.y - 1.0);
        ellipse(dvec3(x + y, y - x, 0.0) / 2.0_f64.sqrt())
    };
    let half = 4.5_f64.sqrt();
    let text =
        format!("104,13.,-10.,13.,-16.,-16.,-56.,0.,{},{},{},{};", 1.0 + half, 1.0 + half, 1.0 - half, 1.0 - half);
    check(&text, 1, &turned, [dvec3(1.0 + half, 1.0 + half, 0.0), dvec3(1.0 - half, 1.0 - half, 0.0)]);
    // y = x², and x² − y² = 1 on its right branch.
    let parabola = |p: DVec3| p.y - p.x * p.x;
    check("104,1.,0.,0.,0.,-1.,0.,0.,-1.,1.,2.,4.;", 3, &parabola, [dvec3(-1.0, 1.0, 0.0), dvec3(2.0, 4.0, 0.0)]);
    let y = 3.0_f64.sqrt();
    let hyperbola = |p: DVec3| p.x * p.x - p.y * p.y - 1.0;
    let text = format!("104,1.,0.,-1.,0.,0.,-1.,0.,2.,{y},2.,{};", -y);
    check(&text, 2, &hyperbola, [dvec3(2.0, y, 0.0), dvec3(2.0, -y, 0.0)]);
    let other = refusal(104, 2, &format!("104,1.,0.,-1.,0.,0.,-1.,0.,2.,{y},-2.,{y};"));
    assert!(other.contains("one branch"), "{other}");
    assert!(refusal(104, 1, "104,1.,0.,1.,0.,0.,1.,0.,1.,0.,0.,1.;").contains("no real points"));
}

#[test]
fn copious_data_become_polylines() {
    let [flat, space] = ["106,1,3,7.,0.,0.,3.,0.,3.,4.;", "106,2,3,0.,0.,7.,3.,0.,7.,3.,4.,7.;"];
    let vectors = "106,3,3,0.,0.,7.,1.,1.,1.,3.,0.,7.,1.,1.,1.,3.,4.,7.,1.,1.,1.;";
    let corners = [dvec3(0.0, 0.0, 7.0), dvec3(3.0, 0.0, 7.0), dvec3(3.0, 4.0, 7.0)];
    for (form, text) in [(1, flat), (11, flat), (2, space), (12, space), (3, vectors), (13, vectors)] {
        assert_eq!(only(106, form, text).control_points(), corners, "form {form}");
    }
    let closed = only(106, 63, flat);
    assert!(closed.is_closed() && (closed.length() - 12.0).abs() < 1e-12);
    assert!(refusal(106, 20, flat).contains("copious data of form 20 is not read"));
    assert!(refusal(106, 11, "106,1,3000000000,7.,0.,0.;").contains("announces 3000000000 items"));
}

#[test]
fn parametric_splines_become_cubics() {
    // x = u, y = u³, z = 1 on breaks 0, 1, 3: on the second piece y = 1 + 3 s + 3 s² + s³.
    let text = "112,3,2,2,2,0.,1.,3.,0.,1.,0.,0.,0.,0.,0.,1.,1.,0.,0.,0.,1.,1.,0.,0.,1.,3.,3.,1.,1.,0.,0.,0.,\
                3.,1.,0.,0.,27.,27.,9.,1.,1.,0.,0.,0.;";
    let curve = only(112, 0, text);
    for u in spread(&curve) {
        assert_near(curve.point(u), dvec3(u, u * u * u, 1.0));
    }
    assert_eq!(curve.breaks(), [0.0, 1.0, 3.0]);
    assert!(refusal(112, 0, &text.replace("1.,3.,3.,1.,1.", "5.,3.,3.,1.,1.")).contains("do not meet"));
}

#[test]
fn a_spline_with_a_range_is_cut() {
    let curve = cubic();
    let text = write(&[("wall", &curve)], &WriteOptions::default());
    let file = read(text.as_bytes()).unwrap();
    assert_eq!(file.curves[0].parts[0], curve);
    // The same curve by its own text, from 0.2 to 0.8.
    let numbers = |v: &[f64]| v.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(",");
    let points: Vec<f64> = curve.control_points().iter().flat_map(|p| p.to_array()).collect();
    let (knots, weights, points) = (numbers(curve.knots()), numbers(curve.weights()), numbers(&points));
    let piece = only(126, 0, &format!("126,5,3,0,0,1,0,{knots},{weights},{points},0.2,0.8;"));
    assert_eq!(piece.domain(), (0.2, 0.8));
    assert!(spread(&piece).into_iter().all(|u| piece.point(u).distance(curve.point(u)) < 1e-12));
}

#[test]
fn matrices_are_chained() {
    // A quarter turn about z and a shift by 10 in x, itself shifted by 5 in z.
    let turn = "124,0.,-1.,0.,10.,1.,0.,0.,0.,0.,0.,1.,0.;";
    let shift = "124,1.,0.,0.,0.,0.,1.,0.,0.,0.,0.,1.,5.;";
    let draft = Draft::new(&[(110, 0, "110,0.,0.,0.,1.,0.,0.;"), (124, 0, turn), (124, 0, shift)]);
    let file = draft.matrix(0, 3).matrix(1, 5).global("2,2HMM", "10,2HCM").read();
    let (a, b) = ends(&file.curves[0].parts[0]);
    assert_near(a, dvec3(100.0, 0.0, 50.0));
    assert_near(b, dvec3(100.0, 10.0, 50.0));
}

#[test]
fn composites_place_their_members() {
    let entities = [
        (110, 0, "110,0.,0.,0.,3.,0.,0.;"),
        (100, 0, "100,0.,3.,2.,3.,0.,5.,2.;"),
        (102, 0, "102,2,1,3;"),
        (124, 0, "124,1.,0.,0.,0.,0.,1.,0.,0.,0.,0.,1.,5.;"),
    ];
    let file =
        Draft::new(&entities).matrix(2, 7).status(0, "00010000").status(1, "00030000").status(2, "01020000").read();
    assert_eq!(file.warnings, [""; 0]);
    let composite = &file.curves[2];
    assert_near(ends(&composite.parts[0]).0, dvec3(0.0, 0.0, 5.0));
    assert_near(ends(&composite.parts[1]).1, dvec3(5.0, 2.0, 5.0));
    assert!((composite.parts[1].length() - PI).abs() < 1e-9);
    let dependence: Vec<Dependence> = file.curves.iter().map(|c| c.dependence).collect();
    assert_eq!(dependence, [Dependence::Physical, Dependence::Both, Dependence::Logical]);
    assert_eq!(file.curves.iter().map(|c| c.is_visible).collect::<Vec<_>>(), [true, true, false]);
    assert_eq!(file.curves.iter().map(|c| c.level).collect::<Vec<_>>(), [0, 1, 2]);
}

#[test]
fn composites_are_joined_in_any_order_and_direction() {
    let sides = ["3.,0.,0.,3.,2.,0.", "0.,0.,0.,3.,0.,0.", "0.,2.,0.,3.,2.,0.", "0.,4.,0.,0.,2.,0."];
    let lines: Vec<String> = sides.iter().map(|s| format!("110,{s};")).collect();
    let mut entities: Vec<(u32, i32, &str)> = lines.iter().map(|l| (110, 0, l.as_str())).collect();
    entities.push((102, 0, "102,4,1,3,5,7;"));
    let file = Draft::new(&entities).read();
    let found: Vec<DVec3> = file.curves[4].parts.iter().flat_map(|p| [ends(p).0, ends(p).1]).collect();
    let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0], [0.0, 4.0]].map(|[x, y]| dvec3(x, y, 0.0));
    assert_eq!(found, corners.windows(2).flatten().copied().collect::<Vec<_>>());
    assert_eq!(file.warnings.len(), 1);
}

#[test]
fn gaps_and_wrong_pointers_are_reported() {
    let check = |draft: Draft, expect: &str| {
        let warnings = draft.read().warnings;
        assert!(warnings.iter().any(|w| w.contains(expect)), "{warnings:?} lacks {expect:?}");
    };
    let line = (110, 0, "110,0.,0.,0.,3.,0.,0.;");
    let far = (110, 0, "110,3.,0.,0.25,9.,0.,0.;");
    check(
        Draft::new(&[line, far, (102, 0, "102,2,1,3;")]),
        "composite curve at directory entry D5 do not meet: the widest gap is 0.250 mm",
    );
    check(Draft::new(&[line, (102, 0, "102,1,9;")]), "D9, which does not exist");
    check(Draft::new(&[line, (102, 0, "102,2,1,1;")]), "it holds the line at directory entry D1 twice");
    check(
        Draft::new(&[line, (102, 0, "102,1,3;")]),
        "its member, the composite curve at directory entry D3, is not read",
    );
    check(Draft::new(&[line, (102, 0, "102,0;")]), "it has no members");
    check(Draft::new(&[line, (102, 0, "102,5,1;")]), "announces 5 items");
    check(Draft::new(&[line, line]).matrix(0, 3), "its matrix should be at D3, where there is a line");
    let matrix = (124, 0, "124,1.,0.,0.,0.,0.,1.,0.,0.,0.,0.,1.,5.;");
    check(Draft::new(&[line, matrix]).matrix(0, 3).matrix(1, 3), "point to each other in a loop");
    check(Draft::new(&[line, (124, 0, "124,1.,0.;")]).matrix(0, 3), "its matrix at D3 is broken");
    check(Draft::new(&[(110, 0, "110,0.,0.,0.,3.,0.;")]), "parameter 6 is missing (the record has 5)");
    check(Draft::new(&[(110, 0, "110,0.,0.,0.,3.,0.,1.")]), "without the \";\" that closes the record");
    check(Draft::new(&[(110, 0, "100,0.,0.,0.,3.,0.,1.;")]), "begin with \"100\", not 110");
    check(Draft::new(&[(110, 0, "110,0.,99Habc;")]), "the string of 99 characters on line 6 is longer");
    check(
        Draft::new(&[(126, 0, "126,1,1,0,0,1,0,0.,0.,1.,1.,1.,0.,0.,0.,0.,1.,1.,1.;")]),
        "weight 2 of the curve is 0",
    );
    check(Draft::new(&[(126, 0, "126,1,9000000000,0,0,1,0,0.,0.,1.,1.,1.,0.,0.;")]), "too few for its degree");
    check(
        Draft::new(&[line, (144, 0, "144,1;"), (144, 0, "144,1;")]),
        "2 entities of type 144 (trimmed surface) not read",
    );
    check(Draft::new(&[(777, 0, "777;")]), "1 entity of type 777 (unknown entity) not read");
}

#[test]
fn cards_that_do_not_match_the_last_are_reported() {
    let mut cards = Draft::new(&[(110, 0, "110,0.,0.,0.,3.,0.,0.;")]).cards();
    let last = cards.pop().unwrap();
    cards.push(last.replace("P      1", "P      4"));
    let warnings = read(cards.join("\n").as_bytes()).unwrap().warnings;
    assert!(warnings.len() == 1 && warnings[0].contains("announces 4 P cards, but there are 1"), "{warnings:?}");
}

#[test]
fn broken_files_give_one_clear_error() {
    let check = |bytes: &[u8], expect: &str| {
        let error = read(bytes).unwrap_err().to_string();
        assert!(error.contains(expect), "{error:?} lacks {expect:?}");
    };
    let draft = || Draft::new(&[(110, 0, "110,0.,0.,0.,3.,0.,0.;")]);
    let cards = draft().cards();
    check(b"", "the file is empty (0 bytes)");
    check(b" \n\n", "nothing but white space");
    check(b"solid cube\nfacet", "this is not an IGES file: line 1 has no S in column 73");
    check(&[0xff; 500], "this is not an IGES file");
    check(&[0; 500], "this is not an IGES file");
    check(format!("{:<72}C      1\n", "compressed").as_bytes(), "IGES file in compressed form");
    check(format!("{:<72}B      1\n", "binary").as_bytes(), "IGES file in binary form");
    check(cards[..cards.len() - 1].join("\n").as_bytes(), "cut short: it ends at line 6 without a T card");
    check(&draft().text().as_bytes()[..500], "cut short: line 7, the last, ends in column 14");
    check(format!("{}\n{}\n", cards[0], cards[cards.len() - 1]).as_bytes(), "ends without a global section");
    check(
        [&cards[..4], &["short".to_owned()], &cards[4..]].concat().join("\n").as_bytes(),
        "line 5 of the IGES file cannot be read: it ends in column 5",
    );
    check([&cards[..4], &cards[5..]].concat().join("\n").as_bytes(), "the second is missing");
    check([&cards[..5], &cards[1..]].concat().join("\n").as_bytes(), "a card of section G follows section D");
    check(cards.join("\n").replace("     110       1", "     110     x.1").as_bytes(), "columns 9 to 16 hold \"x.1\"");
    check(
        cards.join("\n").replacen("     110       0", "     112       0", 1).as_bytes(),
        "type 110 on its first card and 112",
    );
    check(draft().global("2,2HMM", "0,3HELL").text().as_bytes(), "unit flag 0 and the unit name \"ELL\"");
    check(draft().global("1H,,1H;,", "1H,,1H,,").text().as_bytes(), "cannot be the delimiters");
    check(draft().global("1H,,1H;,", "1Hx;1H;x").text().as_bytes(), "\";\" is where the delimiter \"x\" belongs");
    check(draft().global("4Hpart,1.0", "4Hpart,-1.0").text().as_bytes(), "the scale of the drawing is -1");
    check(draft().global("000000;", "000000").text().as_bytes(), "without the \";\" that closes the record");
}

#[test]
fn written_files_are_of_eighty_columns_and_always_the_same() {
    let circle = Nurbs::circle(dvec3(1e-7, 1e9, -0.1), DVec3::X * 1e-3, DVec3::Z * 1e-3).unwrap();
    let options = WriteOptions { file_name: format!("a very {} path.igs", "long ".repeat(30)), ..Default::default() };
    let text = write(&[("näme that is too long", &cubic()), ("", &circle)], &options);
    assert!(text.lines().all(|line| line.len() == 80), "{text}");
    assert_eq!(text, write(&[("näme that is too long", &cubic()), ("", &circle)], &options));
    let file = read(text.as_bytes()).unwrap();
    assert_eq!((file.curves[0].name.as_str(), file.curves[1].name.as_str()), ("n?me tha", ""));
    assert_eq!((&file.curves[0].parts[0], &file.curves[1].parts[0]), (&cubic(), &circle));
    assert_eq!((file.system.as_str(), file.warnings.len()), (concat!("Beadwright ", env!("CARGO_PKG_VERSION")), 0));
    assert!(read(write(&[], &options).as_bytes()).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_number_survives_writing(values in prop::collection::vec(prop::num::f64::NORMAL | prop::num::f64::ZERO, 12)) {
        let points: Vec<DVec3> = values.chunks(3).map(DVec3::from_slice).collect();
        let knots = vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
        let curve = Nurbs::new(3, knots, vec![0.1, 1.0 / 3.0, 1e-30, 7.0], points).unwrap();
        let file = read(write(&[("x", &curve)], &WriteOptions::default()).as_bytes()).unwrap();
        prop_assert_eq!(&file.curves[0].parts[0], &curve);
    }

    #[test]
    fn mutated_files_never_panic(
        which in 0_usize..5,
        changes in prop::collection::vec((any::<prop::sample::Index>(), prop_oneof![any::<u8>(), b'0'..=b'9', Just(b','), Just(b';'), Just(b'H')]), 0..12),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let entities = [
            (110, 0, "110,0.,0.,0.,3.,0.,0.,0,1,11;"), (100, 0, "100,0.,3.,2.,3.,0.,5.,2.;"), (102, 0, "102,2,1,3;"),
            (124, 0, "124,0.,-1.,0.,10.,1.,0.,0.,0.,0.,0.,1.,0.;"), (104, 1, "104,4.,0.,9.,0.,0.,-36.,2.,3.,0.,0.,2.;"),
            (406, 15, "406,1,4Hwall;"), (106, 12, "106,2,2,0.,0.,7.,3.,0.,7.;"), (142, 0, "142,1,0,5,0,1;"),
            (112, 0, "112,3,2,3,1,0.,1.,0.,1.,0.,0.,0.,0.,0.,1.,1.,0.,0.,0.,1.,1.,0.,0.,1.,3.,3.,1.,1.,0.,0.,0.;"),
        ];
        let own = || Draft::new(&entities).matrix(1, 7).text() .into_bytes();
        let mut bytes = match which {
            0 | 1 => own(),
            2 => write(&[("a", &cubic()), ("b", &cubic().reversed())], &WriteOptions::default()).into_bytes(),
            3 => fs::read(models().join("tubes_siemens.iges")).unwrap_or_else(|_| own()),
            _ => fs::read(models().join("rounded_cube.iges")).unwrap_or_else(|_| own()),
        };
        for (place, value) in changes {
            let i = place.index(bytes.len());
            bytes[i] = value;
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        match read(&bytes) {
            Ok(file) => {
                let total: usize = file.entities.iter().map(|e| e.read + e.unread).sum();
                let curves = file.entities.iter().filter(|e| matches!(e.entity, 100 | 102 | 104 | 106 | 110 | 112 | 126));
                prop_assert!(total > 0);
                prop_assert_eq!(curves.map(|e| e.read).sum::<usize>(), file.curves.len());
                for part in file.curves.iter().flat_map(|c| &c.parts) {
                    let (length, closest) = (part.length(), part.closest(DVec3::ONE));
                    prop_assert!(!(length < 0.0 || closest.distance < 0.0));
                }
            }
            Err(error) => prop_assert!(error.to_string().ends_with('.')),
        }
    }

    #[test]
    fn garbage_never_panics(bytes in prop::collection::vec(any::<u8>(), 0..2000)) {
        prop_assert!(read(&bytes).is_err());
    }
}

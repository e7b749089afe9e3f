//! Colours can be told apart by everybody, with normal sight and without the red, green or blue cones, and are the same
//! wherever they are seen.

use crate::common;
use crate::sight;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use beadwright::export::{self, Beads};
use beadwright::model::RepairReport;
use beadwright::palette::{self, KINDS, hex};
use beadwright::pass::PassKind;
use beadwright::plan::Plan;
use beadwright::planar::DVec2;
use beadwright::profile::Profile;
use beadwright::report::plot::{Curve, Plot};
use beadwright::report::sheet::Sheet;
use beadwright::report::{Report, svg};
use sight::{Rgb, SIGHTS, difference, lab};
use std::fs;
use std::path::{Path, PathBuf};

/// Fails where two of the colours are nearer than `least` to somebody.
fn check_apart(what: &str, colours: &[Rgb], least: f64) {
    assert!(colours.len() > 1, "{what}");
    for (number, sight) in SIGHTS.iter().enumerate() {
        for (i, a) in colours.iter().enumerate() {
            for b in &colours[..i] {
                let apart = difference(*a, *b, sight);
                assert!(apart > least, "{what}, sight {number}: {a:?} and {b:?} differ by {apart:.0}");
            }
        }
    }
}

#[test]
fn kinds_and_marks_are_told_apart() {
    check_apart("kinds", &KINDS.map(palette::kind), 30.0);
    check_apart("starts and ends", &[palette::START, palette::END], 40.0);
    check_apart("curves", &palette::CURVES, 20.0);
    check_apart("bodies", &palette::BODIES, 25.0);
    check_apart("leans", &palette::LEANS.map(|(_, colour)| colour), 10.0);
    check_apart("steps", &[palette::STEP, palette::FLIP, palette::kind(PassKind::Contour)], 20.0);
    for colour in KINDS.map(palette::kind).into_iter().chain(palette::HEIGHTS.map(|(_, colour)| colour)) {
        check_apart("voids and metal", &[palette::VOID, colour], 12.0);
    }
    for dark in [false, true] {
        check_apart("verdicts", &[palette::good(dark), palette::bad(dark)], 20.0);
    }
}

#[test]
fn the_quarters_of_every_scale_are_told_apart() {
    for scale in [palette::rising, palette::warmth, |part| palette::height(2.0 * part)] {
        let stops: Vec<Rgb> = (0..=4).map(|i| scale(f64::from(i) / 4.0)).collect();
        check_apart("a scale", &stops, 12.0);
    }
    for scale in [palette::rising, palette::warmth] {
        for sight in &SIGHTS {
            let light: Vec<f64> = (0..=20).map(|i| lab(scale(f64::from(i) / 20.0), sight)[0]).collect();
            assert!(light.is_sorted(), "{light:.0?}");
        }
    }
    // Too little and too much metal differ as much from what was planned.
    let far = |height: f64| difference(palette::height(height), palette::height(1.0), &SIGHTS[0]);
    assert!(far(0.9) > 5.0 && far(1.1) > 5.0 && far(0.5) > 30.0 && far(1.5) > 30.0);
}

/// A plan with passes of two kinds.
fn planned() -> (Plan, Profile) {
    let mut profile = common::profile("cmt-al2319-kuka");
    profile.fill.strategy = "compound".parse().unwrap();
    let plan = common::planned("cross", &profile);
    (plan, profile)
}

#[test]
fn a_kind_has_one_colour_in_pages_drawings_and_scenes() {
    let (plan, profile) = planned();
    let kinds: Vec<PassKind> =
        KINDS.into_iter().filter(|k| plan.layers.iter().flat_map(|l| &l.passes).any(|p| p.kind == *k)).collect();
    assert!(kinds.len() > 1, "{kinds:?}");
    let mut report = Report::new(&plan.header, &profile);
    plan.layers.iter().for_each(|layer| report.layer(layer, None));
    let report = report.finish(&plan.summary, &RepairReport::default(), &[], &[]);
    for page in [&report, &Sheet::new("", "").html()] {
        assert_eq!(page.matches("--contour: ").count(), 2, "on bright and on dark pages");
        for kind in KINDS {
            let colour = palette::kind(kind);
            assert_eq!(page.matches(&format!("--{}: {};", kind.name(), hex(colour))).count(), 2);
            assert!(page.contains(&serde_json::json!([kind.name(), colour]).to_string()), "{}", kind.name());
        }
        assert!(page.contains(&format!("--void: {};", hex(palette::VOID))));
    }
    let beads = Beads { header: &plan.header, layers: &plan.layers, profile: &profile, heat: None };
    let drawing = |name: &str| {
        let format = export::layer_format(name).unwrap();
        String::from_utf8((format.write)(&plan.layers[0]).unwrap()).unwrap()
    };
    let scene = |name: &str| (export::format(name).unwrap().write)(&beads).unwrap();
    let glb = scene("glb");
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    let gltf: serde_json::Value = serde_json::from_slice(&glb[20..20 + length]).unwrap();
    let vtp = String::from_utf8(scene("vtp")).unwrap();
    let text = vtp.split("Name=\"colour\"").nth(1).unwrap().lines().nth(1).unwrap();
    let bytes = STANDARD.decode(text).unwrap();
    let (picture, drawn) = (svg::layer(&plan.layers[0], ""), drawing("svg"));
    for kind in kinds {
        let colour = palette::kind(kind);
        assert!(bytes[8..].chunks(3).any(|c| c == colour), "{} in VTP", kind.name());
        let material = gltf["materials"].as_array().unwrap().iter().find(|m| m["name"] == kind.name()).unwrap();
        let shares = &material["pbrMetallicRoughness"]["baseColorFactor"];
        let shown = [0, 1, 2].map(|c| encoded(shares[c].as_f64().unwrap()));
        assert_eq!(shown, colour, "{} in GLB", kind.name());
        if plan.layers[0].passes.iter().any(|pass| pass.kind == kind) {
            for text in [&picture, &drawn] {
                assert!(text.contains(&format!("stroke=\"{}\"", hex(colour))), "{} in SVG", kind.name());
            }
        }
    }
}

/// A share of light as a value of the screen (sRGB, IEC 61966-2-1).
fn encoded(share: f64) -> u8 {
    let value = if share <= 0.0031308 { 12.92 * share } else { 1.055 * share.powf(1.0 / 2.4) - 0.055 };
    (255.0 * value).round() as u8
}

/// Colours with a hue are in the palette, so that none is chosen twice; greys, and the grounds of pages in their styles, are not.
#[test]
fn colours_are_chosen_in_one_place() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut read = 0;
    for name in ["beadwright", "beadwright-studio", "papers", "record", "distort", "robot"] {
        for file in files(&crates.join(name).join("src")) {
            let text = fs::read_to_string(&file).unwrap();
            read += 1;
            for (line, number) in text.lines().zip(1..) {
                let found = line.match_indices('#').filter_map(|(at, _)| line.get(at + 1..at + 7));
                let hexes = found.filter_map(|digits| u32::from_str_radix(digits, 16).ok());
                for [_, r, g, b] in hexes.map(u32::to_be_bytes) {
                    let hue = r.max(g).max(b) - r.min(g).min(b);
                    assert!(hue < 28, "{}:{number}: take it from palette.rs: {}", file.display(), line.trim());
                }
                let mixes = line.contains("from_rgb(") && !file.ends_with("theme.rs");
                assert!(!mixes, "{}:{number}: use theme::ink: {}", file.display(), line.trim());
            }
        }
    }
    assert!(read > 200, "{read}");
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let all = entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] });
    all.filter(|path| path.extension().is_some_and(|ending| ending == "rs" || ending == "js")).collect()
}

#[test]
fn every_curve_of_a_plot_is_distinct_and_named_inside_it() {
    let names =
        ["loop", "raster", "zigzag", "contour", "compound", "hybrid", "spiral", "fermat", "hilbert", "partition"];
    let curve = |name: &str| Curve { name: name.to_owned(), points: vec![DVec2::ZERO, DVec2::new(9.0, 1.0)] };
    let svg = Plot { title: "Void".to_owned(), curves: names.map(curve).to_vec(), ..Plot::default() }.svg();
    let looks: Vec<_> =
        svg.split("<polyline ").skip(1).map(|line| (of(line, "stroke"), of(line, "stroke-dasharray"))).collect();
    assert!(looks.iter().enumerate().all(|(i, look)| !looks[..i].contains(look)), "{looks:?}");
    for name in names {
        let place = svg.split(&format!(">{name}</text>")).next().unwrap().rsplit("<text").next().unwrap();
        let x: f64 = of(place, " x").parse().unwrap();
        assert!(x + 7.2 * name.len() as f64 <= 720.0, "{name} ends outside the picture");
    }
}

/// An attribute of a piece of SVG.
fn of(piece: &str, name: &str) -> String {
    piece.split_once(&format!("{name}=\"")).unwrap().1.split('"').next().unwrap().to_owned()
}

#[test]
fn a_limit_is_a_line_across_a_plot_with_its_value() {
    let curves = vec![Curve { name: "loop".to_owned(), points: vec![DVec2::ZERO, DVec2::new(9.0, 1.0)] }];
    let limits = vec![(3.0, "limit 3 %".to_owned())];
    let svg = Plot { title: "Void".to_owned(), curves, limits, ..Plot::default() }.svg();
    let line = svg.split("<line ").find(|line| line.contains(&hex(palette::bad(false)))).unwrap();
    let [x1, y1, x2, y2] =
        [" x1", " y1", " x2", " y2"].map(|name| of(&format!(" {line}"), name).parse::<f64>().unwrap());
    assert!(y1 == y2 && x2 - x1 > 600.0, "{x1} {y1} {x2} {y2}");
    // Above the curve, which ends at 1.
    let points = of(svg.split("<polyline ").nth(1).unwrap(), "points");
    let end: f64 = points.rsplit(',').next().unwrap().parse().unwrap();
    assert!(y1 < end - 50.0, "{y1}, {end}");
    assert!(svg.contains(">limit 3 %</text>") && of(&svg, "aria-label").ends_with("limit 3 %"));
}

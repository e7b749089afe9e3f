//! The colours of the pages can be told apart by everybody: with normal sight, and without the red, green or blue cones.

use crate::common;
use crate::sight;

use beadwright::model::RepairReport;
use beadwright::planar::DVec2;
use beadwright::report::Report;
use beadwright::report::plot::{Curve, Plot};
use sight::{Rgb, SIGHTS, difference};

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

fn hex(text: &str) -> Rgb {
    [1, 3, 5].map(|i| u8::from_str_radix(&text[i..i + 2], 16).unwrap())
}

fn report() -> String {
    let profile = common::profile("cmt-al2319-kuka");
    let plan = common::planned("cross", &profile);
    let mut report = Report::new(&plan.header, &profile);
    plan.layers.iter().for_each(|layer| report.layer(layer, None));
    let findings = beadwright::check::all_findings(&plan.summary, &[], &[]);
    report.finish(&plan.summary, &RepairReport::default(), &[], &findings)
}

#[test]
fn kinds_and_ends_are_told_apart_on_light_and_dark_pages() {
    let html = report();
    let themes: Vec<&str> = html.split("--contour:").skip(1).map(|rest| rest.split('}').next().unwrap()).collect();
    assert_eq!(themes.len(), 2);
    for theme in themes {
        let theme = format!("--contour:{theme}");
        let named = |name: &str| hex(theme.split_once(&format!("--{name}: ")).unwrap().1);
        check_apart("kinds", &["contour", "infill", "skeleton", "wall"].map(named), 30.0);
        check_apart("starts and ends", &["start", "end"].map(named), 40.0);
    }
}

#[test]
fn the_quarters_of_every_scale_are_told_apart() {
    let html = report();
    for scale in ["RAMP", "EMBER"] {
        let rest = html.split_once(&format!("const {scale} = ")).unwrap().1;
        let stops: Vec<Rgb> = serde_json::from_str(rest.split_once(';').unwrap().0).unwrap();
        check_apart(scale, &stops, 12.0);
    }
}

#[test]
fn every_curve_of_a_plot_is_distinct_and_named_inside_it() {
    let names =
        ["loop", "raster", "zigzag", "contour", "compound", "hybrid", "spiral", "fermat", "hilbert", "partition"];
    let curve = |name: &str| Curve { name: name.to_owned(), points: vec![DVec2::ZERO, DVec2::new(9.0, 1.0)] };
    let svg = Plot { title: "Void".to_owned(), curves: names.map(curve).to_vec(), ..Plot::default() }.svg();
    let of = |piece: &str, name: &str| {
        piece.split_once(&format!("{name}=\"")).unwrap().1.split('"').next().unwrap().to_owned()
    };
    let lines = svg.split("<polyline ").skip(1);
    let looks: Vec<_> = lines.map(|line| (of(line, "stroke"), of(line, "stroke-dasharray"))).collect();
    assert!(looks.iter().enumerate().all(|(i, look)| !looks[..i].contains(look)), "{looks:?}");
    let solid = looks.iter().filter(|(_, dashes)| dashes == "none");
    check_apart("curves", &solid.map(|(colour, _)| hex(colour)).collect::<Vec<_>>(), 20.0);
    for name in names {
        let place = svg.split(&format!(">{name}</text>")).next().unwrap().rsplit("<text").next().unwrap();
        let x: f64 = of(place, " x").parse().unwrap();
        assert!(x + 7.2 * name.len() as f64 <= 720.0, "{name} ends outside the picture");
    }
}

//! `report.html` gives back what was planned, loads nothing, and lets no text of the user become markup.

use crate::common;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use beadwright::check;
use beadwright::finding::{Finding, Severity};
use beadwright::layer::Layer;
use beadwright::model::RepairReport;
use beadwright::pass::{Along, Pass, PassKind, Segment};
use beadwright::plan::Plan;
use beadwright::planar::{DVec2, Polygon, Ring};
use beadwright::process::Process;
use beadwright::profile::Profile;
use beadwright::report::{Report, encode, svg};
use beadwright::warning::{Warning, WarningKind};
use common::profile;
use glam::DVec3;
use std::io::Read;

fn planned(part: &str) -> (Plan, Profile) {
    let profile = profile("cmt-al2319-kuka");
    (common::planned(part, &profile), profile)
}

fn process() -> Process {
    Profile::built_in("cmt-al2319-kuka").unwrap().process
}

fn page(plan: &Plan, profile: &Profile) -> String {
    let mut report = Report::new(&plan.header, profile);
    plan.layers.iter().for_each(|layer| report.layer(layer, None));
    let findings = beadwright::check::all_findings(&plan.summary, &[], &[]);
    report.finish(&plan.summary, &RepairReport::default(), &["a&b.src".to_owned()], &findings)
}

/// Kind, closed, points, width and speed.
type DecodedPass = (u32, bool, Vec<DVec2>, Vec<[f64; 2]>);

/// A layer as the page reads it.
struct Decoded {
    head: Vec<f64>,
    rings: Vec<Vec<DVec2>>,
    /// Kind, closed, points, width, speed.
    passes: Vec<DecodedPass>,
    warnings: serde_json::Value,
}

fn decode(text: &str) -> Decoded {
    let bytes = STANDARD.decode(text).unwrap();
    let (head, deflated) = bytes.split_at(8 * encode::HEAD);
    let head: Vec<f64> = head.chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
    let mut body = Vec::new();
    flate2::read::DeflateDecoder::new(deflated).read_to_end(&mut body).unwrap();
    let u32_at = |i: usize| u32::from_le_bytes(body[4 * i..4 * i + 4].try_into().unwrap());
    let end = 4 + 4 * u32_at(0) as usize;
    let n = head[14] as usize;
    let axis = |first: usize, origin: f64| {
        let planes = &body[end + first..end + first + 2 * n];
        let at = (0..n).scan(0_i64, move |at, i| {
            *at += i64::from(i16::from_le_bytes([planes[i], planes[n + i]]));
            Some(*at)
        });
        at.map(|at| origin + at as f64 * head[13]).collect::<Vec<_>>()
    };
    let mut points = axis(0, head[9]).into_iter().zip(axis(2 * n, head[10])).map(|(x, y)| DVec2::new(x, y));
    let mut table = (1..end / 4).map(u32_at).collect::<Vec<_>>().into_iter();
    let mut next = || table.next().unwrap();
    let mut rings = Vec::new();
    for _ in 0..next() {
        let counts: Vec<_> = (0..next()).map(|_| next()).collect();
        rings.extend(counts.iter().map(|&c| points.by_ref().take(c as usize).collect::<Vec<_>>()));
    }
    let mut passes = Vec::new();
    for _ in 0..next() {
        let (flags, count) = (next(), next());
        let points = points.by_ref().take(count as usize).collect();
        let values = if flags & 512 > 0 { count } else { 1 };
        let along = (0..values).map(|_| [next(), next()].map(|v| f64::from(v) / 1e3)).collect();
        passes.push((flags & 255, flags & 256 > 0, points, along));
    }
    assert!(points.next().is_none() && table.next().is_none(), "something is left over");
    let warnings = serde_json::from_slice(&body[end + 4 * n..]).unwrap();
    Decoded { head, rings, passes, warnings }
}

fn check_round_trip(layer: &Layer) {
    let decoded = decode(&encode::layer(layer, &process(), None));
    let half = decoded.head[13] * 0.5 + 1e-9;
    let check = |points: &[DVec2], original: Vec<DVec2>| {
        assert_eq!(points.len(), original.len());
        let worst = points.iter().zip(original).map(|(a, b)| (*a - b).abs().max_element()).fold(0.0, f64::max);
        assert!(worst <= half, "layer {}: {worst} mm off", layer.index);
    };
    let rings: Vec<&Ring> = layer.islands.iter().flat_map(|i| i.rings()).collect();
    assert_eq!(decoded.rings.len(), rings.len());
    decoded.rings.iter().zip(rings).for_each(|(points, ring)| check(points, ring.points().to_vec()));
    assert_eq!(decoded.passes.len(), layer.passes.len());
    for ((kind, closed, points, along), pass) in decoded.passes.iter().zip(&layer.passes) {
        assert_eq!((*kind == 0, *closed), (pass.kind == PassKind::Contour, pass.closed));
        for (i, [width, speed]) in along.iter().enumerate() {
            assert!((width - pass.width.after(i)).abs() < 1e-3 && (speed - pass.pace.after(i)).abs() < 1e-3);
        }
        check(points, pass.points.iter().map(|p| p.truncate()).collect());
    }
    let length: f64 = layer.passes.iter().map(Pass::length).sum();
    assert_eq!(decoded.head[..2], [layer.z, layer.height]);
    assert_eq!(decoded.head[2..5], [layer.slice_area, layer.planned_area, length]);
    assert_eq!(decoded.head[8] as usize, layer.warnings.len());
}

/// A square of that size about a place far out, with one closed pass and one that crosses it.
fn square(size: f64) -> Layer {
    let at = |x: f64, y: f64| DVec2::new(-7_000.123 + x * size, 4_321.987 + y * size);
    let corners = vec![at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
    let pass = |kind, closed, points: &[DVec2]| {
        let points = points.iter().map(|p| p.extend(3.0)).collect();
        Pass { kind, closed, points, width: Along::Same(7.54), pace: Along::Same(10.5), wait: 0.0 }
    };
    let passes = vec![
        pass(PassKind::Contour, true, &corners),
        pass(PassKind::Infill, false, &[at(0.01, 0.99), at(0.99, 0.01), at(1.0, 1.0)]),
    ];
    let warning = Warning { kind: WarningKind::ThinFeature, layer: 0, place: at(0.5, 0.5), size: 12.34 };
    Layer {
        z: 3.0,
        height: 1.5,
        islands: vec![Polygon::simple(Ring::new(corners))],
        passes,
        slice_area: size * size,
        planned_area: 0.5 * size * size,
        warnings: vec![warning; 100],
        ..Layer::default()
    }
}

#[test]
fn layers_come_back_within_half_a_unit() {
    for part in ["cross", "propeller"] {
        planned(part).0.layers.iter().for_each(check_round_trip);
    }
    for size in [0.1, 50.0, 319.0, 10_000.0, 20_000.0] {
        check_round_trip(&square(size));
    }
    check_round_trip(&Layer::default());
}

#[test]
fn resolution_grows_with_the_layer_only() {
    assert_eq!(decode(&encode::layer(&square(300.0), &process(), None)).head[13], 0.01);
    assert!((decode(&encode::layer(&square(10_000.0), &process(), None)).head[13] - 0.3125).abs() < 1e-9);
}

#[test]
fn many_warnings_of_a_layer_are_shown_in_part() {
    let decoded = decode(&encode::layer(&square(50.0), &process(), None));
    let shown = decoded.warnings.as_array().unwrap();
    assert_eq!((decoded.head[8], shown.len()), (100.0, 30));
    assert_eq!(shown[0][2], "12.3 mm² narrower than a bead left empty");
}

#[test]
fn layers_of_the_page_are_the_encoded_layers() {
    let (plan, profile) = planned("cross");
    let html = page(&plan, &profile);
    let data = data(&html);
    let layers = data["layers"].as_array().unwrap();
    assert_eq!(layers.len(), plan.layers.len());
    layers.iter().zip(&plan.layers).for_each(|(text, layer)| assert_eq!(text, &encode::layer(layer, &process(), None)));
    assert_eq!(html, page(&plan, &profile));
}

/// What the page holds for its scripts.
fn data(html: &str) -> serde_json::Value {
    let (_, data) = html.split_once("id=\"data\">").unwrap();
    serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap()
}

#[test]
fn the_time_line_is_the_time_of_the_plan() {
    for (name, part) in [("cmt-al2319-kuka", "cross"), ("cmt-steel-abb", "propeller"), ("fdm-abs-0.4", "cross")] {
        let mut profile = profile(name);
        profile.start_stop.interpass_time = 7.0;
        let plan = common::planned(part, &profile);
        let data = data(&page(&plan, &profile));
        let metrics = &plan.summary.metrics;
        let sum = |part: usize| -> f64 {
            data["times"].as_array().unwrap().iter().map(|parts| parts[part].as_f64().unwrap()).sum()
        };
        // Every figure is rounded to 0.1 s.
        let room = 0.05 * plan.layers.len() as f64 + 1e-6;
        assert!((sum(0) - metrics.arc_time_s).abs() <= room, "{name}: arc");
        assert!((sum(1) - metrics.dwell_time_s).abs() <= room, "{name}: waits");
        assert!((sum(0) + sum(1) + sum(2) - metrics.total_time_s).abs() <= 3.0 * room, "{name}: in all");
        assert!(metrics.dwell_time_s > 0.0, "{name}: the profile waits between layers");
    }
}

#[test]
fn colours_span_what_the_beads_have() {
    let (mut plan, profile) = planned("cross");
    let pass = &mut plan.layers[0].passes[0];
    let count = pass.points.len();
    pass.width = Along::Each((0..count).map(|i| 5.0 + i as f64 / count as f64).collect());
    let data = data(&page(&plan, &profile));
    let pieces = || plan.layers.iter().flat_map(|layer| &layer.passes).flat_map(|pass| pass.segments());
    let ends = |value: fn(&Segment) -> f64| {
        let values = || pieces().map(|piece| value(&piece));
        [values().fold(f64::MAX, f64::min), values().fold(f64::MIN, f64::max)]
    };
    for (key, ends) in [("width", ends(|piece| piece.width)), ("speed", ends(|piece| piece.pace))] {
        for (shown, true_value) in data["ranges"][key].as_array().unwrap().iter().zip(ends) {
            assert!((shown.as_f64().unwrap() - true_value).abs() <= 0.0005 + 1e-9, "{key}");
        }
    }
}

#[test]
fn a_warning_leads_to_its_place_and_words_are_explained() {
    let (mut plan, profile) = planned("cross");
    plan.summary.warnings = Default::default();
    for (layer, size) in [(0, 3.0), (2, 9.0), (1, 5.0)] {
        let place = DVec2::new(1.25, -4.5 - size);
        plan.summary.warnings.add(Warning { kind: WarningKind::ThinFeature, layer, place, size }, 2.0);
    }
    let html = page(&plan, &profile);
    let button = "<button data-layer=\"2\" data-x=\"1.25\" data-y=\"-13.50\">Show on layer 3</button>";
    assert!(html.contains(button), "the largest one has a button");
    for word in ["void", "low", "overfill", "outside", "closeness"] {
        assert!(html.contains(&format!("data-word=\"{word}\"")), "{word}");
    }
    assert_eq!(html.matches(" id=\"").count(), {
        let ids = html.split(" id=\"").skip(1).map(|rest| rest.split('"').next().unwrap());
        ids.collect::<std::collections::BTreeSet<_>>().len()
    });
}

#[test]
fn every_finding_is_listed_the_serious_first_with_a_link_to_its_place() {
    let (plan, profile) = planned("cross");
    let found = |kind, severity, pass: usize| {
        let place = Some(DVec3::new(pass as f64, 2.0, 3.0));
        let text = format!("{kind} of pass {pass}.");
        Finding { layer: Some(1), pass: Some(pass), place, ..Finding::new(kind, severity, text) }
    };
    let mut found: Vec<Finding> = (0..30).map(|pass| found("bead-width", Severity::Doubt, pass)).collect();
    let void = Finding::new("void", Severity::Doubt, "void somewhere.".to_owned());
    found.push(Finding { layer: Some(4), ..void });
    found.push(Finding::new("points", Severity::Serious, "serious one.".to_owned()));
    let mut report = Report::new(&plan.header, &profile);
    plan.layers.iter().for_each(|layer| report.layer(layer, None));
    let all = check::all_findings(&plan.summary, &[], &found);
    let html = report.finish(&plan.summary, &RepairReport::default(), &[], &all);
    for pass in 0..30 {
        let link = format!(
            "bead-width of pass {pass}.<button data-layer=\"1\" data-x=\"{pass}.00\" data-y=\"2.00\" data-pass=\"{pass}\">Show on layer 2, pass {}</button>",
            pass + 1
        );
        assert!(html.contains(&link), "{link}");
    }
    assert!(
        html.contains("<button data-layer=\"4\">Show on layer 5</button>"),
        "a finding without a place has its layer"
    );
    assert!(html.contains("<summary>And 29 more</summary>"));
    let list = html.split_once("<ul class=\"warnings\">").unwrap().1;
    assert!(list.trim_start().starts_with("<li class=\"serious\">"), "the serious one is not first");
    assert!(html.contains(">1 serious finding</a>"));
}

/// The cell beside a word.
fn cell<'a>(html: &'a str, name: &str) -> &'a str {
    html.split_once(&format!("<th scope=\"row\">{name}</th><td>")).unwrap().1.split_once('<').unwrap().0
}

#[test]
fn the_page_speaks_only_of_what_is_laid() {
    for strategy in ["raster", "zigzag", "contour", "compound", "hybrid", "loop", "hilbert"] {
        let mut profile = profile("cmt-al2319-kuka");
        profile.fill.strategy = strategy.parse().unwrap();
        for part in ["cross", "propeller"] {
            let plan = common::planned(part, &profile);
            let html = page(&plan, &profile);
            let key = html.split_once("id=\"key-kind\">").unwrap().1.split_once("</div>").unwrap().0;
            for kind in [PassKind::Contour, PassKind::Infill, PassKind::Skeleton, PassKind::Wall] {
                let laid = plan.layers.iter().flat_map(|layer| &layer.passes).any(|pass| pass.kind == kind);
                assert_eq!(
                    key.contains(&format!("</i>{}<", kind.name())),
                    laid,
                    "{part}, {strategy}: {kind:?} in {key}"
                );
            }
            let shown = cell(&html, "Strategy");
            assert!(shown.starts_with(&format!("{strategy}: ")), "{shown}");
            assert_eq!(
                shown.contains("scan lines at"),
                ["raster", "zigzag", "compound"].contains(&strategy),
                "{shown}"
            );
            assert_eq!(shown.contains("perimeter"), ["compound", "hilbert"].contains(&strategy), "{shown}");
        }
    }
}

#[test]
fn the_page_loads_nothing_and_is_complete() {
    let (plan, profile) = planned("cross");
    // The name of the language of pictures is no address to load from.
    let html = page(&plan, &profile).replace("http://www.w3.org/2000/svg", "");
    for needle in ["http:", "https:", "src=", "@import", "url(", "fetch(", "<link", "{{"] {
        assert!(!html.contains(needle), "{needle}");
    }
    for needle in ["ER2319", "6 m/min", "7.54 mm wide", "12 mm", "a&amp;b.src"] {
        assert!(html.contains(needle), "{needle}");
    }
    assert!(html.contains("Heat input"), "the profile has current and voltage");
}

#[test]
fn names_do_not_become_markup() {
    let (mut plan, mut profile) = planned("cross");
    plan.header.part = "<b>&\"'</script>{{js}}".to_owned();
    profile.wire.material = "<i>wire".to_owned();
    let html = page(&plan, &profile);
    assert!(html.contains("<h1>&lt;b&gt;&amp;&quot;&#39;&lt;/script&gt;{{js}}</h1>"));
    assert!(!html.contains("<b>&\"") && !html.contains("<i>wire"));
    assert_eq!(html.matches("</script>").count(), 2);
}

#[test]
fn nothing_lost_is_said_as_well() {
    let (mut plan, profile) = planned("cross");
    plan.summary.notes.clear();
    plan.summary.warnings = Default::default();
    assert!(page(&plan, &profile).contains("<p class=\"good\">Nothing was lost"));
    plan.summary.notes.push("Too <fast>.".to_owned());
    let html = page(&plan, &profile);
    assert!(html.contains("1 remark<") && html.contains("Too &lt;fast&gt;."));
}

/// Every opened element is closed in turn, and no attribute or text breaks out.
fn check_well_formed(xml: &str) {
    let mut open = Vec::new();
    for tag in xml.split('<').skip(1) {
        let (tag, text) = tag.split_once('>').unwrap();
        assert!(!text.contains('>') && tag.matches('"').count() % 2 == 0, "{tag}");
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') {
            open.push(tag.split(' ').next().unwrap());
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

#[test]
fn pictures_are_well_formed() {
    let (plan, _) = planned("propeller");
    let layer = &plan.layers[5];
    let picture = svg::layer(layer, "<b>&\"\u{1}");
    check_well_formed(&picture);
    assert!(picture.contains("<title>&lt;b&gt;&amp;&quot;\u{fffd}</title>"));
    // A pass of one width is one line, one of several widths a group.
    let wide = picture.matches("stroke-opacity").count() + picture.matches("<g opacity").count();
    assert_eq!(wide, layer.passes.len());
    assert!(!picture.contains("NaN"));
    check_well_formed(&svg::layer(&Layer::default(), ""));
    check_well_formed(&svg::layer(&square(10_000.0), "large"));
}

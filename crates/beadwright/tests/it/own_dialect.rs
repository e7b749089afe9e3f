//! Dialects of one's own: what they are refused for, and that they never write more or less than they should.
//! `beadwright-cli/tests/it/own_dialect.rs` runs the example.

use crate::common;

use beadwright::dialect::own::Own;
use beadwright::dialect::{self, DialectError};
use beadwright::layer::{Extent, Layer};
use beadwright::plan::Plan;
use beadwright::process::Follow;
use beadwright::profile::Profile;
use common::{planned, profile};
use std::collections::BTreeMap;
use std::path::Path;

type Files = BTreeMap<String, String>;

/// The example of a gantry.
fn gantry() -> Files {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/dialects/gantry");
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries
        .map(|p| (p.file_name().unwrap().to_str().unwrap().to_owned(), std::fs::read_to_string(&p).unwrap()))
        .collect()
}

/// The gantry with one text replaced in one file.
fn with(file: &str, old: &str, new: &str) -> Files {
    let mut files = gantry();
    let text = files.get_mut(file).unwrap();
    assert!(text.contains(old), "{old:?} does not stand in {file}");
    *text = text.replacen(old, new, 1);
    files
}

fn welder() -> Profile {
    let mut profile = profile("cmt-al2319-kuka");
    (profile.program.chord_tolerance, profile.program.arcs) = (0.05, true);
    (profile.start_stop.crater_fill_time, profile.start_stop.crater_power) = (0.5, 0.6);
    profile.start_stop.interpass_time = 30.0;
    profile
}

fn write(files: Files, layers: &[Layer], profile: &Profile) -> Result<Files, DialectError> {
    let job = profile.job("cross");
    dialect::write_with(Own::new("./gantry", files)?.writer(&job)?, &Extent::of(layers), layers, &job)
}

fn refused(files: Files, profile: &Profile, expect: &[&str]) {
    let said =
        match Own::new("./gantry", files).map_err(DialectError::from).and_then(|own| own.writer(&profile.job("cross")))
        {
            Ok(_) => panic!("taken, but expected was {expect:?}"),
            Err(error) => error.to_string(),
        };
    println!("{said}");
    assert!(expect.iter().all(|part| said.contains(part)), "{said:?} lacks a part of {expect:?}");
}

fn cross() -> Plan {
    planned("cross", &welder())
}

#[test]
fn broken_templates_are_refused_with_file_line_and_remedy() {
    let p = welder();
    let without = |file: &str| gantry().into_iter().filter(|(name, _)| name != file).collect::<Files>();
    refused(without("layer.txt"), &p, &["./gantry, layer.txt: ", "missing"]);
    refused(without("dialect.toml"), &p, &["./gantry, dialect.toml: ", "missing"]);
    refused(without("words.txt"), &p, &["words.txt", "only files of this folder"]);
    refused(
        with("dialect.toml", "line_ends = \"crlf\"", "line_ends = \"cr\""),
        &p,
        &["dialect.toml, line 4: ", "crlf"],
    );
    refused(with("dialect.toml", "block_step", "block_stride"), &p, &["dialect.toml, line 5: ", "block_step"]);
    refused(with("dialect.toml", "block_step = 10", "block_step = 0"), &p, &["block_step must be 1 or more"]);
    refused(with("layer.txt", "{% endfor %}", ""), &p, &["layer.txt, line ", "cannot be read"]);
    // A name in a branch that no rehearsal reaches.
    let hidden = with("layer.txt", "! LAYER", "{% if layer == 99 %}{{ speed }}{% endif %}\n! LAYER");
    refused(hidden, &p, &["layer.txt, line 2: ", "there is no \"speed\" here; there are", "travel_speed"]);
    refused(
        with("layer.txt", "step.seconds", "step.second"),
        &p,
        &["layer.txt, line ", "a step \"crater\" has no \"second\"; it has kind, seconds"],
    );
    refused(with("layer.txt", "step.circle.x", "step.circle.centre"), &p, &["layer.txt, line ", "has no \"centre\""]);
    refused(with("layer.txt", "step.speed | fixed(2)", "step.speed"), &p, &["layer.txt, line 5: ", "fixed(3)"]);
    refused(with("layer.txt", "fixed(4)", "rounded(4)"), &p, &["layer.txt, line ", "rounded"]);
    refused(with("words.txt", "at.z", "at.u"), &p, &["words.txt, line 3: ", "has no \"u\""]);
    refused(with("begin.txt", "UNITS", "UNIT\u{e9}S"), &p, &["begin.txt", "ASCII"]);
}

/// What a job needs and a template leaves out would be lost without a word.
#[test]
fn every_loss_is_found() {
    let centre =
        "CX={{ step.circle.x | fixed(4) }} CY={{ step.circle.y | fixed(4) }} A={{ step.circle.sweep | fixed(4) }}";
    let cases = [
        ("words.txt", " Z={{ at.z | mm }}", "", "the z of a travel"),
        ("layer.txt", "LINE {{ place(step) }}", "LINE X={{ step.x | mm }} Y={{ step.y | mm }}", "the z of a weld"),
        (
            "layer.txt",
            "LINE {{ place(step) }} V={{ step.speed | fixed(3) }}",
            "LINE {{ place(step) }}",
            "the speed of a weld",
        ),
        ("layer.txt", centre, "R={{ step.circle.radius | fixed(4) }}", "the side of a circle"),
        ("layer.txt", "weld\" and step.circle", "weld\" and false", "step.circle"),
        (
            "layer.txt",
            "{{ number() }} PAUSE {{ step.seconds | fixed(2) }}\n{% elif step.kind == \"arc-off\"",
            "{% elif step.kind == \"arc-off\"",
            "the time of a crater fill",
        ),
        ("layer.txt", "{% if step.ratio %}", "{% if false %}", "the wire feed in a crater"),
        ("layer.txt", "\"wire-feed\"", "\"wire\"", "the wire feed"),
        ("layer.txt", "\"dwell\"", "\"wait\"", "the wait between layers"),
    ];
    for (file, old, new, lost) in cases {
        refused(with(file, old, new), &welder(), &["./gantry, ", "would lose it", lost]);
    }
    // A job that does not need it may be written so.
    let mut plain = welder();
    (plain.start_stop, plain.program) = (Default::default(), Default::default());
    for (file, old, new, lost) in cases.iter().skip(3).filter(|case| case.0 == "layer.txt") {
        assert!(Own::new("g", with(file, old, new)).unwrap().writer(&plain.job("cross")).is_ok(), "{lost}");
    }
    plain.process.follow = Follow::WireFeed;
    refused(with("layer.txt", "\"wire-feed\"", "\"wire\""), &plain, &["the wire feed"]);
    plain.start_stop.wire_retract = 5.0;
    refused(gantry(), &plain, &["start_stop.wire_retract"]);
    plain.program.table_angle = Some(30.0);
    refused(gantry(), &plain, &["program.table_angle"]);
}

#[test]
fn names_of_files_stay_in_the_folder_of_the_plan() {
    let named = |name: &str| with("dialect.toml", "{{ name }}.GTY", name);
    for name in [
        "../{{ name }}.GTY",
        "/tmp/x",
        "a/b",
        "a\\\\b",
        "",
        ".hidden",
        "c:x",
        "plan.json",
        "REPORT.HTML",
        "x\\n",
        "{{ part * 99 }}",
    ] {
        refused(named(name), &welder(), &["dialect.toml", "cannot be written"]);
    }
    refused(named("{{ layer }}.GTY"), &welder(), &["dialect.toml, file", "there is no \"layer\""]);
    let alike = with("dialect.toml", "{{ name }}_{{ layer | pad(4) }}", "{{ name }}");
    refused(alike, &welder(), &["dialect.toml, layer_file", "Put {{ layer }} into the name"]);
    // Names that turn alike later on only are found then, and nothing is kept.
    let plan = cross();
    let seven = with("dialect.toml", "{{ layer | pad(4) }}", "{{ layer % 7 }}");
    let error = write(seven, &plan.layers, &welder()).unwrap_err().to_string();
    assert!(error.contains("layer 8 would be written into CROSS_1.GTY"), "{error}");
}

/// A template that does not end, or that would fill the memory, is stopped.
#[test]
fn endless_templates_are_stopped() {
    let began = std::time::Instant::now();
    for evil in [
        "{% for a in range(99999) %}{% for b in range(99999) %}{% endfor %}{% endfor %}",
        "{{ \"x\" * 999999999 }}",
        "{% for a in range(9999) %}{{ \"x\" * 99999 }}{% endfor %}",
        "{% macro m() %}{{ m() }}{% endmacro %}{{ m() }}",
        "{% include \"end.txt\" %}",
    ] {
        refused(
            with("end.txt", "{{ number() }} STOP", &format!("{evil}{{{{ number() }}}} STOP")),
            &welder(),
            &["./gantry, end.txt"],
        );
    }
    assert!(began.elapsed().as_secs() < 60, "{:?}", began.elapsed());
}

#[test]
fn one_file_or_many_with_the_line_ends_that_are_asked_for() {
    let plan = cross();
    let many = write(gantry(), &plan.layers, &welder()).unwrap();
    assert_eq!(many.len(), 1 + plan.layers.len());
    assert!(
        many["CROSS.GTY"].starts_with("! cross, cmt-al2319-kuka: 10 layers of 2.000 mm\r\n"),
        "{}",
        many["CROSS.GTY"]
    );
    let mut one = with("dialect.toml", "layer_file = \"{{ name }}_{{ layer | pad(4) }}.GTY\"\n", "");
    let settings = one.get_mut("dialect.toml").unwrap();
    *settings = settings.replace("\"crlf\"", "\"lf\"").replace("block_most = 99990", "block_most = 500");
    // Templates saved by Windows are the same templates.
    one.values_mut().for_each(|text| *text = text.replace('\n', "\r\n"));
    let one = write(one, &plan.layers, &welder()).unwrap();
    let text = &one["CROSS.GTY"];
    assert!(one.len() == 1 && !text.contains('\r') && !text.contains("CALL"));
    let numbers: Vec<u32> = text.lines().filter_map(|l| l.strip_prefix('B')?.get(..5)?.parse().ok()).collect();
    assert!(numbers.len() > 1000 && numbers.windows(2).all(|n| n[1] == if n[0] == 500 { 10 } else { n[0] + 10 }));
    let moves = |text: &str| {
        text.lines().filter(|l| l.contains(" X=")).map(|l| l[7..].trim_end().to_owned()).collect::<Vec<_>>()
    };
    let apart: Vec<String> = many.iter().filter(|(name, _)| name.len() > 9).flat_map(|(_, text)| moves(text)).collect();
    assert_eq!(moves(text), apart);
}

/// A layer's text depends on that layer alone, so thousands of layers can be written one after another.
#[test]
fn layers_are_written_as_they_come() {
    let (plan, profile) = (cross(), welder());
    let own = Own::new("g", gantry()).unwrap();
    let job = profile.job("cross");
    let (mut writer, mut programmer) = (own.writer(&job).unwrap(), job.programmer(false));
    writer.begin(&plan.header.extent);
    for layer in &plan.layers {
        let chunks = writer.layer(&programmer.layer(layer));
        assert_eq!(chunks.len(), 1);
        assert_eq!(chunks[0].file, format!("CROSS_{:04}.GTY", layer.index + 1));
        assert!(chunks[0].text.starts_with(&format!("! LAYER {} OF 10, Z {:.3}\r\n", layer.index + 1, layer.z)));
    }
    assert!(writer.failure().is_none());
}

#[test]
fn a_dry_run_lights_no_arc() {
    let (plan, profile) = (cross(), welder().dry_run());
    let files = write(gantry(), &plan.layers, &profile).unwrap();
    let text: String = files.values().map(String::as_str).collect();
    assert!(text.contains("DRY RUN, NO ARC") && !text.contains("ARC ON") && !text.contains("PAUSE"), "{text}");
    assert!(files.contains_key("DRY_CROSS.GTY"), "{:?}", files.keys());
}

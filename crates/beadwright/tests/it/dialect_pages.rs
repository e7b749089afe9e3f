//! The pages of docs/dialects: the program on each is what the library writes, so that no page goes stale.
//! `BEADWRIGHT_GOLDEN=write cargo test -p beadwright --test it dialect_pages::` writes them anew.

use crate::common;

use beadwright::dialect::own::Own;
use beadwright::dialect::{self, DialectError};
use beadwright::layer::{Extent, Layer};
use beadwright::pass::{Along, Pass, PassKind};
use beadwright::profile::Profile;
use common::profile;
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;
use std::path::PathBuf;

type Files = BTreeMap<String, String>;

/// Pages, each with the programs it shows: a heading, the profile and what is set in it.
type Page = (&'static str, &'static [(&'static str, &'static str)]);

const PAGES: [Page; 8] = [
    ("krl", &[("With outputs", "cmt-al2319-kuka"), ("With ArcTech Basic", "cmt-al2319-kuka arctech")]),
    ("rapid", &[("With RobotWare Arc", "cmt-steel-abb"), ("With outputs", "cmt-steel-abb plain")]),
    ("fanuc", &[("The program", "cmt-steel-robots")]),
    ("inform", &[("The program", "cmt-steel-robots")]),
    ("urscript", &[("The program", "cmt-steel-robots")]),
    (
        "gcode",
        &[
            ("LinuxCNC", "plasma-304-cnc"),
            ("Fanuc", "plasma-304-fanuc"),
            ("Siemens", "plasma-304-siemens"),
            ("Beckhoff TwinCAT NC I", "plasma-304-twincat"),
        ],
    ),
    ("marlin", &[("The program", "fdm-abs-0.4")]),
    ("your-own", &[("The example's program", "cmt-al2319-kuka")]),
];

fn docs() -> PathBuf {
    common::docs().join("dialects")
}

/// A line that turns into a quarter of a circle of 8 mm, in as many points.
fn bend(count: usize, z: f64) -> Pass {
    let turn = (0..=count).map(|i| FRAC_PI_2 * i as f64 / count as f64 - FRAC_PI_2);
    let bend = turn.map(|angle| DVec2::new(30.0, 8.0) + 8.0 * DVec2::from_angle(angle));
    let points: Vec<DVec3> = [DVec2::ZERO].into_iter().chain(bend).map(|p| p.extend(z)).collect();
    Pass { kind: PassKind::Contour, closed: false, points, width: Along::Same(4.5), pace: Along::Same(8.0), wait: 0.0 }
}

/// One layer with one pass.
fn part(count: usize) -> Vec<Layer> {
    let (islands, warnings) = (Vec::new(), Vec::new());
    let passes = vec![bend(count, 2.0)];
    vec![Layer { z: 2.0, height: 2.0, islands, passes, warnings, ..Layer::default() }]
}

fn set(words: &str) -> Profile {
    let (name, variant) = words.split_once(' ').unwrap_or((words, ""));
    let mut profile = profile(name);
    match variant {
        "arctech" => profile.dialects.krl.as_mut().unwrap().arc = dialect::krl::KrlArc::Arctech,
        "plain" => profile.dialects.rapid.as_mut().unwrap().arc = dialect::rapid::RapidArc::Plain,
        _ => {}
    }
    profile
}

fn write(page: &str, layers: &[Layer], profile: &Profile) -> Result<Files, DialectError> {
    let job = profile.job("demo");
    if page != "your-own" {
        return dialect::write(page, layers, &job);
    }
    let folder = docs().join("../../examples/dialects/gantry");
    let texts = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let named =
        texts.map(|p| (p.file_name().unwrap().to_str().unwrap().to_owned(), std::fs::read_to_string(&p).unwrap()));
    dialect::write_with(Own::new("gantry", named.collect())?.writer(&job)?, &Extent::of(layers), layers, &job)
}

/// Bytes that one more straight move of a pass takes.
fn bytes_a_move(page: &str, profile: &Profile) -> f64 {
    let mut profile = profile.clone();
    (profile.program.chord_tolerance, profile.program.arcs) = (0.0, false);
    let size = |count: usize| write(page, &part(count), &profile).unwrap().values().map(String::len).sum::<usize>();
    (size(110) - size(10)) as f64 / 100.0
}

/// The part of a page between its marks.
fn programs(page: &str, shown: &[(&str, &str)]) -> String {
    let mut out = String::new();
    for (heading, words) in shown {
        let mut profile = set(words);
        (profile.program.chord_tolerance, profile.program.arcs) = (0.05, true);
        out.push_str(&format!("### {heading}\n\n"));
        for (file, text) in write(page, &part(40), &profile).unwrap() {
            out.push_str(&format!("`{file}`\n\n```text\n{}```\n\n", text.replace("\r\n", "\n")));
        }
        let size = bytes_a_move(page, &profile);
        out.push_str(&format!(
            "A straight weld move takes {size:.0} bytes, 10,000 of them {:.2} MB.\n\n",
            size / 100.0
        ));
    }
    out
}

#[test]
fn the_pages_show_what_is_written() {
    for (page, shown) in PAGES {
        common::page_shows(&format!("dialects/{page}.md"), "programs", &programs(page, shown));
    }
}

/// Every dialect has a page, every page is in the list, and the list is linked.
#[test]
fn every_dialect_has_a_page() {
    let index = std::fs::read_to_string(docs().join("../dialects.md")).unwrap();
    let pages: Vec<&str> = PAGES.iter().map(|(page, _)| *page).collect();
    for name in dialect::names() {
        assert!(pages.contains(&name), "docs/dialects/{name}.md is missing");
    }
    for page in &pages {
        assert!(index.contains(&format!("(dialects/{page}.md)")), "docs/dialects.md does not link {page}.md");
    }
    for place in ["../../README.md", "../architecture.md"] {
        assert!(std::fs::read_to_string(docs().join(place)).unwrap().contains("dialects.md"), "{place}");
    }
    let files = std::fs::read_dir(docs()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    let mut found: Vec<String> = files.map(|name| name.trim_end_matches(".md").to_owned()).collect();
    found.sort();
    let mut expected: Vec<String> = pages.iter().map(|page| (*page).to_owned()).collect();
    expected.sort();
    assert_eq!(found, expected);
}

/// The page of dialects of one's own names every key of every step, and every value of the job.
#[test]
fn the_page_of_ones_own_names_all_data() {
    let page = std::fs::read_to_string(docs().join("your-own.md")).unwrap();
    let mentions =
        |name: &str| assert!(page.contains(&format!("`{name}`")), "docs/dialects/your-own.md does not mention {name}");
    let profile = profile("cmt-al2319-kuka");
    let refuse = |layer: &str| {
        let texts = [("dialect.toml", "file = \"x.txt\""), ("layer.txt", layer)];
        let texts = texts.map(|(name, text)| (name.to_owned(), text.to_owned()));
        match Own::new("own", BTreeMap::from(texts)).unwrap().writer(&profile.job("demo")) {
            Ok(_) => panic!("{layer} was taken"),
            Err(error) => error.to_string(),
        }
    };
    let names = |said: &str, after: &str| {
        let list = said.split_once(after).unwrap_or_else(|| panic!("{said}")).1.trim_end_matches('.');
        list.split(", ").map(str::to_owned).collect::<Vec<_>>()
    };
    let job = names(&refuse("{{ nothing }}"), "there are ");
    assert!(job.len() > 20, "{job:?}");
    job.iter().for_each(|name| mentions(name));
    for kind in ["travel", "arc-on", "weld", "wire-feed", "crater", "arc-off", "dwell"] {
        mentions(kind);
        let said = refuse(&format!(
            "{{% for step in steps %}}{{% if step.kind == \"{kind}\" %}}{{{{ step.none }}}}{{% endif %}}{{% endfor %}}"
        ));
        names(&said, "it has ").iter().for_each(|name| mentions(name));
    }
    let circle = "{% for step in steps %}{% if step.kind == \"weld\" and step.circle %}{{ step.circle.none }}{% endif %}{% endfor %}";
    names(&refuse(circle), "it has ").iter().for_each(|name| mentions(name));
}

//! What the fuzz targets call: each takes any bytes, and may neither panic nor return nonsense.
//!
//! `fuzz/run TARGET SECONDS` runs one, `fuzz/run` all of them.

#[path = "../crates/beadwright/tests/it/families/mod.rs"]
mod families;

use beadwright::dialect::reading::{self, Options};
use beadwright::export::toolpath;
use beadwright::fill::StrategyName;
use beadwright::model::{MAX_REACH_MM, Model, Placement, import_damaged, outline};
use beadwright::planar::{DVec2, FillRule, Join, Region, Ring};
use beadwright::profile::{BUILT_IN, Profile, edit};
use beadwright::task::Task;
use beadwright::{dialect, plan_file, text};
use std::sync::LazyLock;

/// An STL file: if it is read, its mesh is finite and its corners exist.
pub fn stl(data: &[u8]) {
    let Ok(import) = import_damaged(data, &Task::new()) else { return };
    let mesh = &import.mesh;
    assert!(mesh.vertices.iter().all(|v| v.is_finite()));
    assert!(mesh.triangles.as_flattened().iter().all(|&v| (v as usize) < mesh.vertices.len()));
    assert_eq!(mesh.triangles.len(), mesh.neighbours.len());
}

/// A drawing, grown into a solid: if it is, the solid is finite and within reach.
pub fn drawing(data: &[u8]) {
    let Ok(outlines) = outline::read(data) else { return };
    let Ok(import) = outlines.extruded(1.0, 5.0) else { return };
    let (low, high) = import.mesh.bounds();
    assert!(low.abs().max(high.abs()).max_element() <= 2.0 * MAX_REACH_MM, "{low} {high}");
}

/// A 3MF file of toolpaths: if it is read, its passes can be welded.
pub fn toolpath(data: &[u8]) {
    let Ok(plan) = toolpath::read(data) else { return };
    let passes = plan.layers.iter().flat_map(|layer| &layer.passes);
    passes.for_each(|pass| assert!(pass.points.len() > 1 && pass.segments().all(|s| s.width > 0.0 && s.pace > 0.0)));
}

/// An IGES file, placed as a wall: if it is, it lies within reach. The cards are put in order first, since hardly any
/// random line is one.
pub fn iges(data: &[u8]) {
    let cards = if data.first() == Some(&b'!') { as_cards(&data[1..]) } else { data.to_vec() };
    let Ok(model) = Model::read(&cards, &Task::new()) else { return };
    let Ok(part) = model.place(&Placement::default(), Some(10.0), 5.0) else { return };
    let (low, high) = part.bounds();
    assert!(low.abs().max(high.abs()).max_element() <= 2.0 * MAX_REACH_MM, "{low} {high}");
}

/// Lines `D…` and `P…` as cards of these sections, between a start and an end that are right.
fn as_cards(data: &[u8]) -> Vec<u8> {
    let mut text = String::new();
    let mut card = |content: &str, section: char, number: usize| {
        let content: String = content.chars().filter(|c| c.is_ascii_graphic() || *c == ' ').take(72).collect();
        text.push_str(&format!("{content:<72}{section}{number:>7}\n"));
    };
    card("fuzz", 'S', 1);
    card("1H,,1H;,4Htest,5Ht.igs,4Htest,4Htest,32,38,6,308,15,4Htest,1.0,2,2HMM,1,", 'G', 1);
    card("0.1,15H20000101.000000,1.0D-6,80.0,,,11,0,15H20000101.000000;", 'G', 2);
    let lines = String::from_utf8_lossy(data).into_owned();
    let of = |letter: char| lines.lines().filter_map(|l| l.strip_prefix(letter)).map(str::to_owned).collect::<Vec<_>>();
    let (directory, parameters) = (of('D'), of('P'));
    directory.iter().enumerate().for_each(|(i, line)| card(line, 'D', i + 1));
    parameters.iter().enumerate().for_each(|(i, line)| card(&format!("{line:<64}{:>8}", 2 * i + 1), 'P', i + 1));
    card(&format!("S      1G      2D{:>7}P{:>7}", directory.len(), parameters.len()), 'T', 1);
    text.into_bytes()
}

/// A profile: if it is read, all that is made from it can be made, and it survives JSON.
pub fn profile(data: &[u8]) {
    let Ok(text) = text::of(data) else { return };
    // Mutations of a whole profile seldom stay one. After `@`, lines are keys to set in a built-in one.
    let text = match text.strip_prefix('@') {
        Some(keys) => keys.lines().take(8).fold(BUILT_IN[0].1.to_owned(), |text, line| {
            let (key, value) = line.split_once('=').unwrap_or((line, "0"));
            edit::with_value(&text, key, value).unwrap_or(text)
        }),
        None => text,
    };
    let Ok(profile) = Profile::parse(&text) else { return };
    assert!(profile.stepover().is_finite() && profile.stepover() > 0.0, "{}", profile.stepover());
    _ = (profile.wall_bead(), profile.notes(), profile.limits());
    _ = profile.fill_settings(3);
    assert_eq!(Profile::from_json(&serde_json::json!(profile)), Ok(profile));
}

/// A plan.json: if it is read, it is finite.
pub fn plan_json(data: &[u8]) {
    let Ok(text) = text::of(data) else { return };
    let Ok(plan) = plan_file::read(&text) else { return };
    let mut points = plan.layers.iter().flat_map(|l| &l.passes).flat_map(|p| &p.points);
    assert!(points.all(|p| p.is_finite()) && !plan.layers.is_empty());
}

/// A program in one language; `head` makes it one.
fn program(head: &str, data: &[u8]) {
    let Ok(text) = text::of(data) else { return };
    let text = format!("{head}{text}");
    // Every module that is called is there.
    let mut module = |name: &str| Some(format!("{head}{}", name.len()));
    let Ok(read) = reading::read(&text, &mut module, &Options::default()) else { return };
    assert!(read.moves.iter().all(|m| m.to.is_finite() && m.to.abs().max_element() <= MAX_REACH_MM));
    _ = (read.layers(), read.totals());
}

pub fn krl(data: &[u8]) {
    program("DEF A( )\n$VEL.CP=0.01\nLIN {X 0,Y 0,Z 0}\n$OUT[2]=TRUE\n", data);
}

pub fn gcode(data: &[u8]) {
    program("G21 G90\n", data);
}

pub fn rapid(data: &[u8]) {
    program("MODULE A\nPROC main()\n", data);
}

pub fn fanuc(data: &[u8]) {
    program("/PROG A\n/MN\n", data);
}

pub fn inform(data: &[u8]) {
    program("/JOB\n//NAME A\n", data);
}

pub fn urscript(data: &[u8]) {
    program("def a():\n", data);
}

/// Rings of small numbers, mm; a byte of 255 ends a ring.
fn rings(data: &[u8]) -> Vec<Ring> {
    let ring = |bytes: &[u8]| {
        let point = |pair: &[u8; 2]| DVec2::new(f64::from(pair[0]) * 0.5, f64::from(pair[1]) * 0.5);
        Ring::new(bytes.as_chunks::<2>().0.iter().map(point).collect())
    };
    data.split(|&b| b == 255).map(ring).filter(|r| r.points().len() > 2).take(12).collect()
}

/// Operations on polygons keep what geometry says of their areas.
pub fn polygons(data: &[u8]) {
    let (first, second) = data.split_at(data.len() / 2);
    let [a, b] = [first, second].map(|data| Region::from_rings(&rings(data), FillRule::EvenOdd));
    let (sum, both) = (a.union(&b).area(), a.area() + b.area());
    let common = both - sum;
    let slack = 1e-3 * (1.0 + a.perimeter() + b.perimeter());
    assert!(common >= -slack && common <= a.area().min(b.area()) + slack, "{common} of {} and {}", a.area(), b.area());
    assert!((a.difference(&b).area() - (a.area() - common)).abs() <= slack);
    let (less, more) = (a.offset(-1.0, Join::ROUND), a.offset(1.0, Join::ROUND));
    assert!(less.area() <= a.area() + slack && more.area() >= a.area() - slack);
    // Opening stays inside.
    assert!(less.offset(1.0, Join::ROUND).difference(&a).area() <= slack + 0.02 * a.perimeter());
}

/// The built-in profiles for welding.
static PROFILES: LazyLock<Vec<Profile>> =
    LazyLock::new(|| BUILT_IN.iter().take(4).filter_map(|(_, text)| Profile::parse(text).ok()).collect());

/// A part of two layers, planned and written: the first bytes choose the strategy and the profile, the next a random part of
/// one of the families or else its rings. Passes stay inside and do not cross.
pub fn plan(data: &[u8]) {
    let [choice, kind, rest @ ..] = data else { return };
    let islands = if *kind < 128 {
        let seed = rest.iter().take(4).fold(7, |seed: u64, byte| seed * 256 + u64::from(*byte));
        families::islands(usize::from(kind % 8), seed)
    } else {
        Region::from_rings(&rings(rest), FillRule::EvenOdd).into_polygons()
    };
    let mut profile = PROFILES[usize::from(choice / 16) % PROFILES.len()].clone();
    profile.fill.strategy = StrategyName::ALL[usize::from(choice % 16) % StrategyName::ALL.len()];
    let Some(mesh) = families::extruded(&islands, 2.0 * profile.layers.height) else { return };
    let Ok(plan) = beadwright::plan("part", &mesh, &profile, &Task::new()) else { return };
    for layer in &plan.layers {
        let fault = families::fault(layer);
        assert_eq!(fault, None, "{} by {}", islands.len(), profile.fill.strategy);
    }
    for post in &profile.posts {
        assert!(dialect::write(post, &plan.layers, &profile.job("part")).is_ok_and(|files| !files.is_empty()));
    }
}

//! Every dialect, five parts, and five ways of planning: what our reader finds in the programs is what the plan's totals
//! say, in length, starts and time, travels included. `BEADWRIGHT_LAYERS=1000 cargo test -p beadwright --test it matrix:: --
//! --nocapture` takes all layers and prints the table.

use crate::common;

use beadwright::dialect;
use beadwright::dialect::krl::KrlArc;
use beadwright::dialect::rapid::RapidArc;
use beadwright::dialect::reading::{ReadError, ReadTotals};
use beadwright::layer::Layer;
use beadwright::metrics::Metrics;
use beadwright::process::Follow;
use beadwright::profile::Profile;
use common::{planned, with_all_dialects};
use std::collections::BTreeMap;

const DIALECTS: [(&str, &str, &str); 8] = [
    ("krl", "krl", "PART.src"),
    ("krl-arctech", "krl", "PART.src"),
    ("rapid", "rapid", "part.mod"),
    ("rapid-plain", "rapid", "part.mod"),
    ("gcode", "gcode", "part.nc"),
    ("fanuc", "fanuc", "PART.ls"),
    ("inform", "inform", "PART.jbi"),
    ("urscript", "urscript", "part.script"),
];

const PARTS: [(&str, &str, &str); 5] = [
    ("propeller", "loop", "cmt-al2319-kuka"),
    ("propeller", "hybrid", "cmt-al2319-kuka"),
    ("tian", "wall", "cmt-steel-abb"),
    ("blade", "wall", "cmt-steel-abb"),
    ("pot", "wall", "cmt-steel-abb"),
];

/// Plain, with starts and stops, with arcs, without arc, and with a wire feed that follows.
const WAYS: [&str; 5] = ["plain", "start_stop", "arcs", "dry run", "wire feed"];

fn dressed(base: &str, dialect: &str, way: &str, strategy: &str) -> Option<Profile> {
    let mut profile = with_all_dialects(base);
    profile.fill.strategy = strategy.parse().unwrap();
    let sections = &mut profile.dialects;
    let lines = |line: &str| vec![line.to_owned()];
    sections.krl.as_mut()?.wire_feed = lines("$ANOUT[1] = {{wire_feed_ratio}}");
    sections.gcode.as_mut()?.wire_feed = lines("M67 E0 Q{{wire_feed_ratio}}");
    let rapid = sections.rapid.as_mut()?;
    (rapid.wire_feed, rapid.speed_step) = (lines("SetAO aoWire,{{wire_feed_ratio}};"), 0.02);
    sections.fanuc.as_mut()?.wire_feed = lines("AO[1]={{wire_feed_ratio}}");
    sections.inform.as_mut()?.wire_feed = lines("AOUT AO#(1) {{wire_feed_ratio}}");
    sections.urscript.as_mut()?.wire_feed = lines("set_standard_analog_out(0, {{wire_feed_ratio}})");
    // Each volume would be a program of its own.
    (sections.krl.as_mut()?.max_megabytes, sections.urscript.as_mut()?.max_megabytes) = (1000.0, 1000.0);
    match dialect {
        // The data sets of ArcTech have craters of their own, and one wire feed.
        "krl-arctech" if ["start_stop", "wire feed"].contains(&way) => return None,
        "krl-arctech" => {
            sections.krl.as_mut()?.arc = KrlArc::Arctech;
            profile.start_stop.crater_fill_time = 0.0;
        }
        "rapid-plain" => sections.rapid.as_mut()?.arc = RapidArc::Plain,
        _ => {}
    }
    match way {
        "start_stop" => {
            let ends = &mut profile.start_stop;
            (ends.end_overlap, ends.lead_in_length, ends.lead_in_power) = (6.0, 5.0, 1.2);
            (ends.lead_out_length, ends.lead_out_power, ends.crater_fill_time) = (4.0, 0.8, 0.4);
            (ends.interpass_time, ends.dwell_height) = (7.5, 15.0);
        }
        "arcs" => (profile.program.arcs, profile.program.chord_tolerance) = (true, 0.05),
        "wire feed" => profile.process.follow = Follow::WireFeed,
        _ => {}
    }
    let post = DIALECTS.iter().find(|row| row.0 == dialect)?.1;
    profile.posts = vec![post.to_owned()];
    Some(if way == "dry run" { profile.dry_run() } else { profile })
}

/// What our reader finds in a program; nothing in a dry run.
fn read_back(layers: &[Layer], profile: &Profile, post: &str, main: &str) -> Option<ReadTotals> {
    let files: BTreeMap<String, String> = dialect::write(post, layers, &profile.job("part")).unwrap();
    let dry = main.replace("PART", "DRY_PART").replace("part", "dry_part");
    let main = if profile.is_dry_run() { dry } else { main.to_owned() };
    let mut program = match common::read_back(&files, &main) {
        Ok(program) => program,
        // A dry run lays nothing, and so there is nothing to be judged.
        Err(ReadError::NoDeposition { .. }) if profile.is_dry_run() => return None,
        Err(error) => panic!("{error}"),
    };
    program.take_rapids_at(profile.travel.speed);
    Some(program.totals())
}

#[test]
fn every_program_agrees_with_its_plan() {
    let count = std::env::var("BEADWRIGHT_LAYERS").ok().and_then(|n| n.parse().ok()).unwrap_or(2);
    println!("part, strategy, way, dialect: starts, bead mm, travel mm, time s; off by %");
    for (part, strategy, base) in PARTS {
        for way in WAYS {
            let mut layers = planned(part, &dressed(base, "krl", way, strategy).unwrap()).layers;
            layers.truncate(count);
            for (dialect, post, main) in DIALECTS {
                let Some(profile) = dressed(base, dialect, way, strategy) else { continue };
                let case = format!("{part}, {strategy}, {way}, {dialect}");
                match read_back(&layers, &profile, post, main) {
                    Some(found) => agrees(&case, &layers, &profile, &found),
                    None => println!("{case}: nothing is laid"),
                }
            }
        }
    }
}

/// Time of gas for which the torch stands at each pass and which no line of the program states, s: it belongs to the weld
/// equipment.
fn in_the_equipment(case: &str, profile: &Profile) -> f64 {
    let own = case.ends_with(", fanuc") || case.ends_with(", inform");
    let gas = profile.process.gas_preflow + profile.process.gas_postflow;
    if own && !profile.is_dry_run() { gas } else { 0.0 }
}

fn agrees(case: &str, layers: &[Layer], profile: &Profile, found: &ReadTotals) {
    let mut wanted = Metrics::new(profile);
    layers.iter().for_each(|layer| wanted.add(layer));
    // The totals leave out the way down to the first pass, which programs have.
    let down = profile.travel.clearance;
    let (starts, bead) = (wanted.arc_starts, wanted.deposited_length_mm);
    let travel = wanted.travel_length_mm + down;
    let time = wanted.total_time_s + down / profile.travel.speed - in_the_equipment(case, profile) * starts as f64;
    let off = |found: f64, wanted: f64| 100.0 * (found / wanted - 1.0);
    let off = [off(found.deposited_length_mm, bead), off(found.travel_length_mm, travel), off(found.time_s, time)];
    println!("{case}: {starts}, {bead:.1}, {travel:.1}, {time:.1}; {off:+.3?}");
    assert_eq!(found.arc_starts, starts, "{case}");
    assert!(off.iter().all(|off| off.abs() < 0.2), "{case}: {off:+.3?} %");
}

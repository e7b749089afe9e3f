//! Rehearses a user-defined dialect before anything is written: with a small program that has every kind of step, and
//! by checking, for everything that the job needs, that the text changes with it.

use super::write::OwnWriter;
use super::{BEGIN, END, FILE, LAYER, LAYER_FILE, Own, OwnError, SETTINGS, data};
use crate::dialect::writing::{DialectError, Job, Writer};
use crate::program::{Attitude, Circle, Instruction, LayerProgram};
use bead_plan::layer::Extent;
use bead_plan::pass::PassKind;
use bead_plan::process::Follow;
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// Refuses templates that are broken, or that would lose part of the job.
pub(super) fn rehearse(own: &Own, job: &Job<'_>) -> Result<(), DialectError> {
    let refuse = |file: &str, reason: String| {
        Err(DialectError::Own(OwnError { folder: own.folder.clone(), file: file.to_owned(), line: None, reason }))
    };
    if job.program.external_axes() {
        let reason = "a dialect of your own writes no external axes (program.linear_axis, program.table_angle, \
                      program.table_side, program.positioner). Remove the key, and move the axis by hand.";
        return refuse(SETTINGS, reason.to_owned());
    }
    if job.program.tilts() {
        let reason =
            "a dialect of your own writes no orientation. Remove program.follow_wall and program.travel_angle.";
        return refuse(SETTINGS, reason.to_owned());
    }
    names(own, job)?;
    run(own, job, &[every_step(), every_step()])?;
    for Probe { what, write, programs: [one, other] } in probes(job) {
        if run(own, job, &[one])? == run(own, job, &[other])? {
            return refuse(
                LAYER,
                format!("it writes the same whatever {what} is, so the program would lose it. {write}"),
            );
        }
    }
    let writes_retract = || own.environment.templates().any(|(_, template)| template.source().contains("wire_retract"));
    if job.weld.ends.wire_retract > 0.0 && !job.dry_run && !writes_retract() {
        let reason = "start_stop.wire_retract would be lost. Write {{ wire_retract | fixed(1) }} (mm) or \
                      {{ wire_retract_time | fixed(2) }} (s) at step.kind == \"arc-off\".";
        return refuse(LAYER, reason.to_owned());
    }
    Ok(())
}

/// Runs the templates on layers; returns the text of all files.
fn run(own: &Own, job: &Job<'_>, layers: &[Vec<Instruction>]) -> Result<String, DialectError> {
    let mut writer = OwnWriter::new(own, job);
    let mut chunks = writer.begin(&Extent { layers: layers.len(), ..Extent::default() });
    for (index, instructions) in layers.iter().enumerate() {
        let (z, instructions) = (2.0 * (index + 1) as f64, instructions.clone());
        chunks.extend(writer.layer(&LayerProgram { index, z, instructions }));
    }
    chunks.extend(writer.end());
    match writer.failure() {
        Some(error) => Err(error),
        None => Ok(chunks.into_iter().map(|chunk| chunk.text).collect()),
    }
}

/// Refuses names that no template knows, even in places that the rehearsal does not reach.
fn names(own: &Own, job: &Job<'_>) -> Result<(), OwnError> {
    let writer = OwnWriter::new(own, job);
    let environment = writer.environment();
    for (file, template) in environment.templates() {
        let more: &[&str] = match file {
            BEGIN | FILE => &[],
            LAYER => &["layer", "z", "steps", "file"],
            END => &["layer_files"],
            LAYER_FILE => &["layer"],
            _ => &["layer", "z", "steps", "file", "layer_files"],
        };
        let is_known = |name: &str| more.contains(&name) || environment.globals().any(|(global, _)| global == name);
        let mut unknown: Vec<String> = template.undeclared_variables(false).into_iter().collect();
        unknown.retain(|name| !is_known(name));
        unknown.sort();
        if let Some(name) = unknown.into_iter().next() {
            let mut known = [&["layers", "block()"], more].concat();
            let of_job = data::job(job);
            known.extend(of_job.iter().map(|(name, _)| *name));
            let line = line_of(template.source(), &name).filter(|_| !file.starts_with(SETTINGS));
            let reason = format!("there is no \"{name}\" here; there are {}.", known.join(", "));
            return Err(OwnError { folder: own.folder.clone(), file: file.to_owned(), line, reason });
        }
    }
    Ok(())
}

/// The first line, from 1, that contains a word.
fn line_of(text: &str, word: &str) -> Option<usize> {
    let part = |c: char| c.is_alphanumeric() || c == '_';
    let has = |line: &str| line.split(|c| !part(c)).any(|found| found == word);
    text.lines().position(has).map(|line| line + 1)
}

const START: DVec3 = DVec3::new(10.0, 20.0, 2.0);

fn travel(to: DVec3) -> Instruction {
    Instruction::Travel { to }
}

fn weld(to: DVec3, circle: Option<Circle>, speed: f64) -> Instruction {
    Instruction::Weld { to, circle, speed, last: false, attitude: Attitude::default() }
}

/// A quarter of a circle from the start to (15, 25), to the left or to the right.
fn quarter(left: bool) -> Circle {
    let (centre, side) = if left { (DVec3::new(10.0, 25.0, 2.0), 1.0) } else { (DVec3::new(15.0, 20.0, 2.0), -1.0) };
    let out = DVec3::new(1.0, -1.0, 0.0).normalize() * 5.0 * side;
    Circle { via: centre + out, centre, radius: 5.0, sweep: FRAC_PI_2 * side }
}

const END_OF_QUARTER: DVec3 = DVec3::new(15.0, 25.0, 2.0);

/// A pass from [`START`] that contains the given instructions.
fn pass(inside: impl IntoIterator<Item = Instruction>) -> Vec<Instruction> {
    let head = [
        Instruction::Approach { to: START + 5.0 * DVec3::Z },
        travel(START),
        Instruction::ArcOn { pass: 1, kind: PassKind::Contour },
    ];
    let last = Instruction::Weld {
        to: DVec3::new(40.0, 20.0, 2.0),
        circle: None,
        speed: 7.0,
        last: true,
        attitude: Attitude::default(),
    };
    head.into_iter()
        .chain(inside)
        .chain([last, Instruction::ArcOff { pass: 1 }, Instruction::Retract { to: DVec3::new(40.0, 20.0, 7.0) }])
        .collect()
}

fn every_step() -> Vec<Instruction> {
    let crater = |ratio| Instruction::Crater { seconds: 0.5, ratio };
    let steps = [
        weld(END_OF_QUARTER, Some(quarter(true)), 8.0),
        Instruction::WireFeed { ratio: 0.8 },
        weld(START, None, 8.0),
        weld(END_OF_QUARTER, Some(quarter(false)), 6.0),
        crater(Some(0.6)),
        crater(None),
    ];
    let mut layer = pass(steps);
    layer.insert(0, Instruction::Dwell { seconds: 20.0 });
    layer.extend(pass([]));
    layer
}

/// Two programs that must not give the same text.
struct Probe {
    what: String,
    /// What to write, as a sentence.
    write: String,
    programs: [Vec<Instruction>; 2],
}

/// Everything that the job needs.
fn probes(job: &Job<'_>) -> Vec<Probe> {
    let (ends, burns) = (&job.weld.ends, !job.dry_run);
    let (arcs, crater) = (job.program.arcs, burns && ends.fills_craters());
    let weak = burns && ends.crater_is_weaker();
    let feeds = weak || burns && job.weld.process.follow == Follow::WireFeed;
    let waits = burns && (ends.interpass_time > 0.0 || ends.min_layer_time > 0.0);
    let fill = |seconds, ratio| pass([Instruction::Crater { seconds, ratio: Some(ratio) }]);
    let feed = |ratio| pass([Instruction::WireFeed { ratio }, weld(START + DVec3::X, None, 7.0)]);
    let wait = |seconds| [vec![Instruction::Dwell { seconds }], pass([])].concat();
    let turn = |circle| pass([weld(END_OF_QUARTER, circle, 7.0)]);
    let pace = |speed| pass([weld(END_OF_QUARTER, None, speed)]);
    let without = |dropped: fn(&Instruction) -> bool| {
        let mut steps = pass([]);
        steps.retain(|step| !dropped(step));
        steps
    };
    let rows = [
        (true, "the speed of a weld", "step.speed", [pace(7.0), pace(8.0)]),
        (
            burns,
            "an arc start",
            "step.kind == \"arc-on\"",
            [pass([]), without(|s| matches!(s, Instruction::ArcOn { .. }))],
        ),
        (
            burns,
            "an arc end",
            "step.kind == \"arc-off\"",
            [pass([]), without(|s| matches!(s, Instruction::ArcOff { .. }))],
        ),
        (
            arcs,
            "step.circle (program.arcs = true)",
            "step.circle, or plan with program.arcs = false",
            [turn(None), turn(Some(quarter(true)))],
        ),
        (arcs, "the side of a circle", "step.circle.sweep", [turn(Some(quarter(false))), turn(Some(quarter(true)))]),
        (
            crater,
            "the time of a crater fill",
            "step.seconds at step.kind == \"crater\"",
            [fill(1.0, 0.5), fill(2.0, 0.5)],
        ),
        (weak, "the wire feed in a crater", "step.ratio at step.kind == \"crater\"", [fill(1.0, 0.5), fill(1.0, 0.6)]),
        (feeds, "the wire feed", "step.ratio at step.kind == \"wire-feed\"", [feed(0.8), feed(0.9)]),
        (waits, "the wait between layers", "step.seconds at step.kind == \"dwell\"", [wait(5.0), wait(6.0)]),
    ];
    let needed = rows.into_iter().filter(|row| row.0).map(|(_, what, write, programs)| Probe {
        what: what.to_owned(),
        write: format!("Write {write}."),
        programs,
    });
    places(arcs).into_iter().chain(needed).collect()
}

/// Every coordinate of every kind of move must be written.
fn places(arcs: bool) -> Vec<Probe> {
    let mut probes = Vec::new();
    for (axis, by) in [("x", DVec3::X), ("y", DVec3::Y), ("z", DVec3::Z)] {
        let here = DVec3::new(20.0, 30.0, 4.0);
        let mut probe = |what: &str, programs| {
            let (what, write) = (format!("the {axis} of {what}"), format!("Write {{{{ step.{axis} | fixed(3) }}}}."));
            probes.push(Probe { what, write, programs });
        };
        let moved = |to: fn(DVec3) -> Instruction| [pass([to(here)]), pass([to(here + by)])];
        probe("a travel", moved(travel));
        probe("a weld", moved(|to| weld(to, None, 7.0)));
        if arcs && axis != "z" {
            let programs = [0.0, 1.0].map(|far| pass([weld(END_OF_QUARTER + far * by, Some(quarter(true)), 7.0)]));
            probe("the end of a circle", programs);
        }
    }
    probes
}

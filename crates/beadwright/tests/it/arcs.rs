//! Arcs and straight pieces fitted to planned paths: fewer moves along the same path.

use crate::common;

use beadwright::example;
use beadwright::model::{Mesh, import};
use beadwright::pass::{Along, Pass};
use beadwright::plan::Plan;
use beadwright::program::{Circle, Instruction, ProgramSettings, Programmer};
use beadwright::task::Task;
use common::{model, profile_by};
use glam::DVec3;

fn fitted() -> ProgramSettings {
    ProgramSettings { chord_tolerance: 0.05, arcs: true, ..ProgramSettings::default() }
}

fn planned(mesh: &Mesh, profile: &str, strategy: &str) -> Plan {
    common::planned_once("part", mesh, &profile_by(profile, strategy)).unwrap()
}

/// Instructions of every layer, as planned and fitted.
fn programs(plan: &Plan, settings: &ProgramSettings) -> Vec<Vec<Instruction>> {
    let mut programmer = Programmer::new(10.0).with_fit(settings);
    plan.layers.iter().map(|layer| programmer.layer(layer).instructions).collect()
}

fn welds(programs: &[Vec<Instruction>]) -> usize {
    programs.iter().flatten().filter(|i| matches!(i, Instruction::Weld { .. })).count()
}

/// Points along the passes, no farther apart than 0.2 mm, arcs along their circle.
fn traced(instructions: &[Instruction]) -> Vec<Vec<DVec3>> {
    let (mut passes, mut at) = (Vec::new(), DVec3::ZERO);
    for instruction in instructions {
        match *instruction {
            Instruction::Approach { to } | Instruction::Travel { to } | Instruction::Retract { to } => at = to,
            Instruction::ArcOn { .. } => passes.push(vec![at]),
            Instruction::Weld { to, circle, .. } => {
                let pass = passes.last_mut().unwrap();
                let length = circle.map_or(at.distance(to), |c| c.length());
                let steps = (length / 0.2).ceil() as usize;
                pass.extend((1..steps).map(|i| along(at, to, circle, i as f64 / steps as f64)));
                pass.push(to);
                at = to;
            }
            _ => {}
        }
    }
    passes
}

fn along(from: DVec3, to: DVec3, circle: Option<Circle>, part: f64) -> DVec3 {
    let Some(circle) = circle else { return from.lerp(to, part) };
    let start = (from - circle.centre).truncate();
    circle.centre + glam::DVec2::from_angle(circle.sweep * part).rotate(start).extend(0.0)
}

/// Greatest distance from a point of `points` to the line; points go along it, so that it is sought near the last place.
fn farthest(points: &[DVec3], line: &[DVec3]) -> f64 {
    let (mut near, mut worst) = (0_usize, 0.0_f64);
    for &p in points {
        let window = near.saturating_sub(80)..(near + 80).min(line.len() - 1);
        let to = |i: usize| {
            let (a, b) = (line[i], line[i + 1]);
            let t = ((p - a).dot(b - a) / (b - a).length_squared().max(1e-18)).clamp(0.0, 1.0);
            p.distance_squared(a.lerp(b, t))
        };
        let (there, squared) = window.map(|i| (i, to(i))).min_by(|(_, a), (_, b)| a.total_cmp(b)).unwrap();
        near = there;
        worst = worst.max(squared.sqrt());
    }
    worst
}

fn dense(pass: &Pass) -> Vec<DVec3> {
    let piece = |s: beadwright::pass::Segment| {
        let steps = (s.length() / 0.2).ceil().max(1.0) as usize;
        (1..=steps).map(move |i| s.from.lerp(s.to, i as f64 / steps as f64))
    };
    pass.start().into_iter().chain(pass.segments().flat_map(piece)).collect()
}

/// Checks distance and speeds and gives the moves before and after.
fn compare(case: &str, plan: &Plan, settings: &ProgramSettings) -> (usize, usize) {
    let (full, fitted) = (programs(plan, &ProgramSettings::default()), programs(plan, settings));
    for (layer, instructions) in plan.layers.iter().zip(&fitted) {
        let paths = traced(instructions);
        assert_eq!(paths.len(), layer.passes.len(), "{case}");
        for (path, pass) in paths.iter().zip(&layer.passes) {
            let dense = dense(pass);
            let (there, back) = (farthest(path, &dense), farthest(&dense, path));
            // Points of the arcs are 0.2 mm apart: their chords lie less than 1e-3 mm inside.
            assert!(there.max(back) <= settings.chord_tolerance + 1e-3, "{case}: {there} there, {back} back");
        }
    }
    let seconds = |programs: &[Vec<Instruction>]| programs.iter().map(|p| seconds(p)).sum::<f64>();
    let (before, after) = (seconds(&full), seconds(&fitted));
    assert!((after / before - 1.0).abs() < 0.005, "{case}: {after} s for {before}");
    (welds(&full), welds(&fitted))
}

/// Time with the arc on: shows whether every speed has kept its place.
fn seconds(instructions: &[Instruction]) -> f64 {
    let (mut at, mut sum) = (DVec3::ZERO, 0.0);
    for instruction in instructions {
        match *instruction {
            Instruction::Approach { to } | Instruction::Travel { to } | Instruction::Retract { to } => at = to,
            Instruction::Weld { to, circle, speed, .. } => {
                sum += circle.map_or(at.distance(to), |c| c.length()) / speed;
                at = to;
            }
            _ => {}
        }
    }
    sum
}

fn thruster() -> Mesh {
    let mut mesh = import(&model("openthruster_prop_cw.stl"), &Task::new()).unwrap().mesh;
    mesh.place(3.66, DVec3::ZERO);
    mesh
}

#[test]
#[cfg_attr(no_models, ignore = "no shared models")]
fn propellers_take_a_third_of_the_moves_along_the_same_path() {
    let propeller = example::find("propeller").unwrap().mesh();
    for (name, mesh) in [("propeller", propeller), ("thruster", thruster())] {
        for strategy in ["contour", "hybrid"] {
            let plan = planned(&mesh, "cmt-al2319-kuka", strategy);
            let case = format!("{name} {strategy}");
            let (before, after) = compare(&case, &plan, &fitted());
            let lines = compare(&case, &plan, &ProgramSettings { arcs: false, ..fitted() }).1;
            println!("{case}: {before} moves, {after} fitted, {lines} with lines only");
            if strategy == "contour" {
                assert!(before >= 3 * after, "{case}: {before} moves became {after}");
                continue;
            }
            // The hybrid's speed follows its width from place to place, and no move spans a change of it.
            let level = ProgramSettings { speed_tolerance: 0.11, ..fitted() };
            let level = compare(&case, &plan, &level).1;
            println!("{case}: {level} with speeds of 11 % one");
            let even = compare(&case, &of_one_speed(plan), &fitted());
            println!("{case}: {} moves, {} fitted, of one speed", even.0, even.1);
            assert!(before >= 2 * level && level < after && even.0 >= 3 * even.1, "{case}: {level}, {even:?}");
        }
    }
}

/// The same paths at one speed: what fitting does to the paths alone.
fn of_one_speed(mut plan: Plan) -> Plan {
    plan.layers.iter_mut().flat_map(|l| &mut l.passes).for_each(|pass| pass.pace = Along::Same(8.0));
    plan
}

/// A controller that takes a point every 0.1 s gets none sooner where the tolerance allows it, on the same path with the
/// same time.
#[test]
fn points_are_as_far_apart_as_the_controller_needs() {
    let plan = planned(&example::find("cross").unwrap().mesh(), "cmt-al2319-kuka", "hybrid");
    let straight = ProgramSettings { chord_tolerance: 0.2, ..ProgramSettings::default() };
    let spread = ProgramSettings { min_point_time: 0.1, ..straight.clone() };
    let (before, after) = (programs(&plan, &straight), programs(&plan, &spread));
    let exact = programs(&plan, &ProgramSettings::default());
    let times = |programs: &[Vec<Instruction>]| -> Vec<f64> {
        let (mut at, mut times) = (DVec3::ZERO, Vec::new());
        for instruction in programs.iter().flatten() {
            match *instruction {
                Instruction::Approach { to } | Instruction::Travel { to } | Instruction::Retract { to } => at = to,
                Instruction::Weld { to, speed, .. } => {
                    times.push(at.distance(to) / speed);
                    at = to;
                }
                _ => {}
            }
        }
        times
    };
    let short = |times: &[f64]| times.iter().filter(|t| **t < 0.1).count();
    let (b, a, e) = (times(&before), times(&after), times(&exact));
    println!("{} short of {}, then {} of {}", short(&b), b.len(), short(&a), a.len());
    assert!(short(&b) >= 20 && 4 * short(&a) <= short(&b), "{} {}", short(&b), short(&a));
    assert!((a.iter().sum::<f64>() / e.iter().sum::<f64>() - 1.0).abs() < 1e-3);
    for (line, exact) in after.iter().zip(&exact) {
        for (line, points) in traced(line).iter().zip(traced(exact)) {
            assert!(farthest(&points, line) <= 0.2, "{}", farthest(&points, line));
        }
    }
}

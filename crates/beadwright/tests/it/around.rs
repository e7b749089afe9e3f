//! One helix a layer around an axis: one arc start, rings that fill the layer, a part that always turns the same way.

use crate::common;
use crate::readers;

use beadwright::check;
use beadwright::dialect;
use beadwright::fill::around::Around;
use beadwright::layer::Layer;
use beadwright::model::{Mesh, solid::Solid};
use beadwright::plan::{self, Plan};
use beadwright::plan_file;
use beadwright::profile::Profile;
use beadwright::program::{Positioner, PositionerAxis, Turning};
use beadwright::task::Task;
use common::{profile, with_all_dialects};
use glam::{DQuat, DVec2, DVec3};
use std::f64::consts::TAU;

/// A pipe about an axis through the origin: radii and length, mm.
fn pipe(axis: DVec3, [inner, outer]: [f64; 2], length: f64) -> Mesh {
    let section = [[inner, 0.0], [outer, 0.0], [outer, length], [inner, length]].map(DVec2::from_array);
    let Solid { vertices, triangles } = Solid::revolve(&section, 180);
    let turn = DQuat::from_rotation_arc(DVec3::Z, axis);
    Mesh::from_triangles(vertices.iter().map(|p| turn * *p).collect(), triangles).0
}

/// Layers around an axis from a radius on, cut open at 180°.
fn around(axis: DVec3, radius: f64, side: &str) -> Profile {
    around_from(axis, radius, side, 180)
}

/// The same, cut open at an angle, °.
fn around_from(axis: DVec3, radius: f64, side: &str, seam: u32) -> Profile {
    let mut profile = profile("cmt-al2319-kuka");
    let [x, y, z] = axis.to_array();
    profile.layers.chart =
        format!("cylinder:axis={x}/{y}/{z},radius={radius},side={side},seam={seam}").parse().unwrap();
    profile.fill.around = Some(Around::Helix);
    // There is room for travels in a bore.
    profile.travel.clearance = 20.0;
    profile
}

fn planned(mesh: &Mesh, profile: &Profile) -> Plan {
    common::planned_once("pipe", mesh, profile).unwrap()
}

/// Figures of the worst layer: void, overfill and metal outside, %.
fn worst(plan: &Plan, profile: &Profile) -> [f64; 3] {
    let settings = plan::deposit_settings(profile);
    let figures = check::judge_layers(
        &plan.layers,
        profile,
        beadwright::deposit::Judge::new(settings),
        None,
        &Task::new(),
        |_, _| {},
    );
    figures.unwrap().figures.iter().fold([0.0; 3], |[void, overfill, outside], layer| {
        [void.max(layer.void_percent()), overfill.max(layer.overfill_percent()), outside.max(layer.outside_percent())]
    })
}

#[test]
fn a_layer_is_one_pass_that_fills_it() {
    let axes = [DVec3::Z, DVec3::new(0.6, 0.0, 0.8), DVec3::new(-0.3, 0.9, 0.1).normalize()];
    let cases = [
        ([30.0, 36.0], 140.0, "outer"),
        ([60.0, 64.0], 31.0, "outer"),
        ([20.0, 34.0], 7.6, "outer"),
        ([50.0, 58.0], 83.0, "inner"),
    ];
    for (k, (radii, length, side)) in cases.into_iter().enumerate() {
        let (axis, begins) = (axes[k % axes.len()], if side == "outer" { radii[0] } else { radii[1] });
        let profile = around_from(axis, begins, side, [180, 45, 301][k % 3]);
        let plan = planned(&pipe(axis, radii, length), &profile);
        let (case, metrics) = (format!("{radii:?} × {length} {side}"), &plan.summary.metrics);
        assert!(plan.layers.iter().all(|layer| layer.passes.len() == 1), "{case}");
        assert_eq!(metrics.arc_starts, plan.layers.len(), "{case}");
        let (laid, sliced) = (metrics.deposited_volume_mm3, metrics.part_volume_mm3);
        assert!((laid / sliced - 1.0).abs() < 0.02, "{case}: {laid} of {sliced}");
        for layer in &plan.layers {
            goes_on(layer, &profile, length, &case);
        }
        let [void, overfill, outside] = worst(&plan, &profile);
        println!("{case}: void {void:.3} %, overfill {overfill:.3} %, outside {outside:.3} %");
        // Metal reaches less than half a millimetre beyond each edge.
        assert!(void <= 0.1 && overfill <= 1.5 && outside * length <= 90.0, "{case}: {void} {overfill} {outside}");
        let findings = check::check(&plan.layers, &profile, plan::deposit_settings(&profile), &Task::new()).unwrap();
        let known = ["off-level", "cooling", "outside"];
        let found: Vec<_> = findings.iter().filter(|f| !known.contains(&f.kind)).map(|f| &f.text).collect();
        assert!(found.is_empty(), "{case}: {found:?}");
    }
}

/// The pass of a layer always goes on in the same direction, around as often as there are rings, and stays within the edges.
fn goes_on(layer: &Layer, profile: &Profile, length: f64, case: &str) {
    let line = layer.passes[0].line();
    let steps: Vec<f64> = line.windows(2).map(|w| w[1].x - w[0].x).filter(|step| step.abs() > 1e-6).collect();
    assert!(steps.iter().all(|step| step.signum() == steps[0].signum()), "{case}: layer {} turns back", layer.index);
    let turns = profile.layers.sheet(layer).unwrap().turns_to(line[0], line[line.len() - 1]).abs();
    let width = profile.bead.width;
    let rings = ((length / width - 1.0) / (profile.stepover() / width)).round() + 1.0;
    assert!((turns - rings).abs() < 0.2, "{case}: {turns} turns, {rings} rings");
    let (low, high) = layer
        .islands
        .iter()
        .flat_map(|island| island.outer.points())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p.y), high.max(p.y)));
    let inside = |p: &DVec2| (low + 0.3 * width..=high - 0.3 * width).contains(&p.y);
    assert!(line.iter().all(inside), "{case}: layer {}", layer.index);
}

/// Where a helix is impossible, the strategy fills what goes all around, as it does without being asked for one.
#[test]
fn other_shapes_are_filled_as_before() {
    let mut cut = Solid::revolve(&[[30.0, 0.0], [36.0, 0.0], [36.0, 40.0], [30.0, 60.0]].map(DVec2::from_array), 180);
    // Slanted: the edge is a ring only on one side.
    cut.vertices.iter_mut().filter(|p| p.z > 1.0).for_each(|p| p.z += 0.4 * p.x);
    let mesh = Mesh::from_triangles(cut.vertices, cut.triangles).0;
    let helix = around(DVec3::Z, 30.0, "outer");
    let mut open = helix.clone();
    open.fill.around = None;
    let [a, b] = [&helix, &open].map(|profile| planned(&mesh, profile));
    assert!(a.layers.iter().zip(&b.layers).all(|(a, b)| a.passes == b.passes));
}

#[test]
fn files_hold_a_helix() {
    let profile = around(DVec3::Z, 30.0, "outer");
    let plan = planned(&pipe(DVec3::Z, [30.0, 34.0], 60.0), &profile);
    let layers = plan.layers.iter().map(|layer| plan_file::layer(layer, profile.layers.sheet(layer).as_ref()));
    let text = plan_file::head(&plan.header, &profile) + &layers.collect::<String>() + plan_file::tail();
    let again = plan_file::read(&text).unwrap();
    for (a, b) in plan.layers.iter().zip(&again.layers) {
        assert_eq!(b.passes.len(), 1);
        let (a, b) = (&a.passes[0], &b.passes[0]);
        assert!((a.length() - b.length()).abs() < 0.05, "{} {}", a.length(), b.length());
        // Which turn is the first is not in the file.
        let way = |pass: &beadwright::Pass| pass.end().unwrap() - pass.start().unwrap();
        assert!(way(a).distance(way(b)) < 0.05, "{} {}", way(a), way(b));
    }
}

/// In a chuck the part turns one way as long as the arc burns, as often as there are rings.
#[test]
fn the_chuck_turns_one_way_under_the_arc() {
    let mut profile = around(DVec3::Z, 30.0, "outer");
    let plan = planned(&pipe(DVec3::Z, [30.0, 34.0], 60.0), &profile);
    let axis = PositionerAxis { direction: [0.0, 0.0, 1.0], through: [0.0; 3], limits: [-1e5, 1e5], speed: 90.0 };
    profile.program.positioner = Some(Positioner { turning: Turning::Follow, axes: vec![axis], up: [1.0, 0.0, 0.0] });
    profile.dialects = with_all_dialects("cmt-steel-robots").dialects;
    profile.dialects.krl.as_mut().unwrap().max_megabytes = 1000.0;
    let files = dialect::write("krl", &plan.layers, &profile.job("demo")).unwrap();
    let motion = readers::krl::run(&files, "DEMO", "$OUT[2]");
    assert_eq!(motion.welds.len(), plan.layers.len());
    for (weld, layer) in motion.welds.iter().zip(&plan.layers) {
        let angles: Vec<f64> = weld.axes.iter().map(|axes| axes[0].unwrap()).collect();
        let steps: Vec<f64> = angles.windows(2).map(|w| w[1] - w[0]).filter(|step| step.abs() > 1e-4).collect();
        assert!(steps.iter().all(|step| step.signum() == steps[0].signum()), "layer {}", layer.index);
        let line = layer.passes[0].line();
        let turns = profile.layers.sheet(layer).unwrap().turns_to(line[0], line[line.len() - 1]).abs();
        assert!(((angles[angles.len() - 1] - angles[0]).abs() / 360.0 - turns).abs() < 0.05, "layer {}", layer.index);
        // Every place lies on the layer, at the height that the steps reach.
        let radius = 30.0 + layer.z;
        let off = weld.points.iter().map(|[x, y, _]| (x.hypot(*y) - radius).abs()).fold(0.0, f64::max);
        assert!(off < 0.01, "layer {}: {off} mm of {}", layer.index, TAU * radius);
    }
}

/// A table that cannot turn as often as there are rings gets the plan that it can follow.
#[test]
fn a_table_that_turns_little_gets_no_helix() {
    let mut profile = around(DVec3::Z, 30.0, "outer");
    let axis = |limit: f64| PositionerAxis {
        direction: [0.0, 0.0, 1.0],
        through: [0.0; 3],
        limits: [-limit, limit],
        speed: 90.0,
    };
    let mesh = pipe(DVec3::Z, [30.0, 34.0], 60.0);
    let mut notes = |limit: f64| {
        let axes = vec![axis(limit)];
        profile.program.positioner = Some(Positioner { turning: Turning::Follow, axes, up: [1.0, 0.0, 0.0] });
        let plan = planned(&mesh, &profile);
        plan.summary.notes.iter().any(|note| note.contains("No layer is laid as a helix"))
    };
    // Eleven rings.
    assert!(notes(190.0) && notes(1900.0) && !notes(2100.0));
}

/// However far beads reach beyond the outline, a layer that is cut open is taken as it is.
#[test]
fn passes_of_one_turn_are_left_whole() {
    for strategy in ["loop", "contour", "zigzag"] {
        let mut profile = around(DVec3::Z, 30.0, "outer");
        profile.fill.strategy = strategy.parse().unwrap();
        (profile.fill.around, profile.fill.machining_allowance) = (None, 6.0);
        let plan = planned(&pipe(DVec3::Z, [30.0, 34.0], 60.0), &profile);
        let cut = |layer: &&Layer| plan::Bands::of_layer(layer, &profile).is_some();
        assert_eq!(plan.layers.iter().filter(cut).count(), 0, "{strategy}");
    }
}

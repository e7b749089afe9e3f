//! Beads laid on what lies below them, against closed forms, and the height that plans build.

use crate::solids::{cuboid, imported, mapped};
use beadwright::bead::{Bead, Section};
use beadwright::deposit::{DepositSettings, Nominal, Stack, stack::Growth};
use beadwright::fill::StrategyName;
use beadwright::finding::Severity;
use beadwright::layer::Layer;
use beadwright::pass::{Along, Pass, PassKind};
use beadwright::plan::{self, Header, Plan, Sink, choice};
use beadwright::{Judge, Model, Part, Placement, Profile, Task, check, example};
use glam::{DQuat, DVec2, DVec3};
use planar::{Bounds, Polygon, Ring};
use std::convert::Infallible;

const WIDTH: f64 = 6.0;
const HEIGHT: f64 = 2.0;
/// Turns of a test, degrees: no line of it lies along the grid.
const TURNS: [f64; 4] = [0.0, 17.0, 45.0, 101.0];

fn bead() -> Bead {
    Bead { width: WIDTH, height: HEIGHT, section: Section::Parabola }
}

fn settings() -> DepositSettings {
    DepositSettings::new(Nominal { bead: bead(), pace: 8.0, rise: bead().area() / WIDTH }, 0.0)
}

fn stack() -> Stack {
    Stack::new(&Bounds { min: DVec2::splat(-60.0), max: DVec2::splat(60.0) }, settings())
}

/// Straight passes from x = -40 to 40 at these y, turned about the origin.
fn layer(index: usize, height: f64, ys: &[f64], degrees: f64) -> Layer {
    let z = (index + 1) as f64 * height;
    let turned = |x: f64, y: f64| DVec2::from_angle(degrees.to_radians()).rotate(DVec2::new(x, y));
    let pass = |&y: &f64| Pass {
        kind: PassKind::Infill,
        closed: false,
        points: [-40.0, 40.0].map(|x| turned(x, y).extend(z)).to_vec(),
        width: Along::Same(WIDTH),
        pace: Along::Same(8.0),
        wait: 0.0,
    };
    let (low, high) = (ys[0] - WIDTH / 2.0, ys[ys.len() - 1] + WIDTH / 2.0);
    let ring = [(-43.0, low), (43.0, low), (43.0, high), (-43.0, high)].map(|(x, y)| turned(x, y));
    let islands = vec![Polygon::simple(Ring::new(ring.to_vec()))];
    Layer { index, z, height, islands, passes: ys.iter().map(pass).collect(), ..Layer::default() }
}

fn volume(stack: &Stack) -> f64 {
    let grid = stack.grid();
    let place = |at: usize| grid.place(at % grid.columns, at / grid.columns);
    (0..grid.points()).map(|at| stack.height_at(place(at)).unwrap()).sum::<f64>() * grid.step * grid.step
}

#[test]
fn a_bead_on_the_plate_is_the_parabola() {
    for degrees in TURNS {
        let mut stack = stack();
        stack.add(&layer(0, HEIGHT, &[0.0], degrees));
        let (along, grid) = (DVec2::from_angle(degrees.to_radians()), *stack.grid());
        for at in 0..grid.points() {
            let p = grid.place(at % grid.columns, at / grid.columns);
            if p.dot(along).abs() < 35.0 {
                let expected = HEIGHT * (1.0 - (2.0 * along.perp_dot(p) / WIDTH).powi(2)).max(0.0);
                let height = stack.height_at(p).unwrap();
                assert!((height - expected).abs() < 0.03 * HEIGHT, "{degrees}°, {p}: {height} {expected}");
            }
        }
        let metal = 80.0 * bead().area();
        assert!((volume(&stack) / metal - 1.0).abs() < 2e-3, "{degrees}°: {} mm³ of {metal}", volume(&stack));
    }
}

#[test]
fn metal_is_kept_where_nothing_hangs() {
    // Each layer lies inside the one below.
    for degrees in TURNS {
        let mut stack = stack();
        let layers: Vec<Vec<f64>> = vec![
            (0..9).map(|k| -17.6 + 4.4 * f64::from(k)).collect(),
            (0..5).map(|k| -8.8 + 4.4 * f64::from(k)).collect(),
            vec![-3.0, 0.0, 3.0],
        ];
        for (index, ys) in layers.iter().enumerate() {
            let mut layer = layer(index, 1.8, ys, degrees);
            let shorter = 1.0 - 0.1 * index as f64;
            layer.passes.iter_mut().flat_map(|pass| &mut pass.points).for_each(|p| {
                let along = DVec2::from_angle(degrees.to_radians());
                let cut = p.truncate().dot(along) * (shorter - 1.0);
                *p += (along * cut).extend(0.0);
            });
            stack.add(&layer);
            let metal: f64 = layer.passes.iter().map(|pass| pass.length() * bead().area()).sum();
            let laid = volume(&stack)
                - layers[..index]
                    .iter()
                    .enumerate()
                    .map(|(i, ys)| 80.0 * (1.0 - 0.1 * i as f64) * ys.len() as f64 * bead().area())
                    .sum::<f64>();
            assert!((laid / metal - 1.0).abs() < 0.01, "{degrees}°, layer {index}: {laid} mm³ of {metal}");
        }
    }
}

/// What the middle of a stack of such layers rises by the layer, from the fourth on, mm.
fn rise(ys: impl Fn(usize) -> Vec<f64>, at: impl Fn(usize) -> f64, degrees: f64) -> f64 {
    let (mut stack, mut tops) = (stack(), Vec::new());
    for index in 0..16 {
        stack.add(&layer(index, 1.3, &ys(index), degrees));
        let normal = DVec2::from_angle(degrees.to_radians()).perp();
        let across = |k: i32| normal * (at(index) + 0.1 * f64::from(k));
        tops.push((-4..=4).map(|k| stack.height_at(across(k)).unwrap()).fold(0.0, f64::max));
    }
    (tops[15] - tops[3]) / 12.0
}

#[test]
fn a_wall_rises_by_area_over_width_upright_and_leaning() {
    let expected = bead().area() / WIDTH;
    for degrees in TURNS {
        let upright = rise(|_| vec![0.0], |_| 0.0, degrees);
        assert!((upright / expected - 1.0).abs() < 0.03, "{degrees}°: {upright} mm, expected {expected}");
        // A level layer of a leaning wall is a prism of the bead's width.
        for shift in [0.3, 0.6] {
            let leaning = rise(|k| vec![shift * k as f64], |k| shift * k as f64, degrees);
            assert!((leaning / expected - 1.0).abs() < 0.05, "{degrees}°, {shift} mm: {leaning}, expected {expected}");
        }
    }
}

#[test]
fn a_wall_of_two_beads_rises_by_their_metal_over_its_thickness() {
    for degrees in TURNS {
        for apart in [3.6, 4.3] {
            let ys = vec![-apart / 2.0, apart / 2.0];
            let (risen, expected) = (rise(|_| ys.clone(), |_| 0.0, degrees), 2.0 * bead().area() / (apart + WIDTH));
            assert!(
                (risen / expected - 1.0).abs() < 0.06,
                "{degrees}°, {apart} mm apart: {risen}, expected {expected}"
            );
        }
    }
}

#[test]
fn the_middle_of_a_wide_layer_rises_by_area_over_stepover() {
    for degrees in TURNS {
        let stepover = 4.3;
        let ys: Vec<f64> = (-5..=5).map(|k| stepover * f64::from(k)).collect();
        let (risen, expected) = (rise(|_| ys.clone(), |_| 0.0, degrees), bead().area() / stepover);
        assert!((risen / expected - 1.0).abs() < 0.05, "{degrees}°: {risen}, expected {expected}");
    }
}

#[test]
fn splitting_a_pass_changes_nothing() {
    let laid = |pieces: usize| {
        let mut stack = stack();
        for index in 0..4 {
            let mut layer = layer(index, 1.8, &[-4.3, 0.0, 4.3], 17.0);
            for pass in &mut layer.passes {
                let (from, to) = (pass.points[0], pass.points[1]);
                pass.points = (0..=pieces).map(|k| from.lerp(to, k as f64 / pieces as f64)).collect();
            }
            stack.add(&layer);
        }
        stack.built().unwrap()
    };
    let whole = laid(1);
    for pieces in [7, 64, 400] {
        let built = laid(pieces);
        let off = [built.mean - whole.mean, built.peak - whole.peak, built.hollow - whole.hollow];
        assert!(off[0].abs() < 0.02 && off.iter().all(|off| off.abs() < 0.25), "{pieces} pieces: {built:?} {whole:?}");
    }
}

fn planned(name: &str, degrees: f64, level: bool) -> (Plan, Profile) {
    let mut profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    profile.layers.level = level;
    let placement = Placement { turn: DVec3::new(0.0, 0.0, degrees), ..Placement::default() };
    let bytes = example::find(name).unwrap().stl();
    let part = Model::read(&bytes, &Task::new()).unwrap().place(&placement, None, profile.bead.width).unwrap();
    (plan::plan(name, &part, &profile, &Task::new()).unwrap(), profile)
}

fn built(plan: &Plan, profile: &Profile) -> Growth {
    let settings = plan::deposit_settings_over(profile, (plan.header.extent.low, plan.header.extent.high));
    check::grown(&plan.layers, profile, settings, &Task::new()).unwrap().worst().unwrap()
}

/// Keeps the layers, and wants to know how the part grows.
struct Asking(Vec<Layer>);

impl Sink for Asking {
    type Error = Infallible;

    fn begin(&mut self, _: &Header) -> Result<(), Infallible> {
        Ok(())
    }

    fn layer(&mut self, layer: Layer) -> Result<(), Infallible> {
        self.0.push(layer);
        Ok(())
    }

    fn asks_how_it_grows(&self) -> bool {
        true
    }
}

#[test]
fn the_growth_that_planning_finds_is_that_of_its_layers() {
    for (name, allowance) in [("vase", 0.0), ("propeller", 0.0), ("cross", 12.0)] {
        let mut profile = Profile::built_in("cmt-al2319-kuka").unwrap();
        profile.fill.machining_allowance = allowance;
        let part = example::find(name).unwrap().mesh();
        let mut asking = Asking(Vec::new());
        let summary = plan::plan_into(name, &part, &profile, &Task::new(), &mut asking).unwrap();
        let settings = plan::deposit_settings_over(&profile, part.bounds());
        let stacked = check::grown(&asking.0, &profile, settings, &Task::new()).unwrap();
        assert_eq!(summary.grown, Some(stacked), "{name}");
        assert_eq!(plan::plan(name, &part, &profile, &Task::new()).unwrap().summary.grown, None);
    }
}

#[test]
fn level_layers_end_where_the_plan_does() {
    for name in ["cross", "gear", "plate", "star", "vase", "propeller"] {
        // Tips of the twisted blades end low.
        let least = if name == "propeller" { 0.97 } else { 0.99 };
        for degrees in [0.0, 23.0] {
            let (plan, profile) = planned(name, degrees, true);
            let ended = built(&plan, &profile);
            assert!(ended.within >= least && ended.mean.abs() < 0.4, "{name} at {degrees}°: {ended:?}");
            let high = example::find(name).unwrap().mesh().bounds().1.z;
            assert!(
                (plan.layers.last().unwrap().z - high).abs() < 1e-6,
                "{name} at {degrees}°: all of the part is built"
            );
            let mut judge = Judge::new(plan::deposit_settings(&profile));
            plan.layers.iter().for_each(|layer| drop(judge.layer(layer)));
            let outside = judge.total().outside_percent();
            assert!(outside < 1.5, "{name} at {degrees}°: {outside} % beside the part");
            let metrics = &plan.summary.metrics;
            let metal = metrics.deposited_volume_mm3 / metrics.part_volume_mm3;
            // Corners hold less than their beads would need.
            assert!((metal - 1.0).abs() < 0.05, "{name} at {degrees}°: {metal} of the metal of its slices");
        }
    }
}

/// Corners and rims stay rounded: a small part rises faster than its metal fills it. A wall of two beads rises more slowly.
#[test]
fn small_and_thin_parts_end_where_the_plan_does_too() {
    let boxes = [(20.0, 20.0, 20.0), (25.0, 25.0, 60.0), (40.0, 40.0, 40.0), (30.0, 60.0, 30.0), (10.0, 80.0, 50.0)];
    for (x, y, z) in boxes {
        for degrees in [0.0_f64, 30.0] {
            let turn = DQuat::from_rotation_z(degrees.to_radians());
            let solid = mapped(&cuboid([0.0; 3], [x, y, z]), |p| turn * p);
            let profile = Profile::built_in("cmt-al2319-kuka").unwrap();
            let part = Part::Mesh(imported(&solid));
            let profile = choice::choose(&part, &profile, false, &Task::new()).unwrap().profile;
            let plan = plan::plan("box", &part, &profile, &Task::new()).unwrap();
            let ended = built(&plan, &profile);
            let label = format!("{x} × {y} × {z} mm at {degrees}°");
            assert!(ended.within >= 0.95 && ended.mean.abs() < 0.6, "{label}: {ended:?}");
        }
    }
}

#[test]
fn a_paper_followed_to_the_letter_has_layers_of_one_height() {
    let mut profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    profile.fill.strategy = StrategyName::Hybrid;
    assert!(profile.is_level());
    profile.hybrid.literal = true;
    let mesh = example::find("propeller").unwrap().mesh();
    let plan = plan::plan("propeller", &mesh, &profile, &Task::new()).unwrap();
    assert!(plan.layers.iter().all(|layer| (layer.height - 2.0).abs() < 1e-9));
}

#[test]
fn a_part_with_few_beads_side_by_side_is_said_to_end_low() {
    let (plan, profile) = planned("vase", 0.0, false);
    let ended = built(&plan, &profile);
    assert!(ended.mean < -10.0 && ended.within < 0.5, "{ended:?}");
    let settings = plan::deposit_settings_over(&profile, (plan.header.extent.low, plan.header.extent.high));
    let findings = check::check(&plan.layers, &profile, settings, &Task::new()).unwrap();
    let found = findings.iter().find(|finding| finding.kind == "built-height").unwrap();
    assert!(found.text.contains("below it"), "{}", found.text);
    assert_eq!(found.severity, Severity::Serious, "no arc burns {} mm farther away", ended.hollow);
    let top = plan.layers.last().unwrap().z;
    assert!(found.place.is_some_and(|place: DVec3| (place.z - top).abs() < 1e-9));
}

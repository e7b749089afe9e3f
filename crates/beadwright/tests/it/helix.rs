//! Closed walls as one helix: one arc start, every turn on the one below, the metal of the wall, a level top.

use crate::common;
use beadwright::fill::StrategyName;

use beadwright::export::{self, Beads, toolpath};
use beadwright::glam::{DQuat, DVec3};
use beadwright::layer::Layer;
use beadwright::model::Mesh;
use beadwright::pass::Pass;
use beadwright::plan::{self, Plan, PlanError};
use beadwright::profile::Profile;
use beadwright::program::Turns;
use beadwright::task::Task;
use beadwright::warning::WarningKind;
use beadwright::{check, plan_file};
use common::{profile_by, tube};

fn profile(helix: bool) -> Profile {
    let mut profile = profile_by("cmt-al2319-kuka", "wall");
    profile.wall.helix = helix;
    profile
}

fn planned(mesh: &Mesh, profile: &Profile) -> Plan {
    common::planned_once("tube", mesh, profile).unwrap()
}

fn turned(mesh: &Mesh, degrees: f64) -> Mesh {
    let turn = DQuat::from_rotation_z(degrees.to_radians());
    let (low, _) = mesh.bounds();
    let vertices = mesh.vertices.iter().map(|v| turn * (*v - low.with_z(0.0)) + DVec3::new(100.0, 40.0, 0.0)).collect();
    Mesh::from_triangles(vertices, mesh.triangles.clone()).0
}

/// Metal, as the time at the nominal wire feed, s.
fn metal(plan: &Plan) -> f64 {
    let passes = plan.layers.iter().flat_map(|layer| &layer.passes);
    passes.flat_map(|pass| pass.segments().collect::<Vec<_>>()).map(|s| s.length() / s.pace).sum()
}

#[test]
fn a_tube_is_one_pass_with_the_metal_of_its_walls() {
    for (lean, degrees) in [(0.0, 0.0), (0.0, 33.0), (0.15, 0.0), (-0.2, 71.0)] {
        let mesh = turned(&tube(40.0, 7.54, 40.0, lean), degrees);
        let (helix, plain) = (planned(&mesh, &profile(true)), planned(&mesh, &profile(false)));
        let layers = plain.layers.len();
        assert_eq!((helix.layers.len(), plain.summary.metrics.arc_starts), (layers, layers as u64 as _));
        assert_eq!((helix.summary.metrics.arc_starts, helix.summary.metrics.passes), (1, 1), "{lean} {degrees}");
        // Each turn begins where the last one ended, and rises by one layer.
        for pair in helix.layers.windows(2) {
            let (end, start) = (pair[0].passes[0].end().unwrap(), pair[1].passes[0].start().unwrap());
            assert!(end.distance(start) < 1e-9, "{end} {start}");
            assert!(pair[0].lit.after && pair[1].lit.before);
        }
        let first = &helix.layers[0].passes[0];
        assert!(first.points.iter().all(|p| (p.z - helix.layers[0].z).abs() < 1e-9), "the first turn is level");
        // A point of a turn lies a layer above the turn below it, as far out as the wall leans.
        for layers in helix.layers.windows(2).skip(2).take(layers - 4) {
            let [below, above] = [&layers[0].passes[0], &layers[1].passes[0]];
            for p in above.points.iter().step_by(7) {
                let under = |pair: &[DVec3]| {
                    let [a, b] = [pair[0], pair[1]];
                    let way = (b - a).truncate();
                    let part = (p.truncate() - a.truncate()).dot(way) / way.length_squared();
                    a.lerp(b, part.clamp(0.0, 1.0))
                };
                let away = |q: &DVec3| q.truncate().distance(p.truncate());
                let nearest = below.points.windows(2).map(under).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap();
                let (rise, away) = (p.z - nearest.z, away(&nearest));
                let near_the_seam = p.distance(above.points[0]) < 15.0 || p.distance(above.end().unwrap()) < 15.0;
                assert!(near_the_seam || (rise - layers[1].height).abs() < 0.05, "{rise} {lean}");
                assert!(away < 0.05 + lean.abs() * layers[1].height, "{away} {lean}");
            }
        }
        let (ours, theirs) = (metal(&helix), metal(&plain));
        assert!((ours / theirs - 1.0).abs() < 0.01, "{ours} {theirs} {lean}");
        let last = helix.layers.last().unwrap();
        assert!((last.passes[0].end().unwrap().z - last.z).abs() < 1e-9, "the top is level");
    }
}

#[test]
fn no_check_takes_a_helix_for_something_else() {
    let profile = profile(true);
    let plan = planned(&tube(40.0, 7.54, 40.0, 0.1), &profile);
    let settings = plan::deposit_settings(&profile);
    let findings = check::check(&plan.layers, &profile, settings, &Task::new()).unwrap();
    let found: Vec<_> = findings.iter().map(|f| (f.kind, &f.text)).collect();
    // Nothing waits on the way, and that is so.
    assert!(found.iter().all(|(kind, _)| ["built-height", "cooling"].contains(&&**kind)), "{found:?}");
    assert!(plan.summary.forbidden.is_empty());
}

#[test]
fn plan_json_holds_the_helix() {
    let profile = profile(true);
    let plan = planned(&tube(40.0, 7.54, 16.0, 0.0), &profile);
    let layers: String = plan.layers.iter().map(|layer| plan_file::layer(layer, None)).collect();
    let text = plan_file::head(&plan.header, &profile) + &layers + plan_file::tail();
    let read = plan_file::read(&text).unwrap();
    assert!(read.layers.iter().zip(&plan.layers).all(|(a, b)| a.lit == b.lit));
    let two = text.replacen(
        "{\"kind\":\"wall\"",
        "{\"kind\":\"wall\",\"closed\":false,\"points\":[[0,0,2],[9,0,2]],\"width\":7,\"pace\":9},{\"kind\":\"wall\"",
        1,
    );
    let error = plan_file::read(&two).unwrap_err().to_string();
    assert!(error.contains("layer 1") && error.contains("goes_on"), "{error}");
}

#[test]
fn toolpaths_in_3mf_hold_the_helix() {
    let profile = profile(true);
    let plan = planned(&tube(40.0, 7.54, 16.0, 0.0), &profile);
    let beads = Beads { header: &plan.header, layers: &plan.layers, profile: &profile, heat: None };
    let read = toolpath::read(&(export::format("3mf").unwrap().write)(&beads).unwrap()).unwrap();
    assert!(read.layers.iter().zip(&plan.layers).all(|(a, b)| a.lit == b.lit && a.passes.len() == 1));
    let length = |layers: &[Layer]| layers.iter().flat_map(|l| &l.passes).map(Pass::length).sum::<f64>();
    assert!((length(&read.layers) - length(&plan.layers)).abs() < 0.01);
}

/// The turns put together are one pass with the points of all; where some are left out, the arc goes out before them.
#[test]
fn turns_are_put_together_for_programs() {
    let plan = planned(&tube(30.0, 7.54, 20.0, 0.0), &profile(true));
    let taken = |chosen: &dyn Fn(usize) -> bool| -> Vec<Layer> {
        let mut turns = Turns::default();
        let layers = plan.layers.iter().filter(|layer| chosen(layer.index));
        let mut all: Vec<Layer> = layers.flat_map(|layer| turns.take(layer)).map(|layer| layer.into_owned()).collect();
        all.extend(turns.end());
        all
    };
    let whole = taken(&|_| true);
    let length: f64 = plan.layers.iter().flat_map(|l| &l.passes).map(Pass::length).sum();
    assert!(whole.len() == 1 && (whole[0].passes[0].length() - length).abs() < 1e-6);
    assert!((metal(&Plan { layers: whole, ..plan.clone() }) / metal(&plan) - 1.0).abs() < 1e-9);
    let rest = taken(&|index| index >= 4);
    assert!(rest.len() == 1 && rest[0].index == 4 && !rest[0].lit.is_turn());
    let apart = taken(&|index| !(2..=5).contains(&index));
    assert_eq!(apart.iter().map(|layer| layer.index).collect::<Vec<_>>(), [0, 6]);
}

/// A limit of temperature that a helix cannot keep is said.
#[test]
fn a_helix_hotter_than_the_limit_is_said() {
    let mut profile = profile(true);
    let limits =
        beadwright::heat::Interpass { max_temperature: 100.0, min_temperature: None, reorder: true, along: true };
    profile.interpass = Some(limits);
    let plan = planned(&tube(30.0, 7.54, 40.0, 0.0), &profile);
    assert!(plan.layers.iter().all(|layer| layer.passes.len() == 1 && layer.passes[0].wait == 0.0));
    let hot = plan.summary.warnings.summaries().find(|w| w.kind == WarningKind::HotAhead).unwrap();
    assert!(hot.count > plan.layers.len() / 2 && hot.largest.size > 150.0, "{hot:?}");
}

/// A wall of two beads is one closed loop, and no helix.
#[test]
fn a_loop_of_two_beads_is_no_helix() {
    let mut profile = profile(true);
    profile.fill.strategy = StrategyName::Loop;
    let error = plan::plan("two", &tube(40.0, 13.0, 10.0, 0.0), &profile, &Task::new()).unwrap_err();
    assert!(
        matches!(error, PlanError::NoHelix { layer: 1, .. }) && error.to_string().contains("not a single bead"),
        "{error}"
    );
}

/// What is not one closed wall is refused with the layer.
#[test]
fn two_walls_are_no_helix() {
    let (one, mut two) = (tube(30.0, 7.54, 10.0, 0.0), tube(20.0, 7.54, 10.0, 0.0));
    two.vertices.iter_mut().for_each(|v| v.x += 80.0);
    let count = one.vertices.len() as u32;
    let vertices = one.vertices.iter().chain(&two.vertices).copied().collect();
    let triangles = one.triangles.iter().copied().chain(two.triangles.iter().map(|t| t.map(|k| k + count))).collect();
    let mesh = Mesh::from_triangles(vertices, triangles).0;
    let error = plan::plan("two", &mesh, &profile(true), &Task::new()).unwrap_err();
    assert!(matches!(error, PlanError::NoHelix { layer: 1, .. }), "{error}");
    assert!(
        error.to_string().contains("layer 1 cannot be a turn of the helix that wall.helix asks for: it has 2 passes."),
        "{error}"
    );
}

/// Where a controller holds no more points, the arc is lit again, and the wall rises on as if it had not.
#[test]
fn a_helix_longer_than_a_program_is_lit_again_and_said() {
    let mesh = tube(40.0, 7.54, 40.0, 0.0);
    let turn = planned(&mesh, &profile(true)).layers[1].passes[0].points.len();
    for (turns, fits) in [(9, true), (7, true), (5, true), (2, false)] {
        let mut profile = profile(true);
        // A move takes at most 102 characters.
        profile.dialects.krl.as_mut().unwrap().max_megabytes = (102 * turns * turn) as f64 * 1e-6;
        let plan = match plan::plan("tube", &mesh, &profile, &Task::new()) {
            Ok(plan) => plan,
            Err(error) => {
                let text = error.to_string();
                assert!(!fits && text.contains("layer 1 cannot be a turn") && text.contains("three turns"), "{text}");
                continue;
            }
        };
        let starts = plan.layers.iter().filter(|layer| !layer.lit.before).count();
        assert!(fits && starts > 1 && starts <= plan.layers.len() / 2, "{turns}: {starts}");
        assert!(plan.layers.iter().all(|layer| layer.lit.is_turn()), "no turn is alone");
        let text: Vec<String> = plan.summary.warnings.summaries().map(|w| w.sentence()).collect();
        assert!(text.iter().any(|t| t.contains("struck again")), "{text:?}");
        let settings = plan::deposit_settings(&profile);
        let findings = check::check(&plan.layers, &profile, settings, &Task::new()).unwrap();
        assert!(!findings.iter().any(|f| f.kind == "points"), "{findings:?}");
        let heights: Vec<f64> = plan.layers.iter().flat_map(|l| &l.passes[0].points).map(|p| p.z).collect();
        assert!(heights.windows(2).all(|pair| pair[1] >= pair[0] - 1e-9), "it rises all the way");
    }
}

//! Checks: every seeded fault is found by the check that is there for it, and clean plans have no finding.

use crate::common;

use beadwright::bead::Law;
use beadwright::check::{self, CHECKS};
use beadwright::finding::Severity;
use beadwright::layer::Layer;
use beadwright::pass::Along;
use beadwright::plan;
use beadwright::process::Follow;
use beadwright::profile::Profile;
use beadwright::task::Task;
use common::profile_by;
use glam::DVec3;

fn planned(part: &str, profile: &Profile, layers: usize) -> Vec<Layer> {
    let mut plan = common::planned(part, profile);
    plan.layers.truncate(layers);
    plan.layers
}

/// Names of the checks that find something.
fn found(layers: &[Layer], profile: &Profile) -> Vec<&'static str> {
    let findings = check::check(layers, profile, plan::deposit_settings(profile), &Task::new()).unwrap();
    assert!(findings.iter().all(|f| f.sentence().ends_with('.')), "{findings:?}");
    let mut names: Vec<&str> = findings.into_iter().map(|f| f.kind).collect();
    names.sort_unstable();
    names.dedup();
    names
}

#[test]
fn clean_plans_have_no_finding() {
    for part in ["cross", "star", "gear", "propeller"] {
        for strategy in ["loop", "hybrid"] {
            let profile = profile_by("cmt-al2319-kuka", strategy);
            let mut found = found(&planned(part, &profile, 10), &profile);
            // To close all voids the hybrid would need passes that are over before their arc is steady.
            found.retain(|check| strategy != "hybrid" || *check != "void");
            assert_eq!(found, [""; 0], "{part} by {strategy}");
        }
    }
    let profile = profile_by("cmt-steel-abb", "wall");
    assert_eq!(found(&planned("tian", &profile, 18), &profile), [""; 0]);
}

#[test]
fn the_torchs_speed_and_the_heat_are_judged_whatever_follows_the_width() {
    let mut profile = profile_by("cmt-al2319-kuka", "loop");
    // Beads of the gear are 0.8 to 1.3 widths wide.
    let layers = planned("gear", &profile, 2);
    let speed = profile.process.deposition_speed;
    profile.check.min_speed = Some(0.95 * speed);
    profile.check.max_speed = Some(1.05 * speed);
    assert_eq!(found(&layers, &profile), ["speed-window"]);
    profile.process.follow = Follow::WireFeed;
    assert_eq!(found(&layers, &profile), [""; 0], "the torch keeps its speed, the wire follows");
    (profile.process.current, profile.process.voltage) = (Some(150.0), Some(20.0));
    profile.check.max_heat_input = Some(1.1 * profile.heat_input().unwrap());
    assert_eq!(found(&layers, &profile), ["heat-input"], "wide beads are hotter by either");
    profile.process.follow = Follow::Speed;
    assert_eq!(found(&layers, &profile), ["heat-input", "speed-window"]);
}

#[test]
fn wire_is_balanced_by_the_law_of_the_bead() {
    let mut profile = profile_by("cmt-al2319-kuka", "loop");
    profile.bead.law = Law::ConstantRatio;
    let layers = planned("gear", &profile, 2);
    assert!(!found(&layers, &profile).contains(&"wire-balance"));
    profile.bead.law = Law::ConstantHeight;
    assert!(found(&layers, &profile).contains(&"wire-balance"), "the widths ask for other paces");
}

/// A fault: what it is, how it comes into the plan or the profile, and the check that finds it.
type Fault = (&'static str, fn(&mut Vec<Layer>, &mut Profile), &'static str);

const FAULTS: [Fault; 20] = [
    ("a coordinate that is no number", |l, _| l[1].passes[0].points[1].x = f64::NAN, "points"),
    ("an infinite coordinate", |l, _| l[0].passes[1].points[0].y = f64::INFINITY, "points"),
    (
        "a pass of one spot",
        |l, _| {
            let spot = l[0].passes[0].points[0];
            l[0].passes[0].points.iter_mut().for_each(|p| *p = spot);
        },
        "points",
    ),
    ("a point below its layer", |l, _| l[2].passes[0].points[0].z -= 3.0, "points"),
    ("a layer gone", |l, _| drop(l.remove(1)), "layers"),
    ("two layers exchanged", |l, _| l.swap(1, 2), "layers"),
    ("a layer without passes", |l, _| l[1].passes.clear(), "layers"),
    (
        "a travel with the arc on",
        |l, _| {
            let far = l[0].passes[0].points[0] + DVec3::new(400.0, 0.0, 0.0);
            l[0].passes[0].points.push(far);
        },
        "air",
    ),
    (
        "a bead across the layer",
        |l, _| {
            let mut across = l[0].passes[0].clone();
            let z = l[0].z;
            across.closed = false;
            across.points = vec![DVec3::new(-45.0, 0.3, z), DVec3::new(45.0, 0.2, z)];
            (across.width, across.pace) = (Along::Same(7.54), Along::Same(10.5));
            l[0].passes.push(across);
        },
        "crossing",
    ),
    (
        "a stub",
        |l, _| {
            let end = l[0].passes[0].points[0] + DVec3::new(1.0, 0.0, 0.0);
            l[0].passes[0].points = vec![l[0].passes[0].points[0], end];
            l[0].passes[0].closed = false;
        },
        "short-pass",
    ),
    ("a speed of zero", |l, _| l[1].passes[0].pace = Along::Same(0.0), "speed-window"),
    ("a speed over the window", |_, p| p.check.max_speed = Some(5.0), "speed-window"),
    ("a bead three times as wide", |l, _| l[0].passes[0].width = Along::Same(22.0), "bead-width"),
    ("wire feed halved", |_, p| p.process.wire_feed_speed /= 2.0, "wire-balance"),
    ("a speed that does not follow the width", |l, _| l[0].passes[0].pace = Along::Same(20.0), "wire-balance"),
    (
        "too much heat",
        |_, p| {
            (p.process.current, p.process.voltage) = (Some(200.0), Some(25.0));
            p.check.max_heat_input = Some(300.0);
        },
        "heat-input",
    ),
    (
        "half of the passes gone",
        |l, _| {
            let half = l[0].passes.len() / 2;
            l[0].passes.truncate(half);
        },
        "void",
    ),
    (
        "all passes twice",
        |l, _| {
            let again = l[1].passes.clone();
            l[1].passes.extend(again);
        },
        "overfill",
    ),
    (
        "a layer moved aside",
        |l, _| {
            let points = l[3].passes.iter_mut().flat_map(|p| &mut p.points);
            points.for_each(|p| p.x += 6.0);
        },
        "outside",
    ),
    (
        "a layer that hangs over",
        |l, _| {
            for island in &mut l[3].islands {
                *island = beadwright::planar::Polygon::simple(beadwright::planar::Ring::new(
                    island.outer.points().iter().map(|p| *p + glam::DVec2::new(9.0, 0.0)).collect(),
                ));
            }
        },
        "overhang",
    ),
];

#[test]
fn every_seeded_fault_is_found() {
    let mut profile = profile_by("cmt-al2319-kuka", "hybrid");
    // Several passes a layer.
    profile.hybrid.pocket_depth = Some(1.5);
    let clean = planned("cross", &profile, 4);
    for (what, seed, check) in FAULTS {
        let (mut layers, mut profile) = (clean.clone(), profile.clone());
        seed(&mut layers, &mut profile);
        let names = found(&layers, &profile);
        assert!(names.contains(&check), "{what}: found by {names:?}");
    }
}

/// A fault that is reported with its place: what it is, how it is planted, and the check, layer and pass (from 0) that report it.
type Placed = (&'static str, fn(&mut Vec<Layer>, &mut Profile), &'static str, Option<usize>, Option<usize>);

/// Passes that run through these places beside the first point of a pass, mm.
fn detour(pass: &mut beadwright::pass::Pass, by: &[(f64, f64)]) {
    let from = pass.points[0];
    let through: Vec<DVec3> = by.iter().map(|&(x, y)| from + DVec3::new(x, y, 0.0)).collect();
    pass.points.splice(1..1, through);
    (pass.width, pass.pace) = (Along::Same(7.54), Along::Same(10.5));
}

const PLACED: [Placed; 20] = [
    ("a spike", |l, _| detour(&mut l[1].passes[0], &[(30.0, 0.0), (0.0, 0.0)]), "retraced", Some(1), Some(0)),
    (
        "a hairpin",
        |l, _| detour(&mut l[2].passes[1], &[(0.0, 40.0), (1.5, 40.0), (1.5, 0.0)]),
        "retraced",
        Some(2),
        Some(1),
    ),
    (
        "a pass that comes back on its way out",
        |l, _| {
            let pass = &mut l[3].passes[0];
            let back: Vec<DVec3> = pass.points.iter().rev().skip(1).copied().collect();
            (pass.closed, pass.width, pass.pace) = (false, Along::Same(7.54), Along::Same(10.5));
            pass.points.extend(back);
        },
        "retraced",
        Some(3),
        Some(0),
    ),
    ("the first layer last", |l, p| (l.rotate_left(1), p.travel.clearance = 4.0).1, "low-travel", Some(0), Some(1)),
    (
        "a post in the way",
        |l, _| {
            // It is in place before the other passes come.
            let (at, mut post) = (l[0].passes[1].points[0], l[0].passes[0].clone());
            (post.closed, post.points) =
                (false, vec![at + DVec3::new(0.0, 0.0, 40.0), at + DVec3::new(20.0, 0.0, 40.0)]);
            l[0].passes.insert(1, post);
        },
        "low-travel",
        Some(0),
        // The travel to the pass after it leaves from its top.
        Some(3),
    ),
    ("a layer of one short pass", |l, _| l[2].passes = vec![stub(&l[2], 60.0)], "cooling", Some(2), None),
    (
        "a layer too quick for its limit",
        |l, p| (l[1].passes.truncate(1), p.check.min_layer_time = Some(60.0)).1,
        "heat-input",
        Some(1),
        None,
    ),
    (
        "an arc over before it burns",
        |l, p| {
            // The program leaves at once.
            p.dialects.krl.as_mut().unwrap().arc_on = vec!["$OUT[2] = TRUE".to_owned()];
            let pass = stub(&l[1], 8.0);
            l[1].passes.push(pass)
        },
        "short-arc",
        Some(1),
        None,
    ),
    ("a speed that is no number", |l, _| l[2].passes[0].pace = Along::Same(f64::NAN), "speed-window", Some(2), Some(0)),
    ("a bead of a millimetre", |l, _| l[3].passes[1].width = Along::Same(1.0), "bead-width", Some(3), Some(1)),
    ("a bead of no known width", |l, _| l[0].passes[0].width = Along::Same(f64::NAN), "bead-width", Some(0), Some(0)),
    (
        "a pass that crosses itself",
        |l, _| detour(&mut l[1].passes[0], &[(30.0, 20.0), (0.0, 20.0), (30.0, -10.0)]),
        "crossing",
        Some(1),
        Some(0),
    ),
    (
        "a pass of the layer below",
        |l, _| {
            let low = l[0].passes[1].clone();
            l[2].passes.insert(0, low)
        },
        "points",
        Some(2),
        Some(0),
    ),
    ("a point far above its layer", |l, _| l[0].passes[1].points[0].z += 5.0, "points", Some(0), Some(1)),
    ("a pass without points", |l, _| l[1].passes[1].points.clear(), "points", Some(1), Some(1)),
    ("a travel that is never lifted", |_, p| p.travel.clearance = 0.0, "clearance", None, None),
    (
        "a part cut in the middle",
        |l, _| {
            l.iter_mut().skip(2).for_each(|l| {
                l.z += 5.0;
                l.passes.iter_mut().flat_map(|p| &mut p.points).for_each(|p| p.z += 5.0);
            })
        },
        "layers",
        Some(2),
        None,
    ),
    ("a controller too small for a layer", |_, p| p.check.max_points = 20, "program-size", Some(0), None),
    ("a controller too small for the plan", |_, p| p.check.max_plan_points = Some(100), "program-size", None, None),
    (
        "the arc on beside the part",
        |l, _| detour(&mut l[3].passes[1], &[(0.0, 300.0), (9.0, 300.0)]),
        "air",
        Some(3),
        Some(1),
    ),
];

/// A pass of this length where the first pass of a layer begins.
fn stub(layer: &Layer, length: f64) -> beadwright::pass::Pass {
    let mut pass = layer.passes[0].clone();
    let start = pass.points[0];
    (pass.closed, pass.points) = (false, vec![start, start + DVec3::new(length, 0.0, 0.0)]);
    (pass.width, pass.pace) = (Along::Same(7.54), Along::Same(10.5));
    pass
}

#[test]
fn every_seeded_fault_is_found_at_its_place() {
    let profile = profile_by("cmt-al2319-kuka", "contour");
    let clean = planned("cross", &profile, 4);
    let all = |layers: &[Layer], profile: &Profile| {
        check::check(layers, profile, plan::deposit_settings(profile), &Task::new()).unwrap()
    };
    let before = all(&clean, &profile);
    for (what, seed, check, layer, pass) in PLACED {
        let (mut layers, mut profile) = (clean.clone(), profile.clone());
        seed(&mut layers, &mut profile);
        let findings = all(&layers, &profile);
        let own: Vec<_> = findings.iter().filter(|f| f.kind == check).collect();
        let there = |f: &&&beadwright::Finding| f.layer == layer && (pass.is_none() || f.pass == pass);
        assert!(own.iter().any(|f| there(&f)), "{what}: {own:?}");
        assert!(!before.iter().any(|f| f.kind == check), "{what}: {check} finds something in the clean plan");
    }
}

/// Lines end to end and layer on layer, each where the one before has ended.
#[test]
fn arcs_struck_on_craters_are_found() {
    let profile = profile_by("cmt-al2319-kuka", "contour");
    let layer = planned("cross", &profile, 1).remove(0);
    let wall = |count: usize, shift: f64| -> Vec<Layer> {
        let line = |k: usize| {
            let (mut layer, z) = (layer.clone(), layer.height * (k + 1) as f64);
            let x = shift * (k % 3) as f64;
            let mut points = vec![DVec3::new(x, 0.0, z), DVec3::new(60.0 + x, 0.0, z)];
            points.rotate_left(k % 2);
            (layer.index, layer.z, layer.islands) = (k, z, Vec::new());
            layer.passes.truncate(1);
            (layer.passes[0].closed, layer.passes[0].points) = (false, points);
            (layer.passes[0].width, layer.passes[0].pace) = (Along::Same(7.54), Along::Same(10.5));
            layer
        };
        (0..count).map(line).collect()
    };
    let named = |layers: &[Layer]| found(layers, &profile).contains(&"alternating-ends");
    assert!(named(&wall(25, 0.0)));
    // The first layer meets nothing below.
    assert!(!named(&wall(24, 0.0)));
    assert!(!named(&wall(30, 8.0)), "ends moved by more than a bead width");
    let findings = check::check(&wall(26, 0.0), &profile, plan::deposit_settings(&profile), &Task::new()).unwrap();
    let of = findings.iter().filter(|f| f.kind == "alternating-ends");
    // Both ends of the wall, once each.
    assert_eq!(of.map(|f| (f.layer, f.place.unwrap().x)).collect::<Vec<_>>(), [(Some(24), 0.0), (Some(24), 60.0)]);
}

#[test]
fn the_reminder_to_cool_is_for_torches_that_wait_nowhere() {
    let mut profile = profile_by("cmt-al2319-kuka", "contour");
    let layers: Vec<Layer> = {
        let mut layers = planned("cross", &profile, 3);
        layers.iter_mut().for_each(|layer| layer.passes = vec![stub(layer, 60.0)]);
        layers
    };
    let reminded = |profile: &Profile| found(&layers, profile).contains(&"cooling");
    // 60 mm at 10.5 mm/s.
    assert!(reminded(&profile));
    profile.check.cooling_time = 5.0;
    assert!(!reminded(&profile));
    profile.check.cooling_time = 15.0;
    profile.start_stop.interpass_time = 30.0;
    assert!(!reminded(&profile));
    profile.start_stop.interpass_time = 0.0;
    profile.process.ctwd = 0.0;
    assert!(!reminded(&profile), "a printer");
}

/// The checks that look at how passes lie to each other stay silent on what is planned, over all layers.
#[test]
fn whole_plans_are_clean_of_spikes_craters_and_low_travels() {
    for part in ["cross", "star", "gear", "propeller", "plate"] {
        for strategy in ["contour", "zigzag", "loop", "hybrid"] {
            let profile = profile_by("cmt-al2319-kuka", strategy);
            let layers = planned(part, &profile, usize::MAX);
            let findings = check::check(&layers, &profile, plan::deposit_settings(&profile), &Task::new()).unwrap();
            let ways = ["retraced", "alternating-ends", "low-travel", "cooling"];
            let reported: Vec<String> =
                findings.iter().filter(|f| ways.contains(&f.kind)).map(|f| f.sentence()).collect();
            assert_eq!(reported, [""; 0], "{part} {strategy}");
        }
    }
}

#[test]
fn towers_stacked_starts_and_large_layers_are_found() {
    let mut profile = profile_by("cmt-al2319-kuka", "contour");
    let layer = planned("cross", &profile, 1).remove(0);
    let stack = |count: usize| -> Vec<Layer> {
        let place = |k: usize| {
            let (mut layer, up) = (layer.clone(), layer.height * k as f64);
            (layer.index, layer.z) = (k, layer.z + up);
            layer.passes.iter_mut().flat_map(|p| &mut p.points).for_each(|p| p.z += up);
            layer
        };
        (0..count).map(place).collect()
    };
    profile.travel.clearance = 2.0;
    let names = found(&stack(14), &profile);
    assert!(names.contains(&"stacked-starts") && names.contains(&"towers"), "{names:?}");
    profile.check.max_points = 20;
    assert!(found(&stack(1), &profile).contains(&"program-size"));
    profile.check.max_points = 20_000;
    assert!(!found(&stack(1), &profile).contains(&"program-size"));
    profile.check.max_plan_points = Some(20);
    assert!(found(&stack(1), &profile).contains(&"program-size"));
}

#[test]
fn points_too_dense_for_the_controller_are_found() {
    let mut profile = profile_by("cmt-al2319-kuka", "contour");
    let mut layers = planned("cross", &profile, 1);
    let z = layers[0].z;
    // A zigzag of 0.2 mm that no tolerance of 0.05 mm smooths, 28 ms a move at 10 mm/s.
    let zigzag = (0..40).map(|i| DVec3::new(0.2 * f64::from(i), 0.2 * f64::from(i % 2), z)).collect();
    layers[0].passes[0].points = zigzag;
    assert!(!found(&layers, &profile).contains(&"dense-points"));
    (profile.program.chord_tolerance, profile.program.min_point_time) = (0.05, 0.012);
    assert!(!found(&layers, &profile).contains(&"dense-points"));
    profile.program.min_point_time = 0.05;
    assert!(found(&layers, &profile).contains(&"dense-points"));
    profile.program.chord_tolerance = 0.5;
    assert!(!found(&layers, &profile).contains(&"dense-points"), "{:?}", found(&layers, &profile));
}

#[test]
fn every_check_says_what_why_and_what_to_do() {
    for check in &CHECKS {
        for text in [check.what, check.why, check.example, check.remedy] {
            assert!(text.len() > 20, "{}", check.name);
        }
    }
    let mut names: Vec<&str> = CHECKS.iter().map(|c| c.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), CHECKS.len());
}

#[test]
fn geometry_that_is_lost_is_a_finding() {
    let profile = common::profile("cmt-al2319-kuka");
    let mut summary = common::planned("cross", &profile).summary;
    let lost = |summary: &plan::Summary| {
        let found = check::all_findings(summary, &[], &[]).into_iter();
        found.map(|finding| (finding.kind, finding.severity, finding.text)).find(|(kind, ..)| *kind == "lost-geometry")
    };
    assert_eq!(lost(&summary), None, "the cross is planned whole");
    for (share, severity) in [(0.85, Severity::Doubt), (0.74, Severity::Serious)] {
        summary.metrics.planned_area_mm2 = share * summary.metrics.slice_area_mm2;
        let (_, found, text) = lost(&summary).expect("nothing is said");
        assert_eq!(found, severity);
        assert!(text.contains(&format!("Only {:.0} % of the part", 100.0 * share)), "{text}");
    }
}

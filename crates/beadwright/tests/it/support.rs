//! Passes lie on metal, or the plan says so: roofs over air refuse it, small islands that hang are left out.

use crate::common;

use beadwright::model::Mesh;
use beadwright::plan::Plan;
use beadwright::planar::DVec2;
use beadwright::warning::{WarningKind, WarningSummary};
use common::{flat, profile};

/// Blocks (x, y, z from and to, mm), turned about z by some degrees.
fn blocks(blocks: &[[(f64, f64); 3]], degrees: f64) -> Mesh {
    let way = DVec2::from_angle(f64::to_radians(degrees));
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for [x, y, z] in blocks {
        let first = vertices.len() as u32;
        for k in 0..8 {
            let pick = |(low, high): (f64, f64), bit: u32| if k >> bit & 1 == 0 { low } else { high };
            vertices.push(way.rotate(DVec2::new(pick(*x, 0), pick(*y, 1))).extend(pick(*z, 2)));
        }
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        triangles.extend(faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|t| t.map(|v| v + first)));
    }
    Mesh::from_triangles(vertices, triangles).0
}

fn planned(mesh: &Mesh, strategy: &str) -> Plan {
    let mut profile = flat(profile("cmt-al2319-kuka"));
    profile.fill.strategy = strategy.parse().unwrap();
    common::planned_once("part", mesh, &profile).unwrap()
}

fn warning(plan: &Plan, kind: WarningKind) -> Option<WarningSummary> {
    plan.summary.warnings.summaries().find(|w| w.kind == kind).cloned()
}

const BASE: [(f64, f64); 3] = [(0.0, 60.0), (0.0, 60.0), (0.0, 12.0)];

/// A long roof beside a tower lies on nothing, whatever the strategy and however the part is turned.
#[test]
fn a_roof_over_air_refuses_the_plan() {
    let roof = [(70.0, 190.0), (0.0, 60.0), (12.0, 24.0)];
    for degrees in [0.0, 17.0, 90.0] {
        for strategy in ["loop", "zigzag", "contour", "hybrid"] {
            let plan = planned(&blocks(&[BASE, roof], degrees), strategy);
            let air = warning(&plan, WarningKind::InTheAir).unwrap();
            assert_eq!(air.layers, [(6, 6)], "{strategy}: what is welded in the air counts once");
            assert_eq!(plan.summary.forbidden, [air.sentence()], "{strategy} at {degrees}°");
        }
    }
}

/// A roof that begins on a tower hangs by half of a long pass and more.
#[test]
fn a_bridge_between_two_towers_is_in_the_air() {
    let towers = [(0.0, 20.0), (0.0, 20.0), (0.0, 20.0)];
    let other = [(180.0, 200.0), (0.0, 20.0), (0.0, 20.0)];
    let bridge = [(0.0, 200.0), (0.0, 20.0), (20.0, 30.0)];
    let plan = planned(&blocks(&[towers, other, bridge], 0.0), "zigzag");
    assert!(warning(&plan, WarningKind::InTheAir).is_some());
    assert!(!plan.summary.forbidden.is_empty());
}

/// A slab that begins within the first layer, which its slice misses, sags onto the plate; one a layer higher does not.
#[test]
fn what_begins_within_the_first_layer_is_laid_onto_the_plate() {
    for (from, hangs) in [(1.4, false), (3.2, true)] {
        let slab = [(80.0, 190.0), (0.0, 60.0), (from, 12.0)];
        for degrees in [0.0, 17.0] {
            let plan = planned(&blocks(&[BASE, slab], degrees), "loop");
            assert_eq!(!plan.summary.forbidden.is_empty(), hangs, "from {from} mm: {:?}", plan.summary.forbidden);
            assert!(warning(&plan, WarningKind::Overhang).is_some(), "from {from} mm at {degrees}°");
        }
    }
}

/// A knob of two layers that hangs beside the part is left out; the rest is built.
#[test]
fn a_small_island_that_hangs_is_left_out() {
    let knob = [(80.0, 92.0), (0.0, 12.0), (8.0, 10.0)];
    let plan = planned(&blocks(&[BASE, knob], 17.0), "loop");
    let hanging = warning(&plan, WarningKind::HangingIsland).unwrap();
    assert_eq!((hanging.count, hanging.layers.clone()), (1, vec![(4, 4)]));
    assert!((hanging.total - 144.0).abs() < 1.0, "{}", hanging.total);
    assert_eq!(plan.summary.forbidden, [] as [String; 0]);
    let area = |layer: usize| plan.layers[layer].planned_area;
    assert!((area(4) - area(3)).abs() < 0.02 * area(3), "{} for {}", area(4), area(3));
    assert_eq!(plan.layers[4].passes.len(), plan.layers[3].passes.len());
}

/// What stands on an island that hangs refuses the plan.
#[test]
fn a_column_that_begins_in_the_air_refuses_the_plan() {
    let column = [(80.0, 92.0), (0.0, 12.0), (4.0, 12.0)];
    let plan = planned(&blocks(&[BASE, column], 0.0), "loop");
    assert!(warning(&plan, WarningKind::HangingIsland).is_some());
    let air = warning(&plan, WarningKind::InTheAir).unwrap();
    assert_eq!(plan.summary.forbidden, [air.sentence()]);
}

/// A wall that leans by half a bead a layer and less lies on metal.
#[test]
fn steps_of_less_than_half_a_bead_are_on_metal() {
    let step = |k: usize| {
        let (by, z) = (3.0 * k as f64, 2.0 * k as f64);
        [(by, by + 7.0), (0.0, 100.0), (z, z + 2.0)]
    };
    let steps: Vec<_> = (0..10).map(step).collect();
    let plan = planned(&blocks(&steps, 0.0), "loop");
    assert_eq!(plan.summary.forbidden, [] as [String; 0]);
    assert!(warning(&plan, WarningKind::InTheAir).is_none());
}

/// A long loop of which a corner hangs far out lies on metal for most of its length; the corner does not.
#[test]
fn a_long_pass_that_hangs_somewhere_is_in_the_air() {
    let slab = [(0.0, 200.0), (0.0, 60.0), (0.0, 8.0)];
    let with_tongue = |reach: f64, degrees: f64| {
        let upper = [(0.0, 200.0), (0.0, 60.0), (8.0, 12.0)];
        let tongue = [(80.0, 110.0), (55.0, 60.0 + reach), (8.0, 12.0)];
        planned(&blocks(&[slab, upper, tongue], degrees), "loop")
    };
    for degrees in [0.0, 23.0] {
        let plan = with_tongue(40.0, degrees);
        let air = warning(&plan, WarningKind::InTheAir).unwrap();
        assert_eq!((air.layers.clone(), plan.summary.forbidden.clone()), (vec![(4, 4)], vec![air.sentence()]));
        assert!(air.total > 60.0 && air.total < 300.0, "{}: the tongue is 40 mm long and 30 mm wide", air.total);
        let place = DVec2::from_angle(-f64::to_radians(degrees)).rotate(air.largest.place);
        let middle = DVec2::from_angle(-f64::to_radians(degrees)).rotate(plan_middle(&plan));
        let off = place - middle;
        assert!(off.y > 28.0 && off.x.abs() < 25.0, "{off}: on the tongue");
        assert_eq!(with_tongue(3.0, degrees).summary.forbidden, [] as [String; 0], "half a bead beyond the edge holds");
    }
}

/// The middle of the plate below the part.
fn plan_middle(plan: &Plan) -> DVec2 {
    let outline = plan.layers[0].islands[0].outer.points();
    let (low, high) = outline.iter().fold((outline[0], outline[0]), |(low, high), p| (low.min(*p), high.max(*p)));
    (low + high) / 2.0
}

/// The whole of a layer is no small place of it.
#[test]
fn a_layer_that_hangs_is_not_left_out() {
    let foot = [(0.0, 12.0), (0.0, 12.0), (0.0, 6.0)];
    let aside = [(40.0, 52.0), (0.0, 12.0), (6.0, 8.0)];
    let plan = planned(&blocks(&[foot, aside], 0.0), "loop");
    assert!(warning(&plan, WarningKind::HangingIsland).is_none());
    assert_eq!(plan.summary.forbidden.len(), 1);
}

/// The tip of an ear above a neck without room for a bead is left out; more above such a neck refuses the plan.
#[test]
fn a_tip_above_a_neck_is_left_out() {
    let neck = [(20.0, 20.5), (20.0, 20.5), (12.0, 14.0)];
    for degrees in [0.0, 31.0] {
        let tip = [(16.0, 25.0), (16.0, 25.0), (14.0, 16.0)];
        let plan = planned(&blocks(&[BASE, neck, tip], degrees), "loop");
        assert_eq!(warning(&plan, WarningKind::HangingIsland).unwrap().layers, [(7, 7)]);
        assert_eq!(plan.summary.forbidden, [] as [String; 0]);
        let column = [(16.0, 25.0), (16.0, 25.0), (14.0, 20.0)];
        let plan = planned(&blocks(&[BASE, neck, column], degrees), "loop");
        let below = warning(&plan, WarningKind::NothingBelow).unwrap();
        assert_eq!(plan.summary.forbidden, [below.sentence()], "what hangs is reported once");
    }
}

/// Above a wall too thin for a bead, what refuses the plan is the wall, not air: the remedy is another one.
#[test]
fn a_plate_above_a_wall_too_thin_to_weld_says_so() {
    let wall = [(80.0, 80.4), (0.0, 60.0), (0.0, 12.0)];
    let plate = [(77.0, 83.4), (0.0, 60.0), (12.0, 16.0)];
    for degrees in [0.0, 17.0] {
        let plan = planned(&blocks(&[BASE, wall, plate], degrees), "loop");
        let over = warning(&plan, WarningKind::OverUnwelded).unwrap();
        assert_eq!(plan.summary.forbidden, [over.sentence()], "at {degrees}°");
        assert!(over.total > 45.0 && over.total < 65.0, "{} of 60 mm", over.total);
    }
}

//! Surfaces that are not closed: what they stand for is asked, and one bead runs along those that stand for walls.

use crate::common;
use crate::solids;
use beadwright::fill::StrategyName;

use beadwright::glam::{DMat3, DVec3};
use beadwright::model::{Part, holes};
use beadwright::plan::{self, Plan, PlanError, choice};
use beadwright::profile::Profile;
use beadwright::slice::Surface;
use beadwright::task::Task;
use beadwright::warning::WarningKind;
use beadwright::{Mesh, check};
use common::profile_by;
use solids::{Facet, cuboid, flipped, imported};
use std::f64::consts::{PI, TAU};

const RADIUS: f64 = 60.0;
const HEIGHT: f64 = 40.0;
const STEPS: u32 = 240;

/// A part of the skin of an upright tube, from one angle to another.
fn tube(from: f64, to: f64) -> Vec<Facet> {
    let at = |k: u32, z: f64| {
        let angle = from + (to - from) * f64::from(k) / f64::from(STEPS);
        // The same place, to the last bit, after a whole turn.
        let angle = if to - from == TAU && k == STEPS { from } else { angle };
        DVec3::new(RADIUS * angle.cos(), RADIUS * angle.sin(), z)
    };
    let strip = |k: u32| {
        let [a, b, c, d] = [at(k, 0.0), at(k + 1, 0.0), at(k + 1, HEIGHT), at(k, HEIGHT)];
        [[a, b, c], [a, c, d]]
    };
    (0..STEPS).flat_map(strip).collect()
}

fn turned(facets: &[Facet], angle: f64) -> Mesh {
    let turn = DMat3::from_rotation_z(angle);
    imported(&facets.iter().map(|facet| facet.map(|p| turn * p)).collect::<Vec<_>>()).mesh
}

fn profile(surface: Option<Surface>) -> Profile {
    let mut profile = profile_by("cmt-al2319-kuka", "loop");
    profile.slice.surface = surface;
    profile
}

fn planned(mesh: &Mesh, surface: Surface) -> Plan {
    let import = beadwright::model::Import { mesh: mesh.clone(), ..imported(&cuboid([0.0; 3], [1.0; 3])) };
    let part = Part::Mesh(import);
    let profile = choice::choose(&part, &profile(Some(surface)), false, &Task::new()).unwrap().profile;
    plan::plan("part", &part, &profile, &Task::new()).unwrap()
}

#[test]
fn what_an_open_surface_means_is_asked() {
    for angle in [0.0, 0.4, 2.0] {
        for skin in [tube(0.0, TAU), tube(0.0, 4.0), cuboid([0.0; 3], [40.0, 30.0, 20.0])[2..].to_vec()] {
            match plan::plan("part", &turned(&skin, angle), &profile(None), &Task::new()) {
                Err(error @ PlanError::Open { .. }) => {
                    let said = error.to_string();
                    assert!(
                        said.contains("slice.surface = \"solid\"") && said.contains("slice.surface = \"wall\""),
                        "{said}"
                    );
                }
                other => panic!("{other:?}"),
            }
        }
        // A closed one needs no answer, and takes none.
        let cube = turned(&cuboid([0.0; 3], [40.0, 30.0, 20.0]), angle);
        let plan = |surface| plan::plan("part", &cube, &profile(surface), &Task::new()).unwrap().layers;
        assert_eq!(plan(None), plan(Some(Surface::Solid)));
        assert_eq!(plan(None), plan(Some(Surface::Wall)));
    }
}

#[test]
fn one_bead_runs_along_a_wall_and_a_solid_is_filled() {
    for angle in [0.0, 0.7, 3.0] {
        let whole = turned(&tube(0.0, TAU), angle);
        let wall = planned(&whole, Surface::Wall);
        let chords = f64::from(STEPS) * 2.0 * RADIUS * (PI / f64::from(STEPS)).sin();
        for layer in &wall.layers {
            assert!(matches!(&layer.passes[..], [pass] if pass.closed), "layer {}", layer.index);
            assert!((layer.passes[0].length() / chords - 1.0).abs() < 1e-3, "{}", layer.passes[0].length());
        }
        assert!((wall.layers.last().unwrap().z - HEIGHT).abs() < 2.0);
        let half = planned(&turned(&tube(0.2, 0.2 + PI), angle), Surface::Wall);
        for layer in &half.layers {
            assert!(matches!(&layer.passes[..], [pass] if !pass.closed), "layer {}", layer.index);
            assert!((layer.passes[0].length() / (chords / 2.0) - 1.0).abs() < 1e-3, "{}", layer.passes[0].length());
        }
        assert!(half.summary.warnings.summaries().all(|w| w.kind != WarningKind::OpenContourDropped));
        let solid = planned(&whole, Surface::Solid);
        let disc = PI * RADIUS * RADIUS * solid.layers.len() as f64;
        assert!((solid.summary.metrics.slice_area_mm2 / disc - 1.0).abs() < 1e-3);
        assert!(solid.summary.metrics.coverage() > 0.98);
    }
}

/// A tall wall has no tower: its beads lie on each other, as the model of walls has it.
#[test]
fn a_tall_wall_is_no_tower() {
    let tall: Vec<Facet> = tube(0.0, TAU).iter().map(|facet| facet.map(|p| p * DVec3::new(1.0, 1.0, 5.0))).collect();
    let plan = planned(&turned(&tall, 0.3), Surface::Wall);
    let mut profile = profile(Some(Surface::Wall));
    profile.fill.strategy = StrategyName::Wall;
    let found = check::check(&plan.layers, &profile, plan::deposit_settings(&profile), &Task::new()).unwrap();
    assert!(plan.layers.len() > 100 && found.iter().all(|finding| finding.kind != "towers"), "{found:?}");
}

#[test]
fn a_plan_that_would_lack_part_of_a_solid_is_refused() {
    // A slit, narrower than a bead and wider than what is bridged, from top to bottom of one side.
    let mut faces = cuboid([0.0; 3], [60.0, 40.0, 20.0]);
    faces.retain(|facet| !facet.iter().all(|p| p.x == 60.0));
    let quad = |y: [f64; 2]| {
        let at = |y: f64, z: f64| DVec3::new(60.0, y, z);
        [[at(y[0], 0.0), at(y[1], 0.0), at(y[1], 20.0)], [at(y[0], 0.0), at(y[1], 20.0), at(y[0], 20.0)]]
    };
    faces.extend(quad([0.0, 18.0]));
    faces.extend(quad([20.0, 40.0]));
    for faces in [faces.clone(), flipped(&faces)] {
        let mesh = turned(&faces, 0.3);
        let open = plan::plan("part", &mesh, &profile(None), &Task::new());
        let refused = match open {
            Err(PlanError::Empty(_)) => true,
            Ok(plan) => !plan.summary.forbidden.is_empty(),
            Err(error) => panic!("{error}"),
        };
        assert!(refused);
    }
}

#[test]
fn openings_are_as_wide_as_they_are() {
    let whole = turned(&tube(0.0, TAU), 0.4);
    let found = holes::openings(&whole);
    // Twice the area over the length of a regular polygon is its inner radius.
    let inner = RADIUS * (PI / f64::from(STEPS)).cos();
    assert_eq!(found.len(), 2);
    assert!(found.iter().all(|opening| (opening.width - inner).abs() < 1e-6), "{found:?}");
    let mut box_without_lid = cuboid([0.0; 3], [30.0; 3]);
    box_without_lid.retain(|facet| !facet.iter().all(|p| p.z == 30.0));
    let square = imported(&box_without_lid).mesh;
    let found = holes::openings(&square);
    assert!(matches!(found[..], [one] if (one.width - 15.0).abs() < 1e-9 && (one.length - 120.0).abs() < 1e-9));
    assert_eq!(holes::openings(&imported(&cuboid([0.0; 3], [30.0; 3])).mesh), vec![]);
}

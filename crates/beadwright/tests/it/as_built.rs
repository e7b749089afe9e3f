//! Beads as a solid in space against the part: by closed forms on blocks, and whichever way layers lie.

use crate::common;

use beadwright::as_built::{AsBuilt, as_built};
use beadwright::example;
use beadwright::layer::Layer;
use beadwright::model::{Mesh, solid::Solid};
use beadwright::plan::Plan;
use beadwright::planar::{Polygon, Ring};
use beadwright::profile::{Body, Profile};
use beadwright::task::Task;
use common::profile;
use glam::{DVec2, DVec3};

fn compared(layers: &[Layer], profile: &Profile, mesh: &Mesh) -> AsBuilt {
    as_built(layers, profile, mesh, &Task::new()).unwrap()
}

fn planned(mesh: &Mesh, profile: &Profile) -> Plan {
    common::planned_once("part", mesh, profile).unwrap()
}

/// Fraction of the metal's surface that lies within 0.6 bead heights of the part's.
fn near(built: &AsBuilt, profile: &Profile) -> f64 {
    let reach = 0.6 * profile.bead.height;
    let distances = &built.surface.distances;
    distances.iter().filter(|distance| distance.abs() <= reach).count() as f64 / distances.len() as f64
}

const LENGTH: f64 = 90.0;
const WIDTH: f64 = 60.0;

fn block() -> (Mesh, Profile, Plan) {
    let corners = [(0.0, 0.0), (LENGTH, 0.0), (LENGTH, WIDTH), (0.0, WIDTH)].map(|(x, y)| DVec2::new(x, y));
    let Solid { vertices, triangles } =
        Solid::loft(&Polygon::simple(Ring::new(corners.to_vec())), &[0.0, 20.0], |p, _| p);
    let (mesh, profile) = (Mesh::from_triangles(vertices, triangles).0, profile("cmt-al2319-kuka"));
    let plan = planned(&mesh, &profile);
    (mesh, profile, plan)
}

#[test]
fn metal_moved_aside_shares_with_the_part_what_the_closed_form_says() {
    let (mesh, profile, plan) = block();
    let whole = compared(&plan.layers, &profile, &mesh);
    assert!((whole.part / mesh.volume() - 1.0).abs() < 0.01 && whole.agreement() > 0.97, "{whole:?}");
    for aside in [5.0, 20.0, 2.0 * LENGTH] {
        let mut layers = plan.layers.clone();
        let points = layers.iter_mut().flat_map(|layer| &mut layer.passes).flat_map(|pass| &mut pass.points);
        points.for_each(|p| p.x += aside);
        let moved = compared(&layers, &profile, &mesh);
        let (shared, found) = ((LENGTH - aside).max(0.0) / LENGTH, moved.common / whole.common);
        // Its ends are known to a voxel.
        assert!((found - shared).abs() < 1.2 * moved.step / LENGTH, "{aside}: {found} {shared}");
    }
}

#[test]
fn the_metal_of_a_layer_left_out_is_missing() {
    let (mesh, profile, plan) = block();
    let whole = compared(&plan.layers, &profile, &mesh);
    let mut layers = plan.layers.clone();
    let gone = layers.remove(3);
    let without = compared(&layers, &profile, &mesh);
    let (missing, layer) = (whole.common - without.common, gone.slice_area * gone.height);
    // Its height is known to a voxel.
    assert!((missing - layer).abs() < 1.01 * gone.slice_area * whole.step, "{missing} of {layer}");
    assert!(without.surface.figures.lowest.distance < -5.0, "{:?}", without.surface.figures.lowest);
    assert!(whole.surface.figures.lowest.distance > -2.0, "{:?}", whole.surface.figures.lowest);
}

#[test]
fn beads_lie_where_the_part_is_whichever_way_its_layers_lie() {
    // How much metal and part have in common, and how much of the metal's surface is near that of the part.
    for (name, agreement, surface) in [
        ("hub", 0.97, 0.99),
        ("elbow", 0.985, 0.97),
        ("shaft", 0.96, 0.96),
        ("y-tube", 0.96, 0.96),
        ("dome", 0.985, 0.999),
        ("clad", 0.98, 0.999),
    ] {
        let example = example::find(name).unwrap();
        let (mesh, mut profile) = (example.mesh(), profile("cmt-al2319-kuka"));
        profile.layers.bodies = Body::read(&example.bodies().unwrap()).unwrap();
        let plan = planned(&mesh, &profile);
        let built = compared(&plan.layers, &profile, &mesh);
        let near = near(&built, &profile);
        assert!(built.agreement() > agreement && near > surface, "{name}: {} {near}", built.agreement());
        // What is there already is neither part nor surface; what is welded is the plan's.
        let whole = plan.summary.metrics.mesh_volume_mm3.unwrap();
        assert!((built.part / whole - 1.0).abs() < 0.02, "{name}: {} of {whole}", built.part);
    }
}

#[test]
fn the_agreement_is_the_same_wherever_the_part_lies() {
    let (mesh, profile, plan) = block();
    let whole = compared(&plan.layers, &profile, &mesh);
    let by = DVec3::new(317.3, -911.7, 0.0);
    let (mut mesh, mut layers) = (mesh, plan.layers);
    mesh.vertices.iter_mut().for_each(|p| *p += by);
    let points = layers.iter_mut().flat_map(|layer| &mut layer.passes).flat_map(|pass| &mut pass.points);
    points.for_each(|p| *p += by);
    let moved = compared(&layers, &profile, &mesh);
    assert!((moved.agreement() - whole.agreement()).abs() < 1e-3, "{} {}", moved.agreement(), whole.agreement());
}

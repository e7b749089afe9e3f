//! Never a wrong plan in silence: whatever the part, centre-lines stay inside it and do not cross, and what is not filled is
//! told. Cases that broke the program lie in the shared folder (`BEADWRIGHT_CASES`).
#![allow(clippy::unwrap_used, clippy::panic)]

mod common;
mod families;
mod solids;

use beadwright::Mesh;
use beadwright::fill::{STRATEGIES, sound};
use beadwright::model::import;
use beadwright::pass::Pass;
use beadwright::plan::{self, Plan};
use beadwright::planar::triangulate::triangulate;
use beadwright::planar::{DVec2, Polygon, Ring};
use beadwright::profile::Profile;
use beadwright::slice::LayerFit;
use beadwright::task::Task;
use beadwright::warning::WarningKind;
use common::profile_by;
use families::{FAMILIES, islands};
use rayon::prelude::*;
use solids::Facet;
use std::path::{Path, PathBuf};

fn case(name: &str) -> Vec<u8> {
    let default = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/cases");
    let folder = std::env::var_os("BEADWRIGHT_CASES").map_or_else(default, PathBuf::from);
    let path = folder.join(name);
    std::fs::read(&path)
        .unwrap_or_else(|error| panic!("{}: {error}. BEADWRIGHT_CASES names the folder.", path.display()))
}

fn planned(name: &str, strategy: &str) -> Plan {
    let mesh = import(&case(name), &Task::new()).unwrap().mesh;
    plan::plan(name, &mesh, &profile_by("cmt-al2319-kuka", strategy), &Task::new()).unwrap()
}

fn line(pass: &Pass) -> Vec<DVec2> {
    let again = pass.closed.then(|| pass.points.first()).flatten();
    pass.points.iter().chain(again).map(|p| p.truncate()).collect()
}

/// Greatest distance of a centre-line from the islands, judged at its points and between them, mm.
fn outside(passes: &[Pass], islands: &[Polygon]) -> f64 {
    let to_edges = |p: DVec2| {
        let edges = islands.iter().flat_map(|i| i.rings().flat_map(|ring| ring.edges()).collect::<Vec<_>>());
        let squared = |(a, b)| beadwright::planar::polyline::distance_squared_to_segment(p, a, b);
        edges.map(squared).fold(f64::INFINITY, f64::min).sqrt()
    };
    let places = passes.iter().flat_map(|pass| {
        let line = line(pass);
        line.windows(2).flat_map(|w| (0..8).map(|k| w[0].lerp(w[1], f64::from(k) / 8.0))).collect::<Vec<_>>()
    });
    let left = |p: &DVec2| !islands.iter().any(|island| island.contains(*p));
    places.filter(left).map(to_edges).fold(0.0, f64::max)
}

fn is_sound(plan: &Plan, name: &str) {
    for layer in &plan.layers {
        let by = outside(&layer.passes, &layer.islands);
        assert!(by <= 0.011, "{name}, layer {}: {by} mm outside", layer.index + 1);
        let lines: Vec<Vec<DVec2>> = layer.passes.iter().map(line).collect();
        let crossing = sound::crossings(&lines).next();
        assert_eq!(crossing, None, "{name}, layer {}", layer.index + 1);
    }
}

#[test]
#[cfg_attr(no_models, ignore = "no shared cases")]
fn case_1601_walls_stay_in_a_disk_with_holes() {
    for name in ["disk_6holes.stl", "wall_155m.stl"] {
        let plan = planned(name, "wall");
        is_sound(&plan, name);
        let told = |kind| plan.summary.warnings.summaries().any(|w| w.kind == kind);
        assert!(told(WarningKind::Refilled), "{name}: contours in place of walls are told");
    }
}

#[test]
#[cfg_attr(no_models, ignore = "no shared cases")]
fn case_1602_no_island_is_lost_by_the_strategy() {
    let plan = planned("wall_island_lost.stl", "wall");
    is_sound(&plan, "wall_island_lost");
    assert!(plan.summary.metrics.coverage() > 0.95, "{}", plan.summary.metrics.coverage());
}

#[test]
#[cfg_attr(no_models, ignore = "no shared cases")]
fn case_1603_the_hybrid_does_not_cross_itself() {
    is_sound(&planned("hybrid_crossing.stl", "hybrid"), "hybrid_crossing");
}

#[test]
#[cfg_attr(no_models, ignore = "no shared cases")]
fn case_1604_what_is_left_of_the_height_is_told() {
    let mesh = import(&case("box60x60x2.99.stl"), &Task::new()).unwrap().mesh;
    let plan_by = |fit: LayerFit| {
        let mut profile = profile_by("cmt-al2319-kuka", "loop");
        profile.layers.fit = fit;
        let found = plan::plan("box", &mesh, &profile, &Task::new()).unwrap();
        assert!(!found.layers.iter().any(|layer| layer.passes.is_empty()));
        let sound = |finding: &beadwright::Finding| finding.check != "wire-balance";
        let settings = plan::deposit_settings(&profile);
        assert!(beadwright::check(&found.layers, &profile, settings, &Task::new()).unwrap().iter().all(sound));
        found
    };
    let told = |plan: &Plan| plan.summary.notes.iter().find(|note| note.contains("mm high")).cloned();
    let fixed = plan_by(LayerFit::Fixed);
    assert!(fixed.layers.len() == 1 && told(&fixed).unwrap().contains("0.99 mm (33.1 %) are not built"), "{fixed:?}");
    let last = plan_by(LayerFit::Last);
    assert!(last.layers.len() == 2 && told(&last).unwrap().contains("1.01 mm (33.8 %) above it"));
    let even = plan_by(LayerFit::Even);
    assert!((even.layers.last().unwrap().z - 2.99).abs() < 1e-6 && told(&even).is_none());
    let metal = |plan: &Plan| plan.summary.metrics.deposited_volume_mm3 / plan.summary.metrics.mesh_volume_mm3.unwrap();
    assert!((metal(&even) / (metal(&fixed) * 2.99 / 2.0) - 1.0).abs() < 0.02, "the metal follows the layers' height");
    assert_eq!(even.layers.len(), 2);
}

/// A plan of islands without a mesh: two layers, as they are filled.
fn filled(islands: &[Polygon], profile: &Profile) -> Vec<Vec<Pass>> {
    let mesh = extruded(islands, 2.0 * profile.layers.height);
    match plan::plan("part", &mesh, profile, &Task::new()) {
        Ok(plan) => plan.layers.into_iter().map(|layer| layer.passes).collect(),
        Err(plan::PlanError::Empty(_)) => Vec::new(),
        Err(error) => panic!("{error}"),
    }
}

fn extruded(islands: &[Polygon], height: f64) -> Mesh {
    let walls = |ring: &Ring| {
        let edges: Vec<(DVec2, DVec2)> = ring.edges().collect();
        let (low, high) = (|p: DVec2| p.extend(0.0), move |p: DVec2| p.extend(height));
        edges.into_iter().flat_map(move |(a, b)| [[low(a), low(b), high(b)], [low(a), high(b), high(a)]])
    };
    let caps = |island: &Polygon| {
        let flat: Vec<DVec2> = island.rings().flat_map(|ring| ring.points().to_vec()).collect();
        let at = move |i: usize, z: f64| flat[i].extend(z);
        let both = move |[a, b, c]: [usize; 3]| {
            [[at(a, 0.0), at(c, 0.0), at(b, 0.0)], [at(a, height), at(b, height), at(c, height)]]
        };
        triangulate(island).into_iter().flat_map(both).collect::<Vec<_>>()
    };
    let facets: Vec<Facet> = islands
        .iter()
        .flat_map(|island| caps(island).into_iter().chain(island.rings().flat_map(walls).collect::<Vec<_>>()))
        .collect();
    solids::imported(&facets).mesh
}

/// `BEADWRIGHT_PARTS=2000` tries so many parts of other seeds.
#[test]
fn random_parts_of_eight_families_are_filled_soundly_by_every_strategy() {
    let parts: u64 = std::env::var("BEADWRIGHT_PARTS").ok().and_then(|n| n.parse().ok()).unwrap_or(40);
    let first: u64 = if parts == 40 { 0 } else { 1000 };
    let faults: Vec<String> = (0..parts)
        .into_par_iter()
        .flat_map_iter(|number| {
            let (family, seed) = ((number % 8) as usize, first + number / 8);
            let islands = islands(family, seed);
            let fault = move |strategy: &str| {
                let profile = profile_by("cmt-al2319-kuka", strategy);
                let name = format!("{} {seed} by {strategy}", FAMILIES[family]);
                filled(&islands, &profile).into_iter().enumerate().find_map(|(k, passes)| {
                    let by = outside(&passes, &islands);
                    let lines: Vec<Vec<DVec2>> = passes.iter().map(line).collect();
                    let crossing = sound::crossings(&lines).next();
                    (by > 0.011 || crossing.is_some()).then(|| format!("{name}, layer {k}: {by:.3} mm, {crossing:?}"))
                })
            };
            STRATEGIES.iter().filter_map(|strategy| fault(strategy.name())).collect::<Vec<_>>()
        })
        .collect();
    assert!(faults.is_empty(), "{} of {parts}: {faults:#?}", faults.len());
}

//! Never a wrong plan in silence: whatever the part, centre-lines stay inside it and do not cross, and what is not filled is
//! reported. Cases that broke the program lie in the shared folder (`BEADWRIGHT_CASES`).

use crate::common;
use crate::families;

use beadwright::fill::{StrategyName, sound};
use beadwright::glam::DVec3;
use beadwright::model::import;
use beadwright::plan::{self, Plan};
use beadwright::planar::{DVec2, Polygon, Region, buffer};
use beadwright::profile::Profile;
use beadwright::slice::LayerFit;
use beadwright::task::Task;
use beadwright::warning::WarningKind;
use beadwright::{Layer, Mesh};
use common::{flat, profile_by};
use families::{FAMILIES, extruded, fault, islands, line};
use rayon::prelude::*;
use std::collections::BTreeMap;
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
    common::planned_once(name, &mesh, &profile_by("cmt-al2319-kuka", strategy)).unwrap()
}

fn is_sound(plan: &Plan, name: &str) {
    assert_eq!(plan.layers.iter().find_map(fault), None, "{name}");
}

#[test]
#[cfg_attr(no_models, ignore = "no shared cases")]
fn walls_stay_in_a_disk_with_holes() {
    // Case 1601.
    for name in ["disk_6holes.stl", "wall_155m.stl"] {
        let plan = planned(name, "wall");
        is_sound(&plan, name);
        let reported = |kind| plan.summary.warnings.summaries().any(|w| w.kind == kind);
        assert!(reported(WarningKind::Refilled), "{name}: contours in place of walls are reported");
    }
}

#[test]
#[cfg_attr(no_models, ignore = "no shared cases")]
fn no_island_is_lost_by_the_strategy() {
    // Case 1602.
    let plan = planned("wall_island_lost.stl", "wall");
    is_sound(&plan, "wall_island_lost");
    assert!(plan.summary.metrics.coverage() > 0.95, "{}", plan.summary.metrics.coverage());
}

#[test]
#[cfg_attr(no_models, ignore = "no shared cases")]
fn the_hybrid_does_not_cross_itself() {
    // Case 1603.
    is_sound(&planned("hybrid_crossing.stl", "hybrid"), "hybrid_crossing");
}

#[test]
#[cfg_attr(no_models, ignore = "no shared cases")]
fn what_is_left_of_the_height_is_reported() {
    // Case 1604.
    let mesh = import(&case("box60x60x2.99.stl"), &Task::new()).unwrap().mesh;
    let plan_by = |fit: LayerFit| {
        let mut profile = flat(profile_by("cmt-al2319-kuka", "loop"));
        profile.layers.fit = fit;
        let found = plan::plan("box", &mesh, &profile, &Task::new()).unwrap();
        assert!(!found.layers.iter().any(|layer| layer.passes.is_empty()));
        let sound = |finding: &beadwright::Finding| finding.kind != "wire-balance";
        let settings = plan::deposit_settings(&profile);
        assert!(beadwright::check(&found.layers, &profile, settings, &Task::new()).unwrap().iter().all(sound));
        found
    };
    let reported = |plan: &Plan| plan.summary.notes.iter().find(|note| note.contains("mm high")).cloned();
    let fixed = plan_by(LayerFit::Fixed);
    assert!(
        fixed.layers.len() == 1 && reported(&fixed).unwrap().contains("0.99 mm (33.1 %) are not built"),
        "{fixed:?}"
    );
    let last = plan_by(LayerFit::Last);
    assert!(last.layers.len() == 2 && reported(&last).unwrap().contains("1.01 mm (33.8 %) above it"));
    let even = plan_by(LayerFit::Even);
    assert!((even.layers.last().unwrap().z - 2.99).abs() < 1e-6 && reported(&even).is_none());
    let metal = |plan: &Plan| plan.summary.metrics.deposited_volume_mm3 / plan.summary.metrics.mesh_volume_mm3.unwrap();
    assert!((metal(&even) / (metal(&fixed) * 2.99 / 2.0) - 1.0).abs() < 0.02, "the metal follows the layers' height");
    assert_eq!(even.layers.len(), 2);
    let level = planned("box60x60x2.99.stl", "loop");
    assert!((level.layers.last().unwrap().z - 2.99).abs() < 1e-6 && reported(&level).is_none());
}

/// What changes sides at a vertex crosses, and what touches there does not, at any turn.
#[test]
fn lines_that_change_sides_at_a_common_vertex_cross() {
    let diagonal = [(0.0, 0.0), (5.0, 5.0), (10.0, 10.0)];
    type Points = [(f64, f64)];
    let cases: [(&Points, &Points, bool); 9] = [
        (&diagonal, &[(0.0, 10.0), (5.0, 5.0), (10.0, 0.0)], true),
        (&[(0.0, 0.0), (10.0, 10.0)], &[(0.0, 10.0), (5.0, 5.0), (10.0, 0.0)], true),
        (&diagonal, &[(0.0, 6.0), (5.0, 5.0), (5.1, 4.0)], true),
        (&diagonal, &[(0.0, 10.0), (5.0, 5.0), (4.0, 10.0)], false),
        (&diagonal, &[(0.0, 10.0), (5.0, 5.0)], false),
        (&diagonal, &[(5.0, 5.0), (10.0, 0.0)], false),
        (&diagonal, &[(0.0, 10.0), (5.0, 5.0), (10.0, 10.0)], false),
        (&diagonal, &[(10.0, 10.0), (20.0, 0.0), (0.0, -5.0), (0.0, 0.0)], false),
        (
            &[(20.0, 0.0), (30.0, 0.0)],
            &[(0.0, 0.0), (5.0, 5.0), (10.0, 10.0), (10.0, 0.0), (5.0, 5.0), (0.0, 10.0)],
            true,
        ),
    ];
    for turn in [0.0, 0.3, 1.1, 2.9, 4.0] {
        let line = |points: &[(f64, f64)]| -> Vec<DVec2> {
            points.iter().map(|&p| DVec2::from_angle(turn).rotate(DVec2::from(p))).collect()
        };
        for (one, other, cross) in cases {
            for lines in [[line(one), line(other)], [line(other), line(one)]] {
                let backwards = lines.clone().map(|line| line.into_iter().rev().collect::<Vec<_>>());
                for lines in [&lines, &backwards] {
                    assert_eq!(sound::crossings(lines).next().is_some(), cross, "{one:?} {other:?} turned {turn}");
                }
            }
        }
    }
    // A ring touches itself where it begins.
    let ring: Vec<DVec2> = [(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0), (0.0, 0.0)].map(DVec2::from).to_vec();
    assert_eq!(sound::crossings(&[ring]).next(), None);
}

/// A line that comes back along another and leaves it by a hair beyond does not cross it, however its pieces are divided.
#[test]
fn lines_that_touch_along_a_stretch_do_not_cross() {
    // As the strategy `fermat` lays a star: the second line ends 8 nm beyond the first, then goes back to its own side.
    let first = [(0.0, -5.0), (0.0, 0.0), (10.0, 0.0), (10.0, 5.0)].map(DVec2::from);
    let second = [(20.0, 0.0), (4.0, 8e-6), (3.9, -9.0)].map(DVec2::from);
    let divided = [(20.0, 0.0), (8.0, 6e-6), (4.0, 8e-6), (3.98, -1.8), (3.9, -9.0)].map(DVec2::from);
    for turn in [0.0, 0.3, 1.7] {
        let turned = |line: &[DVec2]| line.iter().map(|p| DVec2::from_angle(turn).rotate(*p)).collect::<Vec<_>>();
        for second in [&second[..], &divided] {
            let lines = [turned(&first[1..3]), turned(second)];
            assert_eq!(sound::crossings(&lines).next(), None, "turned {turn}");
        }
    }
}

/// A pass that begins on the end of another, as where the arc is struck again, does not cross it, however its start is rounded.
#[test]
fn lines_that_begin_on_others_do_not_cross_them() {
    for turn in [0.0, 0.2, 0.3, 0.7, 1.7, 2.9] {
        let way = DVec2::from_angle(turn);
        let bend: Vec<DVec2> =
            [(0.0, 0.0), (3.7, 0.9), (4.4, 1.1), (9.0, 1.3), (9.5, 7.0)].map(|p| way.rotate(DVec2::from(p))).to_vec();
        for share in (1..40).map(|k| f64::from(k) / 40.0) {
            let start = bend[1].lerp(bend[2], share);
            let again = [&[start], &bend[2..], &[way.rotate(DVec2::new(20.0, 7.0))]].concat();
            assert_eq!(sound::crossings(&[bend[..4].to_vec(), again]).next(), None, "turned {turn}, from {share}");
        }
    }
}

/// A bead that runs back along itself, hardly beside itself, crosses itself or does not, whichever way it is welded.
#[test]
fn a_line_crosses_itself_as_often_when_it_is_run_backwards() {
    let fold: Vec<DVec2> = [
        (21.183809051987964, -11.581956683568812),
        (24.902262442272995, -13.766219288629742),
        (24.035080847518525, -13.257438992616148),
        (25.131544085302306, -13.894358948006454),
        (24.572017873335728, -14.83810845256585),
    ]
    .map(DVec2::from)
    .to_vec();
    let back: Vec<DVec2> = fold.iter().rev().copied().collect();
    assert_eq!(sound::crossings(&[fold]).count(), sound::crossings(&[back]).count());
}

/// No bead runs back along itself by more than 0.15 of its width where beads are moved to even out their heights.
#[test]
fn loops_take_no_step_back() {
    for seed in (0..12).chain([7010]) {
        let mesh = extruded(&islands(1, seed), 4.0).unwrap();
        let plan = plan::plan("spiky", &mesh, &flat(profile_by("cmt-al2319-kuka", "loop")), &Task::new()).unwrap();
        for pass in plan.layers.iter().flat_map(|layer| &layer.passes) {
            for corner in line(pass).windows(3) {
                let (before, after) = (corner[1] - corner[0], corner[2] - corner[1]);
                let turn = before.angle_to(after).abs().to_degrees();
                let is_step = before.length().min(after.length()) > 0.15 * pass.width.after(0);
                assert!(!is_step || turn < 165.0, "{seed}: {turn:.1} degrees at {}", corner[1]);
            }
        }
    }
}

/// Where the hybrid cannot, the best of the other strategies fills, with hardly more arc starts than islands.
#[test]
#[cfg_attr(no_models, ignore = "no shared cases")]
fn islands_that_the_hybrid_cannot_fill_are_filled_well_all_the_same() {
    for name in ["blob_40", "comb_14", "holes_66", "holes_98", "near_holes_45"] {
        let plan = planned(&format!("hybrid_crossing_{name}.stl"), "hybrid");
        is_sound(&plan, name);
        let islands: usize = plan.layers.iter().map(|layer| layer.islands.len()).sum();
        assert!(plan.summary.metrics.passes <= 6 * islands, "{name}: {}", plan.summary.metrics.passes);
        assert!(plan.summary.metrics.coverage() > 0.88, "{name}: {}", plan.summary.metrics.coverage());
    }
}

/// Bare strips at the rim are said, however narrow the part.
#[test]
#[cfg_attr(no_models, ignore = "no shared cases")]
fn what_is_left_bare_is_said() {
    for name in ["bare_near_boxes_4", "bare_near_boxes_60", "bare_near_holes_37", "bare_slivers_99"] {
        for strategy in ["loop", "hybrid", "zigzag"] {
            let plan = planned(&format!("{name}.stl"), strategy);
            for layer in &plan.layers {
                let said = |w: &beadwright::warning::Warning| {
                    [WarningKind::Bare, WarningKind::ThinFeature, WarningKind::IslandTooSmall].contains(&w.kind)
                };
                let left = 1.0 - layer.planned_area / layer.slice_area;
                assert!(left < 0.03 || layer.warnings.iter().any(said), "{name} by {strategy}: {left:.3} bare");
            }
        }
    }
}

/// Lengths and areas of a plan: what must not depend on where the part lies or how its file is ordered. Metal is shared out in the
/// same way for all strategies: one of them shows that.
fn figures(mesh: &Mesh, strategy: &str) -> [f64; 4] {
    let profile = profile_by("cmt-al2319-kuka", strategy);
    let profile = if strategy == "contour" { profile } else { flat(profile) };
    let m = plan::plan("part", mesh, &profile, &Task::new()).unwrap().summary.metrics;
    [m.passes as f64, m.deposited_length_mm, m.slice_area_mm2, m.planned_area_mm2]
}

#[test]
fn plans_do_not_depend_on_where_a_part_lies_or_how_its_triangles_are_ordered() {
    for (family, seed) in [(0, 3), (2, 5), (6, 4)] {
        let mesh = extruded(&islands(family, seed), 4.0).unwrap();
        let changed = |change: &dyn Fn(DVec3) -> DVec3, mirrored: bool| {
            let vertices = mesh.vertices.iter().map(|v| change(*v)).collect();
            let turned = |[a, b, c]: [u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
            Mesh::from_triangles(vertices, mesh.triangles.iter().map(|t| turned(*t)).collect()).0
        };
        let mut order: Vec<[u32; 3]> = mesh.triangles.iter().rev().map(|[a, b, c]| [*c, *a, *b]).collect();
        let half = order.len() / 2;
        order.rotate_left(half);
        let shuffled = Mesh::from_triangles(mesh.vertices.clone(), order).0;
        let moved = changed(&|v| v + DVec3::new(123.4, -56.7, 0.0), false);
        let quarter = changed(&|v| DVec3::new(-v.y, v.x, v.z), false);
        let mirrored = changed(&|v| DVec3::new(-v.x, v.y, v.z), true);
        for strategy in ["contour", "loop", "hybrid", "wall"] {
            let same = figures(&mesh, strategy);
            for (what, other) in
                [("shuffled", &shuffled), ("moved", &moved), ("turned", &quarter), ("mirrored", &mirrored)]
            {
                let found = figures(other, strategy);
                let near = |(a, b): (&f64, &f64), part: f64| (a - b).abs() <= part * a.abs();
                // What lies on the part is the same; the way along it may begin elsewhere.
                assert!(near((&same[2], &found[2]), 1e-6), "{family} {strategy} {what}: {same:?} {found:?}");
                assert!(near((&same[3], &found[3]), 0.02), "{family} {strategy} {what}: {same:?} {found:?}");
                assert!(near((&same[1], &found[1]), 0.05), "{family} {strategy} {what}: {same:?} {found:?}");
            }
        }
    }
}

/// Why a part of islands cannot be welded as planned, or what it loses without a word.
fn wrong(islands: &[Polygon], profile: &Profile) -> Option<String> {
    let mesh = extruded(islands, 2.0 * profile.layers.height)?;
    let plan = match plan::plan("part", &mesh, profile, &Task::new()) {
        Ok(plan) => plan,
        Err(plan::PlanError::Empty(_)) => return None,
        Err(error) => return Some(error.to_string()),
    };
    plan.layers.iter().find_map(|layer| fault(layer).or_else(|| untold(layer)))
}

/// Where the area that a layer is said to cover is wrong by more than 1 %, measured with polygons instead of rows.
fn untold(layer: &Layer) -> Option<String> {
    // Pieces of one width, to a hundredth of a millimetre, are buffered together.
    let mut pieces: BTreeMap<i64, Vec<Vec<DVec2>>> = BTreeMap::new();
    for pass in &layer.passes {
        for (i, piece) in line(pass).windows(2).enumerate() {
            let width = (100.0 * pass.width.after(i)).round() as i64;
            pieces.entry(width).or_default().push(piece.to_vec());
        }
    }
    let footprint = |(width, lines): (&i64, &Vec<Vec<DVec2>>)| buffer(lines, false, 0.00505 * *width as f64, 0.02);
    let beads = pieces.iter().map(footprint).reduce(|a, b| a.union(&b)).unwrap_or_default();
    let area: f64 = layer.islands.iter().map(Polygon::area).sum();
    let covered = area - Region::from_normalised(layer.islands.clone()).difference(&beads).area();
    let said = layer.planned_area;
    ((covered - said).abs() > 0.01 * area)
        .then(|| format!("layer {}: {covered:.1} covered, {said:.1} said", layer.index))
}

/// Rings in rings: thin strips along their edges stay bare, and rows along an edge would count them in whole rows.
#[test]
fn bare_strips_along_the_edges_of_polygons_are_measured_as_they_are() {
    let fault = wrong(&islands(7, 8011), &profile_by("cmt-al2319-kuka", "contour"));
    assert_eq!(fault, None);
}

/// What much is left bare of is measured on closer rows: strips thinner than the rows' distance make a difference there.
#[test]
fn strips_along_thin_rings_are_measured_as_they_are() {
    for (seed, strategy) in [(20036, "contour"), (20068, "loop"), (20083, "loop"), (113_006, "loop")] {
        let fault = wrong(&islands(6, seed), &profile_by("cmt-al2319-kuka", strategy));
        assert_eq!(fault, None, "{seed}");
    }
}

/// A pass that touches others where beads of thin places are tied to it keeps a width for each of its pieces, however short
/// they are.
#[test]
fn tied_passes_have_a_width_at_every_point() {
    let fault = wrong(&islands(5, 20060), &flat(profile_by("cmt-al2319-kuka", "hybrid")));
    assert_eq!(fault, None);
}

/// `BEADWRIGHT_PARTS=2000` tries that many parts, `BEADWRIGHT_SEED=1000` others.
#[test]
fn random_parts_of_eight_families_are_filled_soundly_by_every_strategy() {
    let parts: u64 = std::env::var("BEADWRIGHT_PARTS").ok().and_then(|n| n.parse().ok()).unwrap_or(16);
    let first: u64 = std::env::var("BEADWRIGHT_SEED").ok().and_then(|n| n.parse().ok()).unwrap_or(0);
    let faults: Vec<String> = (0..parts)
        .into_par_iter()
        .flat_map_iter(|number| {
            let (family, seed) = ((number % 8) as usize, first + number / 8);
            let islands = islands(family, seed);
            let wrong = move |strategy: &str| {
                // As the strategy fills them, and once the metal is shared out.
                let level = profile_by("cmt-al2319-kuka", strategy);
                let why = wrong(&islands, &flat(level.clone())).or_else(|| wrong(&islands, &level))?;
                Some(format!("{} {seed} by {strategy}, {why}", FAMILIES[family]))
            };
            StrategyName::ALL.iter().filter_map(|strategy| wrong(strategy.name())).collect::<Vec<_>>()
        })
        .collect();
    assert!(faults.is_empty(), "{} of {parts}: {faults:#?}", faults.len());
}

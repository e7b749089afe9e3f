//! Parts that are welded one after another: their layers, the ways between them, and room for the torch.

use beadwright::example;
use beadwright::fill::StrategyName;
use beadwright::model::together::{Arrangement, arrange};
use beadwright::model::{Import, Placement, import};
use beadwright::plan::{self, Collect, PlanError, Summary};
use beadwright::profile::Profile;
use beadwright::program::Instruction;
use beadwright::task::Task;
use glam::DVec3;

fn profile() -> Profile {
    let mut profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    profile.fill.strategy = StrategyName::Contour;
    profile
}

/// A block with its low corner there, mm.
fn block(size: DVec3, at: DVec3) -> Import {
    let corner = |k: usize| at + size * DVec3::new((k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2) as f64);
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let facets = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).map(|t| t.map(corner));
    let bytes = beadwright::model::stl::write("block", facets);
    let placement = Placement { units: Some(beadwright::model::Units::Millimetre), ..Placement::default() };
    placement.solid(import(&bytes, &Task::new()).unwrap(), 5.0).unwrap()
}

fn planned(parts: &[(String, Import)], profile: &Profile) -> (Collect, Summary) {
    let meshes: Vec<_> = parts.iter().map(|(name, import)| (name.clone(), import.into())).collect();
    let mut collect = Collect::default();
    let summary = plan::parts_into("build", &meshes, profile, &Task::new(), &mut collect).unwrap();
    (collect, summary)
}

/// Blocks of these heights, mm, in a row with that gap.
fn blocks(heights: &[f64], gap: f64) -> Vec<(String, Import)> {
    let side = 30.0;
    let at = |k: usize| DVec3::new(k as f64 * (side + gap), 0.0, 0.0);
    let block = |(k, &height): (usize, &f64)| (format!("part{}", k + 1), block(DVec3::new(side, side, height), at(k)));
    heights.iter().enumerate().map(block).collect()
}

#[test]
fn each_part_is_finished_before_the_next() {
    let profile = profile();
    let imports = ["cross", "gear", "star"].map(|name| {
        let stl = example::find(name).unwrap().stl();
        let solid = Placement::default().solid(import(&stl, &Task::new()).unwrap(), 5.0).unwrap();
        (name.to_owned(), solid)
    });
    let (parts, places) = arrange(imports.to_vec(), Arrangement::Rows { gap: 60.0 }).unwrap();
    let (build, summary) = planned(&parts, &profile);
    assert_eq!(build.header.unwrap().extent.layers, build.layers.len());
    assert!(build.layers.iter().enumerate().all(|(k, layer)| layer.index == k));
    let mut first = 0;
    let mut length = 0.0;
    for ((name, import), (_, place)) in parts.iter().zip(&places) {
        // The layers that the part has alone, where it stands.
        let alone = plan::plan(name, &import.mesh, &profile, &Task::new()).unwrap();
        length += alone.summary.metrics.deposited_length_mm;
        for (own, all) in alone.layers.iter().zip(&build.layers[first..]) {
            assert_eq!((own.z, &own.islands), (all.z, &all.islands), "{name}");
            let inside = |p: &DVec3| p.truncate().cmpge(place.min).all() && p.truncate().cmple(place.max).all();
            assert!(all.passes.iter().flat_map(|pass| &pass.points).all(inside), "{name}");
        }
        first += alone.layers.len();
        assert!(summary.notes[0].contains(&format!("{name} (layers ")), "{}", summary.notes[0]);
    }
    assert_eq!(first, build.layers.len());
    assert!((summary.metrics.deposited_length_mm - length).abs() < 1e-6 * length);
    assert!(summary.forbidden.is_empty(), "{:?}", summary.forbidden);
}

/// Followed move by move: with the arc off the tip never gets below the top of a part that it flies over.
#[test]
fn ways_lead_over_everything_built() {
    let (clearance, side, gap) = (20.0, 30.0, 80.0);
    let profile = profile();
    assert_eq!(profile.travel.clearance, clearance);
    // The way from the second to the third is free, that from the third to the fourth leads over the second.
    for order in [[40.0, 12.0, 24.0, 8.0], [8.0, 12.0, 24.0, 40.0], [2.0, 2.0, 2.0, 2.0]] {
        let mut parts = blocks(&order, gap);
        parts.swap(1, 3);
        let (build, _) = planned(&parts, &profile);
        let mut programmer = profile.programmer();
        let (mut at, mut stands) = (None::<DVec3>, Vec::<(DVec3, DVec3)>::new());
        for layer in &build.layers {
            let mut welded = Vec::new();
            for step in programmer.layer(layer).instructions {
                let Some(to) = step.target() else { continue };
                let weld = matches!(step, Instruction::Weld { .. });
                if let Some(from) = at.filter(|_| !weld) {
                    for k in 0..=200 {
                        let place = from.lerp(to, f64::from(k) / 200.0);
                        let hit = stands.iter().find(|(low, high)| {
                            place.cmpgt(*low).all() && place.cmplt(*high).all() && place.z < high.z - 1e-6
                        });
                        assert!(hit.is_none(), "{order:?}: at {place} in {hit:?}");
                    }
                }
                if weld {
                    welded.push(to);
                }
                at = Some(to);
            }
            let low = welded.iter().fold(DVec3::INFINITY, |a, b| a.min(*b));
            let high = welded.iter().fold(DVec3::NEG_INFINITY, |a, b| a.max(*b));
            stands.push((low.with_z(0.0), high));
        }
        assert!(stands.len() >= 4 && stands.iter().all(|(low, high)| (high - low).x < side));
    }
}

/// By hand: a cone of 45° from a nozzle 10 mm wide, 10 mm above the wire's tip.
#[test]
fn the_torch_has_room_or_the_plan_is_forbidden() {
    let mut profile = profile();
    // All beads are of the nominal width.
    profile.layers.level = false;
    profile.torch = Some(beadwright::process::TorchShape { nozzle_radius: 10.0, stick_out: 10.0, cone: 45.0 });
    let needs = |tallest: f64, first: f64| tallest - first;
    for gap in [20.0, 30.0, 40.0, 50.0, 60.0] {
        let (build, summary) = planned(&blocks(&[40.0, 20.0], gap), &profile);
        let top = build.layers.iter().map(|layer| layer.z).fold(0.0, f64::max);
        let extent = |from: f64, to: f64| {
            let inside = |p: &&DVec3| p.x > from && p.x < to;
            let points: Vec<DVec3> =
                build.layers.iter().flat_map(|l| &l.passes).flat_map(|p| p.points.clone()).collect();
            let x = || points.iter().filter(inside).map(|p| p.x);
            (x().fold(f64::INFINITY, f64::min), x().fold(f64::NEG_INFINITY, f64::max))
        };
        let metal = extent(-1.0, 30.0 + gap / 2.0).1 + profile.bead.width / 2.0;
        let has = extent(30.0 + gap / 2.0, 1e3).0 - metal;
        // The tip is lowest in the first layer: the cone is widest at the top of what stands.
        let free = has >= needs(top, build.layers[0].z);
        assert_eq!(summary.forbidden.is_empty(), free, "{gap}: {has} {top} {:?}", summary.forbidden);
        if let Some(sentence) = summary.forbidden.first() {
            let lacks = (needs(top, build.layers[0].z) - has).ceil();
            assert!(sentence.contains("would hit part1 while it welds part2"), "{sentence}");
            assert!(sentence.contains(&format!("{lacks:.0} mm farther apart")), "{sentence}");
        }
        // The lower one first: nothing stands above the wire, but for the nozzle.
        let (_, summary) = planned(&blocks(&[10.0, 40.0], gap), &profile);
        assert!(summary.forbidden.is_empty(), "{gap}: {:?}", summary.forbidden);
    }
}

#[test]
fn what_is_not_known_is_asked_for() {
    let parts = blocks(&[10.0, 10.0], 30.0);
    let meshes: Vec<_> = parts.iter().map(|(name, import)| (name.clone(), import.into())).collect();
    let mut profile = profile();
    profile.torch = None;
    let refused = plan::parts_into("build", &meshes, &profile, &Task::new(), &mut Collect::default()).unwrap_err();
    assert!(matches!(&refused, PlanError::Parts(_)) && refused.to_string().contains("[torch]"), "{refused}");
}

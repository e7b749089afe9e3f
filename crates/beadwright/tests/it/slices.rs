//! Slices of real parts that the default strategy filled badly: each must be filled by the loop itself, at any angle.

use crate::common;
use crate::families;

use beadwright::fill::coverage::Coverage;
use beadwright::fill::sound::{self, Fault};
use beadwright::fill::{Path, StrategyName};
use beadwright::planar::{DVec2, Join, Polygon, Region, Ring};
use common::profile;
use std::path::PathBuf;

#[derive(serde::Deserialize)]
struct Island {
    outline: Vec<[f64; 2]>,
    holes: Vec<Vec<[f64; 2]>>,
}

#[derive(serde::Deserialize)]
struct Slice {
    islands: Vec<Island>,
}

fn cases() -> PathBuf {
    let default = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/cases");
    std::env::var_os("BEADWRIGHT_CASES").map_or_else(default, PathBuf::from)
}

/// The islands of a slice, turned.
fn islands(name: &str, degrees: f64) -> Vec<Polygon> {
    let way = DVec2::from_angle(degrees.to_radians());
    let text = std::fs::read_to_string(cases().join("slices").join(format!("{name}.json"))).unwrap();
    let slice: Slice = serde_json::from_str(&text).unwrap();
    let ring = |points: &Vec<[f64; 2]>| Ring::new(points.iter().map(|&p| way.rotate(p.into())).collect());
    let polygon = |i: &Island| Polygon { outer: ring(&i.outline), holes: i.holes.iter().map(ring).collect() };
    slice.islands.iter().map(polygon).collect()
}

/// What the loop lays into a slice.
struct Laid {
    starts: usize,
    /// Part of the area that stays bare.
    bare: f64,
    faults: Vec<Fault>,
}

fn laid(name: &str, degrees: f64) -> Laid {
    let profile = profile("cmt-al2319-kuka");
    let settings = profile.fill_settings(0);
    let (mut laid, mut area, mut bare) = (Laid { starts: 0, bare: 0.0, faults: Vec::new() }, 0.0, 0.0);
    for island in islands(name, degrees) {
        let fill = StrategyName::Loop.strategy().fill(&island, &settings);
        let paths: Vec<&Path> = fill.stages.iter().flatten().collect();
        let whole = Region::from(island.clone());
        laid.starts += paths.len();
        area += island.area();
        bare += Coverage::of(&paths, &whole, profile.bead.width).map_or(island.area(), |c| c.bare().area);
        laid.faults.extend(sound::fault(&paths, &island, settings.machining_allowance));
    }
    laid.bare = bare / area;
    laid
}

/// The loop fills slices by itself, with no more starts than that, and leaves no more than that part bare: fits in
/// no corner, and in no wall thinner than the narrowest bead.
fn is_filled(slices: &[(&str, usize, f64)]) {
    for &(name, starts, bare) in slices {
        for degrees in [0.0, 17.0, 45.0, 90.0, 133.0, 270.0] {
            let laid = laid(name, degrees);
            println!("{name} at {degrees}°: {} starts, {:.2} % bare", laid.starts, 100.0 * laid.bare);
            assert_eq!(laid.faults, [], "{name} at {degrees}°");
            assert!(laid.starts <= starts, "{name} at {degrees}°: {} starts", laid.starts);
            assert!(laid.bare <= bare, "{name} at {degrees}°: {:.2} % bare", 100.0 * laid.bare);
        }
    }
}

#[test]
#[cfg_attr(no_cases, ignore = "needs the shared cases")]
fn plain_ovals_are_one_pass() {
    is_filled(&[("Y_L64", 1, 0.01), ("Y_L66", 1, 0.01), ("hand_L86", 1, 0.02)]);
}

#[test]
#[cfg_attr(no_cases, ignore = "needs the shared cases")]
fn hubs_are_one_pass_beside_their_blades() {
    is_filled(&[("bladex_r0_L31", 6, 0.15), ("bladex_r0_L44", 6, 0.055), ("openthr_r0_L38", 8, 0.015)]);
}

#[test]
#[cfg_attr(no_cases, ignore = "needs the shared cases")]
fn plates_with_holes_are_filled_by_loops() {
    is_filled(&[
        ("feature_r0_L1", 3, 0.05),
        ("feature_r0_L6", 4, 0.05),
        ("fr13_L18", 1, 0.045),
        ("branches70_L1", 1, 0.003),
    ]);
}

#[test]
#[cfg_attr(no_cases, ignore = "needs the shared cases")]
fn rings_with_teeth_are_filled_by_loops() {
    is_filled(&[("diff_ring_L6", 2, 0.015), ("diff_ring_L8", 40, 0.215), ("rear_x2_r0_L15", 3, 0.01)]);
}

/// Wide enough for one wide bead, though not for two.
#[test]
#[cfg_attr(no_cases, ignore = "needs the shared cases")]
fn an_island_for_one_wide_bead_has_one() {
    is_filled(&[("hand_L79", 3, 0.065)]);
}

/// A ring one bead thick with teeth outside, turned; `cut` takes a sector out of it.
fn toothed_ring(thick: f64, tooth: f64, cut: bool, degrees: f64) -> Polygon {
    let (teeth, inner) = (20, 14.0);
    let way = DVec2::from_angle(degrees.to_radians());
    let outer = (0..4 * teeth).map(|k| {
        let radius = inner + thick + if k % 4 < 2 { 0.0 } else { tooth };
        way.rotate(DVec2::from_angle(std::f64::consts::TAU * (f64::from(k) + 0.5) / f64::from(4 * teeth)) * radius)
    });
    let hole = (0..90).map(|k| DVec2::from_angle(-f64::from(k) * std::f64::consts::TAU / 90.0) * inner);
    let ring = Polygon { outer: Ring::new(outer.collect()), holes: vec![Ring::new(hole.collect())] };
    let corners = [(0.0, -2.0), (60.0, -2.0), (60.0, 2.0), (0.0, 2.0)].map(|(x, y)| way.rotate(DVec2::new(x, y)));
    let gap = Region::from(Polygon::simple(Ring::new(corners.to_vec())));
    let region = if cut { Region::from(ring).difference(&gap) } else { ring.into() };
    region.into_polygons().remove(0)
}

/// Teeth cut the middle of a wall into short pieces; the wall is welded all the same, in one pass.
#[test]
fn a_toothed_ring_one_bead_thick_is_welded_all_around() {
    let profile = profile("cmt-al2319-kuka");
    let settings = profile.fill_settings(0);
    for (thick, tooth, cut) in
        [(8.0, 1.5, false), (8.0, 1.5, true), (5.0, 1.2, false), (5.0, 1.2, true), (5.4, 5.0, false), (9.0, 5.0, true)]
    {
        for degrees in [0.0, 17.0, 45.0, 90.0] {
            let island = toothed_ring(thick, tooth, cut, degrees);
            let fill = StrategyName::Loop.strategy().fill(&island, &settings);
            let paths: Vec<&Path> = fill.stages.iter().flatten().collect();
            let case = format!("{thick} {tooth} {cut} at {degrees}°");
            let [path] = &paths[..] else { panic!("{case}: {} passes", paths.len()) };
            let around = path.length() / (std::f64::consts::TAU * (14.0 + thick / 2.0));
            assert!(path.closed != cut && around > if cut { 0.85 } else { 0.95 }, "{case}: {around} of the way around");
            assert!(sound::fault(&paths, &island, 0.0).is_none_or(|f| matches!(f, Fault::Outside { .. })), "{case}");
        }
    }
}

/// A plate with eight holes a quarter of a bead from its rim, and a slot in each end, turned.
fn holed_plate(degrees: f64) -> Polygon {
    let way = DVec2::from_angle(degrees.to_radians());
    let ring = |points: Vec<DVec2>| Ring::new(points.into_iter().map(|p| way.rotate(p)).collect());
    let corners = [(-63.5, -31.75), (63.5, -31.75), (63.5, 31.75), (-63.5, 31.75)].map(DVec2::from);
    let slot = |x: f64, end: f64| {
        let sides = [(x, -17.5), (end, -17.5), (end, 17.5), (x, 17.5)].map(DVec2::from);
        Region::from(Polygon::simple(Ring::new(sides.to_vec())))
    };
    let rounded = |slot: Region, radius: f64| slot.offset(-radius, Join::ROUND).offset(radius, Join::ROUND);
    let slots = [rounded(slot(-90.0, -46.8), 12.7), rounded(slot(48.1, 90.0), 3.2)];
    let plate = Region::from(Polygon::simple(Ring::new(corners.to_vec())));
    let cut = plate.difference(&slots[0]).difference(&slots[1]).into_polygons().remove(0);
    let hole = |x: f64, y: f64| {
        let at = |k: i32| DVec2::new(x, y) + 5.556 * DVec2::from_angle(-f64::from(k) * std::f64::consts::TAU / 36.0);
        ring((0..36).map(at).collect())
    };
    let holes = [-57.1, -28.5, 0.1, 28.7].into_iter().flat_map(|x| [hole(x, -25.4), hole(x, 25.4)]).collect();
    Polygon { outer: ring(cut.outer.into_points()), holes }
}

/// Small rings before the necks lie across the loop: they are left out, and no other strategy takes its place.
#[test]
fn plates_with_holes_close_to_their_rim_are_filled_by_the_loop() {
    use beadwright::{plan, task::Task, warning::WarningKind};
    let profile = profile("cmt-al2319-kuka");
    for degrees in [0.0, 10.0, 30.0, 45.0, 77.0, 90.0, 133.0, 200.0, 270.0, 310.0] {
        let mesh = families::extruded(&[holed_plate(degrees)], 2.0 * profile.layers.height).unwrap();
        let plan = plan::plan("plate", &mesh, &profile, &Task::new()).unwrap();
        let passes = plan.layers.iter().map(|layer| layer.passes.len()).max();
        let refilled = plan.summary.warnings.summaries().any(|warning| warning.kind == WarningKind::Refilled);
        assert!(!refilled && passes.is_some_and(|passes| passes <= 2), "{degrees}°: {refilled}, {passes:?} passes");
    }
}

/// What stands on a small island needs its metal: its only pass is welded however short, and a check says that it is.
#[test]
fn the_only_pass_of_an_island_is_kept() {
    use beadwright::{check, plan, task::Task};
    let profile = profile("cmt-al2319-kuka");
    let block = |length: f64, degrees: f64| {
        let way = DVec2::from_angle(f64::to_radians(degrees));
        let corners = [(0.0, 0.0), (length, 0.0), (length, 8.0), (0.0, 8.0)];
        let ring = Ring::new(corners.map(|(x, y)| way.rotate(DVec2::new(x, y))).to_vec());
        families::extruded(&[Polygon::simple(ring)], 10.0).unwrap()
    };
    for degrees in [0.0, 30.0] {
        for length in [12.0, 14.0, 20.0] {
            let plan = plan::plan("block", &block(length, degrees), &profile, &Task::new()).unwrap();
            assert!(plan.layers.iter().all(|layer| layer.passes.len() == 1), "{length} mm at {degrees}°");
            let findings =
                check::check(&plan.layers, &profile, plan::deposit_settings(&profile), &Task::new()).unwrap();
            let is_short = findings.iter().any(|finding| finding.kind == "short-pass");
            assert_eq!(is_short, length < 15.0, "{length} mm at {degrees}°: {findings:?}");
        }
    }
}

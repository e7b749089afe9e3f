//! Printers: raster angle, merged sub-regions, sparse infill, flow, and the G-code read back.

use crate::common;

use crate::readers;
use crate::solids;
use common::{model, profile};

use beadwright::dialect;
use beadwright::dialect::marlin::BedOrigin;
use beadwright::dialect::reading::{self, Options};
use beadwright::example;
use beadwright::fill::compound::Compound;
use beadwright::fill::zigzag::regions::Weave;
use beadwright::fill::{FillSettings, Strategy as _, angle};
use beadwright::layer::{Extent, Layer};
use beadwright::model::import;
use beadwright::pass::{Pass, PassKind};
use beadwright::plan::{self, Plan};
use beadwright::planar::scan::{Scan, Spacing};
use beadwright::planar::turns::ends_at;
use beadwright::planar::{DVec2, FillRule, Join, Polygon, Region, Ring};
use beadwright::profile::{Profile, RasterTurn};
use beadwright::slice::Slicer;
use beadwright::task::Task;
use proptest::prelude::*;
use solids::runner;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A small part: a fifth of an example.
fn plan_of(part: &str, profile: &Profile) -> Plan {
    let mut mesh = example::find(part).unwrap().mesh();
    mesh.place(0.2, glam::DVec3::ZERO);
    common::planned_once(part, &mesh, profile).unwrap()
}

fn gcode(plan: &Plan, profile: &Profile) -> String {
    dialect::write("marlin", &plan.layers, &profile.job("part")).unwrap().into_values().collect()
}

#[test]
fn filament_is_the_deposited_volume() {
    for (part, relative) in [("plate", true), ("plate", false), ("gear", true), ("star", false)] {
        let mut profile = profile("fdm-abs-0.4");
        profile.dialects.marlin.as_mut().unwrap().relative_extrusion = relative;
        let plan = plan_of(part, &profile);
        let print = readers::marlin::run(&gcode(&plan, &profile));
        let volume = print.filament * PI * profile.wire.diameter * profile.wire.diameter / 4.0;
        let metrics = &plan.summary.metrics;
        assert!((volume / metrics.deposited_volume_mm3 - 1.0).abs() < 1e-3, "{part}: {volume} mm³");
        // The strand is 0.4 × 0.2 mm along its whole length, and fills the part.
        assert!((volume / (metrics.deposited_length_mm * 0.4 * 0.2) - 1.0).abs() < 1e-3, "{part}: {volume} mm³");
        // A plate of 24 mm is much edge: larger parts come within 1 % (benches/fdm_peers.sh).
        assert!((volume / metrics.part_volume_mm3 - 1.0).abs() < 0.025, "{part}: {volume} mm³");
        assert_eq!(print.paths.len(), metrics.passes, "{part}");
        assert!((print.travel / metrics.travel_length_mm - 1.0).abs() < 0.01, "{part}");
        assert!(print.drawn_back > 0.0);
    }
}

#[test]
fn our_own_reader_reads_the_same() {
    let profile = profile("fdm-abs-0.4");
    let plan = plan_of("plate", &profile);
    let program = reading::read(&gcode(&plan, &profile), &mut |_| None, &Options::default()).unwrap();
    let (totals, metrics) = (program.totals(), &plan.summary.metrics);
    assert_eq!(totals.arc_starts, metrics.passes);
    assert!((totals.deposited_length_mm - metrics.deposited_length_mm).abs() < 1e-3 * metrics.deposited_length_mm);
    assert!((totals.volume_mm3.unwrap() / metrics.deposited_volume_mm3 - 1.0).abs() < 2e-3);
    let time = program.seconds(&profile.motion.unwrap());
    assert!((time / metrics.total_time_s - 1.0).abs() < 0.01, "{time} s for {} s", metrics.total_time_s);
}

/// Wherever a part lies, its middle is that of the bed; coordinates start at the corner or in the middle.
#[test]
fn parts_come_to_the_middle_of_the_bed() {
    let mut mesh = example::find("plate").unwrap().mesh();
    mesh.place(0.3, glam::DVec3::ZERO);
    let mut profile = profile("fdm-abs-0.4");
    for (shift, origin, middle) in [
        (DVec2::ZERO, BedOrigin::Corner, DVec2::splat(110.0)),
        (DVec2::new(-712.5, 3000.0), BedOrigin::Corner, DVec2::splat(110.0)),
        (DVec2::new(40.0, 40.0), BedOrigin::Centre, DVec2::ZERO),
    ] {
        let mut moved = mesh.clone();
        moved.vertices.iter_mut().for_each(|vertex| *vertex += shift.extend(0.0));
        profile.dialects.marlin.as_mut().unwrap().bed.as_mut().unwrap().origin = origin;
        let plan = plan::plan("plate", &moved, &profile, &Task::new()).unwrap();
        let program = reading::read(&gcode(&plan, &profile), &mut |_| None, &Options::default()).unwrap();
        let laid = program.moves.iter().filter(|step| step.metal.is_laid());
        let (low, high) = laid.fold((glam::DVec3::INFINITY, glam::DVec3::NEG_INFINITY), |(low, high), step| {
            (low.min(step.to), high.max(step.to))
        });
        let found = ((low + high) / 2.0).truncate();
        assert!(found.distance(middle) < 0.3, "{shift}, {origin:?}: {found}");
    }
}

#[test]
fn parts_that_do_not_fit_on_the_bed_are_refused() {
    let plan = plan_of("plate", &profile("fdm-abs-0.4"));
    let refused = |size: [f64; 3]| {
        let mut profile = profile("fdm-abs-0.4");
        profile.dialects.marlin.as_mut().unwrap().bed.as_mut().unwrap().size = size;
        dialect::write("marlin", &plan.layers, &profile.job("plate")).err().map(|error| error.to_string())
    };
    let size = Extent::of(&plan.layers).size();
    assert_eq!(refused([size.x + 0.1, size.y + 0.1, size.z + 0.1]), None);
    for axis in 0..3 {
        let mut small = [300.0; 3];
        small[axis] = size[axis] - 0.1;
        let said = refused(small).unwrap();
        assert!(said.contains("marlin.bed") && said.contains(&format!("{:.1}", size.x)), "{said}");
    }
}

#[test]
fn contours_come_before_the_fill() {
    let plan = plan_of("plate", &profile("fdm-abs-0.4"));
    for layer in &plan.layers {
        assert!(layer.passes.is_sorted_by_key(|p| p.kind == PassKind::Infill));
        assert_eq!(layer.passes.iter().filter(|p| p.kind == PassKind::Contour).count(), 6, "outline and five holes");
    }
}

#[test]
fn sparse_infill_is_solid_at_tops_and_bottoms() {
    let mut profile = profile("fdm-abs-0.4");
    profile.fill.infill_density = 0.2;
    let plan = plan_of("plate", &profile);
    let infill = |l: &Layer| l.passes.iter().filter(|p| p.kind == PassKind::Infill).map(Pass::length).sum::<f64>();
    let lengths: Vec<f64> = plan.layers.iter().map(infill).collect();
    let (solid, count) = (profile.fill.solid_layers as usize, lengths.len());
    for (i, length) in lengths.iter().enumerate() {
        let share = length / lengths[0];
        if i < solid || i + solid >= count {
            assert!((share - 1.0).abs() < 0.02, "layer {i}: {share}");
        } else {
            // Links along the boundary come on top of the lines.
            assert!((0.19..0.35).contains(&share), "layer {i}: {share}");
        }
    }
}

/// The angle with the fewest turns on layers of `compound`.
fn fewest_turns(layers: &[&[Polygon]], settings: &FillSettings) -> Option<f64> {
    let infills: Vec<Vec<Region>> = layers.iter().map(|l| angle::infills(&Compound, l, settings)).collect();
    angle::fewest_turns(&infills, settings)
}

#[test]
fn the_best_angle_has_no_more_turns_than_any_other() {
    let profile = profile("fdm-abs-0.4");
    let settings = profile.fill_settings(0);
    for part in ["plate", "gear", "star", "cross", "propeller"] {
        let mut mesh = example::find(part).unwrap().mesh();
        mesh.place(0.3, glam::DVec3::ZERO);
        let plan = plan::plan(part, &mesh, &profile, &Task::new()).unwrap();
        let island = &plan.layers[5].islands[0];
        let (core, spacing) = (Compound.infill(island, &settings), Spacing::AtMost(settings.stepover));
        let alone = fewest_turns(&[std::slice::from_ref(island)], &settings).unwrap();
        let pair = fewest_turns(&[std::slice::from_ref(island); 2], &settings).unwrap();
        let turns = |a: f64| ends_at(&core, a, spacing);
        for k in 0..720 {
            let a = f64::from(k) * PI / 720.0;
            // An edge within 1 % wins.
            let no_more = |a: i64, b: i64| a as f64 <= 1.01 * b as f64;
            assert!(no_more(turns(alone), turns(a)), "{part}: {} at {alone}, {} at {a}", turns(alone), turns(a));
            let both = |a: f64| turns(a) + turns(a + FRAC_PI_2);
            assert!(no_more(both(pair), both(a)), "{part}: {} at {pair}, {} at {a}", both(pair), both(a));
        }
    }
}

/// The direction of an edge wins over an angle 0.1° beside it that has hardly fewer turns.
#[test]
#[cfg_attr(no_models, ignore = "no shared models")]
fn an_edge_with_hardly_more_turns_wins() {
    let bytes = model("plate_holes.stl");
    let mesh = import(&bytes, &Task::new()).unwrap().mesh;
    let layers =
        Slicer::new(&mesh, profile("fdm-abs-0.4").slice_options(), &Task::new()).unwrap().all(&Task::new()).unwrap();
    let islands = &layers[layers.len() / 2].islands;
    // Lines of 0.32 and 0.6 mm would lie at 89.94 and 89.93° for 0.1 % less turns.
    for width in [0.8, 1.0, 1.2, 1.5] {
        let profile = profile("fdm-abs-0.4");
        let mut settings = profile.fill_settings(0);
        settings.stepover *= width;
        for count in [1, 2] {
            let best = fewest_turns(&vec![&islands[..]; count], &settings).unwrap().to_degrees();
            assert!((best / 90.0 - (best / 90.0).round()).abs() < 1e-6, "{width}: {best}");
        }
    }
}

#[test]
fn a_turned_part_has_a_turned_angle() {
    let profile = profile("fdm-abs-0.4");
    let settings = profile.fill_settings(0);
    let ring = |turn: f64| {
        let corners = [(0.0, 0.0), (40.0, 0.0), (40.0, 15.0), (0.0, 15.0)].map(DVec2::from);
        Polygon {
            outer: Ring::new(corners.iter().map(|p| DVec2::from_angle(turn).rotate(*p)).collect()),
            holes: vec![],
        }
    };
    for turn in [0.0, 0.3, 1.1, 2.5] {
        let best = fewest_turns(&[&[ring(turn)]], &settings).unwrap();
        assert!(((best - turn + 0.5 * PI).rem_euclid(PI) - 0.5 * PI).abs() < 1e-4, "{best} for {turn}");
    }
}

/// A blob with some round holes.
fn blob(seed: &[f64]) -> Region {
    let ring = |middle: DVec2, n: usize, radius: &dyn Fn(f64) -> f64| {
        let point = |k: usize| {
            let angle = TAU * k as f64 / n as f64;
            middle + DVec2::from_angle(angle) * radius(angle)
        };
        Ring::new((0..n).map(point).collect())
    };
    let outer = ring(DVec2::ZERO, 90, &|a| {
        30.0 + 6.0 * (3.0 * a + 6.0 * seed[0]).sin() + 5.0 * (7.0 * a + 6.0 * seed[1]).cos()
    });
    let hole = |s: &f64| ring(DVec2::from_angle(40.0 * s) * (6.0 + 9.0 * s), 24, &|_| 2.0 + 3.0 * s).reversed();
    Region::from_rings(&[outer].into_iter().chain(seed[2..].iter().map(hole)).collect::<Vec<_>>(), FillRule::NonZero)
}

#[test]
fn merging_keeps_every_line_and_needs_no_more_paths() {
    runner(60)
        .run(&(prop::collection::vec(0.0..1.0, 3..9), 0.0..3.1, 0.5..3.0), |(seed, angle, stepover)| {
            let region = blob(&seed);
            let scan = Scan::new(&region, angle, Spacing::AtMost(stepover));
            let weave = Weave::new(&scan, stepover);
            let spans: Vec<usize> = weave.regions().iter().flat_map(|r| r.spans.iter().copied()).collect();
            let mut once = spans.clone();
            once.sort_unstable();
            prop_assert!(once.into_iter().eq(0..scan.spans().len()), "every line in one sub-region");
            let (apart, merged) = (weave.apart(), weave.merged());
            prop_assert!(merged.len() <= apart.len());
            let mut regions: Vec<usize> = merged.iter().flatten().map(|(r, _)| *r).collect();
            regions.sort_unstable();
            prop_assert!(regions.into_iter().eq(0..apart.len()), "every sub-region in one path");
            // A path holds its lines and links that leave the region nowhere.
            for path in weave.paths(&merged) {
                for ends in path.windows(2) {
                    prop_assert!(region.offset(0.01, Join::ROUND).contains((ends[0] + ends[1]) / 2.0));
                }
            }
            Ok(())
        })
        .unwrap();
}

#[test]
fn a_plate_with_a_hole_needs_two_paths() {
    // Below, left, right and above the hole: two of the four sub-regions follow each other on either side (3.2).
    let square = |s: f64| Ring::new([(-s, -s), (s, -s), (s, s), (-s, s)].map(DVec2::from).to_vec());
    let region = Region::from_rings(&[square(20.0), square(6.0).reversed()], FillRule::NonZero);
    let scan = Scan::new(&region, 0.0, Spacing::AtMost(0.9));
    let weave = Weave::new(&scan, 0.9);
    assert_eq!(weave.regions().len(), 4);
    assert_eq!(weave.merged().len(), 2);
}

/// Robots hold their speed at turns but lose time at every arc start: the angle is chosen for that too, and it may not
/// be quick by leaving places bare.
#[test]
fn the_best_angle_of_a_weld_lays_its_metal_no_slower_than_a_fixed_one() {
    for (name, strategy) in
        [("cmt-al2319-kuka", "zigzag"), ("cmt-al2319-kuka", "compound"), ("plasma-304-cnc", "raster")]
    {
        let profile = common::profile_by(name, strategy);
        for (part, degrees) in
            ["cross", "star"].iter().flat_map(|part| [0.0, 20.0, 60.0].map(|degrees| (part, degrees)))
        {
            let mut mesh = example::find(part).unwrap().mesh();
            mesh.place(2.0, glam::DVec3::new(0.0, 0.0, degrees));
            let low = 2.0 * profile.layers.height / mesh.size().z;
            let flat = solids::mapped(&solids::facets_of(&mesh), |p| p.with_z(p.z * low));
            let mesh = solids::imported(&flat).mesh;
            let laid = |turn: RasterTurn| {
                let mut profile = profile.clone();
                profile.fill.raster_turn = turn;
                let metrics = plan::plan(part, &mesh, &profile, &Task::new()).unwrap().summary.metrics;
                (metrics.total_time_s, metrics.deposited_volume_mm3)
            };
            let (best, fixed) = (laid(RasterTurn::Best), laid(RasterTurn::Alternate));
            let what = format!("{strategy} {part} at {degrees}°: {best:?}, fixed {fixed:?}");
            assert!(best.0 / best.1 <= 1.005 * fixed.0 / fixed.1, "{what}");
            assert!(best.1 >= 0.97 * fixed.1, "{what}");
        }
    }
}

//! Plans of the example parts with every strategy: inside the outline, nothing crosses, totals add up, programs read
//! back.

use crate::common::{flat, planned_once};
use crate::readers;
use beadwright::fill::StrategyName;

use beadwright::dialect;
use beadwright::dialect::rapid::RapidArc;
use beadwright::layer::Layer;
use beadwright::model::Mesh;
use beadwright::pass::{Pass, Segment};
use beadwright::plan::{self, Plan};
use beadwright::planar::{DVec2, Region, polyline};
use beadwright::profile::Profile;
use beadwright::task::Task;
use beadwright::warning::WarningKind;
use beadwright::{example, plan_file};
use rayon::prelude::*;
use readers::{Motion, distance};
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// Centre-lines may lie this far outside their place, mm: grid, simplification and arc tolerance.
const TOLERANCE: f64 = 0.02;

fn profile(name: &str, strategy: &str, angle: f64) -> Profile {
    let mut profile = Profile::built_in(name).unwrap();
    profile.fill.strategy = strategy.parse().unwrap();
    profile.fill.raster_angle = angle;
    flat(profile)
}

fn plan_of(mesh: &Mesh, profile: &Profile) -> Plan {
    planned_once("part", mesh, profile).unwrap()
}

/// Parts with walls of one bead; the other strategies have no room in them.
const THIN_WALLED: [&str; 5] = ["blade", "gourd", "pot", "tian", "wall"];

/// Every example by every strategy, with two profiles; all tests share these plans.
static CASES: LazyLock<Vec<(String, Plan, Profile)>> = LazyLock::new(|| {
    // The two large closed ones are planned in wall_paths.rs, the bracket as its preform, and the mould is there to be clad.
    let parts = example::ALL
        .par_iter()
        .filter(|part| !["bracket", "gourd", "mould", "pot"].contains(&part.name) && part.bodies().is_none());
    let cases = parts.flat_map_iter(|part| {
        let thin = THIN_WALLED.contains(&part.name);
        let strategies = StrategyName::ALL.iter().filter(move |strategy| (**strategy == StrategyName::Wall) == thin);
        let profiles = [("cmt-al2319-kuka", 0.0), ("plasma-304-cnc", 33.0)];
        strategies.flat_map(move |strategy| profiles.map(|profile| (part, thin, strategy.name(), profile)))
    });
    let planned = cases.map(|(part, thin, strategy, (profile_name, angle))| {
        let mut profile = profile(profile_name, strategy, angle);
        profile.bead.width = if thin { 4.0 } else { profile.bead.width };
        (format!("{} {strategy} {profile_name}", part.name), plan_of(&part.mesh(), &profile), profile)
    });
    planned.collect()
});

fn each_case(mut check: impl FnMut(&str, &Plan, &Profile)) {
    CASES.iter().for_each(|(case, plan, profile)| check(case, plan, profile));
}

/// Distance from a point to the boundary of a layer, mm.
fn to_boundary(layer: &Layer, p: DVec2) -> f64 {
    let edges = layer.islands.iter().flat_map(|i| i.rings()).flat_map(|r| r.edges());
    let distance = |(a, b)| beadwright::planar::polyline::distance_squared_to_segment(p, a, b);
    edges.map(distance).fold(f64::INFINITY, f64::min).sqrt()
}

#[test]
fn centre_lines_keep_half_a_bead_from_the_outline() {
    each_case(|case, plan, profile| {
        // Beads of a wall are as wide as it is, and cut corners where walls meet.
        let wall = profile.fill.strategy == StrategyName::Wall;
        // Widths change in steps: half a step on either side of a bead; twice where thin walls are tied to rings.
        let steps = if profile.fill.strategy == StrategyName::Mat { 2.0 } else { 1.0 };
        let slack = profile.fill.machining_allowance + TOLERANCE + 0.03 * steps * profile.bead.width;
        for layer in plan.layers.iter().step_by(4) {
            for pass in &layer.passes {
                for (i, p) in pass.points.iter().map(|p| p.truncate()).enumerate() {
                    let keep = if wall { 1.4 } else { pass.width.after(i).min(profile.bead.width) / 2.0 } - slack;
                    assert!(layer.islands.iter().any(|i| i.contains(p)), "{case}: {p} lies outside");
                    assert!(to_boundary(layer, p) >= keep, "{case}: {p} is {} from the outline", to_boundary(layer, p));
                }
            }
        }
    });
}

#[test]
fn a_machining_allowance_moves_the_outermost_bead_outwards() {
    let mesh = example::find("cross").unwrap().mesh();
    let mut profile = profile("plasma-304-cnc", "compound", 0.0);
    let length = |profile: &Profile| {
        let plan = plan_of(&mesh, profile);
        plan.layers[0].passes.last().unwrap().length()
    };
    let before = length(&profile);
    profile.fill.machining_allowance = 1.0;
    // Twelve corners: eight outward mitres of an axis-parallel cross add 8·a to the perimeter of each offset by a,
    // less what the four inner corners round off (at most 4·(2 − π/2)·w/2 on either side).
    let grown = length(&profile) - before;
    assert!((grown - 8.0).abs() < 0.1 + 4.0 * (2.0 - std::f64::consts::FRAC_PI_2), "{grown}");
}

/// Segments of different passes, or of one pass but not neighbours, may touch but not cross.
fn crossing(layer: &Layer) -> Option<(DVec2, DVec2)> {
    let mut segments: Vec<(usize, usize, DVec2, DVec2)> = Vec::new();
    for (k, pass) in layer.passes.iter().enumerate() {
        let ends = pass.segments().map(|s| (s.from.truncate(), s.to.truncate()));
        segments.extend(ends.enumerate().map(|(i, (from, to))| (k, i, from, to)));
    }
    segments.sort_by(|a, b| a.2.x.min(a.3.x).total_cmp(&b.2.x.min(b.3.x)));
    for (i, s) in segments.iter().enumerate() {
        let right = s.2.x.max(s.3.x);
        for t in segments[i + 1..].iter().take_while(|t| t.2.x.min(t.3.x) <= right) {
            let neighbours = s.0 == t.0 && s.1.abs_diff(t.1) <= 1;
            if !neighbours && cross_properly(s.2, s.3, t.2, t.3) {
                return Some((s.2, t.2));
            }
        }
    }
    None
}

/// Nor where metal is shared out and beads at the outline move inwards.
#[test]
fn no_two_passes_of_a_level_layer_cross() {
    for name in ["cross", "plate", "star"] {
        for strategy in ["loop", "zigzag", "hybrid", "contour", "compound"] {
            let mut profile = profile("cmt-al2319-kuka", strategy, 0.0);
            profile.layers.level = true;
            for layer in plan_of(&example::find(name).unwrap().mesh(), &profile).layers.iter().step_by(3) {
                assert_eq!(crossing(layer), None, "{name} {strategy}, layer {}", layer.index);
            }
        }
    }
}

/// Whether two segments cross with a margin of 1 µm on both sides of each.
fn cross_properly(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p) / p.distance(q).max(1e-9);
    let apart = |u: f64, v: f64| (u > 1e-3 && v < -1e-3) || (u < -1e-3 && v > 1e-3);
    apart(side(a, b, c), side(a, b, d)) && apart(side(c, d, a), side(c, d, b))
}

#[test]
fn the_crossing_test_finds_crossings() {
    let at = DVec2::new;
    assert!(cross_properly(at(0.0, 0.0), at(2.0, 2.0), at(0.0, 2.0), at(2.0, 0.0)));
    assert!(!cross_properly(at(0.0, 0.0), at(2.0, 2.0), at(2.0, 2.0), at(4.0, 0.0)));
}

#[test]
fn no_two_passes_of_a_layer_cross() {
    each_case(|case, plan, _| {
        for layer in plan.layers.iter().step_by(3) {
            assert_eq!(crossing(layer), None, "{case}, layer {}", layer.index);
        }
    });
}

#[test]
fn totals_are_the_sums_of_the_layers() {
    each_case(|case, plan, profile| {
        let passes = || plan.layers.iter().flat_map(|l| &l.passes);
        let m = &plan.summary.metrics;
        let length: f64 = passes().map(|p| p.length()).sum();
        assert_eq!(m.arc_starts, passes().count(), "{case}");
        assert!((m.deposited_length_mm - length).abs() < 1e-6 * length, "{case}");
        let seconds: f64 = passes().map(|p| p.seconds(&profile.process)).sum();
        assert!((m.arc_time_s - seconds).abs() < 1e-6 * seconds, "{case}");
        let metal = seconds * profile.bead().area() * profile.process.deposition_speed;
        assert!((m.deposited_volume_mm3 - metal).abs() < 1e-9 * metal, "{case}");
        let wire = m.arc_time_s * profile.process.wire_feed_speed / 60.0;
        assert!((m.wire_length_m - wire).abs() < 1e-9 * wire, "{case}");
        // Scan lines across a wall two beads wide leave most of it bare.
        assert!((0.3..=1.0).contains(&m.coverage()), "{case}: {}", m.coverage());
    });
}

#[test]
fn dense_strategies_lay_about_the_volume_of_the_part() {
    // A wide plate: edges matter little. The bead's volume per stepover equals the layer's.
    let mesh = example::find("plate").unwrap().mesh();
    for strategy in ["raster", "zigzag", "compound", "contour"] {
        let m = plan_of(&mesh, &profile("plasma-304-cnc", strategy, 90.0)).summary.metrics;
        let ratio = m.deposited_volume_mm3 / m.part_volume_mm3;
        // One-way lines end half a bead inside the outline and have no links: they lay less.
        let least = if strategy == "raster" { 0.8 } else { 0.85 };
        assert!((least..1.15).contains(&ratio), "{strategy}: {ratio}");
    }
}

/// Writes the plan with a post and returns its files.
/// The metal of level layers is shared out once they are filled.
#[test]
fn what_a_plan_covers_is_what_its_beads_cover() {
    let profile = profile("plasma-304-cnc", "loop", 0.0);
    let plan = plan_of(&crate::common::tube(40.0, 14.0, 4.0, 0.1), &profile);
    for layer in &plan.layers {
        let islands = Region::from_normalised(layer.islands.clone());
        let step = 0.05;
        let rows = islands.rows(-50.0, step, 2000);
        let points = rows.iter().enumerate().flat_map(|(row, ends)| {
            let y = -50.0 + step * row as f64;
            ends.chunks_exact(2).flat_map(move |span| {
                (0..).map(move |k| DVec2::new(span[0] + step * (k as f64 + 0.5), y)).take_while(|p| p.x < span[1])
            })
        });
        let pieces: Vec<Segment> = layer.passes.iter().flat_map(Pass::segments).collect();
        let is_covered = |p: &DVec2| {
            pieces.iter().any(|piece| {
                let (a, b) = (piece.from.truncate(), piece.to.truncate());
                let radius = piece.width * 0.505;
                (*p - a.midpoint(b)).abs().max_element() < 2.0 * radius + a.distance(b)
                    && polyline::distance_squared_to_segment(*p, a, b) < radius * radius
            })
        };
        let covered = points.filter(is_covered).count() as f64 * step * step;
        assert!((layer.planned_area / covered - 1.0).abs() < 2e-3, "{} of {covered}", layer.planned_area);
        assert!(covered > 0.96 * layer.slice_area, "{covered} of {}", layer.slice_area);
    }
}

fn written(plan: &Plan, profile: &Profile, name: &str) -> BTreeMap<String, String> {
    dialect::write(name, &plan.layers, &profile.job("Test part-1")).unwrap()
}

fn same_as_plan(case: &str, motion: &Motion, plan: &Plan, profile: &Profile) {
    let passes: Vec<_> = plan.layers.iter().flat_map(|l| &l.passes).collect();
    assert_eq!(motion.welds.len(), passes.len(), "{case}: arc starts");
    for (weld, pass) in motion.welds.iter().zip(&passes) {
        assert!(distance(weld.points[0], pass.start().unwrap().to_array()) < 0.002, "{case}");
        assert!(distance(*weld.points.last().unwrap(), pass.end().unwrap().to_array()) < 0.002, "{case}");
        let length: f64 = weld.points.windows(2).map(|w| distance(w[0], w[1])).sum();
        assert!((length - pass.length()).abs() < 0.02 + 1e-4 * length, "{case}: {length} for {}", pass.length());
        // Dropping short moves may shift a change of speed by one of them; the time shows that nothing else did.
        let time: f64 = weld.points.windows(2).zip(&weld.speeds).map(|(w, s)| distance(w[0], w[1]) / s).sum();
        assert!(
            (time / pass.seconds(&profile.process) - 1.0).abs() < 0.01,
            "{case}: {time} s for {}",
            pass.seconds(&profile.process)
        );
    }
    let travel = motion.travel;
    let first_descent = profile.travel.clearance;
    let planned = plan.summary.metrics.travel_length_mm + first_descent;
    assert!((travel - planned).abs() < 0.01 + 1e-4 * planned, "{case}: travel {travel} for {planned}");
}

#[test]
fn krl_reads_back_as_planned() {
    each_case(|case, plan, profile| {
        let mut profile = profile.clone();
        profile.dialects.krl = Profile::built_in("cmt-al2319-kuka").unwrap().dialects.krl;
        profile.dialects.krl.as_mut().unwrap().max_megabytes = 1000.0;
        let files = written(plan, &profile, "krl");
        same_as_plan(case, &readers::krl::run(&files, "TEST_PART_1", "$OUT[2]"), plan, &profile);
    });
}

#[test]
fn gcode_reads_back_as_planned() {
    each_case(|case, plan, profile| {
        let mut profile = profile.clone();
        profile.dialects.gcode = Profile::built_in("plasma-304-cnc").unwrap().dialects.gcode;
        // The way in is as long as that of the robots.
        profile.dialects.gcode.as_mut().unwrap().safe_z = 0.0;
        let files = written(plan, &profile, "gcode");
        same_as_plan(case, &readers::gcode::run(&files["Test part-1.nc"], 3, 5), plan, &profile);
    });
}

#[test]
fn rapid_reads_back_as_planned() {
    each_case(|case, plan, profile| {
        let mut profile = profile.clone();
        let mut rapid = Profile::built_in("cmt-steel-abb").unwrap().dialects.rapid.unwrap();
        // Fine steps: the times are compared within 1 %, at down to 3 mm/s.
        rapid.speed_step = 0.02;
        let plain = profile.dialects.krl.is_none();
        rapid.arc = if plain { RapidArc::Plain } else { RapidArc::Instructions };
        profile.dialects.rapid = Some(rapid);
        let files = written(plan, &profile, "rapid");
        let output = if plain { "doArc" } else { "" };
        same_as_plan(case, &readers::rapid::run(&files, "Test_part_1", output), plan, &profile);
    });
}

#[test]
fn plan_json_holds_the_plan() {
    let profile = profile("cmt-al2319-kuka", "compound", 0.0);
    let plan = plan_of(&example::find("gear").unwrap().mesh(), &profile);
    let settings = plan::deposit_settings(&profile);
    let mut text = plan_file::head(&plan.header, &profile);
    plan.layers.iter().for_each(|l| text.push_str(&plan_file::layer(l, None)));
    text.push_str(plan_file::tail());
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!((json["version"].as_u64(), json["units"].as_str()), (Some(2), Some("mm")));
    let layers = json["layers"].as_array().unwrap();
    assert_eq!(layers.len(), plan.layers.len());
    for (read, layer) in layers.iter().zip(&plan.layers) {
        assert_eq!(read["islands"].as_array().unwrap().len(), layer.islands.len());
        assert_eq!(read["islands"][0]["holes"].as_array().unwrap().len(), layer.islands[0].holes.len());
        for (read, pass) in read["passes"].as_array().unwrap().iter().zip(&layer.passes) {
            assert_eq!(read["kind"], pass.kind.name());
            assert_eq!(read["closed"], pass.closed);
            let points: Vec<[f64; 3]> = serde_json::from_value(read["points"].clone()).unwrap();
            assert_eq!(points.len(), pass.points.len());
            assert!(points.iter().zip(&pass.points).all(|(a, b)| distance(*a, b.to_array()) < 1e-4));
            assert_eq!(read["pace"].as_f64(), Some(10.5));
        }
    }
    let read = plan_file::read(&text).unwrap();
    assert_eq!((read.header, read.settings.unwrap()), (plan.header.clone(), settings));
    assert_eq!(read.profile, Some(profile));
    for (read, layer) in read.layers.iter().zip(&plan.layers) {
        assert!((read.slice_area / layer.slice_area - 1.0).abs() < 1e-6);
        assert_eq!(read.passes.len(), layer.passes.len());
        assert!(read.passes.iter().zip(&layer.passes).all(|(a, b)| (a.length() - b.length()).abs() < 0.01));
    }
    for (from, to, word) in [
        ("\"version\":2", "\"version\":9", "version 9"),
        ("\"units\":\"mm\"", "\"units\":\"in\"", "is in \"in\""),
        ("\"width\":7.5400,\"pace\"", "\"width\":1e5,\"pace\"", "at most 2000"),
        ("\"outline\":[[", "\"outline\":[[1e9,0],[", "out of bounds"),
        ("\"deposition_speed\":10.5", "\"deposition_speed\":-1.0", "process.deposition_speed"),
        ("\"index\":0", "\"index\":7", "its place in the list"),
        ("\"pace\":10.5000", "\"pace\":-1", "greater than 0"),
        ("\"kind\":\"contour\"", "\"kind\":\"loop\"", "unknown variant"),
        ("\"layers\":[", "\"layers\":{", "line 1"),
    ] {
        let Err(error) = plan_file::read(&text.replacen(from, to, 1)) else { panic!("{from} is read as {to}") };
        let error = error.to_string();
        assert!(error.contains(word), "{from}: {error}");
    }
}

#[test]
fn one_and_two_threads_plan_the_same() {
    let mesh = example::find("propeller").unwrap().mesh();
    let profile = profile("plasma-304-cnc", "compound", 20.0);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| plan_of(&mesh, &profile))
    };
    let (one, two) = (with(1), with(2));
    assert_eq!(one.layers, two.layers);
    assert_eq!(one.summary, two.summary);
}

#[test]
fn what_is_thinner_than_a_bead_is_reported() {
    // A 40 mm block with a 3 mm fin: the fin's 30 mm × 3 mm are lost on every layer.
    let outline =
        [(0.0, 0.0), (40.0, 0.0), (40.0, 18.0), (70.0, 18.0), (70.0, 21.0), (40.0, 21.0), (40.0, 40.0), (0.0, 40.0)];
    let mesh = extruded(&outline, 8.0);
    let plan = plan_of(&mesh, &profile("cmt-al2319-kuka", "compound", 0.0));
    let text: Vec<String> = plan.summary.warnings.summaries().map(|w| w.sentence()).collect();
    let thin = plan.summary.warnings.summaries().find(|w| w.kind == WarningKind::ThinFeature).unwrap();
    assert_eq!((thin.count, &thin.layers[..]), (4, &[(0, 3)][..]), "{text:?}");
    // Less where the opening of the block rounds into the root of the fin.
    assert!((85.0..91.0).contains(&thin.largest.size), "{text:?}");
    let m = &plan.summary.metrics;
    // Corners are lost too: (1 − π/4) r² at each of the block's four.
    let corners = 4.0 * (1.0 - std::f64::consts::FRAC_PI_4) * (0.35 * 7.54_f64).powi(2);
    let expected = 1.0 - (thin.largest.size + corners) / 1690.0;
    // Beads cover no more than that, and hardly less.
    assert!((expected - 0.02..expected + 1e-3).contains(&m.coverage()), "{} for {expected}", m.coverage());
}

/// Fins of half a bead and more are welded with the narrowest bead, which reaches beyond them, at any angle; thinner ones, and
/// necks between two holes, are not.
#[test]
fn fins_of_half_a_bead_are_welded_with_the_narrowest() {
    let w = 7.54;
    for (thickness, welded) in [(0.46, false), (0.54, true), (0.66, true)] {
        let (low, high) = (20.0 - thickness * w / 2.0, 20.0 + thickness * w / 2.0);
        let outline =
            [(0.0, 0.0), (40.0, 0.0), (40.0, low), (80.0, low), (80.0, high), (40.0, high), (40.0, 40.0), (0.0, 40.0)];
        for (strategy, degrees) in [("loop", 0.0), ("loop", 33.0), ("loop", 80.0), ("contour", 0.0), ("hybrid", 33.0)] {
            let way = DVec2::from_angle(f64::to_radians(degrees));
            let turned = outline.map(|p| way.rotate(p.into()).into());
            let plan = plan_of(&extruded(&turned, 4.0), &profile("cmt-al2319-kuka", strategy, 0.0));
            let m = &plan.summary.metrics;
            let fin = 40.0 * thickness * w / m.slice_area_mm2 * 2.0;
            let text: Vec<String> = plan.summary.warnings.summaries().map(|w| w.sentence()).collect();
            let of = |kind| plan.summary.warnings.summaries().find(|w| w.kind == kind).map_or(0.0, |w| w.total);
            let (beside, lost) = (of(WarningKind::ThinWall), of(WarningKind::ThinFeature));
            let whole = 2.0 * 40.0 * thickness * w;
            let found = if welded { beside } else { lost };
            assert!((0.85..1.02).contains(&(found / whole)), "{thickness} {strategy} {degrees}: {text:?}");
            assert!(beside == 0.0 || lost == 0.0, "{thickness} {strategy} {degrees}: {text:?}");
            let covered = if welded { 0.94 } else { 1.0 - 0.85 * fin };
            assert!((m.coverage() > 0.94) == welded && m.coverage() < covered + 0.06, "{} {text:?}", m.coverage());
            let narrowest =
                plan.layers.iter().flat_map(|l| &l.passes).flat_map(|pass| pass.segments()).map(|s| s.width);
            assert!(narrowest.fold(f64::INFINITY, f64::min) > 0.699 * w, "no bead is narrower than the process lays");
        }
    }
}

/// Through a neck with room for one bead the loop goes once.
#[test]
fn no_loop_runs_over_itself_in_a_neck() {
    // A bar with a slit to its middle.
    let outline =
        [(0.0, 0.0), (60.0, 0.0), (60.0, 6.4), (61.2, 6.4), (61.2, 0.0), (110.0, 0.0), (110.0, 12.7), (0.0, 12.7)];
    for degrees in [0.0, 17.0, 45.0, 90.0, 200.0] {
        let way = DVec2::from_angle(f64::to_radians(degrees));
        let turned = outline.map(|p| way.rotate(p.into()).into());
        let profile = profile("cmt-al2319-kuka", "loop", 0.0);
        let plan = plan_of(&extruded(&turned, 8.0), &profile);
        let settings = plan::deposit_settings(&profile);
        let findings = beadwright::check(&plan.layers, &profile, settings, &Task::new()).unwrap();
        assert!(!findings.iter().any(|f| f.kind == "retraced"), "{degrees}: {findings:?}");
        assert_eq!(plan.summary.metrics.passes, plan.layers.len(), "one arc start a layer at {degrees}°");
        assert!(plan.summary.metrics.coverage() > 0.95);
    }
}

#[test]
fn a_part_without_room_for_a_bead_is_refused() {
    let mesh = extruded(&[(0.0, 0.0), (100.0, 0.0), (100.0, 3.0), (0.0, 3.0)], 10.0);
    let error = plan::plan("fin", &mesh, &profile("cmt-al2319-kuka", "zigzag", 0.0), &Task::new()).unwrap_err();
    assert!(error.to_string().contains("wide enough for a bead of 7.54 mm"), "{error}");
}

#[test]
fn a_gap_between_two_blocks_gives_empty_layers() {
    let square = [(0.0, 0.0), (30.0, 0.0), (30.0, 30.0), (0.0, 30.0)];
    let (low, mut high) = (extruded(&square, 6.0), extruded(&square, 6.0));
    high.vertices.iter_mut().for_each(|v| v.z += 12.0);
    let offset = low.vertices.len() as u32;
    let vertices = low.vertices.into_iter().chain(high.vertices).collect();
    let triangles = low.triangles.into_iter().chain(high.triangles.into_iter().map(|t| t.map(|v| v + offset)));
    let (mesh, _) = Mesh::from_triangles(vertices, triangles.collect());
    let plan = plan_of(&mesh, &profile("cmt-al2319-kuka", "zigzag", 0.0));
    let warning = |kind| plan.summary.warnings.summaries().find(|w| w.kind == kind).unwrap();
    assert_eq!(warning(WarningKind::EmptyLayer).layers, [(3, 5)]);
    assert_eq!(plan.summary.metrics.layers, 6);
    // The upper block would be welded into the air.
    let hanging = warning(WarningKind::NothingBelow);
    assert_eq!((hanging.layers.clone(), hanging.largest.size), (vec![(6, 6)], 6.0));
    assert_eq!(plan.summary.forbidden, [hanging.sentence()]);
}

/// A prism over a counter-clockwise outline.
fn extruded(outline: &[(f64, f64)], height: f64) -> Mesh {
    use beadwright::planar::{Polygon, Ring, triangulate::triangulate};
    let ring: Vec<DVec2> = outline.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
    let n = ring.len() as u32;
    let vertices = [0.0, height].iter().flat_map(|&z| ring.iter().map(move |p| p.extend(z))).collect();
    let caps = triangulate(&Polygon::simple(Ring::new(ring.clone())));
    let caps = caps.iter().map(|t| t.map(|i| i as u32)).flat_map(|[a, b, c]| [[a, c, b], [a + n, b + n, c + n]]);
    let walls = (0..n).flat_map(|i| {
        let j = (i + 1) % n;
        [[i, j, j + n], [i, j + n, i + n]]
    });
    Mesh::from_triangles(vertices, caps.chain(walls).collect()).0
}

#[test]
fn the_length_that_is_expected_is_about_what_is_laid() {
    for (part, angle) in [("cross", 0.0), ("cross", 45.0), ("propeller", 30.0), ("gear", 10.0), ("star", 0.0)] {
        let mesh = example::find(part).unwrap().mesh();
        for width in [2.0, 4.0] {
            let mut profile = profile("cmt-al2319-kuka", "zigzag", angle);
            profile.bead.width = width;
            let expected = plan::expected(&mesh, &profile).unwrap();
            let laid = plan_of(&mesh, &profile);
            let ratio = expected.layer_length * expected.layers / laid.summary.metrics.deposited_length_mm;
            assert!((0.85..1.2).contains(&ratio), "{part}, beads of {width} mm: {ratio:.2} of what is laid");
            assert_eq!(expected.layers as usize, laid.layers.len(), "{part}");
            assert!(!expected.large, "{part}");
        }
        let mut fine = profile("cmt-al2319-kuka", "zigzag", angle);
        fine.bead.width = 0.2;
        assert!(plan::expected(&mesh, &fine).unwrap().large, "{part}");
    }
    let mut open = example::find("cross").unwrap().mesh();
    open.triangles.clear();
    assert_eq!(plan::expected(&open, &profile("cmt-al2319-kuka", "zigzag", 0.0)), None);
}

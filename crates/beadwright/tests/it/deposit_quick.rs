//! The deposit model as it is run against its reference, every point in double precision: plans by strategy and turn.

use crate::common::planned_once;
use beadwright::deposit::{DepositSettings, Judge, Judgement};
use beadwright::example;
use beadwright::layer::Layer;
use beadwright::pass::{Along, Pass, PassKind};
use beadwright::plan::{self, Plan};
use beadwright::profile::Profile;
use glam::{DVec2, DVec3};
use planar::{Polygon, Ring};

/// Distance between grid points, mm. No spacing of beads is a multiple of it: the points of the reference would meet each
/// of them in the same places, and their mean would not be that of the beads.
const STEP: f64 = 0.31;

/// How far low areas may lie apart, in points.
const LOW: f64 = 0.3;
/// The same in hatches along the grid or at 45° to it: the points of the reference fall on whole lines of equal height, each
/// of them low or not.
const LOW_OF_HATCH: f64 = 1.5;

fn profile() -> Profile {
    Profile::built_in("plasma-304-cnc").unwrap()
}

fn plan(part: &str, turn: f64, strategy: &str) -> Plan {
    let mut profile = profile();
    profile.fill.strategy = strategy.parse().unwrap();
    let mut mesh = example::find(part).unwrap().mesh();
    mesh.place(1.0, DVec3::new(0.0, 0.0, turn));
    planned_once(part, &mesh, &profile).unwrap()
}

/// The layer as it is judged, and by the reference.
fn both(settings: DepositSettings, layer: &Layer) -> [Judgement; 2] {
    [Judge::new(settings), Judge::new(settings).with_every_point()].map(|mut judge| judge.layer(layer))
}

/// What is promised: void, overfill and outside within 0.02 points; heights within 1e-4 of a bead's.
#[track_caller]
fn agree(name: &str, settings: DepositSettings, [quick, slow]: &[Judgement; 2], most_low: f64) {
    let (a, b, h) = (&quick.figures, &slow.figures, settings.nominal.bead.height);
    assert!(b.area > 0.0 && (a.area - b.area).abs() < 1e-9 * b.area, "{name}: {} {} mm²", a.area, b.area);
    assert_eq!(a.deposited_volume, b.deposited_volume);
    let near = |what: &str, a: f64, b: f64, most: f64| assert!((a - b).abs() <= most, "{name}, {what}: {a} for {b}");
    near("void %", a.void_percent(), b.void_percent(), 0.02);
    near("overfill %", a.overfill_percent(), b.overfill_percent(), 0.02);
    near("outside %", a.outside_percent(), b.outside_percent(), 0.02);
    // Ridges find these from a line across them.
    near("low %", a.low_percent(), b.low_percent(), most_low);
    near("mean", a.mean(), b.mean(), 1e-3 * h);
    near("deviation", a.deviation(), b.deviation(), 1e-3 * h);
    // Crowns and hollows between points are found too.
    assert!(a.max >= b.max - 1e-4 * h && a.max <= b.max + 0.01 * h, "{name}, max: {} for {}", a.max, b.max);
    assert!(a.min <= b.min + 1e-4 * h && a.min >= b.min - 0.05 * h, "{name}, min: {} for {}", a.min, b.min);
    let largest = |judged: &Judgement| judged.voids.first().map_or(0.0, |void| void.area);
    near("largest void mm²", largest(quick), largest(slow), 4.0 * settings.step * settings.step);
    let highest = |judged: &Judgement| judged.peaks.first().map_or(0.0, |peak| peak.height);
    near("highest peak", highest(quick), highest(slow), 1e-4 * h);
}

#[test]
fn the_quick_way_finds_what_every_point_shows() {
    for (part, strategies) in [
        ("cross", &["zigzag", "compound", "contour"][..]),
        ("plate", &["raster", "zigzag", "hybrid"]),
        ("gear", &["zigzag", "spiral"]),
        ("propeller", &["compound", "hybrid"]),
    ] {
        for turn in [0.0, 37.0] {
            for strategy in strategies {
                let plan = plan(part, turn, strategy);
                let settings = DepositSettings { step: STEP, ..plan::deposit_settings(&profile()) };
                let judged = both(settings, &plan.layers[0]);
                agree(&format!("{part} {turn}° {strategy}"), settings, &judged, LOW);
            }
        }
    }
}

fn hatch(spacing: f64, turn: f64) -> Layer {
    let nominal = plan::deposit_settings(&profile()).nominal;
    let square = [(-60.0, -60.0), (60.0, -60.0), (60.0, 60.0), (-60.0, 60.0)].map(DVec2::from);
    let turned = |x: f64, y: f64| DVec2::from_angle(turn.to_radians()).rotate(DVec2::new(x, y)).extend(2.0);
    let line = |k: i32| {
        let (y, x) = (f64::from(k) * spacing, if k % 2 == 0 { 85.0 } else { -85.0 });
        let (width, pace) = (Along::Same(nominal.bead.width), Along::Same(nominal.pace));
        Pass {
            kind: PassKind::Infill,
            closed: false,
            points: vec![turned(-x, y), turned(x, y)],
            width,
            pace,
            wait: 0.0,
        }
    };
    let lines = (85.0 / spacing) as i32;
    let islands = vec![Polygon::simple(Ring::new(square.to_vec()))];
    Layer { islands, passes: (-lines..=lines).map(line).collect(), ..Layer::default() }
}

/// Scan lines from too near to too far, at angles that meet the grid in every way. A missing line is seen too.
#[test]
fn hatches_of_any_spacing_and_angle_agree() {
    let settings = DepositSettings { step: STEP, ..plan::deposit_settings(&profile()) };
    let width = settings.nominal.bead.width;
    let mut spared = 0;
    for part in [0.45, 0.55, 0.6, 0.738, 0.9, 0.903, 0.95, 1.1] {
        for turn in [0.0, 45.0, 61.3, 90.0] {
            let layer = hatch(part * width, turn);
            let judged = both(settings, &layer);
            spared += usize::from(judged[0].work < judged[1].work * 4 / 5);
            agree(&format!("{part} w {turn}°"), settings, &judged, LOW_OF_HATCH);
        }
        let mut gap = hatch(part * width, 30.0);
        gap.passes.remove(gap.passes.len() / 2 + 1);
        agree(&format!("{part} w without a line"), settings, &both(settings, &gap), LOW_OF_HATCH);
    }
    assert!(spared >= 12, "ridges are judged without their points: {spared}");
}

/// A part far from the origin is judged as well as one at it.
#[test]
fn single_precision_does_not_show_far_from_the_origin() {
    let settings = DepositSettings { step: STEP, ..plan::deposit_settings(&profile()) };
    let mut layer = plan("cross", 10.0, "compound").layers.swap_remove(0);
    let by = DVec2::new(9_000.0, -7_000.0);
    layer.passes.iter_mut().flat_map(|pass| &mut pass.points).for_each(|p| *p += by.extend(0.0));
    let moved = |ring: &Ring| Ring::new(ring.points().iter().map(|p| *p + by).collect());
    let islands = layer.islands.iter();
    layer.islands =
        islands.map(|i| Polygon { outer: moved(&i.outer), holes: i.holes.iter().map(moved).collect() }).collect();
    agree("9 m away", settings, &both(settings, &layer), LOW);
}

/// Layers that come again are not computed again, and get their own number; a change is seen.
#[test]
fn a_layer_that_repeats_an_earlier_one_is_known() {
    let settings = DepositSettings { step: STEP, ..plan::deposit_settings(&profile()) };
    let plan = plan("cross", 0.0, "zigzag");
    let [mut first, second] = [0, 1].map(|k| plan.layers[k].clone());
    let mut judge = Judge::new(settings).with_pictures(100);
    let seen = [judge.layer(&first), judge.layer(&second)];
    first.index = 7;
    let again = judge.layer(&first);
    assert_eq!((again.work, again.figures, &again.picture), (0, seen[0].figures, &seen[0].picture));
    assert!(seen[0].work > 0 && again.voids.iter().chain(&again.peaks).all(|patch| patch.layer == 7));
    assert_eq!(judge.total().area, 2.0 * seen[0].figures.area + seen[1].figures.area);
    first.passes[0].points[0].x += 0.01 * settings.nominal.bead.width;
    assert!(judge.layer(&first).work > 0);
}

/// A judge without patches finds the same figures and draws the same picture.
#[test]
fn patches_are_left_out_without_changing_the_rest() {
    let settings = DepositSettings { step: STEP, ..plan::deposit_settings(&profile()) };
    for (part, strategy) in [("cross", "zigzag"), ("gear", "compound")] {
        let layer = plan(part, 20.0, strategy).layers.swap_remove(1);
        let judges = [Judge::new(settings), Judge::new(settings).without_patches()];
        let [all, bare] = judges.map(|judge| judge.with_pictures(100).layer(&layer));
        assert!(!all.voids.is_empty() && !all.peaks.is_empty());
        assert!(bare.voids.is_empty() && bare.peaks.is_empty());
        assert_eq!((bare.figures, bare.picture, bare.work), (all.figures, all.picture, all.work));
    }
}

//! Dots: the shape of one against the closed form, and posts too small for a bead, which are built of dots.

use crate::common;
use crate::families;

use beadwright::check;
use beadwright::deposit::{DepositSettings, Nominal, Stack};
use beadwright::glam::{DVec2, DVec3};
use beadwright::layer::Layer;
use beadwright::model::Mesh;
use beadwright::pass::{Along, Pass, PassKind};
use beadwright::plan::{self, Plan, PlanError};
use beadwright::process::{Dot, Spot};
use beadwright::profile::Profile;
use beadwright::task::Task;
use beadwright::warning::WarningKind;
use common::profile_by;
use planar::{Bounds, Polygon, Ring};
use std::f64::consts::{PI, TAU};

/// Height of the posts, mm.
const HIGH: f64 = 20.0;
const SPOT: Spot = Spot { time: 0.9, height: 2.6 };

fn profile() -> Profile {
    let mut profile = profile_by("cmt-al2319-kuka", "loop");
    profile.spot = Some(SPOT);
    profile
}

/// Metal a second, mm³.
fn rate(profile: &Profile) -> f64 {
    profile.process.deposition_speed * profile.bead().area()
}

fn polygon(corners: usize, radius: f64, degrees: f64) -> Ring {
    let corner = |k: usize| DVec2::from_angle(degrees.to_radians() + TAU * k as f64 / corners as f64) * radius;
    Ring::new((0..corners).map(corner).collect())
}

fn prism(ring: &Ring) -> Mesh {
    families::extruded(&[Polygon::simple(ring.clone())], HIGH).unwrap()
}

fn planned(mesh: &Mesh, profile: &Profile) -> Plan {
    plan::plan("post", mesh, profile, &Task::new()).unwrap()
}

fn reported(plan: &Plan, kind: WarningKind) -> usize {
    plan.layers.iter().flat_map(|layer| &layer.warnings).filter(|warning| warning.kind == kind).count()
}

#[test]
fn a_dot_on_the_plate_is_the_dome_of_the_trial() {
    let profile = profile();
    let dot = profile.dot().unwrap();
    let metal = rate(&profile) * SPOT.time;
    let diameter = dot.diameter_of(metal).unwrap();
    assert!((2.0 / 3.0 * PI * (diameter / 2.0).powi(2) * SPOT.height / metal - 1.0).abs() < 1e-12);
    assert!((dot.seconds(diameter) / SPOT.time - 1.0).abs() < 1e-12);
    // The deposition model knows nothing of dots: it gets a pass that is short and slow.
    let nominal = Nominal { bead: profile.bead(), pace: profile.process.deposition_speed, rise: profile.layers.height };
    let bounds = Bounds { min: DVec2::splat(-15.0), max: DVec2::splat(15.0) };
    let mut stack = Stack::new(&bounds, DepositSettings::new(nominal, 0.0));
    let points = [-Dot::LENGTH / 2.0, Dot::LENGTH / 2.0].map(|x| DVec3::new(x, 0.0, 2.0)).to_vec();
    let (width, pace) = (Along::Same(diameter), Along::Same(dot.pace(diameter)));
    let pass = Pass { kind: PassKind::Spot, closed: false, points, width, pace, wait: 0.0 };
    stack.add(&Layer { z: 2.0, height: 2.0, passes: vec![pass], ..Layer::default() });
    let crown = stack.height_at(DVec2::ZERO).unwrap();
    // Its grid is coarse for so small a bead.
    assert!((crown / SPOT.height - 1.0).abs() < 0.1, "{crown}");
    let grid = *stack.grid();
    let place = |at: usize| grid.place(at % grid.columns, at / grid.columns);
    let laid: f64 = (0..grid.points()).map(|at| stack.height_at(place(at)).unwrap()).sum::<f64>() * grid.step.powi(2);
    assert!((laid / metal - 1.0).abs() < 0.01, "{laid} for {metal}");
}

#[test]
fn a_post_too_small_for_a_bead_is_a_column_of_dots_with_its_metal() {
    let profile = profile();
    for (corners, radius) in [(4, 4.6), (5, 4.2), (8, 3.6), (40, 3.6)] {
        for degrees in [0.0, 17.0, 45.0] {
            let ring = polygon(corners, radius, degrees);
            let (mesh, area) = (prism(&ring), ring.area());
            let plan = planned(&mesh, &profile);
            let passes: Vec<&Pass> = plan.layers.iter().flat_map(|layer| &layer.passes).collect();
            assert_eq!(passes.len(), plan.layers.len(), "{corners} {degrees}");
            assert!(passes.iter().all(|pass| pass.kind == PassKind::Spot), "{corners} {degrees}");
            assert_eq!(reported(&plan, WarningKind::IslandTooSmall) + reported(&plan, WarningKind::PassTooShort), 0);
            let seconds: f64 = passes.iter().map(|pass| pass.seconds(&profile.process)).sum();
            let (laid, wanted) = (rate(&profile) * seconds, area * HIGH);
            assert!((laid / wanted - 1.0).abs() < 1e-4, "{corners} {degrees}: {laid} for {wanted}");
            let middle = ring.centroid().unwrap();
            let off = |pass: &&Pass| ((pass.points[0] + pass.points[1]) / 2.0).truncate().distance(middle);
            assert!(passes.iter().all(|pass| off(pass) < 1e-3), "{corners} {degrees}");
            let findings =
                check::check(&plan.layers, &profile, plan::deposit_settings(&profile), &Task::new()).unwrap();
            // A post does not cool between dots, and a round one does not end where a square one does.
            let known = |kind: &str| ["cooling", "outside"].contains(&kind);
            assert!(findings.iter().all(|finding| known(finding.kind)), "{corners} {degrees}: {findings:?}");
        }
    }
}

#[test]
fn only_what_a_dot_fills_becomes_one() {
    let without = profile_by("cmt-al2319-kuka", "loop");
    let post = prism(&polygon(4, 4.6, 0.0));
    assert!(matches!(plan::plan("post", &post, &without, &Task::new()), Err(PlanError::Empty(_))));
    // A long island, one of too little metal and one with room for beads are none.
    let bar = Ring::new(vec![DVec2::ZERO, DVec2::new(9.0, 0.0), DVec2::new(9.0, 3.5), DVec2::new(0.0, 3.5)]);
    for ring in [bar, polygon(20, 1.2, 0.0), polygon(20, 12.0, 0.0)] {
        let plan = plan::plan("post", &prism(&ring), &profile(), &Task::new());
        let dots = plan.iter().flat_map(|plan| &plan.layers).flat_map(|layer| &layer.passes);
        assert_eq!(dots.filter(|pass| pass.kind == PassKind::Spot).count(), 0, "{}", ring.area());
    }
}

#[test]
fn dots_are_refused_where_the_wire_feed_changes_and_not_the_time() {
    let text = Profile::built_in_text("cmt-al2319-kuka").unwrap();
    let text = text.replacen("[process]", "[spot]\ntime = 0.9\nheight = 2.6\n\n[process]\nfollow = \"wire-feed\"", 1);
    let refused = Profile::parse(&text).unwrap_err().to_string();
    assert!(refused.contains("spot.time") && refused.contains("process.follow"), "{refused}");
}

/// The time of the trial is all the time for which the arc burns on a dot.
#[test]
fn no_crater_is_filled_on_a_dot_and_none_is_woven() {
    let mut profile = profile();
    let mesh = prism(&polygon(4, 4.6, 0.0));
    let arc = |profile: &Profile| planned(&mesh, profile).summary.metrics.arc_time_s;
    let without = arc(&profile);
    profile.start_stop.crater_fill_time = 0.8;
    assert_eq!(arc(&profile), without);
    let text = Profile::built_in_text("cmt-al2319-kuka").unwrap();
    let both = format!("{text}\n[spot]\ntime = 0.9\nheight = 2.6\n\n[weave]\nlength = 3.0\namplitude = 2.0\n");
    let refused = Profile::parse(&both).unwrap_err().to_string();
    assert!(refused.contains("spot.time") && refused.contains("weave"), "{refused}");
}

#[test]
fn a_dot_holds_the_allowance_too() {
    let mut profile = profile();
    profile.fill.machining_allowance = 0.3;
    let ring = polygon(40, 3.4, 0.0);
    let plan = planned(&prism(&ring), &profile);
    let passes = || plan.layers.iter().flat_map(|layer| &layer.passes);
    assert!(passes().count() > 0 && passes().all(|pass| pass.kind == PassKind::Spot));
    let laid: f64 = passes().map(|pass| rate(&profile) * pass.seconds(&profile.process)).sum();
    let wanted = PI * 3.7_f64.powi(2) * HIGH;
    assert!((laid / wanted - 1.0).abs() < 0.01, "{laid} for {wanted}");
}

//! Beads that depend on the heat below: walls planned as high and as wide as others measured them, the metal unchanged, and
//! nothing else of a plan.

use crate::common;
use crate::solids;

use beadwright::Profile;
use beadwright::adapt::{Feedback, Rules};
use beadwright::bead::BeadByHeat;
use beadwright::build::{self, Errors, Heat, Settings};
use beadwright::heat::{MeasuredWall, Wall, WallLaw, plate};
use beadwright::layer::Layer;
use beadwright::model::Mesh;
use beadwright::pass::Pass;
use beadwright::plan::{self, Plan};
use beadwright::profile::ProfileError;
use beadwright::task::Task;
use common::{profile, profile_by};
use glam::{DQuat, DVec3};
use solids::{cuboid, imported, mapped};

/// Walls of others (PIONEER M1, Zenodo 17608626): wait, s; height of 32 layers and width, mm.
const WALLS: [(f64, f64, f64); 5] =
    [(0.0, 39.8, 6.80), (30.0, 47.6, 5.41), (60.0, 49.0, 5.15), (120.0, 49.8, 5.03), (240.0, 50.7, 4.79)];
/// The source does not give it.
const LENGTH: f64 = 125.0;

/// The process of those walls, with the bead of the wall that waited for 60 s.
fn pioneer() -> Profile {
    let mut profile = profile_by("cmt-steel-abb", "wall");
    (profile.process.wire_feed_speed, profile.process.deposition_speed) = (4.5, 10.0);
    (profile.process.current, profile.process.voltage) = (Some(132.0), Some(14.3));
    profile.start_stop = Default::default();
    let plate = profile.substrate.as_mut().unwrap();
    (plate.thickness, plate.margin) = (12.0, 50.0);
    profile.bead.width = 5.15;
    profile.bead.height = 1.5 * 49.0 / 32.0;
    // The rest of the wire is spatter and waves.
    profile.process.efficiency = profile.bead().area() / 8.48;
    profile
}

/// What heat does to beads, from the shortest and the longest wait alone.
fn fitted(profile: &Profile) -> BeadByHeat {
    let settings = profile.heat_settings().unwrap();
    let measured =
        |(dwell, height, width)| MeasuredWall { wall: Wall { length: LENGTH, layers: 32, dwell }, height, width };
    let law = WallLaw::fit(&[measured(WALLS[0]), measured(WALLS[4])], &settings, &profile.weld_settings()).unwrap();
    law.by_heat(profile.bead.width).unwrap()
}

fn planned(mesh: &Mesh, profile: &Profile) -> Plan {
    common::planned_once("part", mesh, profile).unwrap()
}

/// A block on the plate, turned about the build direction.
fn block(size: [f64; 3], degrees: f64) -> Mesh {
    let turn = DQuat::from_rotation_z(f64::to_radians(degrees));
    imported(&mapped(&cuboid([0.0; 3], size), |p: DVec3| turn * p)).mesh
}

/// A wall as thick as its bead, whose beads are as long as those that were measured.
fn wall(profile: &Profile, height: f64, degrees: f64) -> Mesh {
    block([LENGTH + profile.bead.width, profile.bead.width, height], degrees)
}

/// Mean width of the beads above the first, mm.
fn mean_width(layers: &[Layer]) -> f64 {
    let pieces = || layers[1..].iter().flat_map(|l| &l.passes).flat_map(Pass::segments);
    let length: f64 = pieces().map(|s| s.length()).sum();
    pieces().map(|s| s.length() * s.width).sum::<f64>() / length
}

#[test]
fn walls_are_planned_as_high_and_as_wide_as_they_grow() {
    for degrees in [0.0, 33.0] {
        for (dwell, height, width) in WALLS {
            let mut profile = pioneer();
            profile.bead.by_heat = Some(fitted(&profile));
            profile.start_stop.interpass_time = dwell;
            // A little more than the 32 layers that were welded.
            let mut layers = planned(&wall(&profile, height + 4.0, degrees), &profile).layers;
            layers.truncate(32);
            let (top, own) = (layers[31].z, mean_width(&layers));
            let errors = (top / height - 1.0, own / width - 1.0);
            let warm = layers.iter().flat_map(|l| &l.temperatures).map(|t| t.mean).sum::<f64>() / layers.len() as f64;
            println!(
                "{degrees}°, wait {dwell} s: {warm:.0} °C, 32 layers {top:.1} mm high ({:+.1} %), {own:.2} mm wide ({:+.1} %)",
                100.0 * errors.0,
                100.0 * errors.1
            );
            assert!(errors.0.abs() <= 0.03 && errors.1.abs() <= 0.08, "{degrees}°, {dwell} s: {errors:?}");
            // The wire and the speed are those of every wall: the program gives the robot nothing else.
            for piece in layers[1..].iter().flat_map(|l| &l.passes).flat_map(Pass::segments) {
                assert!((piece.pace / 10.0 - 1.0).abs() < 0.02, "{}", piece.pace);
            }
        }
    }
}

#[test]
fn beads_of_filled_parts_widen_by_the_law_and_nothing_else_changes() {
    for degrees in [0.0, 20.0] {
        let mut profile = profile_by("cmt-steel-robots", "zigzag");
        // Level layers make good what wider beads have built below.
        profile.layers.level = false;
        let mesh = block([60.0, 40.0, 12.0], degrees);
        let cold = planned(&mesh, &profile);
        let law = BeadByHeat { temperature: 100.0, width: 0.004, rise: -0.001 };
        profile.bead.by_heat = Some(law);
        let warm = planned(&mesh, &profile);
        assert_eq!(cold.layers.len(), warm.layers.len());
        let mut hottest: f64 = 0.0;
        for (cold, warm) in cold.layers.iter().zip(&warm.layers) {
            assert_eq!((cold.z, cold.height), (warm.z, warm.height));
            assert_eq!(warm.temperatures.len(), warm.passes.len());
            for ((cold, warm), temperature) in cold.passes.iter().zip(&warm.passes).zip(&warm.temperatures) {
                assert_eq!((&cold.points, &cold.pace), (&warm.points, &warm.pace));
                let (length, nominal) = (cold.length(), profile.bead.width);
                let mean = |pass: &Pass| pass.segments().map(|s| s.length() * s.width).sum::<f64>() / length;
                let expected = 1.0 + (temperature.mean - 100.0) * 0.004 / nominal;
                // The law is linear; pieces are longer and shorter than those of the heat model.
                let widening = mean(warm) / mean(cold);
                assert!((widening / expected - 1.0).abs() < 0.03, "{widening} for {expected}");
                hottest = hottest.max(temperature.mean);
            }
        }
        println!("{degrees}°: up to {hottest:.0} °C ahead of the torch");
        assert!(hottest > 200.0);
        assert_eq!(cold.summary.metrics.deposited_volume_mm3, warm.summary.metrics.deposited_volume_mm3);
    }
}

#[test]
fn a_law_without_slopes_changes_nothing() {
    let mut profile = pioneer();
    let mesh = wall(&profile, 20.0, 0.0);
    let plain = planned(&mesh, &profile);
    profile.bead.by_heat = Some(BeadByHeat { temperature: 20.0, width: 0.0, rise: 0.0 });
    let level = planned(&mesh, &profile);
    assert_eq!(plain.layers.len(), level.layers.len());
    for (plain, level) in plain.layers.iter().zip(&level.layers) {
        assert_eq!((plain.z, plain.height), (level.z, level.height));
        for (plain, level) in plain.passes.iter().zip(&level.passes) {
            assert!(plain.segments().eq(level.segments()));
        }
    }
}

const PERFECT: Errors = Errors { pass: 0.0, along: 0.0, correlation: 20.0, drift: 0.0, lost: None, scan: 0.0, seed: 1 };

#[test]
fn a_wall_planned_cold_comes_out_too_low_when_it_is_hot_and_feedback_makes_up_for_it() {
    for degrees in [0.0, 45.0] {
        let profile = pioneer();
        let layers = planned(&wall(&profile, 49.0, degrees), &profile).layers;
        let built = |by: Feedback, law: Option<BeadByHeat>| {
            let plate = plate(&layers, &profile.heat_settings().unwrap(), &profile.weld_settings()).unwrap();
            let settings = Settings {
                nominal: plan::deposit_settings(&profile).nominal,
                errors: PERFECT,
                rules: Rules { window: (0.7, 1.3), spacing: profile.bead.width },
                heat: law.map(|law| Heat { plate, law, rise: profile.single_wall().unwrap().rise() }),
            };
            build::build(&layers, by, &settings, &Task::new()).unwrap().unwrap()
        };
        assert!(built(Feedback::None, None).end.rms < 1e-6);
        let level = BeadByHeat { temperature: 20.0, width: 0.0, rise: 0.0 };
        assert!(built(Feedback::None, Some(level)).end.rms < 1e-6);
        let law = fitted(&profile);
        let (open, place) = (built(Feedback::None, Some(law)), built(Feedback::Place, Some(law)));
        println!(
            "{degrees}°: without feedback {:+.1} mm, with it {:+.2} mm in {} layers instead of {}",
            open.end.mean,
            place.end.mean,
            place.layers.len(),
            layers.len()
        );
        // Welded without waits it is 39.8 mm high for 49.
        assert!((-13.0..-6.0).contains(&open.end.mean), "{}", open.end.mean);
        assert!(place.rms() < 0.5, "{}", place.rms());
        assert!(place.layers.len() > layers.len());
    }
}

#[test]
fn a_law_needs_the_values_of_heat() {
    let text = profile("plasma-304-cnc").toml_text().unwrap();
    let law = "\n[bead.by_heat]\ntemperature = 100.0\nwidth = 0.004\nrise = -0.001\n";
    let (before, after) = text.split_once("\n[heat]").unwrap();
    let after = after.split_once("\n[").unwrap().1;
    let lacking = format!("{before}\n[{after}{law}");
    match Profile::parse(&lacking) {
        Err(error @ ProfileError::Value { .. }) => assert!(error.to_string().contains("[heat]"), "{error}"),
        other => panic!("{other:?}"),
    }
}

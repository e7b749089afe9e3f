//! Input that cannot be computed is refused with a sentence.

use crate::parts::{plate, settings, wall};
use distort::{Bead, Body, Clamp, DVec3, DistortError, Elastic, Grid, Plate, Settings, build};

fn refused(plate: &Plate, beads: &[Bead], clamps: &[Clamp], settings: &Settings) -> String {
    let error = build(plate, beads, clamps, settings, &mut |_| true).unwrap_err();
    println!("{error}");
    error.to_string()
}

#[test]
fn numbers() {
    let beads = wall(0.0, 1, 0.0);
    let with = |settings: Settings| refused(&plate(), &beads, &[], &settings);
    assert!(with(Settings { voxel: 0.0, ..settings() }).contains("voxel = 0 mm"));
    assert!(with(Settings { calibration: f64::NAN, ..settings() }).contains("calibration"));
    assert!(with(Settings { elastic: Elastic { young: 210e3, poisson: 0.5 }, ..settings() }).contains("Poisson"));
    assert!(with(Settings { voxel: 0.1, voxel_height: 0.1, ..settings() }).contains("Choose voxels larger"));
    assert!(with(Settings { voxel: 0.05, voxel_height: 0.05, ..settings() }).contains("Choose voxels larger"));
}

#[test]
fn shapes() {
    let flat = Plate { high: plate().low, ..plate() };
    assert!(refused(&flat, &[], &[], &settings()).contains("no volume"));
    let with = |change: fn(&mut Bead)| {
        let mut beads = wall(0.0, 2, 0.0);
        change(&mut beads[1]);
        refused(&plate(), &beads, &[], &settings())
    };
    assert!(with(|bead| bead.points.truncate(1)).starts_with("Bead 2: it has no length"));
    assert!(
        with(|bead| bead.points[0].x = f64::NAN).contains("no length")
            || with(|bead| bead.points[0].x = f64::NAN).contains("not finite")
    );
    assert!(with(|bead| bead.points[0].x = 1e9).contains("1 km"));
    assert!(with(|bead| bead.width = -1.0).contains("width"));
    assert!(with(|bead| bead.heat = f64::INFINITY).contains("heat"));
    assert!(with(|bead| bead.end = -1.0).contains("before it starts"));
    assert!(with(|bead| bead.up = DVec3::ZERO).contains("normal"));
    let clamp = Clamp { at: DVec3::ZERO, radius: -1.0, stiffness: Clamp::FIRM };
    assert!(refused(&plate(), &[], &[clamp], &settings()).contains("radius"));
}

#[test]
fn cancelled() {
    let mut calls = 0;
    let result = build(&plate(), &wall(0.0, 3, 0.0), &[], &settings(), &mut |_| {
        calls += 1;
        calls < 2
    });
    assert_eq!((result.unwrap_err(), calls), (DistortError::Cancelled, 2));
}

/// Nothing welded, a bead that floats, one beyond the plate, and one on its edge only: no fault, and no end without result.
#[test]
fn odd_parts() {
    let all = [vec![], wall(0.0, 1, 0.0)];
    for beads in &all {
        let bent = build(&plate(), beads, &[], &settings(), &mut |_| true).unwrap();
        assert_eq!(bent.released.lift.range > 0.0, !beads.is_empty());
    }
    for shift in [DVec3::Z * 20.0, DVec3::Y * 60.0, DVec3::new(0.0, 33.0, 0.0), DVec3::NEG_Z * 20.0] {
        let mut beads = wall(0.0, 2, 0.0);
        beads.iter_mut().flat_map(|bead| &mut bead.points).for_each(|point| *point += shift);
        let bent = build(&plate(), &beads, &[], &settings(), &mut |_| true);
        println!("{shift}: {:?}", bent.as_ref().map(|bent| bent.released.lift.range));
        assert!(bent.is_ok_and(|bent| bent.released.lift.range.is_finite()));
    }
}

#[test]
fn bodies() {
    let grid = Grid { counts: [2, 2, 2], size: DVec3::ONE, low: DVec3::ZERO };
    let elastic = Elastic { young: 1e5, poisson: 0.3 };
    let mut body = Body::new(grid, elastic).unwrap();
    assert!(body.fill(8, 1.0).unwrap_err().to_string().contains("Voxel 8"));
    body.fill_all();
    body.push(0, DVec3::X);
    assert!(matches!(body.solve(1e-9), Err(DistortError::NotConverged { .. })), "nothing holds it");
    body.hold(99, DVec3::ONE);
    assert!(body.solve(1e-9).unwrap_err().to_string().contains("no metal"));
    assert!(Body::new(Grid { counts: [0, 1, 1], ..grid }, elastic).is_err());
}

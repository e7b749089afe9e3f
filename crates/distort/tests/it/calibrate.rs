//! One scan of a plate gives back the factor with which it was made.

use crate::parts::{on_corners, plate, settings, wall};
use distort::{DVec3, Settings};

#[test]
fn factor_of_a_scan() {
    let beads = wall(9.0, 4, 0.0);
    let bent = on_corners(&beads, &settings());
    let real = on_corners(&beads, &Settings { calibration: 1.37, ..settings() });
    // The scan lies somewhere else, and tilted.
    let point = |i: usize| {
        let (x, y) = (-58.0 + 7.0 * (i % 17) as f64, -28.0 + 7.0 * (i / 17) as f64);
        let lift = real.at(&real.released, DVec3::new(x, y, plate().low.z)).unwrap().z;
        DVec3::new(x, y, lift + 31.0 + 0.02 * x - 0.01 * y)
    };
    let scan: Vec<DVec3> = (0..17 * 9).map(point).collect();
    let found = bent.calibrated(&scan).unwrap();
    println!("{found:?}");
    assert!((found.factor - 1.37).abs() < 1e-6 && found.left < 1e-6 && found.measured > 0.05);
    assert!(bent.calibrated(&scan[..3]).is_err());
}

#[test]
fn proportional() {
    let beads = wall(9.0, 4, 0.0);
    let [one, two] = [1.0, 2.0].map(|calibration| on_corners(&beads, &Settings { calibration, ..settings() }));
    assert!((two.released.lift.range / one.released.lift.range - 2.0).abs() < 1e-6);
    assert!((two.released.deviation.rms / one.released.deviation.rms - 2.0).abs() < 0.01);
    let none = on_corners(&beads, &Settings { calibration: 0.0, ..settings() });
    assert_eq!((none.released.lift.range, none.released.deviation.largest), (0.0, 0.0));
}

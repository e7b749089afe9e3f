//! Where the heat lies.

use distort::{DVec3, Deposit, EccentricityScore, Warm, cooling, eccentricity};

const CAPACITY: f64 = 4.5e-3;

/// Four beads at the sides of a square plate, in an order.
fn square(order: [usize; 4]) -> EccentricityScore {
    let sides = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y].map(|side| 50.0 * side);
    let deposit = |i: usize| Deposit { time: 20.0 * i as f64, at: sides[order[i]], volume: 600.0, energy: 10e3 };
    let deposits: Vec<Deposit> = (0..4).map(deposit).collect();
    let plate = Warm { at: DVec3::ZERO, volume: 120e3, temperature: 20.0 };
    let times: Vec<f64> = (0..=300).map(f64::from).collect();
    let snapshots = cooling(&deposits, Some(plate), &times, 60.0, CAPACITY, 20.0).unwrap();
    EccentricityScore::of(&eccentricity(&snapshots, CAPACITY, 20.0).unwrap())
}

#[test]
fn opposite_sides_one_after_another() {
    let (around, across) = (square([0, 1, 2, 3]), square([0, 2, 1, 3]));
    println!("around {around:?}\nacross {across:?}");
    assert!(across.mean < around.mean);
    // Which side comes first makes no difference.
    assert!((square([2, 3, 0, 1]).mean - around.mean).abs() < 1e-9);
    assert!((around.largest - 50.0).abs() < 1.0 && around.largest_at < 20.0);
}

/// One source that cools: the closed form ∫ Q dt = E τ (1 − exp(−t/τ)).
#[test]
fn heat_of_one_source() {
    let deposits = [Deposit { time: 0.0, at: DVec3::X * 30.0, volume: 100.0, energy: 2000.0 }];
    let plate = Warm { at: DVec3::ZERO, volume: 900.0, temperature: 20.0 };
    for pieces in [10, 20, 40] {
        let times: Vec<f64> = (0..=pieces).map(|i| 100.0 * f64::from(i) / f64::from(pieces)).collect();
        let course =
            eccentricity(&cooling(&deposits, Some(plate), &times, 50.0, CAPACITY, 20.0).unwrap(), CAPACITY, 20.0)
                .unwrap();
        let heat: f64 = course.windows(2).map(|w| 0.5 * (w[1].time - w[0].time) * (w[0].heat + w[1].heat)).sum();
        let exact = 2000.0 * 50.0 * (1.0 - (-2.0f64).exp());
        println!("{pieces} pieces: ∫ Q dt {heat:.1}, exact {exact:.1} J s");
        assert!((heat / exact - 1.0).abs() < 0.4 / f64::from(pieces * pieces) * 25.0);
        // Only the source is warm, a tenth of the metal.
        assert!((EccentricityScore::of(&course).mean - 27.0).abs() < 1e-9);
    }
}

#[test]
fn nothing_warm() {
    let plate = Warm { at: DVec3::X, volume: 900.0, temperature: 10.0 };
    let found =
        eccentricity(&cooling(&[], Some(plate), &[0.0, 1.0], 50.0, CAPACITY, 20.0).unwrap(), CAPACITY, 20.0).unwrap();
    assert_eq!((found[1].heat, found[1].offset), (0.0, DVec3::ZERO));
    assert_eq!(EccentricityScore::of(&found), EccentricityScore::default());
    assert!(eccentricity(&[], f64::NAN, 20.0).is_err());
}

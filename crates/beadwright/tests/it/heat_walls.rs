//! Walls of one program welded with waits of 0 to 240 s, measured by others (PIONEER M1, Zenodo 17608626): fitted on the
//! shortest and the longest wait, the others are predicted.

use beadwright::Profile;
use beadwright::heat::{HeatSettings, MeasuredWall, Wall, WallFitError, WallLaw};
use beadwright::weld::WeldSettings;

/// Wait, s; height and width, mm.
const WALLS: [(f64, f64, f64); 5] =
    [(0.0, 39.8, 6.80), (30.0, 47.6, 5.41), (60.0, 49.0, 5.15), (120.0, 49.8, 5.03), (240.0, 50.7, 4.79)];

/// ER70S-6 wire of 1.2 mm at 4.5 m/min, 10 mm/s, 132 A, 14.3 V on a plate of 12 mm.
fn pioneer() -> (HeatSettings, WeldSettings) {
    let mut profile = Profile::built_in("cmt-steel-abb").unwrap();
    profile.process.wire_feed_speed = 4.5;
    profile.process.deposition_speed = 10.0;
    (profile.process.current, profile.process.voltage) = (Some(132.0), Some(14.3));
    profile.start_stop = Default::default();
    let substrate = profile.substrate.as_mut().unwrap();
    (substrate.thickness, substrate.margin) = (12.0, 50.0);
    let settings = HeatSettings { bead_area: 8.48, bead_width: 5.4, ..profile.heat_settings().unwrap() };
    (settings, profile.weld_settings())
}

fn measured(length: f64, (dwell, height, width): (f64, f64, f64)) -> MeasuredWall {
    MeasuredWall { wall: Wall { length, layers: 32, dwell }, height, width }
}

#[test]
fn walls_between_are_predicted() {
    let (settings, weld) = pioneer();
    // The source does not give the length.
    for length in [100.0, 125.0, 150.0] {
        let fitted = [measured(length, WALLS[0]), measured(length, WALLS[4])];
        let law = WallLaw::fit(&fitted, &settings, &weld).unwrap();
        println!("length {length} mm: {law:?}");
        for wall in WALLS {
            let own = law.predict(&measured(length, wall).wall, &settings, &weld);
            let (height, width) = (own.height / wall.1 - 1.0, own.width / wall.2 - 1.0);
            println!(
                "  wait {:3} s: {:4.0} °C, height {:.1} mm for {:.1} ({:+.1} %), width {:.2} mm for {:.2} ({:+.1} %)",
                wall.0,
                own.temperature,
                own.height,
                wall.1,
                100.0 * height,
                own.width,
                wall.2,
                100.0 * width
            );
            assert!(height.abs() <= 0.03, "wait {} s: height {height}", wall.0);
            assert!(width.abs() <= 0.08, "wait {} s: width {width}", wall.0);
        }
    }
}

#[test]
fn walls_that_determine_nothing_are_refused() {
    let (settings, weld) = pioneer();
    let one = measured(100.0, WALLS[1]);
    assert_eq!(WallLaw::fit(&[one], &settings, &weld), Err(WallFitError::TooFew));
    assert_eq!(WallLaw::fit(&[one, one], &settings, &weld), Err(WallFitError::Alike));
}

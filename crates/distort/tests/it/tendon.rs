//! A bar with one line of tendon force bends as beam theory says.

use crate::parts::built;
use distort::{Bead, DVec3, Distortion, Plate, Settings};

/// Curvature, 1/mm, along x at the lower edge, by the sagitta of the middle half.
fn curvature(bent: &Distortion, plate: &Plate) -> f64 {
    let length = plate.size().x;
    let z = |part: f64| {
        bent.at(&bent.released, DVec3::new(plate.low.x + part * length, plate.low.y, plate.low.z)).unwrap().z
    };
    (z(0.25) - 2.0 * z(0.5) + z(0.75)) / (0.25 * length).powi(2)
}

fn bar() -> Plate {
    Plate { low: DVec3::new(0.0, -10.0, -8.0), high: DVec3::new(320.0, 10.0, 0.0), stiffness: 1.0 }
}

/// A bead all along the bar. It lies inside, so it adds shrinkage, but no metal.
fn line(width: f64, height: f64, heat: f64) -> Bead {
    let points = vec![DVec3::new(0.0, 0.0, 0.0), DVec3::new(320.0, 0.0, 0.0)];
    Bead { points, width, height, heat, start: 0.0, end: 40.0, up: DVec3::Z }
}

fn by_beams(plate: &Plate, force: f64, arm: f64, young: f64) -> f64 {
    let size = plate.size();
    force * arm / (young * size.y * size.z.powi(3) / 12.0)
}

#[test]
fn whole_width() {
    for (voxel, voxel_height) in [(5.0, 2.0), (2.5, 1.0)] {
        let settings = Settings { voxel, voxel_height, across: 0.0, ..Settings::steel() };
        let (plate, bead) = (bar(), line(20.0, 2.0, 60.0));
        let bent = built(&plate, &[bead], &[], &settings);
        let exact = by_beams(&plate, settings.tendon * 60.0, 3.0, settings.elastic.young);
        let found = curvature(&bent, &plate);
        println!(
            "voxels of {voxel} mm: curvature {found:.6e}, F e/(E I) {exact:.6e}, error {:.4} %",
            100.0 * (found / exact - 1.0)
        );
        assert!((found / exact - 1.0).abs() < 1e-3);
    }
}

/// A narrow line, with strain across too: only what is along bends the bar.
#[test]
fn narrow_line() {
    let mut errors = Vec::new();
    for (voxel, voxel_height) in [(4.0, 2.0), (2.0, 1.0), (1.0, 0.5)] {
        let settings = Settings { voxel, voxel_height, ..Settings::steel() };
        let (plate, bead) = (bar(), line(4.0, 2.0, 15.0));
        let bent = built(&plate, &[bead], &[], &settings);
        let exact = by_beams(&plate, settings.tendon * 15.0, 3.0, settings.elastic.young);
        let found = curvature(&bent, &plate);
        println!(
            "voxels of {voxel} mm: curvature {found:.6e}, F e/(E I) {exact:.6e}, error {:.3} %",
            100.0 * (found / exact - 1.0)
        );
        errors.push((found / exact - 1.0).abs());
    }
    assert!(errors.iter().all(|error| *error < 0.01), "{errors:?}");
}

/// The zone beneath a bead takes the force that its section cannot, and no more than the metal has in a thin wall.
#[test]
fn zone_takes_the_force() {
    let settings = Settings { voxel: 2.0, voxel_height: 1.0, across: 0.0, ..Settings::steel() };
    let bar = bar();
    for heat in [40.0, 80.0, 160.0] {
        let bent = built(&bar, &[line(4.0, 2.0, heat)], &[], &settings);
        // The mean shortening of whole sections is that of the bar, whatever happens near the line.
        let end = |x: f64| {
            let on = bent
                .released
                .nodes
                .iter()
                .zip(&bent.released.moved)
                .map(|(&node, moved)| (bent.grid.place(node), moved.x));
            let weight = |p: DVec3| if p.y.abs() > 9.99 { 0.5 } else { 1.0 } * if p.z < -7.99 || p.z > -0.01 { 0.5 } else { 1.0 };
            let (sum, weights) =
                on.filter(|(p, _)| p.x == x).fold((0.0, 0.0), |(s, w), (p, m)| (s + weight(p) * m, w + weight(p)));
            sum / weights
        };
        let force = (end(0.0) - end(320.0)) / 320.0 * settings.elastic.young * 160.0;
        println!("{heat} J/mm: {force:.0} N, wanted {:.0}", settings.tendon * heat);
        assert!((force / (settings.tendon * heat) - 1.0).abs() < 1e-3);
    }
    // Welded over again and again, the same place shrinks only so far.
    let often: Vec<Bead> = (0..5)
        .map(|i| Bead { start: 50.0 * f64::from(i), end: 50.0 * f64::from(i) + 40.0, ..line(4.0, 2.0, 80.0) })
        .collect();
    let (once, five) = (built(&bar, &often[..1], &[], &settings), built(&bar, &often, &[], &settings));
    let ratio = five.released.lift.range / once.released.lift.range;
    println!("five passes on one line bend {ratio:.3} times as much as one");
    // Voxels at the border of the zone, which it fills in part, may shrink as much as those inside.
    assert!(ratio > 1.1 && ratio < 1.2 * settings.saturation);
}

//! Plates with beads for the other tests.

use distort::{Bead, Clamp, DVec3, Distortion, Plate, Settings, build};

/// A straight bead of 6 × 2 mm with 150 J/mm.
pub(crate) fn bead(from: [f64; 3], to: [f64; 3], start: f64) -> Bead {
    let points = vec![DVec3::from_array(from), DVec3::from_array(to)];
    let end = start + points[0].distance(points[1]) / 8.0;
    Bead { points, width: 6.0, height: 2.0, heat: 150.0, start, end, up: DVec3::Z }
}

/// A plate of 120 × 60 × 6 mm around the origin, its upper face at 0.
pub(crate) fn plate() -> Plate {
    Plate { low: DVec3::new(-60.0, -30.0, -6.0), high: DVec3::new(60.0, 30.0, 0.0), stiffness: 1.0 }
}

/// A wall of several layers along x at a given y.
pub(crate) fn wall(y: f64, layers: usize, start: f64) -> Vec<Bead> {
    let z = |i: usize| 2.0 * (i + 1) as f64;
    (0..layers).map(|i| bead([-45.0, y, z(i)], [45.0, y, z(i)], start + 100.0 * i as f64)).collect()
}

/// Voxels of 3 × 3 × 2 mm.
pub(crate) fn settings() -> Settings {
    Settings { voxel: 3.0, voxel_height: 2.0, ..Settings::steel() }
}

pub(crate) fn built(plate: &Plate, beads: &[Bead], clamps: &[Clamp], settings: &Settings) -> Distortion {
    build(plate, beads, clamps, settings, &mut |_| true).unwrap()
}

pub(crate) fn on_corners(beads: &[Bead], settings: &Settings) -> Distortion {
    built(&plate(), beads, &plate().clamped_at_corners(10.0, Clamp::FIRM), settings)
}

//! The surface of plate and part is closed, and holds all of their voxels.

use crate::parts::{on_corners, settings, wall};
use distort::{DVec3, Distortion};
use std::collections::HashMap;

#[test]
fn the_surface_is_closed_and_holds_all_metal() {
    let bent = on_corners(&wall(6.0, 4, 0.0), &settings());
    let plate = bent.born.iter().filter(|born| **born == 0).count();
    for (faces, voxels) in [(bent.surface(), bent.voxels.len()), (bent.plate_surface(), plate)] {
        let (held, metal) = (held(&bent, &faces), voxels as f64 * bent.grid.volume());
        assert!((held / metal - 1.0).abs() < 1e-9, "{held} for {metal} mm³");
    }
}

/// The volume within faces, which must leave no edge open, mm³.
fn held(bent: &Distortion, faces: &[[usize; 4]]) -> f64 {
    let mut edges: HashMap<[usize; 2], i32> = HashMap::new();
    let mut volume = 0.0;
    for face in faces {
        for k in 0..4 {
            let (a, b) = (face[k], face[(k + 1) % 4]);
            *edges.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
        }
        let [a, b, c, d] = face.map(|node| bent.grid.place(node));
        // Twice the area of the face times the distance of its plane: by Gauss, six times the volume.
        let area = (b - a).cross(d - a) + (d - c).cross(b - c);
        volume += DVec3::dot(a, area) / 6.0;
    }
    assert!(edges.values().all(|&times| times == 0), "an edge is open");
    volume
}

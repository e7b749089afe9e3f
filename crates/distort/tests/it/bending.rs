//! How a part deviates at any place.

use crate::parts::{on_corners, settings, wall};
use distort::{DVec3, Deviation};

#[test]
fn at_its_nodes_a_part_moves_as_the_build_says() {
    let bent = on_corners(&wall(6.0, 4, 0.0), &settings());
    for shape in [&bent.clamped, &bent.released] {
        let bending = bent.bending(shape);
        let welded: Vec<usize> =
            bent.voxels.iter().zip(&bent.born).filter(|(_, born)| **born > 0).map(|(v, _)| *v).collect();
        let mut nodes: Vec<usize> = welded.iter().flat_map(|&voxel| bent.grid.corners(voxel)).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let places = nodes.iter().map(|&node| bent.grid.place(node));
        let moved: Vec<(DVec3, DVec3)> = places.map(|place| (place, bending.at(place).unwrap())).collect();
        let rms = (moved.iter().map(|(_, m)| m.length_squared()).sum::<f64>() / moved.len() as f64).sqrt();
        assert!((rms / shape.deviation.rms - 1.0).abs() < 1e-9, "{rms} {}", shape.deviation.rms);
        // Nothing is left of its motion as a rigid body.
        let again = Deviation::of(moved.iter().copied());
        assert!((again.largest / shape.deviation.largest - 1.0).abs() < 1e-9);
        let turned = moved.iter().map(|&(at, m)| (at, m + DVec3::new(0.3 - 1e-3 * at.y, 1e-3 * at.x, -2.0)));
        assert!((Deviation::of(turned).rms / rms - 1.0).abs() < 1e-9);
    }
}

#[test]
fn between_and_beside_the_nodes() {
    let bent = on_corners(&wall(6.0, 4, 0.0), &settings());
    let bending = bent.bending(&bent.released);
    let (grid, at) = (bent.grid, |place: DVec3| bending.at(place).unwrap());
    // The wall is 90 × 6 × 8 mm around y = 6.
    let voxel = grid.voxel_of(DVec3::new(20.0, 6.5, 3.5)).unwrap();
    let corners = grid.corners(voxel).map(|node| grid.place(node));
    let middle = corners.iter().sum::<DVec3>() / 8.0;
    let mean = corners.iter().map(|&corner| at(corner)).sum::<DVec3>() / 8.0;
    assert!(at(middle).distance(mean) < 1e-9);
    let above = at(corners[7].with_z(8.0));
    assert!(at(corners[7].with_z(9.5)).distance(above) < 1e-9, "beside the part it moves as the nearest node");
    assert_eq!(bending.at(DVec3::new(20.0, 6.0, 40.0)), None);
    assert_eq!(bending.at(DVec3::new(1e9, 0.0, f64::NAN)), None);
}

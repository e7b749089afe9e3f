//! Solids cut by a level plane: volumes in closed form, closed surfaces, the same wherever the plane meets vertices.

use crate::solids;

use beadwright::example;
use beadwright::glam::DVec3;
use beadwright::model::{Mesh, cut};
use solids::{cuboid, facets_of, flipped, imported, joined, sphere};

/// The volume of a mesh up to a height, by its slices' areas: an integral of its own.
fn volume_above(mesh: &Mesh, z: f64) -> f64 {
    cut::above(mesh, z).map_or(0.0, |(mesh, _)| mesh.volume())
}

#[test]
fn a_cut_ball_is_a_cap() {
    let ball = imported(&sphere(20.0, 64)).mesh;
    let whole = ball.volume();
    for z in [0.0, 3.3, 10.0, 20.0, 31.7, 39.0] {
        let (cap, repair) = cut::above(&ball, z).unwrap();
        let h = 40.0 - z;
        let expected = std::f64::consts::PI * h * h * (20.0 - h / 3.0);
        // The ball has flat faces.
        let faceted = expected * whole / (4.0 / 3.0 * std::f64::consts::PI * 8000.0);
        assert!((cap.volume() - faceted).abs() < 0.01 * whole, "{z}: {} for {faceted}", cap.volume());
        assert_eq!((repair.open_edges, repair.non_manifold_edges), (0, 0), "{z}: {repair:?}");
        let (low, high) = cap.bounds();
        assert!(low.z.abs() < 1e-9 && (high.z - h).abs() < 0.1, "{z}: {low} to {high}");
    }
    assert!(cut::above(&ball, 41.0).is_none());
}

#[test]
fn cuts_through_examples_stay_closed() {
    for name in ["cross", "gear", "propeller", "vase", "star"] {
        let mesh = example::find(name).unwrap().mesh();
        let (whole, top) = (mesh.volume(), mesh.bounds().1.z);
        let mut before = whole;
        for part in [0.0, 0.1, 0.25, 0.5, 0.75, 0.999] {
            let (cut, repair) = cut::above(&mesh, part * top).unwrap();
            assert_eq!(repair.open_edges, 0, "{name} at {part}: {repair:?}");
            assert!(cut.volume() <= before + 1e-6 && cut.volume() > 0.0, "{name} at {part}");
            before = cut.volume();
            // Cut once more, it is the same as cut higher at once.
            let twice = volume_above(&cut, 0.1 * (top - part * top));
            let once = volume_above(&mesh, part * top + 0.1 * (top - part * top));
            assert!((twice - once).abs() < 1e-6 * whole, "{name} at {part}: {twice} for {once}");
        }
        assert!((volume_above(&mesh, 0.0) - whole).abs() < 1e-9 * whole, "{name}: nothing is cut off at 0");
    }
}

/// A tube's cut face has a hole; at the height of its step, vertices lie on the plane.
#[test]
fn holes_and_steps() {
    let outer = cuboid([-20.0, -20.0, 0.0], [20.0, 20.0, 30.0]);
    let inner = cuboid([-10.0, -10.0, 5.0], [10.0, 10.0, 25.0]);
    let hollow = imported(&joined(&[outer.clone(), flipped(&inner)])).mesh;
    let layers = |z: f64| (30.0 - z) * 1600.0 - (25.0 - z.max(5.0)).max(0.0) * 400.0;
    for z in [0.0, 2.0, 5.0, 5.1, 17.0, 24.999, 25.0, 29.0] {
        let (cut, repair) = cut::above(&hollow, z).unwrap();
        assert!((cut.volume() - layers(z)).abs() < 1e-6, "{z}: {} for {}", cut.volume(), layers(z));
        assert_eq!(repair.open_edges, 0, "{z}: {repair:?}");
    }
    assert_eq!(facets_of(&hollow).len(), 24);
}

/// The section of a part may cross itself by a little; it is cut all the same, and stays closed.
#[test]
fn a_prism_whose_section_crosses_itself_is_cut() {
    let outline = [(0.0, 0.0), (40.0, 0.0), (40.0, 19.98), (39.98, 20.0), (40.0, 20.0), (39.98, 19.98), (0.0, 20.0)];
    let count = outline.len() as u32;
    let vertices = [0.0, 12.0].iter().flat_map(|&z| outline.iter().map(move |&(x, y)| DVec3::new(x, y, z))).collect();
    let walls = (0..count).map(|k| (k, (k + 1) % count));
    let walls = walls.flat_map(|(a, b)| [[a, b, b + count], [a, b + count, a + count]]);
    let caps = (2..count).flat_map(|k| [[0, k, k - 1], [count, count + k - 1, count + k]]);
    let (mesh, repair) = Mesh::from_triangles(vertices, walls.chain(caps).collect());
    assert_eq!(repair.open_edges, 0, "{repair:?}");
    let (cut, repair) = cut::above(&mesh, 5.0).unwrap();
    assert_eq!(repair.open_edges, 0, "{repair:?}");
    assert!((cut.volume() / mesh.volume() - 7.0 / 12.0).abs() < 1e-4, "{} of {}", cut.volume(), mesh.volume());
}

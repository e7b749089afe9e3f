//! Meshes divided into their solids.

use bead_part::model::solid::Solid;
use bead_part::model::{Mesh, Solids};
use glam::{DVec2, DVec3};
use planar::{Polygon, Ring};

/// A box by its lowest and highest corner; a cavity where it is wound inwards.
fn block(low: f64, high: f64, inwards: bool) -> Mesh {
    let corner = |k: usize| DVec3::from_array([0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low } else { high }));
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    let mut mesh = Mesh::from_triangles((0..8).map(corner).collect(), triangles).0;
    if inwards {
        mesh.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
        mesh.neighbours.iter_mut().for_each(|across| across.swap(0, 2));
    }
    mesh
}

/// A box with a cavity, between the walls of a thin bracket of less metal.
#[test]
fn a_cavity_does_not_belong_to_what_stands_around_its_solid() {
    let outline =
        [(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (97.0, 100.0), (97.0, 3.0), (3.0, 3.0), (3.0, 100.0), (0.0, 100.0)];
    let outline = Polygon::simple(Ring::new(outline.map(DVec2::from).to_vec()));
    let Solid { vertices, triangles } = Solid::loft(&outline, &[0.0, 100.0], |p, _| p);
    let bracket = Mesh::from_triangles(vertices, triangles).0;
    assert!((64e3..512e3).contains(&bracket.volume()), "{}", bracket.volume());
    let mut mesh = block(10.0, 90.0, false);
    mesh.add(block(30.0, 70.0, true));
    mesh.add(bracket);
    let hollow = Solids::of(&mesh).mesh(&[0]).volume();
    assert!((hollow - (512e3 - 64e3)).abs() < 1e-6, "{hollow}");
}

#[test]
fn a_cavity_belongs_to_the_solid_around_it() {
    // A box with a cavity, in which a smaller box lies loose.
    let mut mesh = block(0.0, 100.0, false);
    mesh.add(block(10.0, 90.0, true));
    mesh.add(block(40.0, 60.0, false));
    let solids = Solids::of(&mesh);
    assert_eq!(solids.count(), 2);
    let volumes = [0, 1].map(|number| solids.mesh(&[number]).volume());
    assert!((volumes[0] - (1e6 - 512e3)).abs() < 1e-6 && (volumes[1] - 8e3).abs() < 1e-6, "{volumes:?}");
    // On the inner side of the wall.
    assert_eq!(solids.nearest(DVec3::new(12.0, 50.0, 50.0)), Some(0));
    assert_eq!(solids.nearest(DVec3::splat(50.0)), Some(1));
    assert_eq!(solids.mesh(&[0, 1]).triangles.len(), mesh.triangles.len());
    for number in 0..2 {
        assert_eq!(solids.nearest(solids.point(number).unwrap()), Some(number));
    }
}

//! Holes that are closed: volumes are those of the whole solid, and what is left open is reported.
#![allow(dead_code)]

use crate::solids;

use beadwright::model::holes::close;
use beadwright::report::overhang;
use glam::{DMat3, DQuat, DVec3};
use solids::{Facet, cube, facets_of, imported, sphere};

fn turned(facets: &[Facet], angle: f64) -> Vec<Facet> {
    let turn = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), angle));
    facets.iter().map(|facet| facet.map(|corner| turn * corner)).collect()
}

/// A solid without the facets whose middle lies in a ball.
fn bitten(facets: &[Facet], at: DVec3, radius: f64) -> Vec<Facet> {
    let outside = |facet: &&Facet| (facet[0] + facet[1] + facet[2]).distance(3.0 * at) > 3.0 * radius;
    facets.iter().filter(outside).copied().collect()
}

#[test]
fn a_side_of_a_cube_comes_back_whole() {
    for angle in [0.0, 0.4, 1.9] {
        let whole = turned(&cube(), angle);
        let volume = imported(&whole).mesh.volume();
        // Two facets of one side: a flat hole with four edges.
        let open = imported(&whole[2..]);
        assert!(open.repair.open_edges > 0);
        let (small, filled) = close(open.clone(), 1e-3);
        assert_eq!((filled.holes, small.mesh.triangles.len()), (0, 10));
        assert!(filled.left > 0 && filled.sentences()[0].contains("left open"));
        let (solid, filled) = close(open, 1e3);
        assert_eq!((solid.repair.open_edges, filled.left, solid.mesh.triangles.len()), (0, 0, 12));
        assert!((solid.mesh.volume() - volume).abs() < 1e-9 * volume, "{}", solid.mesh.volume());
        // Closed for any other reader too.
        assert_eq!(imported(&facets_of(&solid.mesh)).repair.open_edges, 0);
    }
}

#[test]
fn bites_of_a_sphere_are_closed_up_to_a_size() {
    let ball = sphere(20.0, 48);
    let whole = imported(&ball);
    let radius = whole.mesh.size().max_element() / 2.0;
    let middle = whole.mesh.bounds().0.midpoint(whole.mesh.bounds().1);
    let at = |direction: DVec3| middle + radius * direction.normalize();
    let bites = bitten(&ball, at(DVec3::new(1.0, 0.3, 0.2)), 0.25 * radius);
    let bites = bitten(&bites, at(DVec3::new(-0.4, 0.8, -0.5)), 0.6 * radius);
    let open = imported(&bites);
    let (some, filled) = close(open.clone(), 0.9 * radius);
    assert_eq!((filled.holes, filled.left), (1, 1), "{filled:?}");
    assert!(some.repair.open_edges > 0 && filled.widest < 0.9 * radius && filled.widest_left > 0.9 * radius);
    let (solid, filled) = close(open, 3.0 * radius);
    assert_eq!((filled.holes, filled.left, solid.repair.open_edges, solid.repair.flipped), (2, 0, 0, 0));
    // Flat covers cut off less than the caps of the bites.
    let (volume, most) = (solid.mesh.volume(), whole.mesh.volume());
    assert!(volume < most && volume > 0.9 * most, "{volume} of {most}");
}

/// Areas of the legend by hand: a cube on the plate, and one on a corner.
#[test]
fn the_picture_shows_what_hangs_over() {
    let area = |facets: &[Facet], name: &str| -> f64 {
        let picture = overhang::svg(&imported(facets).mesh).unwrap();
        let line = picture.lines().find(|line| line.contains(name)).unwrap();
        line.rsplit(": ").next().unwrap().split('<').next().unwrap().parse().unwrap()
    };
    let side = imported(&cube()).mesh.size().x;
    assert!((area(&cube(), "on the plate") - side * side).abs() < 0.1);
    assert!(area(&cube(), "leans 60 to 90°") < 0.1);
    // Standing on a corner, three sides lean by asin(1/√3) = 35.3° from the vertical.
    let corner = DMat3::from_quat(DQuat::from_rotation_arc(DVec3::ONE.normalize(), DVec3::Z));
    let standing: Vec<Facet> = cube().iter().map(|facet| facet.map(|c| corner * c)).collect();
    assert!((area(&standing, "leans 30 to 45°") - 3.0 * side * side).abs() < 0.1);
    assert!(area(&standing, "on the plate") < 0.1);
}

//! Broken meshes: what the report says, and what is left after the mending.

use crate::solids;

use beadwright::model::{Mesh, NO_NEIGHBOUR, RepairReport};
use glam::DVec3;
use proptest::prelude::*;
use solids::{Facet, cube, cuboid, facets_of, flipped, imported, joined, lathe, mapped, moved, runner, sphere};

/// The report of a cube without faults.
fn clean() -> RepairReport {
    RepairReport { triangles_read: 12, triangles: 12, vertices: 8, shells: 1, ..RepairReport::default() }
}

/// Imports the triangles and compares report, volume and size.
fn check(facets: &[Facet], expect: RepairReport, volume: f64, size: [f64; 3]) {
    let import = imported(facets);
    assert_eq!(import.repair, expect);
    assert!((import.mesh.volume() - volume).abs() < 1e-4 * volume, "{} mm³ for {volume}", import.mesh.volume());
    let off = (import.mesh.size() - DVec3::from_array(size)).abs().max_element();
    assert!(off < 1e-3, "{} for {size:?}", import.mesh.size());
    assert_neighbours(&import.mesh);
    // Winding: every edge with a neighbour runs the other way there.
    let again = imported(&facets_of(&import.mesh)).repair;
    assert_eq!((again.flipped, again.duplicate, again.inside_out), (0, 0, false), "mended twice");
}

/// Neighbours know each other across one edge that runs both ways.
fn assert_neighbours(mesh: &Mesh) {
    assert_eq!(mesh.neighbours.len(), mesh.triangles.len());
    let edge = |t: usize, e: usize| (mesh.triangles[t][e], mesh.triangles[t][(e + 1) % 3]);
    for t in 0..mesh.triangles.len() {
        for e in 0..3 {
            let n = mesh.neighbours[t][e];
            let (a, b) = edge(t, e);
            let back = |k: &usize| edge(n as usize, *k) == (b, a) && mesh.neighbours[n as usize][*k] == t as u32;
            assert!(n == NO_NEIGHBOUR || (0..3).any(|k| back(&k)), "triangle {t}, edge {e}: {n} does not agree");
        }
    }
}

/// A triangle of the cube with corners (10, 10, 10) and others.
fn at_far_corner(facets: &[Facet]) -> usize {
    facets.iter().position(|f| f.contains(&DVec3::splat(10.0))).unwrap()
}

const SIZE: [f64; 3] = [10.0; 3];

#[test]
fn a_good_cube_is_clean() {
    check(&cube(), clean(), 1000.0, SIZE);
    assert!(imported(&cube()).repair.is_clean());
    assert_eq!(imported(&cube()).repair.sentences(), [""; 0]);
}

#[test]
fn a_duplicate_triangle_goes() {
    for k in 0..12 {
        let facets = joined(&[cube(), vec![cube()[k]]]);
        check(&facets, RepairReport { triangles_read: 13, duplicate: 1, ..clean() }, 1000.0, SIZE);
        // Wound the other way it is still the same triangle.
        let facets = joined(&[cube(), flipped(&[cube()[k]])]);
        check(&facets, RepairReport { triangles_read: 13, duplicate: 1, ..clean() }, 1000.0, SIZE);
    }
}

#[test]
fn a_cube_that_is_there_twice_is_one_cube() {
    let facets = joined(&[cube(), cube()]);
    check(&facets, RepairReport { triangles_read: 24, duplicate: 12, ..clean() }, 1000.0, SIZE);
}

#[test]
fn a_missing_triangle_leaves_three_open_edges() {
    for k in 0..12 {
        let mut facets = cube();
        facets.remove(k);
        let expect = RepairReport { triangles_read: 11, triangles: 11, open_edges: 3, ..clean() };
        // Seen from the middle every triangle holds a twelfth of the volume.
        check(&facets, expect, 1000.0 * 11.0 / 12.0, SIZE);
    }
}

#[test]
fn flipped_triangles_are_turned() {
    for count in 1..6 {
        let mut facets = cube();
        facets[..count].iter_mut().for_each(|f| f.swap(0, 1));
        check(&facets, RepairReport { flipped: count, ..clean() }, 1000.0, SIZE);
        // The majority is inside out.
        let expect = RepairReport { flipped: count, inside_out: true, ..clean() };
        check(&flipped(&facets), expect, 1000.0, SIZE);
    }
}

#[test]
fn a_mesh_that_is_inside_out_is_turned() {
    check(&flipped(&cube()), RepairReport { inside_out: true, ..clean() }, 1000.0, SIZE);
}

#[test]
fn degenerate_triangles_go() {
    let [a, b, c] = cube()[0];
    let facets = joined(&[cube(), vec![[a, a, b], [c, b, c], [a, a, a]]]);
    check(&facets, RepairReport { triangles_read: 15, degenerate: 3, ..clean() }, 1000.0, SIZE);
}

#[test]
fn a_degenerate_triangle_far_away_leaves_nothing_behind() {
    let far = DVec3::new(0.0, 0.0, -500.0);
    let facets = joined(&[cube(), vec![[far, far, far]]]);
    check(&facets, RepairReport { triangles_read: 13, degenerate: 1, ..clean() }, 1000.0, SIZE);
    // Else the part would not stand on the substrate.
    let mut mesh = imported(&facets).mesh;
    mesh.place(1.0, DVec3::ZERO);
    assert_eq!(facets_of(&mesh).concat().iter().map(|v| v.z).fold(f64::INFINITY, f64::min), 0.0);
}

#[test]
fn a_sliver_that_closes_a_t_joint_stays() {
    // One edge of a face is divided, the neighbour's is not; a triangle without an area lies between.
    let mut facets = cube();
    let [a, b, c] = facets.remove(0);
    let middle = (a + b) / 2.0;
    facets.extend([[a, middle, c], [middle, b, c], [a, b, middle]]);
    check(&facets, RepairReport { triangles_read: 14, triangles: 14, vertices: 9, ..clean() }, 1000.0, SIZE);
}

#[test]
fn a_crack_is_welded() {
    let diagonal = 300.0_f64.sqrt();
    let mut facets = cube();
    let k = at_far_corner(&facets);
    for corner in facets[k].iter_mut().filter(|v| **v == DVec3::splat(10.0)) {
        *corner += DVec3::new(1e-6 * diagonal, 0.0, 0.0);
    }
    check(&facets, RepairReport { vertices_merged: 1, ..clean() }, 1000.0, SIZE);
}

#[test]
fn all_corners_shaken_within_the_crack_width_are_welded() {
    // Loose triangles whose corners disagree by up to 1 µm in 17 mm, as rounding in an exporter leaves them.
    let shake = |(i, f): (usize, Facet)| {
        let by = |k: usize| DVec3::new([0.0, 1e-5, -1e-5][(i + k) % 3], 0.0, [1e-5, 0.0][(i * k) % 2]);
        [f[0] + by(0), f[1] + by(1), f[2] + by(2)]
    };
    let facets: Vec<Facet> = cube().into_iter().enumerate().map(shake).collect();
    let import = imported(&facets);
    assert!(import.repair.vertices_merged > 8);
    let expect = RepairReport { vertices_merged: import.repair.vertices_merged, ..clean() };
    check(&facets, expect, 1000.0, SIZE);
}

#[test]
fn a_gap_wider_than_a_crack_stays_open() {
    let mut facets = cube();
    let k = at_far_corner(&facets);
    facets[k] = facets[k].map(|v| if v == DVec3::splat(10.0) { v + DVec3::new(0.01, 0.0, 0.0) } else { v });
    let repair = imported(&facets).repair;
    assert_eq!((repair.vertices_merged, repair.vertices, repair.open_edges), (0, 9, 4));
}

#[test]
fn welding_takes_no_notice_of_the_sign_of_zero() {
    let facets = cube();
    let negative: Vec<Facet> =
        mapped(&facets, |v| DVec3::from_array(v.to_array().map(|x| if x == 0.0 { -0.0 } else { x })));
    check(&joined(&[facets[..6].to_vec(), negative[6..].to_vec()]), clean(), 1000.0, SIZE);
}

#[test]
fn cubes_that_share_a_face_stay_two_solids() {
    let other = mapped(&flipped(&cube()), |v| v.with_x(20.0 - v.x));
    let facets = joined(&[cube(), other]);
    // Four edges of the face and its diagonal.
    let two = RepairReport { triangles_read: 24, triangles: 24, vertices: 12, shells: 2, ..clean() };
    check(&facets, RepairReport { non_manifold_edges: 5, ..two.clone() }, 2000.0, [20.0, 10.0, 10.0]);
    // Moved, not mirrored: the diagonals of the face differ or agree, the solids stay.
    let facets = joined(&[cube(), moved(&cube(), DVec3::X * 10.0)]);
    let repair = imported(&facets).repair;
    assert!((4..=5).contains(&repair.non_manifold_edges), "{repair:?}");
    check(&facets, RepairReport { non_manifold_edges: repair.non_manifold_edges, ..two }, 2000.0, [20.0, 10.0, 10.0]);
}

#[test]
fn cubes_that_share_an_edge_have_one_non_manifold_edge() {
    let facets = joined(&[cube(), moved(&cube(), DVec3::new(10.0, 10.0, 0.0))]);
    let expect =
        RepairReport { triangles_read: 24, triangles: 24, vertices: 14, non_manifold_edges: 1, shells: 2, ..clean() };
    check(&facets, expect, 2000.0, [20.0, 20.0, 10.0]);
}

#[test]
fn a_fin_of_two_sheets_is_no_solid_but_survives() {
    // A sheet that sticks out of the cube: its free edges are open, its root is shared by three triangles.
    let tip = DVec3::new(20.0, 5.0, 5.0);
    let [a, b] = [DVec3::new(10.0, 0.0, 0.0), DVec3::new(10.0, 10.0, 0.0)];
    let import = imported(&joined(&[cube(), vec![[a, b, tip]]]));
    assert_eq!((import.repair.open_edges, import.repair.non_manifold_edges), (3, 1));
    assert_neighbours(&import.mesh);
}

#[test]
fn shells_are_counted() {
    let shells = |parts: &[Vec<Facet>]| imported(&joined(parts)).repair.shells;
    let far = |x: f64| moved(&cube(), DVec3::X * x);
    assert_eq!(shells(&[cube()]), 1);
    assert_eq!(shells(&[cube(), far(20.0), far(40.0)]), 3);
    assert_eq!(shells(&[cube(), flipped(&cuboid([2.0; 3], [8.0; 3]))]), 2);
    assert_eq!(shells(&[sphere(5.0, 8), moved(&sphere(2.0, 8), DVec3::X * 9.0)]), 2);
    assert_eq!(shells(&[lathe(&[(5.0, 0.0), (5.0, 3.0)], 9)]), 1);
}

#[test]
fn a_cavity_is_taken_off_the_volume() {
    let facets = joined(&[cube(), flipped(&cuboid([4.0; 3], [6.0; 3]))]);
    let expect = RepairReport { triangles_read: 24, triangles: 24, vertices: 16, shells: 2, ..clean() };
    check(&facets, expect, 992.0, SIZE);
}

#[test]
fn every_fault_is_reported_in_a_sentence() {
    let faults = RepairReport {
        degenerate: 1,
        duplicate: 2,
        vertices_merged: 3,
        open_edges: 4,
        non_manifold_edges: 5,
        flipped: 6,
        inside_out: true,
        normals_against_winding: 7,
        ..clean()
    };
    assert!(!faults.is_clean());
    let text = faults.sentences().join("\n");
    let words = [
        "1 triangle without",
        "2 duplicate",
        "3 vertices merged",
        "4 open",
        "5 edges",
        "6 triangles with the wrong winding",
        "7 stored",
        "inside out",
    ];
    assert!(words.iter().all(|w| text.contains(w)), "{text}");
    assert_eq!(faults.sentences().len(), words.len());
}

#[test]
fn random_soups_never_panic_and_keep_their_books() {
    // Triangles among few points: degenerate, duplicate, non-manifold and turned ones abound.
    let facets = prop::collection::vec([0..9_usize, 0..9, 0..9], 1..40);
    runner(800)
        .run(&facets, |triangles| {
            let vertices: Vec<DVec3> =
                (0..9).map(|k| DVec3::new((k % 3) as f64 * 5.0, (k / 3) as f64 * 5.0, (k * k % 5) as f64)).collect();
            let read = triangles.len();
            let triangles = triangles.into_iter().map(|t| t.map(|i| i as u32)).collect();
            let (mesh, report) = Mesh::from_triangles(vertices, triangles);
            assert_neighbours(&mesh);
            prop_assert_eq!(report.triangles_read, read);
            prop_assert_eq!(report.triangles, mesh.triangles.len());
            prop_assert_eq!(read - report.degenerate - report.duplicate, mesh.triangles.len());
            prop_assert!(report.shells <= mesh.triangles.len());
            Ok(())
        })
        .unwrap();
}

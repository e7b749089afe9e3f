//! Slices of solids whose sections have closed forms, and what must not matter to them.

use crate::solids;

use beadwright::example;
use beadwright::slice::{BATCH, Slice, SliceOptions, Slicer};
use beadwright::task::Task;
use beadwright::warning::{WarningKind, WarningSummary, Warnings};
use glam::DVec3;
use proptest::prelude::*;
use solids::{
    Facet, cube, cuboid, facets_of, flipped, imported, joined, lathe, mapped, moved, prism, regular, runner, sphere,
    split,
};
use std::f64::consts::PI;

fn options(layer_height: f64) -> SliceOptions {
    SliceOptions { layer_height, close_gap: 0.5, simplify: 1e-4 }
}

/// All layers, after looking at what holds for every part.
fn cut(facets: &[Facet], options: SliceOptions) -> Vec<Slice> {
    let mesh = imported(facets).mesh;
    let layers = Slicer::new(&mesh, options, &Task::new()).unwrap().all(&Task::new()).unwrap();
    for (k, layer) in layers.iter().enumerate() {
        assert_eq!((layer.index, layer.height), (k, options.layer_height));
        assert!((layer.z - (k + 1) as f64 * options.layer_height).abs() < 1e-9);
        for island in &layer.islands {
            assert!(island.outer.area() > 0.0, "layer {k}: islands run counter-clockwise");
            assert!(island.holes.iter().all(|h| h.area() < 0.0), "layer {k}: holes run clockwise");
            let inside = |p| island.outer.contains(p);
            assert!(
                island.holes.iter().all(|h| h.points().iter().all(|p| inside(*p))),
                "layer {k}: a hole lies outside"
            );
        }
    }
    layers
}

/// Every layer has the area of the section at its middle, to a part in 10⁴, and nothing is warned of.
fn check(facets: &[Facet], layer_height: f64, layers: usize, area: impl Fn(f64) -> f64) {
    let found = cut(facets, options(layer_height));
    assert_eq!(found.len(), layers);
    for layer in found {
        let expect = area(layer.z - layer_height / 2.0);
        let off = (layer.area() - expect).abs();
        assert!(off < 1e-4 * expect.max(1.0), "layer {}: {} mm² for {expect}", layer.index, layer.area());
        assert_eq!(layer.warnings, [], "layer {}", layer.index);
    }
}

/// (islands, holes) of each layer.
fn topology(layers: &[Slice]) -> Vec<(usize, usize)> {
    layers.iter().map(|l| (l.islands.len(), l.islands.iter().map(|i| i.holes.len()).sum())).collect()
}

fn summaries(layers: &[Slice]) -> Vec<WarningSummary> {
    let mut warnings = Warnings::default();
    layers.iter().for_each(|l| l.warnings.iter().for_each(|w| warnings.add(*w, l.z)));
    warnings.summaries().cloned().collect()
}

#[test]
fn cube_is_a_square_on_every_layer() {
    check(&cube(), 0.5, 20, |_| 100.0);
    assert_eq!(topology(&cut(&cube(), options(0.5))), [(1, 0); 20]);
    // Collinear points where the plane meets the diagonals of the walls are gone.
    assert!(cut(&cube(), options(0.5)).iter().all(|l| l.islands[0].outer.points().len() == 4));
}

#[test]
fn a_last_layer_less_than_half_full_is_left_out() {
    for (height, layers) in [(3.0, 3), (3.4, 3), (3.5, 3), (3.6, 4), (0.2, 1), (0.6, 1)] {
        assert_eq!(cut(&cuboid([0.0; 3], [9.0, 9.0, height]), options(1.0)).len(), layers, "{height} mm");
    }
}

#[test]
fn cone_has_polygons_of_its_radius() {
    check(&lathe(&[(0.0, 0.0), (20.0, 0.0), (0.0, 40.0)], 48), 0.8, 50, |z| regular(20.0 - z / 2.0, 48));
}

#[test]
fn sphere_has_the_volume_of_its_formula() {
    let layers = cut(&sphere(10.0, 100), options(0.1));
    let volume: f64 = layers.iter().map(|l| l.area() * l.height).sum();
    assert!((volume / (4.0 / 3.0 * PI * 1000.0) - 1.0).abs() < 2e-3, "{volume}");
    for layer in layers {
        let z = layer.z - 0.05;
        let disc = PI * z * (20.0 - z);
        assert!((layer.area() - disc).abs() < 0.002 * disc + 0.1, "layer {}: {} for {disc}", layer.index, layer.area());
    }
}

#[test]
fn a_cavity_is_a_hole_where_it_is() {
    let facets = joined(&[cube(), flipped(&cuboid([2.0, 3.0, 4.0], [7.0, 8.0, 6.0]))]);
    check(&facets, 1.0, 10, |z| if (4.0..6.0).contains(&z) { 75.0 } else { 100.0 });
    let expect: Vec<_> = (0..10).map(|k| (1, usize::from(k == 4 || k == 5))).collect();
    assert_eq!(topology(&cut(&facets, options(1.0))), expect);
}

#[test]
fn a_box_in_a_hole_in_a_box_is_an_island_of_its_own() {
    let hole = flipped(&cuboid([2.0; 3], [8.0; 3]));
    let facets = joined(&[cube(), hole, cuboid([4.0; 3], [6.0; 3])]);
    check(&facets, 1.0, 10, |z| match z {
        4.0..6.0 => 100.0 - 36.0 + 4.0,
        2.0..8.0 => 100.0 - 36.0,
        _ => 100.0,
    });
    assert_eq!(topology(&cut(&facets, options(1.0)))[4], (2, 1));
}

#[test]
fn overlapping_cubes_unite_and_say_so() {
    let facets = joined(&[cube(), moved(&cube(), DVec3::new(5.0, 5.0, 2.0))]);
    let layers = cut(&facets, options(1.0));
    let areas: Vec<f64> = layers.iter().map(|l| l.area().round()).collect();
    assert_eq!(areas, [[100.0; 2].as_slice(), &[175.0; 8], &[100.0; 2]].concat());
    assert_eq!(topology(&layers), [(1, 0); 12]);
    let warnings = summaries(&layers);
    assert_eq!(
        (warnings.len(), warnings[0].kind, &warnings[0].layers[..]),
        (1, WarningKind::ContoursUnited, &[(2, 9)][..])
    );
    assert!((warnings[0].largest.size - 25.0).abs() < 1e-3);
    assert!(warnings[0].sentence().starts_with("Layers 3–10: overlapping"), "{}", warnings[0].sentence());
}

#[test]
fn cubes_that_share_a_face_are_one_island() {
    let beside = joined(&[cube(), moved(&cube(), DVec3::X * 10.0)]);
    check(&beside, 1.0, 10, |_| 200.0);
    assert_eq!(topology(&cut(&beside, options(1.0))), [(1, 0); 10]);
    let above = joined(&[cube(), moved(&cube(), DVec3::Z * 10.0)]);
    check(&above, 1.0, 20, |_| 100.0);
    // The common face lies exactly on a plane.
    check(&above, 4.0, 5, |_| 100.0);
}

#[test]
fn a_solid_wound_inwards_beside_others_is_not_lost() {
    let facets = joined(&[cube(), moved(&flipped(&cuboid([0.0; 3], [3.0, 3.0, 10.0])), DVec3::X * 20.0)]);
    let layers = cut(&facets, options(1.0));
    assert!(layers.iter().all(|l| (l.area() - 109.0).abs() < 1e-3));
    assert_eq!(summaries(&layers)[0].layers, [(0, 9)]);
}

#[test]
fn vertices_exactly_on_a_plane_do_no_harm() {
    // An octahedron with its equator on the plane at 4.5, and at every other height.
    let octahedron = lathe(&[(0.0, 0.0), (4.5, 4.5), (0.0, 9.0)], 4);
    check(&octahedron, 1.0, 9, |z| 2.0 * z.min(9.0 - z).powi(2));
    // Rings of vertices on every plane, and a seam of edges along z.
    let line: Vec<_> =
        [(0.0, 0.0)].into_iter().chain((0..=20).map(|k| (8.0, f64::from(k) / 2.0))).chain([(0.0, 10.0)]).collect();
    check(&lathe(&line, 12), 1.0, 10, |_| regular(8.0, 12));
    // A pyramid ends, and another stands on its tip, on the plane at 4.5; both beside a tower.
    let up = lathe(&[(0.0, 0.0), (4.5, 0.0), (0.0, 4.5)], 4);
    let down = moved(&lathe(&[(0.0, 4.5), (4.5, 9.0), (0.0, 9.0)], 4), DVec3::Y * 20.0);
    let tower = cuboid([10.0, 0.0, 0.0], [12.0, 2.0, 9.0]);
    let tips = joined(&[up, down, tower]);
    check(&tips, 1.0, 9, |z| 4.0 + 2.0 * (z - 4.5).powi(2));
    assert_eq!(topology(&cut(&tips, options(1.0)))[4], (1, 0));
}

/// A staircase along x whose treads lie at 0.5, 1.5, 2.5 … and are 3 mm deep.
fn stairs(steps: usize) -> Vec<Facet> {
    let mut outline = vec![(0.0, 0.0), (3.0 * steps as f64, 0.0)];
    for k in (0..steps).rev() {
        let tread = (steps - k) as f64 - 0.5;
        outline.extend([(3.0 * (k + 1) as f64, tread), (3.0 * k as f64, tread)]);
    }
    mapped(&prism(&outline, 2.0), |v| DVec3::new(v.x, -v.z, v.y))
}

#[test]
fn a_plane_in_a_horizontal_face_takes_the_section_below_it() {
    assert_eq!(imported(&stairs(6)).repair.open_edges, 0);
    check(&stairs(6), 1.0, 5, |z| 2.0 * 3.0 * (6.0 - (z - 0.5).round()));
    // Upside down the treads are ceilings; a foot of 0.5 mm puts them on the planes again.
    let ceiling = mapped(&stairs(6), |v| DVec3::new(v.x, -v.y, 6.0 - v.z));
    check(&ceiling, 1.0, 6, |z| 2.0 * 3.0 * (z - 0.5).round());
}

#[test]
fn thousands_of_layers_on_twelve_triangles() {
    let layers = cut(&cuboid([0.0; 3], [30.0, 20.0, 50.0]), options(0.01));
    assert_eq!(layers.len(), 5000);
    assert!(layers.iter().all(|l| (l.area() - 600.0).abs() < 1e-6 && l.islands[0].outer.points().len() == 4));
}

#[test]
fn batches_in_any_order_are_the_same_layers() {
    let mesh = imported(&sphere(10.0, 12)).mesh;
    let slicer = Slicer::new(&mesh, options(0.1), &Task::new()).unwrap();
    assert_eq!((slicer.layer_count(), slicer.batch_count()), (200, 200_usize.div_ceil(BATCH)));
    let mut batches: Vec<_> = (0..slicer.batch_count()).rev().map(|b| slicer.batch(b, &Task::new()).unwrap()).collect();
    batches.reverse();
    assert_eq!(batches.concat(), slicer.all(&Task::new()).unwrap());
}

fn areas(facets: &[Facet]) -> Vec<f64> {
    cut(facets, options(0.7)).iter().map(Slice::area).collect()
}

/// Parts with slopes, holes and several islands.
fn varied() -> Vec<Vec<Facet>> {
    let example = |name: &str| facets_of(&example::find(name).unwrap().mesh());
    let towers = joined(&[sphere(6.0, 10), moved(&lathe(&[(0.0, 0.0), (5.0, 0.0), (0.0, 12.0)], 7), DVec3::X * 15.0)]);
    let hollow = joined(&[sphere(9.0, 9), moved(&flipped(&sphere(5.0, 7)), DVec3::Z * 3.3)]);
    vec![towers, hollow, example("vase"), example("gear")]
}

/// The changed mesh has the same areas, layer by layer.
fn unchanged_by(change: impl Fn(&[Facet]) -> Vec<Facet>) {
    for facets in varied() {
        let (before, after) = (areas(&facets), areas(&change(&facets)));
        assert_eq!(before.len(), after.len());
        for (k, (a, b)) in before.iter().zip(&after).enumerate() {
            assert!((a - b).abs() < 1e-5 * a.max(1.0), "layer {k}: {a} and {b}");
        }
    }
}

#[test]
fn the_order_of_triangles_does_not_matter() {
    for facets in varied() {
        let before = areas(&facets);
        runner(4)
            .run(&Just(facets).prop_shuffle(), |shuffled| {
                let after = areas(&shuffled);
                prop_assert!(before.iter().zip(&after).all(|(a, b)| (a - b).abs() < 1e-6 * a.max(1.0)));
                Ok(())
            })
            .unwrap();
    }
    unchanged_by(|facets| facets.iter().map(|&[a, b, c]| [b, c, a]).collect());
}

#[test]
fn turning_about_z_does_not_matter() {
    unchanged_by(|facets| mapped(facets, |v| DVec3::new(-v.y, v.x, v.z)));
}

#[test]
fn moving_in_x_and_y_does_not_matter() {
    unchanged_by(|facets| mapped(facets, |v| v + DVec3::new(64.0, -32.0, 0.0)));
}

#[test]
fn mirroring_does_not_matter() {
    unchanged_by(|facets| flipped(&mapped(facets, |v| v.with_x(-v.x))));
    // Not wound again, the mesh is inside out and is turned at import.
    unchanged_by(|facets| mapped(facets, |v| v.with_y(-v.y)));
}

#[test]
fn splitting_triangles_does_not_matter() {
    unchanged_by(split);
}

#[test]
fn a_tube_without_caps_is_still_a_ring_on_every_layer() {
    check(&lathe(&[(8.0, 0.0), (8.0, 5.0), (8.0, 10.0)], 24), 1.0, 10, |_| regular(8.0, 24));
    check(&flipped(&lathe(&[(8.0, 0.0), (4.0, 10.0)], 24)), 1.0, 10, |z| regular(8.0 - 0.4 * z, 24));
}

/// A tube of radius 8 mm without caps, 10 mm high, whose wall has a slit of 2 mm below z = 5.
fn slit_tube() -> Vec<Facet> {
    let n = 24;
    let slit = 2.0 * (1.0 / 8.0_f64).asin();
    let at = |i: usize, z: f64| {
        // Angles go once round but for the slit, so that the last column of the lower half is left out.
        let angle = slit / 2.0 + (std::f64::consts::TAU - slit) * i.min(n) as f64 / n as f64;
        let angle = if i > n { slit / 2.0 } else { angle };
        DVec3::new(8.0 * angle.cos(), 8.0 * angle.sin(), z)
    };
    let band = |low: f64, high: f64, columns: usize| {
        (0..columns).flat_map(move |i| {
            let [a, b, c, d] = [at(i, low), at(i + 1, low), at(i + 1, high), at(i, high)];
            [[a, b, c], [a, c, d]]
        })
    };
    band(0.0, 5.0, n).chain(band(5.0, 10.0, n + 1)).collect()
}

#[test]
fn a_slit_wider_than_close_gap_drops_the_contours_and_says_where() {
    let layers = cut(&slit_tube(), SliceOptions { close_gap: 1.9, ..options(1.0) });
    let islands: Vec<usize> = layers.iter().map(|l| l.islands.len()).collect();
    assert_eq!(islands, [0, 0, 0, 0, 0, 1, 1, 1, 1, 1]);
    let warnings = summaries(&layers);
    assert_eq!(warnings.len(), 1);
    let dropped = &warnings[0];
    assert_eq!((dropped.kind, dropped.count, &dropped.layers[..]), (WarningKind::OpenContourDropped, 5, &[(0, 4)][..]));
    // Once round the tube, less the slit.
    assert!((dropped.largest.size - (2.0 * PI * 8.0 - 2.0)).abs() < 0.3, "{}", dropped.largest.size);
    let sentence = dropped.sentence();
    assert!(
        sentence.starts_with("Layers 1–5: 5 open contours dropped") && sentence.contains("slice.close_gap"),
        "{sentence}"
    );
}

#[test]
fn a_slit_narrower_than_close_gap_is_bridged_and_says_so() {
    let layers = cut(&slit_tube(), SliceOptions { close_gap: 2.1, ..options(1.0) });
    assert_eq!(topology(&layers), [(1, 0); 10]);
    assert!(layers.iter().all(|l| (l.area() - layers[9].area()).abs() < 1e-3));
    let warnings = summaries(&layers);
    assert_eq!(warnings.len(), 1);
    let closed = &warnings[0];
    assert_eq!((closed.kind, closed.count, &closed.layers[..]), (WarningKind::GapClosed, 5, &[(0, 4)][..]));
    assert!((closed.largest.size - 2.0).abs() < 1e-3);
    assert!(
        (closed.largest.place.x - 8.0).abs() < 0.1 && closed.largest.place.y.abs() < 1.1,
        "{}",
        closed.largest.place
    );
}

#[test]
fn loose_walls_are_joined_to_one_ring() {
    // Four walls of a box in any order and winding, 0.2 mm apart at the corners.
    let wall = |a: (f64, f64), b: (f64, f64)| {
        let [a, b] = [a, b].map(|(x, y)| DVec3::new(x, y, 0.0));
        vec![[a, b, b.with_z(4.0)], [a, b.with_z(4.0), a.with_z(4.0)]]
    };
    let walls = [
        wall((0.2, 0.0), (10.0, 0.0)),
        flipped(&wall((0.2, 10.0), (10.0, 10.0))),
        wall((10.0, 0.2), (10.0, 10.0)),
        wall((0.0, 10.0), (0.0, 0.2)),
    ];
    let layers = cut(&joined(&walls), options(1.0));
    assert!(layers.iter().all(|l| l.islands.len() == 1 && (l.area() - 100.0).abs() < 1.0));
    assert!(summaries(&layers).iter().any(|w| w.kind == WarningKind::GapClosed && w.largest.size < 0.3));
}

#[test]
fn one_and_two_threads_cut_the_same() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| varied().iter().chain([&slit_tube()]).map(|f| cut(f, options(0.3))).collect::<Vec<_>>())
    };
    assert_eq!(with(1), with(2));
}

//! The strategies of the field that ours are compared with: what each promises, checked without the fallback of `plan`.

use crate::common;
use crate::families;

use beadwright::example;
use beadwright::fill::{Fill, Path, sound};
use beadwright::glam::DVec3;
use beadwright::plan;
use beadwright::planar::{DVec2, Polygon, Ring};
use beadwright::slice::Slicer;
use beadwright::task::Task;
use common::{flat, profile_by};
use std::f64::consts::PI;

const BASELINES: [&str; 5] = ["spiral", "fermat", "hilbert", "partition", "mat"];
const PARTS: [&str; 4] = ["cross", "star", "gear", "propeller"];

fn filled(strategy: &str, island: &Polygon) -> Fill {
    let profile = profile_by("cmt-al2319-kuka", strategy);
    profile.fill.strategy.strategy().fill(island, &profile.fill_settings(0))
}

fn paths(fill: &Fill) -> Vec<&Path> {
    fill.stages.iter().flatten().collect()
}

/// The islands of the third layer of an example, turned.
fn islands_of(part: &str, turn: f64) -> Vec<Polygon> {
    let mut mesh = example::find(part).unwrap().mesh();
    mesh.place(1.0, DVec3::new(0.0, 0.0, turn));
    let profile = profile_by("cmt-al2319-kuka", "contour");
    Slicer::new(&mesh, profile.slice_options(), &Task::new()).unwrap().all(&Task::new()).unwrap().remove(2).islands
}

#[test]
fn baselines_stay_inside_and_cross_nothing_at_any_angle() {
    for part in PARTS {
        for turn in [0.0, 17.0, 45.0] {
            for island in islands_of(part, turn) {
                for strategy in BASELINES {
                    let fill = filled(strategy, &island);
                    let fault = sound::fault(&paths(&fill), &island, 0.0);
                    assert!(fault.is_none() && !fill.is_empty(), "{strategy} on {part} at {turn}°: {fault:?}");
                }
            }
        }
    }
}

#[test]
fn spirals_have_one_start_an_island() {
    for part in PARTS {
        for turn in [0.0, 17.0, 45.0] {
            for island in islands_of(part, turn) {
                for strategy in ["spiral", "fermat"] {
                    let fill = filled(strategy, &island);
                    let lengths: Vec<f64> = paths(&fill).iter().map(|path| path.length()).collect();
                    assert_eq!(lengths.len(), 1, "{strategy} on {part} at {turn}°: {lengths:?}");
                    // Opening rings and linking them hardly changes the length.
                    let rings: f64 = paths(&filled("contour", &island)).iter().map(|path| path.length()).sum();
                    assert!((lengths[0] / rings - 1.0).abs() < 0.03, "{strategy} on {part}: {} of {rings}", lengths[0]);
                }
            }
        }
    }
}

fn disc(radius: f64) -> Polygon {
    let points = (0..360).map(|k| DVec2::from_angle(f64::from(k) * PI / 180.0) * radius);
    Polygon::simple(Ring::new(points.collect()))
}

fn square(half: f64) -> Polygon {
    let corners = [(-half, -half), (half, -half), (half, half), (-half, half)];
    Polygon::simple(Ring::new(corners.map(|(x, y)| DVec2::new(x, y)).to_vec()))
}

#[test]
fn a_spiral_ends_in_the_middle_and_a_fermat_spiral_beside_its_beginning() {
    let profile = profile_by("cmt-al2319-kuka", "spiral");
    let (radius, d) = (50.0, profile.stepover());
    let ends = |strategy: &str| {
        let fill = filled(strategy, &disc(radius));
        let path = paths(&fill)[0].path();
        (path[0], *path.last().unwrap())
    };
    let (from, to) = ends("spiral");
    assert!(from.length() > radius - profile.bead.width && to.length() < 1.5 * d, "{from} {to}");
    let (from, to) = ends("fermat");
    assert!(from.distance(to) < 2.5 * d && from.length().min(to.length()) > radius - 2.5 * d, "{from} {to}");
}

#[test]
fn a_hilbert_curve_fills_its_square_with_steps_of_one_stepover() {
    // The core of this square holds 8 × 8 cells.
    let profile = profile_by("cmt-al2319-kuka", "hilbert");
    let (d, w) = (profile.stepover(), profile.bead.width);
    let inset = w / 2.0 + profile.fill_settings(0).contour_gap;
    // Both ends reach a quarter of a stepover further, to the edge of the core. The curve begins anew in each quarter around the datum.
    let side = 8.0 * d - d / 2.0;
    let corners =
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| DVec2::new(x, y) * (side + 2.0 * inset));
    let moved = corners.map(|p| p + d / 4.0 - inset);
    let fill = filled("hilbert", &Polygon::simple(Ring::new(moved.to_vec())));
    let infill: Vec<_> = paths(&fill).into_iter().filter(|path| !path.closed).collect();
    assert_eq!(infill.len(), 1);
    assert_eq!(
        infill[0].points.len(),
        infill[0].points.iter().map(|p| p.round().as_ivec2()).collect::<std::collections::HashSet<_>>().len()
    );
    assert!((infill[0].length() - 63.5 * d).abs() < 1e-3, "{} mm", infill[0].length());
}

#[test]
fn convex_parts_are_one_cell_and_an_l_is_two() {
    // A cell with a rounded corner has a short line there besides its zigzag.
    let zigzag = |path: &&&Path| !path.closed && path.length() > 100.0;
    let cells = |island: &Polygon| paths(&filled("partition", island)).iter().filter(zigzag).count();
    assert_eq!([cells(&square(40.0)), cells(&disc(40.0))], [1, 1]);
    let corners = [(0.0, 0.0), (100.0, 0.0), (100.0, 40.0), (40.0, 40.0), (40.0, 120.0), (0.0, 120.0)];
    for turn in [0.0_f64, 33.0] {
        let way = DVec2::from_angle(turn.to_radians());
        let points = corners.map(|(x, y)| way.rotate(DVec2::new(x, y)));
        assert_eq!(cells(&Polygon::simple(Ring::new(points.to_vec()))), 2);
    }
}

#[test]
fn rings_from_the_medial_axis_fill_a_strip_whatever_its_width() {
    let profile = profile_by("cmt-al2319-kuka", "mat");
    for width in [31.0, 35.0, 38.5, 42.0] {
        let corners = [(0.0, 0.0), (200.0, 0.0), (200.0, width), (0.0, width)];
        let strip = Polygon::simple(Ring::new(corners.map(|(x, y)| DVec2::new(x, y)).to_vec()));
        let fill = filled("mat", &strip);
        let rings = paths(&fill);
        assert!(rings.iter().all(|path| path.closed));
        // From the axis outwards: each ring lies around the one before.
        let areas: Vec<f64> = rings.iter().map(|path| Ring::new(path.points.clone()).area().abs()).collect();
        assert!(areas.is_sorted(), "{areas:?}");
        // The beads across the middle share its width.
        let across: f64 = rings
            .iter()
            .map(|path| {
                let nearest = (0..path.points.len()).min_by_key(|i| {
                    let (a, b) = (path.points[*i], path.points[(i + 1) % path.points.len()]);
                    let crosses = (a.x - 100.0) * (b.x - 100.0) <= 0.0 && a.y.min(b.y) < width / 2.0;
                    usize::from(!crosses)
                });
                2.0 * path.width.after(nearest.unwrap())
            })
            .sum();
        // At both sides a bead reaches beyond its cell, to the edge of the strip.
        let (w, d) = (profile.bead.width, profile.stepover());
        let room = (width - (w - d)) * w / d;
        assert!((across / room - 1.0).abs() < 0.06, "{width} mm: beads of {across} mm for {room} mm");
    }
}

/// Where a baseline is not sound, `plan` takes contours and says so; that must be the exception.
#[test]
fn baselines_seldom_need_to_be_replaced() {
    for strategy in BASELINES {
        let (mut islands, mut faulty) = (0, Vec::new());
        for family in 0..families::FAMILIES.len() {
            for seed in 0..4 {
                for island in families::islands(family, seed) {
                    islands += 1;
                    let fault = sound::fault(&paths(&filled(strategy, &island)), &island, 0.0);
                    faulty.extend(fault.map(|fault| (families::FAMILIES[family], seed, fault)));
                }
            }
        }
        assert!(50 * faulty.len() <= islands, "{strategy}: {} of {islands}: {faulty:?}", faulty.len());
    }
}

#[test]
fn contours_in_place_of_walls_bring_the_metal_of_the_part() {
    // Layers of walls are thinner than those of beads side by side.
    for (name, turn) in [("propeller", 0.0), ("gear", 17.0)] {
        let mut mesh = example::find(name).unwrap().mesh();
        mesh.place(1.0, DVec3::new(0.0, 0.0, turn));
        let filled = |strategy: &str| {
            let plan = plan::plan(name, &mesh, &flat(profile_by("cmt-al2319-kuka", strategy)), &Task::new()).unwrap();
            plan.summary.metrics.deposited_volume_mm3 / plan.summary.metrics.part_volume_mm3
        };
        let (wall, contour) = (filled("wall"), filled("contour"));
        assert!((wall / contour - 1.0).abs() < 0.1, "{name}: {wall}, contours {contour}");
    }
}

//! Triangles fill a polygon with holes exactly.

use crate::shapes;

use planar::triangulate::{triangulate, triangulate_by_edges};
use planar::{DVec2, Polygon, Ring};
use proptest::prelude::*;
use shapes::{config, star, three_holes};
use std::collections::{HashMap, HashSet};
use std::f64::consts::{SQRT_2, TAU};

fn triangles(polygon: &Polygon) -> Vec<[DVec2; 3]> {
    let points: Vec<DVec2> = polygon.rings().flat_map(|r| r.points()).copied().collect();
    triangulate(polygon).iter().map(|t| t.map(|i| points[i])).collect()
}

fn area(t: &[DVec2; 3]) -> f64 {
    Ring::new(t.to_vec()).area()
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn triangles_fill_the_polygon(region in star()) {
        let polygon = &region.polygons()[0];
        let triangles = triangles(polygon);
        let corners: usize = polygon.rings().map(|r| r.points().len()).sum();
        prop_assert_eq!(triangles.len(), corners + 2 * polygon.holes.len() - 2);
        prop_assert!(triangles.iter().all(|t| area(t) >= 0.0));
        let total: f64 = triangles.iter().map(area).sum();
        prop_assert!((total - polygon.area()).abs() < 1e-9 * polygon.outer.area());
        for t in triangles.iter().filter(|t| area(t) > 1e-6) {
            prop_assert!(polygon.contains((t[0] + t[1] + t[2]) / 3.0));
        }
    }
}

#[test]
fn a_plate_with_three_holes() {
    let plate = three_holes();
    let triangles = triangles(&plate.polygons()[0]);
    // Collinear corners: the number of triangles is not fixed.
    assert!((triangles.iter().map(area).sum::<f64>() - plate.area()).abs() < 1e-9);
}

#[test]
fn nothing_to_fill() {
    assert!(triangulate(&Polygon::default()).is_empty());
}

/// Every edge has another triangle on its other side or is one of the polygon, and the area is that of the polygon.
fn assert_closed(base: &Polygon, case: &str) {
    let points: Vec<DVec2> = base.rings().flat_map(|ring| ring.points()).copied().collect();
    let triangles = triangulate_by_edges(base);
    let total: f64 = triangles.iter().map(|t| area(&t.map(|i| points[i]))).sum();
    assert!((total / base.area() - 1.0).abs() < 1e-9, "{case}: {total} for {}", base.area());
    let mut edges: Vec<[usize; 2]> = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    edges.sort_unstable();
    assert!(edges.windows(2).all(|pair| pair[0] != pair[1]), "{case}: an edge belongs to two triangles on one side");
    let all: HashSet<[usize; 2]> = edges.iter().copied().collect();
    let rim: Vec<[usize; 2]> = edges.into_iter().filter(|&[i, j]| !all.contains(&[j, i])).collect();
    let (mut wanted, mut first) = (Vec::new(), 0);
    for ring in base.rings() {
        let count = ring.points().len();
        wanted.extend((0..count).map(|k| [first + k, first + (k + 1) % count]));
        first += count;
    }
    wanted.sort_unstable();
    assert!(rim == wanted, "{case}: an edge inside is open, or one of the polygon is missing");
}

/// A square with `count` points on each side, up to `off` (mm) beside them.
fn square(middle: DVec2, side: f64, degrees: f64, (count, off): (u32, f64)) -> Ring {
    let corner = |k: u32| middle + DVec2::from_angle(TAU / 4.0 * f64::from(k) + degrees.to_radians()) * side / SQRT_2;
    let sides = (0..4).flat_map(|k| (0..count).map(move |i| (k, i)));
    let beside = |k: u32, i: u32| DVec2::from_angle(f64::from(97 * k + 31 * i) + side) * off * f64::from((k + i) % 3);
    Ring::new(
        sides.map(|(k, i)| corner(k).lerp(corner(k + 1), f64::from(i) / f64::from(count)) + beside(k, i)).collect(),
    )
}

/// A cut through a flat face of many triangles has points in line but for the last digits.
#[test]
fn many_points_in_line_leave_no_edge_open() {
    for count in [1, 2, 3, 5, 8, 40] {
        for degrees in [0.0, 17.0, 45.0] {
            for off in [0.0, 1e-15, 1e-12, 1e-10, 1e-9, 1e-6] {
                let way = DVec2::from_angle(f64::to_radians(degrees));
                let square = |at: f64, side: f64| square(way * at, side, 45.0 + degrees, (count, off));
                let holes = [-20.0, -10.0, 0.0, 10.0, 20.0].map(|at| square(at, 6.0).reversed());
                for holes in [&[], &[square(0.0, 30.0).reversed()][..], &holes] {
                    let base = Polygon { outer: square(0.0, 60.0), holes: holes.to_vec() };
                    assert_closed(&base, &format!("{count} points, {degrees}°, {off} mm, {} holes", holes.len()));
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn no_edge_is_open(region in star()) {
        assert_closed(&region.polygons()[0], "a star");
    }
}

/// A hole that shares an edge with the outline, as cuts make them: the edge bounds nothing.
#[test]
fn an_edge_run_there_and_back_bounds_nothing() {
    let ring = |points: &[(f64, f64)]| Ring::new(points.iter().map(|&(x, y)| DVec2::new(x, y)).collect());
    let outer = ring(&[(0.0, 0.0), (10.0, 0.0), (30.0, 0.0), (40.0, 0.0), (40.0, 20.0), (0.0, 20.0)]);
    let hole = ring(&[(10.0, 0.0), (10.0, 8.0), (30.0, 8.0), (30.0, 0.0)]);
    let base = Polygon { outer, holes: vec![hole] };
    let points: Vec<DVec2> = base.rings().flat_map(|ring| ring.points()).copied().collect();
    let total: f64 = triangulate_by_edges(&base).iter().map(|t| area(&t.map(|i| points[i]))).sum();
    assert!((total - 640.0).abs() < 1e-9, "{total}");
}

/// The edges of all triangles together are those of the polygon, and none of them has the corners of another: a mesh keeps
/// all of them.
fn assert_whole(base: &Polygon, case: &str) {
    let triangles = triangulate_by_edges(base);
    let mut edges = HashMap::new();
    let mut run = |[from, to]: [usize; 2], times: i32| {
        *edges.entry([from.min(to), from.max(to)]).or_insert(0) += if from < to { times } else { -times };
    };
    triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).for_each(|edge| run(edge, 1));
    let mut first = 0;
    for ring in base.rings() {
        let count = ring.points().len();
        (0..count).for_each(|k| run([first + k, first + (k + 1) % count], -1));
        first += count;
    }
    assert!(edges.values().all(|times| *times == 0), "{case}: an edge is open");
    let mut corners = triangles.clone();
    corners.iter_mut().for_each(|triangle| triangle.sort_unstable());
    let all: HashSet<[usize; 3]> = corners.iter().copied().collect();
    assert_eq!(all.len(), triangles.len(), "{case}: a triangle comes twice");
}

/// A corner that runs across itself.
#[test]
fn a_rectangle_whose_corner_crosses_itself_is_filled() {
    let corners = [(0.0, 0.0), (40.0, 0.0), (40.0, 19.98), (39.98, 20.0), (40.0, 20.0), (39.98, 19.98), (0.0, 20.0)];
    for turned in [0.0, 30.0, 211.0] {
        let way = DVec2::from_angle(f64::to_radians(turned));
        let base = Polygon { outer: Ring::new(corners.map(|p| way.rotate(p.into())).to_vec()), holes: Vec::new() };
        assert_whole(&base, &format!("{turned}°"));
    }
}

/// Where points of a cut lie on the wrong side of each other by a little, only triangles beside them overlap.
#[test]
fn where_edges_cross_the_rest_is_filled_all_the_same() {
    let circle = |radius: f64, count: u32| -> Vec<DVec2> {
        (0..count).map(|k| DVec2::from_angle(TAU * f64::from(k) / f64::from(count)) * radius).collect()
    };
    for off in [1e-9, 1e-6, 1e-3] {
        let mut outer = circle(20.0, 200);
        // A step back along the circle, twice, and points that change places.
        outer.swap(17, 18);
        outer.insert(90, outer[88] * (1.0 + off));
        outer.insert(150, outer[148] * (1.0 - off));
        let mut hole = circle(0.4, 60);
        hole.reverse();
        hole.swap(5, 6);
        let base = Polygon { outer: Ring::new(outer), holes: vec![Ring::new(hole)] };
        let points: Vec<DVec2> = base.rings().flat_map(|ring| ring.points()).copied().collect();
        let triangles = triangulate_by_edges(&base);
        let areas: Vec<f64> = triangles.iter().map(|t| area(&t.map(|i| points[i]))).collect();
        let (total, all): (f64, f64) = (areas.iter().sum(), areas.iter().map(|area| area.abs()).sum());
        assert!((total / base.area() - 1.0).abs() < 1e-9, "{off} mm: {total} for {}", base.area());
        assert!(all - total < 2.0, "{off} mm: {} mm² lie twice", all - total);
        let covers = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|i| points[i]);
            [a.perp_dot(b), b.perp_dot(c), c.perp_dot(a)].into_iter().all(|side| side > 0.0)
        };
        assert!(!triangles.iter().any(covers), "{off} mm: a triangle covers the hole");
        assert_whole(&base, &format!("{off} mm"));
    }
}

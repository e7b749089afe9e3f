//! Growing and shrinking: closed forms, Steiner's formula, distances by brute force, the library Clipper2.

use crate::shapes;

use clipper2_rust::{EndType, JoinType, inflate_paths_64};
use planar::offset::{ARC_TOLERANCE_MM, SIMPLIFY_MM};
use planar::{DVec2, FillRule, Join, Region, Ring};
use proptest::prelude::*;
use shapes::{
    clipper_area, config, convex, distance_to_boundary, dumbbell, map_points, plate, same_shapes, star,
    symmetric_difference, three_holes, to_clipper, v,
};
use std::f64::consts::{FRAC_PI_2, PI};

const MITER: Join = Join::Miter(10.0);

/// How far the boundary of an offset may lie from the true one: arc, simplification, grid.
const BOUNDARY_MM: f64 = ARC_TOLERANCE_MM + SIMPLIFY_MM + 2e-4;

/// What that may do to the area of an offset of straight edges and full circles of radii `radii` in all.
fn area_error(straight: f64, radii: f64) -> f64 {
    let arcs = 2.0 * PI * radii;
    straight * (BOUNDARY_MM - ARC_TOLERANCE_MM) + arcs * BOUNDARY_MM
}

/// Difference of two areas as a part of what their boundary may enclose.
fn error_of(expected: f64, found: f64, perimeter: f64) -> f64 {
    (found - expected).abs() / (perimeter * BOUNDARY_MM)
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn a_rectangle_grows_by_steiners_formula(w in 1.0..100.0, h in 1.0..100.0, d in 0.05..20.0f64) {
        let rect = plate(w, h, &[]);
        let round = rect.offset(d, Join::ROUND).area();
        prop_assert!(f64::abs(round - (w * h + 2.0 * (w + h) * d + PI * d * d)) < area_error(2.0 * (w + h), d));
        let mitred = rect.offset(d, MITER).area();
        prop_assert!(f64::abs(mitred - (w + 2.0 * d) * (h + 2.0 * d)) < 4.0 * (w + h + 4.0 * d) * planar::GRID_MM);
    }

    #[test]
    fn a_plate_shrinks_and_its_holes_grow(d in 0.05..2.0f64) {
        let plate = three_holes();
        let found = plate.offset(-d, Join::ROUND);
        let holes: f64 = [(10.0, 7.0), (15.0, 15.0), (18.0, 8.0)].iter()
            .map(|(w, h)| w * h + 2.0 * d * (w + h) + PI * d * d).sum();
        let expected = (60.0 - 2.0 * d) * (40.0 - 2.0 * d) - holes;
        prop_assert!((found.area() - expected).abs() < area_error(plate.perimeter(), 3.0 * d));
        prop_assert_eq!(found.euler(), -2);
    }

    #[test]
    fn a_convex_polygon_comes_back(region in convex(), d in 0.05..1.0f64) {
        let back = region.offset(-d, MITER).offset(d, MITER);
        prop_assert!(symmetric_difference(&region, &back) < 2.0 * SIMPLIFY_MM * region.perimeter());
        let opened = region.offset(d, Join::ROUND).offset(-d, Join::ROUND);
        prop_assert!(symmetric_difference(&region, &opened) < 2.0 * BOUNDARY_MM * region.perimeter());
    }

    #[test]
    fn inward_vertices_follow_the_formula(region in convex(), d in 0.05..1.0f64) {
        let q = region.polygons()[0].outer.points();
        let n = q.len();
        let shrunk = region.offset(-d, MITER);
        let found = shrunk.polygons()[0].outer.points();
        prop_assert_eq!(found.len(), n);
        for i in 0..n {
            let (e1, e2) = ((q[(i + 1) % n] - q[i]).normalize(), (q[(i + n - 1) % n] - q[i]).normalize());
            let expected = q[i] + d * (e1 + e2) / e1.perp_dot(e2).abs();
            prop_assert!(found.iter().any(|p| p.distance(expected) < 5e-3), "no vertex near {expected}");
        }
    }

    #[test]
    fn an_opening_follows_steiners_formula(region in convex(), r in 0.1..6.0f64) {
        check_steiner(&region, r, false)?;
        check_steiner(&three_holes(), r / 3.0, false)?;
    }

    #[test]
    fn discs_about_an_erosion_may_overlap_but_never_leave_gaps(region in star(), r in 0.1..2.0f64) {
        check_steiner(&region, r, true)?;
    }

    #[test]
    fn points_are_where_their_distance_says(region in star(), d in -3.0..3.0f64, x in -28.0..28.0, y in -28.0..28.0) {
        let p = v(x, y);
        let distance = distance_to_boundary(&region, p) * if region.contains(p) { -1.0 } else { 1.0 };
        prop_assume!(f64::abs(distance - d) > BOUNDARY_MM);
        prop_assert_eq!(region.offset(d, Join::ROUND).contains(p), distance < d);
    }

    #[test]
    fn areas_do_not_depend_on_the_description(region in star(), d in -2.0..2.0f64) {
        let expected = region.offset(d, Join::ROUND);
        for other in same_shapes(&region) {
            let found = other.offset(d, Join::ROUND);
            prop_assert!(error_of(expected.area(), found.area(), found.perimeter() + 1.0) < 1.0);
        }
    }

    #[test]
    fn growing_twice_is_growing_once(region in star(), a in 0.1..2.0f64, b in 0.1..2.0f64) {
        let once = region.offset(a + b, Join::ROUND);
        let twice = region.offset(a, Join::ROUND).offset(b, Join::ROUND);
        prop_assert!(symmetric_difference(&once, &twice) < 3.0 * BOUNDARY_MM * once.perimeter());
    }

    #[test]
    fn shrinking_is_growing_of_the_outside(region in star(), d in 0.1..2.0f64) {
        let frame = plate(120.0, 120.0, &[]);
        let frame = shapes::map_points(&frame, |p| p - v(60.0, 60.0));
        let grown = region.offset(d, Join::ROUND);
        let outside = frame.offset(d, MITER).difference(&region).offset(-d, Join::ROUND);
        let both = symmetric_difference(&frame.difference(&grown), &outside);
        prop_assert!(both < 2.0 * BOUNDARY_MM * (grown.perimeter() + 480.0));
    }

    #[test]
    fn clipper_finds_the_same_areas(region in star(), convex in convex(), d in -2.0..2.0f64) {
        let round = region.offset(d, Join::ROUND);
        let paths = inflate_paths_64(&to_clipper(&region), d * 1e4, JoinType::Round, EndType::Polygon, 2.0, 50.0);
        prop_assert!(error_of(clipper_area(&paths), round.area(), region.perimeter()) < 1.0);
        let mitred = convex.offset(d, MITER);
        let paths = inflate_paths_64(&to_clipper(&convex), d * 1e4, JoinType::Miter, EndType::Polygon, 10.0, 0.0);
        prop_assert!(error_of(clipper_area(&paths), mitred.area(), convex.perimeter()) < 0.1);
    }
}

/// C = S shrunk by r, then area(C grown by r) = area(C) + r·perimeter(C) + π r²·euler(C): exact where the discs
/// of radius r about C fill it once, too large where they overlap.
fn check_steiner(region: &Region, r: f64, discs_overlap: bool) -> Result<(), TestCaseError> {
    let center = region.offset(-r, Join::ROUND);
    let formula = center.area() + r * center.perimeter() + PI * r * r * center.euler() as f64;
    let opened = center.offset(r, Join::ROUND).area();
    let error = error_of(formula, opened, region.perimeter() + 1.0);
    prop_assert!(error < 1.0 || discs_overlap && opened < formula, "{opened}, formula {formula}");
    Ok(())
}

#[test]
fn steiners_formula_counts_twice_across_a_short_bridge() {
    // The erosion comes apart, but its tips lie less than 2r from each other: the discs about them share a lens.
    let r: f64 = 1.01;
    let center = dumbbell().offset(-r, Join::ROUND);
    assert_eq!(center.euler(), 2);
    let formula = center.area() + r * center.perimeter() + 2.0 * PI * r * r;
    let half_gap = 0.25 + (r * r - 1.0).sqrt();
    let lens = 2.0 * r * r * (half_gap / r).acos() - 2.0 * half_gap * (r * r - half_gap * half_gap).sqrt();
    let opened = center.offset(r, Join::ROUND).area();
    assert!(error_of(formula - lens, opened, dumbbell().perimeter()) < 1.0);
}

#[test]
fn a_bridge_breaks_when_its_half_width_is_reached() {
    assert_eq!(dumbbell().offset(-0.99, Join::ROUND).polygons().len(), 1);
    assert_eq!(dumbbell().offset(-1.01, Join::ROUND).polygons().len(), 2);
    assert!(dumbbell().offset(-5.0, Join::ROUND).is_empty());
}

#[test]
fn a_hole_closes_when_it_is_grown_over() {
    let plate = plate(20.0, 20.0, &[(v(8.0, 8.0), v(12.0, 14.0))]);
    assert_eq!(plate.offset(1.99, Join::ROUND).euler(), 0);
    assert_eq!(plate.offset(2.01, Join::ROUND).euler(), 1);
}

#[test]
fn nothing_happens_without_distance_or_region() {
    assert_eq!(three_holes().offset(0.0, Join::ROUND), three_holes());
    assert!(Region::EMPTY.offset(3.0, Join::ROUND).is_empty());
    assert_eq!(three_holes().polygons()[0].offset(1.0, MITER), three_holes().offset(1.0, MITER));
}

#[test]
fn a_sharp_tip_is_cut_off_at_the_limit() {
    let needle =
        Region::from(planar::Polygon::simple(planar::Ring::new(vec![v(0.0, -1.0), v(20.0, 0.0), v(0.0, 1.0)])));
    let reach = |limit| needle.offset(1.0, Join::Miter(limit)).bounds().unwrap().max.x - 20.0;
    let whole = 1.0 / (1.0_f64 / 20.0).atan().sin();
    assert!((reach(50.0) - whole).abs() < 5e-3, "{} {whole}", reach(50.0));
    assert!(reach(2.0) <= 2.0 + 5e-3, "{}", reach(2.0));
}

#[test]
fn round_joins_keep_their_tolerance() {
    let region = plate(10.0, 10.0, &[]);
    for tolerance in [0.05, ARC_TOLERANCE_MM] {
        for d in [0.5, 5.0, 50.0] {
            let grown = region.offset(d, Join::Round(tolerance));
            let middles = grown.rings().flat_map(|r| r.edges()).map(|(a, b): (DVec2, DVec2)| a.midpoint(b));
            let lowest = middles.map(|p| distance_to_boundary(&region, p)).fold(f64::INFINITY, f64::min);
            assert!(d - lowest < tolerance + SIMPLIFY_MM + 2e-4, "{d} {tolerance}: {lowest}");
        }
    }
}

/// A plate with a fin on its right side.
fn plate_with_fin(width: f64, length: f64) -> planar::Polygon {
    let points = [
        (0.0, 0.0),
        (20.0, 0.0),
        (20.0, 5.0),
        (20.0 + length, 5.0),
        (20.0 + length, 5.0 + width),
        (20.0, 5.0 + width),
        (20.0, 12.0),
        (0.0, 12.0),
    ];
    planar::Polygon::simple(planar::Ring::new(points.map(DVec2::from).to_vec()))
}

/// A rectangle loses (4 − π) r² in its corners, wherever the disc rolls.
#[test]
fn a_disc_reaches_all_of_a_rectangle_but_its_corners() {
    let rectangle = plate_with_fin(3.0, 0.0);
    for r in [0.5, 1.0, 2.5] {
        let reached = rectangle.reached_by_disc(r, &rectangle.offset(-r, Join::ROUND)).unwrap();
        let exact = 240.0 - (4.0 - std::f64::consts::PI) * r * r;
        assert!((reached - exact).abs() < 0.01, "{reached} for {exact}");
    }
}

/// Corners do not count, however many: a fin that holds no disc does.
#[test]
fn a_part_is_roomy_unless_it_has_a_fin() {
    let roomy = |width: f64, length: f64| {
        let plate = plate_with_fin(width, length);
        plate.is_roomy_for_disc(1.0, &plate.centres_of_disc(1.0, Join::ROUND), 0.25)
    };
    assert!(roomy(4.5, 0.0) && roomy(4.5, 6.0), "nothing is thin");
    assert!(!roomy(1.5, 6.0) && !roomy(1.9, 4.0) && !roomy(0.3, 3.0), "a fin is thin");
}

fn ring(points: impl IntoIterator<Item = (f64, f64)>) -> Ring {
    Ring::new(points.into_iter().map(DVec2::from).collect())
}

/// An edge used up by one cut alone, beside edges that turn back sharply, stayed and kept what lies too near the outline.
#[test]
fn a_barb_in_a_corner_leaves_no_spike() {
    // Case 1901.
    let barb = [(0.0, 0.0), (0.0, 0.1), (-0.02, 0.05), (-0.02, 0.15)];
    let around = [(10.0, 0.15), (10.0, 10.0), (-10.0, 10.0), (-10.0, 0.0)];
    let outline = Region::from_rings(&[ring(barb.into_iter().chain(around))], FillRule::NonZero);
    for (quarter, distance) in [(0, 1.0), (1, 0.7), (2, 1.3), (3, 2.0)] {
        let turned = map_points(&outline, |p| DVec2::from_angle(f64::from(quarter) * FRAC_PI_2 + 0.1).rotate(p));
        for join in [Join::ROUND, MITER] {
            let inner = turned.offset(-distance, join);
            assert!(inner.area() > 90.0);
            for &p in inner.rings().flat_map(|ring| ring.points()) {
                assert!(distance_to_boundary(&turned, p) > distance - BOUNDARY_MM, "{p} at {distance}");
            }
        }
    }
}

/// Round joins of less than their tolerance became tips of any length.
#[test]
fn tiny_round_offsets_reach_no_farther_than_their_tolerance() {
    // Case 1902.
    let needle = Region::from_rings(&[ring([(0.0, 0.0), (10.0, 0.0), (0.0, 0.1)])], FillRule::NonZero);
    for distance in [0.0005, 0.001, 0.002, 0.005, 0.02] {
        let grown = needle.offset(distance, Join::ROUND);
        for &p in grown.rings().flat_map(|ring| ring.points()) {
            assert!(distance_to_boundary(&needle, p) < distance + BOUNDARY_MM, "{p} at {distance}");
        }
    }
}
